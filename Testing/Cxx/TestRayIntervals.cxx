// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where rays begin and end, against their definition in index space, ray by ray and slice by slice:
// half-spaces, closed surfaces, depth buffers, and all of them together.
#include "CoreTesting.h"

#include "ClosedSurface.h"
#include "Frame.h"
#include "RayIntervals.h"
#include "SceneDepth.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

namespace
{
using coretesting::Checks;
using reference::Random;
using splatting::ClosedSurface;
using splatting::RayIntervals;
using splatting::SceneDepth;
using splatting::ShearWarp;
using splatting::View;

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
  View view;
  std::vector<glm::dvec4> halfSpaces; // of index space
  Mesh mesh;
  Depths depths;
};

/// Where a line p(t) = from + t direction is inside.
struct Stretch
{
  double begin = -Infinity, end = Infinity;
};

/// Bounds that are nearer than this to what decides are not compared: rounding decides.
constexpr double Doubt = 1e-6;

glm::dvec3 randomVector(Random& random)
{
  return { random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0) };
}

glm::dvec3 randomPoint(Random& random, const glm::ivec3& size)
{
  return { random.uniform(-0.5, size.x - 0.5), random.uniform(-0.5, size.y - 0.5),
    random.uniform(-0.5, size.z - 0.5) };
}

glm::dvec4 halfSpaceThrough(const glm::dvec3& point, const glm::dvec3& normal)
{
  return { normal, -glm::dot(normal, point) };
}

std::vector<glm::dvec4> halfSpacesOfBox(const glm::dvec3& low, const glm::dvec3& high)
{
  std::vector<glm::dvec4> result;
  for (int a = 0; a < 3; ++a)
  {
    glm::dvec4 h(0.0, 0.0, 0.0, -low[a]);
    h[a] = 1.0;
    result.push_back(h);
    h = { 0.0, 0.0, 0.0, high[a] };
    h[a] = -1.0;
    result.push_back(h);
  }
  return result;
}

Stretch inside(
  const std::vector<glm::dvec4>& halfSpaces, const glm::dvec3& from, const glm::dvec3& direction)
{
  Stretch stretch;
  for (const glm::dvec4& h : halfSpaces)
  {
    const double at = glm::dot(h, glm::dvec4(from, 1.0));
    const double speed = glm::dot(glm::dvec3(h), direction);
    if (speed > 0.0)
    {
      stretch.begin = std::max(stretch.begin, -at / speed);
    }
    else if (speed < 0.0)
    {
      stretch.end = std::min(stretch.end, -at / speed);
    }
    else if (at < 0.0)
    {
      stretch.end = -Infinity;
    }
  }
  return stretch;
}

/// The first and the last crossing with any triangle (Moeller and Trumbore). False if an edge is
/// so near that rounding decides.
bool crossMesh(
  const Mesh& mesh, const glm::dvec3& from, const glm::dvec3& direction, Stretch& stretch)
{
  stretch = { Infinity, -Infinity };
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
    if (!(std::abs(least) > Doubt))
    {
      return false;
    }
    if (least > 0.0)
    {
      const double depth = glm::dot(edge2, q) / determinant;
      stretch.begin = std::min(stretch.begin, depth);
      stretch.end = std::max(stretch.end, depth);
    }
  }
  return true;
}

/// The definitions, for the rays of one scene.
class Oracle
{
public:
  Oracle(const Scene& scene, const ShearWarp& geometry)
    : Source(scene),
      Geometry(geometry),
      ClipToIndex(glm::inverse(scene.view.indexToClip))
  {
    const glm::dvec3 last(scene.view.dimensions - 1);
    glm::dvec3 low(0.0), high(last);
    for (int a = 0; a < 3; ++a)
    {
      low[a] -= last[a] == 0.0 ? 0.5 : 0.0;
      high[a] += last[a] == 0.0 ? 0.5 : 0.0;
    }
    this->Shown = halfSpacesOfBox(low, high);
    this->Voxels = halfSpacesOfBox(glm::dvec3(-0.5), last + 0.5);
    for (auto* body : { &this->Shown, &this->Voxels })
    {
      body->insert(body->end(), scene.halfSpaces.begin(), scene.halfSpaces.end());
    }
  }

  /// Where the ray of shear pixel (u, v) crosses the middle of slice z.
  glm::dvec3 point(int u, int v, double z) const
  {
    const glm::dvec2 place = glm::dvec2(u, v) - this->Geometry.position(z);
    glm::dvec3 p;
    p[this->Geometry.axes()[0]] = place.x;
    p[this->Geometry.axes()[1]] = place.y;
    p[this->Geometry.axes()[2]] = z;
    return p;
  }

  /// Between which slices the ray is inside everything. False if rounding decides.
  bool find(int u, int v, Stretch& stretch) const
  {
    const glm::dvec3 from = this->point(u, v, 0.0);
    const glm::dvec3 step = this->point(u, v, 1.0) - from;
    stretch = inside(this->Source.halfSpaces, from, step);
    if (!this->Source.mesh.triangles.empty())
    {
      Stretch surface;
      if (!crossMesh(this->Source.mesh, from, step, surface))
      {
        return false;
      }
      stretch.begin = std::max(stretch.begin, surface.begin);
      stretch.end = std::min(stretch.end, surface.end);
    }
    return this->Source.depths.samples.empty() || this->endAtDepth(from, step, stretch);
  }

  /// Whether the picture's pixel is hidden; -1 if rounding decides.
  int hides(const glm::ivec2& pixel) const
  {
    const double depth = this->sample(pixel);
    const double entry = this->stretchOfDepths(pixel, this->Shown).begin;
    return depth < 1.0 && std::abs(depth - entry) < Doubt ? -1 : depth < 1.0 && depth < entry;
  }

private:
  double depthOf(const glm::dvec3& p) const
  {
    const glm::dvec4 clip = this->Source.view.indexToClip * glm::dvec4(p, 1.0);
    return 0.5 * (clip.z / clip.w + 1.0);
  }

  double sample(const glm::ivec2& pixel) const
  {
    const Depths& d = this->Source.depths;
    return d.samples.at((pixel.y - d.origin.y) * d.size.x + pixel.x - d.origin.x);
  }

  /// The depths between which the ray of a screen pixel is inside a body.
  Stretch stretchOfDepths(const glm::ivec2& pixel, const std::vector<glm::dvec4>& body) const
  {
    const glm::dvec2 clip =
      2.0 * (glm::dvec2(pixel) + 0.5) / glm::dvec2(this->Source.view.viewport) - 1.0;
    const glm::dvec4 nearest = this->ClipToIndex * glm::dvec4(clip, -1.0, 1.0);
    const glm::dvec4 farthest = this->ClipToIndex * glm::dvec4(clip, 1.0, 1.0);
    const glm::dvec3 from = glm::dvec3(nearest) / nearest.w;
    const glm::dvec3 direction = glm::dvec3(farthest) / farthest.w - from;
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

  bool endAtDepth(const glm::dvec3& from, const glm::dvec3& step, Stretch& stretch) const
  {
    const glm::dvec4 clip = this->Source.view.indexToClip * glm::dvec4(from, 1.0);
    const glm::dvec2 seen =
      0.5 * (glm::dvec2(clip) / clip.w + 1.0) * glm::dvec2(this->Source.view.viewport);
    const glm::dvec2 rest = glm::fract(seen);
    if (std::min({ rest.x, rest.y, 1.0 - rest.x, 1.0 - rest.y }) < Doubt)
    {
      return false;
    }
    const Depths& d = this->Source.depths;
    const glm::ivec2 pixel =
      glm::clamp(glm::ivec2(glm::floor(seen)), d.origin, d.origin + d.size - 1);
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
      const double start = this->depthOf(from);
      const double slope = this->depthOf(from + step) - start;
      const double z = (depth - start) / slope;
      (slope > 0.0 ? stretch.end : stretch.begin) =
        slope > 0.0 ? std::min(stretch.end, z) : std::max(stretch.begin, z);
    }
    return true;
  }

  const Scene& Source;
  const ShearWarp& Geometry;
  glm::dmat4 ClipToIndex;
  std::vector<glm::dvec4> Shown, Voxels;
};

/// Everything that the core makes of a scene.
struct Found
{
  ShearWarp geometry;
  std::vector<glm::dvec4> halfSpaces; // in pixels
  ClosedSurface surface;
  SceneDepth depth;
  RayIntervals intervals;

  explicit Found(const Scene& scene) : geometry(scene.view)
  {
    for (const glm::dvec4& h : scene.halfSpaces)
    {
      this->halfSpaces.push_back(this->geometry.inPixels(h));
    }
    const bool hasMesh = !scene.mesh.triangles.empty();
    if (hasMesh)
    {
      this->surface.reset(scene.mesh.points, scene.mesh.triangles);
      this->surface.project(this->geometry);
    }
    const Depths& d = scene.depths;
    if (!d.samples.empty())
    {
      std::copy(d.samples.begin(), d.samples.end(), this->depth.allocate(d.origin, d.size));
      this->depth.place(scene.view, this->geometry, this->halfSpaces);
    }
    this->intervals.find(this->geometry, this->halfSpaces, hasMesh ? &this->surface : nullptr,
      d.samples.empty() ? nullptr : &this->depth);
  }
};

struct Counts
{
  int rays = 0, doubtful = 0, cut = 0, thin = 0, hidden = 0;
};

bool isDoubtful(double depth)
{
  return std::isfinite(depth) && std::abs(depth - std::round(depth)) < Doubt;
}

/// The crossed slices that count, from first to last.
void compareRay(const Oracle& oracle, const RayIntervals& intervals, int u, int v, int first,
  int last, Counts& counts, Checks& check)
{
  Stretch stretch;
  ++counts.rays;
  if (!oracle.find(u, v, stretch) || isDoubtful(stretch.begin) || isDoubtful(stretch.end))
  {
    ++counts.doubtful;
    return;
  }
  const double middle = std::floor(0.5 * (stretch.begin + stretch.end) + 0.5);
  const bool isThin =
    stretch.begin < stretch.end && std::ceil(stretch.begin) > std::floor(stretch.end);
  counts.thin += isThin && middle >= first && middle <= last;
  for (int k = first; k <= last; ++k)
  {
    const bool expected = isThin ? k == middle : k >= stretch.begin && k <= stretch.end;
    const bool counted =
      intervals.empty() || (k >= intervals.first(v)[u] && k <= intervals.last(v)[u]);
    counts.cut += !expected;
    check(counted == expected, "pixel ", u, ", ", v, " slice ", k, " of ", first, " to ", last,
      ": inside from ", stretch.begin, " to ", stretch.end);
  }
}

void compare(const Scene& scene, Counts& counts, Checks& check)
{
  const Found found(scene);
  const ShearWarp& geometry = found.geometry;
  const Oracle oracle(scene, geometry);
  std::vector<splatting::SliceGeometry> slices;
  splatting::findSlices(geometry, slices);
  splatting::CrossedSlices crossed;
  crossed.reset(slices, geometry.width());
  std::vector<std::int16_t> first(geometry.width()), last(geometry.width());
  for (int v = 0; v < geometry.height(); ++v)
  {
    crossed.find(v, first.data(), last.data());
    for (int u = 0; u < geometry.width(); ++u)
    {
      if (first[u] <= last[u])
      {
        compareRay(oracle, found.intervals, u, v, first[u], last[u], counts, check);
      }
    }
  }
  if (scene.depths.samples.empty())
  {
    return;
  }
  splatting::Picture picture;
  splatting::placePicture({ geometry }, scene.view.viewport, picture);
  picture.pixels.assign(std::size_t(picture.size.x) * picture.size.y, 1);
  found.depth.hide(picture);
  for (int n = 0; n < picture.size.x * picture.size.y; ++n)
  {
    const glm::ivec2 pixel = picture.origin + glm::ivec2(n % picture.size.x, n / picture.size.x);
    const int hidden = oracle.hides(pixel);
    counts.hidden += hidden == 1;
    check(
      hidden < 0 || hidden == (picture.pixels[n] == 0), "screen pixel ", pixel.x, ", ", pixel.y);
  }
}

std::vector<glm::dvec4> randomHalfSpaces(Random& random, const glm::ivec3& size)
{
  std::vector<glm::dvec4> result;
  for (int count = random.uniform(1, 6); count > 0; --count)
  {
    const glm::dvec3 normal = randomVector(random);
    // Most of the volume stays on the inner side of many planes.
    glm::dvec4 h = halfSpaceThrough(randomPoint(random, size), normal);
    const bool isInside = glm::dot(h, glm::dvec4(0.5 * glm::dvec3(size), 1.0)) > 0.0;
    result.push_back(isInside ? h : -h);
  }
  if (random.uniform(0, 2) == 0)
  {
    // A slab, of which some rays have less than a slice.
    const glm::dvec3 normal = randomVector(random), point = randomPoint(random, size);
    result.push_back(halfSpaceThrough(point, normal));
    result.push_back(-halfSpaceThrough(point + random.uniform(0.1, 1.0) * normal, normal));
  }
  return result;
}

/// A sphere, stretched and turned, with the radius changed by up to `bumps`.
Mesh randomBlob(Random& random, const glm::ivec3& size, double bumps)
{
  const int rings = random.uniform(3, 9), sectors = random.uniform(3, 11);
  const glm::dvec3 centre = randomPoint(random, size);
  const glm::dmat3 stretch(randomVector(random), randomVector(random), randomVector(random));
  Mesh mesh;
  const auto add = [&](double polar, double azimuth)
  {
    const glm::dvec3 p(
      std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
    const double radius = (1.0 + random.uniform(-bumps, bumps)) * 0.6 * (size.x + size.z);
    mesh.points.push_back(centre + radius * (stretch * p));
  };
  constexpr double pi = 3.14159265358979;
  add(0.0, 0.0);
  for (int n = 0; n < (rings - 1) * sectors; ++n)
  {
    add(pi * (n / sectors + 1) / rings, 2.0 * pi * (n % sectors) / sectors);
  }
  add(pi, 0.0);
  const int south = static_cast<int>(mesh.points.size()) - 1;
  const auto at = [=](int ring, int sector) {
    return ring == 0 ? 0 : ring == rings ? south : 1 + (ring - 1) * sectors + sector % sectors;
  };
  for (int ring = 0; ring < rings; ++ring)
  {
    for (int s = 0; s < sectors; ++s)
    {
      if (ring > 0)
      {
        mesh.triangles.push_back({ at(ring, s), at(ring + 1, s), at(ring, s + 1) });
      }
      if (ring < rings - 1)
      {
        mesh.triangles.push_back({ at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1) });
      }
    }
  }
  return mesh;
}

/// The volume takes a part of the depth range, as in a scene.
void spreadDepths(View& view, Random& random)
{
  double low = Infinity, high = -Infinity;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec3 p(corner & 1 ? view.dimensions.x : 0, corner & 2 ? view.dimensions.y : 0,
      corner & 4 ? view.dimensions.z : 0);
    const double z = (view.indexToClip * glm::dvec4(p, 1.0)).z;
    low = std::min(low, z);
    high = std::max(high, z);
  }
  const double scale = (random.uniform(0, 1) ? 1.2 : -1.2) / (high - low);
  for (int c = 0; c < 4; ++c)
  {
    view.indexToClip[c][2] *= scale;
  }
  view.indexToClip[3][2] -= 0.5 * scale * (low + high);
  // Special shears would put points on edges between pixels, where rounding decides.
  view.indexToClip[3][0] += 0.3 / view.viewport.x;
  view.indexToClip[3][1] += 0.2 / view.viewport.y;
}

/// Patches at random depths, and background.
Depths randomDepths(const View& view, Random& random)
{
  splatting::Picture picture;
  splatting::placePicture({ ShearWarp(view) }, view.viewport, picture);
  Depths depths{ picture.origin, picture.size,
    std::vector<float>(std::size_t(picture.size.x) * picture.size.y, 1.0f) };
  for (int patch = 0; patch < 12; ++patch)
  {
    const double depth = random.uniform(0.0, 1.0), slope = random.uniform(-0.01, 0.01);
    const int left = random.uniform(0, picture.size.x), bottom = random.uniform(0, picture.size.y);
    const int right = std::min(left + random.uniform(1, 60), picture.size.x);
    const int top = std::min(bottom + random.uniform(1, 60), picture.size.y);
    for (int y = bottom; y < top; ++y)
    {
      for (int x = left; x < right; ++x)
      {
        depths.samples[y * picture.size.x + x] =
          static_cast<float>(std::clamp(depth + slope * (x - left), 0.0, 1.0));
      }
    }
  }
  return depths;
}

enum Cutter
{
  HalfSpaces = 1,
  Convex = 2,
  Bumpy = 4,
  Depth = 8
};

Scene randomScene(Random& random, int cutters)
{
  Scene scene;
  const std::array<int, 3> size = coretesting::randomSize(random, 17);
  scene.view = coretesting::anyView(size, random);
  if (cutters & HalfSpaces)
  {
    scene.halfSpaces = randomHalfSpaces(random, scene.view.dimensions);
  }
  if (cutters & (Convex | Bumpy))
  {
    scene.mesh = randomBlob(random, scene.view.dimensions, cutters & Bumpy ? 0.6 : 0.0);
  }
  if (cutters & Depth)
  {
    spreadDepths(scene.view, random);
    scene.depths = randomDepths(scene.view, random);
  }
  return scene;
}

void testRandomScenes(int cutters, Checks& check)
{
  Random random(40 + cutters);
  Counts counts;
  for (int n = 0; n < 250; ++n)
  {
    compare(randomScene(random, cutters), counts, check);
  }
  std::cout << "cutters " << cutters << ": " << counts.rays << " rays, " << counts.doubtful
            << " left out, " << counts.cut << " samples cut, " << counts.thin << " thin, "
            << counts.hidden << " hidden" << std::endl;
  check(counts.rays > 5000 && counts.cut > 4000, "Enough is cut.");
  check(!(cutters & HalfSpaces) || counts.thin > 50, "Some intervals are thinner than a slice.");
  check(!(cutters & Depth) || counts.hidden > 1000, "Some pixels are hidden.");
  check(20 * counts.doubtful < counts.rays, "Few rays are left out.");
}

/// A box whose faces are cut into many triangles, with the points between moved at random.
Mesh boxOfTriangles(Random& random, const glm::dvec3& low, const glm::dvec3& high, int parts)
{
  Mesh mesh;
  for (int face = 0; face < 6; ++face)
  {
    const int a = face / 2, b = (a + 1) % 3, c = (a + 2) % 3;
    const int first = static_cast<int>(mesh.points.size());
    for (int n = 0; n < (parts + 1) * (parts + 1); ++n)
    {
      const int x = n % (parts + 1), y = n / (parts + 1);
      const auto place = [&](int step, bool isFixed)
      { return (step + (isFixed ? 0.0 : random.uniform(-0.4, 0.4))) / parts; };
      const bool isRim = x == 0 || y == 0 || x == parts || y == parts;
      glm::dvec3 p;
      p[a] = face % 2 ? high[a] : low[a];
      p[b] = low[b] + (high[b] - low[b]) * place(x, isRim);
      p[c] = low[c] + (high[c] - low[c]) * place(y, isRim);
      mesh.points.push_back(p);
    }
    for (int n = 0; n < parts * parts; ++n)
    {
      const int corner = first + n / parts * (parts + 1) + n % parts;
      mesh.triangles.push_back({ corner, corner + 1, corner + parts + 2 });
      mesh.triangles.push_back({ corner, corner + parts + 2, corner + parts + 1 });
    }
  }
  return mesh;
}

/// The slices that a pixel is left of some; all that are empty are equal.
std::pair<int, int> crossedSlicesOf(
  const RayIntervals& intervals, int u, int v, int first, int last)
{
  if (!intervals.empty())
  {
    first = std::max<int>(first, intervals.first(v)[u]);
    last = std::min<int>(last, intervals.last(v)[u]);
  }
  return first > last ? std::pair<int, int>(1, 0) : std::pair<int, int>(first, last);
}

/// Half of the boxes have their corners where rays pass when there is no shear.
void testBoxes(Checks& check)
{
  Random random(7);
  int cut = 0, rays = 0, doubtful = 0;
  for (int n = 0; n < 300; ++n)
  {
    Scene planes, mesh, wide, narrow;
    const std::array<int, 3> size = coretesting::randomSize(random, 20);
    planes.view = coretesting::anyView(size, random);
    mesh.view = wide.view = narrow.view = planes.view;
    glm::dvec3 low = randomPoint(random, planes.view.dimensions);
    glm::dvec3 high = low + glm::abs(randomVector(random)) * 20.0;
    if (n % 2)
    {
      low = glm::floor(low);
      high = glm::floor(high) + 1.0;
    }
    planes.halfSpaces = halfSpacesOfBox(low, high);
    wide.halfSpaces = halfSpacesOfBox(low - Doubt, high + Doubt);
    narrow.halfSpaces = halfSpacesOfBox(low + Doubt, high - Doubt);
    mesh.mesh = boxOfTriangles(random, low, high, random.uniform(1, 5));
    const Found a(planes), b(mesh), c(wide), d(narrow);
    cut += !a.intervals.empty();
    const bool isStraight = a.geometry.shear() == glm::dvec2(0.0);
    std::vector<splatting::SliceGeometry> slices;
    splatting::findSlices(a.geometry, slices);
    splatting::CrossedSlices crossed;
    crossed.reset(slices, a.geometry.width());
    std::vector<std::int16_t> first(a.geometry.width()), last(a.geometry.width());
    for (int v = 0; v < a.geometry.height(); ++v)
    {
      crossed.find(v, first.data(), last.data());
      for (int u = 0; u < a.geometry.width(); ++u)
      {
        if (first[u] > last[u])
        {
          continue;
        }
        // What is cut of the slices that the ray crosses.
        const auto slicesOf = [&](const RayIntervals& intervals)
        { return crossedSlicesOf(intervals, u, v, first[u], last[u]); };
        // Rays along a face are inside; those that meet an edge are for rounding to decide.
        const bool isDoubtful = !isStraight && slicesOf(c.intervals) != slicesOf(d.intervals);
        ++rays;
        doubtful += isDoubtful;
        check(isDoubtful || slicesOf(a.intervals) == slicesOf(b.intervals), "Box ", n,
          ": a surface cuts pixel ", u, ", ", v, " as planes do.");
      }
    }
  }
  std::cout << "boxes: " << cut << " cut, " << rays << " rays, " << doubtful << " left out"
            << std::endl;
  check(cut > 200 && 10 * doubtful < rays, "Most boxes cut, and few rays are left out.");
}

void testNothingCut(Checks& check)
{
  Random random(11);
  for (int n = 0; n < 50; ++n)
  {
    Scene scene;
    scene.view = coretesting::anyView({ 9, 12, 7 }, random);
    check(Found(scene).intervals.empty(), "Nothing cuts.");
    const glm::dvec3 low(-12.0), high(30.0);
    scene.mesh = boxOfTriangles(random, low, high, 2);
    check(Found(scene).intervals.empty(), "A surface around the volume cuts nothing.");
    scene.mesh = {};
    spreadDepths(scene.view, random);
    scene.depths = randomDepths(scene.view, random);
    std::fill(scene.depths.samples.begin(), scene.depths.samples.end(), 0.999f);
    check(Found(scene).intervals.empty(), "What lies behind cuts nothing.");
    std::fill(scene.depths.samples.begin(), scene.depths.samples.end(), 0.001f);
    check(Found(scene).intervals.empty(), "What lies in front hides on the screen.");
  }
}

/// A surface with a hole: rays through the hole cross it once.
void testOpenSurface(Checks& check)
{
  Scene scene;
  scene.view = coretesting::viewWithShear({ 12, 12, 12 }, 2, 0.25, -0.125);
  Random random(3);
  scene.mesh = boxOfTriangles(random, { 2.3, 2.3, 2.3 }, { 8.6, 8.6, 8.6 }, 1);
  scene.mesh.triangles.resize(scene.mesh.triangles.size() - 2); // the last face is across z
  const Found found(scene);
  const int u = found.geometry.margin().x + 5, v = found.geometry.margin().y + 5;
  check(found.intervals.first(v)[u] > found.intervals.last(v)[u],
    "A ray that crosses the surface once shows nothing.");
}
}

//------------------------------------------------------------------------------
int TestRayIntervals(int, char*[])
{
  Checks check;
  for (int cutters :
    { int(HalfSpaces), int(Convex), int(Bumpy), int(Depth), HalfSpaces | Bumpy | Depth })
  {
    testRandomScenes(cutters, check);
  }
  testBoxes(check);
  testNothingCut(check);
  testOpenSurface(check);
  return check.result();
}
