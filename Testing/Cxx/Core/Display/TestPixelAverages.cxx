// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// TestPixelAverages
//
// Views whose pixels are wider than voxels: the averages of areas of shear images.
#include "PixelAreaTesting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace coretesting;

namespace
{
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
}

int TestPixelAverages(int, char*[])
{
  Checks check;
  testAverages(check);
  testWidePixels(check);
  return check.result();
}
