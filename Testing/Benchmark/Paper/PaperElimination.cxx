// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Paper/PaperElimination.h"

#include "Paper/PaperRenderer.h"
#include "Projection/Project.h"

#include <algorithm>
#include <chrono>

namespace
{
using splatting::Acceleration;

struct Cost
{
  double Build = 0.0; // milliseconds, along the z axis
  double Frame = 0.0; // the projection alone, mean over views
  std::size_t Chains = 0;
  std::size_t Hidden = 0;
  std::size_t Bytes = 0;
};

double Milliseconds(std::chrono::steady_clock::duration duration)
{
  return std::chrono::duration<double, std::milli>(duration).count();
}

/// The mean over views along z, each of which is projected several times and the fastest counts.
double MeasureProjections(splatting::VolumeIndex& index, const PaperVolume& volume,
  const splatting::ProjectionSettings& settings, int passes)
{
  splatting::Projector projector;
  splatting::ShearImage image;
  double sum = 0.0;
  int views = 0;
  for (int turn = -40; turn <= 40; turn += 10, ++views)
  {
    const splatting::ShearWarp geometry(
      MakePaperView(volume, { 0.0, static_cast<double>(turn) }, 64));
    double fastest = 1e300;
    for (int pass = 0; pass < passes; ++pass)
    {
      const auto start = std::chrono::steady_clock::now();
      projector.project(index, geometry, settings, {}, image);
      fastest = std::min(fastest, Milliseconds(std::chrono::steady_clock::now() - start));
    }
    sum += fastest;
  }
  return sum / views;
}

Cost MeasureCost(const PaperVolume& volume, Acceleration acceleration, bool eliminates, int passes)
{
  splatting::VolumeIndex index;
  const std::array<int, 3>& size = volume.Voxels.size;
  index.reset(
    { volume.Voxels.voxels.data(), splatting::ScalarType::UInt8, { size[0], size[1], size[2] } });
  index.range();
  const double before = index.time();
  const std::size_t held = index.memorySize();
  const splatting::LineEncoding encoding{ acceleration == Acceleration::SortedVolume
      ? splatting::LineOrder::SortedVolume
      : splatting::LineOrder::SortedLines,
    0.0, eliminates };
  const splatting::LineIndex& lines = *index.lines(2, encoding);
  Cost cost;
  cost.Build = 1e3 * (index.time() - before);
  cost.Chains = lines.chainCount();
  cost.Hidden = lines.invisibleCount();
  cost.Bytes = index.memorySize() - held;
  splatting::ProjectionSettings settings;
  settings.quality = splatting::Quality::Preview;
  settings.acceleration = acceleration;
  settings.eliminateInvisible = eliminates;
  cost.Frame = MeasureProjections(index, volume, settings, passes);
  return cost;
}
}

//------------------------------------------------------------------------------
void ReportElimination(
  PaperReport& report, const std::vector<PaperDataSet>& sets, const PaperSettings& settings)
{
  report.AddHeading("Invisible voxels");
  report.AddText(
    "Not in the paper, but of the same kind: chains without the voxels that no ray along the z "
    "axis "
    "can see (Mroz, Hauser and Groeller 2000), lossless preview, the projection alone, views "
    "within "
    "40 degrees of the axis. Their elimination took 94 s and gave a factor of 1.3; this one guards "
    "a "
    "voxel "
    "by the 3x3 voxels of the slice before or behind, and theirs in turn.");
  std::vector<std::vector<std::string>> rows;
  for (const PaperDataSet& data : sets)
  {
    const PaperVolume& volume = data.Volumes[0];
    for (const auto acceleration : { Acceleration::SortedLines, Acceleration::SortedVolume })
    {
      const Cost all = MeasureCost(volume, acceleration, false, settings.Passes);
      const Cost some = MeasureCost(volume, acceleration, true, settings.Passes);
      const auto count = [](std::size_t n) { return Fixed(1e-6 * static_cast<double>(n), 2); };
      rows.push_back({ data.Name,
        acceleration == Acceleration::SortedVolume ? "sorted over the volume" : "sorted per slice",
        Fixed(100.0 * static_cast<double>(some.Hidden) /
            static_cast<double>(volume.Voxels.voxels.size()),
          1) +
          " %",
        count(all.Chains) + " / " + count(some.Chains),
        count(all.Bytes) + " / " + count(some.Bytes),
        Fixed(all.Build, 0) + " / " + Fixed(some.Build, 0),
        Fixed(all.Frame, 2) + " / " + Fixed(some.Frame, 2), Fixed(all.Frame / some.Frame, 2) });
    }
  }
  report.AddTable({ "data", "chains", "voxels left out", "million chains, all / visible",
                    "MB, all / visible", "made in ms", "projected in ms", "factor" },
    rows);
}
