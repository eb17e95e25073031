// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tests the projections that benchmarks compare with splatting. Projective shear-warp is compared
// with values computed by hand, fast versions with slow ones.
#include "CoreTesting.h"

#include "TimedProjection.h"

#include <algorithm>
#include <cmath>

using namespace coretesting;
using reference::SliceSampling;

namespace
{
reference::Bytes randomBytes(reference::Random& random, int largest)
{
  return reference::uniformNoise<std::uint8_t>(randomSize(random, largest), random);
}

/// Shears of a view from anywhere: rays through edges are out of the question.
reference::ShearView genericView(const reference::Bytes& volume, reference::Random& random)
{
  return referenceView(splatting::ShearWarp(randomView(volume.size, random)));
}

/// Row 0 of the picture of a volume with one row.
std::vector<double> onlyRow(const reference::Image<double>& image, int margin)
{
  return { image.value.begin() + margin * image.width,
    image.value.begin() + (margin + 1) * image.width };
}

void testProjectiveByHand(Checks& check)
{
  // Two slices of four voxels, sheared by half a pixel: kc = 1/2, margin 2, so pixel u meets
  // x = u - 2 + 1/4 in slice 0 and x = u - 2 - 1/4 in slice 1.
  reference::Volume<double> volume({ 4, 1, 2 });
  volume.voxels = { 8.0, 0.0, 0.0, 4.0, 0.0, 12.0, 0.0, 0.0 };
  const reference::ShearView view = { 2, { 0.5, 0.0 } };
  const auto nearest =
    onlyRow(reference::projectiveShearWarp(volume, view, SliceSampling::Nearest), 1);
  check(nearest == std::vector<double>({ 0, 0, 8, 12, 0, 4, 0, 0 }), "nearest samples by hand");
  // Slice 0 gives 3/4 V[u-2] + 1/4 V[u-1], slice 1 gives 1/4 V[u-3] + 3/4 V[u-2].
  const auto bilinear =
    onlyRow(reference::projectiveShearWarp(volume, view, SliceSampling::Bilinear), 1);
  check(bilinear == std::vector<double>({ 0, 0, 6, 9, 3, 4, 0, 0 }), "bilinear samples by hand");
}

void testFastProjective(Checks& check)
{
  reference::forScenes("fast projective shear-warp", 50,
    [&](int, reference::Random& random)
    {
      reference::ByteImage found; // used again
      for (int turn = 0; turn < 2; ++turn)
      {
        const reference::Bytes volume = randomBytes(random, 40);
        const splatting::ShearWarp geometry(anyView(volume.size, random));
        const reference::ShearView view = referenceView(geometry);
        splatting::VolumeIndex index;
        index.reset({ volume.voxels.data(), splatting::ScalarType::UInt8, toGlm(volume.size) });
        const splatting::Slices slices = index.slices(view.axis);
        const auto expected =
          reference::projectiveShearWarp(reference::toDouble(volume), view, SliceSampling::Nearest);
        reference::projectSlices(
          { static_cast<const std::uint8_t*>(slices.voxels), slices.rowStride, slices.sliceStride },
          reference::makeShearGrid(volume.size, view), view, found);
        check(found.value.size() == expected.value.size() &&
            std::equal(found.value.begin(), found.value.end(), expected.value.begin()),
          "the fast projective shear-warp differs, axis ", view.axis);
        for (int v = 0; v < found.height; ++v)
        {
          for (int u = 0; u < found.width; ++u)
          {
            check(!expected.isHit(u, v) || (u >= found.range[v][0] && u < found.range[v][1]),
              "a pixel with sample is out of its row's range");
          }
        }
      }
    });
}

double largestDifference(const reference::Image<float>& a, const reference::Image<double>& b)
{
  double largest = 0.0;
  for (std::size_t pixel = 0; pixel < a.value.size(); ++pixel)
  {
    largest = std::max(largest, std::abs(a.value[pixel] - b.value[pixel]));
  }
  return largest;
}

void testRayCasters(Checks& check)
{
  reference::forScenes("ray casters", 50,
    [&](int, reference::Random& random)
    {
      reference::Image<float> picture; // used again
      for (const double distance : { 1.0, 0.25 })
      {
        const reference::Bytes bytes = randomBytes(random, 14);
        const reference::ShearView view = genericView(bytes, random);
        const auto volume = reference::toDouble(bytes);
        const reference::Rays rays = reference::shearRays(bytes.size, view, distance);

        const auto linear = reference::pointSampledTrilinear(volume, view, distance);
        reference::castTrilinear(bytes, rays, picture);
        check(picture.hit == linear.hit, "trilinear: other rays meet the volume");
        // Positions to 2^-20 voxel, at most three differences of 255 per voxel.
        check(largestDifference(picture, linear) < 1e-3, "trilinear: off by ",
          largestDifference(picture, linear));

        const auto crossed =
          reference::exactTraversal(volume, reference::raysOf(volume.size, view));
        reference::castThroughVoxels(bytes, rays, picture);
        check(picture.hit == crossed.hit && largestDifference(picture, crossed) == 0.0,
          "the traversal is not the exact one");

        // One sample in the middle of each slice is what projective shear-warp takes.
        const auto nearest = reference::projectiveShearWarp(volume, view, SliceSampling::Nearest);
        reference::castNearest(bytes, reference::shearRays(bytes.size, view, 1.0), picture);
        check(picture.hit == nearest.hit && largestDifference(picture, nearest) == 0.0,
          "nearest samples are not the slices' voxels");
      }
    });
}
}

int TestReferenceProjections(int, char*[])
{
  Checks check;
  testProjectiveByHand(check);
  testFastProjective(check);
  testRayCasters(check);
  return check.exitCode();
}
