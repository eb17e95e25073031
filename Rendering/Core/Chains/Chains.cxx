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
  void project(Frame& frame) override
  {
    dispatch(frame.index.volume().type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        frame.settings.quality == Quality::Preview ? this->preview<T>(frame)
                                                   : this->splat<T>(frame);
      });
  }

private:
  template <class T>
  void preview(Frame& frame)
  {
    const LinePreview<T> preview(frame, *frame.lines, this->Reaches);
    // All bands look through sorted chains: there must be no more bands than threads.
    const int height = frame.image.height, threads = vtkSMPTools::GetEstimatedNumberOfThreads();
    const int rows = frame.lines->encoding().order == LineOrder::Lines
      ? bandHeight(height)
      : (height + threads - 1) / threads;
    forBands(height, rows, frame.watch,
      [&](int v0, int v1)
      {
        openRows<T>(frame.image, previewFloor<T>(frame), v0, v1);
        preview.splat(v0, v1, this->Scratch.Local());
        closeRows<T>(frame.image, v0, v1);
      });
  }

  template <class T>
  void splat(Frame& frame)
  {
    using A = Accumulator<T>;
    auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Footprints);
    auto& reach = std::get<WorksheetReach<A>>(this->Reach);
    findFootprints(frame.geometry, worksheetKernel(frame.settings),
      frame.settings.footprintSampling, weightBits<T>, this->Table, footprints);
    findReach(frame.sliceGeometry, footprints, reach);
    walk(frame,
      LineWorksheets<T>(frame, footprints, reach, worksheetDepth(frame.settings), *frame.lines));
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
