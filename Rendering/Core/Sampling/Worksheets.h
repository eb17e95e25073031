// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Standard and high mode: the footprints of all slices, and worksheets in layers of BrickDepth
 * slices. A worksheet lives for a few rows of one slice, in registers.
 */
#ifndef splattingWorksheets_h
#define splattingWorksheets_h

#include "Clipping/Cuts.h"
#include "Projection/ProjectionContext.h"
#include "Sampling/Footprint.h"
#include "Sampling/LoadedVoxels.h"
#include "Sampling/SliceSampler.h"

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
  std::array<A, 25> weights; // row after row, zero where there is no tap
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

/// Weights are rounded so that 8-bit sums are exact, else to the accumulator's precision.
template <class T>
constexpr int weightBits = sizeof(T) == 1 ? 16
  : std::is_same_v<Accumulator<T>, float> ? 24
                                          : 48;

/// The footprints of all slices; `sampling` as ProjectionSettings::footprintSampling. The table is
/// set if it is needed, and of use again for other frames of the same view.
template <class A>
void findFootprints(const ShearWarp& geometry, const Kernel& kernel, int sampling, int weightBits,
  GeneralTable& table, std::vector<SliceFootprint<A>>& footprints);

/// What the worksheets of all slices read.
template <class A>
struct WorksheetReach
{
  struct Layer
  {
    VoxelWindow window; ///< of the layer's own voxels, by all worksheets that read them
    A share = 0;        ///< how much of a worksheet its neighbours' voxels can weigh
  };
  std::vector<Layer> layers;
  std::vector<VoxelWindow> slices; ///< the same for each slice's voxels
  int columns = 0, rows = 0;       ///< the largest of the slices' windows
};

template <class A>
void findReach(const std::vector<SliceGeometry>& slices,
  const std::vector<SliceFootprint<A>>& footprints, WorksheetReach<A>& reach);

/// The kernel of standard and high mode, and how many slices beyond its own a footprint reads.
inline Kernel worksheetKernel(const ProjectionSettings& settings)
{
  return settings.quality == Quality::Standard ? Kernel{ Reconstruction::Box } : settings.kernel;
}
inline int worksheetDepth(const ProjectionSettings& settings)
{
  return settings.quality == Quality::Standard ? 0 : 1;
}

/// What the worksheets of all projections share: how layers, blocks and rows are walked, and how
/// voxels are loaded.
template <class T>
class WorksheetSampler : public SliceSampler<T, Accumulator<T>>
{
public:
  using A = Accumulator<T>;
  using typename SliceSampler<T, A>::Samples;
  using Target = PixelRows<A>; ///< where worksheets go

  /// @param depth  how many slices beyond its own a footprint reads
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

  /// What is subtracted from voxels before they are weighed, so that a flat background of the
  /// lowest value is 0 and its sums are exact.
  A base() const override { return this->Base; }

  A magnitude() const override
  {
    return std::abs(static_cast<A>(this->Context.range.low) - this->Base);
  }

  void splat(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const Target& pixels, LoadedVoxels& loaded) const override;
  /// Block by block, so that voxels are widened once.
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

  /// Adds the base; rounding must not show values that the data do not have.
  void finish(int v0, int v1) const override;

protected:
  /// The largest of all voxels, less the base, whatever its sign.
  A largestVoxel() const
  {
    return std::max(
      this->magnitude(), std::abs(static_cast<A>(this->Context.range.high) - this->Base));
  }

  /// Room for the voxels of some rows and columns of pixels.
  void open(int v0, int v1, const Span& columns, LoadedVoxels& loaded) const;

  /// Widens the voxels that worksheet k reads, as far as they are not loaded.
  /// @param step  to the worksheet that comes next, 0 if none does
  void load(int k, int step, LoadedVoxels& loaded) const;

  /// The voxels of slice s that worksheets need for some pixels.
  virtual LoadedVoxels::Sheet sheetOf(int s, int v0, int v1, const Span& columns) const = 0;

  virtual void loadSheet(const LoadedVoxels::Sheet& sheet, LoadedVoxels& loaded) const;

  /// Does the same as load() and splatRows() from the volume's own voxels, as far as these are all
  /// that counts. False if that does not pay.
  virtual bool splatOwn(int, int, int, int, const Span&, const Target&, LoadedVoxels&) const
  {
    return false;
  }

  /// Raises pixels of some rows to the worksheet of slice k, whose voxels have been loaded and are
  /// finite.
  virtual void splatRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const = 0;

  /// The same where some are not. NaN is left out of averages: the worksheet of the others, divided
  /// by that of their weights. Pixels that are NaN have no sample yet.
  virtual void splatNonFiniteRows(
    int k, int first, int end, const Span& span, const Target& target, LoadedVoxels& loaded) const;

  /// Whether the voxels that worksheet k reads are, which have been loaded.
  bool isFinite(int k, LoadedVoxels& loaded) const;

  /// What the weights of a pixel add up to at least.
  virtual A wholeWeight() const { return 1; }

private:
  /// The widest registers hold two tiles, and take no longer for both than for one.
  static constexpr int RunUnit = 2 * TileWidth;

  static A baseOf(const VolumeIndex::Range& range)
  {
    // Only where the difference is exact: 64-bit integers have more bits than double.
    return std::numeric_limits<T>::is_integer && sizeof(T) < 8 ? static_cast<A>(range.low) : A(0);
  }

  /// The sheets that worksheet k reads, as slices.
  Span sheetsOf(int k) const
  {
    return { std::max(k - this->Depth, 0),
      std::min(k + this->Depth, this->Context.geometry.size().z - 1) + 1 };
  }
  bool isFinite(const LoadedVoxels::Sheet& sheet, LoadedVoxels& loaded) const;
  /// Voxels, which of them are finite, and, if there are infinities, which are positive or
  /// negative.
  int parts() const { return this->Context.range.hasInfinities() ? 4 : 2; }
  /// Makes the parts of the sheets that worksheet k reads.
  void separate(int k, LoadedVoxels& loaded) const;

  /// Room for one worksheet.
  Target worksheetFor(int v0, int v1, const Span& columns, LoadedVoxels& loaded) const;

  /// Calls f for blocks of the image whose voxels stay in the cache.
  template <class F>
  void forBlocks(int v0, int v1, const Span& columns, F&& f) const;

  /// Makes the worksheet of slice k for pixels of some rows. Pixels without a sample get the least
  /// value or, if the volume has NaN, NaN.
  void sample(int k, int step, int first, int end, const Span& span, const Target& worksheet,
    LoadedVoxels& loaded) const;
  /// Raises pixels of some rows to the worksheet of slice k.
  /// @param step  to the worksheet that comes next, 0 if none does
  void splatOne(int k, int step, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const;
  void splatBlocks(const Span& slices, int v0, int v1, const Span& run, const Target& target,
    LoadedVoxels& loaded) const;
  void splatBlock(const Span& slices, int v0, int v1, const Span& columns, const Target& target,
    LoadedVoxels& loaded) const;

  /// Calls f(first, end, span) for rows that slice k covers in the same columns: nearly always all
  /// of them at once.
  template <class F>
  void forRows(int k, int v0, int v1, const Span& columns, F&& f) const;

  /// Fills rows of a sheet, from `to` on, with the volume's rows from `from` on.
  void loadRows(
    const LoadedVoxels::Sheet& sheet, int to, int from, int rows, LoadedVoxels& loaded) const;

protected:
  const ProjectionContext& Context;
  const WorksheetReach<A>& Reach;
  int Depth;
  int BlockWidth = 1024, BlockHeight = 16; ///< pixels; for the second-level cache
  A Base;
};
}

#endif
