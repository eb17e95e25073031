// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Random scenes for the engine of exact projections, and how each of their pixels is compared with
 * the oracle.
 */
#ifndef CellTesting_h
#define CellTesting_h

#include "CellOracle.h"
#include "CoreTesting.h"

#include "Cells/CellProjector.h"
#include "Clipping/ClosedSurface.h"
#include "Clipping/SceneDepth.h"

#include <glm/geometric.hpp>
#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtx/string_cast.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace celltesting
{
using reference::Checks;
using reference::Random;
using splatting::CellScreen;
using splatting::ProjectionSettings;
using splatting::Reduction;
using splatting::View;

/// What the oracle computes with.
template <class T>
using Real =
  std::conditional_t<std::is_same_v<splatting::Accumulator<T>, float>, double, long double>;

/// Largest error as a share of the volume's range: by definition of the exact mode.
template <class T>
constexpr double Bound = std::is_same_v<splatting::Accumulator<T>, float> ? 1e-6 : 1e-12;

/// A pixel is ambiguous if a ray this many voxels beside its own shows something else.
template <class T>
constexpr double Beside = std::is_same_v<splatting::Accumulator<T>, float> ? 0x1p-20 : 1e-12;

/// How precisely the places of a ray are known, in voxels.
template <class T>
constexpr double Precision = std::is_same_v<splatting::Accumulator<T>, float> ? 0x1p-21 : 0x1p-44;

/// Something to project.
template <class T>
struct Scene
{
  reference::Volume<T> volume;
  View view;
  ProjectionSettings settings;
  std::vector<glm::dvec3> points; ///< of a closed surface
  std::vector<glm::ivec3> triangles;
  std::vector<float> depths; ///< of all pixels of the viewport
  bool locate = false;
};

/// The engine's picture of a scene, the ends of rays made anew.
template <class T>
class Engine
{
public:
  explicit Engine(const Scene<T>& scene) : Source(scene)
  {
    const reference::Volume<T>& volume = scene.volume;
    const splatting::VoxelArray voxels{ volume.voxels.data(), splatting::scalarTypeOf<T>(),
      coretesting::toGlm(volume.size) };
    splatting::VolumeIndex whole;
    whole.reset(voxels);
    this->Range = whole.range();
    this->Index.update(
      splatting::CellGrid(voxels, glm::ivec3(0), voxels.dimensions, scene.view.showsBoxes),
      this->Range);
    if (!scene.triangles.empty())
    {
      this->Surface.reset(scene.points, scene.triangles);
      this->Ends.surface = &this->Surface;
    }
    if (!scene.depths.empty())
    {
      std::copy(scene.depths.begin(), scene.depths.end(),
        this->Depth.allocate(glm::ivec2(0), scene.view.viewport));
      this->Depth.place(scene.view);
      this->Ends.depth = &this->Depth;
    }
  }

  const splatting::VolumeIndex::Range& range() const { return this->Range; }
  const splatting::RayEnds& ends() const { return this->Ends; }

  bool project(CellScreen& screen)
  {
    return this->Projector.project(this->Index, this->Source.view, this->Source.settings,
      this->Ends, this->Source.locate, screen);
  }
  bool project(const glm::ivec2 (&within)[2], CellScreen& screen)
  {
    return this->Projector.project(this->Index, this->Source.view, this->Source.settings,
      this->Ends, this->Source.locate, within, screen);
  }

private:
  const Scene<T>& Source;
  splatting::VolumeIndex::Range Range;
  splatting::CellIndex Index;
  splatting::ClosedSurface Surface;
  splatting::SceneDepth Depth;
  splatting::RayEnds Ends;
  splatting::CellProjector Projector;
};

/// A pixel of the viewport; NaN outside of the rectangle.
template <class A>
A valueAt(const CellScreen& screen, int x, int y)
{
  const glm::ivec2 p = glm::ivec2(x, y) - screen.origin;
  const bool isIn = p.x >= 0 && p.y >= 0 && p.x < screen.size.x && p.y < screen.size.y;
  return isIn ? screen.row<A>(p.y)[p.x] : std::numeric_limits<A>::quiet_NaN();
}

inline float depthAt(const CellScreen& screen, int x, int y)
{
  const glm::ivec2 p = glm::ivec2(x, y) - screen.origin;
  return screen.depths[std::size_t(p.y) * screen.size.x + p.x];
}

/// What was compared, and how far it was off.
struct Counts
{
  long pixels = 0, samples = 0, ambiguous = 0;
  double worst = 0.0; ///< error as a share of the bound

  void add(const Counts& other)
  {
    this->pixels += other.pixels;
    this->samples += other.samples;
    this->ambiguous += other.ambiguous;
    this->worst = std::max(this->worst, other.worst);
  }
  /// Ambiguous pixels lie on curves: the outlines of the volume and of cuts, and where octants or
  /// the shades of cells meet. Four of them cross a picture, unless all rays run along faces.
  bool isAmbiguous() const
  {
    return this->ambiguous > 4.0 * 2.0 * std::sqrt(static_cast<double>(this->pixels));
  }
  /// Prints them, and checks that there is something to compare.
  void report(const std::string& family, Checks& check) const
  {
    std::cout << std::left << std::setw(28) << family << " pixels " << this->pixels << ", samples "
              << this->samples << ", ambiguous " << this->ambiguous << ", worst error "
              << std::setprecision(3) << this->worst << " of the bound" << std::endl;
    check(this->samples > 0 || !reference::onlyScene().empty(), family, ": nothing is seen");
  }
};

/// Whether neighbouring rays show nearly the same.
enum Continuity
{
  Continuous,
  Discontinuous
};

/// Compares random scenes, each by f(random, counts), and reports what has been compared.
template <class T, class F>
void forFamily(const std::string& family, int scenes, Continuity continuity, Checks& check, F&& f)
{
  const std::string name = coretesting::seriesOf<T>(family);
  Counts counts;
  int all = 0, ambiguous = 0;
  reference::forScenes(name, scenes,
    [&](int, Random& random)
    {
      Counts scene;
      f(random, scene);
      counts.add(scene);
      ++all;
      ambiguous += scene.isAmbiguous();
    });
  counts.report(name, check);
  // About one of 300 random views of discontinuous pictures is ambiguous as a whole.
  check(continuity == Continuous ? ambiguous == 0 : 4 * ambiguous <= all + 4, name, ": ", ambiguous,
    " of ", all, " pictures are ambiguous");
}

template <class T>
reference::CellScene<Real<T>> oracleScene(const Scene<T>& scene)
{
  reference::CellScene<Real<T>> result;
  result.size = coretesting::toGlm(scene.volume.size);
  result.voxels.assign(scene.volume.voxels.begin(), scene.volume.voxels.end());
  for (int c = 0; c < 4; ++c)
  {
    for (int r = 0; r < 4; ++r)
    {
      result.indexToClip[c][r] = scene.view.indexToClip[c][r];
    }
  }
  result.viewport = scene.view.viewport;
  result.showsBoxes = scene.view.showsBoxes;
  result.halfSpaces = scene.view.halfSpaces;
  result.planes = scene.view.cropping.planes;
  result.flags = scene.view.cropping.flags;
  for (const glm::ivec3& t : scene.triangles)
  {
    result.triangles.push_back({ scene.points[t[0]], scene.points[t[1]], scene.points[t[2]] });
  }
  result.depths = scene.depths;
  return result;
}

/// Compares the pixels of one scene.
template <class T>
class Comparison
{
public:
  using A = splatting::Accumulator<T>;
  using R = Real<T>;
  using Sample = reference::CellSample<R>;

  Comparison(const Scene<T>& scene, const splatting::VolumeIndex::Range& range, Checks& check)
    : Source(scene),
      Plain(oracleScene(scene)),
      Oracle(Plain),
      Coarse(Plain, 8.0 * Beside<T>),
      Check(check)
  {
    const bool isFinite = range.low <= range.high && !range.hasInfinities();
    R low = std::numeric_limits<R>::infinity(), high = -low;
    for (const R voxel : this->Plain.voxels)
    {
      low = std::isfinite(voxel) ? std::min(low, voxel) : low;
      high = std::isfinite(voxel) ? std::max(high, voxel) : high;
    }
    this->Low = low <= high ? low : 0;
    this->Range = low <= high ? high - low : 0;
    this->Lowest = isFinite ? range.low : 0.0;
    // Values are computed from the lowest voxel on, and added to it in the end.
    const R largest = low <= high ? std::max(std::fabs(low), std::fabs(high)) : R(0);
    const R spread = range.hasInfinities() ? 2 * largest : this->Range;
    this->Fall = static_cast<double>(0x1p-40 * spread + 0x1p-48 * largest);
    this->Tolerance = Bound<T> * this->Range + std::numeric_limits<A>::epsilon() * largest;
    if (scene.settings.reduction == Reduction::DepthShaded)
    {
      // Errors grow by the largest factor.
      this->Tolerance *=
        std::max(1.0, std::abs(scene.settings.ambient) + std::abs(scene.settings.changeRate));
      const R most = isFinite ? this->Range : largest;
      this->ShareTolerance = std::abs(scene.settings.changeRate) * most * Precision<T>;
    }
  }

  const reference::CellOracle<R>& oracle() const { return this->Oracle; }
  R tolerance() const { return this->Tolerance; }
  /// Of one ray: the shorter it is, the less is known which share of it lies before a sample.
  R tolerance(const reference::CellRay<R>& ray) const
  {
    const R length = ray.far - ray.near;
    return this->Tolerance + (length > 0 ? this->ShareTolerance / length : R(0));
  }

  Sample expected(const reference::CellRay<R>& ray) const
  {
    return this->expected(this->Oracle, ray);
  }
  /// @param value  of the engine: where maximum and minimum are equally far, it may be either's
  Sample expected(
    const reference::CellOracle<R>& oracle, const reference::CellRay<R>& ray, A value = 0) const
  {
    const ProjectionSettings& s = this->Source.settings;
    switch (s.reduction)
    {
      case Reduction::DepthShaded:
        return oracle.shaded(ray, { this->Lowest, s.ambient, s.changeRate });
      case Reduction::Local:
        return oracle.local(ray, s.threshold, this->Fall);
      case Reduction::Signed:
        return this->farther(oracle.largest(ray), oracle.largest(ray, true), value);
      default:
        return oracle.largest(ray, s.reduction == Reduction::Minimum);
    }
  }

  /// Rays that cross the field over too little have no sample.
  bool crosses(const reference::CellRay<R>& ray, int x, int y, const CellScreen& screen) const
  {
    const R step = glm::length(screen.rays.direction(x, y));
    return ray.far - ray.near > splatting::CellProjector::ShortestRay * step;
  }

  Counts compare(const CellScreen& screen) const
  {
    Counts counts;
    for (int y = 0; y < this->Source.view.viewport.y; ++y)
    {
      for (int x = 0; x < this->Source.view.viewport.x; ++x)
      {
        this->comparePixel(screen, x, y, counts);
      }
    }
    return counts;
  }

private:
  /// Of two samples the one that is farther from the origin, if both are infinitely far the
  /// maximum. The engine's extrema may each be wrong by the tolerance, and so may the difference of
  /// their distances be by twice as much.
  Sample farther(const Sample& maximum, const Sample& minimum, A value) const
  {
    const R origin = this->Source.settings.origin;
    const R lead = std::fabs(minimum.value - origin) - std::fabs(maximum.value - origin);
    const bool isNearer = std::fabs(value - minimum.value) < std::fabs(value - maximum.value);
    return (std::fabs(lead) <= 2 * this->Tolerance ? isNearer : lead > 0) ? minimum : maximum;
  }

  Sample sampleOf(
    const reference::CellRay<R>& ray, int x, int y, A value, const CellScreen& screen) const
  {
    return this->crosses(ray, x, y, screen) ? this->expected(this->Oracle, ray, value) : Sample();
  }

  /// 0 if both are the same, infinite if only one is a sample.
  R error(A value, const Sample& sample) const
  {
    const bool exists = value == value;
    if (exists != sample.exists)
    {
      return std::numeric_limits<R>::infinity();
    }
    return !exists || R(value) == sample.value ? R(0) : std::fabs(R(value) - sample.value);
  }

  void comparePixel(const CellScreen& screen, int x, int y, Counts& counts) const
  {
    const A value = valueAt<A>(screen, x, y);
    const reference::CellRay<R> ray = this->Oracle.ray(x, y);
    const Sample sample = this->sampleOf(ray, x, y, value, screen);
    ++counts.pixels;
    counts.samples += sample.exists;
    const R error = this->error(value, sample), tolerance = this->tolerance(ray);
    // Also where the error is small enough: what is left tells how precise values are.
    if (error > tolerance / 2 && this->isAmbiguous(screen, x, y, value))
    {
      ++counts.ambiguous;
      return;
    }
    if (error > 0)
    {
      counts.worst = std::max(counts.worst, static_cast<double>(error / tolerance));
    }
    this->Check(error <= tolerance, "pixel ", x, ", ", y, ": ", value, ", not ", sample.value,
      sample.exists ? "" : " (none)", ", error ", error / tolerance, " of the bound at ", sample.t,
      " of ", ray.near, " to ", ray.far, ", ray of length ", ray.far - ray.near, ", direction ",
      ray.direction[0], " ", ray.direction[1], " ", ray.direction[2]);
  }

  /// Whether rounding may end a ray's part of a cell anywhere in it: it changes the part's middle,
  /// and its largest value, which negative factors make the least.
  bool runsAlongFace(const reference::CellRay<R>& ray) const
  {
    bool along = false;
    for (int a = 0; a < 3; ++a)
    {
      for (const R t : { ray.near, ray.far })
      {
        const R halves = 2 * (ray.start[a] + t * ray.direction[a]);
        along |= std::fabs(ray.direction[a]) < R(1e-5) &&
          std::fabs(halves - std::round(halves)) < 4 * R(Beside<T>);
      }
    }
    return along;
  }

  /// Whether rays beside a pixel's own differ by more than a continuous field can, and the engine's
  /// value is in their range.
  bool isAmbiguous(const CellScreen& screen, int x, int y, A value) const
  {
    std::vector<Sample> samples;
    std::vector<reference::CellRay<R>> rays;
    // Of every size, since a ray that nearly runs along a face crosses it where rounding decides.
    for (double size = Beside<T>; size > 0.0; size = size > 0x1p-56 ? size / 8.0 : 0.0)
    {
      for (int n = 0; n < 8; ++n)
      {
        const glm::dvec3 side(n & 1, n >> 1 & 1, n >> 2);
        rays.push_back(this->Oracle.ray(x, y, size * (2.0 * side - 1.0)));
        const bool crosses = this->crosses(rays.back(), x, y, screen);
        samples.push_back(crosses ? this->expected(this->Oracle, rays.back(), value) : Sample());
        samples.push_back(crosses ? this->expected(this->Coarse, rays.back(), value) : Sample());
      }
    }
    const Reduction reduction = this->Source.settings.reduction;
    if (reduction == Reduction::Maximum || reduction == Reduction::Minimum)
    {
      samples.push_back(this->Coarse.certain(rays, reduction == Reduction::Minimum));
    }
    const reference::CellRay<R> own = this->Oracle.ray(x, y);
    if (reduction == Reduction::Local && this->crosses(own, x, y, screen))
    {
      // The least fall is 16 times what rounding changes a value by, and compares two values, of
      // which each is the result of two roundings.
      for (const double share : { 0.75, 1.25 })
      {
        samples.push_back(
          this->Oracle.local(own, this->Source.settings.threshold, share * this->Fall));
      }
    }
    R least = std::numeric_limits<R>::infinity(), largest = -least;
    bool none = false;
    for (const Sample& sample : samples)
    {
      none |= !sample.exists;
      least = sample.exists ? std::min(least, sample.value) : least;
      largest = sample.exists ? std::max(largest, sample.value) : largest;
    }
    if (!(value == value) || !(least <= largest))
    {
      return none && (value == value || least <= largest);
    }
    if (this->ShareTolerance > 0 && this->runsAlongFace(own))
    {
      return true;
    }
    const R margin = this->tolerance(own);
    // A ray that misses a part shows less, of minima more.
    return (none || largest - least > 6 * margin) &&
      ((none && reduction != Reduction::Minimum) || value >= least - margin) &&
      ((none && reduction != Reduction::Maximum) || value <= largest + margin);
  }

  const Scene<T>& Source;
  const reference::CellScene<R> Plain;
  const reference::CellOracle<R> Oracle, Coarse;
  Checks& Check;
  R Low, Range, Tolerance, ShareTolerance = 0;
  double Lowest, Fall;
};

/// Projects a scene and compares all pixels of it.
template <class T>
Counts compareScene(const Scene<T>& scene, Checks& check)
{
  Engine<T> engine(scene);
  CellScreen screen;
  if (!engine.project(screen))
  {
    check(false, "the view has no meaning: ", glm::to_string(scene.view.indexToClip));
    return {};
  }
  return Comparison<T>(scene, engine.range(), check).compare(screen);
}
}

#endif
