// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The voxels that no ray of a preview along one axis can show; see LineEncoding.
 */
#ifndef splattingInvisibleVoxels_h
#define splattingInvisibleVoxels_h

#include "Common/Parallel.h"
#include "Projection/ProjectionContext.h"


namespace splatting
{
template <class T>
class InvisibleVoxels
{
public:
  InvisibleVoxels(const Slices& slices, const glm::ivec3& size)
    : Source(slices),
      Size(size),
      Flags(std::size_t(size.x) * size.y * size.z, 0)
  {
    this->sweep(size.z - 1, -1, -1, [](T guard, T value) { return guard >= value; });
    this->sweep(0, size.z, 1, [](T guard, T value) { return guard > value; });
  }

  /// One flag per voxel of a row.
  const unsigned char* row(int j, int k) const { return this->Flags.data() + this->place(j, k); }

  std::size_t count() const
  {
    return std::count(this->Flags.begin(), this->Flags.end(), static_cast<unsigned char>(1));
  }

private:
  std::size_t place(int j, int k) const
  {
    return (std::size_t(k) * this->Size.y + j) * this->Size.x;
  }

  /// Calls body(j) for all rows of a slice.
  template <class Body>
  void forRows(Body&& body) const
  {
    parallelFor(0, this->Size.y, 16,
      [&](std::ptrdiff_t first, std::ptrdiff_t last)
      {
        for (std::ptrdiff_t j = first; j < last; ++j)
        {
          body(static_cast<int>(j));
        }
      });
  }

  /// From slice to slice. The guard of a voxel is the least value that every ray through it crosses
  /// in the previous slices.
  template <class Hides>
  void sweep(int first, int end, int step, Hides&& hides)
  {
    const int width = this->Size.x, height = this->Size.y;
    std::vector<T> guard(std::size_t(width) * height, leastValue<T>());
    std::vector<T> cover(guard.size());
    for (int k = first; k != end; k += step)
    {
      this->forRows(
        [&](int j)
        {
          const T* const values = static_cast<const T*>(this->Source.voxels) +
            j * this->Source.rowStride + k * this->Source.sliceStride;
          const T* const guards = guard.data() + std::ptrdiff_t(j) * width;
          T* const covers = cover.data() + std::ptrdiff_t(j) * width;
          unsigned char* const flags = this->Flags.data() + this->place(j, k);
          for (int i = 0; i < width; ++i)
          {
            flags[i] |= static_cast<unsigned char>(hides(guards[i], values[i]));
            covers[i] = std::max(values[i], guards[i]);
          }
        });
      // Rays leave the volume beside the outermost voxels, which therefore have no guard.
      this->forRows(
        [&](int j)
        {
          if (j > 0 && j < height - 1)
          {
            guardRow(cover.data() + std::ptrdiff_t(j) * width, width,
              guard.data() + std::ptrdiff_t(j) * width);
          }
        });
    }
  }

  /// The least of 3 x 3 covers.
  static void guardRow(const T* cover, int width, T* guard)
  {
    const T* const before = cover - width;
    const T* const after = cover + width;
    const auto column = [=](int i) { return std::min(std::min(before[i], cover[i]), after[i]); };
    for (int i = 1; i < width - 1; ++i)
    {
      guard[i] = std::min(std::min(column(i - 1), column(i)), column(i + 1));
    }
  }

  const Slices& Source;
  glm::ivec3 Size;
  std::vector<unsigned char> Flags;
};
}

#endif
