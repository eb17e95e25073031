// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Integration.h
 * @brief   numerical integration of a volume that is continued between its voxels
 */
#ifndef reference_Integration_h
#define reference_Integration_h

#include "Projection.h"

#include <cmath>
#include <vector>

namespace reference
{

struct Node
{
  double position;
  double weight;
};

/**
 * The Gauss-Legendre rule on [-1, 1].
 */
std::vector<Node> gaussLegendre(int count);

/**
 * The rule applied to each piece of [low, high] between kinks (in any order, inside or not).
 */
std::vector<Node> compositeRule(
  const std::vector<Node>& rule, double low, double high, std::vector<double> kinks);

/**
 * The indices from first on whose kernels reach into some interval.
 */
struct IndexRange
{
  int first;
  int count;
};

IndexRange reachingIndices(const Kernel& kernel, double low, double high);

/**
 * Where the field may have a kink or a step along one axis: where a voxel's kernel ends. (The hat's
 * kink at its own voxel is the end of the next voxel's.)
 */
std::vector<double> fieldKinks(const Kernel& kernel, double low, double high);

/**
 * A weighted sum of voxels and the sum of the weights.
 */
struct WeightedSum
{
  double sum = 0.0;
  double weight = 0.0;

  // The weight 0 is left out as 0 times infinity is NaN.
  void addVoxel(double factor, double voxel)
  {
    if (factor > 0.0 && !std::isnan(voxel))
    {
      this->sum += factor * voxel;
      this->weight += factor;
    }
  }
  void add(double factor, const WeightedSum& other)
  {
    if (factor > 0.0)
    {
      this->sum += factor * other.sum;
      this->weight += factor * other.weight;
    }
  }
};

/**
 * Weights of voxels along one axis.
 */
struct AxisWeights
{
  int first = 0;
  std::vector<double> weights;

  void divideBySum()
  {
    double sum = 0.0;
    for (double weight : this->weights)
    {
      sum += weight;
    }
    for (double& weight : this->weights)
    {
      weight /= sum;
    }
  }
};

/**
 * The weights of all voxels whose kernel includes a position.
 */
AxisWeights kernelAt(const Kernel& kernel, double place);

/**
 * The volume seen along the rays, continued by its outermost voxels.
 */
struct SeenVolume
{
  const Volume<double>& volume;
  const ImageRays& rays;

  double voxel(int i, int j, int k) const
  {
    const int indices[3] = { i, j, k };
    std::array<int, 3> position;
    for (int a = 0; a < 3; ++a)
    {
      position[this->rays.axes[a]] = std::clamp(indices[a], 0, this->rays.size[a] - 1);
    }
    return this->volume.at(position);
  }

  /**
   * The sum of products of weights times voxels.
   */
  WeightedSum sum(const AxisWeights& x, const AxisWeights& y, const AxisWeights& z) const
  {
    WeightedSum result;
    for (std::size_t k = 0; k < z.weights.size(); ++k)
    {
      for (std::size_t j = 0; j < y.weights.size(); ++j)
      {
        for (std::size_t i = 0; i < x.weights.size(); ++i)
        {
          result.addVoxel(x.weights[i] * y.weights[j] * z.weights[k],
            this->voxel(x.first + int(i), y.first + int(j), z.first + int(k)));
        }
      }
    }
    return result;
  }
};

/**
 * Without weight it is 0 / 0, a NaN, no sample.
 */
inline Sample<double> sampleOf(int slice, const WeightedSum& slab)
{
  return { slice, slab.sum / slab.weight, slab.weight };
}

} // namespace reference

#endif
