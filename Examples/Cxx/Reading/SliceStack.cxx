// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/SliceStack.h"

#include "vtkMath.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace
{
/// Planes that are closer than so many pixels lie at the same place.
constexpr double SamePlace = 0.01;

/// Pixels that a slice's corners may be off: less than what a projection resolves.
constexpr double HalfPixel = 0.5;

/// Steps that a slice may be off its even place.
constexpr double EvenEnough = 0.1;

/// Times as many slices as there are.
constexpr double MostSlices = 8.0;

[[noreturn]] void RefusePlane(const SlicePlane& plane, const std::string& reason)
{
  throw std::runtime_error(plane.Name + ": " + reason);
}

double Dot(const Vector3& a, const Vector3& b)
{
  return vtkMath::Dot(a.data(), b.data());
}

Vector3 Subtract(const Vector3& a, const Vector3& b)
{
  return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
}

Vector3 GetNormal(const SlicePlane& plane)
{
  Vector3 normal;
  vtkMath::Cross(plane.Row.data(), plane.Column.data(), normal.data());
  return normal;
}

double GetPixel(const SlicePlane& plane)
{
  return std::min(plane.Spacing[0], plane.Spacing[1]);
}

std::string At(const SlicePlane& plane)
{
  std::ostringstream text;
  text << "at (" << plane.Position[0] << ", " << plane.Position[1] << ", " << plane.Position[2]
       << ") mm";
  return text.str();
}

std::string Describe(const SlicePlane& plane)
{
  return plane.Name + " " + At(plane);
}

/**
 * Degrees between planes, in themselves or against each other.
 */
double GetAngle(const SlicePlane& a, const SlicePlane& b)
{
  return vtkMath::DegreesFromRadians(
    std::max(vtkMath::AngleBetweenVectors(a.Row.data(), b.Row.data()),
      vtkMath::AngleBetweenVectors(a.Column.data(), b.Column.data())));
}

bool HaveSameOrientation(const SlicePlane& a, const SlicePlane& b)
{
  const double reach = std::hypot(a.Size[0] * a.Spacing[0], a.Size[1] * a.Spacing[1]);
  return vtkMath::RadiansFromDegrees(GetAngle(a, b)) * reach < HalfPixel * GetPixel(a);
}

bool HaveSameSpacing(const SlicePlane& a, const SlicePlane& b)
{
  const auto isSame = [&](int axis)
  {
    return std::fabs(a.Spacing[axis] - b.Spacing[axis]) * a.Size[axis] <
      HalfPixel * a.Spacing[axis];
  };
  return isSame(0) && isSame(1);
}

/**
 * How a plane differs from the usual ones.
 */
std::string DescribeDifference(const SlicePlane& odd, const SlicePlane& usual)
{
  std::ostringstream text;
  if (!HaveSameOrientation(odd, usual))
  {
    text << "is turned by " << GetAngle(odd, usual) << " degrees";
  }
  else if (odd.Size != usual.Size)
  {
    text << "has " << odd.Size[0] << " x " << odd.Size[1] << " pixels, not " << usual.Size[0]
         << " x " << usual.Size[1];
  }
  else
  {
    text << "has pixels of " << odd.Spacing[0] << " x " << odd.Spacing[1] << " mm, not "
         << usual.Spacing[0] << " x " << usual.Spacing[1];
  }
  return text.str();
}

double GetMedian(std::vector<double> values)
{
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/**
 * The slice that goes aside by another way from the one before than most do, and how far.
 */
std::pair<std::size_t, double> FindJump(const std::vector<const SlicePlane*>& stack)
{
  const Vector3 normal = GetNormal(*stack[0]);
  std::vector<double> heights, slopes[2];
  for (std::size_t i = 1; i < stack.size(); ++i)
  {
    const Vector3 step = Subtract(stack[i]->Position, stack[i - 1]->Position);
    heights.push_back(Dot(step, normal));
    slopes[0].push_back(Dot(step, stack[0]->Row) / heights.back());
    slopes[1].push_back(Dot(step, stack[0]->Column) / heights.back());
  }
  const double usual[2] = { GetMedian(slopes[0]), GetMedian(slopes[1]) };
  std::pair<std::size_t, double> jump(1, 0.0);
  for (std::size_t i = 0; i < heights.size(); ++i)
  {
    const double aside = heights[i] * std::hypot(slopes[0][i] - usual[0], slopes[1][i] - usual[1]);
    jump = aside > jump.second ? std::make_pair(i + 1, aside) : jump;
  }
  return jump;
}

/**
 * Where the slices lie along the line from the first to the last, whose direction is given.
 */
std::vector<double> FindPlacesOnLine(
  const std::vector<const SlicePlane*>& stack, const Vector3& direction)
{
  const Vector3 normal = GetNormal(*stack[0]);
  std::vector<double> places;
  double farthest = 0.0;
  for (const SlicePlane* plane : stack)
  {
    Vector3 aside = Subtract(plane->Position, stack[0]->Position);
    places.push_back(Dot(aside, normal) / Dot(direction, normal));
    for (int axis = 0; axis < 3; ++axis)
    {
      aside[axis] -= places.back() * direction[axis];
    }
    farthest = std::max(farthest, vtkMath::Norm(aside.data()));
  }
  if (farthest > HalfPixel * GetPixel(*stack[0]))
  {
    const auto jump = FindJump(stack);
    std::ostringstream text;
    text
      << "this slice, " << At(*stack[jump.first]) << ", is shifted sideways by " << jump.second
      << " mm against the one before, " << Describe(*stack[jump.first - 1])
      << "; move what does not belong to the volume out of the folder, or choose another series.";
    RefusePlane(*stack[jump.first], text.str());
  }
  return places;
}

bool IsEven(const std::vector<double>& places)
{
  const double step = places.back() / static_cast<double>(places.size() - 1);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    if (std::fabs(places[i] - static_cast<double>(i) * step) > EvenEnough * step)
    {
      return false;
    }
  }
  return true;
}

/**
 * The mean of the steps that are about the least, changed so that the last slice is on the grid.
 */
double ChooseStep(const std::vector<double>& steps, double length)
{
  const double least = *std::min_element(steps.begin(), steps.end());
  double sum = 0.0;
  std::size_t count = 0;
  for (const double step : steps)
  {
    sum += step < (1.0 + EvenEnough) * least ? step : 0.0;
    count += step < (1.0 + EvenEnough) * least;
  }
  return length / std::max(1.0, std::round(length * static_cast<double>(count) / sum));
}

/**
 * What to say of uneven steps: where slices are missing, or else where the steps change.
 */
std::string DescribeSteps(
  const std::vector<const SlicePlane*>& stack, const std::vector<double>& steps, double step)
{
  std::ostringstream text;
  std::size_t missing = 0;
  const std::size_t last = steps.size() - 1;
  for (std::size_t i = 0; i <= last; ++i)
  {
    const double before = steps[i > 0 ? i - 1 : i + 1], after = steps[i < last ? i + 1 : i - 1];
    if (steps[i] > 1.5 * std::max(before, after))
    {
      const long count = std::lround(steps[i] / step) - 1;
      text << (missing ? ", " : "") << count << " between " << Describe(*stack[i]) << " and "
           << Describe(*stack[i + 1]);
      missing += static_cast<std::size_t>(count);
    }
  }
  if (missing)
  {
    return std::to_string(missing) + " slices are missing and were interpolated: " + text.str();
  }
  const auto range = std::minmax_element(steps.begin(), steps.end());
  const auto change = std::adjacent_find(steps.begin(), steps.end(),
    [&](double a, double b) { return std::fabs(a - b) > EvenEnough * step; });
  const auto where = static_cast<std::size_t>(change - steps.begin()) % last + 1;
  text << "the slices are " << *range.first << " to " << *range.second
       << " mm apart and were interpolated to " << step << " mm; their distance changes from "
       << steps[where - 1] << " to " << steps[where] << " mm at " << Describe(*stack[where]);
  return text.str();
}

/**
 * Slices at even places, each one of those there are if that is near enough, or between two.
 */
std::vector<SliceBlend> Interpolate(
  const std::vector<double>& places, const std::vector<std::size_t>& order, double step)
{
  const auto count = static_cast<std::size_t>(std::lround(places.back() / step)) + 1;
  std::vector<SliceBlend> slices;
  std::size_t i = 0;
  for (std::size_t k = 0; k < count; ++k)
  {
    const double place = static_cast<double>(k) * step;
    while (i + 2 < places.size() && places[i + 1] <= place)
    {
      ++i;
    }
    const double distance = places[i + 1] - places[i];
    double weight = std::clamp((place - places[i]) / distance, 0.0, 1.0);
    weight = weight * distance < EvenEnough * step ? 0.0 : weight;
    weight = (1.0 - weight) * distance < EvenEnough * step ? 1.0 : weight;
    slices.push_back({ order[i], order[i + 1], weight });
  }
  return slices;
}

void CheckCount(
  const std::vector<const SlicePlane*>& stack, const std::vector<double>& steps, double step)
{
  const double length = std::accumulate(steps.begin(), steps.end(), 0.0);
  if (length / step > MostSlices * static_cast<double>(stack.size()))
  {
    const auto range = std::minmax_element(steps.begin(), steps.end());
    const auto least = static_cast<std::size_t>(range.first - steps.begin());
    const auto most = static_cast<std::size_t>(range.second - steps.begin());
    std::ostringstream text;
    text << "this slice, " << At(*stack[least]) << ", is " << *range.first << " mm from the next, "
         << Describe(*stack[least + 1]) << ", while there are " << *range.second << " mm between "
         << Describe(*stack[most]) << " and " << Describe(*stack[most + 1])
         << ", which is too uneven to interpolate; move what does not belong to the volume out of "
            "the folder.";
    RefusePlane(*stack[least], text.str());
  }
}
}

std::array<Vector3, 3> MakeSteps(const SlicePlane& plane, const Vector3& direction, double step)
{
  std::array<Vector3, 3> steps;
  for (int row = 0; row < 3; ++row)
  {
    steps[0][row] = plane.Row[row] * plane.Spacing[0];
    steps[1][row] = plane.Column[row] * plane.Spacing[1];
    steps[2][row] = direction[row] * step;
  }
  return steps;
}

std::vector<std::size_t> FindLargestStack(const std::vector<SlicePlane>& planes, std::string& note)
{
  std::vector<std::vector<std::size_t>> kinds;
  for (std::size_t i = 0; i < planes.size(); ++i)
  {
    const auto kind = std::find_if(kinds.begin(), kinds.end(),
      [&](const auto& other)
      {
        const SlicePlane& first = planes[other.front()];
        return HaveSameOrientation(first, planes[i]) && first.Size == planes[i].Size &&
          HaveSameSpacing(first, planes[i]);
      });
    (kind == kinds.end() ? *kinds.insert(kind, std::vector<std::size_t>()) : *kind).push_back(i);
  }
  const auto usual = std::max_element(
    kinds.begin(), kinds.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  const auto odd = usual == kinds.begin() ? kinds.end() - 1 : kinds.begin();
  if (kinds.size() > 1)
  {
    const SlicePlane& plane = planes[odd->front()];
    note = "only the largest stack is shown; " + std::to_string(planes.size() - usual->size()) +
      " of " + std::to_string(planes.size()) + " slices do not fit, such as " + Describe(plane) +
      ", which " + DescribeDifference(plane, planes[usual->front()]);
  }
  return *usual;
}

std::vector<std::vector<std::size_t>> FindPlaces(const std::vector<SlicePlane>& planes)
{
  const Vector3 normal = GetNormal(planes[0]);
  std::vector<std::pair<double, std::size_t>> heights;
  for (std::size_t i = 0; i < planes.size(); ++i)
  {
    heights.emplace_back(Dot(planes[i].Position, normal), i);
  }
  std::sort(heights.begin(), heights.end());
  std::vector<std::vector<std::size_t>> places;
  double last = 0.0;
  for (const auto& [height, plane] : heights)
  {
    if (places.empty() || height - last > SamePlace * GetPixel(planes[0]))
    {
      places.emplace_back();
    }
    places.back().push_back(plane);
    last = height;
  }
  return places;
}

SliceGrid MakeGrid(const std::vector<SlicePlane>& planes, const std::vector<std::size_t>& order)
{
  if (order.size() == 1)
  {
    return { GetNormal(planes[order[0]]), 0.0, { { order[0], order[0], 0.0 } }, "" };
  }
  std::vector<const SlicePlane*> stack;
  for (const std::size_t plane : order)
  {
    stack.push_back(&planes[plane]);
  }
  Vector3 direction = Subtract(stack.back()->Position, stack.front()->Position);
  vtkMath::Normalize(direction.data());
  const std::vector<double> places = FindPlacesOnLine(stack, direction);
  SliceGrid grid = { direction, places.back() / static_cast<double>(places.size() - 1), {}, "" };
  if (IsEven(places))
  {
    for (const std::size_t plane : order)
    {
      grid.Slices.push_back({ plane, plane, 0.0 });
    }
    return grid;
  }
  std::vector<double> steps(places.size());
  std::adjacent_difference(places.begin(), places.end(), steps.begin());
  steps.erase(steps.begin());
  grid.Step = ChooseStep(steps, places.back());
  CheckCount(stack, steps, grid.Step);
  grid.Slices = Interpolate(places, order, grid.Step);
  grid.Note = DescribeSteps(stack, steps, grid.Step);
  return grid;
}
