// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The innermost loops: one run of voxels in, one run of pixels out. Kernels.cxx is compiled once
 * per instruction set, which is selected at run time. Each loop does the same IEEE operations in
 * the same order for any vector width (no fused multiply-add, no reassociation), so every
 * instruction set gives the same bits.
 */
#ifndef splattingKernels_h
#define splattingKernels_h

#include "Common/ScalarType.h"

#include <type_traits>

namespace splatting
{
/// Pixels and rows of a tile of the image, the unit in which parts of slices are skipped.
constexpr int TileWidth = 8;
constexpr int TileHeight = 4;

enum class InstructionSet
{
  Baseline,
  AVX2,
  AVX512,
  AVX512VBMI ///< and instructions that select bytes
};

/// The largest number of rows of voxels that a row of pixels reads at a time: three in each of four
/// slices.
constexpr int MostRows = 12;

/// Half-open range of integers: pixels, voxels, slices, ...
struct Span
{
  int begin = 0;
  int end = 0;
  bool empty() const { return this->end <= this->begin; }
};

/// A register of pixels at an end of a row. It begins at pixel `first`. Its pixels [begin[r],
/// end[r]), relative to `first`, read row r of voxels. The memory of all rows may be read for all
/// of its pixels.
struct Rim
{
  int first;
  const int* begin;
  const int* end;
};

/// Rows of pixels, and the rows of voxels of the first one, shifted so that pixel x reads
/// rows[r][x].
template <class T>
struct Sweep
{
  T* image;
  std::ptrdiff_t imageStride;
  int height;
  const T* rows[MostRows];
  int count;
  std::ptrdiff_t rowStride;
  std::ptrdiff_t ahead; ///< to voxels that are needed next, if memory does not prefetch them
  const Span* runs;     ///< the pixels to raise
  int runCount;
  Span valid; ///< the pixels that all rows have voxels for
  Rim rims[2];
  int rimCount;
};

/// The rays of a perspective image in one slice. See AxisSteps and AxisPicks for the arrays, which
/// begin with the first column and the first row.
template <class T>
struct CrossedSlice
{
  const T* voxels; ///< the slice's first
  const std::int32_t *firstRow, *lastRow;
  const double *rowTime, *columnTime;
  const std::int16_t *rowTick, *columnTick;
  const std::int32_t *entryBase, *exitBase;
  const void *entryLanes, *exitLanes;
};

/// Rows of pixels of a perspective image, and the voxels that their rays cross in one or two
/// slices.
template <class T>
struct Crossing
{
  T* image; ///< the row's first pixel
  std::ptrdiff_t imageStride;
  int height;
  CrossedSlice<T> slices[2];
  int count; ///< of slices
  std::ptrdiff_t rowStride;
  std::ptrdiff_t ahead;       ///< to voxels that are needed next
  std::int32_t columns, rows; ///< of voxels
  const T* none;              ///< a row of the least value
  const Span* runs; ///< the pixels to raise: multiples of 64 bytes, except at the row's end
  int runCount;
};

/// A rectangle of footprint weights, and the first voxels that it weighs, of type A or, without
/// copies, of the volume's type.
template <class A, class S = A>
struct SplatPart
{
  const S* source;  ///< the voxel under the first weight of the first pixel
  const A* weights; ///< rows x columns of them
  int rows;         ///< 1 to 5
  int columns;
};

/// A rectangle of the image, and the parts of the footprint: one per contributing slice.
template <class A, class S = A>
struct Splat
{
  A* image;
  std::ptrdiff_t imageStride;
  std::ptrdiff_t width;
  int height;
  std::ptrdiff_t sourceStride; ///< from one row of voxels to the next
  SplatPart<A, S> parts[3];
  int partCount;
  A base = 0;               ///< subtracted from the volume's voxels
  std::ptrdiff_t ahead = 0; ///< from these to voxels that are needed next, or 0
};

/// Loops over voxels of type T.
template <class T>
struct VoxelLoops
{
  /// Elements of a register.
  std::ptrdiff_t lanes;
  /// The number of neighbouring pixels of a perspective image that select from one group of voxels.
  /// The group has as many voxels.
  int group;
  /// image[x] = max(image[x], rows[0..count)[x]), without NaN.
  void (*maximum)(T* image, const T* const* rows, int count, std::ptrdiff_t n);
  /// out[x] = the largest of rows[0..count)[x], in whole registers: up to lanes - 1 elements beyond
  /// n are read and written as well.
  void (*largest)(const T* const* rows, int count, T* out, std::ptrdiff_t n);
  /// `maximum` for all rows of pixels: for the valid pixels of the runs, possibly some valid pixels
  /// beside them, and for the rims.
  void (*sweep)(const Sweep<T>& sweep);
  /// `maximum` of the voxels that rays cross, individually for each pixel.
  void (*cross)(const Crossing<T>& crossing);
  /// out[x] = row[x] - base, which must be exact, for some rows of n elements. row[x + ahead] is
  /// needed next, unless ahead is 0.
  void (*widen)(const T* row, std::ptrdiff_t stride, Accumulator<T>* out, std::ptrdiff_t outStride,
    Accumulator<T> base, std::ptrdiff_t n, int rows, std::ptrdiff_t ahead);
  /// WorksheetLoops::splat from the volume's voxels; nullptr for types for which it is slower.
  void (*splatVoxels)(const Splat<Accumulator<T>, T>& splat);
  /// maxima[x] = max(maxima[x], rows[0..count)[x]) and low = min(low, all of them), without NaN;
  /// sets nonFinite if there are NaN or infinities.
  void (*survey)(
    const T* const* rows, int count, std::ptrdiff_t n, T* maxima, T& low, bool& nonFinite);
  /// out[x] = the largest of row[4 x], row[4 x + 1], row[4 x + 2] and row[4 x + 3].
  void (*largestOfFour)(const T* row, T* out, std::ptrdiff_t n);
};

/// Loops over pixels of type P that compare tiles of the image with bounds.
template <class P>
struct TileLoops
{
  /// minima[t] = the least of the pixels [t * TileWidth, (t + 1) * TileWidth) of all rows.
  void (*minima)(const P* image, std::ptrdiff_t stride, int rows, std::ptrdiff_t tiles, P* minima);
  /// flags[t] = whether bounds[t] > minima[t].
  void (*exceeds)(const P* bounds, const P* minima, unsigned char* flags, std::ptrdiff_t n);
};

/// Loops over the samples of a row of pixels in one slice. A NaN sample is none; a NaN pixel has no
/// sample yet. Only pixels with mask[x] != 0 change; without a mask all do.
template <class P>
struct RayLoops
{
  /// image[x] = max(image[x], samples[x]).
  void (*raise)(P* image, const P* samples, const unsigned char* mask, std::ptrdiff_t n);
  /// image[x] = min(image[x], samples[x]).
  void (*lower)(P* image, const P* samples, const unsigned char* mask, std::ptrdiff_t n);
  /// As `raise`, but only while ended[x] is 0. If a pixel is not below the threshold, the first
  /// sample below the pixel sets ended[x].
  void (*climb)(P* image, unsigned char* ended, P threshold, const P* samples,
    const unsigned char* mask, std::ptrdiff_t n);
  /// winners[x] = place for the first sample of a ray (winners[x] < 0), and where the image differs
  /// from `before`.
  void (*note)(std::int32_t* winners, std::int32_t place, const P* before, const P* image,
    const P* samples, const unsigned char* mask, std::ptrdiff_t n);
};

/// The factors of depth shading for the samples of slice k, in a row of pixels whose rays have
/// slices first[x] to last[x].
template <class A>
struct Shade
{
  A low, ambient, changeRate;
  A none; ///< the value without a sample; NaN is also none
  std::int32_t k;
  bool reversed; ///< whether the ray comes from the last slice
  const std::int16_t* first;
  const std::int16_t* last;
};

/// The least and greatest first and last slices of the rays of tiles.
struct TileExtremes
{
  std::int16_t *leastFirst, *greatestFirst, *leastLast, *greatestLast; ///< arrays
};

/// Of depths along rays, in slices.
struct DepthLimits
{
  static constexpr double Rounding = 1e-9; ///< tolerance of cuts
  /// before the first slice, and beyond the last one
  static constexpr double Before = -1.0, Beyond = 32767.0;
};

/// A plane along a row of pixels: the ray of pixel x crosses it at (slope (u + x) + rest) scale.
struct PlaneRow
{
  double slope, rest, scale;
  int u;
};

/// Loops over the depths at which rays are cut, and over the remaining slices.
struct CutLoops
{
  /// near[x] = max(near[x], the depth of the plane on the ray).
  void (*beginAtPlane)(const PlaneRow& plane, double* near, std::ptrdiff_t n);
  /// far[x] = min(far[x], the depth of the plane on the ray).
  void (*endAtPlane)(const PlaneRow& plane, double* far, std::ptrdiff_t n);
  /// The first and last of slices [begin, end) between the depths, see RayIntervals; first > last
  /// if there are none. Returns whether a ray lacks at least one of these slices.
  bool (*slicesBetween)(const double* near, const double* far, int begin, int end,
    std::int16_t* first, std::int16_t* last, std::ptrdiff_t n);
  /// The extremes of all tiles of some rows of n pixels.
  void (*tileExtremes)(const std::int16_t* first, const std::int16_t* last, std::ptrdiff_t stride,
    int rows, std::ptrdiff_t n, const TileExtremes& tiles);
  /// The visible share of tiles in slices [begin, end): 0 none, 1 some, 2 all.
  void (*tileShares)(
    const TileExtremes& tiles, int begin, int end, unsigned char* shares, std::ptrdiff_t n);
};

/// Loops over the rays of perspective images.
struct PerspectiveLoops
{
  /// The voxels in which rays enter and leave a slice, see AxisSteps::Slice. Ray x enters at at[x]
  /// + slope[x] * from and leaves at at[x] + slope[x] * to.
  void (*steps)(const double* at, const double* slope, double from, double to, std::int32_t size,
    std::int32_t* first, std::int32_t* last, double* time, std::int16_t* tick, std::ptrdiff_t n);
};

/// Integers that select elements of type A from a register.
template <class A>
using LaneOf = std::conditional_t<sizeof(A) == 4, std::int32_t, std::int64_t>;

/// The weights of the pixels of an image axis in a part of a slice; see AxisFootprints.
template <class A>
struct AxisWeights
{
  int shape;      ///< of the kernel, a Reconstruction
  double support; ///< its half-width
  const double *at, *slope;
  double depth;     ///< of the part's middle, from the reference
  double thickness; ///< of the part
  double pitch;     ///< from ray to ray
  std::int32_t low, high;
  int taps;
  std::int32_t* first; ///< voxels, clamped to [low, high]
  A* weights;          ///< tap t of pixel x at weights[t * stride + x]
  std::ptrdiff_t stride;
};

/// Some rows of voxels, and individual weights of each pixel of a row.
template <class A>
struct Resampling
{
  const A* voxels; ///< voxel 0 of the first row, which need not exist
  std::ptrdiff_t voxelStride;
  A* out; ///< pixel 0 of the first row, likewise
  std::ptrdiff_t outStride;
  int rows;
  const std::int32_t* base;
  const void* lanes;
  const A* weights;
  std::ptrdiff_t stride;
  int taps;
};

/// Worksheets from voxels that are not all finite.
template <class A>
struct Averages
{
  A* image; ///< NaN is "no sample yet"
  /// The worksheets of the finite voxels, with 0 for the others, and of their weights. Averages are
  /// the quotients.
  const A *sums, *weights;
  A whole; ///< lower bound of weights if all voxels are finite; then `sums` are averages
  /// The worksheets of positive and of negative infinities, or nullptr.
  const A *positive, *negative;
};

/// Loops over worksheets and images of type A (float or double).
template <class A>
struct WorksheetLoops
{
  /// Neighbouring pixels of a perspective image that select from one group of as many voxels.
  int group;
  void (*axisWeights)(const AxisWeights<A>& weights, std::ptrdiff_t n);
  /// out[x] = the sum of taps times voxels, for all rows and x from begin to end, in whole
  /// registers; voxels and weights are read likewise.
  void (*resample)(const Resampling<A>& rows, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// out[x] = the sum of weights[r] rows[r][x].
  void (*blend)(const A* const* rows, const A* weights, int count, A* out, std::ptrdiff_t n);
  /// image[x] = max(image[x], the sum of weights[r] rows[r][x]).
  void (*raiseBlend)(const A* const* rows, const A* weights, int count, A* image, std::ptrdiff_t n);
  /// Sets every pixel of the rectangle to the maximum of it and the weighted sum of its voxels,
  /// which must be finite.
  void (*splat)(const Splat<A>& splat);
  /// Sets pixels to the larger of themselves and the averages.
  void (*raiseAverages)(const Averages<A>& averages, std::ptrdiff_t n);
  /// Whether there are neither NaN nor infinities.
  bool (*allFinite)(const A* voxels, std::ptrdiff_t n);
  /// Flags finite voxels with 1 and, unless these are nullptr, positive and negative infinities.
  /// Voxels that are not finite become 0.
  void (*separate)(A* voxels, A* finite, A* positive, A* negative, std::ptrdiff_t n);
  /// As `raise`, by low + (samples[x] - low) * (ambient + (1 - n / N) changeRate), for sample n of
  /// N, from 0 on.
  void (*shade)(
    A* image, const Shade<A>& shade, const A* samples, const unsigned char* mask, std::ptrdiff_t n);
  /// Adds the samples in [low, high].
  void (*add)(double* sums, std::int32_t* counts, A low, A high, const A* samples,
    const unsigned char* mask, std::ptrdiff_t n);
  /// image[x] = clamp(image[x] + base, low, high); NaN stays.
  void (*finish)(A* image, A base, A low, A high, std::ptrdiff_t n);
  /// The bounds of worksheets that weigh their own voxels by 1 - `share` and those of a
  /// neighbouring layer by `share`, enlarged by rounding errors:
  ///   value = own[t] + share * max(0, max(before[t], after[t]) - own[t]),
  ///   own[t] = value + slack * max(|value|, magnitude).
  void (*bound)(
    A* own, const A* before, const A* after, A share, A slack, A magnitude, std::ptrdiff_t n);
  /// out[x] = image interpolated bilinearly at start + x step, between existing pixels.
  void (*interpolate)(const A* image, std::ptrdiff_t stride, const double* start,
    const double* step, A* out, std::ptrdiff_t n);
  /// The same at (u, v) of start + x step = (u w, v w, w).
  void (*interpolateProjective)(const A* image, std::ptrdiff_t stride, const double* start,
    const double* step, A* out, std::ptrdiff_t n);
  /// out[x] = colors[nearest entry to scale (values[x] - low)], clamped to [0, last]; 0 for NaN.
  void (*lookUp)(const A* values, A low, A scale, std::int32_t last, const std::uint32_t* colors,
    std::uint32_t* out, std::ptrdiff_t n);
};

struct Kernels
  : CutLoops
  , PerspectiveLoops
  , VoxelLoops<std::int8_t>
  , VoxelLoops<std::uint8_t>
  , VoxelLoops<std::int16_t>
  , VoxelLoops<std::uint16_t>
  , VoxelLoops<std::int32_t>
  , VoxelLoops<std::uint32_t>
  , VoxelLoops<std::int64_t>
  , VoxelLoops<std::uint64_t>
  , VoxelLoops<float>
  , VoxelLoops<double>
  , TileLoops<std::int8_t>
  , TileLoops<std::uint8_t>
  , TileLoops<std::int16_t>
  , TileLoops<std::uint16_t>
  , TileLoops<std::int32_t>
  , TileLoops<std::uint32_t>
  , TileLoops<std::int64_t>
  , TileLoops<std::uint64_t>
  , TileLoops<float>
  , TileLoops<double>
  , RayLoops<std::int8_t>
  , RayLoops<std::uint8_t>
  , RayLoops<std::int16_t>
  , RayLoops<std::uint16_t>
  , RayLoops<std::int32_t>
  , RayLoops<std::uint32_t>
  , RayLoops<std::int64_t>
  , RayLoops<std::uint64_t>
  , RayLoops<float>
  , RayLoops<double>
  , WorksheetLoops<float>
  , WorksheetLoops<double>
{
};

/// The best instruction set of both processor and build.
InstructionSet bestInstructionSet();

/// The loops for a set, or for the best lower one if processor or build do not have it.
const Kernels& kernelsFor(InstructionSet set);

/// "baseline", "AVX2", "AVX-512" or "AVX-512 VBMI".
const char* nameOf(InstructionSet set);
}

#endif
