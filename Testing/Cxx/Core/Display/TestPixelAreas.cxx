// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Views whose pixels are wider than voxels: extrema and averages of areas of shear images.
#include "ScreenPixels.h"
#include "WarpTesting.h"
#include "WideViews.h"

#include "Splat/Warp/ShearPixels.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

using namespace coretesting;

namespace
{
using Images = std::vector<splatting::ShearImage>;
using Geometries = std::vector<splatting::ShearWarp>;

constexpr float Background = -100.0f; // below all values

/// Hides some samples.
void makeHoles(splatting::ShearImage& image, reference::Random& random)
{
  image.mask.resize(std::size_t(image.width) * image.height);
  for (unsigned char& sample : image.mask)
  {
    sample = random.uniform(0, 9) > 0;
  }
}

Images noise(const Geometries& geometries, bool hasHoles, reference::Random& random)
{
  Images images;
  for (const splatting::ShearWarp& geometry : geometries)
  {
    images.push_back(imageOf(geometry, [&](int, int) { return random.uniform(0.0, 1.0); }));
    splatting::ShearImage& image = images.back();
    if (hasHoles)
    {
      makeHoles(image, random);
    }
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
  splatting::WarpedScalars warped;
  warped.set(images, geometries, reduction, viewport, anyInstructionSet(random));
  splatting::copyScreen(warped, viewport, pixels.data());
  return pixels;
}

splatting::View someView(int n, reference::Random& random)
{
  const auto size = randomSize(random, 24);
  const splatting::View view = n % 2 ? randomPerspective(size, random) : anyView(size, random);
  return reduced(random.oneIn(2) ? skewed(view, random) : view);
}

/// Calls f(n, view, geometries, random) for those of some views that are overviews, and counts
/// them.
template <class F>
Sightings forOverviews(const char* series, int count, F&& f)
{
  Sightings overviews;
  reference::forScenes(series, count,
    [&](int n, reference::Random& random)
    {
      const splatting::View view = someView(n, random);
      Geometries geometries;
      splatting::ShearWarp::factorise(view, geometries);
      const bool minifiesAnyAxis = !geometries.empty() && geometries.front().minifiesAnyAxis();
      overviews.add(minifiesAnyAxis);
      if (minifiesAnyAxis)
      {
        f(n, view, geometries, random);
      }
    });
  return overviews;
}

/// A shear image as the source of an AreaReader.
struct Source
{
  const splatting::ShearImage& image;
  reference::ImageRays rays;
  int width, height;
  glm::dmat3 toScreen, toShear;
  std::vector<glm::dvec4> box; ///< the picture covers this box

  Source(const splatting::ShearImage& shear, const splatting::ShearWarp& geometry)
    : image(shear),
      rays(referenceRays(geometry)),
      width(shear.width),
      height(shear.height),
      toScreen(geometry.shearToScreen()),
      toShear(geometry.screenToShear()),
      box(reference::boxOfVolume(this->rays.volumeSize(), false, -1e-6))
  {
  }
  bool covers(int u, int v) const { return this->image.covers(u, v); }
  double value(int u, int v) const { return this->image.row<float>(v)[u]; }
  bool isShown(int u, int v) const
  {
    return depthsInside(this->box, this->rays, u, v).length() >= 0.0;
  }
};

/// What a pixel reads of all images of a view, by the definition.
struct Readings
{
  reference::Reading all;
  std::vector<splatting::ShearPixel> nearest; ///< of each value
};

class Reader
{
public:
  Reader(const Images& images, const Geometries& geometries)
  {
    for (std::size_t n = 0; n < images.size(); ++n)
    {
      this->Sources.emplace_back(images[n], geometries[n]);
    }
  }

  const std::vector<Source>& sources() const { return this->Sources; }

  Readings at(int x, int y) const
  {
    Readings result;
    reference::Reading& all = result.all;
    for (std::size_t n = 0; n < this->Sources.size(); ++n)
    {
      reference::Reading one;
      reference::AreaReader<Source>(this->Sources[n], 1e-7).read({ x, y }, one);
      // An image is not read beside its part of the picture, which the other images show.
      all.isCertain &=
        one.isCertain && (one.hasSample || one.values.empty() || this->Sources.size() == 1);
      all.hasSample |= one.hasSample;
      all.values.insert(all.values.end(), one.values.begin(), one.values.end());
      for (const glm::ivec2& p : one.nearest)
      {
        result.nearest.push_back({ static_cast<int>(n), p.x, p.y });
      }
    }
    return result;
  }

  /// The largest sample less than two samples beside the area of a pixel.
  double largestBeside(const glm::dvec2& pixel) const
  {
    double largest = Background;
    for (const Source& source : this->Sources)
    {
      glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
      for (const glm::dvec2& corner : reference::AreaReader<Source>::corners())
      {
        const glm::dvec3 h = source.toShear * glm::dvec3(pixel + corner, 1.0);
        const double far = std::numeric_limits<double>::infinity();
        const glm::dvec2 p = h.z > 0.0 ? glm::dvec2(h) / h.z : glm::dvec2(far);
        low = h.z > 0.0 ? glm::min(low, p) : glm::dvec2(-far);
        high = glm::max(high, p);
      }
      for (int v = 0; v < source.height; ++v)
      {
        for (int u = 0; u < source.width; ++u)
        {
          const bool isBeside =
            u > low.x - 2.0 && u < high.x + 2.0 && v > low.y - 2.0 && v < high.y + 2.0;
          if (isBeside && source.covers(u, v))
          {
            largest = std::max(largest, source.value(u, v));
          }
        }
      }
    }
    return largest;
  }

  double sample(const splatting::ShearPixel& p) const
  {
    return this->Sources[p.image].value(p.u, p.v);
  }

private:
  std::vector<Source> Sources;
};

/// Calls f(pixel, reading) for the pixels of a view where rounding decides nothing.
template <class F>
void forReadings(
  const splatting::View& view, const Images& images, const Geometries& geometries, F&& f)
{
  const Reader reader(images, geometries);
  for (int y = 0; y < view.viewport.y; ++y)
  {
    for (int x = 0; x < view.viewport.x; ++x)
    {
      const Readings reading = reader.at(x, y);
      if (reading.all.isCertain)
      {
        f(std::size_t(y) * view.viewport.x + x, reading);
      }
    }
  }
}

/// Pixels show the extremum or the mean of what they read. The picture may end where no sample
/// that is shown is in their areas, and where they read nothing they may show what is beside them.
void testDefinition(Checks& check)
{
  // Values of 0 to 1 become float, and places differ by less than Reader::Rounding.
  constexpr double rounding = 1e-6;
  Sightings read;
  const Sightings wide = forOverviews("definition", 200,
    [&](int n, const splatting::View& view, const Geometries& geometries, reference::Random& random)
    {
      using splatting::Reduction;
      const Images images = noise(geometries, n % 4 == 0, random);
      const auto largest = picture(images, geometries, Reduction::Maximum, view.viewport, random);
      const auto least = picture(images, geometries, Reduction::Minimum, view.viewport, random);
      const auto mean = picture(images, geometries, Reduction::Mean, view.viewport, random);
      bool hasRead = false;
      const Reader reader(images, geometries);
      forReadings(view, images, geometries,
        [&](std::size_t p, const Readings& reading)
        {
          const std::vector<double>& values = reading.all.values;
          hasRead = hasRead || !values.empty();
          check(!reading.all.hasSample || largest[p] != Background,
            "a sample in the area of pixel ", p, " is not shown");
          if (values.empty() || largest[p] == Background)
          {
            check(largest[p] == Background ||
                largest[p] <=
                  reader.largestBeside(glm::dvec2(p % view.viewport.x, p / view.viewport.x)) +
                    rounding,
              "pixel ", p, " shows ", largest[p], ", which is not beside it");
            return;
          }
          double sum = 0.0;
          for (const double value : values)
          {
            sum += value;
          }
          const double expected[] = { *std::max_element(values.begin(), values.end()),
            *std::min_element(values.begin(), values.end()), sum / double(values.size()) };
          const float found[] = { largest[p], least[p], mean[p] };
          for (int reduction = 0; reduction < 3; ++reduction)
          {
            check(std::abs(found[reduction] - expected[reduction]) < rounding, "pixel ", p,
              " shows ", found[reduction], ", not ", expected[reduction], ", reduction ",
              reduction);
          }
        });
      read.add(hasRead);
    });
  check(wide.areEnough(0.8), "only ", wide, " have wide pixels");
  check(read.areEnough(0.5), "only ", read, " have pixels that read something");
}

/// Every visible sample is in the area of some pixel.
void testEverySample(Checks& check)
{
  Sightings seen;
  forOverviews("every sample", 100,
    [&](int n, const splatting::View& view, const Geometries& geometries, reference::Random& random)
    {
      const Images images = noise(geometries, n % 4 == 0, random);
      const auto found =
        picture(images, geometries, splatting::Reduction::Maximum, view.viewport, random);
      bool isSeen = false;
      const Reader reader(images, geometries);
      for (const Source& source : reader.sources())
      {
        for (int v = 0; v < source.height; ++v)
        {
          for (int u = 0; u < source.width; ++u)
          {
            const glm::dvec3 h = source.toScreen * glm::dvec3(u, v, 1.0);
            const glm::dvec2 p = glm::dvec2(h) / h.z + 0.5;
            // On the line between two areas it may be in either.
            float shown = -1.0f;
            bool isInside = source.covers(u, v) && source.isShown(u, v);
            for (int side = 0; side < 4 && isInside; ++side)
            {
              const glm::ivec2 pixel(glm::floor(p + 1e-9 * (glm::dvec2(side % 2, side / 2) - 0.5)));
              isInside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < view.viewport.x &&
                pixel.y < view.viewport.y;
              shown = isInside
                ? std::max(shown, found[std::size_t(pixel.y) * view.viewport.x + pixel.x])
                : shown;
            }
            isSeen = isSeen || isInside;
            check(!isInside || shown >= source.value(u, v), "a sample of ", source.value(u, v),
              " is lost in ", shown);
          }
        }
      }
      seen.add(isSeen);
    });
  check(seen.areEnough(0.5), "only ", seen, " show a sample");
}

/// The location of a pixel is the largest of the samples that it reads, or that are nearest to what
/// it reads.
void testLocations(Checks& check)
{
  Sightings located;
  forOverviews("locations", 60,
    [&](int n, const splatting::View& view, const Geometries& geometries, reference::Random& random)
    {
      const Images images = noise(geometries, n % 4 == 0, random);
      const auto found =
        picture(images, geometries, splatting::Reduction::Maximum, view.viewport, random);
      std::vector<splatting::ShearPixel> shown(found.size());
      splatting::findShearPixels(images, geometries, splatting::Reduction::Maximum, glm::ivec2(0),
        view.viewport, shown.data());
      for (std::size_t p = 0; p < found.size(); ++p)
      {
        check((shown[p].image < 0) == (found[p] == Background), "pixel ", p,
          " shows a sample or has a location, not both: ", found[p]);
        splatting::ShearPixel alone;
        const glm::ivec2 at(p % view.viewport.x, p / view.viewport.x);
        splatting::findShearPixels(
          images, geometries, splatting::Reduction::Maximum, at, glm::ivec2(1), &alone);
        check(alone.image == shown[p].image && alone.u == shown[p].u && alone.v == shown[p].v,
          "a pixel alone has another location");
      }
      bool isLocated = false;
      const Reader reader(images, geometries);
      forReadings(view, images, geometries,
        [&](std::size_t p, const Readings& reading)
        {
          const splatting::ShearPixel& location = shown[p];
          if (reading.all.values.empty() || location.image < 0)
          {
            return;
          }
          isLocated = true;
          double best = -1.0;
          bool isRead = false;
          for (const splatting::ShearPixel& nearest : reading.nearest)
          {
            best = std::max(best, reader.sample(nearest));
            isRead |=
              nearest.image == location.image && nearest.u == location.u && nearest.v == location.v;
          }
          check(isRead && reader.sample(location) == best, "the location of pixel ", p, " has ",
            reader.sample(location), ", not ", best);
        });
      located.add(isLocated);
    });
  check(located.areEnough(0.5), "only ", located, " have pixels with locations");
}

/// However many voxels a pixel is wide, and if it is so along one axis only, what it shows takes no
/// more time than the image has samples: this would not end otherwise.
void testWidePixels(Checks& check)
{
  reference::forScenes("wide pixels", 40,
    [&](int n, reference::Random& random)
    {
      splatting::View view = anyView(randomSize(random, 24), random);
      const double width = std::pow(10.0, random.uniform(1.0, 9.0));
      glm::dmat4 scale(1.0);
      for (int a = 0; a < 3; ++a)
      {
        // All axes of the screen, or one of the volume.
        scale[a][a] = n % 2 || a == n / 2 % 3 ? 1.0 / width : 1.0;
      }
      glm::dmat4& m = view.indexToClip;
      const glm::dvec4 middle = m * glm::dvec4(0.5 * (glm::dvec3(view.dimensions) - 1.0), 1.0);
      m = m * scale;
      m[3] += middle - m * glm::dvec4(0.5 * (glm::dvec3(view.dimensions) - 1.0), 1.0);
      Geometries geometries;
      splatting::ShearWarp::factorise(view, geometries);
      Images images;
      for (const splatting::ShearWarp& geometry : geometries)
      {
        images.push_back(imageOf(geometry, [](int, int) { return 7.0; }));
      }
      const auto means =
        picture(images, geometries, splatting::Reduction::Mean, view.viewport, random);
      const std::ptrdiff_t seen =
        std::count_if(means.begin(), means.end(), [](float mean) { return mean != Background; });
      check(seen > 0, "pixels of ", width, " voxels show nothing");
      check(std::all_of(means.begin(), means.end(),
              [](float mean) { return mean == Background || std::abs(mean - 7.0f) < 1e-5f; }),
        "a constant image has another mean");
    });
}
}

int TestPixelAreas(int, char*[])
{
  Checks check;
  testDefinition(check);
  testEverySample(check);
  testLocations(check);
  testWidePixels(check);
  return check.exitCode();
}
