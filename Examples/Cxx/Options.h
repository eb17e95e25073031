// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Options_h
#define Options_h

#include "Look.h"
#include "Projector.h"
#include "Reading/Mask.h"
#include "Reading/VolumeReader.h"
#include "View.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

/**
 * The names of the quality modes, in the order of vtkSplattingMIPProjection::QualityModes.
 */
extern const std::vector<std::string> ModeNames;

/**
 * Settings from the command line.
 */
struct Options
{
  std::vector<std::string> Inputs;                  // volumes; none: the built-in one
  ReadSettings Read;                                // choices in it
  MaskSettings Mask;                                // voxels to show
  std::vector<int> Modes;                           // one, or several for stills side by side
  ProjectionSettings Projection;                    //
  ViewSettings View;                                //
  LookSettings Look;                                // the user's, where these are true:
  bool HasWindow = false;                           // Look.Window
  bool HasLevel = false;                            // Look.Level
  std::vector<std::string> Colors;                  // of the volumes, in place of a colormap
  int Blending = vtkSplattingMIPVolumeMapper::OVER; // of the pictures of several volumes
  bool DepthCoding = false;                         // in place of a colormap
  std::string Output;                               // an absolute path
  bool NoMarks = false;                             // no letters for sides, no scale bar
  bool Compare = false;                             // with the ray caster
  bool Interactive = false;                         // in a window
  int Rotate = 0;                                   // views, or 0
  int Rate = 12;                                    // views per second
};

/**
 * Parse the command line. Throws CLI::Success for --help and --version, CLI::ParseError for invalid
 * options.
 */
Options ParseOptions(CLI::App& app, int argc, char* argv[]);

#endif
