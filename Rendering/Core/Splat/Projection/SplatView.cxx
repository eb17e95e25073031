// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Projection/SplatView.h"

#include <algorithm>
#include <cstddef>

namespace splatting
{
bool SplatView::set(const View& view, const RayEnds& ends)
{
  if (!ShearWarp::factorise(view, this->geometries))
  {
    return false;
  }
  this->cuts.resize(this->geometries.size());
  for (std::size_t n = 0; n < this->geometries.size(); ++n)
  {
    this->cuts[n].cropping = view.cropping;
    this->cuts[n].intervals.find(this->geometries[n], view.halfSpaces, ends.surface, ends.depth);
  }
  return true;
}

bool SplatView::projectsAs(const SplatView& other, bool ordered) const
{
  return this->cuts == other.cuts &&
    std::equal(this->geometries.begin(), this->geometries.end(), other.geometries.begin(),
      other.geometries.end(),
      [=](const ShearWarp& a, const ShearWarp& b)
      { return a.sameShear(b) && (!ordered || a.reversed() == b.reversed()); });
}

const ShearWarp* SplatView::main() const
{
  const auto largest = std::max_element(this->geometries.begin(), this->geometries.end(),
    [](const ShearWarp& a, const ShearWarp& b)
    { return a.rayCount().x * a.rayCount().y < b.rayCount().x * b.rayCount().y; });
  return largest == this->geometries.end() ? nullptr : &*largest;
}
}
