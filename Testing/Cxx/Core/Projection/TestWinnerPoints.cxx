// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the samples lie that pixels show: points of the screen lie on the rays of their pixels, in
// their slices, and next to their voxels.
#include "Splat/Warp/Warp.h"
#include "WinnerScenes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace winnerscenes;
using splatting::Quality;

namespace
{
/**
 * How many pixels beside its own a point may be shown.
 *
 * The plane of a pixel's column is x = X - c W, of the rows X and W of the view's matrix, that of
 * its row y alike. Where they meet in a slice is found by Cramer's rule: a coordinate is a sum of
 * products of two coefficients and the point, rounded six times and divided by the determinant.
 * Times x that is how far x p is from 0. X p and W p are rounded four times where the point is
 * viewed. Divided by w, both are seen in units of half the viewport. Twice that allows for slices
 * along an axis that another ray follows most.
 */
glm::dvec2 rayBound(const Scene& scene, const glm::dvec3& point, double w, const glm::ivec2& pixel)
{
  const glm::dmat4 rows = glm::transpose(scene.view.indexToClip);
  const glm::dvec2 viewport(scene.view.viewport);
  const glm::dvec2 place = (2.0 * glm::dvec2(pixel) + 1.0) / viewport - 1.0;
  const glm::dvec4 planes[] = { rows[0] - place.x * rows[3], rows[1] - place.y * rows[3] };
  const glm::dvec3 x(planes[0]), y(planes[1]), ray = glm::abs(glm::cross(x, y));
  const glm::dvec4 size = glm::abs(glm::dvec4(point, 1.0));
  const double reach = glm::length(size);
  const double coordinate = 6.0 * reach *
    (glm::length(planes[0]) * glm::length(y) + glm::length(planes[1]) * glm::length(x)) /
    std::max({ ray.x, ray.y, ray.z });
  glm::dvec2 bound;
  for (int a = 0; a < 2; ++a)
  {
    const double solved = 2.0 * glm::length(glm::dvec3(planes[a])) * coordinate;
    const double viewed = 4.0 * glm::dot(glm::abs(rows[a]), size) +
      4.0 * std::abs(place[a]) * glm::dot(glm::abs(rows[3]), size);
    bound[a] = 2.0 * 0x1p-53 * viewport[a] * ((solved + viewed) / std::abs(w) * 0.5 + 2.0);
  }
  return bound;
}

/// What the arrays of a locator say of all pixels of a viewport, row by row.
class PixelArrays
{
public:
  PixelArrays(const splatting::Locator& locator, const glm::ivec2& viewport)
    : Voxels(std::size_t(3) * viewport.x * viewport.y),
      Positions(this->Voxels.size()),
      ClipDepths(std::size_t(viewport.x) * viewport.y)
  {
    splatting::Locator::Arrays arrays;
    arrays.voxels = this->Voxels.data();
    arrays.positions = this->Positions.data();
    arrays.clipDepths = this->ClipDepths.data();
    locator.fill({ 0, 0 }, viewport, arrays);
  }

  glm::ivec3 voxel(std::size_t at) const
  {
    return { this->Voxels[3 * at], this->Voxels[3 * at + 1], this->Voxels[3 * at + 2] };
  }
  glm::dvec3 point(std::size_t at) const
  {
    return { this->Positions[3 * at], this->Positions[3 * at + 1], this->Positions[3 * at + 2] };
  }
  float clipDepth(std::size_t at) const { return this->ClipDepths[at]; }

private:
  std::vector<int> Voxels;
  std::vector<double> Positions;
  std::vector<float> ClipDepths;
};

/// How far a point lies from the middle of the slice that a shear pixel's sample is of. It may be
/// put before an eye that lies just there, see Locator::pointAt().
double besideSlice(const std::vector<splatting::ShearImage>& images, const Scene& scene,
  const splatting::ShearPixel& pixel, const glm::dvec3& point)
{
  const splatting::ShearImage& image = images[pixel.image];
  const int winner = image.winners[std::size_t(pixel.v) * image.width + pixel.u];
  const double slice = winner / splatting::StepsPerSlice;
  return std::max(std::abs(point[scene.images[pixel.image].principalAxis()] - slice) - 1e-6, 0.0);
}

/// Points lie on the rays of their pixels, in their slices, and next to their voxels.
void testPoints(Checks& check, bool perspective)
{
  reference::forScenes(nameOf("points", perspective), 60,
    [&](int n, reference::Random& random)
    {
      const std::array<int, 3> size = randomSize(random, 12);
      const auto volume = reference::uniformNoise<std::uint8_t>(size, random, 0, 255);
      const Scene scene = anyScene(volume.size, perspective, random);
      splatting::ProjectionSettings settings;
      settings.quality = static_cast<Quality>(n % 3);
      const auto images = projectScene(volume, scene, settings);
      const splatting::Locator locator(located(volume, scene, images, settings));
      const glm::ivec2& viewport = scene.view.viewport;
      const PixelArrays arrays(locator, viewport);
      // A square and its ray may be as far from the shear pixel's as half a pixel, and that half a
      // voxel and a slice's drift from the voxel; footprints of high reach two voxels more.
      const double reach = settings.quality == Quality::Preview ? 2.01 : 3.01;
      for (int y = 0; y < viewport.y; ++y)
      {
        for (int x = 0; x < viewport.x; ++x)
        {
          const std::size_t at = std::size_t(y) * viewport.x + x;
          const glm::dvec3 point = arrays.point(at);
          const glm::ivec3 voxel = arrays.voxel(at);
          splatting::ShearPixel nearest;
          splatting::findShearPixels(
            images, scene.images, settings.reduction, { x, y }, glm::ivec2(1), &nearest);
          const bool has = nearest.image >= 0;
          const splatting::Locator::Sample picked = locator.at({ x, y });
          check(has == (voxel.x >= 0) && has == (point.x == point.x) && has == picked.exists &&
              picked.voxel == voxel,
            "arrays and pick differ");
          if (!has)
          {
            continue;
          }
          const glm::dvec4 clip = scene.view.indexToClip * glm::dvec4(point, 1.0);
          const glm::dvec2 shown =
            (glm::dvec2(clip) / clip.w + 1.0) * 0.5 * glm::dvec2(viewport) - 0.5;
          const glm::dvec2 off = glm::abs(shown - glm::dvec2(x, y));
          const glm::dvec2 bound = rayBound(scene, point, clip.w, { x, y });
          check(picked.point == point && off.x <= bound.x && off.y <= bound.y,
            "the point is not on the ray of pixel ", x, " ", y, ": ", off.x, " ", off.y,
            " beside it, not ", bound.x, " ", bound.y);
          check(besideSlice(images, scene, nearest, point) <= 1e-9, "the point of pixel ", x, " ",
            y, " is beside its slice");
          // Points may be next to the eye, before any near plane.
          const double rounding = 1e-6 / std::min(std::abs(clip.w), 1.0);
          const double depth = 0.5 * clip.z / clip.w + 0.5;
          check(std::abs(arrays.clipDepth(at) - depth) < rounding * std::max(1.0, std::abs(depth)),
            "another depth: ", arrays.clipDepth(at), ", not ", depth);
          const glm::dvec3 way = glm::abs(point - glm::dvec3(voxel));
          check(std::max({ way.x, way.y, way.z }) <= reach, "pixel ", x, " ", y, ": the point is ",
            way.x, " ", way.y, " ", way.z, " from its voxel");
        }
      }
    });
}
/// For each image the weight of the missing samples around a viewport pixel.
std::vector<double> missingWeights(
  const std::vector<splatting::ShearImage>& images, const Scene& scene, const glm::dvec2& pixel)
{
  std::vector<double> result;
  for (std::size_t n = 0; n < images.size(); ++n)
  {
    const glm::dvec3 h = scene.images[n].screenToShear() * glm::dvec3(pixel, 1.0);
    const glm::dvec2 place = glm::dvec2(h) / h.z;
    const glm::ivec2 first(glm::floor(place));
    const glm::dvec2 share = place - glm::dvec2(first);
    double missing = 0.0;
    for (int corner = 0; corner < 4; ++corner)
    {
      const glm::ivec2 beside(corner & 1, corner >> 1), at = first + beside;
      const glm::dvec2 weights = glm::mix(1.0 - share, share, glm::dvec2(beside));
      if (images[n].meetsVolume(at.x, at.y) &&
        images[n].winners[std::size_t(at.y) * images[n].width + at.x] < 0)
      {
        missing += weights.x * weights.y;
      }
    }
    result.push_back(missing);
  }
  return result;
}

/// A pixel has a location where the picture has a value, also beside hidden voxels.
void testExistence(Checks& check, bool perspective)
{
  Sightings beside;
  reference::forScenes(nameOf("holes", perspective), 120,
    [&](int n, reference::Random& random)
    {
      const std::array<int, 3> size = randomSize(random, 8);
      auto volume = reference::uniformNoise<float>(size, random);
      const double hidden = random.uniform(0.5, 1.0);
      for (float& voxel : volume.voxels)
      {
        voxel = random.chance(hidden) ? std::numeric_limits<float>::quiet_NaN() : voxel;
      }
      const Scene scene = anyScene(volume.size, perspective, random);
      splatting::ProjectionSettings settings;
      settings.quality = static_cast<Quality>(n % 3);
      const auto images = projectScene(volume, scene, settings);
      const splatting::Locator locator(located(volume, scene, images, settings));
      const glm::ivec2& viewport = scene.view.viewport;
      splatting::WarpedScalars warped;
      warped.set(images, scene.images, settings.reduction, viewport, settings.instructionSet);
      std::vector<float> space(warped.size.x);
      bool isBeside = false;
      for (int y = 0; y < warped.size.y; ++y)
      {
        const auto* const values = static_cast<const float*>(warped.valuesOfRow(y, space.data()));
        for (int x = 0; x < warped.size.x; ++x)
        {
          const glm::ivec2 pixel = warped.origin + glm::ivec2(x, y);
          const bool exists = locator.at(pixel).exists;
          const std::vector<double> missing = missingWeights(images, scene, glm::dvec2(pixel));
          // Rounding decides which side of the middle a pixel is on.
          const bool isMiddle = std::any_of(missing.begin(), missing.end(),
            [](double weight) { return std::abs(weight - 0.5) < 1e-6; });
          check(isMiddle || exists == !std::isnan(values[x]), "pixel ", pixel.x, " ", pixel.y, ": ",
            exists ? "a location without a value" : "a value without a location");
          isBeside = isBeside || (exists && missing.front() > 0.1 && missing.front() < 0.4);
        }
      }
      beside.add(isBeside);
    });
  check(beside.areEnough(0.1), "pixels beside holes are in only ", beside);
}
}

int TestWinnerPoints(int, char*[])
{
  Checks check;
  testPoints(check, false);
  testPoints(check, true);
  testExistence(check, false);
  testExistence(check, true);
  return check.exitCode();
}
