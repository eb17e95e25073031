// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Chains/LineWalk.h"
#include "Chains/LineWorksheets.h"

#include <vtkSMPThreadLocal.h>
#include <vtkSMPTools.h>

#include <memory>
#include <tuple>
#include <type_traits>
#include <vector>

namespace splatting
{
namespace
{
class ChainsMode : public ProjectionMode
{
public:
  void project(ProjectionContext& context) override
  {
    dispatch(context.index.volume().type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        context.settings.quality == Quality::Preview ? this->preview<T>(context)
                                                     : this->splat<T>(context);
      });
  }

private:
  template <class T>
  void preview(ProjectionContext& context)
  {
    const LinePreview<T> preview(context, *context.lines, this->Reaches);
    // All bands look through sorted chains: there must be no more bands than threads.
    const int height = context.image.height, threads = vtkSMPTools::GetEstimatedNumberOfThreads();
    const int rows = context.lines->encoding().order == LineOrder::Lines
      ? bandHeight(height)
      : (height + threads - 1) / threads;
    forBands(height, rows, context.observer,
      [&](int v0, int v1)
      {
        openRows<T>(context.image, previewFloor<T>(context), v0, v1);
        preview.splat(v0, v1, this->Scratch.Local());
        closeRows<T>(context.image, v0, v1);
      });
  }

  template <class T>
  void splat(ProjectionContext& context)
  {
    using A = Accumulator<T>;
    auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Footprints);
    auto& reach = std::get<WorksheetReach<A>>(this->Reach);
    findFootprints(context.geometry, worksheetKernel(context.settings),
      context.settings.footprintSampling, weightBits<T>, this->Table, footprints);
    findReach(context.sliceGeometry, footprints, reach);
    walk(context,
      LineWorksheets<T>(
        context, footprints, reach, worksheetDepth(context.settings), *context.lines));
  }

  std::vector<LineReach> Reaches;
  vtkSMPThreadLocal<LineScratch> Scratch;
  GeneralTable Table;
  std::tuple<std::vector<SliceFootprint<float>>, std::vector<SliceFootprint<double>>> Footprints;
  std::tuple<WorksheetReach<float>, WorksheetReach<double>> Reach;
};
}

std::unique_ptr<ProjectionMode> makeChains()
{
  return std::make_unique<ChainsMode>();
}
}
