// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Input/VolumeGrid.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkRectilinearGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace splatting
{
namespace
{
constexpr int MostVoxels = 16384; // along an axis, like the mapper's limit

/// Voxels between, or on, the points of an axis.
int voxelsAlong(int points, bool cells)
{
  return cells ? std::max(points - 1, 1) : points;
}

/// One axis of a rectilinear grid.
struct Axis
{
  std::vector<double> points;
  bool uniform = true;
  double step = 0.0; // the least or only step; 0 if there is none
  double length() const { return this->points.back() - this->points.front(); }
};

/// Whether all points are within a thousandth of a step of equal distances.
bool isUniform(const std::vector<double>& points)
{
  const double step = (points.back() - points.front()) / (double(points.size()) - 1.0);
  for (std::size_t n = 0; n < points.size(); ++n)
  {
    if (std::abs(points[n] - (points[0] + double(n) * step)) > 1e-3 * std::abs(step))
    {
      return false;
    }
  }
  return true;
}

/// False if the number of coordinates differs from that of points, or if they neither ascend nor
/// descend.
bool readAxis(vtkDataArray* coordinates, int points, Axis& axis)
{
  if (!coordinates || coordinates->GetNumberOfTuples() != points)
  {
    return false;
  }
  axis.points.resize(points);
  for (int n = 0; n < points; ++n)
  {
    axis.points[n] = coordinates->GetComponent(n, 0);
  }
  if (!std::isfinite(axis.length()))
  {
    return false;
  }
  const double sign = axis.length() < 0.0 ? -1.0 : 1.0;
  double least = std::numeric_limits<double>::max();
  for (int n = 1; n < points; ++n)
  {
    const double step = sign * (axis.points[n] - axis.points[n - 1]);
    if (!(step > 0.0))
    {
      return false;
    }
    least = std::min(least, step);
  }
  axis.uniform = points < 2 || isUniform(axis.points);
  axis.step = points < 2 ? 0.0 : axis.uniform ? axis.length() / (points - 1) : sign * least;
  return true;
}

/// Voxels of a resampled axis with steps enlarged by a factor.
int resampledCount(const Axis& axis, double factor, bool cells)
{
  if (axis.step == 0.0)
  {
    return 1;
  }
  if (axis.uniform && factor == 1.0)
  {
    return voxelsAlong(static_cast<int>(axis.points.size()), cells);
  }
  const double steps = std::ceil(axis.length() / (axis.step * factor));
  return static_cast<int>(std::min(steps, MostVoxels - 1.0)) + (cells ? 0 : 1);
}

glm::ivec3 resampledSize(const Axis (&axes)[3], bool cells, double most)
{
  for (double factor = 1.0;; factor *= 1.01)
  {
    glm::ivec3 size;
    for (int a = 0; a < 3; ++a)
    {
      size[a] = resampledCount(axes[a], factor, cells);
    }
    if (double(size.x) * size.y * size.z <= most)
    {
      return size;
    }
  }
}

/// The points or cells of an axis around the voxels at first + n * step.
ResampledAxis locate(const Axis& axis, double first, double step, int count, bool cells)
{
  ResampledAxis result;
  const std::vector<double>& points = axis.points;
  const int last = std::max(static_cast<int>(points.size()) - 2, 0);
  int below = 0;
  for (int n = 0; n < count; ++n)
  {
    const double at = first + n * step;
    while (below < last && (at - points[below + 1]) * step >= 0.0)
    {
      ++below;
    }
    result.below.push_back(below);
    if (!cells)
    {
      const double width = points.size() > 1 ? points[below + 1] - points[below] : 1.0;
      result.fraction.push_back(std::clamp((at - points[below]) / width, 0.0, 1.0));
    }
  }
  return result;
}

void describeImage(vtkImageData* image, GridOfDataSet& result)
{
  const double* const rowMajor = image->GetIndexToPhysicalMatrix()->GetData();
  const int* const extent = image->GetExtent();
  glm::dmat4& m = result.grid.indexToPhysical;
  glm::dvec4 first(extent[0], extent[2], extent[4], 1.0);
  for (int r = 0; r < 4; ++r)
  {
    for (int c = 0; c < 4; ++c)
    {
      m[c][r] = rowMajor[4 * r + c];
    }
  }
  for (int a = 0; a < 3; ++a)
  {
    // A layer of cells on a single point has no thickness.
    first[a] += result.grid.cells && extent[2 * a] < extent[2 * a + 1] ? 0.5 : 0.0;
    result.grid.spacing[a] = image->GetSpacing()[a];
    result.grid.first[a] = image->GetOrigin()[a] + first[a] * image->GetSpacing()[a];
  }
  m[3] = m * first;
  result.grid.dimensions = result.dimensions;
  result.resampled = result.coarse = false;
}

/// The step of axes with a single point.
double stepOfOthers(const Axis (&axes)[3])
{
  double step = std::numeric_limits<double>::max();
  for (const Axis& axis : axes)
  {
    step = std::min(step, axis.step != 0.0 ? std::abs(axis.step) : step);
  }
  return step < std::numeric_limits<double>::max() ? step : 1.0;
}

void describeAxes(const Axis (&axes)[3], GridOfDataSet& result)
{
  const bool cells = result.grid.cells;
  const glm::dvec3 n(result.dimensions);
  result.resampled = !(axes[0].uniform && axes[1].uniform && axes[2].uniform);
  result.grid.dimensions = result.resampled
    ? resampledSize(axes, cells, std::max(GridOfDataSet::MostResampled, n.x * n.y * n.z))
    : result.dimensions;
  result.coarse = false;
  result.grid.indexToPhysical = glm::dmat4(1.0);
  for (int a = 0; a < 3; ++a)
  {
    const Axis& axis = axes[a];
    const int count = result.grid.dimensions[a];
    const double steps = cells ? count : count - 1.0;
    const double step = axis.step != 0.0 ? axis.length() / steps : stepOfOthers(axes);
    // Steps that are not enlarged equal at most the least one, within rounding.
    result.coarse |= axis.step != 0.0 && std::abs(step) > 1.000001 * std::abs(axis.step);
    const double first = axis.points[0] + (cells && axis.step != 0.0 ? 0.5 * step : 0.0);
    result.grid.indexToPhysical[a][a] = result.grid.spacing[a] = step;
    result.grid.indexToPhysical[3][a] = result.grid.first[a] = first;
    result.axes[a] = result.resampled ? locate(axis, first, step, count, cells) : ResampledAxis{};
  }
}
}

std::string describeGrid(vtkDataSet* data, bool cells, GridOfDataSet& result)
{
  vtkImageData* const image = vtkImageData::SafeDownCast(data);
  vtkRectilinearGrid* const grid = vtkRectilinearGrid::SafeDownCast(data);
  const int* const points = image ? image->GetDimensions() : grid->GetDimensions();
  result.grid.cells = cells;
  for (int a = 0; a < 3; ++a)
  {
    result.dimensions[a] = voxelsAlong(points[a], cells);
  }
  // Positions in rows, slices and the shear image are int, and must be exact in double.
  if (std::max({ points[0], points[1], points[2] }) > MostVoxels)
  {
    return "The input has more than 16384 voxels along an axis: extract a part of it.";
  }
  if (image)
  {
    describeImage(image, result);
    return {};
  }
  Axis axes[3];
  vtkDataArray* const coordinates[3] = { grid->GetXCoordinates(), grid->GetYCoordinates(),
    grid->GetZCoordinates() };
  for (int a = 0; a < 3; ++a)
  {
    if (!readAxis(coordinates[a], points[a], axes[a]))
    {
      return std::string("The ") + "XYZ"[a] +
        " coordinates of the rectilinear grid must be one number for each point, and all ascend or "
        "all descend.";
    }
  }
  describeAxes(axes, result);
  return {};
}
}
