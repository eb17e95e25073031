// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TestPixelAreas
//
// Views whose pixels are wider than voxels: what areas of shear images show, and images of which
// each ray meets the nearest voxel of a slice only.
#include "CoreTesting.h"
#include "WideViews.h"

#include "Display/Warp.h"

#include <glm/common.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <vector>

using namespace coretesting;

namespace
{
using Images = std::vector<splatting::ShearImage>;
using Geometries = std::vector<splatting::ShearWarp>;

constexpr float Background = -100.0f; // below all values

/// A float image of a function of the pixel, as wide as a preview's; some have holes.
template <class F>
splatting::ShearImage imageOf(
  const splatting::ShearWarp& geometry, bool hasHoles, reference::Random& random, F&& f)
{
  const auto size = geometry.size();
  std::array<int, 3> dimensions;
  for (int a = 0; a < 3; ++a)
  {
    dimensions[geometry.axes()[a]] = size[a];
  }
  splatting::ProjectionSettings settings;
  settings.quality = splatting::Quality::Preview;
  splatting::ShearImage image =
    project(reference::constant<float>(dimensions, 0.0f), geometry, settings);
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      image.row<float>(v)[u] = static_cast<float>(f(u, v));
    }
  }
  if (hasHoles)
  {
    image.mask.resize(std::size_t(image.width) * image.height);
    for (unsigned char& sample : image.mask)
    {
      sample = random.uniform(0, 9) > 0;
    }
  }
  return image;
}

Images noise(const Geometries& geometries, bool hasHoles, reference::Random& random)
{
  Images images;
  for (const splatting::ShearWarp& geometry : geometries)
  {
    images.push_back(
      imageOf(geometry, hasHoles, random, [&](int, int) { return random.uniform(0.0, 1.0); }));
    splatting::ShearImage& image = images.back();
    image.winners.assign(std::size_t(image.width) * image.height, 0);
    for (std::size_t n = 0; n < image.mask.size(); ++n)
    {
      image.winners[n] = image.mask[n] ? 0 : -1;
    }
  }
  return images;
}

std::vector<float> picture(const Images& images, const Geometries& geometries,
  splatting::Reduction reduction, const glm::ivec2& viewport, reference::Random& random)
{
  std::vector<float> pixels(std::size_t(viewport.x) * viewport.y, Background);
  splatting::Warper().warpScalars(
    images, geometries, reduction, viewport, anyInstructionSet(random), Background, pixels.data());
  return pixels;
}

/// For each pixel the largest value that was found in its area, by way of places of the image: all
/// samples, and places on the lines between them.
class Scatter
{
public:
  static constexpr int Steps = 64; // from sample to sample

  explicit Scatter(const glm::ivec2& viewport)
    : Values(std::size_t(viewport.x) * viewport.y, Background),
      Viewport(viewport)
  {
  }

  void add(const splatting::ShearImage& image, const splatting::ShearWarp& geometry)
  {
    for (int v = 0; v < image.height; ++v)
    {
      for (int u = 0; u < image.width; ++u)
      {
        const bool isDue = image.covers(u, v) && isShown(geometry, u, v);
        for (int n = 0; n < Steps && isDue; ++n)
        {
          const double share = double(n) / Steps;
          const float here = image.row<float>(v)[u];
          if (n == 0 || (image.covers(u + 1, v) && isShown(geometry, u + 1, v)))
          {
            const float next = n ? image.row<float>(v)[u + 1] : here;
            this->put(geometry, { u + share, v }, (1.0 - share) * here + share * next);
          }
          if (n > 0 && image.covers(u, v + 1) && isShown(geometry, u, v + 1))
          {
            const float next = image.row<float>(v + 1)[u];
            this->put(geometry, { u, v + share }, (1.0 - share) * here + share * next);
          }
        }
      }
    }
  }

  float at(std::size_t n) const { return this->Values[n]; }

private:
  /// Whether a ray passes between the outermost voxels' centres, where the picture does not end:
  /// the outermost half slices are beyond.
  static bool isShown(const splatting::ShearWarp& geometry, int u, int v)
  {
    if (u >= geometry.rayCount().x || !meets(geometry, u, v, -0.5 - 1e-6))
    {
      return false;
    }
    const glm::dvec3 last = glm::dvec3(geometry.size()) - 1.0;
    double near = last.z > 0.0 ? 0.0 : -0.5, far = last.z > 0.0 ? last.z : 0.5;
    for (int a = 0; a < 2; ++a)
    {
      const splatting::Fan& fan = a == 0 ? geometry.columns() : geometry.rows();
      const int n = a == 0 ? u : v;
      const double first = (1e-6 - fan.at[n]) / fan.slope[n];
      const double second = (last[a] - 1e-6 - fan.at[n]) / fan.slope[n];
      near = std::max(near, geometry.reference() + std::min(first, second));
      far = std::min(far, geometry.reference() + std::max(first, second));
    }
    return near <= far;
  }

  void put(const splatting::ShearWarp& geometry, const glm::dvec2& place, double value)
  {
    const glm::dvec3 h = geometry.shearToScreen() * glm::dvec3(place, 1.0);
    const glm::dvec2 p = glm::dvec2(h) / h.z;
    // Places within 1e-9 of two areas are left to both, or to none: others are beside them.
    const glm::ivec2 pixel(glm::floor(p + 0.5));
    const glm::dvec2 off = glm::abs(p - glm::dvec2(pixel));
    const bool isClear = off.x < 0.5 - 1e-9 && off.y < 0.5 - 1e-9;
    if (isClear && pixel.x >= 0 && pixel.y >= 0 && pixel.x < this->Viewport.x &&
      pixel.y < this->Viewport.y)
    {
      float& largest = this->Values[std::size_t(pixel.y) * this->Viewport.x + pixel.x];
      largest = std::max(largest, static_cast<float>(value));
    }
  }

  std::vector<float> Values;
  glm::ivec2 Viewport;
};

splatting::View someView(int n, reference::Random& random)
{
  const auto size = randomSize(random, 24);
  return reduced(n % 2 ? randomPerspective(size, random) : anyView(size, random));
}

void testExtrema(Checks& check)
{
  Sightings wide;
  reference::forScenes("extrema", 200,
    [&](int n, reference::Random& random)
    {
      const splatting::View view = someView(n, random);
      Geometries geometries;
      splatting::ShearWarp::factorise(view, geometries, n % 3 ? 1 : 2);
      if (geometries.empty() || !geometries.front().isOverview())
      {
        wide.add(false);
        return;
      }
      wide.add(true);
      const Images images = noise(geometries, n % 4 == 0, random);
      Images mirrored = images;
      Scatter scatter(view.viewport);
      for (std::size_t i = 0; i < images.size(); ++i)
      {
        scatter.add(images[i], geometries[i]);
        float* const pixels = mirrored[i].row<float>(0);
        std::transform(pixels, pixels + std::size_t(images[i].width) * images[i].height, pixels,
          [](float x) { return -x; });
      }
      const auto largest =
        picture(images, geometries, splatting::Reduction::Maximum, view.viewport, random);
      const auto least =
        picture(mirrored, geometries, splatting::Reduction::Minimum, view.viewport, random);
      // Places are a step apart at most; values change by 1 from sample to sample at most. Corners
      // lie beside lines, where the image is no larger than on both lines about them together.
      for (std::size_t p = 0; p < largest.size(); ++p)
      {
        const float known = scatter.at(p);
        check(largest[p] >= known - 1e-6f, "pixel ", p, " shows ", largest[p],
          ", less than there is in its area: ", known);
        check(least[p] == (largest[p] == Background ? Background : -largest[p]), "pixel ", p,
          ": the least is no mirror of the largest");
      }
    });
  check(wide.areEnough(0.8), "only ", wide, " have wide pixels");
}

/// How near the outline of a pixel's area comes to a sample along both axes, in samples.
double distanceToOutline(
  const splatting::ShearWarp& geometry, int x, int y, const glm::dvec2& sample)
{
  double nearest = std::numeric_limits<double>::infinity();
  constexpr int steps = 200;
  for (int side = 0; side < 4 * steps; ++side)
  {
    const double along = double(side % steps) / steps - 0.5;
    const glm::dvec2 border[] = { { along, -0.5 }, { 0.5, along }, { -along, 0.5 },
      { -0.5, -along } };
    const glm::dvec3 h =
      geometry.screenToShear() * glm::dvec3(glm::dvec2(x, y) + border[side / steps], 1.0);
    const glm::dvec2 off = glm::abs(glm::dvec2(h) / h.z - sample);
    nearest = std::min(nearest, std::max(off.x, off.y));
  }
  return nearest;
}

/// What a pixel shows of a sample depends on how near its area is.
void testNothingElse(Checks& check)
{
  reference::forScenes("nothing else", 100,
    [&](int n, reference::Random& random)
    {
      const splatting::View view = someView(n, random);
      Geometries geometries;
      splatting::ShearWarp::factorise(view, geometries);
      if (geometries.empty() || !geometries.front().isOverview())
      {
        return;
      }
      // One bright sample: a pyramid as wide as two samples.
      Images images;
      for (const splatting::ShearWarp& geometry : geometries)
      {
        images.push_back(imageOf(geometry, false, random, [](int, int) { return 0.0; }));
      }
      const std::size_t which = random.uniform(0, static_cast<int>(images.size()) - 1);
      splatting::ShearImage& image = images[which];
      const int v = random.uniform(0, image.height - 1);
      if (image.spans[v].empty())
      {
        return;
      }
      const int u = random.uniform(image.spans[v].begin, image.spans[v].end - 1);
      image.row<float>(v)[u] = 1.0f;
      const auto found =
        picture(images, geometries, splatting::Reduction::Maximum, view.viewport, random);
      for (int y = 0; y < view.viewport.y; ++y)
      {
        for (int x = 0; x < view.viewport.x; ++x)
        {
          const double nearest = distanceToOutline(geometries[which], x, y, { u, v });
          const glm::dvec3 h = geometries[which].shearToScreen() * glm::dvec3(u, v, 1.0);
          const glm::dvec2 at = glm::abs(glm::dvec2(h) / h.z - glm::dvec2(x, y));
          const bool inside = at.x <= 0.5 && at.y <= 0.5 && h.z > 0.0;
          const float value = found[std::size_t(y) * view.viewport.x + x];
          check(!inside || at.x > 0.4999 || at.y > 0.4999 || value == 1.0f,
            "a sample is lost in its pixel's area: ", value);
          check(inside || value <= std::max(0.0, 1.0 - nearest) + 0.05, "a pixel shows ", value,
            " of a sample that is ", nearest, " away");
        }
      }
    });
}

/// Averages of linear images are their values at pixels' centres, those of noise are means of
/// places that are no farther apart than samples.
void testAverages(Checks& check)
{
  Sightings inside;
  reference::forScenes("averages", 60,
    [&](int, reference::Random& random)
    {
      const splatting::View view = reduced(anyView(randomSize(random, 30), random));
      const Geometries geometries{ splatting::ShearWarp(view) };
      const splatting::ShearWarp& geometry = geometries.front();
      if (!geometry.valid() || !geometry.isOverview())
      {
        return;
      }
      const double a = random.uniform(-1.0, 1.0), b = random.uniform(-1.0, 1.0);
      const Images linear{ imageOf(
        geometry, false, random, [=](int u, int v) { return a * u + b * v; }) };
      const Images rough = noise(geometries, false, random);
      const auto mean = splatting::Reduction::Mean;
      const auto means = picture(linear, geometries, mean, view.viewport, random);
      const auto roughMeans = picture(rough, geometries, mean, view.viewport, random);
      const glm::dmat3& m = geometry.screenToShear();
      const glm::ivec2 steps(std::max(std::ceil(glm::length(glm::dvec2(m[0])) - 1e-9), 1.0),
        std::max(std::ceil(glm::length(glm::dvec2(m[1])) - 1e-9), 1.0));
      const splatting::ShearImage& image = rough.front();
      for (int y = 0; y < view.viewport.y; ++y)
      {
        for (int x = 0; x < view.viewport.x; ++x)
        {
          double sum = 0.0;
          bool isWhole = true;
          for (int n = 0; n < steps.x * steps.y && isWhole; ++n)
          {
            const glm::dvec2 off((n % steps.x + 0.5) / steps.x, (n / steps.x + 0.5) / steps.y);
            const glm::dvec2 p(m * glm::dvec3(glm::dvec2(x, y) - 0.5 + off, 1.0));
            const glm::ivec2 low(glm::floor(p));
            for (int corner = 0; corner < 4; ++corner)
            {
              const glm::ivec2 at = low + glm::ivec2(corner % 2, corner / 2);
              const glm::dvec2 w = 1.0 - glm::abs(p - glm::dvec2(at));
              isWhole = isWhole && image.covers(at.x, at.y);
              sum += isWhole ? w.x * w.y * image.row<float>(at.y)[at.x] : 0.0;
            }
          }
          inside.add(isWhole);
          if (isWhole)
          {
            const std::size_t n = std::size_t(y) * view.viewport.x + x;
            const glm::dvec2 p(m * glm::dvec3(x, y, 1.0));
            check(std::abs(means[n] - (a * p.x + b * p.y)) < 1e-4, "a linear image has a mean of ",
              means[n], " at its value ", a * p.x + b * p.y);
            check(std::abs(roughMeans[n] - sum / (steps.x * steps.y)) < 1e-5, "the mean is ",
              roughMeans[n], ", not ", sum / (steps.x * steps.y));
          }
        }
      }
    });
  check(inside.areEnough(0.003), "only ", inside, " pixels are inside");
}

/// The location of a pixel is the sample that it shows.
void testLocations(Checks& check)
{
  Sightings samples;
  reference::forScenes("locations", 60,
    [&](int n, reference::Random& random)
    {
      const splatting::View view = someView(n, random);
      Geometries geometries;
      splatting::ShearWarp::factorise(view, geometries);
      if (geometries.empty() || !geometries.front().isOverview())
      {
        return;
      }
      const Images images = noise(geometries, n % 4 == 0, random);
      const auto found =
        picture(images, geometries, splatting::Reduction::Maximum, view.viewport, random);
      std::vector<splatting::ShearPixel> shown(found.size());
      splatting::findShearPixels(images, geometries, splatting::Reduction::Maximum, glm::ivec2(0),
        view.viewport, shown.data());
      for (std::size_t p = 0; p < found.size(); ++p)
      {
        check((shown[p].image < 0) == (found[p] == Background), "pixel ", p,
          " shows a sample or has a location, not both: ", found[p], ", ", shown[p].u, " ",
          shown[p].v);
        if (shown[p].image < 0)
        {
          continue;
        }
        const splatting::ShearImage& image = images[shown[p].image];
        const float value = image.row<float>(shown[p].v)[shown[p].u];
        const glm::dvec3 h =
          geometries[shown[p].image].shearToScreen() * glm::dvec3(shown[p].u, shown[p].v, 1.0);
        const glm::dvec2 off = glm::abs(glm::dvec2(h) / h.z -
          glm::dvec2(double(p % view.viewport.x), double(p / view.viewport.x)));
        const bool inside = off.x < 0.5 && off.y < 0.5;
        samples.add(value == found[p]);
        const glm::dvec2 sample(shown[p].u, shown[p].v);
        const int x = static_cast<int>(p % view.viewport.x);
        const int y = static_cast<int>(p / view.viewport.x);
        check(inside || distanceToOutline(geometries[shown[p].image], x, y, sample) < 0.52,
          "a location is neither in its pixel's area nor the nearest to a place on its outline");
        check(value <= found[p] || !inside, "a sample in the area is larger than the pixel");
        splatting::ShearPixel alone;
        const glm::ivec2 at(p % view.viewport.x, p / view.viewport.x);
        splatting::findShearPixels(
          images, geometries, splatting::Reduction::Maximum, at, glm::ivec2(1), &alone);
        check(alone.image == shown[p].image && alone.u == shown[p].u && alone.v == shown[p].v,
          "a pixel alone has another location");
      }
    });
  check(samples.areEnough(0.1), "only ", samples, " pixels show samples themselves");
}

/// Of each slice a ray meets the voxel that it passes nearest to in the middle.
template <class T>
void testNearest(Checks& check)
{
  reference::forScenes(seriesOf<T>("nearest"), 12,
    [&](int n, reference::Random& random)
    {
      const auto volume = wholeRangeNoise<T>(randomSize(random, 20), random);
      Geometries geometries;
      splatting::ShearWarp::factorise(
        n % 2 ? randomPerspective(volume.size, random) : anyView(volume.size, random), geometries,
        anySampling(random), splatting::Meets::Nearest);
      for (const splatting::ShearWarp& geometry : geometries)
      {
        if (geometry.phases() > 1)
        {
          continue;
        }
        splatting::ProjectionSettings settings;
        settings.quality = splatting::Quality::Preview;
        settings.instructionSet = anyInstructionSet(random);
        settings.acceleration =
          n % 3 ? splatting::Acceleration::Dense : splatting::Acceleration::Bricks;
        const auto found = toReference<T>(project(volume, geometry, settings));
        for (int v = 0; v < geometry.rayCount().y; ++v)
        {
          for (int u = 0; u < geometry.rayCount().x; ++u)
          {
            // Rays that pass between two voxels may meet either.
            T least = std::numeric_limits<T>::lowest(), most = least;
            bool isHit = false, isOpen = false;
            for (int k = geometry.slices().begin; k < geometry.slices().end; ++k)
            {
              const glm::dvec2 p = geometry.onRay(u, v, k);
              const glm::dvec2 off = glm::abs(glm::fract(p) - 0.5);
              const bool isTie = std::min(off.x, off.y) < 1e-9;
              isOpen = isOpen || isTie;
              for (int way = 0; way < (isTie ? 4 : 1); ++way)
              {
                const glm::dvec2 nudge(way % 2 ? 1e-6 : -1e-6, way / 2 ? 1e-6 : -1e-6);
                glm::ivec3 voxel(
                  glm::ivec2(glm::floor(p + 0.5 + (isTie ? nudge : glm::dvec2(0.0)))), k);
                if (voxel.x < 0 || voxel.y < 0 || voxel.x >= geometry.size().x ||
                  voxel.y >= geometry.size().y)
                {
                  continue;
                }
                std::array<int, 3> at;
                for (int a = 0; a < 3; ++a)
                {
                  at[geometry.axes()[a]] = voxel[a];
                }
                const T value = volume.at(at[0], at[1], at[2]);
                most = std::max(most, value);
                least = isTie ? least : std::max(least, value);
                isHit = isHit || !isTie;
              }
            }
            if (isHit || !isOpen)
            {
              check(found.isHit(u, v) == isHit, "a ray has a sample or not: ", u, ", ", v);
            }
            if (found.isHit(u, v))
            {
              check(found.at(u, v) >= least && found.at(u, v) <= most,
                "the nearest voxels are not met: ", double(found.at(u, v)), ", not ",
                double(least));
            }
          }
        }
      }
    });
}

/// In parallel views each voxel is met by one ray: their sum is the volume's.
void testEachVoxelOnce(Checks& check)
{
  reference::forScenes("each voxel once", 40,
    [&](int, reference::Random& random)
    {
      const auto size = randomSize(random, 20);
      const splatting::ShearWarp geometry(anyView(size, random), 1, splatting::Meets::Nearest);
      auto volume = reference::constant<float>(size, 0.0f);
      const int voxel = random.uniform(0, static_cast<int>(volume.voxels.size()) - 1);
      volume.voxels[voxel] = 1.0f;
      splatting::ProjectionSettings settings;
      settings.quality = splatting::Quality::Preview;
      const splatting::ShearImage image = project(volume, geometry, settings);
      int count = 0;
      for (int v = 0; v < image.height; ++v)
      {
        for (int u = 0; u < image.width; ++u)
        {
          count += image.covers(u, v) && image.row<float>(v)[u] == 1.0f;
        }
      }
      check(count == 1, count, " rays meet a voxel");
    });
}

/// How wide a pixel is in voxels.
void testWidths(Checks& check)
{
  reference::forScenes("widths", 100,
    [&](int, reference::Random& random)
    {
      // So many pixels of the screen per unit of the world, and voxels of these sides.
      const double zoom = random.uniform(0.2, 3.0);
      const glm::dvec3 spacing = anyVector(random, 0.3, 3.0);
      splatting::View view;
      view.dimensions = toGlm(randomSize(random, 30));
      view.viewport = { 90, 70 };
      const glm::dvec3 eye = glm::normalize(anyVector(random, -1.0, 1.0)) * 100.0;
      const glm::dvec2 half = 0.5 * glm::dvec2(view.viewport) / zoom;
      view.indexToClip = glm::ortho(-half.x, half.x, -half.y, half.y, 1.0, 1000.0) *
        glm::lookAt(eye, glm::dvec3(0.0), anyVector(random, -1.0, 1.0)) *
        glm::scale(glm::dmat4(1.0), spacing);
      const glm::dvec2 width = splatting::voxelsPerPixel(view);
      const double least = std::min({ spacing.x, spacing.y, spacing.z });
      const double most = std::max({ spacing.x, spacing.y, spacing.z });
      // Along the side of a voxel that lies across the view it is one over its pixels.
      check(width.x >= 1.0 / (zoom * most) - 1e-9 && width.y <= 1.0 / (zoom * least) + 1e-9 &&
          width.x <= width.y + 1e-9,
        "pixels are ", width.x, " to ", width.y, " voxels wide");
      check(splatting::isOverview(view) == (width.y > 1.0 + 1e-6) &&
          splatting::isCoarse(view) == (width.x > 1.0 + 1e-6),
        "what an overview is");
      // Of cubes it is the same from everywhere.
      view.indexToClip = view.indexToClip * glm::scale(glm::dmat4(1.0), 1.0 / spacing);
      const glm::dvec2 ofCubes = splatting::voxelsPerPixel(view);
      check(std::abs(ofCubes.x * zoom - 1.0) < 1e-6 && std::abs(ofCubes.y * zoom - 1.0) < 1e-6,
        "pixels are ", ofCubes.x, " to ", ofCubes.y, " cubes wide, not ", 1.0 / zoom);
    });
  splatting::View inside;
  inside.dimensions = { 30, 30, 30 };
  inside.viewport = { 8, 8 };
  inside.indexToClip = glm::perspective(1.0, 1.0, 0.1, 100.0) *
    glm::lookAt(glm::dvec3(15.0), glm::dvec3(0.0), glm::dvec3(0.0, 0.0, 1.0));
  check(!splatting::isOverview(inside), "from inside a volume there is no overview");
}
}

int TestPixelAreas(int, char*[])
{
  Checks check;
  testWidths(check);
  testExtrema(check);
  testNothingElse(check);
  testAverages(check);
  testLocations(check);
  forEachType([&](auto* null) { testNearest<std::remove_pointer_t<decltype(null)>>(check); });
  testEachVoxelOnce(check);
  return check.result();
}
