// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Checks.h"

#include "Scenes.h"

#include <cstdlib>
#include <iostream>

namespace reference
{

//------------------------------------------------------------------------------
void Checks::fail(const std::string& message)
{
  reportFailure(message);
}

//------------------------------------------------------------------------------
void Checks::skip(const std::string& file)
{
  std::cout << "skipped: no data (" << file << ")" << std::endl;
  this->Skips = true;
}

//------------------------------------------------------------------------------
int Checks::exitCode()
{
  constexpr int skipped = 125; // VTK_SKIP_RETURN_CODE of vtkTesting.h
  (*this)(onlyScene().empty() || scenesRun() > 0, "There is no scene ", onlyScene());
  if (failures() > 0)
  {
    std::cerr << failures() << " checks failed" << std::endl;
  }
  return failures() > 0 ? EXIT_FAILURE : this->Skips ? skipped : EXIT_SUCCESS;
}
}
