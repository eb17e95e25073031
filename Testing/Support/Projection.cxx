// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projection.h"

#include "Integration.h"
#include "Traversal.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace reference
{

namespace
{

constexpr double Pi = 3.14159265358979323846;

/**
 * The trilinear field on a ray at a depth.
 */
double fieldOnRay(const SeenVolume& source, int u, int v, double z)
{
  const Kernel hat;
  const WeightedSum field = source.sum(kernelAt(hat, source.rays.position(0, u, z)),
    kernelAt(hat, source.rays.position(1, v, z)), kernelAt(hat, z));
  return field.sum / field.weight;
}

/**
 * Whether a ray is in the box of the voxels at a depth of the volume.
 */
bool isInside(const ImageRays& rays, int u, int v, double z)
{
  const double x = rays.position(0, u, z), y = rays.position(1, v, z);
  return x >= -0.5 && x <= rays.size[0] - 0.5 && y >= -0.5 && y <= rays.size[1] - 0.5;
}

} // namespace

//------------------------------------------------------------------------------
ShearGrid makeShearGrid(const std::array<int, 3>& volumeSize, const ShearView& view)
{
  if (view.axis < 0 || view.axis > 2)
  {
    throw std::invalid_argument("The principal axis must be 0, 1 or 2.");
  }
  ShearGrid grid;
  grid.axes = { view.axis == 0 ? 1 : 0, view.axis == 2 ? 1 : 2, view.axis };
  for (int a = 0; a < 3; ++a)
  {
    grid.size[a] = volumeSize[grid.axes[a]];
  }
  for (int a = 0; a < 2; ++a)
  {
    const double shear = view.shear[a];
    if (!(std::abs(shear) <= 1.0) || shear * 0x1p24 != std::floor(shear * 0x1p24))
    {
      throw std::invalid_argument("Shears must be multiples of 2^-24 in [-1, 1].");
    }
    grid.margin[a] = static_cast<int>(std::ceil(std::abs(shear) * grid.size[2] / 2.0)) + 1;
  }
  grid.width = grid.size[0] + 2 * grid.margin[0];
  grid.height = grid.size[1] + 2 * grid.margin[1];
  grid.middle = (grid.size[2] - 1) / 2.0;
  return grid;
}

//------------------------------------------------------------------------------
std::array<double, 2> ImageRays::faces(int first, int last) const
{
  const double low = first - 0.5, high = last + 0.5;
  return this->reversed ? std::array<double, 2>{ low, std::min(high, this->eye) }
                        : std::array<double, 2>{ std::max(low, this->eye), high };
}

//------------------------------------------------------------------------------
std::vector<std::array<int, 3>> crossedVoxels(const ImageRays& rays, int u, int v)
{
  // Time is depth in units of 2^-10: slopes, multiples of 2^-24, are then multiples of 2^-34 per
  // unit.
  const std::array<double, 2> faces = rays.faces(0, rays.size[2] - 1);
  const std::int64_t end = inUnits(faces[1] - faces[0]) >> 24;
  const std::array<AxisMotion, 3> ray = { AxisMotion{ inUnits(rays.position(0, u, faces[0])),
                                            inUnits(rays.slope[0][u]) >> 10 },
    AxisMotion{ inUnits(rays.position(1, v, faces[0])), inUnits(rays.slope[1][v]) >> 10 },
    AxisMotion{ inUnits(faces[0]), WholeVoxel >> 10 } };
  std::vector<std::array<int, 3>> crossed;
  for (const std::array<int, 3>& ijk : traverse(ray, end, rays.size))
  {
    if (rays.sees(ijk[2]))
    {
      std::array<int, 3>& position = crossed.emplace_back();
      for (int a = 0; a < 3; ++a)
      {
        position[rays.axes[a]] = ijk[a];
      }
    }
  }
  return crossed;
}

//------------------------------------------------------------------------------
std::vector<int> crossedSlices(const ImageRays& rays, int u, int v)
{
  std::vector<int> slices;
  for (const std::array<int, 3>& position : crossedVoxels(rays, u, v))
  {
    if (slices.empty() || slices.back() != position[rays.axes[2]])
    {
      slices.push_back(position[rays.axes[2]]);
    }
  }
  return slices;
}

//------------------------------------------------------------------------------
ImageRays raysOf(const std::array<int, 3>& volumeSize, const ShearView& view)
{
  const ShearGrid grid = makeShearGrid(volumeSize, view);
  ImageRays rays;
  rays.axes = grid.axes;
  rays.size = grid.size;
  rays.start = grid.middle;
  rays.eye = -std::numeric_limits<double>::infinity();
  const int pixels[2] = { grid.width, grid.height };
  for (int a = 0; a < 2; ++a)
  {
    for (int pixel = 0; pixel < pixels[a]; ++pixel)
    {
      rays.at[a].push_back(static_cast<double>(pixel) - grid.margin[a]);
      rays.slope[a].push_back(-view.shear[a]);
    }
  }
  return rays;
}

//------------------------------------------------------------------------------
double Kernel::support() const
{
  switch (this->shape)
  {
    case Nearest:
      return 0.5;
    case Trilinear:
      return 1.0;
    default:
      return this->radius;
  }
}

//------------------------------------------------------------------------------
double Kernel::operator()(double t) const
{
  if (!(std::abs(t) < this->support()))
  {
    return 0.0;
  }
  switch (this->shape)
  {
    case Nearest:
      return 1.0;
    case Trilinear:
      return 1.0 - std::abs(t);
    default:
      return 0.5 * (1.0 + std::cos(Pi * t / this->radius));
  }
}

//------------------------------------------------------------------------------
Image<double> pointSampledTrilinear(
  const Volume<double>& volume, const ShearView& view, double distance)
{
  const ImageRays rays = raysOf(volume.size, view);
  const SeenVolume source = { volume, rays };
  const int first = static_cast<int>(std::ceil(-0.5 / distance));
  const int last = static_cast<int>(std::floor((rays.size[2] - 0.5) / distance));
  Image<double> image(rays.width(), rays.height());
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      for (int step = first; step <= last; ++step)
      {
        if (isInside(rays, u, v, step * distance))
        {
          image.raise(u, v, fieldOnRay(source, u, v, step * distance));
        }
      }
    }
  }
  return image;
}

//------------------------------------------------------------------------------
Image<double> projectiveShearWarp(
  const Volume<double>& volume, const ShearView& view, SliceSampling sampling)
{
  if (sampling == SliceSampling::Bilinear)
  {
    return pointSampledTrilinear(volume, view, 1.0);
  }
  const ImageRays rays = raysOf(volume.size, view);
  const SeenVolume source = { volume, rays };
  Image<double> image(rays.width(), rays.height());
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      for (int slice = 0; slice < rays.size[2]; ++slice)
      {
        const int i = static_cast<int>(std::floor(rays.position(0, u, slice) + 0.5));
        const int j = static_cast<int>(std::floor(rays.position(1, v, slice) + 0.5));
        if (i >= 0 && i < rays.size[0] && j >= 0 && j < rays.size[1])
        {
          image.raise(u, v, source.voxel(i, j, slice));
        }
      }
    }
  }
  return image;
}

} // namespace reference
