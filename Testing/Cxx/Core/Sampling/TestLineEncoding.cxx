// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Chains of voxels: they stand for the volume's voxels within the tolerance of delta encoding, are
// as long as they can be, and are sorted by value.
#include "LineTesting.h"

#include <algorithm>
#include <cmath>

using namespace linetesting;

namespace
{
/// The voxels that the rows' chains stand for.
template <class T>
reference::Volume<T> decoded(const LineIndex& index, const std::array<int, 3>& size)
{
  reference::Volume<T> volume(size);
  auto out = volume.voxels.begin();
  for (int k = 0; k < size[2]; ++k)
  {
    for (int j = 0; j < size[1]; ++j)
    {
      const splatting::LineRow<T> row = index.row<T>(j, k);
      for (std::ptrdiff_t c = 0; c < row.count; ++c)
      {
        out = std::fill_n(out, row.last[c] + 1, row.values[c]);
      }
    }
  }
  return volume;
}

/// Every chain is within the tolerance of each of its voxels, and as long as it can be.
template <class T>
void testDecoded(Checks& check)
{
  reference::forScenes(seriesOf<T>("decoded"), 20,
    [&](int, reference::Random& random)
    {
      const auto volume = anyVolume<T>(random);
      check(decoded<T>(makeLines(volume, {}), volume.size).voxels == volume.voxels,
        "chains of equal voxels are not the volume");
      const T high = *std::max_element(volume.voxels.begin(), volume.voxels.end());
      for (double levels : { 1.0, 8.0, 255.0 })
      {
        const auto found = decoded<T>(makeLines(volume, { LineOrder::Lines, levels }), volume.size);
        for (std::size_t v = 0; v < volume.voxels.size(); ++v)
        {
          const T x = volume.voxels[v], d = found.voxels[v];
          const long double difference =
            std::abs(static_cast<long double>(x) - static_cast<long double>(d));
          check(difference <= toleranceAt(x, high, levels), "type ",
            int(splatting::scalarTypeOf<T>()), ": ", double(d), " stands for ", double(x),
            " with tolerance ", levels);
        }
      }
    });
}

/// What chains there are in rows of which that is known.
void testChains(Checks& check)
{
  reference::Volume<std::uint8_t> volume({ 8, 1, 1 });
  volume.voxels = { 7, 7, 7, 9, 9, 5, 255, 255 };
  check(makeLines(volume, {}).chainCount() == 4, "four chains of equal voxels");
  // 8 levels at 0 are 7.8 at 7: from 0 to 14 for 7, from 2 to 16 for 9, from -2 to 12 for 5.
  check(makeLines(volume, { LineOrder::Lines, 8.0 }).chainCount() == 2, "7, 9 and 5 join");
  // Values may differ by twice the tolerance: 0 and 20 meet where 10 levels at 0 end.
  volume.voxels = { 0, 19, 0, 20, 0, 19, 0, 255 };
  check(makeLines(volume, { LineOrder::Lines, 10.0 }).chainCount() == 4,
    "0 and 19 join at 10, 0 and 20 do not: 9 levels are left at 20");
  volume = reference::Volume<std::uint8_t>({ 600, 1, 1 }, 3);
  check(makeLines(volume, {}).chainCount() == 3, "chains in rows are at most 256 voxels long");
  check(makeLines(volume, { LineOrder::SortedLines, 0.0 }).chainCount() == 1,
    "sorted chains are as long as they can be");
  volume = reference::Volume<std::uint8_t>({ 600, 1, 1 }, 0);
  check(makeLines(volume, { LineOrder::SortedVolume, 0.0 }).chainCount() == 0,
    "sorted orders leave out the lowest value of the type");
}

/// Runs go down, and hold chains in the order of memory.
void testSorting(Checks& check)
{
  reference::forScenes("sorting", 1,
    [&](int, reference::Random& random)
    {
      const auto volume = boxes<std::int16_t>({ 30, 20, 10 }, 9, random);
      const LineIndex slices = makeLines(volume, { LineOrder::SortedLines, 0.0 });
      for (int k = 0; k < volume.size[2]; ++k)
      {
        for (std::size_t r = slices.runsOf(k); r < slices.runsOf(k + 1); ++r)
        {
          const auto run = slices.run<std::int16_t, splatting::SliceChain>(r);
          check(r == slices.runsOf(k) ||
              run.value < slices.run<std::int16_t, splatting::SliceChain>(r - 1).value,
            "slice ", k, " is not sorted");
          check(
            std::is_sorted(run.begin, run.end,
              [](const auto& a, const auto& b) { return a.j < b.j || (a.j == b.j && a.i < b.i); }),
            "a run is not in the order of memory");
          for (auto chain = run.begin; chain < run.end; ++chain)
          {
            check(volume.at(chain->i, chain->j, k) == run.value, "a chain lies elsewhere");
          }
        }
      }
      const LineIndex all = makeLines(volume, { LineOrder::SortedVolume, 0.0 });
      for (std::size_t r = 0; r < all.runsOf(1); ++r)
      {
        const auto run = all.run<std::int16_t, splatting::VolumeChain>(r);
        check(r == 0 || run.value < all.run<std::int16_t, splatting::VolumeChain>(r - 1).value,
          "the volume is not sorted");
        for (auto chain = run.begin; chain < run.end; ++chain)
        {
          check(volume.at(chain->i, chain->j, chain->k) == run.value, "a chain lies elsewhere");
        }
      }
    });
}
}

int TestLineEncoding(int, char*[])
{
  Checks check;
  forEachType([&](auto* null) { testDecoded<std::remove_pointer_t<decltype(null)>>(check); });
  testChains(check);
  testSorting(check);
  return check.exitCode();
}
