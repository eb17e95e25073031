// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The innermost loops of exact projections: a block of 4^3 cells in, the pixels of a tile out.
 * CellKernels.cxx is compiled once per instruction set; all give the same bits.
 *
 * Values are numbers not less than 0; see CellScale. The volume's lowest voxel (for minima its
 * highest) has the value 0.
 */
#ifndef splattingCellLoops_h
#define splattingCellLoops_h

#include "Kernels/Kernels.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace splatting
{
/// Cells along a block's side.
constexpr int BlockCells = 4;

/// Numbers that no finite voxel has.
template <class A>
struct CellValue
{
  static constexpr A None = -std::numeric_limits<A>::infinity();   ///< a hidden voxel, or no sample
  static constexpr A Lowest = -std::numeric_limits<A>::max();      ///< a voxel of minus infinity
  static constexpr A Highest = std::numeric_limits<A>::max();      ///< a voxel of infinity
  static constexpr A Outside = std::numeric_limits<A>::infinity(); ///< a pixel beside the volume
};

/// From voxels to values: factor * voxel + offset. The factor is a power of two, or minus that.
template <class A>
struct CellScale
{
  A factor = 1, offset = 0;
  bool holes = false; ///< whether there may be NaN or infinities
};

/**
 * A number as a sum, because rays need more digits than float has. The first term is a multiple of
 * `unit`. Sums of such terms, and of their products with pixel numbers, are exact within a block.
 * The rest is 0 for double.
 */
template <class A>
struct CellSum
{
  static constexpr double unit = 0x1p-20;

  A most = 0, rest = 0;

  CellSum() = default;
  explicit CellSum(double value)
  {
    const bool isSplit = sizeof(A) < sizeof(double);
    this->most = static_cast<A>(isSplit ? std::nearbyint(value / unit) * unit : value);
    this->rest = static_cast<A>(value - static_cast<double>(this->most));
  }
};

/**
 * The pixels of a part of the screen that one thread works on.
 */
template <class A>
struct ScreenTile
{
  static constexpr int Side = 128;
  static constexpr int Stride = Side + 16; // so that rows do not compete for the same cache lines
  static constexpr int Size = Side * Stride + 16;
  static constexpr int Patches = Side / 4; // of 4 x 4 pixels, along a side
  static constexpr int PatchStride = Patches + 16;

  alignas(64) A values[Size];
  A depths[Size];
  /// Where rays begin and end: the parameter t is the sum of the two.
  A nears[Size], nearRests[Size], fars[Size], farRests[Size];
  A least[Patches * PatchStride + 16]; ///< the smallest value of each patch
  std::uint32_t changed[Patches];      ///< whether that has to be found again
  int firstChanged = Patches, lastChanged = -1;
};

/**
 * The voxels of a block, and how the rays of a tile meet it. Lengths are in voxels, from the
 * block's middle; pixels are counted from the tile's first one.
 */
template <class A>
struct CellBlock
{
  /// Of slice z and row y: voxels x = 0 to 3, and 1 to 4.
  alignas(64) A left[5][20], right[5][20];
  int begin[3], end[3]; ///< the block's cells that the volume has
  bool holes;

  bool perspective;
  int x, y;                        ///< a pixel, whose ray is
  CellSum<A> start[3], forward[3]; ///< start + (t - reference) forward
  A reference;
  A alongT[3], middleT; ///< t - reference of a point p, about: alongT . p + middleT
  CellSum<A> startAcross[3], startUp[3];     ///< from pixel to pixel
  CellSum<A> forwardAcross[3], forwardUp[3]; ///< of perspective views
  A inverse[3];                              ///< 1 / forward of parallel views
  bool flat[3]; ///< whether parallel rays run within planes of constant x, y, z

  /// The pixels whose rays may cross the block, inclusive, and the smallest value there.
  int columns[2], rows[2];
  A least;
  /// A point p is seen at pixel (x, y) + (across . p + acrossStart, up . p + upStart) / w.
  A across[3], acrossStart, up[3], upStart;
  A inverses[2]; ///< the largest and the smallest 1 / w in the block
  A margin;      ///< pixels by which these may be wrong
  /// Near the eye, where this formula is invalid: the first and last column, then row, of the
  /// pixels that see each cell. Else nullptr.
  const std::int32_t (*seen)[4];

  bool cut;                    ///< whether rays may begin or end within the block
  bool crops;                  ///< whether they do so at the planes of cropping
  A low[3], high[3];           ///< these
  A fieldLow[3], fieldHigh[3]; ///< where the field ends

  bool located;
  A tiesFrom; ///< from which value on the nearest of equal samples is sought
  bool shaded;
  A ambient, rate, mostFactor;
  bool bounded; ///< whether shaded samples are at most mostFactor times the largest voxel
};

template <class A>
struct CellLoops
{
  /// The smallest value of the patches that some pixels (inclusive) lie in.
  A (*least)(const ScreenTile<A>& tile, int x0, int x1, int y0, int y1);
  /// Finds the smallest values of changed patches.
  void (*refresh)(ScreenTile<A>& tile);
  void (*splat)(ScreenTile<A>& tile, const CellBlock<A>& block);
};

template <class T>
struct BlockLoops
{
  /// Fills in a block's voxels. Those of row y and slice z begin at rows[z][y]; x are offsets.
  void (*load)(const T* const (*rows)[5], const std::ptrdiff_t x[5],
    const CellScale<Accumulator<T>>& scale, CellBlock<Accumulator<T>>& block);
};

struct RayEndLoops
{
  /// Limits the rays of pixels x = first to first + n - 1, which are at
  /// start + x step + t (forward + x turn), to the part in [low, high].
  void (*within)(double* near, double* far, int first, int n, double start, double step,
    double forward, double turn, double low, double high);
  /// The same, but to the part where start + x step + t (forward + x turn) is at least 0.
  void (*before)(double* near, double* far, int first, int n, double start, double step,
    double forward, double turn);
};

struct CellKernels
  : RayEndLoops
  , CellLoops<float>
  , CellLoops<double>
  , BlockLoops<std::int8_t>
  , BlockLoops<std::uint8_t>
  , BlockLoops<std::int16_t>
  , BlockLoops<std::uint16_t>
  , BlockLoops<std::int32_t>
  , BlockLoops<std::uint32_t>
  , BlockLoops<std::int64_t>
  , BlockLoops<std::uint64_t>
  , BlockLoops<float>
  , BlockLoops<double>
{
};

/// The loops for a set; a set that processor or build lack gives the best one below it.
const CellKernels& cellKernelsFor(InstructionSet set);
}

#endif
