// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TestPixelAreas
//
// Views whose pixels are wider than voxels: what areas of shear images show.
#include "CoreTesting.h"
#include "WideViews.h"

#include "Display/PixelArea.h"
#include "Display/Warp.h"

#include <glm/common.hpp>

#include <algorithm>
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
  splatting::Warper().warpScalars(
    images, geometries, reduction, viewport, anyInstructionSet(random), Background, pixels.data());
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

splatting::View someView(int n, reference::Random& random)
{
  const auto size = randomSize(random, 24);
  return reduced(n % 2 ? randomPerspective(size, random) : anyView(size, random));
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
      const bool isOverview = !geometries.empty() && geometries.front().isOverview();
      overviews.add(isOverview);
      if (isOverview)
      {
        f(n, view, geometries, random);
      }
    });
  return overviews;
}

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

/// Whether all four pixels are samples between which an image is interpolated at a place.
bool isBetweenSamples(const splatting::ShearImage& image, const glm::dvec2& p)
{
  const glm::dvec2 low = glm::floor(p), limit(image.width, image.height);
  bool all = low.x >= 0.0 && low.y >= 0.0 && low.x < limit.x && low.y < limit.y;
  for (int corner = 0; corner < 4 && all; ++corner)
  {
    all = image.covers(static_cast<int>(low.x) + corner % 2, static_cast<int>(low.y) + corner / 2);
  }
  return all;
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

/// What the points of a pixel's area show.
struct PointMean
{
  bool isCertain = true; ///< none is next to where samples end, and their number does not round
  bool isWhole = true;   ///< all are between samples
  double sum = 0.0;
  double weights = 0.0;
  int images = 0; ///< that show some of them
};

/// The width of the part of an area that lies at one height, from its middle.
glm::dvec2 middleAndWidth(const splatting::PixelArea& area, double v)
{
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (int n = 0; n < area.count; ++n)
  {
    const glm::dvec2 a = area.corners[n], b = area.corners[(n + 1) % area.count];
    const double share = (v - a.y) / (b.y - a.y);
    if (share >= 0.0 && share <= 1.0)
    {
      const double u = glm::mix(a.x, b.x, share);
      left = std::min(left, u);
      right = std::max(right, u);
    }
  }
  return { 0.5 * (left + right), std::max(right - left, 0.0) };
}

/// How many pixels of the screen a sample's width and height cover, about a place of an image.
double coverOf(const splatting::ShearWarp& geometry, const glm::dvec2& place)
{
  constexpr double step = 1e-3;
  const auto shownAt = [&](double u, double v)
  {
    const glm::dvec3 h = geometry.shearToScreen() * glm::dvec3(place + glm::dvec2(u, v), 1.0);
    return glm::dvec2(h) / h.z;
  };
  const glm::dvec2 alongU = shownAt(step, 0.0) - shownAt(-step, 0.0);
  const glm::dvec2 alongV = shownAt(0.0, step) - shownAt(0.0, -step);
  return std::abs(alongU.x * alongV.y - alongU.y * alongV.x) / (4.0 * step * step);
}

/// The part of a range of numbers that an image has.
glm::dvec2 within(const glm::dvec2& range, int samples)
{
  return glm::clamp(range, 0.0, samples - 1.0);
}

/// The middles of equal parts of a range, none of them longer than 1.
std::vector<double> middles(const glm::dvec2& range, bool& isCertain)
{
  const double length = range[1] - range[0];
  isCertain = isCertain && std::abs(length - std::round(length)) > 1e-7;
  std::vector<double> result;
  const int parts = length > 0.0 ? static_cast<int>(std::ceil(length)) : 0;
  for (int n = 0; n < parts; ++n)
  {
    result.push_back(range[0] + (n + 0.5) * length / parts);
  }
  return result;
}

/// Adds up what an image shows of points that are spread evenly over a pixel's area.
void addPoints(const splatting::ShearImage& image, const splatting::ShearWarp& geometry, int x,
  int y, PointMean& mean)
{
  const splatting::PixelArea area = splatting::areaOf(geometry, x, y);
  if (area.count < 3)
  {
    return;
  }
  glm::dvec2 heights(std::numeric_limits<double>::infinity(), 0.0);
  heights[1] = -heights[0];
  for (const glm::dvec2& corner : area)
  {
    heights = { std::min(heights[0], corner.y), std::max(heights[1], corner.y) };
  }
  const glm::dvec2 inside = within(heights, image.height);
  mean.isWhole = mean.isWhole && inside == heights;
  const std::vector<double> rows = middles(inside, mean.isCertain);
  bool isMet = false, isSeen = false;
  for (const double v : rows)
  {
    const glm::dvec2 cut = middleAndWidth(area, v);
    const glm::dvec2 whole = cut[0] + 0.5 * cut[1] * glm::dvec2(-1.0, 1.0);
    const glm::dvec2 row = within(whole, image.width);
    mean.isWhole = mean.isWhole && row == whole;
    const std::vector<double> points = middles(row, mean.isCertain);
    for (const double u : points)
    {
      const glm::dvec2 p(u, v);
      const bool isBetween = isBetweenSamples(image, p);
      for (const glm::dvec2& off : { glm::dvec2(-1.0), { 1.0, -1.0 }, { -1.0, 1.0 }, { 1.0, 1.0 } })
      {
        mean.isCertain = mean.isCertain && isBetweenSamples(image, p + 1e-7 * off) == isBetween;
      }
      mean.isWhole = mean.isWhole && isBetween;
      if (!isBetween)
      {
        continue;
      }
      const double weight = coverOf(geometry, p) * (inside[1] - inside[0]) / rows.size() *
        (row[1] - row[0]) / points.size();
      const glm::ivec2 low(glm::floor(p));
      int showing = 0;
      for (int corner = 0; corner < 4; ++corner)
      {
        const glm::ivec2 sample = low + glm::ivec2(corner % 2, corner / 2);
        const glm::dvec2 w = 1.0 - glm::abs(p - glm::dvec2(sample));
        showing += isShown(geometry, sample.x, sample.y);
        mean.sum += weight * w.x * w.y * image.row<float>(sample.y)[sample.x];
      }
      mean.weights += weight;
      isSeen = true;
      isMet = isMet || showing == 4;
    }
  }
  mean.images += isSeen;
  // Beyond the outermost voxel centres the picture may end.
  mean.isCertain = mean.isCertain && isMet == isSeen;
}

/// What a pixel's area shows of all images.
PointMean meanOf(const Images& images, const Geometries& geometries, int x, int y)
{
  PointMean mean;
  for (std::size_t i = 0; i < geometries.size(); ++i)
  {
    addPoints(images[i], geometries[i], x, y, mean);
  }
  return mean;
}

/// Averages are means of points that are spread evenly over areas, no farther apart than samples,
/// each with the part of the pixel that it stands for, whichever image shows them. Those of linear
/// images are their values at pixels' centres.
void testAverages(Checks& check)
{
  Sightings whole, joint;
  forOverviews("averages", 60,
    [&](int n, const splatting::View& view, const Geometries& geometries, reference::Random& random)
    {
      const double a = random.uniform(-1.0, 1.0);
      const double b = random.uniform(-1.0, 1.0);
      Images linear;
      for (const splatting::ShearWarp& geometry : geometries)
      {
        linear.push_back(
          imageOf(geometry, false, random, [=](int u, int v) { return a * u + b * v; }));
      }
      const Images rough = noise(geometries, n % 4 == 0, random);
      const auto reduction = splatting::Reduction::Mean;
      const auto means = picture(linear, geometries, reduction, view.viewport, random);
      const auto roughMeans = picture(rough, geometries, reduction, view.viewport, random);
      for (int y = 0; y < view.viewport.y; ++y)
      {
        for (int x = 0; x < view.viewport.x; ++x)
        {
          const PointMean expected = meanOf(rough, geometries, x, y);
          if (!expected.isCertain || expected.images == 0)
          {
            continue;
          }
          whole.add(expected.isWhole);
          joint.add(expected.images > 1);
          // The length of rows is concave: in their middles it is no less than on average, and no
          // more than twice that. The 10 % are for how a sample's width changes in perspective.
          check(!expected.isWhole || expected.images > 1 ||
              (expected.weights > 0.9 && expected.weights < 2.2),
            "the points of a pixel stand for ", expected.weights, " of it");
          const std::size_t pixel = std::size_t(y) * view.viewport.x + x;
          const double mean = expected.sum / expected.weights;
          check(std::abs(roughMeans[pixel] - mean) < 1e-5, "the mean is ", roughMeans[pixel],
            ", not ", mean);
          if (expected.isWhole && !geometries.front().isPerspective())
          {
            const glm::dvec2 p(geometries.front().screenToShear() * glm::dvec3(x, y, 1.0));
            check(std::abs(means[pixel] - (a * p.x + b * p.y)) < 1e-4,
              "a linear image has a mean of ", means[pixel], " at its value ", a * p.x + b * p.y);
          }
        }
      }
    });
  check(whole.areEnough(0.003), "only ", whole, " pixels are whole");
  check(joint.areEnough(0.0003), "only ", joint, " pixels show several images");
}

/// However many voxels a pixel is wide, and if it is so along one axis only, an average takes no
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
  testAverages(check);
  testWidePixels(check);
  testLocations(check);
  return check.result();
}
