// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The oracle of reductions itself: rays worked out by hand.
#include "CoreTesting.h"
#include "Reductions.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

using namespace coretesting;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// One sample per slice, from the viewer.
reference::CutRay<double> rayOf(std::initializer_list<double> values)
{
  reference::CutRay<double> ray;
  for (double value : values)
  {
    ray.samples.push_back({ value, ray.slices++ });
  }
  return ray;
}

std::vector<double> sorted(const reference::Outcomes<double>& outcomes)
{
  std::vector<double> values;
  for (const auto& outcome : outcomes)
  {
    values.push_back(outcome.hit ? outcome.value : Infinity);
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

void testLocalByHand(Checks& check)
{
  const auto is = [&](std::initializer_list<double> ray, double threshold, double error,
                    const std::vector<double>& expected)
  {
    check(sorted(reference::firstLocalMaximum(rayOf(ray), threshold, error)) == expected,
      "local maximum at or above ", threshold, " of a ray that begins with ",
      ray.size() ? *ray.begin() : Infinity);
  };
  is({ 1, 2, 7, 9 }, -Infinity, 0.0, { 9 });     // rises: the maximum
  is({ 9, 7, 2, 1 }, -Infinity, 0.0, { 9 });     // falls: the first
  is({ 1, 5, 3, 9 }, -Infinity, 0.0, { 5 });     // the first hill
  is({ 1, 5, 3, 9 }, 5.0, 0.0, { 5 });           // just high enough
  is({ 1, 5, 3, 9, 2, 20 }, 6.0, 0.0, { 9 });    // the second
  is({ 1, 5, 3, 9 }, 10.0, 0.0, { 9 });          // none: the global maximum
  is({ 5, 1, 3 }, 10.0, 0.0, { 5 });             // none, and not the last
  is({ 1, 5, 5, 7, 7, 2, 8 }, 2.0, 0.0, { 7 });  // a plateau goes on
  is({ 3, 1, 2, 2.5, 8, 7 }, 4.0, 0.0, { 8 });   // a hill below the threshold is none
  is({ 4, 1, 4, 3, 9 }, 4.0, 0.0, { 4 });        // begins above the threshold
  is({}, 1.0, 0.0, { Infinity });                // no sample
  is({ 1, 5, 4.9, 9, 2 }, 2.0, 0.1, { 5, 9 });   // is it a hill?
  is({ 1, 5, 3, 9, 2 }, 5.05, 0.1, { 5, 9 });    // is it high enough?
  is({ 1, 5, 5.1, 2, 9 }, 2.0, 0.1, { 5, 5.1 }); // is there a dent?
  is({ 1, 5, 3, 9, 2 }, 2.0, 0.1, { 5 });        // sure
}

void testMeanByHand(Checks& check)
{
  const auto ray = rayOf({ 1, 2, 3, 6 });
  check(sorted(reference::mean(ray, -Infinity, Infinity, 0.0)) == std::vector<double>{ 3 }, "mean");
  check(sorted(reference::mean(ray, 2, 3, 0.0)) == std::vector<double>{ 2.5 }, "mean of a range");
  check(sorted(reference::mean(ray, 4, 5, 0.0)) == std::vector<double>{ Infinity }, "mean of none");
  check(sorted(reference::mean(ray, 2.01, 7, 0.1)) == std::vector<double>{ 11.0 / 3, 4.5 },
    "mean of samples that may be in the range");
}

void testDepthByHand(Checks& check)
{
  // Factors 1, 0.75, 0.5, 0.25 of what is above 10.
  const auto ray = rayOf({ 10, 14, 26, 30 });
  const auto shaded = reference::depthShaded(ray, 10.0, 0.0, 1.0);
  check(sorted(shaded) == std::vector<double>{ 18 }, "depth-shaded maximum");
}

}

int TestReferenceReductions(int, char*[])
{
  Checks check;
  testLocalByHand(check);
  testMeanByHand(check);
  testDepthByHand(check);
  return check.exitCode();
}
