// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Computes standard and high mode from chains of voxels [CS98, section 4]. At the ends of chains
 * the full footprint is evaluated. Between ends, where each row of the footprint is in one chain,
 * neighbouring pixels have the same worksheet. It is computed once, by the same operations in the
 * same order, and so has the same bits.
 */
#ifndef splattingLineWorksheets_h
#define splattingLineWorksheets_h

#include "Splat/Chains/LineIndex.h"
#include "Splat/Sampling/ParallelWorksheets.h"

namespace splatting
{
template <class T>
class LineWorksheets : public ParallelWorksheets<T>
{
public:
  using typename ParallelWorksheets<T>::A;
  using typename ParallelWorksheets<T>::Target;

  /// @param index  in rows, of all voxels
  LineWorksheets(const ProjectionContext& context, const std::vector<SliceFootprint<A>>& footprints,
    const WorksheetReach<A>& reach, int depth, const LineIndex& index)
    : ParallelWorksheets<T>(context, footprints, reach, depth),
      Index(index)
  {
  }

protected:
  void loadSheet(const LoadedVoxels::Sheet& sheet, LoadedVoxels& loaded) const override
  {
    loaded.resizeRunEnds();
    const int last = this->Context.geometry.size().y - 1;
    for (int j = sheet.j; j < sheet.j + sheet.rows; ++j)
    {
      const int row = std::clamp(j, 0, last);
      if (j > sheet.j && row == std::clamp(j - 1, 0, last))
      {
        const A* const from = loaded.voxel<A>(sheet.i, j - 1, sheet.slice);
        const std::uint16_t* const ends = loaded.runEnd(sheet.i, j - 1, sheet.slice);
        std::copy(from, from + sheet.columns, loaded.voxel<A>(sheet.i, j, sheet.slice));
        std::copy(ends, ends + sheet.columns, loaded.runEnd(sheet.i, j, sheet.slice));
      }
      else
      {
        this->decode(this->Index.template row<T>(row, sheet.slice), sheet,
          loaded.voxel<A>(sheet.i, j, sheet.slice), loaded.runEnd(sheet.i, j, sheet.slice));
      }
    }
  }

  /// Chains may differ from the volume's voxels.
  bool splatOwn(int, int, int, int, const Span&, const Target&, LoadedVoxels&) const override
  {
    return false;
  }

  void splatRows(int k, int first, int end, const Span& span, const Target& target,
    LoadedVoxels& loaded) const override
  {
    for (int v = first; v < end; v += StripHeight)
    {
      this->splatStrip(k, v, std::min(v + StripHeight, end), span, target, loaded);
    }
  }

private:
  /// Rows of pixels whose footprints are tested together, as many as a register block has.
  static constexpr int StripHeight = 4;
  /// LeastRun: the least length of a run with one worksheet value that is faster. Register: the
  /// number of pixels of a register.
  static constexpr int LeastRun = 32, Register = 16;

  /// The voxels of the footprint in one loaded row, relative to the strip's first pixel.
  struct ReadRow
  {
    const std::uint16_t* ends;
    int column, columns;
  };
  struct ReadRows
  {
    std::array<ReadRow, 3 * (5 + StripHeight - 1)> rows;
    int count = 0;
  };

  /// Writes the columns of a sheet and, for each of them, the end of the run of its value.
  void decode(const LineRow<T>& chains, const LoadedVoxels::Sheet& sheet, A* voxels,
    std::uint16_t* ends) const
  {
    int begin = 0, end = 0; // of the run so far
    A value = 0;
    const auto write = [&]
    {
      std::fill(voxels + begin, voxels + end, value);
      std::fill(ends + begin, ends + end, static_cast<std::uint16_t>(end));
    };
    int i = 0;
    for (std::ptrdiff_t c = 0; c < chains.count && end < sheet.columns; ++c)
    {
      i += chains.last[c] + 1;
      // Beyond the volume the outermost voxels are repeated.
      const int next = c + 1 < chains.count ? std::min(i - sheet.i, sheet.columns) : sheet.columns;
      if (next <= end)
      {
        continue;
      }
      const A nextValue = static_cast<A>(chains.values[c]) - this->Base;
      if (nextValue != value)
      {
        write();
        begin = end;
      }
      value = nextValue;
      end = next;
    }
    write();
  }

  void splatStrip(
    int k, int v0, int v1, const Span& span, const Target& target, LoadedVoxels& loaded) const
  {
    const ReadRows rows = this->readRows(k, v0, v1, span.begin, loaded);
    int done = span.begin;
    for (int u = span.begin; u < span.end;)
    {
      int length = std::numeric_limits<int>::max();
      int skipped = 0;
      for (int r = 0; r < rows.count && skipped == 0; ++r)
      {
        const ReadRow& row = rows.rows[r];
        const int column = row.column + u - span.begin;
        const int left = row.ends[column] - column; // columns of the same value
        length = std::min(length, left - row.columns + 1);
        skipped = length < LeastRun ? left : 0;
      }
      if (skipped > 0)
      {
        u += skipped; // no long run starts before that
        continue;
      }
      const int end = std::min(u + length, span.end);
      this->splatMixed(k, v0, v1, { done, u }, span, target, loaded);
      this->splatRun(k, v0, v1, { u, end }, target, loaded);
      done = u = end;
    }
    this->splatMixed(k, v0, v1, { done, span.end }, span, target, loaded);
  }

  ReadRows readRows(int k, int v0, int v1, int u, LoadedVoxels& loaded) const
  {
    const SliceFootprint<A>& footprint = this->Footprints[k];
    const int last = this->Context.geometry.size().z - 1;
    ReadRows result;
    for (int p = 0; p < footprint.partCount; ++p)
    {
      const FootprintPart<A>& part = footprint.parts[p];
      const int slice = std::clamp(k + part.slice, 0, last);
      const LoadedVoxels::Sheet& sheet = loaded.sheet(slice);
      const int j = v0 - footprint.nearest.y + part.dj;
      for (int r = 0; r < part.rows + v1 - v0 - 1; ++r)
      {
        result.rows[result.count++] = { loaded.runEnd(sheet.i, j + r, slice),
          u - footprint.nearest.x + part.di - sheet.i, part.columns };
      }
    }
    return result;
  }

  /// Splats pixels with individual worksheets: a whole register if the span has as many.
  void splatMixed(int k, int v0, int v1, Span pixels, const Span& span, const Target& target,
    LoadedVoxels& loaded) const
  {
    if (!pixels.empty())
    {
      pixels.end = std::min(std::max(pixels.end, pixels.begin + Register), span.end);
      pixels.begin = std::max(std::min(pixels.begin, pixels.end - Register), span.begin);
      ParallelWorksheets<T>::splatRows(k, v0, v1, pixels, target, loaded);
    }
  }

  /// Splats pixels with the same worksheet in each row.
  void splatRun(
    int k, int v0, int v1, const Span& run, const Target& target, LoadedVoxels& loaded) const
  {
    A worksheet[StripHeight];
    std::fill_n(worksheet, StripHeight, leastValue<A>());
    Splat<A> splat = this->splatOf(
      k, v0, v1, { run.begin, run.begin + 1 }, { target.origin, target.stride }, loaded);
    splat.image = worksheet;
    splat.imageStride = 1;
    const WorksheetLoops<A>& loops = this->Context.kernels;
    loops.splat(splat);
    for (int v = v0; v < v1; ++v)
    {
      A* const row = target.at(0, v);
      const A value = worksheet[v - v0];
      for (int u = run.begin; u < run.end; ++u)
      {
        row[u] = std::max(row[u], value);
      }
    }
  }

  const LineIndex& Index;
};
}

#endif
