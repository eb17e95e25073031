// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Standard and high mode: the footprints of all slices, and worksheets in layers of BrickDepth
 * slices. A worksheet lives for a few rows of one slice, in registers.
 */
#ifndef splattingWorksheets_h
#define splattingWorksheets_h

#include "Clipping/Cuts.h"
#include "Projection/Frame.h"
#include "Sampling/Footprint.h"
#include "Sampling/Patch.h"
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
/// set if it is needed, and of use again for other phases and frames of the same view.
template <class A>
void findFootprints(const ShearWarp& geometry, const Kernel& kernel, int sampling, int weightBits,
  GeneralTable& table, std::vector<SliceFootprint<A>>& footprints);

/// What the worksheets of all slices read.
template <class A>
struct WorksheetReach
{
  struct Layer
  {
    Window window; ///< of the layer's own voxels, by all worksheets that read them
    A share = 0;   ///< how much of a worksheet its neighbours' voxels can weigh
  };
  std::vector<Layer> layers;
  std::vector<Window> slices; ///< the same for each slice's voxels
  int columns = 0, rows = 0;  ///< the largest of the slices' windows
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

/// What the worksheets of all projections share: how layers, pieces and rows are walked, and how
/// voxels come into the patch.
template <class T>
class WorksheetLayers : public SliceSampler<T, Accumulator<T>>
{
public:
  using A = Accumulator<T>;
  using typename SliceSampler<T, A>::Samples;

  /// @param depth  how many slices beyond its own a footprint reads
  WorksheetLayers(const Frame& frame, bool perspective, const WorksheetReach<A>& reach, int depth)
    : SliceSampler<T, A>({ perspective, 1, RowsTogether, RunUnit, true }),
      Shared(frame),
      Reach(reach),
      Depth(depth),
      Base(baseOf(frame.range))
  {
  }

  A share(int layer) const override { return this->Reach.layers[layer].share; }

  /// What is subtracted from voxels before they are weighed, so that a flat background of the
  /// lowest value is 0 and its sums are exact.
  A base() const override { return this->Base; }

  A magnitude() const override
  {
    return std::abs(static_cast<A>(this->Shared.range.low) - this->Base);
  }

  void splat(int z, int v0, int v1, const std::vector<Span>& runs, const SliceBits& bits,
    const SliceRuns* cuts, Patch& patch) const override;
  void open(int v0, int v1, const Span& columns, Patch& patch) const override;
  void splatOpened(int z, std::vector<RowRuns>& rows, int count, Patch& patch) const override;
  void forSamples(const Span& slices, bool reversed, int v0, int v1, const Span& columns,
    Patch& patch, const Samples& f) const override;
  /// Piece by piece, so that voxels are widened once.
  void splatAll(const Span& layers, int v0, int v1, const std::vector<Span>& all,
    const SliceRuns* cuts, Patch& patch) const override;

  A floor() const override
  {
    const double floor =
      std::clamp(this->Shared.floor, this->Shared.range.low, this->Shared.range.high);
    return static_cast<A>(floor) - this->Base;
  }

  /// Adds the base; rounding must not show values that the data do not have.
  void finish(int v0, int v1) const override;

protected:
  /// Where worksheets go.
  struct Target
  {
    A* origin; ///< of pixel (0, 0), which need not exist
    std::ptrdiff_t stride;
    SliceBits bits = {}; ///< which pixels change, by one of them; if there are any
    unsigned char bit = 0;
    Span whole = {};                ///< pixels that all change, as far as that is known
    std::int16_t* orders = nullptr; ///< of pixel (0, 0), if splatRows() notes winners
    std::int16_t order = 0;

    A* at(int u, int v) const { return this->origin + v * this->stride + u; }
  };

  /// Widens the voxels that worksheet k reads, as far as the patch does not have them.
  /// @param step  to the worksheet that comes next, 0 if none does
  void load(int k, int step, Patch& patch) const;

  /// The voxels of slice s that worksheets need for some pixels.
  virtual Patch::Sheet sheetOf(int s, int v0, int v1, const Span& columns) const = 0;

  virtual void loadSheet(const Patch::Sheet& sheet, Patch& patch) const;

  /// What splatRows() notes of pixel (u, v) and those after it.
  Noting notingAt(const Target& target, int u, int v) const
  {
    Noting noting;
    noting.notes = target.orders ? target.orders + v * target.stride + u : nullptr;
    noting.order = target.order;
    noting.nearestFirst = this->Shared.nearestFirst;
    return noting;
  }

  /// Does the same as load() and splatRows() from the volume's own voxels, as far as these are all
  /// that counts. False if that does not pay.
  virtual bool splatOwn(int, int, int, int, const Span&, const Target&, Patch&) const
  {
    return false;
  }

  /// Raises pixels of some rows to the worksheet of slice k, whose voxels have been loaded.
  virtual void splatRows(
    int k, int first, int end, const Span& span, const Target& target, Patch& patch) const = 0;

private:
  /// Rows that cut layers are walked for at a time: those of a piece.
  static constexpr int RowsTogether = 16;
  /// The widest registers hold two tiles, and take no longer for both than for one.
  static constexpr int RunUnit = 2 * TileWidth;

  static A baseOf(const VolumeIndex::Range& range)
  {
    // Only where the difference is exact: 64-bit integers have more bits than double.
    return std::numeric_limits<T>::is_integer && sizeof(T) < 8 ? static_cast<A>(range.low) : A(0);
  }

  Target image() const
  {
    Target image;
    image.origin = this->Shared.image.template row<A>(0);
    image.stride = this->Shared.image.width;
    image.orders = this->Shared.orders;
    return image;
  }

  /// Room for one worksheet.
  Target worksheetFor(int v0, int v1, const Span& columns, Patch& patch) const;

  /// Calls f for pieces of the image whose patch stays in the cache.
  template <class F>
  void forPieces(int v0, int v1, const Span& columns, F&& f) const;

  /// What says which samples count, where rays are cut: either, or nothing.
  struct SampleCuts
  {
    SliceBits bits;
    const SliceRuns* runs = nullptr;
  };

  /// Sets which of some pixels slice k changes, and leaves out of these what it does not. False if
  /// it changes none.
  bool cut(const SampleCuts& cuts, int k, int v0, int v1, Span& pixels, Target& target,
    Patch& patch) const;
  SliceBits bitsOf(
    const SliceRuns& runs, int k, int v0, int v1, const Span& pixels, Patch& patch) const;

  /// @param after  the step to the slice that comes after these, if it is known
  void splatPiece(const Span& slices, int v0, int v1, const Span& columns, const SampleCuts& cuts,
    Patch& patch, int after = 0) const;
  /// The same by way of worksheets of their own, for splatRows() that do not note winners.
  void notePiece(const Span& slices, int v0, int v1, const Span& columns, const SampleCuts& cuts,
    Patch& patch) const;

  /// From one slice to the next.
  int step() const { return this->Shared.nth({ 0, 2 }, 1) - this->Shared.nth({ 0, 2 }, 0); }

  std::int16_t orderOfSlice(int k) const
  {
    return static_cast<std::int16_t>(this->Shared.orderOfStep(StepsPerSlice * k));
  }

  void put(A value, int v, const Span& pixels, const Target& worksheet) const;
  /// Values a little below those of the image, so that what is as large as the image shows, and no
  /// more is found out about what is smaller.
  void putBelowImage(int v, const Span& pixels, const Target& worksheet) const;

  /// The worksheet of slice k alone (a step from the next one), in which pixels are as open(v,
  /// pixels) has set them or larger, then f(v, pixels) for its rows.
  template <class Open, class F>
  void splatSlice(int k, int step, int v0, int v1, const Span& columns, const Target& worksheet,
    Patch& patch, Open&& open, F&& f) const;

  /// Calls f(first, end, span) for rows that slice k covers in the same columns: nearly always all
  /// of them at once.
  template <class F>
  void forRows(int k, int v0, int v1, const Span& columns, F&& f) const;

  /// Fills rows of a sheet, from `to` on, with the volume's rows from `from` on.
  void loadRows(const Patch::Sheet& sheet, int to, int from, int rows, Patch& patch) const;

protected:
  const Frame& Shared;
  const WorksheetReach<A>& Reach;
  int Depth;
  bool Notes = false;                                ///< whether splatRows() notes winners
  int PieceWidth = 1024, PieceHeight = RowsTogether; ///< pixels; for the second-level cache
  A Base;
};
}

#endif
