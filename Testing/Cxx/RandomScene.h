// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    RandomScene.h
 * @brief   draws what random tests project: volumes, views, cuts and settings
 *
 * All of it can be made simpler, see Scenes.h: the simplest volume is one voxel, the simplest view
 * looks along the first axis at cubes, and cuts nothing. Functions describe what they draw.
 */
#ifndef RandomScene_h
#define RandomScene_h

#include "Geometry/ShearWarp.h"
#include "Random.h"
#include "Splat/Projection/Project.h"
#include "Volume.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace coretesting
{
/// All of them; those that the processor lacks are the best that it has.
inline constexpr splatting::InstructionSet instructionSets[] = {
  splatting::InstructionSet::Baseline, splatting::InstructionSet::AVX2,
  splatting::InstructionSet::AVX512, splatting::InstructionSet::AVX512VBMI
};

inline splatting::InstructionSet anyInstructionSet(reference::Random& random)
{
  return instructionSets[random.uniform(0, 3)];
}

inline splatting::Acceleration anyAcceleration(reference::Random& random)
{
  return static_cast<splatting::Acceleration>(random.uniform(0, 5));
}

inline glm::ivec3 toGlm(const std::array<int, 3>& size)
{
  return { size[0], size[1], size[2] };
}

inline std::array<int, 3> toArray(const glm::ivec3& size)
{
  return { size.x, size.y, size.z };
}

/// Any in a box.
inline glm::dvec3 anyVector(reference::Random& random, double low, double high)
{
  glm::dvec3 v;
  for (int a = 0; a < 3; ++a)
  {
    v[a] = random.uniform(low, high);
  }
  return v;
}

/// Of length 1.
inline glm::dvec3 anyDirection(reference::Random& random)
{
  glm::dvec3 v(0.0);
  while (glm::length(v) < 0.2 || glm::length(v) > 1.0)
  {
    v.x = random.uniform(-1.0, 1.0);
    v.y = random.uniform(-1.0, 1.0);
    v.z = random.uniform(1.0, -1.0); // simplest at 1
  }
  return glm::normalize(v);
}

/// Where voxels are.
inline glm::dvec3 anyPoint(const std::array<int, 3>& size, reference::Random& random)
{
  glm::dvec3 p;
  for (int a = 0; a < 3; ++a)
  {
    p[a] = random.uniform(-0.5, size[a] - 0.5);
  }
  return p;
}

inline std::array<int, 3> anySize(reference::Random& random, int least, int largest)
{
  std::array<int, 3> size;
  for (int& n : size)
  {
    n = random.uniform(least, largest);
  }
  random.note(size[0], " x ", size[1], " x ", size[2], " voxels");
  return size;
}

inline std::array<int, 3> randomSize(reference::Random& random, int largest)
{
  return anySize(random, 1, largest);
}

inline glm::dvec4 halfSpaceThrough(const glm::dvec3& point, const glm::dvec3& normal)
{
  return { normal, -glm::dot(normal, point) };
}

/// One in three is across an axis, through voxel centres or between them.
inline glm::dvec4 anyHalfSpace(const std::array<int, 3>& size, reference::Random& random)
{
  const glm::dvec3 point = anyPoint(size, random);
  glm::dvec3 normal(0.0);
  if (random.oneIn(3))
  {
    normal[random.uniform(0, 2)] = random.sign();
    return halfSpaceThrough(glm::round(2.0 * point) / 2.0, normal);
  }
  normal = anyDirection(random);
  return halfSpaceThrough(point, normal * random.uniform(0.3, 3.0));
}

/// Anywhere; half of them keep the middle of the volume in any case. Sometimes a slab that may be
/// thinner than a slice.
inline std::vector<glm::dvec4> anyHalfSpaces(
  const std::array<int, 3>& size, reference::Random& random)
{
  const glm::dvec4 middle(0.5 * (size[0] - 1), 0.5 * (size[1] - 1), 0.5 * (size[2] - 1), 1.0);
  std::vector<glm::dvec4> result;
  const bool keepsMiddle = random.oneIn(2);
  for (int n = random.uniform(1, 3); n > 0; --n)
  {
    const glm::dvec4 h = anyHalfSpace(size, random);
    result.push_back(keepsMiddle && glm::dot(h, middle) < 0.0 ? -h : h);
  }
  if (random.oneIn(4))
  {
    glm::dvec4 other = -result.back();
    other.w += glm::length(glm::dvec3(other)) * random.uniform(0.05, 2.5);
    result.push_back(other);
  }
  for (const glm::dvec4& h : result)
  {
    random.note("half-space ", h.x, " ", h.y, " ", h.z, " ", h.w);
  }
  return result;
}

/// VTK's: subvolume, fence, inverted fence, cross, inverted cross.
inline constexpr std::uint32_t namedRegions[] = { 0x0002000, 0x2ebfeba, 0x5140145, 0x0417410,
  0x7be8bef };

/// A named set of regions, all of them, or any.
inline std::uint32_t anyRegions(reference::Random& random)
{
  const int kind = random.uniform(0, 3);
  return kind == 0 ? splatting::Cropping::All
    : kind == 1    ? random.among(namedRegions)
                   : static_cast<std::uint32_t>(random.bits()) & splatting::Cropping::All;
}

/// Planes in the volume most of the time, on voxel centres and between them, and beyond it.
inline splatting::Cropping anyCropping(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::Cropping cropping;
  for (int a = 0; a < 3; ++a)
  {
    double p = random.uniform(-1.0, 0.5 * size[a]),
           q = random.uniform(0.5 * size[a], size[a] + 0.0);
    switch (random.uniform(0, 5))
    {
      case 0: // all in the middle
        p = -3.0;
        q = size[a] + 2.5;
        break;
      case 1: // on voxel centres
        p = std::round(p);
        q = std::round(q);
        break;
      case 2: // within a voxel, perhaps
        q = p + random.uniform(0.0, 0.9);
        break;
      case 3: // one voxel
        q = p = std::round(p);
        break;
      default:
        break;
    }
    cropping.planes[a] = { p, q };
    random.note("cropping along axis ", a, ": ", p, " to ", q);
  }
  cropping.flags = anyRegions(random);
  random.note("regions 0x", std::hex, cropping.flags);
  return cropping;
}

/// A parallel view with a given principal axis and shears, one screen pixel per shear pixel.
inline splatting::View viewWithShear(
  const std::array<int, 3>& size, int axis, double shearX, double shearY)
{
  const int i = axis == 0 ? 1 : 0, j = axis == 2 ? 1 : 2;
  splatting::View view;
  view.dimensions = toGlm(size);
  view.viewport = { 400, 400 };
  glm::dmat4& m = view.indexToClip;
  m = glm::dmat4(0.0);
  m[i][0] = m[j][1] = 2.0 / 400;
  m[axis][0] = shearX * 2.0 / 400;
  m[axis][1] = shearY * 2.0 / 400;
  m[axis][2] = 1e-3;
  m[3][3] = 1.0;
  return view;
}

/// A view from anywhere, with any spacing.
inline splatting::View randomView(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::View view;
  view.dimensions = toGlm(size);
  view.viewport = { random.uniform(50, 400), random.uniform(50, 400) };
  glm::dmat4 m(1.0);
  m = glm::scale(m, glm::dvec3(0.02, 0.02, 0.001));
  for (int turn = 0; turn < 3; ++turn)
  {
    const glm::dvec3 axis{ random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
      random.uniform(0.1, 1.0) };
    m = glm::rotate(m, random.uniform(0.0, 6.3), glm::normalize(axis));
  }
  m = glm::scale(m, anyVector(random, 0.3, 3.0));
  view.indexToClip = glm::translate(m, -0.5 * glm::dvec3(view.dimensions - 1));
  random.note("parallel view of ", view.viewport.x, " x ", view.viewport.y, " pixels");
  return view;
}

/// A perspective view: from inside the volume, from nearby or from afar, some from half-way between
/// voxels or along an axis, with any spacing, view angles from 5 to 120 degrees, some off-axis.
inline splatting::View randomPerspective(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::View view;
  view.dimensions = toGlm(size);
  view.viewport = { random.uniform(20, 200), random.uniform(20, 200) };
  const glm::dvec3 spacing = anyVector(random, 0.5, 2.0);
  const double reach = std::pow(10.0, random.uniform(-1.0, 2.5));
  glm::dvec3 eye(0.0), focus(0.0);
  for (int a = 0; a < 3; ++a)
  {
    focus[a] = random.uniform(0.0, size[a] - 1.0);
    // Simplest beyond the end of the first axis.
    const double share = random.uniform(a > 0 ? -1.0 : 1.0, a > 0 ? 1.0 : -1.0);
    eye[a] = 0.5 * (size[a] - 1) + reach * size[a] * share;
  }
  if (random.oneIn(4))
  {
    // Where rays meet edges, and look along an axis or a diagonal.
    eye = glm::round(2.0 * eye) / 2.0;
    for (int a = 0; a < 3; ++a)
    {
      focus[a] = eye[a] + random.uniform(-1, 1);
    }
  }
  const glm::dvec3 up{ random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.9 };
  const double angle = glm::radians(random.uniform(5.0, 120.0));
  const double top = 0.1 * std::tan(0.5 * angle), right = top * view.viewport.x / view.viewport.y;
  const double shift = random.oneIn(2) ? random.uniform(-0.5, 0.5) : 0.0;
  const glm::dmat4 projection =
    glm::frustum((shift - 1.0) * right, (shift + 1.0) * right, -top, top, 0.1, 10000.0);
  view.indexToClip = projection *
    glm::lookAt(eye * spacing, focus * spacing + glm::dvec3(1e-9), up) *
    glm::scale(glm::dmat4(1.0), spacing);
  random.note("view from ", eye.x, " ", eye.y, " ", eye.z, " to ", focus.x, " ", focus.y, " ",
    focus.z, ", spacing ", spacing.x, " ", spacing.y, " ", spacing.z, ", ", view.viewport.x, " x ",
    view.viewport.y, " pixels");
  return view;
}

/// One of the images of a perspective view.
inline splatting::ShearWarp randomPerspectiveImage(
  const std::array<int, 3>& size, reference::Random& random)
{
  std::vector<splatting::ShearWarp> images;
  while (images.empty())
  {
    const splatting::View view = randomPerspective(size, random);
    splatting::ShearWarp::factorise(view, images);
  }
  return images[random.uniform(0, static_cast<int>(images.size()) - 1)];
}

/// Shears at which rays meet edges and corners: no shear, diagonals, simple fractions.
inline double specialShear(reference::Random& random)
{
  static const double shears[] = { 0.0, 1.0, 0.5, 0.25, 0.75, 1.0 / 3.0, 0x1p-24, 1.0 - 0x1p-24 };
  const double shear = shears[random.uniform(0, 7)];
  return random.oneIn(2) ? shear : -shear;
}

/// Half of the views are random, half have special shears.
inline splatting::View anyView(const std::array<int, 3>& size, reference::Random& random)
{
  if (random.oneIn(2))
  {
    return randomView(size, random);
  }
  const int axis = random.uniform(0, 2);
  const double shearX = specialShear(random), shearY = specialShear(random);
  random.note("view along axis ", axis, ", shear ", shearX, " ", shearY);
  return viewWithShear(size, axis, shearX, shearY);
}

/// Noise; of floating point one volume in three has NaN and infinities, some of them mostly NaN.
template <class T>
reference::Volume<T> volumeWithOddValues(const std::array<int, 3>& size, reference::Random& random)
{
  reference::Volume<T> volume = reference::uniformNoise<T>(size, random);
  if constexpr (std::numeric_limits<T>::has_infinity)
  {
    const int share = random.oneIn(3) ? random.uniform(1, 9) : 0;
    reference::Random many = random.fork();
    for (T& voxel : volume.voxels)
    {
      if (many.chance(share / 10.0))
      {
        const T odd[] = { std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::quiet_NaN(),
          std::numeric_limits<T>::infinity(), -std::numeric_limits<T>::infinity() };
        voxel = odd[many.uniform(0, 3)];
      }
    }
  }
  return volume;
}

}

#endif
