// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingLoadedVoxels_h
#define splattingLoadedVoxels_h

#include "Volume/VolumeIndex.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace splatting
{
/// Voxels converted to the accumulator's type: a rectangle from each of up to three slices that a
/// worksheet reads. Beyond the volume its outermost voxels are repeated.
struct LoadedVoxels
{
  /// Bytes after the last voxel, for loops that read whole registers.
  static constexpr std::size_t Padding = 128;

  struct Sheet
  {
    int slice = -1;
    int i = 0, j = 0; // the first voxel
    int columns = 0, rows = 0;
    bool finite = true;     ///< whether there are neither NaN nor infinities
    bool separated = false; ///< whether the other parts are set, see WorksheetSampler
  };
  /// Part 0: the voxels. If some are not finite, part 1 flags the finite ones and, with infinities,
  /// parts 2 and 3 the positive and the negative ones.
  static constexpr int MostParts = 4;
  std::array<std::vector<unsigned char>, MostParts> bytes;
  int part = 0;                         ///< the part of voxel()
  std::vector<std::uint16_t> runEnds;   ///< of walks along chains only
  std::vector<unsigned char> worksheet; ///< of walks by rays only
  std::vector<unsigned char> averages;  ///< worksheets of parts
  std::vector<unsigned char>
    present;                ///< which pixels of `worksheet` have a sample, in perspective previews
  std::vector<Span> runs;   ///< of perspective previews: the requested runs within a slice
  Span rows, pixels;        ///< of the image, whose voxels are loaded
  std::ptrdiff_t ahead = 0; ///< to voxels that are needed next
  std::ptrdiff_t rowLength = 0;
  std::ptrdiff_t sheetLength = 0;
  std::array<Sheet, 3> sheets;
  std::vector<unsigned char> resampledBytes, blendedBytes;
  std::ptrdiff_t resampledLength = 0;
  int resampledRows = 0;

  /// Removes all sheets.
  template <class A>
  void resize(int columns, int rows, int parts)
  {
    this->rowLength = columns;
    this->sheetLength = this->rowLength * rows;
    const std::size_t size = this->sheets.size() * this->sheetLength * sizeof(A) + Padding;
    for (int p = 0; p < parts; ++p)
    {
      if (this->bytes[p].size() < size)
      {
        this->bytes[p].resize(size);
      }
    }
    this->sheets.fill(Sheet{});
  }
  /// Allocates buffers for perspective views: `rows` rows of `length` pixels for each part, which
  /// are computed from weighted rows of voxels.
  template <class A>
  void resizeResampled(int parts, int rows, int length)
  {
    this->resampledRows = rows;
    this->resampledLength = length;
    const std::size_t size = std::size_t(parts) * rows * length * sizeof(A);
    if (this->resampledBytes.size() < size)
    {
      this->resampledBytes.resize(size);
    }
  }
  template <class A>
  A* resampled(int part, int row)
  {
    return reinterpret_cast<A*>(this->resampledBytes.data()) +
      (std::ptrdiff_t(part) * this->resampledRows + row) * this->resampledLength;
  }
  /// Buffer for rows of voxels between slices.
  template <class A>
  A* blended(int rows, int columns)
  {
    const std::size_t size = std::size_t(rows) * columns * sizeof(A) + Padding;
    if (this->blendedBytes.size() < size)
    {
      this->blendedBytes.resize(size);
    }
    return reinterpret_cast<A*>(this->blendedBytes.data());
  }

  Sheet& sheet(int slice) { return this->sheets[slice % this->sheets.size()]; }
  template <class A>
  A* voxel(int i, int j, int slice)
  {
    return reinterpret_cast<A*>(this->bytes[this->part].data()) + this->place(i, j, slice);
  }

  /// For each voxel the next column of its sheet with another value.
  std::uint16_t* runEnd(int i, int j, int slice)
  {
    return this->runEnds.data() + this->place(i, j, slice);
  }
  void resizeRunEnds()
  {
    const std::size_t size = this->sheets.size() * this->sheetLength;
    if (this->runEnds.size() < size)
    {
      this->runEnds.resize(size);
    }
  }

private:
  std::ptrdiff_t place(int i, int j, int slice)
  {
    const Sheet& sheet = this->sheet(slice);
    return slice % this->sheets.size() * this->sheetLength + (j - sheet.j) * this->rowLength +
      (i - sheet.i);
  }
};
}

#endif
