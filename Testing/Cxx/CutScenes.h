// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Random scenes that cut rays.
 */
#ifndef CutScenes_h
#define CutScenes_h

#include "CutOracle.h"

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace cutscenes
{
/// A sphere, stretched and turned, with the radius changed by up to `bumps`.
inline Mesh randomBlob(Random& random, const glm::ivec3& size, double bumps)
{
  const int rings = random.uniform(3, 9), sectors = random.uniform(3, 11);
  const glm::dvec3 centre = anyPoint(toArray(size), random);
  const glm::dmat3 stretch{ anyVector(random, -1.0, 1.0), anyVector(random, -1.0, 1.0),
    anyVector(random, -1.0, 1.0) };
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

/// A box whose faces are cut into many triangles, with the points between moved at random.
inline Mesh boxOfTriangles(Random& random, const glm::dvec3& low, const glm::dvec3& high, int parts)
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

/// Patches at depths from `depthOf(random)` on, and background.
template <class F>
Depths randomDepths(const glm::ivec2& origin, const glm::ivec2& size, Random& random, F&& depthOf)
{
  Depths depths{ origin, size, std::vector<float>(std::size_t(size.x) * size.y, 1.0f) };
  for (int patch = 0; patch < 12; ++patch)
  {
    const double depth = depthOf(random), slope = random.uniform(-0.01, 0.01);
    const int left = random.uniform(0, size.x), bottom = random.uniform(0, size.y);
    const int right = std::min(left + random.uniform(1, 60), size.x);
    const int top = std::min(bottom + random.uniform(1, 60), size.y);
    for (int y = bottom; y < top; ++y)
    {
      for (int x = left; x < right; ++x)
      {
        depths.samples[y * size.x + x] =
          static_cast<float>(std::clamp(depth + slope * (x - left), 0.0, 1.0));
      }
    }
  }
  return depths;
}

/// Counts scenes in which a box cuts rays, contains the eye, and has few rays that are not
/// compared.
struct BoxCounts
{
  coretesting::Sightings cut, holding, sure;
};

/// The eye of a perspective image in index space.
inline glm::dvec3 eyeOf(const ShearWarp& image)
{
  glm::dvec3 eye;
  for (int a = 0; a < 3; ++a)
  {
    eye[image.axes()[a]] = image.eye()[a];
  }
  return eye;
}

inline bool isWithin(const glm::dvec3& p, const glm::dvec3& low, const glm::dvec3& high)
{
  return glm::all(glm::lessThan(low, p)) && glm::all(glm::lessThan(p, high));
}

/// Compares the cuts of a box of triangles with those of six planes.
/// @param margin  larger than the rounding errors of rays and eye
inline void compareBox(Checks& check, const View& view, const glm::dvec3& low,
  const glm::dvec3& high, double margin, Random& random, BoxCounts& counts)
{
  Scene planes, mesh, wide, narrow;
  planes.view = mesh.view = wide.view = narrow.view = view;
  planes.view.halfSpaces = halfSpacesOfBox(low, high);
  wide.view.halfSpaces = halfSpacesOfBox(low - margin, high + margin);
  narrow.view.halfSpaces = halfSpacesOfBox(low + margin, high - margin);
  const int parts = random.uniform(1, 5);
  mesh.mesh = boxOfTriangles(random, low, high, parts);
  const Found a(planes), b(mesh), c(wide), d(narrow);
  int rays = 0, doubtful = 0;
  bool isHolding = false;
  for (std::size_t n = 0; n < a.images.size(); ++n)
  {
    const ShearWarp& image = a.images[n];
    const glm::dvec3 eye = eyeOf(image);
    const bool isStraight = !image.isPerspective() && image.shear() == glm::dvec2(0.0);
    isHolding |= image.isPerspective() && isWithin(eye, low, high);
    // Rounding decides whether a box contains an eye on its face.
    const bool isOnFace = image.isPerspective() && isWithin(eye, low - margin, high + margin) &&
      !isWithin(eye, low + margin, high - margin);
    const Oracle oracle(planes, image);
    forEachRay(oracle,
      [&](int u, int v, const std::vector<int>& crossed)
      {
        const auto slicesOf = [&](const Found& found)
        { return left(found.intervals[n], u, v, crossed); };
        // Rays along a face are inside. For rays that meet an edge rounding decides.
        const bool isDoubtful = isOnFace ||
          (!isStraight &&
            (slicesOf(c) != slicesOf(d) ||
              meetsEdge(oracle, u, v, wide.view.halfSpaces, narrow.view.halfSpaces)));
        ++rays;
        doubtful += isDoubtful;
        check(isDoubtful || slicesOf(a) == slicesOf(b), "A surface cuts pixel ", u, ", ", v,
          " as planes do. Eye ", eye.x, " ", eye.y, " ", eye.z, ", box ", low.x, " ", low.y, " ",
          low.z, " to ", high.x, " ", high.y, " ", high.z);
      });
  }
  counts.cut.add(!a.cutsNothing());
  counts.holding.add(isHolding);
  counts.sure.add(10 * doubtful <= rays);
}

enum Cutter
{
  HalfSpaces = 1,
  Convex = 2,
  Bumpy = 4,
  Depth = 8
};

/// What scenes are cut by, and the name of their series.
struct Series
{
  int cutters;
  const char* name;
};

inline const Series allSeries[] = { { HalfSpaces, "half-spaces" }, { Convex, "convex surfaces" },
  { Bumpy, "bumpy surfaces" }, { Depth, "depth buffers" },
  { HalfSpaces | Bumpy | Depth, "all cutters" } };

/// Compares `count` scenes and judges that they show what they are made for.
template <class F>
void compareSeries(const Series& series, int count, F&& randomScene, Checks& check)
{
  Counts all;
  coretesting::Sightings cut, thin, hidden, sure;
  reference::forScenes(series.name, count,
    [&](int, Random& random)
    {
      Counts counts;
      compare(randomScene(random, series.cutters), counts, check);
      cut.add(counts.cut > 0 && counts.kept > 0);
      thin.add(counts.thin > 0);
      hidden.add(counts.hidden > 0);
      sure.add(20 * counts.doubtful <= counts.rays);
      all.rays += counts.rays;
      all.doubtful += counts.doubtful;
      all.cut += counts.cut;
      all.kept += counts.kept;
    });
  std::cout << series.name << ": " << all.rays << " rays, " << all.doubtful << " left out, "
            << all.cut << " samples cut, " << all.kept << " kept; some cut and some kept in " << cut
            << ", intervals thinner than a slice in " << thin << ", hidden pixels in " << hidden
            << ", next to no ray left out in " << sure << std::endl;
  check(cut.areEnough(0.3), series.name, ": some samples are cut and some kept in only ", cut);
  check(!(series.cutters & HalfSpaces) || thin.areEnough(0.2), series.name,
    ": intervals thinner than a slice in only ", thin);
  check(!(series.cutters & Depth) || hidden.areEnough(0.3), series.name, ": hidden pixels in only ",
    hidden);
  check(sure.areEnough(0.6), series.name, ": next to no ray is left out in only ", sure);
}
}

#endif
