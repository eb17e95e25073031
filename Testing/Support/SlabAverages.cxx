// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "SlabAverages.h"

#include "Integration.h"

#include <cmath>
#include <limits>

namespace reference
{

namespace
{

/**
 * The mean of h(x - i) for each voxel i, where x lies in [low, high] with some density.
 */
template <class Density>
AxisWeights meanKernel(const Kernel& h, double low, double high, std::vector<double> kinks,
  const std::vector<Node>& rule, const Density& density)
{
  const IndexRange range = reachingIndices(h, low, high);
  for (double kink : fieldKinks(h, low, high))
  {
    kinks.push_back(kink);
  }
  AxisWeights result;
  result.first = range.first;
  result.weights.assign(range.count, 0.0);
  for (const Node& x : compositeRule(rule, low, high, kinks))
  {
    for (int n = 0; n < range.count; ++n)
    {
      result.weights[n] += x.weight * density(x.position) * h(x.position - (range.first + n));
    }
  }
  return result;
}

AxisWeights meanOverInterval(
  const Kernel& h, double low, double high, const std::vector<Node>& rule)
{
  return meanKernel(h, low, high, {}, rule, [=](double) { return 1.0 / (high - low); });
}

/**
 * Where x = centre + path a + width b, a and b uniform in [-1/2, 1/2]: its density is the length of
 * what two intervals have in common, a trapezium.
 */
AxisWeights meanOverPart(
  const Kernel& h, double centre, double path, double width, const std::vector<Node>& rule)
{
  if (path == 0.0)
  {
    return meanOverInterval(h, centre - 0.5 * width, centre + 0.5 * width, rule);
  }
  const double outer = 0.5 * (path + width), inner = 0.5 * std::abs(path - width);
  const auto density = [=](double x)
  {
    const double d = x - centre;
    const double common =
      std::min(d + 0.5 * width, 0.5 * path) - std::max(d - 0.5 * width, -0.5 * path);
    return std::max(common, 0.0) / (path * width);
  };
  return meanKernel(
    h, centre - outer, centre + outer, { centre - inner, centre + inner }, rule, density);
}

std::vector<Node> ruleFor(const Kernel& kernel)
{
  return gaussLegendre(kernel.shape == Kernel::CosineBell ? 14 : 4);
}

/**
 * average(u, v, slice) of each slice that rays cross.
 */
template <class Average>
RaySamples<double> averages(const ImageRays& rays, const Average& average)
{
  RaySamples<double> samples;
  for (int v = 0; v < rays.height(); ++v)
  {
    for (int u = 0; u < rays.width(); ++u)
    {
      samples.emplace_back();
      for (int slice : crossedSlices(rays, u, v))
      {
        samples.back().push_back(sampleOf(slice, average(u, v, slice)));
      }
    }
  }
  return samples;
}

double largestSlope(const std::vector<double>& slopes)
{
  double largest = 0.0;
  for (double slope : slopes)
  {
    largest = std::max(largest, std::abs(slope));
  }
  return largest;
}

/**
 * Between these depths within a slice, what a pixel's window adds to each voxel is smooth: where
 * neither edge passes a kink of the field.
 */
std::vector<double> frustumKinks(
  const ImageRays& rays, const Kernel& kernel, int u, int v, const std::array<double, 2>& faces)
{
  std::vector<double> kinks = fieldKinks(kernel, faces[0], faces[1]);
  const int pixel[2] = { u, v };
  for (int a = 0; a < 2; ++a)
  {
    for (double side : { -0.5, 0.5 })
    {
      const auto edge = [&](double z)
      { return rays.position(a, pixel[a], z) + side * rays.spacing(z); };
      const double first = edge(faces[0]), last = edge(faces[1]);
      if (first != last)
      {
        for (double kink : fieldKinks(kernel, std::min(first, last), std::max(first, last)))
        {
          // Edges are straight, as no slice is on both sides of the eye.
          kinks.push_back(faces[0] + (faces[1] - faces[0]) * (kink - first) / (last - first));
        }
      }
    }
  }
  return kinks;
}

/**
 * The average over the part of a slice in the frustum of a pixel.
 */
class FrustumAverage
{
public:
  FrustumAverage(const SeenVolume& source, const Kernel& kernel)
    : Source(source),
      H(kernel),
      Rule(ruleFor(kernel)),
      // Along parallel rays all kernels except bells are polynomials of the depth.
      DepthRule(
        gaussLegendre(source.rays.isParallel() && kernel.shape != Kernel::CosineBell ? 4 : 16))
  {
  }

  WeightedSum operator()(int u, int v, int slice) const
  {
    const ImageRays& rays = this->Source.rays;
    const std::array<double, 2> faces = rays.faces(slice, slice);
    const std::vector<double> kinks = frustumKinks(rays, this->H, u, v, faces);
    WeightedSum slab;
    for (const Node& node : compositeRule(this->DepthRule, faces[0], faces[1], kinks))
    {
      const double z = node.position, half = 0.5 * rays.spacing(z);
      const double x = rays.position(0, u, z), y = rays.position(1, v, z);
      slab.add(node.weight / (faces[1] - faces[0]),
        this->Source.sum(meanOverInterval(this->H, x - half, x + half, this->Rule),
          meanOverInterval(this->H, y - half, y + half, this->Rule), kernelAt(this->H, z)));
    }
    return slab;
  }

private:
  const SeenVolume& Source;
  const Kernel& H;
  const std::vector<Node> Rule, DepthRule;
};

/**
 * A slice cut into parts, in each of which weights are products of means.
 */
class SlabAverage
{
public:
  SlabAverage(const SeenVolume& source, const Kernel& kernel)
    : Source(source),
      H(kernel),
      Rule(ruleFor(kernel)),
      Parts(partsPerSlice(source.rays, kernel))
  {
  }

  WeightedSum operator()(int u, int v, int slice) const
  {
    const ImageRays& rays = this->Source.rays;
    const std::array<double, 2> faces = rays.faces(slice, slice);
    const double thickness = (faces[1] - faces[0]) / this->Parts;
    WeightedSum slab;
    for (int part = 0; part < this->Parts; ++part)
    {
      const double low = faces[0] + part * thickness, middle = low + 0.5 * thickness;
      AxisWeights x = meanOverPart(this->H, rays.position(0, u, middle),
        std::abs(rays.slope[0][u]) * thickness, rays.spacing(middle), this->Rule);
      AxisWeights y = meanOverPart(this->H, rays.position(1, v, middle),
        std::abs(rays.slope[1][v]) * thickness, rays.spacing(middle), this->Rule);
      AxisWeights z = meanOverInterval(this->H, low, low + thickness, this->Rule);
      x.divideBySum();
      y.divideBySum();
      z.divideBySum();
      slab.add(1.0 / this->Parts, this->Source.sum(x, y, z));
    }
    return slab;
  }

private:
  const SeenVolume& Source;
  const Kernel& H;
  const std::vector<Node> Rule;
  const int Parts;
};

} // namespace

//------------------------------------------------------------------------------
int partsPerSlice(const ImageRays& rays, const Kernel& kernel)
{
  const double product = largestSlope(rays.slope[0]) * largestSlope(rays.slope[1]);
  int parts = kernel.shape == Kernel::Nearest ? 1 : 2;
  while (product > 0.25 * parts * parts)
  {
    ++parts;
  }
  return parts;
}

//------------------------------------------------------------------------------
RaySamples<double> slabSamples(
  const Volume<double>& volume, const ImageRays& rays, const Kernel& kernel)
{
  if (rays.isParallel())
  {
    return frustumSamples(volume, rays, kernel);
  }
  const SeenVolume source = { volume, rays };
  return averages(rays, SlabAverage(source, kernel));
}

//------------------------------------------------------------------------------
Sample<double> slabSample(const Volume<double>& volume, const ImageRays& rays, const Kernel& kernel,
  int u, int v, int slice)
{
  const SeenVolume source = { volume, rays };
  return sampleOf(slice,
    rays.isParallel() ? FrustumAverage(source, kernel)(u, v, slice)
                      : SlabAverage(source, kernel)(u, v, slice));
}

//------------------------------------------------------------------------------
RaySamples<double> frustumSamples(
  const Volume<double>& volume, const ImageRays& rays, const Kernel& kernel)
{
  const SeenVolume source = { volume, rays };
  return averages(rays, FrustumAverage(source, kernel));
}

//------------------------------------------------------------------------------
double lostByParts(const ImageRays& rays, const Kernel& kernel, int u, int v, int slice)
{
  const int parts = partsPerSlice(rays, kernel);
  const std::array<double, 2> faces = rays.faces(slice, slice);
  const double t = (faces[1] - faces[0]) / parts;
  const double a = std::abs(rays.slope[0][u]), b = std::abs(rays.slope[1][v]);
  const double drift = 0.25 * t * rays.pitch / std::abs(rays.start - rays.eye);
  double lost = 0.0;
  for (int part = 0; part < parts; ++part)
  {
    const double low = faces[0] + part * t;
    const double narrowest = std::min(rays.spacing(low), rays.spacing(low + t));
    double differences = 0.0;
    if (kernel.shape == Kernel::Nearest)
    {
      differences = 4.0 / (narrowest * narrowest) * a * b * t * t / 12.0 + 2.0 * drift / narrowest;
    }
    else
    {
      const double steepest = kernel.shape == Kernel::Trilinear ? 2.0 : 3.14159265358979323846;
      differences = steepest * steepest * (a * b + a + b) * t * t / 12.0 + 0.5 * steepest * drift;
    }
    lost += 0.5 * std::min(differences, 2.0) / parts;
  }
  return lost;
}

} // namespace reference
