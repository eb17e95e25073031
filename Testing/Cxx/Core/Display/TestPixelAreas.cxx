// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Views whose pixels are wider than voxels: extrema and averages of areas of shear images.
#include "CoreTesting.h"
#include "WideViews.h"

#include "Display/ScreenColors.h"
#include "Display/ShearPixels.h"
#include "Display/Warp.h"

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
  splatting::WarpedScalars warped;
  warped.set(images, geometries, reduction, viewport, anyInstructionSet(random));
  splatting::copyScreen(warped, viewport, pixels.data());
  return pixels;
}

/// Whether a ray passes between the outermost voxels' centres, where the picture does not end:
/// the outermost half slices are beyond.
bool isShown(const splatting::ShearWarp& geometry, int u, int v)
{
  if (u >= geometry.rayCount().x || !meets(geometry, u, v, -0.5 - 1e-6))
  {
    return false;
  }
  const glm::dvec3 last = glm::dvec3(geometry.size()) - 1.0;
  double near = last.z > 0.0 ? 0.0 : -0.5, far = last.z > 0.0 ? last.z : 0.5;
  for (int a = 0; a < 2; ++a)
  {
    const splatting::AxisRays& rays = a == 0 ? geometry.columns() : geometry.rows();
    const int n = a == 0 ? u : v;
    const double first = (1e-6 - rays.at[n]) / rays.slope[n];
    const double second = (last[a] - 1e-6 - rays.at[n]) / rays.slope[n];
    near = std::max(near, geometry.reference() + std::min(first, second));
    far = std::min(far, geometry.reference() + std::max(first, second));
  }
  return near <= far;
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

/// An interval of numbers x with a x + b >= 0 for some a and b.
struct Interval
{
  double low, high;

  void cut(double a, double b)
  {
    if (a > 0.0)
    {
      this->low = std::max(this->low, -b / a);
    }
    else if (a < 0.0 || b < 0.0)
    {
      this->high = a < 0.0 ? std::min(this->high, -b / a) : this->low - 1.0;
    }
  }
  double length() const { return this->high - this->low; }
  double middle() const { return 0.5 * (this->low + this->high); }
};

/// What a pixel reads of all images of a view, by the definition.
struct Reading
{
  bool isCertain = true;  ///< by more than rounding
  bool hasSample = false; ///< whether a visible sample is in the area
  std::vector<double> values;
  std::vector<splatting::ShearPixel> nearest; ///< of each value
};

class Reader
{
public:
  Reader(const Images& images, const Geometries& geometries) : All(images), Geometry(geometries) {}

  Reading at(int x, int y) const
  {
    Reading all;
    for (std::size_t n = 0; n < this->Geometry.size(); ++n)
    {
      Reading reading;
      this->readRows(static_cast<int>(n), { x, y }, reading);
      // An image is not read beside its part of the picture, which the other images show.
      all.isCertain &= reading.isCertain &&
        (reading.hasSample || reading.values.empty() || this->Geometry.size() == 1);
      all.hasSample |= reading.hasSample;
      all.values.insert(all.values.end(), reading.values.begin(), reading.values.end());
      all.nearest.insert(all.nearest.end(), reading.nearest.begin(), reading.nearest.end());
    }
    return all;
  }

  /// The largest sample less than two samples beside the area of a pixel.
  double largestBeside(const glm::dvec2& pixel) const
  {
    double largest = Background;
    for (std::size_t n = 0; n < this->Geometry.size(); ++n)
    {
      glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
      for (const glm::dvec2& corner :
        { glm::dvec2(-0.5, -0.5), { 0.5, -0.5 }, { 0.5, 0.5 }, { -0.5, 0.5 } })
      {
        const glm::dvec3 h = this->Geometry[n].screenToShear() * glm::dvec3(pixel + corner, 1.0);
        const double far = std::numeric_limits<double>::infinity();
        const glm::dvec2 p = h.z > 0.0 ? glm::dvec2(h) / h.z : glm::dvec2(far);
        low = h.z > 0.0 ? glm::min(low, p) : glm::dvec2(-far);
        high = glm::max(high, p);
      }
      for (int v = 0; v < this->All[n].height; ++v)
      {
        for (int u = 0; u < this->All[n].width; ++u)
        {
          const bool isBeside =
            u > low.x - 2.0 && u < high.x + 2.0 && v > low.y - 2.0 && v < high.y + 2.0;
          const bool isLarger =
            isBeside && this->All[n].covers(u, v) && this->All[n].row<float>(v)[u] > largest;
          largest = isLarger ? this->All[n].row<float>(v)[u] : largest;
        }
      }
    }
    return largest;
  }

  float sample(const splatting::ShearPixel& p) const
  {
    return this->All[p.image].row<float>(p.v)[p.u];
  }

private:
  static constexpr double Rounding = 1e-7;

  /// The part of a row (or, of 1, of a column) of an image that lies in a pixel's area, and no more
  /// than a sample beside the image.
  Interval part(int n, const glm::dvec2& pixel, int along, double line) const
  {
    Interval part{ -1.0, double(along == 0 ? this->All[n].width : this->All[n].height) };
    const glm::dmat3& m = this->Geometry[n].shearToScreen();
    const glm::dvec3 step = m[along], start = line * m[1 - along] + m[2];
    for (int a = 0; a < 2; ++a)
    {
      for (const double side : { -1.0, 1.0 })
      {
        const double border = pixel[a] + 0.5 * side;
        part.cut(side * (border * step.z - step[a]), side * (border * start.z - start[a]));
      }
    }
    part.cut(step.z, start.z);
    return part;
  }

  void readRows(int n, const glm::dvec2& pixel, Reading& reading) const
  {
    bool meetsRows = false;
    // A row along a side of the area is in it, or not, by rounding.
    for (const glm::dvec2& corner :
      { glm::dvec2(-0.5, -0.5), { 0.5, -0.5 }, { 0.5, 0.5 }, { -0.5, 0.5 } })
    {
      const glm::dvec3 h = this->Geometry[n].screenToShear() * glm::dvec3(pixel + corner, 1.0);
      const double v = h.y / h.z;
      reading.isCertain &= !(h.z > 0.0) || std::abs(v - std::round(v)) > Rounding;
    }
    for (int v = -1; v <= this->All[n].height; ++v)
    {
      const Interval row = this->part(n, pixel, 0, v);
      reading.isCertain &= std::abs(row.length()) > Rounding;
      meetsRows |= row.length() > 0.0;
      this->readRow(n, row, v, reading);
    }
    if (!meetsRows)
    {
      this->readBetweenRows(n, pixel, reading);
    }
  }

  /// An area between two rows is read in the middle of its height.
  void readBetweenRows(int n, const glm::dvec2& pixel, Reading& reading) const
  {
    Interval rows{ std::numeric_limits<double>::infinity(), 0.0 };
    rows.high = -rows.low;
    for (const glm::dvec2& corner :
      { glm::dvec2(-0.5, -0.5), { 0.5, -0.5 }, { 0.5, 0.5 }, { -0.5, 0.5 } })
    {
      const glm::dvec3 h = this->Geometry[n].screenToShear() * glm::dvec3(pixel + corner, 1.0);
      const glm::dvec2 p = glm::dvec2(h) / h.z;
      const bool isInside = h.z > 0.0 && p.x > -1.0 && p.x < this->All[n].width;
      reading.isCertain &= isInside;
      rows = { std::min(rows.low, p.y), std::max(rows.high, p.y) };
    }
    if (rows.low > -1.0 && rows.high < this->All[n].height && reading.isCertain)
    {
      const double v = rows.middle();
      this->readRow(n, this->part(n, pixel, 0, v), v, reading);
    }
  }

  void readRow(int n, const Interval& row, double v, Reading& reading) const
  {
    if (row.length() < 0.0)
    {
      return;
    }
    for (const double end : { row.low, row.high })
    {
      reading.isCertain &= std::abs(end - std::round(end)) > Rounding;
    }
    bool isRead = false;
    for (double u = std::ceil(row.low); u <= row.high; ++u)
    {
      this->readPoint(n, u, v, reading);
      isRead = true;
    }
    if (!isRead)
    {
      this->readPoint(n, row.middle(), v, reading);
    }
  }

  void readPoint(int n, double u, double v, Reading& reading) const
  {
    const splatting::ShearImage& image = this->All[n];
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    double sum = 0.0;
    for (int corner = 0; corner < 4; ++corner)
    {
      const int column = i + corner % 2, row = j + corner / 2;
      const double weight = (1.0 - std::abs(u - column)) * (1.0 - std::abs(v - row));
      if (weight > 0.0 && !image.covers(column, row))
      {
        return;
      }
      sum += weight > 0.0 ? weight * image.row<float>(row)[column] : 0.0;
    }
    for (const double place : { u, v })
    {
      reading.isCertain &= std::abs(place - std::floor(place) - 0.5) > Rounding;
    }
    const splatting::ShearPixel nearest{ n, int(std::lround(u)), int(std::lround(v)) };
    reading.hasSample |=
      nearest.u == u && nearest.v == v && isShown(this->Geometry[n], nearest.u, nearest.v);
    reading.values.push_back(sum);
    reading.nearest.push_back(nearest);
  }

  const Images& All;
  const Geometries& Geometry;
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
      const Reading reading = reader.at(x, y);
      if (reading.isCertain)
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
        [&](std::size_t p, const Reading& reading)
        {
          const std::vector<double>& values = reading.values;
          hasRead = hasRead || !values.empty();
          check(!reading.hasSample || largest[p] != Background, "a sample in the area of pixel ", p,
            " is not shown");
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
      for (std::size_t i = 0; i < images.size(); ++i)
      {
        for (int v = 0; v < images[i].height; ++v)
        {
          for (int u = 0; u < images[i].width; ++u)
          {
            const glm::dvec3 h = geometries[i].shearToScreen() * glm::dvec3(u, v, 1.0);
            const glm::dvec2 p = glm::dvec2(h) / h.z + 0.5;
            // On the line between two areas it may be in either.
            float shown = -1.0f;
            bool isInside = images[i].covers(u, v) && isShown(geometries[i], u, v);
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
            check(!isInside || shown >= images[i].row<float>(v)[u], "a sample of ",
              images[i].row<float>(v)[u], " is lost in ", shown);
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
        [&](std::size_t p, const Reading& reading)
        {
          const splatting::ShearPixel& location = shown[p];
          if (reading.values.empty() || location.image < 0)
          {
            return;
          }
          isLocated = true;
          float best = -1.0f;
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
        images.push_back(imageOf(geometry, false, random, [](int, int) { return 7.0; }));
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
