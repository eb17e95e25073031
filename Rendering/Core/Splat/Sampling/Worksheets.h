// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Standard and high mode: the footprints of all slices, and worksheets in layers of BrickDepth
 * slices. A worksheet exists for a few rows of one slice, in registers.
 */
#ifndef splattingWorksheets_h
#define splattingWorksheets_h

#include "Splat/Projection/ProjectionContext.h"
#include "Splat/Sampling/Footprint.h"
#include "Splat/Walks/Cuts.h"
#include "Splat/Walks/LoadedVoxels.h"
#include "Splat/Walks/SliceSampler.h"

#include <cmath>

namespace splatting
{
/// The part of a footprint that lies in one slice: the rectangle around its taps.
template <class A>
struct FootprintPart
{
  int slice;  // -1, 0 or 1
  int di, dj; // the first column and row
  int columns, rows;
  std::array<A, 25> weights; // row by row, zero without a tap
};

/// The footprint of one slice, with weights of the accumulator's type.
template <class A>
struct SliceFootprint
{
  glm::ivec2 nearest; // pixel minus voxel, for the voxel nearest to a pixel
  Taps taps;
  std::array<A, 75> weights; // of the taps
  std::array<FootprintPart<A>, 3> parts;
  int partCount = 0;
};

/// Weights for 8-bit voxels are rounded so that sums are exact. For other types they are rounded to
/// the accumulator's precision.
template <class T>
constexpr int weightBits = sizeof(T) == 1 ? 16
  : std::is_same_v<Accumulator<T>, float> ? 24
                                          : 48;

/// The footprints of all slices.
/// @param sampling  as ProjectionSettings::footprintSampling
/// @param table     is set if needed, and reused by other frames of the same view
template <class A>
void findFootprints(const ShearWarp& geometry, const Kernel& kernel, int sampling, int weightBits,
  GeneralTable& table, std::vector<SliceFootprint<A>>& footprints);

/// The voxels that the worksheets of all slices read.
template <class A>
struct WorksheetReach
{
  struct Layer
  {
    VoxelWindow window; ///< of the layer's own voxels, by all worksheets that read them
    A share = 0;        ///< the largest weight of neighbouring layers' voxels in a worksheet
  };
  std::vector<Layer> layers;
  std::vector<VoxelWindow> slices; ///< the same for each slice's voxels
  int columns = 0, rows = 0;       ///< the largest of the slices' windows
};

template <class A>
void findReach(const std::vector<SliceGeometry>& slices,
  const std::vector<SliceFootprint<A>>& footprints, WorksheetReach<A>& reach);

/// The kernel of standard and high mode, and the number of slices beyond its own that a footprint
/// reads.
inline Kernel worksheetKernel(const ProjectionSettings& settings)
{
  return settings.quality == Quality::Standard ? Kernel{ Reconstruction::Box } : settings.kernel;
}
inline int worksheetDepth(const ProjectionSettings& settings)
{
  return settings.quality == Quality::Standard ? 0 : 1;
}

/// The common code of worksheets in all projections: loops over layers, blocks and rows, and
/// loading of voxels.
template <class T>
class WorksheetSampler : public SliceSampler<T, Accumulator<T>>
{
public:
  using A = Accumulator<T>;
  using typename SliceSampler<T, A>::Samples;
  using Target = PixelRows<A>; ///< destination of worksheets

  /// @param depth  slices beyond its own that a footprint reads
  WorksheetSampler(
    const ProjectionContext& context, bool perspective, const WorksheetReach<A>& reach, int depth)
    : SliceSampler<T, A>({ perspective, 1, RunUnit }),
      Context(context),
      Reach(reach),
      Depth(depth),
      Base(baseOf(context.range))
  {
  }

  A share(int layer) const override { return this->Reach.layers[layer].share; }

  /// Is subtracted from voxels before they are weighted. A flat background of the lowest value is
  /// then 0, and its sums are exact.
  A base() const override { return this->Base; }

  A magnitude() const override
  {
    return std::abs(static_cast<A>(this->Context.range.low) - this->Base);
  }

  void splat(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const Target& pixels, LoadedVoxels& loaded) const override;
  /// Block by block, so that voxels are converted once.
  void splatAll(const Span& layers, int v0, int v1, const std::vector<Span>& all,
    LoadedVoxels& loaded) const override;
  void forSamples(const Span& slices, bool reversed, int v0, int v1, const Span& columns,
    LoadedVoxels& loaded, const Samples& f) const override;

  A floor() const override
  {
    if (this->Context.range.nonFinite)
    {
      return leastValue<A>(); // as in previewFloor()
    }
    const double floor =
      std::clamp(this->Context.floor, this->Context.range.low, this->Context.range.high);
    return static_cast<A>(floor) - this->Base;
  }

  /// Adds the base. Clamps rounding errors to the range of the data.
  void finish(int v0, int v1) const override;

protected:
  /// The largest of all voxels, less the base.
  A largestVoxel() const
  {
    return std::max(
      this->magnitude(), std::abs(static_cast<A>(this->Context.range.high) - this->Base));
  }

  /// Allocates the voxels of some rows and columns of pixels.
  void open(int v0, int v1, const Span& columns, LoadedVoxels& loaded) const;

  /// Converts the voxels of worksheet k, unless they are loaded.
  /// @param step  to the next worksheet, 0 if there is none
  void load(int k, int step, LoadedVoxels& loaded) const;

  /// The voxels of slice s that worksheets need for some pixels.
  virtual LoadedVoxels::Sheet sheetOf(int s, int v0, int v1, const Span& columns) const = 0;

  virtual void loadSheet(const LoadedVoxels::Sheet& sheet, LoadedVoxels& loaded) const;

  /// Does the work of load() and splatRows() directly from the volume's voxels, without copies.
  /// Returns false, and does nothing, if copies are needed or not slower.
  virtual bool splatOwn(int, int, int, int, const Span&, const Target&, LoadedVoxels&) const
  {
    return false;
  }

  /// Raises pixels of some rows to the worksheet of slice k, whose voxels are loaded and finite.
  virtual void splatRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const = 0;

  /// The same for voxels that are not all finite. Averages exclude NaN: the worksheet of the other
  /// voxels is divided by that of their weights. Pixels that are NaN have no sample yet.
  virtual void splatNonFiniteRows(
    int k, int first, int end, const Span& span, const Target& target, LoadedVoxels& loaded) const;

  /// Whether the loaded voxels of worksheet k are finite.
  bool isFinite(int k, LoadedVoxels& loaded) const;

  /// A lower bound of the sum of a pixel's weights.
  virtual A wholeWeight() const { return 1; }

private:
  /// The widest registers contain two tiles. One tile takes as long as two.
  static constexpr int RunUnit = 2 * TileWidth;

  static A baseOf(const VolumeIndex::Range& range)
  {
    // Only if the difference is exact: 64-bit integers have more bits than double.
    return std::numeric_limits<T>::is_integer && sizeof(T) < 8 ? static_cast<A>(range.low) : A(0);
  }

  /// The slices of the sheets of worksheet k.
  Span sheetsOf(int k) const
  {
    return { std::max(k - this->Depth, 0),
      std::min(k + this->Depth, this->Context.geometry.size().z - 1) + 1 };
  }
  bool isFinite(const LoadedVoxels::Sheet& sheet, LoadedVoxels& loaded) const;
  /// Voxels, flags of finite ones and, with infinities, flags of positive and negative ones.
  int parts() const { return this->Context.range.hasInfinities() ? 4 : 2; }
  /// Makes the parts of the sheets of worksheet k.
  void separate(int k, LoadedVoxels& loaded) const;

  /// Buffer for one worksheet.
  Target worksheetFor(int v0, int v1, const Span& columns, LoadedVoxels& loaded) const;

  /// Calls f for blocks of the image whose voxels fit the cache.
  template <class F>
  void forBlocks(int v0, int v1, const Span& columns, F&& f) const;

  /// Makes the worksheet of slice k for pixels of some rows. Pixels without a sample get the least
  /// value or, if the volume has NaN, NaN.
  void sample(int k, int step, int first, int end, const Span& span, const Target& worksheet,
    LoadedVoxels& loaded) const;
  /// Raises pixels of some rows to the worksheet of slice k.
  /// @param step  to the next worksheet, 0 if there is none
  void splatOne(int k, int step, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const;
  void splatBlocks(const Span& slices, int v0, int v1, const Span& run, const Target& target,
    LoadedVoxels& loaded) const;
  void splatBlock(const Span& slices, int v0, int v1, const Span& columns, const Target& target,
    LoadedVoxels& loaded) const;

  /// Calls f(first, end, span) for rows with the same columns of slice k, nearly always all rows at
  /// once.
  template <class F>
  void forRows(int k, int v0, int v1, const Span& columns, F&& f) const;

  /// Fills rows of a sheet, from `to` on, with the volume's rows from `from` on.
  void loadRows(
    const LoadedVoxels::Sheet& sheet, int to, int from, int rows, LoadedVoxels& loaded) const;

protected:
  const ProjectionContext& Context;
  const WorksheetReach<A>& Reach;
  int Depth;
  int BlockWidth = 1024, BlockHeight = 16; ///< pixels; fit the second-level cache
  A Base;
};
}

#endif
