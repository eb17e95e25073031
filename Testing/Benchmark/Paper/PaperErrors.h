// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PaperErrors_h
#define PaperErrors_h

#include "ImageComparison.h"

/**
 * Differences between pictures, over all pixels that both have. Pictures of different views may be
 * added up.
 */
class PaperErrors
{
public:
  /// Throws std::invalid_argument if the sizes differ.
  void Add(const reference::Image<double>& picture, const reference::Image<double>& truth);

  double GetMaximum() const { return this->Maximum; }
  /// Of the magnitudes.
  double GetMean() const { return this->Magnitudes / this->Count; }
  double GetRms() const;
  /// Picture minus truth on average: negative where the picture is too dark.
  double GetBias() const { return this->Sum / this->Count; }

private:
  double Maximum = 0.0;
  double Magnitudes = 0.0;
  double Squares = 0.0;
  double Sum = 0.0;
  double Count = 0.0;
};

#endif
