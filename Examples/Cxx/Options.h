// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Options_h
#define Options_h

#include "Look.h"
#include "Projector.h"
#include "Reading/Mask.h"
#include "Reading/VolumeReader.h"
#include "View.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

/**
 * The names of the quality modes, in the order of vtkSplattingMIPProjection::QualityModes.
 */
extern const std::vector<std::string> ModeNames;

/**
 * What the command line asks for.
 */
struct Options
{
  std::string Input;             // empty: the built-in volume
  ReadSettings Read;             // what of it
  MaskSettings Mask;             // which of its voxels
  std::vector<int> Modes;        // one, but for stills side by side
  ProjectionSettings Projection; //
  ViewSettings View;             //
  LookSettings Look;             // of which the user has given
  bool DepthCoding = false;      // in place of a colormap
  bool HasWindow = false;        // this
  bool HasLevel = false;         // and this
  std::string Output;            // an absolute path
  bool NoMarks = false;          // sides and scale bar
  bool Compare = false;          // with the ray caster
  bool Interactive = false;      // in a window
  int Rotate = 0;                // views, or 0
  int Rate = 12;                 // views per second
};

/**
 * Throws CLI::Success for --help and --version, CLI::ParseError for what makes no sense.
 */
Options ParseOptions(CLI::App& app, int argc, char* argv[]);

#endif
