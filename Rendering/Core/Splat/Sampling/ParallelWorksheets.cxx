// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Sampling/ParallelWorksheets.h"

#include "Splat/Sampling/ValuesAtLocations.h"

#include <memory>

namespace splatting
{
namespace
{
template <class A>
class ParallelWorksheetSpace
{
public:
  template <class T>
  void project(ProjectionContext& context)
  {
    this->Space.template find<T>(context);
    walk(context,
      ParallelWorksheets<T>(
        context, this->Space.footprints, this->Space.reach, worksheetDepth(context.settings)));
  }
  template <class T>
  void takeAtLocations(const AtWinners& winners) const
  {
    fillAtWinners<T>(winners,
      [&](const PermutedVoxels<T>& voxels, int u, int v, int step)
      {
        const int k = step / StepsPerSlice;
        return averageAtWinner<T>(voxels, this->Space.footprints[k], u, v, k);
      });
  }

private:
  WorksheetSpace<A> Space;
};
}

std::unique_ptr<ProjectionMode> makeWorksheets()
{
  return std::make_unique<TypedMode<ParallelWorksheetSpace>>();
}
}
