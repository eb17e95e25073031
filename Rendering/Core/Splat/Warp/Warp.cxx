// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Warp/Warp.h"

#include "Common/Parallel.h"
#include "Display/Picture.h"
#include "Display/SignedMaximum.h"
#include "Splat/Warp/AreaRows.h"
#include "Splat/Warp/WarpSource.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace splatting
{
namespace
{
/// Warps the images of a view to rows of pixels.
template <class A>
class RowWarp
{
public:
  /// All must outlive its use.
  RowWarp(
    const std::vector<WarpSource<A>>& images, Reduction reduction, const WorksheetLoops<A>& loops)
    : Images(images),
      Loops(loops),
      Areas(images, reduction)
  {
  }

  /// Warps to a row of pixels. `start` is the first.
  void warp(const glm::dvec3& start, int width, A* out) const
  {
    if (this->Images.front().geometry.minifiesAnyAxis())
    {
      this->Areas.find(start, width, out);
      return;
    }
    forSpans(
      this->Images.size(), start, width,
      [&](std::size_t n) -> const Outline& { return this->Images[n].shown; },
      [&](std::size_t n, const Span& row) { this->warpSpan(this->Images[n], start, row, out); },
      [&](const Span& row)
      { std::fill(out + row.begin, out + row.end, std::numeric_limits<A>::quiet_NaN()); });
  }

private:
  /// Warps the pixels of a row that show one image. `start` is the first.
  void warpSpan(const WarpSource<A>& source, const glm::dvec3& start, const Span& row, A* out) const
  {
    const glm::dvec3 first = source.geometry.screenToShear() * start;
    const Span inside = source.inside.cut(row, start);
    if (inside.empty())
    {
      warpPoints(source, first, row, out);
      return;
    }
    warpPoints(source, first, { row.begin, inside.begin }, out);
    this->warpInside(source, first, inside, out);
    warpPoints(source, first, { inside.end, row.end }, out);
  }

  /// For pixels with neighbours outside the volume.
  static void warpPoints(
    const WarpSource<A>& source, const glm::dvec3& first, const Span& row, A* out)
  {
    for (int x = row.begin; x < row.end; ++x)
    {
      out[x] = pointAt(source, first, x);
    }
  }

  /// For pixels whose four neighbours are in the volume. If a neighbour has no sample, or is
  /// infinite, the interpolated value is not finite.
  void warpInside(
    const WarpSource<A>& source, const glm::dvec3& first, const Span& row, A* out) const
  {
    const auto interpolate =
      source.geometry.isPerspective() ? this->Loops.interpolateProjective : this->Loops.interpolate;
    const glm::dvec3& step = source.geometry.screenToShear()[0];
    const glm::dvec3 p = first + double(row.begin) * step;
    interpolate(
      source.pixels, source.image.width, &p.x, &step.x, out + row.begin, row.end - row.begin);
    for (int x = row.begin; source.hasHoles() && x < row.end; ++x)
    {
      out[x] = std::isfinite(out[x]) ? out[x] : pointAt(source, first, x);
    }
  }

  static A pointAt(const WarpSource<A>& source, const glm::dvec3& first, int x)
  {
    return source.valueAt(first + double(x) * source.geometry.screenToShear()[0]);
  }

  const std::vector<WarpSource<A>>& Images;
  const WorksheetLoops<A>& Loops;
  AreaRows<A> Areas;
};

/// The pixels of an image in the accumulator's type, NaN where cuts have left no sample. `copied`
/// is a buffer for them.
template <class T>
const Accumulator<T>* samplesOf(
  const ShearImage& image, const VoxelLoops<T>& loops, std::vector<unsigned char>& copied)
{
  using A = Accumulator<T>;
  if constexpr (std::is_same_v<T, A>)
  {
    if (image.mask.empty())
    {
      return image.row<T>(0);
    }
  }
  const std::size_t count = std::size_t(image.width) * image.height;
  copied.resize(count * sizeof(A));
  A* const pixels = reinterpret_cast<A*>(copied.data());
  loops.widen(image.row<T>(0), 0, pixels, 0, A(0), static_cast<std::ptrdiff_t>(count), 1, 0);
  for (int v = 0; !image.mask.empty() && v < image.height; ++v)
  {
    A* const row = pixels + std::ptrdiff_t(v) * image.width;
    for (int u = 0; u < image.width; ++u)
    {
      row[u] = image.covers(u, v) ? row[u] : std::numeric_limits<A>::quiet_NaN();
    }
  }
  return pixels;
}

/// Warps images of voxels of type T.
template <class T>
class TypedRows : public WarpedScalars::Rows
{
public:
  using A = Accumulator<T>;

  /// All must outlive its use. `copied` has buffers for copies, if they are needed.
  TypedRows(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
    Reduction reduction, const Kernels& kernels, std::vector<std::vector<unsigned char>>& copied)
    : IsSigned(reduction == Reduction::Signed),
      Origin(images.front().origin),
      Images(sourcesOf(images, geometries, reduction == Reduction::Minimum, kernels, copied)),
      Minima(this->IsSigned ? sourcesOf(images, geometries, true, kernels, copied)
                            : std::vector<WarpSource<A>>()),
      Warp(this->Images, this->IsSigned ? Reduction::Maximum : reduction, kernels),
      WarpOfMinima(this->Minima, Reduction::Minimum, kernels)
  {
  }

  void warp(const glm::dvec3& start, int width, void* values) const override
  {
    A* const out = static_cast<A*>(values);
    this->Warp.warp(start, width, out);
    if (!this->IsSigned)
    {
      return;
    }
    std::vector<A>& least = this->Least.Local();
    least.resize(width);
    this->WarpOfMinima.warp(start, width, least.data());
    for (int x = 0; x < width; ++x)
    {
      out[x] = showsMinimum(out[x], least[x], this->Origin) ? least[x] : out[x];
    }
  }

private:
  static std::vector<WarpSource<A>> sourcesOf(const std::vector<ShearImage>& images,
    const std::vector<ShearWarp>& geometries, bool minima, const Kernels& kernels,
    std::vector<std::vector<unsigned char>>& copied)
  {
    copied.resize(std::max(copied.size(), 2 * geometries.size()));
    std::vector<WarpSource<A>> sources;
    for (std::size_t n = 0; n < geometries.size(); ++n)
    {
      const ShearImage& image = images[n].ofExtremum(minima);
      sources.emplace_back(
        image, samplesOf<T>(image, kernels, copied[2 * n + minima]), geometries[n]);
    }
    return sources;
  }

  const bool IsSigned;
  const double Origin;
  const std::vector<WarpSource<A>> Images, Minima;
  const RowWarp<A> Warp, WarpOfMinima;
  mutable PerThread<std::vector<A>> Least; // a row of minima
};
}

void WarpedScalars::set(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& viewport,
  InstructionSet instructionSet)
{
  Picture place;
  placePicture(geometries, viewport, place);
  this->origin = place.origin;
  this->size = place.size;
  this->IsObserved = !geometries.empty() && geometries.front().minifiesAnyAxis();
  if (this->IsObserved)
  {
    this->Observer.start();
  }
  this->Source = nullptr;
  if (geometries.empty())
  {
    return;
  }
  this->type = averageType(images.front().type);
  if (this->size.x < 1 || this->size.y < 1)
  {
    this->size = glm::ivec2(0);
    return;
  }
  dispatch(images.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      this->Source = std::make_unique<TypedRows<T>>(
        images, geometries, reduction, kernelsFor(instructionSet), this->Copied);
    });
}

const void* WarpedScalars::valuesOfRow(int y, void* space) const
{
  const glm::dvec3 start(this->origin.x, this->origin.y + static_cast<double>(y), 1.0);
  if (!this->IsObserved || this->Observer.ask())
  {
    this->Source->warp(start, this->size.x, space);
  }
  return space;
}
}
