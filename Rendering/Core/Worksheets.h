// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Standard and high mode: the footprints of all slices, and worksheets in layers of BrickDepth
 * slices. A worksheet lives for a few rows of one slice, in registers.
 */
#ifndef splattingWorksheets_h
#define splattingWorksheets_h

#include "Cuts.h"
#include "Footprint.h"
#include "Frame.h"
#include "Patch.h"

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

/// The footprints of all slices; `sampling` as ProjectionSettings::footprintSampling.
template <class A>
void findFootprints(const ShearWarp& geometry, const Kernel& kernel, int sampling, int weightBits,
  std::vector<SliceFootprint<A>>& footprints);

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

/// What the worksheets of all projections share: how layers, pieces and rows are walked, and how
/// voxels come into the patch.
template <class T>
class WorksheetLayers
{
public:
  using A = Accumulator<T>;
  using Voxel = T;
  using Pixel = A;
  /// How many slices beyond its own a layer reads.
  static constexpr int Beyond = 1;
  /// Rows that cut layers are walked for at a time: those of a piece.
  static constexpr int RowsTogether = 16;
  /// Pixels whose multiples runs had best begin and end at: the widest registers hold two tiles,
  /// and take no longer for both than for one.
  static constexpr int RunUnit = 2 * TileWidth;
  /// Whether splatAll() takes SliceRuns.
  static constexpr bool TakesSliceRuns = true;

  /// @param depth  how many slices beyond its own a footprint reads
  WorksheetLayers(const Frame<T>& frame, const WorksheetReach<A>& reach, int depth)
    : Shared(frame),
      Reach(reach),
      Depth(depth),
      Base(baseOf(frame.range))
  {
  }
  virtual ~WorksheetLayers() = default;

  A share(int layer) const { return this->Reach.layers[layer].share; }

  /// Of Frame::orders, the least that a layer can give.
  std::int16_t orderOf(int z) const { return this->Shared.nearestOrder(z); }

  /// What is subtracted from voxels before they are weighed, so that a flat background of the
  /// lowest value is 0 and its sums are exact.
  A base() const { return this->Base; }

  /// Of what rounding is relative to: see slack() of the derived classes.
  A magnitude() const { return std::abs(static_cast<A>(this->Shared.range.low) - this->Base); }

  /// Splats a layer's worksheets into the pixels of some rows and runs of columns, as far as the
  /// bits or the slices' runs (if there are any) say.
  void splat(int z, int v0, int v1, const std::vector<Span>& runs, const SliceBits& bits,
    Patch& patch, const SliceRuns* cuts = nullptr) const
  {
    const Span slices = slicesOfLayer(z, this->Shared.geometry.size());
    for (std::size_t n = 0; n < runs.size(); ++n)
    {
      this->forPieces(v0, v1, runs[n],
        [&](int first, int last, const Span& columns)
        {
          this->open(first, last, columns, patch);
          this->splatPiece(slices, first, last, columns, { bits, cuts }, patch);
        });
    }
  }

  /// The same for some of the rows and columns that have been opened together: layer by layer, so
  /// that voxels are widened once.
  void open(int v0, int v1, const Span& columns, Patch& patch) const
  {
    this->clear(patch, v0, v1, columns);
    patch.rows = { v0, v1 };
    patch.pixels = columns;
  }
  void splatOpened(int z, std::vector<RowRuns>& rows, int count, Patch& patch) const
  {
    count = joined(rows, count);
    const Span slices = slicesOfLayer(z, this->Shared.geometry.size());
    for (int n = 0; n < slices.end - slices.begin; ++n)
    {
      const int k = this->Shared.nth(slices, n);
      for (int r = 0; r < count; ++r)
      {
        for (const Span& run : rows[r].runs)
        {
          this->splatPiece(
            { k, k + 1 }, rows[r].v0, rows[r].v1, run, { rows[r].bits }, patch, this->step());
        }
      }
    }
  }

  /// Calls f(step, v, pixels, worksheet, nullptr) for all worksheets of some slices and of pixels
  /// in some rows and columns, before finish(), from the first slice on or else reversed. A pixel
  /// without a sample is NaN. Steps as in ShearImage::winners.
  template <class F>
  void forSamples(const Span& slices, bool reversed, int v0, int v1, const Span& columns,
    Patch& patch, F&& f) const
  {
    this->forPieces(v0, v1, columns,
      [&](int first, int last, const Span& piece)
      {
        this->open(first, last, piece, patch);
        const Target worksheet = this->worksheetFor(first, last, piece, patch);
        const A none =
          this->Shared.range.special ? std::numeric_limits<A>::quiet_NaN() : leastValue<A>();
        for (int n = 0; n < slices.end - slices.begin; ++n)
        {
          const int k = reversed ? slices.end - 1 - n : slices.begin + n;
          this->splatSlice(
            k, reversed ? -1 : 1, first, last, piece, worksheet, patch,
            [&](int v, const Span& pixels) { this->put(none, v, pixels, worksheet); },
            [&](int v, const Span& pixels)
            { f(StepsPerSlice * k, v, pixels, worksheet.at(pixels.begin, v), nullptr); });
        }
      });
  }

  /// The same for all pixels of some rows, which are one run, and all slices of some layers, piece
  /// by piece, so that voxels are widened once.
  void splatAll(const Span& layers, int v0, int v1, const std::vector<Span>& all, Patch& patch,
    const SliceRuns* cuts = nullptr) const
  {
    const Span slices{ layers.begin * BrickDepth,
      std::min(layers.end * BrickDepth, this->Shared.geometry.size().z) };
    this->forPieces(v0, v1, all.front(),
      [&](int first, int last, const Span& columns)
      {
        this->open(first, last, columns, patch);
        this->splatPiece(slices, first, last, columns, { {}, cuts }, patch);
      });
  }

  /// What pixels start from, before finish(): no worksheet ends below.
  A floor() const
  {
    const double floor =
      std::clamp(this->Shared.floor, this->Shared.range.low, this->Shared.range.high);
    return static_cast<A>(floor) - this->Base;
  }

  /// Adds the base; rounding must not show values that the data do not have.
  void finish(int v0, int v1) const
  {
    const WorksheetLoops<A>& loops = this->Shared.kernels;
    for (int v = v0; v < v1; ++v)
    {
      const Span& span = this->Shared.image.spans[v];
      if (!span.empty())
      {
        loops.finish(this->Shared.image.template row<A>(v) + span.begin, this->Base,
          static_cast<A>(this->Shared.range.low), static_cast<A>(this->Shared.range.high),
          span.end - span.begin);
      }
    }
  }

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

  Target image() const
  {
    Target image;
    image.origin = this->Shared.image.template row<A>(0);
    image.stride = this->Shared.image.width;
    image.orders = this->Shared.orders;
    return image;
  }

private:
  /// Joins rows that are alike, so that they share rows of voxels: those of which all counts, and
  /// those with bits, which say what counts between the first run and the last. How many are left.
  static int joined(std::vector<RowRuns>& rows, int count)
  {
    int last = 0;
    for (int r = 0; r < count; ++r)
    {
      RowRuns& own = rows[r];
      if (own.bits.origin && !own.runs.empty())
      {
        own.runs.assign(1, { own.runs.front().begin, own.runs.back().end });
      }
      RowRuns& before = rows[last];
      const bool isAlike = r > 0 && !own.runs.empty() && !before.runs.empty() &&
        !own.bits.origin == !before.bits.origin;
      if (isAlike)
      {
        Span& run = before.runs.front();
        run = { std::min(run.begin, own.runs.front().begin),
          std::max(run.end, own.runs.front().end) };
        before.v1 = own.v1;
      }
      else if (r > 0 && ++last < r)
      {
        std::swap(rows[last], own);
      }
    }
    return last + 1;
  }

  /// Room for one worksheet.
  Target worksheetFor(int v0, int v1, const Span& columns, Patch& patch) const
  {
    const std::ptrdiff_t stride = columns.end - columns.begin;
    patch.worksheet.resize((v1 - v0) * stride * sizeof(A));
    A* const first = reinterpret_cast<A*>(patch.worksheet.data());
    Target worksheet;
    worksheet.origin = first - v0 * stride - columns.begin;
    worksheet.stride = stride;
    return worksheet;
  }

  static A baseOf(const VolumeIndex::Range& range)
  {
    // Only where the difference is exact: 64-bit integers have more bits than double.
    return std::numeric_limits<T>::is_integer && sizeof(T) < 8 ? static_cast<A>(range.low) : A(0);
  }

  /// Calls f for pieces of the image whose patch stays in the cache.
  template <class F>
  void forPieces(int v0, int v1, const Span& columns, F&& f) const
  {
    for (int v = v0; v < v1; v += this->PieceHeight)
    {
      for (int u = columns.begin; u < columns.end; u += this->PieceWidth)
      {
        f(v, std::min(v + this->PieceHeight, v1),
          Span{ u, std::min(u + this->PieceWidth, columns.end) });
      }
    }
  }

  void clear(Patch& patch, int v0, int v1, const Span& columns) const
  {
    patch.resize<A>(columns.end - columns.begin + this->Reach.columns, v1 - v0 + this->Reach.rows);
  }

  /// What says which samples count, where rays are cut: either, or nothing.
  struct SampleCuts
  {
    SliceBits bits;
    const SliceRuns* runs = nullptr;
  };

  /// Sets which of some pixels slice k changes, and leaves out of these what it does not. False if
  /// it changes none.
  bool cut(
    const SampleCuts& cuts, int k, int v0, int v1, Span& pixels, Target& target, Patch& patch) const
  {
    target.bits = cuts.bits;
    target.bit = static_cast<unsigned char>(1u << k % BrickDepth);
    if (!cuts.runs)
    {
      return true;
    }
    const SliceRuns::Hull hull = cuts.runs->hull({ k, k + 1 }, v0, v1);
    const Span all = common(pixels, hull.all);
    if (all.begin == pixels.begin && all.end == pixels.end)
    {
      return true;
    }
    const Span any = common(pixels, hull.any);
    if (any.empty())
    {
      return false;
    }
    // Loops take whole registers.
    pixels = common(pixels, { any.begin / RunUnit * RunUnit, any.end + RunUnit - 1 });
    target.whole = all;
    target.bits = this->bitsOf(*cuts.runs, k, v0, v1, pixels, patch);
    target.bit = 1;
    return true;
  }

  SliceBits bitsOf(
    const SliceRuns& runs, int k, int v0, int v1, const Span& pixels, Patch& patch) const
  {
    const std::ptrdiff_t stride = pixels.end - pixels.begin;
    patch.counts.resize(std::max<std::size_t>(patch.counts.size(), stride * (v1 - v0)));
    unsigned char* row = patch.counts.data();
    for (int v = v0; v < v1; ++v, row += stride)
    {
      const Span run = common(pixels, runs.at(k, v));
      std::fill_n(row, stride, static_cast<unsigned char>(0));
      if (!run.empty())
      {
        std::fill_n(
          row + (run.begin - pixels.begin), run.end - run.begin, static_cast<unsigned char>(1));
      }
    }
    return { patch.counts.data() - v0 * stride - pixels.begin, stride };
  }

  /// @param after  the step to the slice that comes after these, if it is known
  void splatPiece(const Span& slices, int v0, int v1, const Span& columns, const SampleCuts& cuts,
    Patch& patch, int after = 0) const
  {
    if (this->Shared.orders && !this->Notes)
    {
      this->notePiece(slices, v0, v1, columns, cuts, patch);
      return;
    }
    const int count = slices.end - slices.begin, step = this->step();
    for (int n = 0; n < count; ++n)
    {
      const int k = this->Shared.nth(slices, n);
      this->forRows(k, v0, v1, columns,
        [&](int first, int end, const Span& span)
        {
          Target target = this->image();
          Span pixels = span;
          if (!this->cut(cuts, k, first, end, pixels, target, patch))
          {
            return;
          }
          target.order = this->orderOfSlice(k);
          const int next = n + 1 < count ? step : after;
          if (!this->splatOwn(k, next, first, end, pixels, target, patch))
          {
            this->load(k, next, patch);
            this->splatRows(k, first, end, pixels, target, patch);
          }
        });
    }
  }

  /// From one slice to the next.
  int step() const { return this->Shared.nth({ 0, 2 }, 1) - this->Shared.nth({ 0, 2 }, 0); }

  std::int16_t orderOfSlice(int k) const
  {
    return static_cast<std::int16_t>(this->Shared.orderOfStep(StepsPerSlice * k));
  }

  /// The same by way of worksheets of their own, for splatRows() that do not note winners.
  void notePiece(const Span& slices, int v0, int v1, const Span& columns, const SampleCuts& cuts,
    Patch& patch) const
  {
    const RayLoops<A>& loops = this->Shared.kernels;
    const Target worksheet = this->worksheetFor(v0, v1, columns, patch);
    for (int n = 0; n < slices.end - slices.begin; ++n)
    {
      const int k = this->Shared.nth(slices, n);
      const std::int16_t order = this->orderOfSlice(k);
      this->splatSlice(
        k, this->step(), v0, v1, columns, worksheet, patch,
        [&](int v, const Span& pixels) { this->putBelowImage(v, pixels, worksheet); },
        [&](int v, Span pixels)
        {
          Target image = this->image();
          if (this->cut(cuts, k, v, v + 1, pixels, image, patch))
          {
            loops.raiseNoting(image.at(pixels.begin, v),
              image.orders + v * image.stride + pixels.begin, order, worksheet.at(pixels.begin, v),
              image.bits.origin ? image.bits.at(pixels.begin, v) : nullptr, image.bit,
              pixels.end - pixels.begin);
          }
        });
    }
  }

  void put(A value, int v, const Span& pixels, const Target& worksheet) const
  {
    std::fill(worksheet.at(pixels.begin, v), worksheet.at(pixels.end, v), value);
  }

  /// Values a little below those of the image, so that what is as large as the image shows, and no
  /// more is found out about what is smaller.
  void putBelowImage(int v, const Span& pixels, const Target& worksheet) const
  {
    const A* const image = this->Shared.image.template row<A>(v) + pixels.begin;
    A* const out = worksheet.at(pixels.begin, v);
    const std::ptrdiff_t count = pixels.end - pixels.begin;
    for (std::ptrdiff_t x = 0; x < count; ++x)
    {
      out[x] = image[x] - std::abs(image[x]) * (4 * std::numeric_limits<A>::epsilon()) -
        std::numeric_limits<A>::min();
    }
  }

  /// The worksheet of slice k alone (a step from the next one), in which pixels are as open(v,
  /// pixels) has set them or larger, then f(v, pixels) for its rows.
  template <class Open, class F>
  void splatSlice(int k, int step, int v0, int v1, const Span& columns, const Target& worksheet,
    Patch& patch, Open&& open, F&& f) const
  {
    this->forRows(k, v0, v1, columns,
      [&](int first, int end, const Span& span)
      {
        this->load(k, step, patch);
        for (int v = first; v < end; ++v)
        {
          open(v, span);
        }
        this->splatRows(k, first, end, span, worksheet, patch);
        for (int v = first; v < end; ++v)
        {
          f(v, span);
        }
      });
  }

  /// Calls f(first, end, span) for rows that slice k covers in the same columns: nearly always all
  /// of them at once.
  template <class F>
  void forRows(int k, int v0, int v1, const Span& columns, F&& f) const
  {
    const SliceGeometry& slice = this->Shared.sliceGeometry[k];
    const int end = std::min(v1, slice.vEnd);
    int first = std::max(v0, slice.vBegin);
    while (first < end)
    {
      const Span span = common(columns, this->Shared.pixels(first, k));
      int v = first + 1;
      while (v < end && same(span, common(columns, this->Shared.pixels(v, k))))
      {
        ++v;
      }
      if (!span.empty())
      {
        f(first, v, span);
      }
      first = v;
    }
  }

  static bool same(const Span& a, const Span& b)
  {
    return (a.begin == b.begin && a.end == b.end) || (a.empty() && b.empty());
  }

protected:
  /// Widens the voxels that worksheet k reads, as far as the patch does not have them.
  /// @param step  to the worksheet that comes next, 0 if none does
  void load(int k, int step, Patch& patch) const
  {
    const int last = this->Shared.geometry.size().z - 1;
    for (int s = std::max(k - this->Depth, 0); s <= std::min(k + this->Depth, last); ++s)
    {
      if (patch.sheet(s).slice != s)
      {
        const bool exists = s + step >= 0 && s + step <= last;
        patch.ahead = exists ? step * this->Shared.slices.sliceStride : 0;
        patch.sheet(s) = this->sheetOf(s, patch.rows.begin, patch.rows.end, patch.pixels);
        this->loadSheet(patch.sheet(s), patch);
      }
    }
  }

  /// The voxels of slice s that worksheets need for some pixels.
  virtual Patch::Sheet sheetOf(int s, int v0, int v1, const Span& columns) const = 0;

  virtual void loadSheet(const Patch::Sheet& sheet, Patch& patch) const
  {
    // Rows inside the volume go together, those beyond repeat the outermost.
    const int height = this->Shared.geometry.size().y;
    const int end = sheet.j + sheet.rows;
    const int low = std::clamp(0, sheet.j, end), high = std::clamp(height, low, end);
    for (int j = sheet.j; j < low; ++j)
    {
      this->loadRows(sheet, j, 0, 1, patch);
    }
    if (low < high)
    {
      this->loadRows(sheet, low, low, high - low, patch);
    }
    for (int j = high; j < end; ++j)
    {
      this->loadRows(sheet, j, height - 1, 1, patch);
    }
  }

  /// Fills rows of a sheet, from `to` on, with the volume's rows from `from` on.
  void loadRows(const Patch::Sheet& sheet, int to, int from, int rows, Patch& patch) const
  {
    const int width = this->Shared.geometry.size().x;
    const VoxelLoops<T>& loops = this->Shared.kernels;
    const int begin = std::clamp(-sheet.i, 0, sheet.columns);
    const int end = std::clamp(width - sheet.i, begin, sheet.columns);
    const T* voxels = this->Shared.voxelRow(from, sheet.slice);
    A* out = patch.voxel<A>(sheet.i, to, sheet.slice);
    if (begin < end)
    {
      loops.widen(voxels + sheet.i + begin, this->Shared.slices.rowStride, out + begin,
        patch.rowLength, this->Base, end - begin, rows, patch.ahead);
    }
    for (int r = 0; r < rows && (begin > 0 || end < sheet.columns); ++r)
    {
      std::fill(out, out + begin, static_cast<A>(voxels[0]) - this->Base);
      std::fill(out + end, out + sheet.columns, static_cast<A>(voxels[width - 1]) - this->Base);
      voxels += this->Shared.slices.rowStride;
      out += patch.rowLength;
    }
  }

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

  const Frame<T>& Shared;
  const WorksheetReach<A>& Reach;
  int Depth;
  bool Notes = false;                                ///< whether splatRows() notes winners
  int PieceWidth = 1024, PieceHeight = RowsTogether; ///< pixels; for the second-level cache
  A Base;
};
}

#endif
