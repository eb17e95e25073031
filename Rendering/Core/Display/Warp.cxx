// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/Warp.h"

#include "Display/Outline.h"
#include "Display/PixelArea.h"

#include <vtkSMPTools.h>

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

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

/// Everything that they share of one image.
template <class A, class Sink>
struct WarpSource
{
  const Sink& sink;
  const ShearImage& image;
  const A* pixels;
  const ShearWarp& geometry;
  const FieldRim& rim;
  std::size_t number; // of the image
  Outline shown, inside;

  WarpSource(const Sink& s, const ShearImage& i, const A* p, const ShearWarp& g, const FieldRim& r,
    std::size_t n)
    : sink(s),
      image(i),
      pixels(p),
      geometry(g),
      rim(r),
      number(n),
      shown(shownBy(g)),
      inside(withinSamples(g))
  {
  }
  bool hasHoles() const { return !this->image.mask.empty() || this->image.special; }
};

/// Where all four neighbours of all points are samples.
template <class A, class Sink>
void warpInside(const WarpSource<A, Sink>& source, const glm::dvec3& start, const glm::dvec3& step,
  typename Sink::Pixel* out, int n)
{
  constexpr int chunk = 256; // stays in the first-level cache
  A values[chunk];
  const WorksheetLoops<A>& loops = source.sink.loops;
  const auto interpolate =
    source.geometry.isPerspective() ? loops.interpolateProjective : loops.interpolate;
  for (int x = 0; x < n; x += chunk)
  {
    const int count = std::min(chunk, n - x);
    const glm::dvec3 p = start + double(x) * step;
    interpolate(source.pixels, source.image.width, &p.x, &step.x, values, count);
    source.sink.put(values, out + x, count);
  }
}

/// Calls f(u, v, weight) for the pixels in the volume between which a point is interpolated.
template <class F>
void forNeighbours(const ShearImage& image, const glm::dvec2& p, F&& f)
{
  // Points on the line between two images may round out of theirs, where they have no neighbours.
  const int u = static_cast<int>(std::floor(p.x)), v = static_cast<int>(std::floor(p.y));
  const double fu = p.x - u, fv = p.y - v;
  for (int n = 0; n < 4; ++n)
  {
    const int i = n & 1, j = n >> 1;
    if (image.meetsVolume(u + i, v + j))
    {
      f(u + i, v + j, (i ? fu : 1.0 - fu) * (j ? fv : 1.0 - fv));
    }
  }
}

/// Where a neighbour may be missing, NaN or infinite: interpolates between those that count; NaN
/// where there is no sample.
template <class A, class Sink>
A valueAt(const WarpSource<A, Sink>& source, const glm::dvec3& homogeneous)
{
  const ShearImage& image = source.image;
  const glm::dvec2 p = glm::dvec2(homogeneous) / homogeneous.z;
  double sum = 0.0, weight = 0.0, lost = 0.0, largest = -1.0;
  A nearest = 0;
  forNeighbours(image, p,
    [&](int u, int v, double w)
    {
      const A value = source.pixels[std::ptrdiff_t(v) * image.width + u];
      if (value != value || !image.covers(u, v))
      {
        lost += w;
        return;
      }
      sum += w * value;
      weight += w;
      if (w > largest)
      {
        largest = w;
        nearest = value;
      }
    });
  // Where samples are missing inside the volume, the picture ends half-way to the last one; at the
  // volume's rim it ends with the silhouette.
  if (weight <= 0.0 || lost > 0.5)
  {
    return std::numeric_limits<A>::quiet_NaN();
  }
  const double average = sum / weight;
  return std::isfinite(average) ? static_cast<A>(average) : nearest;
}

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

/// The pixels of row y, `start` being the first, that one image shows.
template <class A, class Sink>
void warpSpan(const WarpSource<A, Sink>& source, const glm::dvec3& start, int y, const Span& row,
  typename Sink::Pixel* out)
{
  const glm::dmat3& m = source.geometry.screenToShear();
  const glm::dvec3 first = m * start, step = m[0];
  const auto warpPoints = [&](int begin, int end)
  {
    for (int x = begin; x < end; ++x)
    {
      const A at = valueAt(source, first + double(x) * step);
      const A own = source.rim.template value<A>(source.number, x, y);
      putValues(source.sink, own == own && at == at ? &own : &at, out + x, 1);
    }
  };
  const Span plain = source.hasHoles()
    ? Span{}
    : source.inside.cut(common(row, source.rim.inside(source.number, y, row)), start);
  if (plain.empty())
  {
    warpPoints(row.begin, row.end);
    return;
  }
  warpPoints(row.begin, plain.begin);
  warpInside(
    source, first + double(plain.begin) * step, step, out + plain.begin, plain.end - plain.begin);
  warpPoints(plain.end, row.end);
}

/// Of a view: one for each direction of each axis.
constexpr std::size_t MostImages = 6;

/// Calls show(n, row) for the pixels of a row, `start` being the first, that image n shows, and
/// skip(row) for those that none does.
template <class ShownOf, class Show, class Skip>
void forSpans(std::size_t count, const glm::dvec3& start, int width, const ShownOf& shownOf,
  const Show& show, const Skip& skip)
{
  // Images meet at lines: the one that begins first has the pixels that two show.
  std::array<std::size_t, MostImages> order;
  std::array<Span, MostImages> spans;
  for (std::size_t n = 0; n < count; ++n)
  {
    spans[n] = shownOf(n).cut({ 0, width }, start);
    std::size_t place = n;
    for (; place > 0 && spans[n].begin < spans[order[place - 1]].begin; --place)
    {
      order[place] = order[place - 1];
    }
    order[place] = n;
  }
  int done = 0;
  for (std::size_t n = 0; n < count; ++n)
  {
    const std::size_t which = order[n];
    const Span row{ std::max(spans[which].begin, done), spans[which].end };
    if (!row.empty())
    {
      skip(Span{ done, row.begin });
      show(which, row);
      done = row.end;
    }
  }
  skip(Span{ done, width });
}

template <class A, class Sink>
void warpRow(const std::vector<WarpSource<A, Sink>>& sources, const glm::dvec3& start, int y,
  int width, typename Sink::Pixel* out)
{
  const auto empty = sources.front().sink.empty;
  forSpans(
    sources.size(), start, width, [&](std::size_t n) -> const Outline& { return sources[n].shown; },
    [&](std::size_t n, const Span& row) { warpSpan(sources[n], start, y, row, out); },
    [&](const Span& row) { std::fill(out + row.begin, out + row.end, empty); });
}

/// The images of a view whose pixels show areas.
template <class A, class Sink>
struct AreaSources
{
  const std::vector<WarpSource<A, Sink>>& images;
  std::vector<Outline> met; ///< by areas
  Reduction reduction;

  AreaSources(const std::vector<WarpSource<A, Sink>>& sources, Reduction r)
    : images(sources),
      reduction(r)
  {
    for (const WarpSource<A, Sink>& source : sources)
    {
      this->met.push_back(metByAreas(source.geometry));
    }
  }
};

/// The extrema of the areas of a row's pixels [x, x + n), of all images that they meet.
template <class A, class Sink>
void findAreaValues(
  const AreaSources<A, Sink>& sources, const glm::dvec3& start, int x, int n, A* values)
{
  const bool least = sources.reduction == Reduction::Minimum;
  std::fill_n(values, n, std::numeric_limits<A>::quiet_NaN());
  for (std::size_t number = 0; number < sources.images.size(); ++number)
  {
    const WarpSource<A, Sink>& source = sources.images[number];
    const PixelAreas<A> areas(source.image, source.pixels);
    const Span met = sources.met[number].cut({ x, x + n }, start);
    const Span shown = source.shown.cut({ x, x + n }, start);
    for (int p = met.begin; p < met.end; ++p)
    {
      AreaValue<A> best{ values[p - x] };
      best.take(areas.extremum(areaOf(source.geometry, start.x + p, start.y), least), least);
      if (!best.found() && p >= shown.begin && p < shown.end)
      {
        best.value = valueAt(
          source, source.geometry.screenToShear() * (start + glm::dvec3(double(p), 0.0, 0.0)));
      }
      values[p - x] = best.value;
    }
  }
}

/// The same of averages.
template <class A, class Sink>
void findAreaAverages(
  const AreaSources<A, Sink>& sources, const glm::dvec3& start, int x, int n, A* values)
{
  for (int p = x; p < x + n; ++p)
  {
    // Of all images the same points, or those of one would count for more.
    glm::ivec2 points(0);
    for (const WarpSource<A, Sink>& source : sources.images)
    {
      const PixelArea area = areaOf(source.geometry, start.x + p, start.y);
      points = glm::max(points, pointsOf(source.geometry, area));
    }
    double sum = 0.0;
    int count = 0;
    for (std::size_t number = 0; number < sources.images.size(); ++number)
    {
      const WarpSource<A, Sink>& source = sources.images[number];
      if (!sources.met[number].cut({ p, p + 1 }, start).empty())
      {
        PixelAreas<A>(source.image, source.pixels)
          .addAverage(source.geometry, start.x + p, start.y, points, sum, count);
      }
    }
    values[p - x] = count > 0 ? static_cast<A>(sum / count) : std::numeric_limits<A>::quiet_NaN();
  }
}

template <class A, class Sink>
void warpAreaRow(const AreaSources<A, Sink>& sources, const glm::dvec3& start, int width,
  typename Sink::Pixel* out)
{
  constexpr int chunk = 256;
  A values[chunk];
  for (int x = 0; x < width; x += chunk)
  {
    const int n = std::min(chunk, width - x);
    sources.reduction == Reduction::Mean ? findAreaAverages(sources, start, x, n, values)
                                         : findAreaValues(sources, start, x, n, values);
    putValues(sources.images.front().sink, values, out + x, n);
  }
}

/// Of the shear pixels that a point's value is interpolated between, the nearest.
ShearPixel nearestPixel(const ShearImage& image, int number, const glm::dvec3& homogeneous,
  const std::function<bool(const ShearPixel&)>& hasSample)
{
  const glm::dvec2 p = glm::dvec2(homogeneous) / homogeneous.z;
  ShearPixel nearest;
  double lost = 0.0, largest = -1.0;
  forNeighbours(image, p,
    [&](int u, int v, double w)
    {
      const bool has = hasSample ? hasSample({ number, u, v })
                                 : image.winners[std::size_t(v) * image.width + u] >= 0;
      if (!has)
      {
        lost += w;
      }
      else if (w > largest)
      {
        largest = w;
        nearest = { number, u, v };
      }
    });
  return lost > 0.5 ? ShearPixel{} : nearest;
}

/// The pixels of a part of a viewport, of which `pixels` is the first and the next row lies a
/// stride further.
template <class A, class Sink>
void warpRows(const std::vector<WarpSource<A, Sink>>& sources, Reduction reduction,
  const Picture& place, typename Sink::Pixel* pixels, std::ptrdiff_t stride)
{
  const bool showsAreas = sources.front().geometry.isOverview();
  const AreaSources<A, Sink> areas(sources, reduction);
  vtkSMPTools::For(0, place.size.y, 16,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType y = first; y < last; ++y)
      {
        const glm::dvec3 start(place.origin.x, place.origin.y + static_cast<double>(y), 1.0);
        typename Sink::Pixel* const out = pixels + y * stride;
        showsAreas ? warpAreaRow(areas, start, place.size.x, out)
                   : warpRow(sources, start, static_cast<int>(y), place.size.x, out);
      }
    });
}

/// Corners of a rectangle of viewport pixels.
struct Rectangle
{
  glm::dvec2 low, high;
};

/// Has all pixels that an image shows something in, and perhaps some beside them.
Rectangle boundsOf(const ShearWarp& geometry, const glm::dvec2& viewport)
{
  if (!geometry.isPerspective() && !geometry.isOverview())
  {
    // What the image shows is symmetric about the middle of the volume.
    const Cuboid box = shownBox(geometry);
    const glm::dvec3 size = box.high - box.low;
    const glm::dvec2 s = glm::abs(geometry.shear());
    const glm::dvec2 half = 0.5 * (glm::dvec2(size) + s * size.z) / geometry.pitch();
    const glm::dvec3 centre = 0.5 * glm::dvec3(geometry.size() - 1);
    const glm::dmat3& m = geometry.shearToScreen();
    const glm::dvec2 middle(m * geometry.pixelOf(centre));
    const glm::dvec2 reach = glm::dvec2(glm::abs(m[0]) * half.x + glm::abs(m[1]) * half.y);
    return { middle - reach, middle + reach };
  }
  const glm::dvec2 last = viewport - 1.0;
  Rectangle bounds{ viewport, glm::dvec2(-2.0) };
  const Outline shown = geometry.isOverview() ? metByAreas(geometry) : shownBy(geometry);
  for (const glm::dvec3& corner :
    shown.cut({ { 0.0, 0.0, 1.0 }, { last.x, 0.0, 1.0 }, { last, 1.0 }, { 0.0, last.y, 1.0 } }))
  {
    bounds.low = glm::min(bounds.low, glm::dvec2(corner));
    bounds.high = glm::max(bounds.high, glm::dvec2(corner));
  }
  return bounds;
}
}

void placePicture(
  const std::vector<ShearWarp>& images, const glm::ivec2& viewport, Picture& picture)
{
  const glm::dvec2 limit(viewport);
  glm::dvec2 low = limit, high(0.0);
  for (const ShearWarp& image : images)
  {
    const Rectangle bounds = boundsOf(image, limit);
    low = glm::min(low, glm::clamp(glm::floor(bounds.low), glm::dvec2(0.0), limit));
    high = glm::max(high, glm::clamp(glm::ceil(bounds.high) + 1.0, glm::dvec2(0.0), limit));
  }
  picture.origin = glm::ivec2(low);
  picture.size = glm::max(glm::ivec2(high) - picture.origin, glm::ivec2(0));
}

void addSaturated(const Picture& layer, Picture& sum)
{
  const auto* const from = reinterpret_cast<const unsigned char*>(layer.pixels.data());
  auto* const to = reinterpret_cast<unsigned char*>(sum.pixels.data());
  vtkSMPTools::For(0, static_cast<vtkIdType>(4 * sum.pixels.size()), 1 << 16,
    [=](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType n = first; n < last; ++n)
      {
        to[n] = static_cast<unsigned char>(std::min(to[n] + from[n], 255));
      }
    });
}

void multiplyByOpacity(const Picture& opacity, Picture& picture)
{
  const auto* const from = reinterpret_cast<const unsigned char*>(opacity.pixels.data());
  auto* const to = reinterpret_cast<unsigned char*>(picture.pixels.data());
  vtkSMPTools::For(0, static_cast<vtkIdType>(picture.pixels.size()), 1 << 14,
    [=](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType n = 4 * first; n < 4 * last; ++n)
      {
        to[n] = static_cast<unsigned char>((to[n] * from[n | 3] + 127) / 255);
      }
    });
}

namespace
{
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
  typename Sink::Pixel* pixels, std::ptrdiff_t stride, const FieldRim& rim)
{
  using A = Accumulator<T>;
  std::vector<WarpSource<A, Sink>> sources;
  for (std::size_t n = 0; n < geometries.size(); ++n)
  {
    const A* const own = widenedPixels<T>(images[n], kernels, widened[n]);
    sources.emplace_back(sink, images[n], own, geometries[n], rim, n);
  }
  warpRows(sources, reduction, place, pixels, stride);
}
}

void Warper::warp(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
  Reduction reduction, const ColorTable& table, const glm::ivec2& viewport,
  InstructionSet instructionSet, Picture& picture, const FieldRim& rim)
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
        picture.pixels.data(), picture.size.x, rim);
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
  InstructionSet instructionSet, double background, void* scalars, const FieldRim& rim)
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
      warpImages<T>(
        images, geometries, reduction, kernels, sink, this->Widened, place, first, viewport.x, rim);
    });
}

namespace
{
/// Where pixels show areas: none of their samples is passed over for one beside them.
template <class T>
ShearPixel shownOfArea(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, const std::vector<Outline>& met, bool least,
  const glm::dvec3& pixel)
{
  AreaExtrema<Accumulator<T>> best;
  int sampled = -1, between = -1; // the images that they are of
  for (std::size_t n = 0; n < geometries.size(); ++n)
  {
    if (met[n].cut({ 0, 1 }, pixel).empty())
    {
      continue;
    }
    const auto found = PixelAreas<T>(images[n], images[n].row<T>(0))
                         .extrema(areaOf(geometries[n], pixel.x, pixel.y), least);
    sampled = best.sample.take(found.sample, least) ? static_cast<int>(n) : sampled;
    between = best.between.take(found.between, least) ? static_cast<int>(n) : between;
  }
  return sampled >= 0 ? ShearPixel{ sampled, best.sample.u, best.sample.v }
                      : ShearPixel{ between, best.between.u, best.between.v };
}

/// Of those that have one.
void findAreaPixels(const std::vector<ShearImage>& images, const std::vector<ShearWarp>& geometries,
  bool least, const glm::ivec2& origin, const glm::ivec2& size, ShearPixel* out)
{
  std::vector<Outline> met;
  for (const ShearWarp& geometry : geometries)
  {
    met.push_back(metByAreas(geometry));
  }
  dispatch(images.front().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      vtkSMPTools::For(0, size.y, 16,
        [&](vtkIdType first, vtkIdType last)
        {
          for (vtkIdType n = first * size.x; n < last * size.x; ++n)
          {
            const glm::dvec3 pixel(origin.x + static_cast<double>(n % size.x),
              origin.y + static_cast<double>(n / size.x), 1.0);
            const ShearPixel found = shownOfArea<T>(images, geometries, met, least, pixel);
            out[n] = found.image < 0 ? out[n] : found;
          }
        });
    });
}
}

void findShearPixels(const std::vector<ShearImage>& images,
  const std::vector<ShearWarp>& geometries, Reduction reduction, const glm::ivec2& origin,
  const glm::ivec2& size, ShearPixel* out, const std::function<bool(const ShearPixel&)>& hasSample)
{
  std::vector<Outline> shown;
  for (const ShearWarp& geometry : geometries)
  {
    shown.push_back(shownBy(geometry));
  }
  vtkSMPTools::For(0, size.y, 16,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType y = first; y < last; ++y)
      {
        // From the viewport's edge on, so that a pixel that two images show is the same one's in
        // any rectangle.
        const glm::dvec3 start(0.0, origin.y + static_cast<double>(y), 1.0);
        ShearPixel* const row = out + y * size.x;
        forSpans(
          geometries.size(), start, origin.x + size.x,
          [&](std::size_t n) -> const Outline& { return shown[n]; },
          [&](std::size_t n, const Span& span)
          {
            const glm::dmat3& m = geometries[n].screenToShear();
            for (int x = std::max(span.begin, origin.x); x < span.end; ++x)
            {
              row[x - origin.x] = nearestPixel(
                images[n], static_cast<int>(n), m * glm::dvec3(x, start.y, 1.0), hasSample);
            }
          },
          [&](const Span& span)
          {
            for (int x = std::max(span.begin, origin.x); x < span.end; ++x)
            {
              row[x - origin.x] = ShearPixel{};
            }
          });
      }
    });
  if (!geometries.empty() && geometries.front().isOverview())
  {
    findAreaPixels(images, geometries, reduction == Reduction::Minimum, origin, size, out);
  }
}
}
