// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Sampling/ParallelWorksheets.h"

#include "Sampling/Carry.h"

#include <memory>
#include <tuple>
#include <type_traits>
#include <vector>

namespace splatting
{
namespace
{
class WorksheetsMode : public ProjectionMode
{
public:
  void project(Frame& frame) override
  {
    dispatch(frame.index.volume().type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        using A = Accumulator<T>;
        auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Footprints);
        auto& reach = std::get<WorksheetReach<A>>(this->Reach);
        findFootprints(frame.geometry, worksheetKernel(frame.settings),
          frame.settings.footprintSampling, weightBits<T>, this->Table, footprints);
        findReach(frame.sliceGeometry, footprints, reach);
        walk(
          frame, ParallelWorksheets<T>(frame, footprints, reach, worksheetDepth(frame.settings)));
      });
  }

  void carry(const Carrying& c) const override
  {
    dispatch(c.other.type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        using A = Accumulator<T>;
        const auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Footprints);
        carryValues<T>(c,
          [&](const PermutedVoxels<T>& voxels, int u, int v, int step)
          {
            const int k = step / StepsPerSlice;
            return carriedAverage<T>(voxels, footprints[k], u, v, k);
          });
      });
  }

private:
  GeneralTable Table;
  std::tuple<std::vector<SliceFootprint<float>>, std::vector<SliceFootprint<double>>> Footprints;
  std::tuple<WorksheetReach<float>, WorksheetReach<double>> Reach;
};
}

std::unique_ptr<ProjectionMode> makeWorksheets()
{
  return std::make_unique<WorksheetsMode>();
}
}
