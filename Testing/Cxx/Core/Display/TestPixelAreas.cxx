// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TestPixelAreas
//
// Views whose pixels are wider than voxels: the extrema of areas of shear images.
#include "PixelAreaTesting.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace coretesting;

namespace
{
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

void testExtrema(Checks& check)
{
  const Sightings wide = forOverviews("extrema", 200,
    [&](int n, const splatting::View& view, const Geometries& geometries, reference::Random& random)
    {
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

/// How near a straight line comes to a sample along both axes, in samples.
double distanceToLine(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& sample)
{
  const glm::dvec2 a = from - sample, way = to - from;
  double nearest = std::numeric_limits<double>::infinity();
  // It is nearest at an end, or where one coordinate is 0 or as large as the other.
  for (const double at : { 0.0, 1.0, -a.x / way.x, -a.y / way.y, (a.y - a.x) / (way.x - way.y),
         -(a.x + a.y) / (way.x + way.y) })
  {
    const double on = at > 0.0 ? std::min(at, 1.0) : 0.0; // of no way at all, NaN
    const glm::dvec2 off = glm::abs(a + on * way);
    nearest = std::min(nearest, std::max(off.x, off.y));
  }
  return nearest;
}

/// How near the outline of a pixel's area comes to a sample along both axes, in samples.
double distanceToOutline(
  const splatting::ShearWarp& geometry, int x, int y, const glm::dvec2& sample)
{
  const glm::dvec2 corners[] = { { -0.5, -0.5 }, { 0.5, -0.5 }, { 0.5, 0.5 }, { -0.5, 0.5 } };
  const auto corner = [&](int n)
  { return geometry.screenToShear() * glm::dvec3(glm::dvec2(x, y) + corners[n % 4], 1.0); };
  double nearest = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 4; ++n)
  {
    glm::dvec3 from = corner(n), to = corner(n + 1);
    // What lies behind the eye, or next to it and far beside all samples, is cut off.
    const double least = 1e-6 * std::max(from.z, to.z);
    if (least <= 0.0)
    {
      continue;
    }
    glm::dvec3& low = from.z < to.z ? from : to;
    const glm::dvec3& high = from.z < to.z ? to : from;
    if (low.z < least)
    {
      low += (least - low.z) / (high.z - low.z) * (high - low);
    }
    nearest =
      std::min(nearest, distanceToLine(glm::dvec2(from) / from.z, glm::dvec2(to) / to.z, sample));
  }
  return nearest;
}

/// Where areas have no place between samples, at rims and holes, pixels show what is interpolated
/// at their centres between the samples that there are.
bool showsPoint(
  const splatting::ShearImage& image, const splatting::ShearWarp& geometry, int x, int y)
{
  const glm::dvec3 h = geometry.screenToShear() * glm::dvec3(x, y, 1.0);
  return !isBetweenSamples(image, glm::dvec2(h) / h.z);
}

/// What a pixel shows of a sample depends on how near its area is.
void testNothingElse(Checks& check)
{
  Sightings seen;
  forOverviews("nothing else", 100,
    [&](int, const splatting::View& view, const Geometries& geometries, reference::Random& random)
    {
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
      const bool isDue = isShown(geometries[which], u, v);
      seen.add(isDue);
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
          check(!isDue || !inside || at.x > 0.4999 || at.y > 0.4999 || value == 1.0f,
            "a sample is lost in its pixel's area: ", value);
          // Interpolated values fall to 0 within a sample.
          const double most = !showsPoint(image, geometries[which], x, y) ? 1.0 - nearest
            : nearest < 1.0                                               ? 1.0
                                                                          : 0.0;
          check(inside || value <= std::max(0.0, most) + 1e-6, "a pixel shows ", value,
            " of a sample that is ", nearest, " away");
        }
      }
    });
  check(seen.areEnough(0.3), "only ", seen, " samples are shown");
}

/// The largest sample in each pixel's area: those within 1e-9 of two areas are left out.
std::vector<float> largestSamples(
  const Images& images, const Geometries& geometries, const glm::ivec2& viewport)
{
  std::vector<float> largest(std::size_t(viewport.x) * viewport.y, Background);
  for (std::size_t n = 0; n < images.size(); ++n)
  {
    for (int v = 0; v < images[n].height; ++v)
    {
      for (int u = images[n].spans[v].begin; u < images[n].spans[v].end; ++u)
      {
        const glm::dvec3 h = geometries[n].shearToScreen() * glm::dvec3(u, v, 1.0);
        const glm::dvec2 p = glm::dvec2(h) / h.z, pixel = glm::floor(p + 0.5);
        const glm::dvec2 off = glm::abs(p - pixel), end(viewport);
        const bool isClear = off.x < 0.5 - 1e-9 && off.y < 0.5 - 1e-9;
        if (isClear && pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < end.x && pixel.y < end.y &&
          images[n].covers(u, v) && isShown(geometries[n], u, v))
        {
          float& own = largest[std::size_t(pixel.y) * viewport.x + std::size_t(pixel.x)];
          own = std::max(own, images[n].row<float>(v)[u]);
        }
      }
    }
  }
  return largest;
}

/// The location of a pixel is the largest sample in its area, or without any one that its value
/// lies next to.
void testLocations(Checks& check)
{
  Sightings samples;
  forOverviews("locations", 60,
    [&](int n, const splatting::View& view, const Geometries& geometries, reference::Random& random)
    {
      const Images images = noise(geometries, n % 4 == 0, random);
      const auto found =
        picture(images, geometries, splatting::Reduction::Maximum, view.viewport, random);
      std::vector<splatting::ShearPixel> shown(found.size());
      splatting::findShearPixels(images, geometries, splatting::Reduction::Maximum, glm::ivec2(0),
        view.viewport, shown.data());
      const auto largest = largestSamples(images, geometries, view.viewport);
      bool isSample = false;
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
        isSample |= value == found[p];
        const glm::dvec2 sample(shown[p].u, shown[p].v);
        const int x = static_cast<int>(p % view.viewport.x);
        const int y = static_cast<int>(p / view.viewport.x);
        // A place is no farther than half a sample from the nearest one.
        const double most = showsPoint(image, geometries[shown[p].image], x, y) ? 1.0 : 0.5;
        const double away = distanceToOutline(geometries[shown[p].image], x, y, sample);
        check(inside || away < most + 1e-6,
          "a location is neither in its pixel's area nor the nearest to a place on its outline");
        check(value <= found[p] || !inside, "a sample in the area is larger than the pixel");
        check(value >= largest[p], "a location has ", value, ", but the area ", largest[p]);
        splatting::ShearPixel alone;
        const glm::ivec2 at(p % view.viewport.x, p / view.viewport.x);
        splatting::findShearPixels(
          images, geometries, splatting::Reduction::Maximum, at, glm::ivec2(1), &alone);
        check(alone.image == shown[p].image && alone.u == shown[p].u && alone.v == shown[p].v,
          "a pixel alone has another location");
      }
      samples.add(isSample);
    });
  check(samples.areEnough(0.9), "pixels show samples themselves in only ", samples);
}
}

int TestPixelAreas(int, char*[])
{
  Checks check;
  testExtrema(check);
  testNothingElse(check);
  testLocations(check);
  return check.result();
}
