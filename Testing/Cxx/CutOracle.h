// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Scenes that cut rays, and the definitions of what is left, ray by ray and slice by slice in index
 * space.
 */
#ifndef CutOracle_h
#define CutOracle_h

#include "CoreTesting.h"

#include "Clipping/ClosedSurface.h"
#include "Clipping/SceneDepth.h"
#include "Splat/Projection/RayIntervals.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace cutscenes
{
using namespace coretesting;
using reference::halfSpacesOfBox;
using reference::inside;
using reference::Random;
using splatting::RayIntervals;
using splatting::ShearWarp;
using splatting::View;
using Stretch = reference::Stretch<double>;

constexpr double Infinity = std::numeric_limits<double>::infinity();

struct Mesh
{
  std::vector<glm::dvec3> points;
  std::vector<glm::ivec3> triangles;
};

struct Depths
{
  glm::ivec2 origin{ 0 }, size{ 0 };
  std::vector<float> samples;
};

/// A random scene; what is empty does not cut.
struct Scene
{
  View view; // with half-spaces
  Mesh mesh;
  Depths depths;
};

/// Bounds that are nearer than this to what decides are not compared: rounding decides.
constexpr double Doubt = 1e-6;
/// Where rays and edges are nearer, as a share of the triangle; rays of perspective images are
/// rounded.
constexpr double MeshDoubt = 1e-5;

/// The crossings of a line with a mesh (Moeller and Trumbore).
struct Crossings
{
  std::vector<double> places;
  bool doubtful = false; // an edge is so near that rounding decides
};

inline Crossings crossMesh(const Mesh& mesh, const glm::dvec3& from, const glm::dvec3& direction)
{
  Crossings crossings;
  for (const glm::ivec3& t : mesh.triangles)
  {
    const glm::dvec3 a = mesh.points[t.x];
    const glm::dvec3 edge1 = mesh.points[t.y] - a, edge2 = mesh.points[t.z] - a;
    const glm::dvec3 p = glm::cross(direction, edge2);
    const double determinant = glm::dot(edge1, p);
    const glm::dvec3 s = from - a;
    const glm::dvec3 q = glm::cross(s, edge1);
    const double x = glm::dot(s, p) / determinant, y = glm::dot(direction, q) / determinant;
    const double least = std::min({ x, y, 1.0 - x - y });
    crossings.doubtful |= !(std::abs(least) > MeshDoubt);
    if (least > 0.0)
    {
      crossings.places.push_back(glm::dot(edge2, q) / determinant);
    }
  }
  return crossings;
}

/// The definitions, for the rays of one image of a scene.
class Oracle
{
public:
  Oracle(const Scene& scene, const ShearWarp& geometry)
    : Source(scene),
      Rays(referenceRays(geometry)),
      ClipToIndex(glm::inverse(scene.view.indexToClip)),
      Shown(reference::boxOfVolume(scene.view.dimensions, false)),
      Voxels(reference::boxOfVolume(scene.view.dimensions, true))
  {
    for (auto* body : { &this->Shown, &this->Voxels })
    {
      body->insert(body->end(), scene.view.halfSpaces.begin(), scene.view.halfSpaces.end());
    }
  }

  const reference::ImageRays& rays() const { return this->Rays; }

  /// Between which slices the ray is inside everything. False if rounding decides.
  bool find(int u, int v, Stretch& stretch) const
  {
    const glm::dvec3 from = this->Rays.point(u, v, 0.0), step = this->Rays.direction(u, v);
    stretch = inside(this->Source.view.halfSpaces, from, step);
    stretch.narrow(this->Rays.beforeEye());
    return (this->Source.mesh.triangles.empty() || this->endAtMesh(from, step, stretch)) &&
      (this->Source.depths.samples.empty() || this->endAtDepth(u, v, stretch));
  }

  /// Whether the picture's pixel is hidden; -1 if rounding decides.
  int hides(const glm::ivec2& pixel) const
  {
    const double depth = this->sample(pixel);
    const double entry = this->stretchOfDepths(pixel, this->Shown).begin;
    return depth < 1.0 && std::abs(depth - entry) < Doubt ? -1 : depth < 1.0 && depth < entry;
  }

private:
  double depthOf(const glm::dvec4& p) const
  {
    const glm::dvec4 clip = this->Source.view.indexToClip * p;
    return 0.5 * (clip.z / clip.w + 1.0);
  }

  double sample(const glm::ivec2& pixel) const
  {
    const Depths& d = this->Source.depths;
    return d.samples.at((pixel.y - d.origin.y) * d.size.x + pixel.x - d.origin.x);
  }

  /// The hull of the crossings before the eye, or from there on if it is inside: then the line
  /// meets the surface an odd number of times behind it.
  bool endAtMesh(const glm::dvec3& from, const glm::dvec3& step, Stretch& stretch) const
  {
    const Crossings crossings = crossMesh(this->Source.mesh, from, step);
    const Stretch ray = this->Rays.beforeEye();
    Stretch hull{ Infinity, -Infinity };
    const auto add = [&](double z)
    {
      hull.begin = std::min(hull.begin, z);
      hull.end = std::max(hull.end, z);
    };
    bool doubtful = crossings.doubtful, isEyeInside = false;
    for (double z : crossings.places)
    {
      const bool isBefore = z > ray.begin && z < ray.end;
      doubtful |= std::min(std::abs(z - ray.begin), std::abs(z - ray.end)) < 1e-3;
      isEyeInside ^= !isBefore;
      if (isBefore)
      {
        add(z);
      }
    }
    if (isEyeInside)
    {
      add(this->Rays.eye);
    }
    stretch.narrow(hull);
    return !doubtful;
  }

  /// The depths between which the ray of a screen pixel is inside a body; those of what it never
  /// enters begin nowhere.
  Stretch stretchOfDepths(const glm::ivec2& pixel, const std::vector<glm::dvec4>& body) const
  {
    const glm::dvec2 place =
      2.0 * (glm::dvec2(pixel) + 0.5) / glm::dvec2(this->Source.view.viewport) - 1.0;
    const glm::dvec4 nearest = this->ClipToIndex * glm::dvec4(place, -1.0, 1.0);
    const glm::dvec4 farthest = this->ClipToIndex * glm::dvec4(place, 1.0, 1.0);
    const glm::dvec3 from = glm::dvec3(nearest) / nearest.w;
    const glm::dvec3 direction = glm::dvec3(farthest) / farthest.w - from;
    if (this->Rays.isParallel())
    {
      // Rays enter and leave through the planes that they do not run along, beside the body, too.
      std::vector<glm::dvec4> crossed;
      std::copy_if(body.begin(), body.end(), std::back_inserter(crossed),
        [&](const glm::dvec4& h)
        {
          const glm::dvec3 normal(h);
          return std::abs(glm::dot(normal, direction)) >
            1e-9 * glm::length(normal) * glm::length(direction);
        });
      return inside(crossed, from, direction);
    }
    const double w0 = (this->Source.view.indexToClip * glm::dvec4(from, 1.0)).w;
    const double w1 = (this->Source.view.indexToClip * glm::dvec4(from + direction, 1.0)).w;
    const double eye = w0 / (w0 - w1);
    const auto depthAt = [&](double t)
    { return t < Infinity ? this->depthOf(glm::dvec4(from + t * direction, 1.0)) : t; };
    Stretch result{ -Infinity, Infinity };
    for (const glm::dvec4& h : body)
    {
      // From the eye on: what is outside there is entered, perhaps, what is inside is left, and
      // planes through the eye are neither. Rays along a plane never come to it.
      const Stretch one = inside({ h }, from, direction);
      const double value = glm::dot(h, glm::dvec4(from + eye * direction, 1.0));
      if (value < -1e-9)
      {
        result.begin = std::max(result.begin, depthAt(one.begin > eye ? one.begin : Infinity));
      }
      else if (value > 1e-9)
      {
        result.end = std::min(result.end, depthAt(one.end > eye ? one.end : Infinity));
      }
    }
    return result;
  }

  /// Where a ray is seen: in perspective, by its direction.
  glm::dvec4 clipPlaceOf(int u, int v) const
  {
    const glm::dvec3 step = this->Rays.direction(u, v);
    return this->Source.view.indexToClip *
      (this->Rays.isParallel() ? glm::dvec4(this->Rays.point(u, v, 0.0), 1.0)
                               : glm::dvec4(this->Rays.reversed ? -step : step, 0.0));
  }

  bool endAtDepth(int u, int v, Stretch& stretch) const
  {
    const glm::dvec4 clip = this->clipPlaceOf(u, v);
    if (clip.w <= 0.0)
    {
      return true; // nothing is seen in that direction
    }
    const glm::dvec2 seen =
      0.5 * (glm::dvec2(clip) / clip.w + 1.0) * glm::dvec2(this->Source.view.viewport);
    const glm::dvec2 rest = glm::fract(seen);
    if (std::min({ rest.x, rest.y, 1.0 - rest.x, 1.0 - rest.y }) <
      (this->Rays.isParallel() ? Doubt : 1e-3))
    {
      return false;
    }
    const Depths& d = this->Source.depths;
    const glm::ivec2 pixel =
      glm::clamp(glm::floor(seen), glm::dvec2(d.origin), glm::dvec2(d.origin + d.size - 1));
    const double depth = this->sample(pixel);
    Stretch body = this->stretchOfDepths(pixel, this->Shown);
    if (std::abs(body.begin - body.end) < Doubt)
    {
      return false;
    }
    if (body.begin > body.end)
    {
      body = this->stretchOfDepths(pixel, this->Voxels);
    }
    if (depth >= 1.0)
    {
      return true;
    }
    if (std::min(std::abs(depth - body.begin), std::abs(depth - body.end)) < Doubt)
    {
      return false;
    }
    if (depth > body.begin && depth < body.end)
    {
      // The ray crosses that depth once, before the eye.
      const auto isDeeper = [&](double z)
      {
        const glm::dvec4 p(this->Rays.point(u, v, z), 1.0);
        return (this->Source.view.indexToClip * p).w > 0.0 && this->depthOf(p) > depth;
      };
      double low = -1e4, high = 1e4;
      const bool deeperAbove = isDeeper(high);
      for (int n = 0; n < 100; ++n)
      {
        const double middle = 0.5 * (low + high);
        (isDeeper(middle) == deeperAbove ? high : low) = middle;
      }
      stretch.narrow(deeperAbove ? Stretch{ -Infinity, low } : Stretch{ low, Infinity });
    }
    return true;
  }

  const Scene& Source;
  const reference::ImageRays Rays;
  const glm::dmat4 ClipToIndex;
  std::vector<glm::dvec4> Shown, Voxels;
};

/// Everything that the core makes of a scene, for all of its images.
struct Found
{
  std::vector<ShearWarp> images;
  splatting::ClosedSurface surface;
  splatting::SceneDepth depth;
  std::vector<RayIntervals> intervals;

  explicit Found(const Scene& scene)
  {
    ShearWarp::factorise(scene.view, this->images);
    this->intervals.resize(this->images.size());
    const bool hasMesh = !scene.mesh.triangles.empty();
    if (hasMesh)
    {
      this->surface.reset(scene.mesh.points, scene.mesh.triangles);
    }
    const Depths& d = scene.depths;
    if (!d.samples.empty())
    {
      std::copy(d.samples.begin(), d.samples.end(), this->depth.allocate(d.origin, d.size));
      this->depth.place(scene.view);
    }
    for (std::size_t n = 0; n < this->images.size(); ++n)
    {
      this->intervals[n].find(this->images[n], scene.view.halfSpaces,
        hasMesh ? &this->surface : nullptr, d.samples.empty() ? nullptr : &this->depth);
    }
  }

  bool cutsNothing() const
  {
    return std::all_of(this->intervals.begin(), this->intervals.end(),
      [](const RayIntervals& i) { return i.empty(); });
  }
};

struct Counts
{
  int rays = 0, doubtful = 0, cut = 0, kept = 0, thin = 0, hidden = 0;
};

/// The slices that a ray crosses and that count.
inline std::vector<int> left(
  const RayIntervals& intervals, int u, int v, const std::vector<int>& crossed)
{
  std::vector<int> result;
  std::copy_if(crossed.begin(), crossed.end(), std::back_inserter(result),
    [&](int k)
    { return intervals.empty() || (k >= intervals.first(v)[u] && k <= intervals.last(v)[u]); });
  return result;
}

inline void compareRay(const Oracle& oracle, const RayIntervals& intervals, int u, int v,
  const std::vector<int>& crossed, Counts& counts, Checks& check)
{
  Stretch stretch;
  ++counts.rays;
  const Stretch ray = oracle.rays().beforeEye();
  const auto isDoubtful = [&](double depth)
  {
    return std::isfinite(depth) && depth != ray.begin && depth != ray.end &&
      std::abs(depth - std::round(depth)) < Doubt;
  };
  if (!oracle.find(u, v, stretch) || isDoubtful(stretch.begin) || isDoubtful(stretch.end) ||
    std::abs(stretch.begin - stretch.end) < Doubt)
  {
    ++counts.doubtful;
    return;
  }
  const double middle = std::floor(0.5 * (stretch.begin + stretch.end) + 0.5);
  const bool isThin =
    stretch.begin < stretch.end && std::ceil(stretch.begin) > std::floor(stretch.end);
  std::vector<int> expected;
  std::copy_if(crossed.begin(), crossed.end(), std::back_inserter(expected),
    [&](int k) { return isThin ? k == middle : k >= stretch.begin && k <= stretch.end; });
  counts.thin += isThin && !expected.empty();
  counts.cut += static_cast<int>(crossed.size() - expected.size());
  counts.kept += static_cast<int>(expected.size());
  const std::vector<int> counted = left(intervals, u, v, crossed);
  const auto last = [](const std::vector<int>& slices)
  { return slices.empty() ? -1 : slices.back(); };
  const auto first = [](const std::vector<int>& slices)
  { return slices.empty() ? -1 : slices.front(); };
  check(counted == expected, "pixel ", u, ", ", v, ": slices ", first(counted), " to ",
    last(counted), " of ", crossed.front(), " to ", crossed.back(), ", not ", first(expected),
    " to ", last(expected), ": inside from ", stretch.begin, " to ", stretch.end);
}

/// Whether a ray passes so near to an edge of a box that rounding decides which of its faces the
/// ray meets: it is in a wider box where it is beyond two faces of a narrower one.
/// @param wide, narrow  the half-spaces of both boxes, in the same order
inline bool meetsEdge(const Oracle& oracle, int u, int v, const std::vector<glm::dvec4>& wide,
  const std::vector<glm::dvec4>& narrow)
{
  const glm::dvec3 from = oracle.rays().point(u, v, 0.0), step = oracle.rays().direction(u, v);
  const Stretch outer = inside(wide, from, step);
  for (std::size_t i = 0; i < narrow.size(); ++i)
  {
    for (std::size_t j = i + 1; j < narrow.size(); ++j)
    {
      Stretch both = inside({ -narrow[i], -narrow[j] }, from, step);
      both.narrow(outer);
      if (both.begin <= both.end)
      {
        return true;
      }
    }
  }
  return false;
}

/// Calls f with each ray of an image that meets the volume, and the slices that it crosses.
template <class F>
void forEachRay(const Oracle& oracle, F&& f)
{
  for (int v = 0; v < oracle.rays().height(); ++v)
  {
    for (int u = 0; u < oracle.rays().width(); ++u)
    {
      const std::vector<int> crossed = reference::crossedSlices(oracle.rays(), u, v);
      if (!crossed.empty())
      {
        f(u, v, crossed);
      }
    }
  }
}

inline void compareHidden(const Scene& scene, const splatting::SceneDepth& depth,
  const Oracle& oracle, Counts& counts, Checks& check)
{
  splatting::Picture picture;
  picture.origin = scene.depths.origin;
  picture.size = scene.depths.size;
  picture.pixels.assign(scene.depths.samples.size(), 1);
  depth.hide(picture);
  for (int n = 0; n < picture.size.x * picture.size.y; ++n)
  {
    const glm::ivec2 pixel = picture.origin + glm::ivec2(n % picture.size.x, n / picture.size.x);
    const int hidden = oracle.hides(pixel);
    counts.hidden += hidden == 1;
    check(
      hidden < 0 || hidden == (picture.pixels[n] == 0), "screen pixel ", pixel.x, ", ", pixel.y);
  }
}

inline void compare(const Scene& scene, Counts& counts, Checks& check)
{
  const Found found(scene);
  for (std::size_t n = 0; n < found.images.size(); ++n)
  {
    const Oracle oracle(scene, found.images[n]);
    forEachRay(oracle,
      [&](int u, int v, const std::vector<int>& crossed)
      { compareRay(oracle, found.intervals[n], u, v, crossed, counts, check); });
    if (n == 0 && !scene.depths.samples.empty())
    {
      compareHidden(scene, found.depth, oracle, counts, check);
    }
  }
}
}

#endif
