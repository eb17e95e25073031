// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Display/Locations.h"

#include "Cells/CellScreen.h"
#include "Common/Parallel.h"
#include "Splat/Sampling/ValuesAtLocations.h"
#include "Splat/Warp/Warp.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <limits>

namespace splatting
{
namespace
{
/**
 * The voxel of a slice that contributes most to a footprint. A voxel can occur more than once, if
 * footprints extend beyond the volume or have parts.
 */
class LargestShare
{
public:
  void add(const glm::ivec2& voxel, double weight, double value)
  {
    int n = 0;
    while (n < this->Count && this->Items[n].voxel != voxel)
    {
      ++n;
    }
    if (n == this->Count && n < static_cast<int>(this->Items.size()))
    {
      this->Items[this->Count++] = { voxel, 0.0, value };
    }
    if (n < this->Count)
    {
      this->Items[n].weight += weight;
    }
  }

  /// @param from  the value that contributes nothing
  glm::ivec2 voxel(double from) const
  {
    glm::ivec2 best(-1);
    double most = -1.0, heaviest = -1.0;
    for (int n = 0; n < this->Count; ++n)
    {
      const Item& item = this->Items[n];
      const double share = item.weight * std::abs(item.value - from);
      if (share > most || (share == most && item.weight > heaviest))
      {
        best = item.voxel;
        most = share;
        heaviest = item.weight;
      }
    }
    return best;
  }

private:
  struct Item
  {
    glm::ivec2 voxel{ -1 };
    double weight, value;
  };
  std::array<Item, 128> Items;
  int Count = 0;
};

/// Finds the voxels of the winners of a shear image, with (i, j, k) permuted like its axes.
template <class T>
class VoxelFinder
{
public:
  using A = Accumulator<T>;

  VoxelFinder(const Located& located, const ShearWarp& geometry, bool minima, GeneralTable& table)
    : Source(located),
      From(minima || located.settings.reduction == Reduction::Minimum ? located.high : located.low),
      Geometry(geometry),
      Voxels(located.volume, Geometry)
  {
    for (int k = 0; k < geometry.size().z && !geometry.isPerspective(); ++k)
    {
      this->Paths.push_back(geometry.rayPath(k));
    }
    const ProjectionSettings& settings = located.settings;
    const bool standard = settings.quality == Quality::Standard;
    const Kernel kernel = standard ? Kernel{ Reconstruction::Box } : settings.kernel;
    if (standard || settings.quality == Quality::High)
    {
      this->Geometry.isPerspective()
        ? this->Own.find(
            this->Geometry, this->Geometry, kernel, kernelsFor(settings.instructionSet))
        : findFootprints(this->Geometry, kernel, settings.footprintSampling, weightBits<T>, table,
            this->Footprints);
    }
  }

  glm::ivec3 find(int u, int v, int step) const
  {
    const int k = step / StepsPerSlice;
    if (!this->Source.volume.voxels && this->Source.settings.quality != Quality::Preview)
    {
      return this->inMiddle(u, v, k);
    }
    return this->Source.settings.quality == Quality::Preview
      ? this->onPath(u, v, k, step % StepsPerSlice)
      : glm::ivec3(this->inFootprint(u, v, k), k);
  }

  glm::ivec3 inMiddle(int u, int v, int k) const
  {
    const glm::ivec2 voxel(glm::round(this->Geometry.onRay(u, v, k)));
    return { glm::clamp(voxel, glm::ivec2(0), glm::ivec2(this->Geometry.size()) - 1), k };
  }

private:
  static constexpr int MostReach = 3; ///< of a footprint, from its nearest voxel

  glm::ivec3 onPath(int u, int v, int k, int t) const
  {
    if (this->Geometry.isPerspective())
    {
      const RayPath path = this->Geometry.voxelsOnRay(u, v, k);
      return { path.di[t], path.dj[t], k };
    }
    const RayPath& path = this->Paths[k];
    return { u + path.di[t], v + path.dj[t], k };
  }

  glm::ivec2 inFootprint(int u, int v, int k) const
  {
    const glm::ivec3 last = this->Geometry.size() - 1;
    if (!this->Geometry.isPerspective())
    {
      const glm::ivec2 low = glm::ivec2(u, v) - this->Footprints[k].nearest - MostReach;
      const glm::ivec2 high = low + 2 * MostReach;
      if (low.x >= 0 && low.y >= 0 && high.x <= last.x && high.y <= last.y && k > 0 && k < last.z)
      {
        return this->inWholeFootprint(u, v, k);
      }
    }
    // The outermost voxels and slices are repeated beyond the border.
    LargestShare shares;
    const auto add = [&](int i, int j, int slice, double weight)
    {
      const glm::ivec3 voxel = glm::clamp(glm::ivec3(i, j, slice), glm::ivec3(0), last);
      const T value = this->Voxels.at(voxel.x, voxel.y, k);
      if (voxel.z == k && weight > 0.0 && value == value)
      {
        shares.add(glm::ivec2(voxel), weight, static_cast<double>(value));
      }
    };
    if (this->Geometry.isPerspective())
    {
      this->Own.forVoxels(
        u, v, k, [&](int i, int j, int slice, double weight) { add(i, j, slice, weight); });
    }
    else
    {
      const SliceFootprint<A>& footprint = this->Footprints[k];
      for (int t = 0; t < footprint.taps.size(); ++t)
      {
        const Tap& tap = footprint.taps[t];
        add(u - footprint.nearest.x + tap.di, v - footprint.nearest.y + tap.dj, k + tap.slice,
          footprint.weights[t]);
      }
    }
    return shares.voxel(this->From);
  }

  /// For footprints of parallel views inside the volume, in which each voxel occurs once.
  glm::ivec2 inWholeFootprint(int u, int v, int k) const
  {
    const SliceFootprint<A>& footprint = this->Footprints[k];
    const glm::ivec2 middle = glm::ivec2(u, v) - footprint.nearest;
    const T* const voxels = this->Voxels.pointer(middle.x, middle.y, k);
    glm::ivec2 best(-1);
    double most = -1.0, heaviest = -1.0;
    for (int t = 0; t < footprint.taps.size(); ++t)
    {
      const Tap& tap = footprint.taps[t];
      if (tap.slice != 0)
      {
        continue;
      }
      const double value = static_cast<double>(voxels[this->Voxels.place(tap.di, tap.dj, 0)]);
      const double weight = footprint.weights[t], share = weight * std::abs(value - this->From);
      if (share > most || (share == most && weight > heaviest))
      {
        best = middle + glm::ivec2(tap.di, tap.dj);
        most = share;
        heaviest = weight;
      }
    }
    return best;
  }

  const Located& Source;
  const double From; ///< the value that contributes nothing
  const ShearWarp& Geometry;
  PermutedVoxels<T> Voxels;
  std::vector<RayPath> Paths; ///< of parallel views
  std::vector<SliceFootprint<A>> Footprints;
  PerspectiveFootprints<A> Own;
};

/// To the order of the volume's axes.
glm::ivec3 unpermuted(const ShearWarp& geometry, const glm::ivec3& voxel)
{
  glm::ivec3 result;
  for (int a = 0; a < 3; ++a)
  {
    result[geometry.axes()[a]] = voxel[a];
  }
  return result;
}

/// The voxel of a shear pixel with a winner.
glm::ivec3 findVoxel(const Located& located, const ShearPixel& pixel)
{
  const ShearImage& projected = pixel.of(*located.images);
  const ShearWarp& geometry = (*located.geometries)[pixel.image];
  const int step = projected.winners[std::size_t(pixel.v) * projected.width + pixel.u];
  ShearWarp alone;
  geometry.takePixel({ pixel.u, pixel.v }, alone);
  return dispatch(located.volume.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      GeneralTable table;
      return unpermuted(
        alone, VoxelFinder<T>(located, alone, pixel.minimum, table).find(0, 0, step));
    });
}

double valueOf(const CellScreen& screen, const glm::ivec2& pixel)
{
  const glm::ivec2 place = pixel - screen.origin;
  return screen.type == ScalarType::Float32 ? screen.row<float>(place.y)[place.x]
                                            : screen.row<double>(place.y)[place.x];
}
}

void findShown(const Located& located, const glm::ivec2& origin, const glm::ivec2& size,
  ShearPixel* out, const std::function<bool(const ShearPixel&)>& hasSample)
{
  const std::vector<ShearImage>& images = *located.images;
  const std::vector<ShearWarp>& geometries = *located.geometries;
  const ProjectionSettings& settings = located.settings;
  if (settings.reduction != Reduction::Signed)
  {
    findShearPixels(images, geometries, settings.reduction, origin, size, out, hasSample);
    return;
  }
  findShearPixels(images, geometries, Reduction::Maximum, origin, size, out, hasSample);
  std::vector<ShearPixel> minima(std::size_t(size.x) * size.y);
  findShearPixels(images, geometries, Reduction::Minimum, origin, size, minima.data(), hasSample);
  // The same values as in the picture, to the last bit. Those below the origin are minima.
  WarpedScalars warped;
  warped.set(
    images, geometries, settings.reduction, located.view.viewport, settings.instructionSet);
  const auto choose = [&](auto null)
  {
    using A = decltype(null);
    const glm::ivec2 first = glm::max(origin, warped.origin),
                     end = glm::min(origin + size, warped.origin + warped.size);
    parallelFor(first.y, end.y, 16,
      [&](std::ptrdiff_t from, std::ptrdiff_t to)
      {
        std::vector<A> space(warped.size.x);
        for (int y = static_cast<int>(from); y < to; ++y)
        {
          const A* const values =
            static_cast<const A*>(warped.valuesOfRow(y - warped.origin.y, space.data()));
          for (int x = first.x; x < end.x; ++x)
          {
            const std::size_t n = std::size_t(y - origin.y) * size.x + x - origin.x;
            out[n] = values[x - warped.origin.x] < settings.origin ? minima[n] : out[n];
          }
        }
      });
  };
  warped.type == ScalarType::Float32 ? choose(0.0f) : choose(0.0);
}

double valueOf(const std::vector<ShearImage>& images, const ShearPixel& pixel)
{
  const ShearImage& image = pixel.of(images);
  return dispatch(image.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      return static_cast<double>(image.row<T>(pixel.v)[pixel.u]);
    });
}

void findVoxels(
  const Located& located, std::size_t image, std::vector<glm::ivec3>& voxels, bool minima)
{
  const ShearImage& projected = (*located.images)[image].ofExtremum(minima);
  const ShearWarp& geometry = (*located.geometries)[image];
  voxels.assign(projected.winners.size(), glm::ivec3(-1));
  dispatch(located.volume.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      GeneralTable table;
      const VoxelFinder<T> finder(located, geometry, minima, table);
      parallelFor(0, projected.height, 8,
        [&](std::ptrdiff_t first, std::ptrdiff_t last)
        {
          for (int v = static_cast<int>(first); v < last; ++v)
          {
            for (int u = 0; u < projected.width; ++u)
            {
              const std::size_t at = std::size_t(v) * projected.width + u;
              if (projected.winners[at] >= 0)
              {
                voxels[at] = unpermuted(geometry, finder.find(u, v, projected.winners[at]));
              }
            }
          }
        });
    });
}

Locator::Locator(const Located& located) : Source(located) {}

/// The point of the sample of a shear pixel with a winner.
glm::dvec3 Locator::point(const glm::dvec2& pixel, const ShearPixel& shown) const
{
  const ShearImage& image = shown.of(*this->Source.images);
  const int step = image.winners[std::size_t(shown.v) * image.width + shown.u];
  return this->pointAt(pixel, shown, step / StepsPerSlice);
}

Locator::Sample Locator::at(const glm::ivec2& pixel) const
{
  if (this->Source.screen)
  {
    Sample sample = this->onScreen(pixel);
    sample.value = sample.exists ? valueOf(*this->Source.screen, pixel) : sample.value;
    return sample;
  }
  ShearPixel shown;
  findShown(this->Source, pixel, glm::ivec2(1), &shown);
  return this->at(pixel, shown);
}

Locator::Sample Locator::at(const glm::ivec2& pixel, const ShearPixel& shown) const
{
  Sample sample;
  sample.exists = shown.image >= 0;
  if (sample.exists)
  {
    sample.point = this->point(glm::dvec2(pixel), shown);
    sample.voxel = findVoxel(this->Source, shown);
    sample.value = valueOf(*this->Source.images, shown);
  }
  return sample;
}

/// The sample of a pixel in an exact projection, without its value.
Locator::Sample Locator::onScreen(const glm::ivec2& pixel) const
{
  const CellScreen& screen = *this->Source.screen;
  const glm::ivec2 p = pixel - screen.origin;
  Sample sample;
  if (p.x >= 0 && p.y >= 0 && p.x < screen.size.x && p.y < screen.size.y)
  {
    const float depth = screen.depths[std::size_t(p.y) * screen.size.x + p.x];
    sample.exists = depth == depth;
    sample.point = screen.rays.point(pixel.x, pixel.y, depth);
    sample.voxel = glm::clamp(
      glm::round(sample.point), glm::dvec3(0.0), glm::dvec3(this->Source.view.dimensions - 1));
  }
  return sample;
}

/// The point of a pixel's ray at a depth along the principal axis.
glm::dvec3 Locator::pointAt(const glm::dvec2& pixel, const ShearPixel& shown, double z) const
{
  const ShearWarp& geometry = (*this->Source.geometries)[shown.image];
  if (geometry.isPerspective())
  {
    constexpr double nearest = 1e-6;
    z = geometry.reversed() ? std::min(z, geometry.eye().z - nearest)
                            : std::max(z, geometry.eye().z + nearest);
  }
  if (geometry.minifiesAnyAxis())
  {
    const glm::dvec2 at = geometry.onRay(shown.u, shown.v, z);
    glm::dvec3 point;
    for (int a = 0; a < 3; ++a)
    {
      point[geometry.axes()[a]] = a < 2 ? at[a] : z;
    }
    return point;
  }
  // The ray is the intersection of the planes of the pixel's column and row. They do not use clip
  // depths, which would lose digits.
  const std::array<int, 3>& axes = geometry.axes();
  const glm::dvec2 clip = (2.0 * pixel + 1.0) / glm::dvec2(this->Source.view.viewport) - 1.0;
  const glm::dmat4 rows = glm::transpose(this->Source.view.indexToClip);
  const glm::dvec4 x = rows[0] - clip.x * rows[3], y = rows[1] - clip.y * rows[3];
  const double p = -(x[axes[2]] * z + x.w), q = -(y[axes[2]] * z + y.w);
  const double determinant = x[axes[0]] * y[axes[1]] - x[axes[1]] * y[axes[0]];
  glm::dvec3 point;
  point[axes[0]] = (p * y[axes[1]] - q * x[axes[1]]) / determinant;
  point[axes[1]] = (q * x[axes[0]] - p * y[axes[0]]) / determinant;
  point[axes[2]] = z;
  return point;
}

glm::dvec3 Locator::inWorld(const glm::dvec3& point) const
{
  return glm::dvec3(this->Source.indexToWorld * glm::dvec4(point, 1.0));
}

double Locator::depth(const glm::dvec3& world) const
{
  const glm::dvec3 way = world - this->Source.camera;
  return isParallel(this->Source.view) ? glm::dot(way, this->Source.direction) : glm::length(way);
}

glm::dvec2 Locator::depthRange() const
{
  const bool parallel = isParallel(this->Source.view);
  glm::dvec2 range(std::numeric_limits<double>::infinity(), 0.0);
  for (int n = 0; n < 8; ++n)
  {
    const glm::dvec3 corner =
      glm::dvec3(n & 1, n >> 1 & 1, n >> 2) * glm::dvec3(this->Source.view.dimensions - 1);
    const double depth = this->depth(this->inWorld(corner));
    range = { std::min(range.x, depth), std::max(range.y, depth) };
  }
  if (!parallel)
  {
    // The nearest point of a box need not be a corner.
    const glm::dvec3 eye =
      glm::dvec3(glm::inverse(this->Source.indexToWorld) * glm::dvec4(this->Source.camera, 1.0));
    const glm::dvec3 nearest =
      glm::clamp(eye, glm::dvec3(0.0), glm::dvec3(this->Source.view.dimensions - 1));
    range.x = std::min(range.x, this->depth(this->inWorld(nearest)));
  }
  return range;
}

void Locator::put(std::size_t at, const Sample& sample, const Arrays& arrays) const
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const bool has = sample.exists;
  const glm::dvec3 world = has ? this->inWorld(sample.point) : glm::dvec3(none);
  if (arrays.voxels)
  {
    const glm::ivec3 voxel = has ? sample.voxel : glm::ivec3(-1);
    std::copy(&voxel.x, &voxel.x + 3, arrays.voxels + 3 * at);
  }
  if (arrays.depths)
  {
    arrays.depths[at] = static_cast<float>(has ? this->depth(world) : none);
  }
  if (arrays.positions)
  {
    std::copy(&world.x, &world.x + 3, arrays.positions + 3 * at);
  }
  if (arrays.clipDepths)
  {
    const glm::dvec4 clip = this->Source.view.indexToClip * glm::dvec4(sample.point, 1.0);
    arrays.clipDepths[at] = static_cast<float>(has ? 0.5 * clip.z / clip.w + 0.5 : none);
  }
}

void Locator::fill(const glm::ivec2& origin, const glm::ivec2& size, const Arrays& arrays) const
{
  if (this->Source.screen)
  {
    this->fillFrom(origin, size, arrays,
      [&](const glm::ivec2& pixel, std::size_t) { return this->onScreen(pixel); });
    return;
  }
  std::vector<ShearPixel> shown(std::size_t(size.x) * size.y);
  findShown(this->Source, origin, size, shown.data());
  // Of each image those of maxima, and in Reduction::Signed those of minima.
  const bool areTwo = this->Source.settings.reduction == Reduction::Signed;
  std::array<std::vector<std::vector<glm::ivec3>>, 2> voxels;
  for (std::size_t n = 0; arrays.voxels && n < this->Source.geometries->size(); ++n)
  {
    for (int minima = 0; minima < (areTwo ? 2 : 1); ++minima)
    {
      findVoxels(this->Source, n, voxels[minima].emplace_back(), minima != 0);
    }
  }
  this->fillFrom(origin, size, arrays,
    [&](const glm::ivec2& pixel, std::size_t at)
    {
      const ShearPixel& from = shown[at];
      Sample sample;
      sample.exists = from.image >= 0;
      if (sample.exists)
      {
        const int width = (*this->Source.images)[from.image].width;
        sample.point = this->point(glm::dvec2(pixel), from);
        sample.voxel = arrays.voxels
          ? voxels[areTwo && from.minimum][from.image][std::size_t(from.v) * width + from.u]
          : glm::ivec3(-1);
      }
      return sample;
    });
}

template <class F>
void Locator::fillFrom(
  const glm::ivec2& origin, const glm::ivec2& size, const Arrays& arrays, F&& sampleOf) const
{
  parallelFor(0, size.y, 8,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t y = first; y < last; ++y)
      {
        for (int x = 0; x < size.x; ++x)
        {
          const std::size_t at = std::size_t(y) * size.x + x;
          this->put(at, sampleOf(origin + glm::ivec2(x, y), at), arrays);
        }
      }
    });
}
}
