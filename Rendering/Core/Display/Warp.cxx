// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/Warp.h"

#include "Common/Parallel.h"
#include "Display/AreaRows.h"
#include "Display/WarpSource.h"
#include "Projection/SignedMaximum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace splatting
{
namespace
{
/// Converts the rows' scalars to colours ...
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

/// ... or copies them.
template <class A>
struct ScalarSink
{
  using Pixel = A;

  const WorksheetLoops<A>& loops;
  A empty;

  void put(const A* values, Pixel* out, std::ptrdiff_t n) const { std::copy_n(values, n, out); }
};

/// Converts values; NaN is no value.
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

/// Warps the images of a view to rows of pixels.
template <class A, class Sink>
class RowWarp
{
public:
  using Pixel = typename Sink::Pixel;

  /// All must outlive its use.
  RowWarp(const std::vector<WarpSource<A>>& images, Reduction reduction, const Sink& sink)
    : Images(images),
      To(sink),
      Areas(images, reduction)
  {
  }

  /// Warps to a row of pixels. `start` is the first.
  void warp(const glm::dvec3& start, int width, Pixel* out) const
  {
    this->Images.front().geometry.minifiesAnyAxis() ? this->warpAreas(start, width, out)
                                                    : this->warpRow(start, width, out);
  }

private:
  static constexpr int Chunk = 256; // fits the first-level cache

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

  void warpRow(const glm::dvec3& start, int width, Pixel* out) const
  {
    forSpans(
      this->Images.size(), start, width,
      [&](std::size_t n) -> const Outline& { return this->Images[n].shown; },
      [&](std::size_t n, const Span& row) { this->warpSpan(this->Images[n], start, row, out); },
      [&](const Span& row) { std::fill(out + row.begin, out + row.end, this->To.empty); });
  }

  /// Warps the pixels of a row that show one image. `start` is the first.
  void warpSpan(
    const WarpSource<A>& source, const glm::dvec3& start, const Span& row, Pixel* out) const
  {
    const glm::dvec3 first = source.geometry.screenToShear() * start;
    const Span inside = source.inside.cut(row, start);
    if (inside.empty())
    {
      this->warpPoints(source, first, row, out);
      return;
    }
    this->warpPoints(source, first, { row.begin, inside.begin }, out);
    this->warpInside(source, first, inside, out);
    this->warpPoints(source, first, { inside.end, row.end }, out);
  }

  /// For pixels with neighbours outside the volume.
  void warpPoints(
    const WarpSource<A>& source, const glm::dvec3& first, const Span& row, Pixel* out) const
  {
    this->forChunks(row, true, out,
      [&](int begin, int count, A* values)
      {
        for (int n = 0; n < count; ++n)
        {
          values[n] = pointAt(source, first, begin + n);
        }
      });
  }

  /// For pixels whose four neighbours are in the volume. If a neighbour has no sample, or is
  /// infinite, the interpolated value is not finite.
  void warpInside(
    const WarpSource<A>& source, const glm::dvec3& first, const Span& row, Pixel* out) const
  {
    const WorksheetLoops<A>& loops = this->To.loops;
    const auto interpolate =
      source.geometry.isPerspective() ? loops.interpolateProjective : loops.interpolate;
    const glm::dvec3& step = source.geometry.screenToShear()[0];
    this->forChunks(row, source.hasHoles(), out,
      [&](int begin, int count, A* values)
      {
        const glm::dvec3 p = first + double(begin) * step;
        interpolate(source.pixels, source.image.width, &p.x, &step.x, values, count);
        for (int n = 0; source.hasHoles() && n < count; ++n)
        {
          values[n] = std::isfinite(values[n]) ? values[n] : pointAt(source, first, begin + n);
        }
      });
  }

  /// Calls find(begin, count, values) for some pixels at a time.
  /// @param mayBeEmpty  whether values can be NaN
  template <class F>
  void forChunks(const Span& row, bool mayBeEmpty, Pixel* out, F&& find) const
  {
    A values[Chunk];
    for (int begin = row.begin; begin < row.end; begin += Chunk)
    {
      const int count = std::min(Chunk, row.end - begin);
      find(begin, count, values);
      mayBeEmpty ? putValues(this->To, values, out + begin, count)
                 : this->To.put(values, out + begin, count);
    }
  }

  static A pointAt(const WarpSource<A>& source, const glm::dvec3& first, int x)
  {
    return source.valueAt(first + double(x) * source.geometry.screenToShear()[0]);
  }

  const std::vector<WarpSource<A>>& Images;
  const Sink& To;
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

/// The part of a viewport that images are warped to: its first pixel, and the distance of rows.
template <class Pixel>
struct Target
{
  const Picture& place;
  Pixel* pixels;
  std::ptrdiff_t stride;
};

/// Calls warp(start, width, out) for each row of a target. If there is an observer, it returns
/// false if the observer has stopped it.
template <class Pixel, class F>
bool forRows(const Target<Pixel>& target, ProgressObserver* observer, F&& warp)
{
  if (observer)
  {
    observer->start();
  }
  const Picture& place = target.place;
  parallelFor(0, place.size.y, 16,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t y = first; y < last && (!observer || observer->ask()); ++y)
      {
        const glm::dvec3 start(place.origin.x, place.origin.y + static_cast<double>(y), 1.0);
        warp(start, place.size.x, target.pixels + y * target.stride);
      }
    });
  return !observer || !observer->stopped();
}

/// Warps images of voxels of type T. `copied` has buffers for copies, if they are needed.
template <class T, class Sink>
bool warpImages(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
  Reduction reduction, const Kernels& kernels, const Sink& sink,
  std::vector<std::vector<unsigned char>>& copied, const Target<typename Sink::Pixel>& target,
  ProgressObserver& observer)
{
  using A = Accumulator<T>;
  using Pixel = typename Sink::Pixel;
  copied.resize(std::max(copied.size(), 2 * geometries.size()));
  const auto sourcesOf = [&](bool minimum)
  {
    std::vector<WarpSource<A>> sources;
    for (std::size_t n = 0; n < geometries.size(); ++n)
    {
      const ShearImage& image = images[n].ofExtremum(minimum);
      const A* const own = samplesOf<T>(image, kernels, copied[2 * n + minimum]);
      sources.emplace_back(image, own, geometries[n]);
    }
    return sources;
  };
  ProgressObserver* const asked = geometries.front().minifiesAnyAxis() ? &observer : nullptr;
  if (reduction != Reduction::Signed)
  {
    const std::vector<WarpSource<A>> sources = sourcesOf(reduction == Reduction::Minimum);
    const RowWarp<A, Sink> rows(sources, reduction, sink);
    return forRows(target, asked,
      [&](const glm::dvec3& start, int width, Pixel* out) { rows.warp(start, width, out); });
  }
  const ScalarSink<A> scalars{ kernels, std::numeric_limits<A>::quiet_NaN() };
  const std::vector<WarpSource<A>> highs = sourcesOf(false), lows = sourcesOf(true);
  const RowWarp<A, ScalarSink<A>> maxima(highs, Reduction::Maximum, scalars);
  const RowWarp<A, ScalarSink<A>> minima(lows, Reduction::Minimum, scalars);
  struct Extrema
  {
    std::vector<A> high, low;
  };
  PerThread<Extrema> extrema;
  return forRows(target, asked,
    [&, origin = images.front().origin](const glm::dvec3& start, int width, Pixel* out)
    {
      Extrema& row = extrema.Local();
      row.high.resize(width);
      row.low.resize(width);
      maxima.warp(start, width, row.high.data());
      minima.warp(start, width, row.low.data());
      for (int x = 0; x < width; ++x)
      {
        row.high[x] = showsMinimum(row.high[x], row.low[x], origin) ? row.low[x] : row.high[x];
      }
      putValues(sink, row.high.data(), out, width);
    });
}
}

bool Warper::warp(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
  Reduction reduction, const ColorTable& table, const glm::ivec2& viewport,
  InstructionSet instructionSet, Picture& picture)
{
  placePicture(geometries, viewport, picture);
  picture.pixels.resize(std::size_t(picture.size.x) * picture.size.y);
  if (picture.pixels.empty())
  {
    return true;
  }
  const Kernels& kernels = kernelsFor(instructionSet);
  return dispatch(images.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      const ColorSink<Accumulator<T>> sink(kernels, table);
      return warpImages<T>(images, geometries, reduction, kernels, sink, this->Copied,
        { picture, picture.pixels.data(), picture.size.x }, this->Observer);
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
      parallelFor(0, static_cast<std::ptrdiff_t>(shown.size()), 1 << 12,
        [&](std::ptrdiff_t first, std::ptrdiff_t last)
        {
          for (std::ptrdiff_t n = first; n < last; ++n)
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

bool Warper::warpScalars(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& viewport,
  InstructionSet instructionSet, double background, void* scalars)
{
  Picture place;
  placePicture(geometries, viewport, place);
  if (place.size.x < 1 || place.size.y < 1)
  {
    return true;
  }
  const Kernels& kernels = kernelsFor(instructionSet);
  return dispatch(images.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      const ScalarSink<A> sink{ kernels, static_cast<A>(background) };
      A* const first =
        static_cast<A*>(scalars) + std::ptrdiff_t(place.origin.y) * viewport.x + place.origin.x;
      return warpImages<T>(images, geometries, reduction, kernels, sink, this->Copied,
        { place, first, viewport.x }, this->Observer);
    });
}
}
