// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The innermost loops: one run of voxels in, one run of pixels out. Kernels.cxx is compiled once
 * per instruction set and chosen from at run time. Each loop does the same IEEE operations in the
 * same order whatever the vector width (no fused multiply-add, no reassociation), so every
 * instruction set gives the same bits.
 */
#ifndef splattingKernels_h
#define splattingKernels_h

#include "Common/ScalarType.h"

#include <type_traits>

namespace splatting
{
/// Pixels along a tile of the image, the unit in which parts of slices are skipped, and its rows.
constexpr int TileWidth = 8;
constexpr int TileHeight = 4;

enum class InstructionSet
{
  Baseline,
  AVX2,
  AVX512,
  AVX512VBMI ///< and instructions that pick bytes
};

/// Most rows of voxels that a row of pixels meets at a time: three in each of four slices.
constexpr int MostRows = 12;

/// Half-open range of integers: pixels, voxels, slices, ...
struct Span
{
  int begin = 0;
  int end = 0;
  bool empty() const { return this->end <= this->begin; }
};

/// Pixels at an end of a row, a register of them from `first` on, that see some of the rows of
/// voxels: row r those in [begin[r], end[r]), relative to `first`. All rows are read there.
struct Rim
{
  int first;
  const int* begin;
  const int* end;
};

/// Rows of pixels, and the rows of voxels that the first one meets, shifted so that pixel x meets
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
  std::ptrdiff_t ahead; ///< to voxels that will be needed next, if memory does not foresee them
  const Span* runs;     ///< the pixels that count
  int runCount;
  Span valid; ///< the pixels that all rows have voxels for
  Rim rims[2];
  int rimCount;
};

/// What the rays of a perspective image do in one slice; see AxisSteps and AxisPicks for the
/// arrays, which begin with the first column and the first row.
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

/// Rows of pixels of a perspective image and the voxels that their rays cross in one slice or two.
template <class T>
struct Crossing
{
  T* image; ///< the row's first pixel
  std::ptrdiff_t imageStride;
  int height;
  CrossedSlice<T> slices[2];
  int count; ///< of slices
  std::ptrdiff_t rowStride;
  std::ptrdiff_t ahead;       ///< to voxels that will be needed next
  std::int32_t columns, rows; ///< of voxels
  const T* none;              ///< a row of the least value
  const Span* runs; ///< the pixels that count: multiples of 64 bytes, but for the row's end
  int runCount;
};

/// A rectangle of footprint weights and the voxels that it meets first, which are of type A or, as
/// the volume has them, of another one.
template <class A, class S = A>
struct SplatPart
{
  const S* source;  ///< the voxel under the first weight of the first pixel
  const A* weights; ///< rows x columns of them
  int rows;         ///< 1 to 5
  int columns;
};

/// A rectangle of the image, and the parts of the footprint: one per slice that adds to it.
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
  A base = 0;               ///< what is subtracted from the volume's own voxels
  std::ptrdiff_t ahead = 0; ///< from these to voxels that will be needed next, or 0
};

/// Loops over voxels of type T.
template <class T>
struct VoxelLoops
{
  /// Elements of a register.
  std::ptrdiff_t lanes;
  /// How many neighbouring pixels of a perspective image pick from one group of as many voxels.
  int group;
  /// image[x] = max(image[x], rows[0..count)[x]); NaN never wins.
  void (*maximum)(T* image, const T* const* rows, int count, std::ptrdiff_t n);
  /// out[x] = the largest of rows[0..count)[x], in whole registers: up to lanes - 1 elements beyond
  /// n are read and written as well.
  void (*largest)(const T* const* rows, int count, T* out, std::ptrdiff_t n);
  /// `maximum` for all rows of pixels: for the runs, as far as they are valid and perhaps some
  /// valid pixels beside them, and for the rims.
  void (*sweep)(const Sweep<T>& sweep);
  /// `maximum` of the voxels that rays cross, each pixel its own.
  void (*cross)(const Crossing<T>& crossing);
  /// out[x] = row[x] - base, which must be exact, for some rows of n elements. row[x + ahead] will
  /// be needed next; unless ahead is 0.
  void (*widen)(const T* row, std::ptrdiff_t stride, Accumulator<T>* out, std::ptrdiff_t outStride,
    Accumulator<T> base, std::ptrdiff_t n, int rows, std::ptrdiff_t ahead);
  /// WorksheetLoops::splat from the volume's own voxels; nullptr for types that take too long.
  void (*splatVoxels)(const Splat<Accumulator<T>, T>& splat);
  /// maxima[x] = max(maxima[x], rows[0..count)[x]) and low = min(low, all of them), NaN aside; sets
  /// nonFinite if there are NaN or infinity.
  void (*survey)(
    const T* const* rows, int count, std::ptrdiff_t n, T* maxima, T& low, bool& nonFinite);
  /// out[x] = the largest of row[4 x], row[4 x + 1], row[4 x + 2] and row[4 x + 3].
  void (*largestOfFour)(const T* row, T* out, std::ptrdiff_t n);
};

/// Loops over pixels of type P that compare tiles of the image with what is still to come.
template <class P>
struct TileLoops
{
  /// minima[t] = the least of the pixels [t * TileWidth, (t + 1) * TileWidth) of all rows.
  void (*minima)(const P* image, std::ptrdiff_t stride, int rows, std::ptrdiff_t tiles, P* minima);
  /// flags[t] = whether bounds[t] > minima[t].
  void (*exceeds)(const P* bounds, const P* minima, unsigned char* flags, std::ptrdiff_t n);
  /// Writes the pixels x with samples[x] > limits[x] to `found`, which has room for n, and returns
  /// how many they are.
  std::ptrdiff_t (*exceed)(
    const P* samples, const P* limits, std::int32_t* found, std::ptrdiff_t n);
};

/// Loops over the samples that a row of pixels has in one slice. A NaN sample is none, a NaN pixel
/// has had none yet. Only pixels with mask[x] != 0 change; without a mask all do.
template <class P>
struct RayLoops
{
  /// image[x] = max(image[x], samples[x]).
  void (*raise)(P* image, const P* samples, const unsigned char* mask, std::ptrdiff_t n);
  /// image[x] = min(image[x], samples[x]).
  void (*lower)(P* image, const P* samples, const unsigned char* mask, std::ptrdiff_t n);
  /// The same as `raise` until ended[x]: from the threshold on, the first lower sample ends it.
  void (*climb)(P* image, unsigned char* ended, P threshold, const P* samples,
    const unsigned char* mask, std::ptrdiff_t n);
  /// winners[x] = place for the first sample of a ray (winners[x] < 0 before) and where the image
  /// is not what it was `before` the samples were taken.
  void (*note)(std::int32_t* winners, std::int32_t place, const P* before, const P* image,
    const P* samples, const unsigned char* mask, std::ptrdiff_t n);
};

/// How depth shading dims the samples of slice k in a row of pixels whose rays have slices first[x]
/// to last[x].
template <class A>
struct Shade
{
  A low, ambient, changeRate;
  A none; ///< what stands where there is no sample; NaN does so always
  std::int32_t k;
  bool reversed; ///< whether the ray comes from the last slice
  const std::int16_t* first;
  const std::int16_t* last;
};

/// The least and greatest first and last slices that the rays of tiles are cut to.
struct TileExtremes
{
  std::int16_t *leastFirst, *greatestFirst, *leastLast, *greatestLast; ///< arrays
};

/// Of depths along rays, in slices.
struct DepthLimits
{
  static constexpr double Rounding = 1e-9; ///< that far outside is inside
  /// Less than the first slice, and more than the last one.
  static constexpr double Before = -1.0, Beyond = 32767.0;
};

/// A plane along a row of pixels: the ray of pixel x meets it at (slope (u + x) + rest) scale.
struct PlaneRow
{
  double slope, rest, scale;
  int u;
};

/// Loops over the depths that rays are cut at, and over the slices that are left.
struct CutLoops
{
  /// near[x] = max(near[x], where the ray meets the plane).
  void (*beginAtPlane)(const PlaneRow& plane, double* near, std::ptrdiff_t n);
  /// far[x] = min(far[x], where the ray meets the plane).
  void (*endAtPlane)(const PlaneRow& plane, double* far, std::ptrdiff_t n);
  /// The first and last of slices [begin, end) that lie between the depths, as RayIntervals says;
  /// first > last if none do. Whether there are rays that do not have all.
  bool (*slicesBetween)(const double* near, const double* far, int begin, int end,
    std::int16_t* first, std::int16_t* last, std::ptrdiff_t n);
  /// The extremes of all tiles of some rows of n pixels.
  void (*tileExtremes)(const std::int16_t* first, const std::int16_t* last, std::ptrdiff_t stride,
    int rows, std::ptrdiff_t n, const TileExtremes& tiles);
  /// How much of tiles counts in slices [begin, end): 0 none, 1 some, 2 all.
  void (*tileShares)(
    const TileExtremes& tiles, int begin, int end, unsigned char* shares, std::ptrdiff_t n);
};

/// Loops over the rays of perspective images.
struct PerspectiveLoops
{
  /// The voxels in which rays enter and leave a slice, as in AxisSteps::Slice: ray x enters at
  /// at[x] + slope[x] * from and leaves at at[x] + slope[x] * to.
  void (*steps)(const double* at, const double* slope, double from, double to, std::int32_t size,
    std::int32_t* first, std::int32_t* last, double* time, std::int16_t* tick, std::ptrdiff_t n);
};

/// Integers that pick elements of type A from a register.
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

/// Some rows of voxels, and how each pixel of a row weighs them on its own.
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

/// Worksheets from voxels of which some are not finite.
template <class A>
struct Averages
{
  A* image; ///< NaN is "no sample yet"
  /// The worksheets of the finite voxels, the others being 0, and of which are finite: averages are
  /// the quotients.
  const A *sums, *weights;
  A whole; ///< what weights are at least where all voxels are finite: `sums` are averages
  /// The worksheets of which voxels are positive and negative infinities, or nullptr.
  const A *positive, *negative;
};

/// Loops over worksheets and images of type A (float or double).
template <class A>
struct WorksheetLoops
{
  /// How many neighbouring pixels of a perspective image pick from one group of as many voxels.
  int group;
  void (*axisWeights)(const AxisWeights<A>& weights, std::ptrdiff_t n);
  /// out[x] = the sum of taps times voxels, for all rows and x from begin to end, in whole
  /// registers, as voxels and weights are read.
  void (*resample)(const Resampling<A>& rows, std::ptrdiff_t begin, std::ptrdiff_t end);
  /// out[x] = the sum of weights[r] rows[r][x].
  void (*blend)(const A* const* rows, const A* weights, int count, A* out, std::ptrdiff_t n);
  /// image[x] = max(image[x], the sum of weights[r] rows[r][x]).
  void (*raiseBlend)(const A* const* rows, const A* weights, int count, A* image, std::ptrdiff_t n);
  /// Every pixel of the rectangle: the maximum of it and the weighted sum of its voxels, which must
  /// be finite.
  void (*splat)(const Splat<A>& splat);
  /// Pixels become the larger of themselves and the averages.
  void (*raiseAverages)(const Averages<A>& averages, std::ptrdiff_t n);
  /// Whether there are neither NaN nor infinities.
  bool (*allFinite)(const A* voxels, std::ptrdiff_t n);
  /// Tells with 1 and 0 which voxels are finite and, unless these are nullptr, which are positive
  /// and negative infinities; those that are not finite become 0.
  void (*separate)(A* voxels, A* finite, A* positive, A* negative, std::ptrdiff_t n);
  /// `raise` by low + (samples[x] - low) * (ambient + (1 - n / N) changeRate), the sample being the
  /// n-th of N from 0 on.
  void (*shade)(
    A* image, const Shade<A>& shade, const A* samples, const unsigned char* mask, std::ptrdiff_t n);
  /// Adds the samples in [low, high].
  void (*add)(double* sums, std::int32_t* counts, A low, A high, const A* samples,
    const unsigned char* mask, std::ptrdiff_t n);
  /// image[x] = clamp(image[x] + base, low, high); NaN stays.
  void (*finish)(A* image, A base, A low, A high, std::ptrdiff_t n);
  /// What a worksheet can reach where it weighs its own voxels by 1 - `share` and its neighbours',
  /// on one side or the other, by `share`, enlarged for rounding:
  /// value = own[t] + share * max(0, max(before[t], after[t]) - own[t]),
  /// own[t] = value + slack * max(|value|, magnitude).
  void (*bound)(
    A* own, const A* before, const A* after, A share, A slack, A magnitude, std::ptrdiff_t n);
  /// out[x] = image interpolated bilinearly at start + x step, which must lie between pixels that
  /// exist.
  void (*interpolate)(const A* image, std::ptrdiff_t stride, const double* start,
    const double* step, A* out, std::ptrdiff_t n);
  /// The same at (u, v) of start + x step = (u w, v w, w).
  void (*interpolateProjective)(const A* image, std::ptrdiff_t stride, const double* start,
    const double* step, A* out, std::ptrdiff_t n);
  /// out[x] = colors[nearest entry to scale (values[x] - low)], clamped to [0, last].
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

/// The best instruction set that processor and build have.
InstructionSet bestInstructionSet();

/// The loops for a set; a set that processor or build lack gives the best one below it.
const Kernels& kernelsFor(InstructionSet set);

/// "baseline", "AVX2", "AVX-512" or "AVX-512 VBMI".
const char* nameOf(InstructionSet set);
}

#endif
