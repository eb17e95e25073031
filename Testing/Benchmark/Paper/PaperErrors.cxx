// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/PaperErrors.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

//------------------------------------------------------------------------------
void PaperErrors::Add(
  const reference::Image<double>& picture, const reference::Image<double>& truth)
{
  if (picture.width != truth.width || picture.height != truth.height)
  {
    throw std::invalid_argument("The pictures differ in size.");
  }
  for (std::size_t pixel = 0; pixel < truth.value.size(); ++pixel)
  {
    if (picture.hit[pixel] && truth.hit[pixel])
    {
      const double error = picture.value[pixel] - truth.value[pixel];
      this->Maximum = std::max(this->Maximum, std::abs(error));
      this->Magnitudes += std::abs(error);
      this->Squares += error * error;
      this->Sum += error;
      this->Count += 1.0;
    }
  }
}

//------------------------------------------------------------------------------
double PaperErrors::GetRms() const
{
  return std::sqrt(this->Squares / this->Count);
}
