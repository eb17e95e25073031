// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Warp.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace splatting
{
namespace
{
/**
 * What a box, seen along the shear, covers of the shear image: a hexagon, symmetric about the
 * image's middle.
 */
class Silhouette
{
public:
  /// `size` is the box's in voxels; `inset` keeps points off the rim by so many pixels along u and
  /// v.
  Silhouette(const ShearWarp& geometry, const glm::dvec3& size, double inset)
    : Centre(0.5 * (geometry.width() - 1), 0.5 * (geometry.height() - 1)),
      Shear(geometry.shear())
  {
    const glm::dvec2 s(std::abs(this->Shear.x), std::abs(this->Shear.y));
    this->Half = { 0.5 * (size.x + s.x * size.z) - inset, 0.5 * (size.y + s.y * size.z) - inset };
    this->HalfAcross = 0.5 * (s.y * size.x + s.x * size.y) - (s.x + s.y) * inset;
  }

  const glm::dvec2& half() const { return this->Half; }

  /// The x in `row` whose points start + x step lie in the hexagon.
  Span cut(Span row, const glm::dvec2& start, const glm::dvec2& step) const
  {
    const glm::dvec2 p = start - this->Centre;
    row = within(row, p.x, step.x, this->Half.x);
    row = within(row, p.y, step.y, this->Half.y);
    return within(row, this->Shear.y * p.x - this->Shear.x * p.y,
      this->Shear.y * step.x - this->Shear.x * step.y, this->HalfAcross);
  }

private:
  /// The x in `row` with |at + x step| <= bound.
  static Span within(Span row, double at, double step, double bound)
  {
    // Rims that fall on pixel centres must not flicker with rounding errors.
    bound += 1e-9 * (1.0 + std::abs(bound));
    if (bound < 0.0)
    {
      return {};
    }
    if (std::abs(step) * (row.end - row.begin) < 1e-12)
    {
      return std::abs(at) <= bound ? row : Span{};
    }
    const double a = (-bound - at) / step, b = (bound - at) / step;
    const double limitLow = row.begin, limitHigh = row.end;
    row.begin = static_cast<int>(std::ceil(std::clamp(std::min(a, b), limitLow, limitHigh)));
    row.end =
      static_cast<int>(std::floor(std::clamp(std::max(a, b), limitLow - 1.0, limitHigh - 1.0))) + 1;
    return row;
  }

  glm::dvec2 Centre, Shear, Half;
  double HalfAcross;
};

/// The box that the picture shows: all of the voxels' boxes, or voxel centre to voxel centre and a
/// single voxel's whole thickness.
glm::dvec3 shownSize(const ShearWarp& geometry)
{
  return glm::dvec3(
    geometry.showsBoxes() ? geometry.size() : glm::max(geometry.size() - 1, glm::ivec3(1)));
}

/// Everything that the rows of one picture share.
template <class A>
struct WarpFrame
{
  const ShearImage& image;
  const A* pixels;
  const WorksheetLoops<A>& loops;
  const ColorTable& table;
  A low, scale;
  std::int32_t last;

  void lookUp(const A* values, std::uint32_t* out, std::ptrdiff_t n) const
  {
    this->loops.lookUp(
      values, this->low, this->scale, this->last, this->table.colors.data(), out, n);
  }
};

/// Where all four neighbours of all points are samples.
template <class A>
void warpInside(const WarpFrame<A>& frame, const glm::dvec2& start, const glm::dvec2& step,
  std::uint32_t* out, int n)
{
  constexpr int chunk = 256; // stays in the first-level cache
  A values[chunk];
  for (int x = 0; x < n; x += chunk)
  {
    const int count = std::min(chunk, n - x);
    const glm::dvec2 p = start + double(x) * step;
    frame.loops.interpolate(frame.pixels, frame.image.width, &p.x, &step.x, values, count);
    frame.lookUp(values, out + x, count);
  }
}

/// Where a neighbour may be missing, NaN or infinite: interpolates between those that count.
template <class A>
std::uint32_t warpPoint(const WarpFrame<A>& frame, const glm::dvec2& p)
{
  const int u = static_cast<int>(std::floor(p.x)), v = static_cast<int>(std::floor(p.y));
  const double fu = p.x - u, fv = p.y - v;
  double sum = 0.0, weight = 0.0, lost = 0.0, largest = -1.0;
  A nearest = 0;
  for (int n = 0; n < 4; ++n)
  {
    const int i = n & 1, j = n >> 1;
    if (!frame.image.meetsVolume(u + i, v + j))
    {
      continue;
    }
    const A value = frame.pixels[std::ptrdiff_t(v + j) * frame.image.width + u + i];
    const double w = (i ? fu : 1.0 - fu) * (j ? fv : 1.0 - fv);
    if (value != value || !frame.image.covers(u + i, v + j))
    {
      lost += w;
      continue;
    }
    sum += w * value;
    weight += w;
    if (w > largest)
    {
      largest = w;
      nearest = value;
    }
  }
  // Where samples are missing inside the volume, the picture ends half-way to the last one; at the
  // volume's rim it ends with the silhouette.
  if (weight <= 0.0 || lost > 0.5)
  {
    return 0;
  }
  const double average = sum / weight;
  const A value = std::isfinite(average) ? static_cast<A>(average) : nearest;
  std::uint32_t color;
  frame.lookUp(&value, &color, 1);
  return color;
}

template <class A>
void warpRows(const WarpFrame<A>& frame, const ShearWarp& geometry, Picture& picture)
{
  const Silhouette shown(geometry, shownSize(geometry), 0.0);
  // Pixels are samples inside the silhouette of the voxels' boxes; a point's neighbours are at most
  // one pixel away.
  const Silhouette inside(geometry, glm::dvec3(geometry.size()), 1.0 + 1e-6);
  const bool holes = !frame.image.mask.empty() || frame.image.special;
  const glm::dmat3& m = geometry.screenToShear();
  const glm::dvec2 step(m[0]);
  vtkSMPTools::For(0, picture.size.y, 16,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType y = first; y < last; ++y)
      {
        const glm::dvec2 start(
          m * glm::dvec3(picture.origin.x, picture.origin.y + static_cast<double>(y), 1.0));
        std::uint32_t* const out = picture.pixels.data() + y * picture.size.x;
        const Span row = shown.cut({ 0, picture.size.x }, start, step);
        const Span plain = holes || row.empty() ? Span{} : inside.cut(row, start, step);
        const int plainBegin = plain.empty() ? row.end : plain.begin;
        const int plainEnd = plain.empty() ? row.end : plain.end;
        std::fill(out, out + std::max(row.begin, 0), 0u);
        for (int x = row.begin; x < plainBegin; ++x)
        {
          out[x] = warpPoint(frame, start + double(x) * step);
        }
        warpInside(
          frame, start + double(plainBegin) * step, step, out + plainBegin, plainEnd - plainBegin);
        for (int x = plainEnd; x < row.end; ++x)
        {
          out[x] = warpPoint(frame, start + double(x) * step);
        }
        std::fill(out + std::max(row.end, row.begin), out + picture.size.x, 0u);
      }
    });
}
}

void placePicture(const ShearWarp& geometry, const glm::ivec2& viewport, Picture& picture)
{
  const glm::dvec2 half = Silhouette(geometry, shownSize(geometry), 0.0).half();
  const glm::dvec2 centre(0.5 * (geometry.width() - 1), 0.5 * (geometry.height() - 1));
  const glm::dmat3& m = geometry.shearToScreen();
  const glm::dvec2 middle(m * glm::dvec3(centre, 1.0));
  const glm::dvec2 reach = glm::dvec2(glm::abs(m[0]) * half.x + glm::abs(m[1]) * half.y);
  for (int a = 0; a < 2; ++a)
  {
    const double limit = viewport[a];
    const int low = static_cast<int>(std::clamp(std::floor(middle[a] - reach[a]), 0.0, limit));
    const int high =
      static_cast<int>(std::clamp(std::ceil(middle[a] + reach[a]) + 1.0, 0.0, limit));
    picture.origin[a] = low;
    picture.size[a] = std::max(high - low, 0);
  }
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

void Warper::warp(const ShearImage& image, const ShearWarp& geometry, const ColorTable& table,
  const glm::ivec2& viewport, InstructionSet instructionSet, Picture& picture)
{
  placePicture(geometry, viewport, picture);
  picture.pixels.resize(std::size_t(picture.size.x) * picture.size.y);
  if (picture.pixels.empty())
  {
    return;
  }
  const Kernels& kernels = kernelsFor(instructionSet);
  dispatch(image.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      using A = Accumulator<T>;
      const A* pixels = nullptr;
      if constexpr (std::is_same_v<T, A>)
      {
        pixels = image.row<T>(0);
      }
      else
      {
        const std::size_t count = std::size_t(image.width) * image.height;
        this->Widened.resize(count * sizeof(A));
        A* const widened = reinterpret_cast<A*>(this->Widened.data());
        const VoxelLoops<T>& loops = kernels;
        loops.widen(image.row<T>(0), 0, widened, 0, A(0), static_cast<std::ptrdiff_t>(count), 1);
        pixels = widened;
      }
      const std::int32_t last = static_cast<std::int32_t>(table.colors.size()) - 1;
      const double scale = table.high > table.low ? last / (table.high - table.low) : 0.0;
      const WarpFrame<A> frame{ image, pixels, kernels, table, static_cast<A>(table.low),
        static_cast<A>(scale), last };
      warpRows(frame, geometry, picture);
    });
}
}
