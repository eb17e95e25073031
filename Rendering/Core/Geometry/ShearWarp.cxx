// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Geometry/ShearWarp.h"

#include "Geometry/Magnification.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_access.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace splatting
{
namespace
{
/// The nearest multiple of 2^-bits.
double quantised(double x, int bits)
{
  return std::ldexp(std::round(std::ldexp(x, bits)), -bits);
}

/// Rows of pixels are whole registers.
constexpr int RowUnit = 64;

constexpr int SlopeBits = 24, PositionBits = 20, EyeBits = 10;

}

std::vector<glm::dvec3> clipped(const std::vector<glm::dvec3>& edges, const glm::dvec3& side)
{
  std::vector<glm::dvec3> result;
  for (std::size_t n = 0; n < edges.size(); ++n)
  {
    const glm::dvec3& a = edges[n];
    const glm::dvec3& b = edges[(n + 1) % edges.size()];
    const double atA = glm::dot(side, a), atB = glm::dot(side, b);
    if (atA >= 0.0)
    {
      result.push_back(a);
    }
    if ((atA < 0.0) != (atB < 0.0))
    {
      result.push_back((atA * b - atB * a) / (atA - atB));
    }
  }
  return result;
}

ShearWarp::ShearWarp(const View& view)
{
  const glm::dmat4& m = view.indexToClip;
  const glm::dvec3 centre = 0.5 * glm::dvec3(view.dimensions - 1);
  const double w = glm::dot(glm::dvec3(glm::row(m, 3)), centre) + m[3][3];
  // Rows of the affine map from index space to pixels, whose centres lie at integers.
  const glm::dvec4 half(0.0, 0.0, 0.0, 1.0);
  const glm::dvec4 rowX = 0.5 * view.viewport.x * (glm::row(m, 0) / w + half) - 0.5 * half;
  const glm::dvec4 rowY = 0.5 * view.viewport.y * (glm::row(m, 1) / w + half) - 0.5 * half;
  // Rays are the lines of constant pixel coordinates.
  const glm::dvec3 x(rowX), y(rowY);
  const glm::dvec3 direction = glm::cross(x, y);
  const double area = glm::length(direction);
  // Also true for NaN or infinity.
  if (!(area > 1e-12 * glm::length(x) * glm::length(y)) || !std::isfinite(area))
  {
    return;
  }
  this->Size = view.dimensions;
  this->ShowsBoxes = view.showsBoxes;
  this->Overview = splatting::minifiesAnyAxis(view);
  this->chooseAxes(direction);
  // Clip depth grows away from the viewer. Along the ray, in the direction of the principal axis:
  const double deeper = glm::dot(glm::dvec3(glm::row(m, 2)) / w, direction);
  this->Reversed = deeper * direction[this->Axes[2]] < 0.0;
  this->computeWarp(rowX, rowY);
  this->setParallelRays();
  this->Valid = true;
}

bool ShearWarp::factorise(const View& view, std::vector<ShearWarp>& images)
{
  if (isParallel(view))
  {
    images.resize(1);
    images.front() = ShearWarp(view);
    images.resize(images.front().valid() ? 1 : 0);
    return !images.empty();
  }
  std::size_t count = 0;
  Rays rays;
  const bool valid = findRays(view, rays);
  const bool overview = valid && splatting::minifiesAnyAxis(view);
  for (int direction = 0; valid && direction < 6; ++direction)
  {
    images.resize(std::max(images.size(), count + 1));
    images[count].Overview = overview;
    count += images[count].lookAlong(direction / 2, direction % 2 == 1, view, rays);
  }
  images.resize(count);
  return valid;
}

void ShearWarp::chooseAxes(const glm::dvec3& direction)
{
  // On ties (within rounding) the slowest axis is selected, because its slices are contiguous.
  int k = 2;
  for (int a = 1; a >= 0; --a)
  {
    if (std::abs(direction[a]) > std::abs(direction[k]) * (1.0 + 1e-12))
    {
      k = a;
    }
  }
  this->permute(k, this->Size);
  for (int a = 0; a < 2; ++a)
  {
    const double shear = -direction[this->Axes[a]] / direction[k];
    this->Shear[a] = quantised(std::clamp(shear, -1.0, 1.0), SlopeBits);
    // Half the stack on either side of the centre, and a pixel for footprints at the border.
    this->Margin[a] = static_cast<int>(std::ceil(std::abs(this->Shear[a]) * this->Size.z / 2)) + 1;
    this->ImageSize[a] = this->RayCount[a] = this->Size[a] + 2 * this->Margin[a];
  }
}

void ShearWarp::permute(int principalAxis, const glm::ivec3& dimensions)
{
  const int k = principalAxis;
  this->Axes = { k == 0 ? 1 : 0, k == 2 ? 1 : 2, k };
  const glm::ivec3 size = dimensions;
  for (int a = 0; a < 3; ++a)
  {
    this->Size[a] = size[this->Axes[a]];
  }
  this->Middle = 0.5 * (this->Size.z - 1);
}

void ShearWarp::setParallelRays()
{
  this->Reference = this->Middle;
  this->DepthRange = { -0.5, this->Size.z - 0.5 };
  this->SlicesSeen = { 0, this->Size.z };
  for (int a = 0; a < 2; ++a)
  {
    AxisRays& rays = a == 0 ? this->Columns : this->Rows;
    rays.at.resize(this->ImageSize[a]);
    for (int n = 0; n < this->ImageSize[a]; ++n)
    {
      rays.at[n] = n - this->Margin[a];
    }
    rays.slope.assign(this->ImageSize[a], -this->Shear[a]);
  }
}

bool ShearWarp::findRays(const View& view, Rays& rays)
{
  const glm::dmat4& m = view.indexToClip;
  glm::dmat3 linear;
  for (int c = 0; c < 3; ++c)
  {
    linear[c] = { m[c][0], m[c][1], m[c][3] };
  }
  const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  if (!(std::abs(glm::determinant(linear)) > 1e-12 * lengths) || !std::isfinite(lengths))
  {
    return false;
  }
  // Points of a ray, regardless of their distance from the eye: linear (p - eye) = w (x, y, 1), x
  // and y in [-1, 1] over the viewport.
  const glm::dmat3 inverse = glm::inverse(linear);
  const glm::dvec2 step = 2.0 / glm::dvec2(view.viewport);
  const glm::dmat3 viewport(
    step.x, 0.0, 0.0, 0.0, step.y, 0.0, 0.5 * step.x - 1.0, 0.5 * step.y - 1.0, 1.0);
  rays.eye = -(inverse * glm::dvec3(m[3][0], m[3][1], m[3][3]));
  rays.directions = inverse * viewport;
  return std::isfinite(glm::length(rays.eye)) && std::isfinite(glm::determinant(rays.directions));
}

bool ShearWarp::lookAlong(int axis, bool reversed, const View& view, const Rays& rays)
{
  this->permute(axis, view.dimensions);
  this->Perspective = true;
  this->ShowsBoxes = view.showsBoxes;
  this->Reversed = reversed;
  glm::dmat3 directions;
  for (int a = 0; a < 3; ++a)
  {
    const int b = this->Axes[a];
    this->Eye[a] = quantised(rays.eye[b], EyeBits);
    for (int c = 0; c < 3; ++c)
    {
      directions[c][a] = rays.directions[c][b] * (a == 2 && reversed ? -1.0 : 1.0);
    }
  }
  const double end = this->Size.z - 0.5, eye = this->Eye.z;
  this->Reference = reversed ? -0.5 : end;
  const double farthest = reversed ? eye + 0.5 : end - eye;
  this->DepthRange = { reversed ? -0.5 : std::max(eye, -0.5), reversed ? std::min(eye, end) : end };
  const double middle = std::clamp(eye, -1.0, double(this->Size.z));
  this->SlicesSeen = reversed
    ? Span{ 0, std::min(static_cast<int>(std::ceil(middle)), this->Size.z) }
    : Span{ static_cast<int>(std::floor(middle)) + 1, this->Size.z };
  this->SlicesSeen.begin = std::max(this->SlicesSeen.begin, 0);
  if (this->SlicesSeen.empty())
  {
    return false;
  }
  if (!this->placeRays(view, directions, farthest))
  {
    return false;
  }
  this->setPerspectiveRays(0, this->Columns);
  this->setPerspectiveRays(1, this->Rows);
  this->Valid = true;
  return true;
}

bool ShearWarp::placeRays(const View& view, const glm::dmat3& directions, double farthest)
{
  // With an odd number of steps no ray is parallel to the axis, where it could lie between voxels.
  constexpr double narrower = 1.0 + 0x1p-10;
  this->Steps = static_cast<std::int64_t>(std::ceil(2.0 * farthest * narrower)) | 1;
  this->Pitch = 2.0 * farthest / static_cast<double>(this->Steps);
  if (!this->placeImage(view, directions))
  {
    return false;
  }
  this->ScreenToShear = this->directionToPixel() * directions;
  this->ShearToScreen = glm::inverse(this->ScreenToShear);
  return true;
}

/// From directions (x, y, z), z along the image's axis, to (u w, v w, w) with w = z.
glm::dmat3 ShearWarp::directionToPixel() const
{
  // Step n has slope 2 n / Steps - 1.
  const double half = 0.5 * static_cast<double>(this->Steps);
  return { half, 0.0, 0.0, 0.0, half, 0.0, half - static_cast<double>(this->First[0]),
    half - static_cast<double>(this->First[1]), 1.0 };
}

glm::dvec3 ShearWarp::pixelOf(const glm::dvec3& point) const
{
  if (!this->Perspective)
  {
    return { glm::dvec2(point) + this->position(point.z), 1.0 };
  }
  const glm::dvec3 d = point - this->Eye;
  return this->directionToPixel() * glm::dvec3(d.x, d.y, this->Reversed ? -d.z : d.z);
}

/// The part of all pixels that shows the volume in the viewport.
bool ShearWarp::placeImage(const View& view, const glm::dmat3& directions)
{
  // The viewport's pyramid, limited to the rays that follow this axis most.
  std::vector<glm::dvec3> corners;
  const double right = view.viewport.x - 0.5, top = view.viewport.y - 0.5;
  for (const glm::dvec2& corner : { glm::dvec2(-0.5, -0.5), glm::dvec2(right, -0.5),
         glm::dvec2(right, top), glm::dvec2(-0.5, top) })
  {
    corners.push_back(directions * glm::dvec3(corner, 1.0));
  }
  for (const glm::dvec3& side : { glm::dvec3(1.0, 0.0, 1.0), glm::dvec3(-1.0, 0.0, 1.0),
         glm::dvec3(0.0, 1.0, 1.0), glm::dvec3(0.0, -1.0, 1.0) })
  {
    corners = clipped(corners, side);
  }
  const double nearest =
    this->Reversed ? this->Eye.z - this->DepthRange.y : this->DepthRange.x - this->Eye.z;
  const double farthest = this->DepthRange.y - this->DepthRange.x + nearest;
  const double half = 0.5 * static_cast<double>(this->Steps);
  for (int a = 0; a < 2; ++a)
  {
    double low = 1.0, high = -1.0;
    for (const glm::dvec3& corner : corners)
    {
      low = std::min(low, std::max(corner[a] / corner.z, -1.0));
      high = std::max(high, std::min(corner[a] / corner.z, 1.0));
    }
    const double begin = -0.5 - this->Eye[a], end = this->Size[a] - 0.5 - this->Eye[a];
    const double close = std::max(nearest, 1e-3);
    low = std::max(low, begin / (begin < 0.0 ? close : farthest));
    high = std::min(high, end / (end > 0.0 ? close : farthest));
    if (!(low <= high))
    {
      return false;
    }
    this->First[a] = static_cast<std::int64_t>(std::floor(half * (low + 1.0)));
    const auto last = static_cast<std::int64_t>(std::ceil(half * (high + 1.0)));
    this->RayCount[a] = static_cast<int>(last - this->First[a]) + 1;
  }
  this->ImageSize = { (this->RayCount.x + RowUnit - 1) / RowUnit * RowUnit, this->RayCount.y };
  return true;
}

void ShearWarp::setPerspectiveRays(int a, AxisRays& rays) const
{
  const double sign = this->Reversed ? -1.0 : 1.0;
  const double start = this->Eye[a] + (this->Eye.z - this->Reference) * sign;
  constexpr double outside = 1e6;
  rays.at.assign(this->ImageSize[a], this->Size[a] + outside);
  rays.slope.assign(this->ImageSize[a], 0.0);
  rays.steepest = 0.0;
  for (int n = 0; n < this->RayCount[a]; ++n)
  {
    const double step = static_cast<double>(this->First[a] + n);
    rays.slope[n] =
      sign * quantised(2.0 * step / static_cast<double>(this->Steps) - 1.0, SlopeBits);
    rays.at[n] = quantised(start + step * this->Pitch, PositionBits);
    rays.steepest = std::max(rays.steepest, std::abs(rays.slope[n]));
  }
}

void ShearWarp::findPart(
  const glm::ivec3& first, const glm::ivec3& dimensions, ShearWarp& part) const
{
  part = *this;
  glm::ivec3& f = part.FirstVoxel;
  for (int a = 0; a < 3; ++a)
  {
    f[a] = first[this->Axes[a]];
    part.Size[a] = dimensions[this->Axes[a]];
  }
  part.Margin += glm::ivec2(f);
  part.Middle -= f.z;
  part.Reference -= f.z;
  part.DepthRange -= double(f.z);
  part.Eye -= glm::dvec3(f);
  part.SlicesSeen.begin = std::clamp(this->SlicesSeen.begin - f.z, 0, part.Size.z);
  part.SlicesSeen.end = std::clamp(this->SlicesSeen.end - f.z, 0, part.Size.z);
  for (int a = 0; a < 2; ++a)
  {
    for (double& at : (a == 0 ? part.Columns : part.Rows).at)
    {
      at -= f[a];
    }
  }
}

void ShearWarp::computeWarp(const glm::dvec4& rowX, const glm::dvec4& rowY)
{
  // A shear pixel shows the voxel of the middle slice at its position.
  const int i = this->Axes[0], j = this->Axes[1], k = this->Axes[2];
  const glm::dmat2 linear(rowX[i], rowY[i], rowX[j], rowY[j]);
  const glm::dvec2 middle =
    glm::dvec2(rowX.w, rowY.w) + this->Middle * glm::dvec2(rowX[k], rowY[k]);
  const glm::dvec2 offset = middle - linear * glm::dvec2(this->Margin);
  this->ShearToScreen =
    glm::dmat3(glm::dvec3(linear[0], 0.0), glm::dvec3(linear[1], 0.0), glm::dvec3(offset, 1.0));
  const glm::dmat2 inverse = glm::inverse(linear);
  this->ScreenToShear = glm::dmat3(
    glm::dvec3(inverse[0], 0.0), glm::dvec3(inverse[1], 0.0), glm::dvec3(-(inverse * offset), 1.0));
}

void ShearWarp::takePixel(const glm::ivec2& pixel, ShearWarp& part) const
{
  part = *this;
  part.RayCount = glm::ivec2(1);
  part.ImageSize = { this->Perspective ? RowUnit : 1, 1 };
  if (!this->Perspective)
  {
    part.Margin -= pixel;
    part.setParallelRays();
    return;
  }
  for (int a = 0; a < 2; ++a)
  {
    AxisRays& rays = a == 0 ? part.Columns : part.Rows;
    const double steepest = rays.steepest;
    part.First[a] += pixel[a];
    part.setPerspectiveRays(a, rays);
    rays.steepest = steepest;
  }
}

RayPath ShearWarp::rayPath(int k) const
{
  return pathBetween(-this->position(k - 0.5), -this->position(k + 0.5), -this->Shear);
}

RayPath ShearWarp::voxelsOnRay(int u, int v, int k) const
{
  const glm::dvec2 slope(this->Columns.slope[u], this->Rows.slope[v]);
  const glm::dvec2 depths = this->faces(k);
  return pathBetween(this->onRay(u, v, depths.x), this->onRay(u, v, depths.y), slope);
}

Span ShearWarp::coverage(const RayPath& path, int v) const
{
  // The voxels of a path are neighbours, so their ranges of pixels are adjacent.
  Span all{ this->width(), 0 };
  for (int t = 0; t < path.count; ++t)
  {
    const int j = v + path.dj[t];
    if (j >= 0 && j < this->Size.y)
    {
      all.begin = std::min(all.begin, -path.di[t]);
      all.end = std::max(all.end, this->Size.x - path.di[t]);
    }
  }
  return all;
}

glm::dvec4 ShearWarp::inPixels(const glm::dvec4& halfSpace) const
{
  const double a = halfSpace[this->Axes[0]], b = halfSpace[this->Axes[1]];
  const double c = halfSpace[this->Axes[2]];
  const glm::dvec2 origin = this->position(0.0), shear = this->Shear;
  return { a, b, c - a * shear.x - b * shear.y, halfSpace.w - a * origin.x - b * origin.y };
}

bool ShearWarp::sameShear(const ShearWarp& other) const
{
  // Columns and Rows include the shears.
  return this->Valid == other.Valid && this->Axes == other.Axes && this->Size == other.Size &&
    this->Pitch == other.Pitch && this->Reference == other.Reference &&
    this->DepthRange == other.DepthRange && this->Columns == other.Columns &&
    this->Rows == other.Rows;
}
}
