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

//------------------------------------------------------------------------------
// Exact traversal. Time is depth, from 0 where the ray enters the first slice at z = -1/2 to n_k
// where it leaves the last. Shears are multiples of 2^-24.

/**
 * x(z) = pixel - margin - s (z - kc), where z - kc = -n_k / 2 at the start.
 */
AxisMotion inSliceMotion(int pixel, int axis, const ShearGrid& grid, const ShearView& view)
{
  const std::int64_t s = inUnits(view.shear[axis]);
  return { (pixel - grid.margin[axis]) * WholeVoxel + s / 2 * grid.size[2], -s };
}

//------------------------------------------------------------------------------
// The interpolated volume

/**
 * The volume seen along the principal axis, continued by its outermost voxels.
 */
struct ShearedVolume
{
  const Volume<double>& volume;
  const ShearGrid grid;
  const ShearView view;

  double voxel(int i, int j, int k) const
  {
    const int indices[3] = { i, j, k };
    std::array<int, 3> position;
    for (int a = 0; a < 3; ++a)
    {
      position[this->grid.axes[a]] = std::clamp(indices[a], 0, this->grid.size[a] - 1);
    }
    return this->volume.at(position);
  }

  double rayPosition(int inSliceAxis, int pixel, double z) const
  {
    return static_cast<double>(pixel) - this->grid.margin[inSliceAxis] -
      this->view.shear[inSliceAxis] * (z - this->grid.middle);
  }
};

/**
 * Numerical integration of the field over one pixel's part of one slice.
 */
class SlabIntegral
{
public:
  SlabIntegral(const ShearedVolume& source, const Kernel& kernel)
    : Source(source),
      H(kernel),
      InSliceRule(gaussLegendre(kernel.shape == Kernel::CosineBell ? 10 : 4)),
      DepthRule(gaussLegendre(kernel.shape == Kernel::CosineBell ? 16 : 4))
  {
  }

  WeightedSum operator()(int u, int v, int slice) const
  {
    const int pixel[2] = { u, v };
    const double low = slice - 0.5;
    const double high = slice + 0.5;
    std::vector<double> kinks = fieldKinks(this->H, low, high);
    this->appendWindowKinks(0, u, low, high, kinks);
    this->appendWindowKinks(1, v, low, high, kinks);
    WeightedSum slab;
    for (const Node& z : compositeRule(this->DepthRule, low, high, kinks))
    {
      slab.add(z.weight, this->integrateWindow(pixel, z.position));
    }
    return slab;
  }

private:
  /**
   * Points across the pixel along one axis and the kernel of each reaching index at each of them.
   */
  struct Samples
  {
    IndexRange range;
    std::vector<double> weights;               // one per point
    std::vector<std::array<double, 8>> kernel; // [point][index - first]
  };

  /**
   * The integral over the pixel's window is smooth in z but where an edge of the window, moving
   * with the ray, passes a kink of the field.
   */
  void appendWindowKinks(
    int axis, int pixel, double low, double high, std::vector<double>& kinks) const
  {
    const double shear = this->Source.view.shear[axis];
    if (shear == 0.0)
    {
      return;
    }
    const double a = this->Source.rayPosition(axis, pixel, low);
    const double b = this->Source.rayPosition(axis, pixel, high);
    const double left = std::min(a, b) - Half;
    const double right = std::max(a, b) + Half;
    for (double kink : fieldKinks(this->H, left, right))
    {
      kinks.push_back(low + (a - Half - kink) / shear);
      kinks.push_back(low + (a + Half - kink) / shear);
    }
  }

  Samples samplePixel(int axis, int pixel, double z) const
  {
    const double centre = this->Source.rayPosition(axis, pixel, z);
    const double low = centre - Half;
    const double high = centre + Half;
    Samples samples;
    samples.range = reachingIndices(this->H, low, high);
    for (const Node& x :
      compositeRule(this->InSliceRule, low, high, fieldKinks(this->H, low, high)))
    {
      std::array<double, 8> kernel = {};
      for (int n = 0; n < samples.range.count; ++n)
      {
        kernel[n] = this->H(x.position - (samples.range.first + n));
      }
      samples.weights.push_back(x.weight);
      samples.kernel.push_back(kernel);
    }
    return samples;
  }

  /**
   * The sum of h(z - k) times voxel (i, j, k) over k.
   */
  WeightedSum sumColumn(int i, int j, double z) const
  {
    const IndexRange range = reachingIndices(this->H, z, z);
    WeightedSum column;
    for (int k = range.first; k < range.first + range.count; ++k)
    {
      column.addVoxel(this->H(z - k), this->Source.voxel(i, j, k));
    }
    return column;
  }

  /**
   * The field summed over all points (x, y) at depth z. The field at a point is the sum over k, j
   * and i; what does not depend on x and y is summed outside their loops.
   */
  WeightedSum integrateWindow(const int pixel[2], double z) const
  {
    const Samples x = this->samplePixel(0, pixel[0], z);
    const Samples y = this->samplePixel(1, pixel[1], z);
    std::array<std::array<WeightedSum, 8>, 8> columns;
    for (int j = 0; j < y.range.count; ++j)
    {
      for (int i = 0; i < x.range.count; ++i)
      {
        columns[j][i] = this->sumColumn(x.range.first + i, y.range.first + j, z);
      }
    }
    WeightedSum window;
    for (std::size_t point = 0; point < y.weights.size(); ++point)
    {
      std::array<WeightedSum, 8> row;
      for (int i = 0; i < x.range.count; ++i)
      {
        for (int j = 0; j < y.range.count; ++j)
        {
          row[i].add(y.kernel[point][j], columns[j][i]);
        }
      }
      window.add(y.weights[point], this->integrateRow(x, row));
    }
    return window;
  }

  WeightedSum integrateRow(const Samples& x, const std::array<WeightedSum, 8>& row) const
  {
    WeightedSum line;
    for (std::size_t point = 0; point < x.weights.size(); ++point)
    {
      WeightedSum field;
      for (int i = 0; i < x.range.count; ++i)
      {
        field.add(x.kernel[point][i], row[i]);
      }
      line.add(x.weights[point], field);
    }
    return line;
  }

  const ShearedVolume& Source;
  static constexpr double Half = 0.5; // a pixel
  const Kernel H;
  const std::vector<Node> InSliceRule;
  const std::vector<Node> DepthRule;
};

WeightedSum fieldAt(const ShearedVolume& source, const Kernel& h, double x, double y, double z)
{
  const IndexRange is = reachingIndices(h, x, x);
  const IndexRange js = reachingIndices(h, y, y);
  const IndexRange ks = reachingIndices(h, z, z);
  WeightedSum field;
  for (int k = ks.first; k < ks.first + ks.count; ++k)
  {
    for (int j = js.first; j < js.first + js.count; ++j)
    {
      for (int i = is.first; i < is.first + is.count; ++i)
      {
        field.addVoxel(h(x - i) * h(y - j) * h(z - k), source.voxel(i, j, k));
      }
    }
  }
  return field;
}

bool isInside(double x, int count)
{
  return x >= -0.5 && x <= count - 0.5;
}

/**
 * The slice's value at a point of its middle plane; NaN outside the volume.
 */
double sampleSlice(
  const ShearedVolume& source, double x, double y, int slice, SliceSampling sampling)
{
  const double outside = std::numeric_limits<double>::quiet_NaN();
  const std::array<int, 3>& size = source.grid.size;
  if (sampling == SliceSampling::Bilinear)
  {
    const WeightedSum field = fieldAt(source, Kernel(), x, y, slice);
    return isInside(x, size[0]) && isInside(y, size[1]) ? field.sum / field.weight : outside;
  }
  const int i = static_cast<int>(std::floor(x + 0.5));
  const int j = static_cast<int>(std::floor(y + 0.5));
  const bool exists = i >= 0 && i < size[0] && j >= 0 && j < size[1];
  return exists ? source.voxel(i, j, slice) : outside;
}

/**
 * The slices in which the pixel's ray crosses a voxel, ascending.
 */
std::vector<int> crossedSlices(const Volume<double>& volume, const ShearView& view, int u, int v)
{
  std::vector<int> slices;
  for (const std::array<int, 3>& position : crossedVoxels(volume.size, view, u, v))
  {
    if (slices.empty() || slices.back() != position[view.axis])
    {
      slices.push_back(position[view.axis]);
    }
  }
  return slices;
}

void requireSupported(const Kernel& kernel)
{
  if (kernel.shape == Kernel::CosineBell && !(kernel.radius >= 0.5 && kernel.radius <= 1.5))
  {
    throw std::invalid_argument("The radius of the cosine bell must be in [0.5, 1.5].");
  }
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
std::vector<std::array<int, 3>> crossedVoxels(
  const std::array<int, 3>& volumeSize, const ShearView& view, int u, int v)
{
  const ShearGrid grid = makeShearGrid(volumeSize, view);
  const std::array<AxisMotion, 3> ray = { inSliceMotion(u, 0, grid, view),
    inSliceMotion(v, 1, grid, view), { -HalfVoxel, WholeVoxel } };
  std::vector<std::array<int, 3>> crossed;
  for (const std::array<int, 3>& ijk : traverse(ray, grid.size[2], grid.size))
  {
    std::array<int, 3>& position = crossed.emplace_back();
    for (int a = 0; a < 3; ++a)
    {
      position[grid.axes[a]] = ijk[a];
    }
  }
  return crossed;
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
RaySamples<double> slabSamples(
  const Volume<double>& volume, const ShearView& view, const Kernel& kernel)
{
  requireSupported(kernel);
  const ShearedVolume source = { volume, makeShearGrid(volume.size, view), view };
  const SlabIntegral integral(source, kernel);
  RaySamples<double> rays;
  for (int v = 0; v < source.grid.height; ++v)
  {
    for (int u = 0; u < source.grid.width; ++u)
    {
      rays.emplace_back();
      for (int slice : crossedSlices(volume, view, u, v))
      {
        rays.back().push_back(sampleOf(slice, integral(u, v, slice)));
      }
    }
  }
  return rays;
}

//------------------------------------------------------------------------------
Sample<double> slabSample(const Volume<double>& volume, const ShearView& view, const Kernel& kernel,
  int u, int v, int slice)
{
  requireSupported(kernel);
  const ShearedVolume source = { volume, makeShearGrid(volume.size, view), view };
  return sampleOf(slice, SlabIntegral(source, kernel)(u, v, slice));
}

//------------------------------------------------------------------------------
Image<double> slabAverage(const Volume<double>& volume, const ShearView& view, const Kernel& kernel)
{
  const RaySamples<double> rays = slabSamples(volume, view, kernel);
  const ShearGrid grid = makeShearGrid(volume.size, view);
  Image<double> image(grid.width, grid.height);
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      for (const Sample<double>& sample : rays[image.index(u, v)])
      {
        image.raise(u, v, sample.value);
      }
    }
  }
  return image;
}

//------------------------------------------------------------------------------
Image<double> pointSampledTrilinear(
  const Volume<double>& volume, const ShearView& view, double distance)
{
  const ShearedVolume source = { volume, makeShearGrid(volume.size, view), view };
  const Kernel hat;
  const int first = static_cast<int>(std::ceil(-0.5 / distance));
  const int last = static_cast<int>(std::floor((source.grid.size[2] - 0.5) / distance));
  Image<double> image(source.grid.width, source.grid.height);
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      for (int step = first; step <= last; ++step)
      {
        const double z = step * distance;
        const double x = source.rayPosition(0, u, z);
        const double y = source.rayPosition(1, v, z);
        if (isInside(x, source.grid.size[0]) && isInside(y, source.grid.size[1]))
        {
          const WeightedSum field = fieldAt(source, hat, x, y, z);
          image.raise(u, v, field.sum / field.weight);
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
  const ShearedVolume source = { volume, makeShearGrid(volume.size, view), view };
  Image<double> image(source.grid.width, source.grid.height);
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      for (int slice = 0; slice < source.grid.size[2]; ++slice)
      {
        const double x = source.rayPosition(0, u, slice);
        const double y = source.rayPosition(1, v, slice);
        image.raise(u, v, sampleSlice(source, x, y, slice, sampling));
      }
    }
  }
  return image;
}

//------------------------------------------------------------------------------
ShearView transformed(const ShearView& view, const AxisSymmetry& symmetry)
{
  const ShearGrid from = makeShearGrid({ 1, 1, 1 }, view);
  ShearView result;
  for (int a = 0; a < 3; ++a)
  {
    result.axis = symmetry.axis[a] == view.axis ? a : result.axis;
  }
  const ShearGrid to = makeShearGrid({ 1, 1, 1 }, result);
  for (int a = 0; a < 2; ++a)
  {
    const int axis = to.axes[a];
    const double shear = view.shear[symmetry.axis[axis] == from.axes[0] ? 0 : 1];
    result.shear[a] = symmetry.sign[axis] * symmetry.sign[result.axis] * shear;
  }
  return result;
}

} // namespace reference
