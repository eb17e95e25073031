// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Tables 1 to 5 of the paper: times and memory.
 */
#ifndef PaperTables_h
#define PaperTables_h

#include "Paper/PaperReport.h"
#include "Paper/PaperScene.h"

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// The N of delta encoding where the paper has it ("typically 5 to 10").
constexpr int PaperTolerance = 10;

struct PaperSettings
{
  int Voxels = 256;  // along each side of the high resolution
  int Window = 300;  // pixels along each side
  int TurnStep = 2;  // degrees between views
  int SlowStep = 20; // the same for ray casters and chains
  int Passes = 3;    // through all methods; each view's fastest frame counts
  int AccuracyViews = 8;
};

enum class PaperMethod
{
  RayNearest,
  RayCrossed,
  RayLinear,
  Plain,
  PlainStandard,
  PlainHigh,
  Projective,
  Encoded,
  EncodedLossless,
  EncodedStandard,
  EncodedHigh,
  Automatic
};

/**
 * The methods that this build has, in the order of the tables.
 */
std::vector<PaperMethod> ListPaperMethods();
std::string GetName(PaperMethod method);
std::unique_ptr<PaperRenderer> MakeRenderer(PaperMethod method, const PaperVolume& volume);

/**
 * Milliseconds per frame over the views of a full turn about x and one about y.
 */
struct PaperTiming
{
  double Minimum = 0.0;
  double Maximum = 0.0;
  double Mean = 0.0;
  int Views = 0;
  double Preparation = 0.0; // the first frames along the three axes
};

/// Of one set of data, in high and low resolution.
using PaperTimes = std::map<PaperMethod, std::array<PaperTiming, 2>>;

PaperTimes MeasureTimes(const PaperDataSet& data, const PaperSettings& settings);

void ReportTimes(
  PaperReport& report, const std::vector<PaperDataSet>& sets, const std::vector<PaperTimes>& times);
void ReportRatios(
  PaperReport& report, const std::vector<PaperDataSet>& sets, const std::vector<PaperTimes>& times);
void ReportMemory(PaperReport& report, const std::vector<PaperDataSet>& sets);

#endif
