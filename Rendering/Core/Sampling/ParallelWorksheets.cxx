// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Sampling/ParallelWorksheets.h"

#include "Sampling/ValuesAtWinners.h"

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
  void project(ProjectionContext& context) override
  {
    dispatch(context.index.volume().type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        using A = Accumulator<T>;
        auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Footprints);
        auto& reach = std::get<WorksheetReach<A>>(this->Reach);
        findFootprints(context.geometry, worksheetKernel(context.settings),
          context.settings.footprintSampling, weightBits<T>, this->Table, footprints);
        findReach(context.sliceGeometry, footprints, reach);
        walk(context,
          ParallelWorksheets<T>(context, footprints, reach, worksheetDepth(context.settings)));
      });
  }

  void takeAtWinners(const AtWinners& c) const override
  {
    dispatch(c.other.type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        using A = Accumulator<T>;
        const auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Footprints);
        fillAtWinners<T>(c,
          [&](const PermutedVoxels<T>& voxels, int u, int v, int step)
          {
            const int k = step / StepsPerSlice;
            return averageAtWinner<T>(voxels, footprints[k], u, v, k);
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
