// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The oracle of reductions and cuts itself: rays worked out by hand, and what must hold of any.
#include "CoreTesting.h"
#include "Reductions.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

using namespace coretesting;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// One sample per slice, from the viewer.
reference::CutRay<double> rayOf(std::initializer_list<double> values)
{
  reference::CutRay<double> ray;
  for (double value : values)
  {
    ray.samples.push_back({ value, ray.slices++ });
  }
  return ray;
}

std::vector<double> sorted(const reference::Outcomes<double>& outcomes)
{
  std::vector<double> values;
  for (const auto& outcome : outcomes)
  {
    values.push_back(outcome.hit ? outcome.value : Infinity);
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

void testLocalByHand(Checks& check)
{
  const auto is = [&](std::initializer_list<double> ray, double threshold, double error,
                    const std::vector<double>& expected)
  {
    check(sorted(reference::firstLocalMaximum(rayOf(ray), threshold, error)) == expected,
      "local maximum at or above ", threshold, " of a ray that begins with ",
      ray.size() ? *ray.begin() : Infinity);
  };
  is({ 1, 2, 7, 9 }, -Infinity, 0.0, { 9 });     // rises: the maximum
  is({ 9, 7, 2, 1 }, -Infinity, 0.0, { 9 });     // falls: the first
  is({ 1, 5, 3, 9 }, -Infinity, 0.0, { 5 });     // the first hill
  is({ 1, 5, 3, 9 }, 5.0, 0.0, { 5 });           // just high enough
  is({ 1, 5, 3, 9, 2, 20 }, 6.0, 0.0, { 9 });    // the second
  is({ 1, 5, 3, 9 }, 10.0, 0.0, { 9 });          // none: the global maximum
  is({ 5, 1, 3 }, 10.0, 0.0, { 5 });             // none, and not the last
  is({ 1, 5, 5, 7, 7, 2, 8 }, 2.0, 0.0, { 7 });  // a plateau goes on
  is({ 3, 1, 2, 2.5, 8, 7 }, 4.0, 0.0, { 8 });   // a hill below the threshold is none
  is({ 4, 1, 4, 3, 9 }, 4.0, 0.0, { 4 });        // begins above the threshold
  is({}, 1.0, 0.0, { Infinity });                // no sample
  is({ 1, 5, 4.9, 9, 2 }, 2.0, 0.1, { 5, 9 });   // is it a hill?
  is({ 1, 5, 3, 9, 2 }, 5.05, 0.1, { 5, 9 });    // is it high enough?
  is({ 1, 5, 5.1, 2, 9 }, 2.0, 0.1, { 5, 5.1 }); // is there a dent?
  is({ 1, 5, 3, 9, 2 }, 2.0, 0.1, { 5 });        // sure
}

void testMeanByHand(Checks& check)
{
  const auto ray = rayOf({ 1, 2, 3, 6 });
  check(sorted(reference::mean(ray, -Infinity, Infinity, 0.0)) == std::vector<double>{ 3 }, "mean");
  check(sorted(reference::mean(ray, 2, 3, 0.0)) == std::vector<double>{ 2.5 }, "mean of a range");
  check(sorted(reference::mean(ray, 4, 5, 0.0)) == std::vector<double>{ Infinity }, "mean of none");
  check(sorted(reference::mean(ray, 2.01, 7, 0.1)) == std::vector<double>{ 11.0 / 3, 4.5 },
    "mean of samples that may be in the range");
}

void testDepthByHand(Checks& check)
{
  // Factors 1, 0.75, 0.5, 0.25 of what is above 10.
  const auto ray = rayOf({ 10, 14, 26, 30 });
  const auto shaded = reference::depthShaded(ray, 10.0, 0.0, 1.0);
  check(sorted(shaded) == std::vector<double>{ 18 }, "depth-shaded maximum");
}

reference::RayCuts randomCuts(reference::Random& random, const std::array<int, 3>& size)
{
  reference::RayCuts cuts;
  for (int n = random.uniform(0, 3); n > 0; --n)
  {
    std::array<double, 4> h{ random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
      random.uniform(-1.0, 1.0), 0.0 };
    for (int a = 0; a < 3; ++a)
    {
      h[3] -= h[a] * random.uniform(0.0, double(size[a]));
    }
    cuts.halfSpaces.push_back(h);
  }
  for (int a = 0; a < 3; ++a)
  {
    const double p = random.uniform(-1.0, double(size[a])),
                 q = random.uniform(-1.0, double(size[a]));
    cuts.planes[a] = { std::min(p, q), std::max(p, q) };
  }
  return cuts;
}

/// Each sample lies in one of the 27 regions; without cuts nothing is lost; the far side sees the
/// same samples in the other order.
void testCuts(Checks& check)
{
  reference::forScenes("cuts", 60,
    [&](int, reference::Random& random)
    {
      const auto volume = wholeRangeNoise<std::int16_t>(randomSize(random, 8), random);
      const reference::ShearView view =
        referenceView(splatting::ShearWarp(anyView(volume.size, random)));
      const auto grid = reference::makeShearGrid(volume.size, view);
      const auto rays = reference::voxelSamples(volume, view);
      reference::RayCuts cuts = randomCuts(random, volume.size);
      const reference::RayCutter all(grid, view, cuts);
      const reference::RayCutter none(grid, view, {});
      for (int u = 0; u < grid.width; ++u)
      {
        const int v = random.uniform(0, grid.height - 1);
        const auto& samples = rays[std::size_t(v) * grid.width + u];
        const auto whole = reference::cutRay(samples, all, u, v, false);
        const auto far = reference::cutRay(samples, all, u, v, true);
        check(reference::cutRay(samples, none, u, v, false).samples.size() == samples.size(),
          "something cuts without cuts");
        check(whole.slices == far.slices && whole.samples.size() == far.samples.size() &&
            reference::largest(whole)[0].value == reference::largest(far)[0].value,
          "the two sides see other samples");
        const bool reversed =
          std::equal(whole.samples.begin(), whole.samples.end(), far.samples.rbegin(),
            [&](const auto& a, const auto& b)
            { return a.value == b.value && a.number == whole.slices - 1 - b.number; });
        check(reversed, "the far side's order is not the reverse");
        std::size_t parts = 0;
        for (int region = 0; region < 27; ++region)
        {
          cuts.regions = 1u << region;
          const reference::RayCutter one(grid, view, cuts);
          parts += reference::cutRay(samples, one, u, v, false).samples.size();
        }
        cuts.regions = (1u << 27) - 1;
        check(parts == whole.samples.size(), "regions overlap or have gaps");
        check(reference::depthShaded(reference::toDouble(whole), 7.0, 1.0, 0.0)[0].value ==
            double(reference::largest(whole)[0].value),
          "shades where there are none");
      }
    });
}

/// Two planes closer than slices leave one slice, wherever they are; so does a thin middle region.
void testThinCuts(Checks& check)
{
  const std::array<int, 3> size{ 6, 7, 9 };
  reference::forScenes("thin cuts", 100,
    [&](int, reference::Random& random)
    {
      const reference::ShearView view{ 2, { 0.25, -0.5 } };
      const auto grid = reference::makeShearGrid(size, view);
      const int u = grid.width / 2, v = grid.height / 2;
      const double depth = random.uniform(2.0, 6.0);
      const int nearest = int(std::floor(depth + 0.505));
      reference::RayCuts planes;
      planes.halfSpaces = { { 0, 0, 1, -depth }, { 0, 0, -1, depth + 0.01 } };
      reference::RayCuts regions;
      regions.planes = { { { -1, 9 }, { -1, 9 }, { depth, depth + 0.01 } } };
      regions.regions = 1u << 13;
      const reference::RayCutter planesCut(grid, view, planes), regionsCut(grid, view, regions);
      for (int k = 0; k < size[2]; ++k)
      {
        check(planesCut.inHalfSpaces(u, v, k) == (k == nearest), "planes ", depth, ", slice ", k);
        check(regionsCut.inRegions(u, v, k) == (k == nearest), "region ", depth, ", slice ", k);
      }
    });
}

/// The mirrored volume seen from the other side is the same ray for ray.
void testMirror(Checks& check)
{
  Sightings differing;
  reference::forScenes("mirrors", 20,
    [&](int, reference::Random& random)
    {
      const auto volume = wholeRangeNoise<std::uint8_t>(randomSize(random, 8), random);
      const reference::ShearView view =
        referenceView(splatting::ShearWarp(anyView(volume.size, random)));
      reference::AxisSymmetry mirror;
      mirror.sign[view.axis] = -1;
      const auto mirrored = reference::transformed(volume, mirror);
      const auto mirroredView = reference::transformed(view, mirror);
      const auto grid = reference::makeShearGrid(volume.size, view);
      const auto rays = reference::voxelSamples(volume, view);
      const auto mirroredRays = reference::voxelSamples(mirrored, mirroredView);
      const reference::RayCutter cutter(grid, view, {});
      int differ = 0;
      for (int v = 0; v < grid.height; ++v)
      {
        for (int u = 0; u < grid.width; ++u)
        {
          const std::size_t pixel = std::size_t(v) * grid.width + u;
          const auto local = [&](const auto& all, bool reversed)
          {
            return reference::firstLocalMaximum(
              reference::cutRay(all[pixel], cutter, u, v, reversed), 128.0, 0.0)[0];
          };
          const auto own = local(rays, false), other = local(mirroredRays, true);
          check(own.hit == other.hit && own.value == other.value, "a mirror changes local maxima");
          differ += own.value != local(rays, true).value;
        }
      }
      differing.add(differ > 0);
    });
  check(differing.areEnough(0.3), "both sides see other first local maxima in only ", differing);
}
}

int TestReferenceReductions(int, char*[])
{
  Checks check;
  testLocalByHand(check);
  testMeanByHand(check);
  testDepthByHand(check);
  testCuts(check);
  testThinCuts(check);
  testMirror(check);
  return check.result();
}
