// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The innermost loops: one row segment in, one row segment out. Kernels.cxx is compiled once per
 * instruction set and chosen from at run time. Each loop does the same IEEE operations in the same
 * order whatever the vector width (no fused multiply-add, no reassociation), so every instruction
 * set gives the same bits.
 */
#ifndef splattingKernels_h
#define splattingKernels_h

#include "ScalarType.h"

namespace splatting
{
enum class InstructionSet
{
  Baseline,
  AVX2,
  AVX512
};

/// Loops over voxels of type T.
template <class T>
struct VoxelLoops
{
  /// image[x] = max(image[x], rows[0..count)[x]); NaN never wins.
  void (*maximum)(T* image, const T* const* rows, int count, std::ptrdiff_t n);
  /// The same where image[x] = NaN is "no sample yet".
  void (*maximumValid)(T* image, const T* const* rows, int count, std::ptrdiff_t n);
  /// out[x] = row[x].
  void (*widen)(const T* row, Accumulator<T>* out, std::ptrdiff_t n);
  /// Widens [low, high] by the row's values (NaN aside); sets special if there are NaN or infinity.
  void (*range)(const T* row, std::ptrdiff_t n, T& low, T& high, bool& special);
};

/// A rectangle of footprint weights and the voxels that it meets first.
template <class A>
struct SplatPart
{
  const A* source;  ///< the voxel under the first weight of the first pixel
  const A* weights; ///< rows x columns of them
  int rows;         ///< 1 to 5
  int columns;
};

/// A rectangle of the image, and the parts of the footprint: one per slice that adds to it.
template <class A>
struct Splat
{
  A* image;
  std::ptrdiff_t imageStride;
  std::ptrdiff_t width;
  int height;
  std::ptrdiff_t sourceStride; ///< from one row of voxels to the next
  SplatPart<A> parts[3];
  int partCount;
};

/// Loops over worksheets and images of type A (float or double).
template <class A>
struct WorksheetLoops
{
  /// Every pixel of the rectangle: the maximum of it and the weighted sum of its voxels, which must
  /// be finite.
  void (*splat)(const Splat<A>& splat);
  /// image[x] = max(image[x], average of rows[0..count)[x], NaN left out, weighted and divided by
  /// the weights that remain). image[x] = NaN is "no sample yet". Rows may hold infinities.
  void (*splatValid)(A* image, const A* const* rows, const A* weights, int count, std::ptrdiff_t n);
  /// image[x] = clamp(image[x], low, high); NaN stays.
  void (*clamp)(A* image, A low, A high, std::ptrdiff_t n);
  /// out[x] = image interpolated bilinearly at start + x step, which must lie between pixels that
  /// exist.
  void (*interpolate)(const A* image, std::ptrdiff_t stride, const double start[2],
    const double step[2], A* out, std::ptrdiff_t n);
  /// out[x] = colors[nearest entry to scale (values[x] - low)], clamped to [0, last].
  void (*lookUp)(const A* values, A low, A scale, std::int32_t last, const std::uint32_t* colors,
    std::uint32_t* out, std::ptrdiff_t n);
};

struct Kernels
  : VoxelLoops<std::int8_t>
  , VoxelLoops<std::uint8_t>
  , VoxelLoops<std::int16_t>
  , VoxelLoops<std::uint16_t>
  , VoxelLoops<std::int32_t>
  , VoxelLoops<std::uint32_t>
  , VoxelLoops<std::int64_t>
  , VoxelLoops<std::uint64_t>
  , VoxelLoops<float>
  , VoxelLoops<double>
  , WorksheetLoops<float>
  , WorksheetLoops<double>
{
};

/// The best instruction set that processor and build have.
InstructionSet bestInstructionSet();

/// The loops for a set; a set that processor or build lack gives the best one below it.
const Kernels& kernelsFor(InstructionSet set);

/// "baseline", "AVX2" or "AVX-512".
const char* nameOf(InstructionSet set);
}

#endif
