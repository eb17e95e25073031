// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Comparison_h
#define Comparison_h

#include "MIPScene.h"
#include "Options.h"

#include <string>

/**
 * Milliseconds in as many digits as mean something.
 */
std::string FormatTime(double milliseconds);

/**
 * Times the modes and prints a line for each. The ray caster is measured with the interpolation
 * that comes next to the mode, each only once.
 */
class Comparison
{
public:
  Comparison(const Volume& volume, const LookSettings& look, const Options& options);

  /**
   * Returns a mode's time in milliseconds.
   */
  double AddMode(int mode);

private:
  MIPScene Scene;
  double RayCasting[2] = { 0.0, 0.0 };
};

#endif
