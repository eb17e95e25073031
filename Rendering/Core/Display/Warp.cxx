// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/Warp.h"

#include "Display/AreaRows.h"
#include "Display/WarpSource.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace splatting
{
namespace
{
/// What becomes of the rows' scalars: their colours, ...
template <class A>
struct ColorSink
{
  using Pixel = std::uint32_t;
  static constexpr Pixel empty = 0;

  const WorksheetLoops<A>& loops;
  const ColorTable& table;
  A low, scale;
  std::int32_t last;

  ColorSink(const WorksheetLoops<A>& l, const ColorTable& t)
    : loops(l),
      table(t),
      low(static_cast<A>(t.low)),
      scale(0),
      last(static_cast<std::int32_t>(t.colors.size()) - 1)
  {
    this->scale = static_cast<A>(t.high > t.low ? this->last / (t.high - t.low) : 0.0);
  }
  void put(const A* values, Pixel* out, std::ptrdiff_t n) const
  {
    this->loops.lookUp(
      values, this->low, this->scale, this->last, this->table.colors.data(), out, n);
  }
};

/// ... or they themselves.
template <class A>
struct ScalarSink
{
  using Pixel = A;

  const WorksheetLoops<A>& loops;
  A empty;

  void put(const A* values, Pixel* out, std::ptrdiff_t n) const { std::copy_n(values, n, out); }
};

/// What becomes of values, NaN being none.
template <class A, class Sink>
void putValues(const Sink& sink, const A* values, typename Sink::Pixel* out, int n)
{
  for (int begin = 0, end = 0; begin < n; begin = end)
  {
    const bool isEmpty = values[begin] != values[begin];
    while (end < n && (values[end] != values[end]) == isEmpty)
    {
      ++end;
    }
    if (isEmpty)
    {
      std::fill(out + begin, out + end, sink.empty);
    }
    else
    {
      sink.put(values + begin, out + begin, end - begin);
    }
  }
}

/// Brings the images of a view to rows of pixels.
template <class A, class Sink>
class RowWarp
{
public:
  using Pixel = typename Sink::Pixel;

  /// Both must outlive its use.
  RowWarp(const std::vector<WarpSource<A>>& images, Reduction reduction, const Sink& sink)
    : Images(images),
      To(sink),
      Areas(images, reduction)
  {
  }

  /// The pixels of a part of a viewport, of which `pixels` is the first and the next row lies a
  /// stride further.
  void warp(const Picture& place, Pixel* pixels, std::ptrdiff_t stride) const
  {
    const bool showsAreas = this->Images.front().geometry.isOverview();
    vtkSMPTools::For(0, place.size.y, 16,
      [&](vtkIdType first, vtkIdType last)
      {
        for (vtkIdType y = first; y < last; ++y)
        {
          const glm::dvec3 start(place.origin.x, place.origin.y + static_cast<double>(y), 1.0);
          Pixel* const out = pixels + y * stride;
          showsAreas ? this->warpAreas(start, place.size.x, out)
                     : this->warpRow(start, static_cast<int>(y), place.size.x, out);
        }
      });
  }

private:
  static constexpr int Chunk = 256; // stays in the first-level cache

  void warpAreas(const glm::dvec3& start, int width, Pixel* out) const
  {
    A values[Chunk];
    for (int x = 0; x < width; x += Chunk)
    {
      const int n = std::min(Chunk, width - x);
      this->Areas.find(start, x, n, values);
      putValues(this->To, values, out + x, n);
    }
  }

  void warpRow(const glm::dvec3& start, int y, int width, Pixel* out) const
  {
    forSpans(
      this->Images.size(), start, width,
      [&](std::size_t n) -> const Outline& { return this->Images[n].shown; },
      [&](std::size_t n, const Span& row) { this->warpSpan(this->Images[n], start, y, row, out); },
      [&](const Span& row) { std::fill(out + row.begin, out + row.end, this->To.empty); });
  }

  /// The pixels of row y, `start` being the first, that one image shows.
  void warpSpan(
    const WarpSource<A>& source, const glm::dvec3& start, int y, const Span& row, Pixel* out) const
  {
    const glm::dmat3& m = source.geometry.screenToShear();
    const glm::dvec3 first = m * start, step = m[0];
    const auto warpPoints = [&](int begin, int end)
    {
      for (int x = begin; x < end; ++x)
      {
        const A at = source.valueAt(first + double(x) * step);
        const A* const own =
          source.rays.empty() ? &at : source.rays.template values<A>(source.number, x, y);
        putValues(this->To, *own == *own && std::isfinite(at) ? own : &at, out + x, 1);
      }
    };
    const Span plain = source.hasHoles() ? Span{} : source.inside.cut(row, start);
    if (plain.empty())
    {
      warpPoints(row.begin, row.end);
      return;
    }
    warpPoints(row.begin, plain.begin);
    if (source.rays.empty())
    {
      this->warpInside(source, first + double(plain.begin) * step, step, out + plain.begin,
        plain.end - plain.begin);
    }
    else
    {
      this->warpRays(source, first, y, plain, out);
    }
    warpPoints(plain.end, row.end);
  }

  /// Where all four neighbours of all points are samples.
  void warpInside(const WarpSource<A>& source, const glm::dvec3& start, const glm::dvec3& step,
    Pixel* out, int n) const
  {
    A values[Chunk];
    const WorksheetLoops<A>& loops = this->To.loops;
    const auto interpolate =
      source.geometry.isPerspective() ? loops.interpolateProjective : loops.interpolate;
    for (int x = 0; x < n; x += Chunk)
    {
      const int count = std::min(Chunk, n - x);
      const glm::dvec3 p = start + double(x) * step;
      interpolate(source.pixels, source.image.width, &p.x, &step.x, values, count);
      this->To.put(values, out + x, count);
    }
  }

  /// The same where the screen's rays have values of their own, but for a few.
  void warpRays(
    const WarpSource<A>& source, const glm::dvec3& first, int y, const Span& row, Pixel* out) const
  {
    A values[Chunk];
    const glm::dvec3& step = source.geometry.screenToShear()[0];
    for (int begin = row.begin; begin < row.end; begin += Chunk)
    {
      const int count = std::min(Chunk, row.end - begin);
      const A* const own = source.rays.template values<A>(source.number, begin, y);
      for (int n = 0; n < count; ++n)
      {
        values[n] = own[n] == own[n] ? own[n] : source.valueAt(first + double(begin + n) * step);
      }
      this->To.put(values, out + begin, count);
    }
  }

  const std::vector<WarpSource<A>>& Images;
  const Sink& To;
  AreaRows<A> Areas;
};

/// The pixels of an image in the accumulator's type, `widened` being a place for them.
template <class T>
const Accumulator<T>* widenedPixels(
  const ShearImage& image, const VoxelLoops<T>& loops, std::vector<unsigned char>& widened)
{
  using A = Accumulator<T>;
  if constexpr (std::is_same_v<T, A>)
  {
    return image.row<T>(0);
  }
  else
  {
    const std::size_t count = std::size_t(image.width) * image.height;
    widened.resize(count * sizeof(A));
    A* const pixels = reinterpret_cast<A*>(widened.data());
    loops.widen(image.row<T>(0), 0, pixels, 0, A(0), static_cast<std::ptrdiff_t>(count), 1, 0);
    return pixels;
  }
}

/// Warps images of voxels of type T, which are widened in `widened`.
template <class T, class Sink>
void warpImages(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
  Reduction reduction, const Kernels& kernels, const Sink& sink,
  std::vector<std::vector<unsigned char>>& widened, const Picture& place,
  typename Sink::Pixel* pixels, std::ptrdiff_t stride, const ScreenRays& rays)
{
  using A = Accumulator<T>;
  std::vector<WarpSource<A>> sources;
  for (std::size_t n = 0; n < geometries.size(); ++n)
  {
    const A* const own = widenedPixels<T>(images[n], kernels, widened[n]);
    sources.emplace_back(images[n], own, geometries[n], rays, n);
  }
  RowWarp<A, Sink>(sources, reduction, sink).warp(place, pixels, stride);
}
}

void Warper::warp(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
  Reduction reduction, const ColorTable& table, const glm::ivec2& viewport,
  InstructionSet instructionSet, Picture& picture, const ScreenRays& rays)
{
  placePicture(geometries, viewport, picture);
  picture.pixels.resize(std::size_t(picture.size.x) * picture.size.y);
  if (picture.pixels.empty())
  {
    return;
  }
  this->Widened.resize(std::max(this->Widened.size(), geometries.size()));
  const Kernels& kernels = kernelsFor(instructionSet);
  dispatch(images.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      const ColorSink<Accumulator<T>> sink(kernels, table);
      warpImages<T>(images, geometries, reduction, kernels, sink, this->Widened, picture,
        picture.pixels.data(), picture.size.x, rays);
    });
}

void Warper::warpPixels(const std::vector<ShearImage>& images, const std::vector<ShearPixel>& shown,
  const ColorTable& table, InstructionSet instructionSet, Picture& picture)
{
  picture.pixels.resize(shown.size());
  if (shown.empty())
  {
    return;
  }
  dispatch(images.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      const ColorSink<A> sink(kernelsFor(instructionSet), table);
      vtkSMPTools::For(0, static_cast<vtkIdType>(shown.size()), 1 << 12,
        [&](vtkIdType first, vtkIdType last)
        {
          for (vtkIdType n = first; n < last; ++n)
          {
            const ShearPixel& from = shown[n];
            const A value = from.image < 0
              ? std::numeric_limits<A>::quiet_NaN()
              : static_cast<A>(images[from.image].row<T>(from.v)[from.u]);
            putValues(sink, &value, &picture.pixels[n], 1);
          }
        });
    });
}

void Warper::warpScalars(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& viewport,
  InstructionSet instructionSet, double background, void* scalars, const ScreenRays& rays)
{
  Picture place;
  placePicture(geometries, viewport, place);
  if (place.size.x < 1 || place.size.y < 1)
  {
    return;
  }
  this->Widened.resize(std::max(this->Widened.size(), geometries.size()));
  const Kernels& kernels = kernelsFor(instructionSet);
  dispatch(images.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      const ScalarSink<A> sink{ kernels, static_cast<A>(background) };
      A* const first =
        static_cast<A*>(scalars) + std::ptrdiff_t(place.origin.y) * viewport.x + place.origin.x;
      warpImages<T>(images, geometries, reduction, kernels, sink, this->Widened, place, first,
        viewport.x, rays);
    });
}
}
