// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/Parallel.h"
#include "Splat/Chains/LineWalk.h"
#include "Splat/Chains/LineWorksheets.h"

#include <memory>
#include <vector>

namespace splatting
{
namespace
{
template <class A>
class ChainSpace
{
public:
  template <class T>
  void project(ProjectionContext& context)
  {
    context.settings.quality == Quality::Preview ? this->preview<T>(context)
                                                 : this->splat<T>(context);
  }
  template <class T>
  void takeAtLocations(const AtWinners&) const
  {
  }

private:
  template <class T>
  void preview(ProjectionContext& context)
  {
    const LinePreview<T> preview(context, *context.lines, this->Paths);
    // All bands search the sorted chains, so there must be no more bands than threads.
    const int height = context.image.height, threads = numberOfThreads();
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
    this->Space.template find<T>(context);
    walk(context,
      LineWorksheets<T>(context, this->Space.footprints, this->Space.reach,
        worksheetDepth(context.settings), *context.lines));
  }

  std::vector<PathRows> Paths;
  PerThread<LineScratch> Scratch;
  WorksheetSpace<A> Space;
};
}

std::unique_ptr<ProjectionMode> makeChains()
{
  return std::make_unique<TypedMode<ChainSpace>>();
}
}
