// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Traversal.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace reference
{

namespace
{

__extension__ typedef __int128 Wide;

/**
 * The time num / den, or never for den = 0.
 */
struct Time
{
  std::int64_t num;
  std::int64_t den;
};

bool isBefore(const Time& a, const Time& b)
{
  if (a.den == 0 || b.den == 0)
  {
    return a.den != 0;
  }
  return static_cast<Wide>(a.num) * b.den < static_cast<Wide>(b.num) * a.den;
}

std::int64_t floorDivide(std::int64_t a, std::int64_t b)
{
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

/**
 * A motion and the voxel that it is in at present.
 */
struct Walker
{
  AxisMotion motion;
  std::int64_t cell;

  explicit Walker(const AxisMotion& newMotion)
    : motion(newMotion),
      cell(floorDivide(newMotion.start + HalfVoxel, WholeVoxel))
  {
    // A ray that starts on a face and moves down leaves the upper cell at once.
    if (this->motion.velocity < 0 && (this->motion.start + HalfVoxel) % WholeVoxel == 0)
    {
      --this->cell;
    }
  }

  Time nextCrossing() const
  {
    const std::int64_t face =
      this->cell * WholeVoxel + (this->motion.velocity > 0 ? HalfVoxel : -HalfVoxel);
    return { std::llabs(face - this->motion.start), std::llabs(this->motion.velocity) };
  }

  void step() { this->cell += this->motion.velocity > 0 ? 1 : -1; }
};

} // namespace

//------------------------------------------------------------------------------
std::int64_t inUnits(double position)
{
  const double scaled = std::ldexp(position, 34);
  if (scaled != std::floor(scaled) || !(std::abs(scaled) < 0x1p62))
  {
    throw std::invalid_argument("Positions along rays must be multiples of 2^-34.");
  }
  return static_cast<std::int64_t>(scaled);
}

//------------------------------------------------------------------------------
std::vector<std::array<int, 3>> traverse(
  const std::array<AxisMotion, 3>& ray, std::int64_t end, const std::array<int, 3>& size)
{
  std::array<Walker, 3> walkers = { Walker(ray[0]), Walker(ray[1]), Walker(ray[2]) };
  std::vector<std::array<int, 3>> crossed;
  Time now = { 0, 1 };
  while (isBefore(now, { end, 1 }))
  {
    std::array<int, 3> position;
    bool isWithin = true;
    Time next = { end, 1 };
    for (int a = 0; a < 3; ++a)
    {
      const Walker& walker = walkers[a];
      position[a] = static_cast<int>(walker.cell);
      isWithin = isWithin && walker.cell >= 0 && walker.cell < size[a];
      next = isBefore(walker.nextCrossing(), next) ? walker.nextCrossing() : next;
    }
    if (isWithin)
    {
      crossed.push_back(position);
    }
    for (Walker& walker : walkers)
    {
      if (!isBefore(next, walker.nextCrossing()))
      {
        walker.step();
      }
    }
    now = next;
  }
  return crossed;
}

} // namespace reference
