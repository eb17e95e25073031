// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Integration.h"

#include <algorithm>

namespace reference
{

namespace
{

constexpr double Pi = 3.14159265358979323846;

struct Legendre
{
  double value;
  double derivative;
};

Legendre legendrePolynomial(int degree, double x)
{
  double previous = 1.0;
  double value = x;
  for (int n = 2; n <= degree; ++n)
  {
    const double next = ((2 * n - 1) * x * value - (n - 1) * previous) / n;
    previous = value;
    value = next;
  }
  return { value, degree * (x * value - previous) / (x * x - 1.0) };
}

} // namespace

//------------------------------------------------------------------------------
// Nodes by Newton's method.
std::vector<Node> gaussLegendre(int count)
{
  std::vector<Node> rule;
  for (int n = 0; n < count; ++n)
  {
    double x = std::cos(Pi * (n + 0.75) / (count + 0.5));
    for (int iteration = 0; iteration < 10; ++iteration)
    {
      const Legendre p = legendrePolynomial(count, x);
      x -= p.value / p.derivative;
    }
    const double slope = legendrePolynomial(count, x).derivative;
    rule.push_back({ x, 2.0 / ((1.0 - x * x) * slope * slope) });
  }
  return rule;
}

//------------------------------------------------------------------------------
std::vector<Node> compositeRule(
  const std::vector<Node>& rule, double low, double high, std::vector<double> kinks)
{
  kinks.push_back(high);
  std::sort(kinks.begin(), kinks.end());
  std::vector<Node> nodes;
  double begin = low;
  for (double end : kinks)
  {
    if (end > begin && end <= high)
    {
      for (const Node& node : rule)
      {
        nodes.push_back({ 0.5 * (begin + end) + 0.5 * (end - begin) * node.position,
          0.5 * (end - begin) * node.weight });
      }
      begin = end;
    }
  }
  return nodes;
}

//------------------------------------------------------------------------------
IndexRange reachingIndices(const Kernel& kernel, double low, double high)
{
  const int first = static_cast<int>(std::ceil(low - kernel.support()));
  const int last = static_cast<int>(std::floor(high + kernel.support()));
  return { first, last - first + 1 };
}

//------------------------------------------------------------------------------
AxisWeights kernelAt(const Kernel& kernel, double place)
{
  const IndexRange range = reachingIndices(kernel, place, place);
  AxisWeights result{ range.first, {} };
  for (int n = 0; n < range.count; ++n)
  {
    result.weights.push_back(kernel(place - (range.first + n)));
  }
  return result;
}

//------------------------------------------------------------------------------
std::vector<double> fieldKinks(const Kernel& kernel, double low, double high)
{
  const IndexRange range = reachingIndices(kernel, low, high);
  std::vector<double> kinks;
  for (int index = range.first; index < range.first + range.count; ++index)
  {
    kinks.push_back(index - kernel.support());
    kinks.push_back(index + kernel.support());
  }
  return kinks;
}

} // namespace reference
