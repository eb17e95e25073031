// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Chains/LineIndex.h"

#include "Common/Parallel.h"
#include "Splat/Chains/LineEncoder.h"
#include "Splat/Projection/ProjectionContext.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <tuple>

namespace splatting
{
namespace
{
/// A chain before sorting.
template <class T, class Chain>
struct Item
{
  T value;
  Chain chain;
};

int sliceOf(const SliceChain&)
{
  return 0;
}
int sliceOf(const VolumeChain& chain)
{
  return chain.k;
}

/// Descending values; chains of equal value in memory order.
template <class T, class Chain>
bool precedes(const Item<T, Chain>& a, const Item<T, Chain>& b)
{
  const auto place = [](const Chain& c) { return std::make_tuple(sliceOf(c), c.j, c.i); };
  return a.value > b.value || (a.value == b.value && place(a.chain) < place(b.chain));
}

void setSlice(SliceChain&, int) {}
void setSlice(VolumeChain& chain, int k)
{
  chain.k = static_cast<std::uint16_t>(k);
}

template <class T>
void append(std::vector<unsigned char>& bytes, const T* values, std::size_t count)
{
  const auto* const from = reinterpret_cast<const unsigned char*>(values);
  bytes.insert(bytes.end(), from, from + count * sizeof(T));
}

template <class T>
T largestVoxel(const Slices& slices, const glm::ivec3& size)
{
  std::vector<T> largest(size.z, leastValue<T>());
  parallelFor(0, size.z, 0,
    [&](std::ptrdiff_t first, std::ptrdiff_t last)
    {
      for (std::ptrdiff_t k = first; k < last; ++k)
      {
        for (int j = 0; j < size.y; ++j)
        {
          const T* const row = static_cast<const T*>(slices.voxels) + j * slices.rowStride +
            std::ptrdiff_t(k) * slices.sliceStride;
          largest[k] = std::max(largest[k], *std::max_element(row, row + size.x));
        }
      }
    });
  return *std::max_element(largest.begin(), largest.end());
}
}

/// Encodes some slices at a time in parallel, and appends them in order.
template <class T>
class LineIndex::Builder
{
public:
  Builder(LineIndex& index, const Slices& slices, const glm::ivec3& size)
    : Index(index),
      Source(slices),
      Size(size),
      Limit(index.Encoding.tolerance,
        index.Encoding.tolerance > 0.0 ? largestVoxel<T>(slices, size) : T())
  {
  }

  void build(const Progress& progress)
  {
    switch (this->Index.Encoding.order)
    {
      case LineOrder::Lines:
        this->Index.RowStarts.reserve(std::size_t(this->Size.y + 1) * this->Size.z);
        this->template encode<Rows>(progress,
          [this](const Rows& rows)
          {
            this->Index.SliceStarts.push_back(this->Index.Lasts.size());
            append(this->Index.Values, rows.values.data(), rows.values.size());
            this->Index.Lasts.insert(this->Index.Lasts.end(), rows.lasts.begin(), rows.lasts.end());
            this->Index.RowStarts.insert(
              this->Index.RowStarts.end(), rows.starts.begin(), rows.starts.end());
          });
        break;
      case LineOrder::SortedLines:
        this->template encode<Items<SliceChain>>(progress,
          [this](const Items<SliceChain>& items)
          { this->appendRuns(items.all, this->Index.SliceChains); });
        this->Index.RunStarts.push_back(this->Index.SliceChains.size());
        break;
      case LineOrder::SortedVolume:
      {
        std::vector<Item<T, VolumeChain>> all;
        this->template encode<Items<VolumeChain>>(progress,
          [&](const Items<VolumeChain>& items)
          { all.insert(all.end(), items.all.begin(), items.all.end()); });
        vtkSMPTools::Sort(all.begin(), all.end(), precedes<T, VolumeChain>);
        this->appendRuns(all, this->Index.VolumeChains);
        this->Index.RunStarts.push_back(this->Index.VolumeChains.size());
        break;
      }
    }
    this->finish();
  }

private:
  /// A slice row by row.
  struct Rows
  {
    std::vector<T> values;
    std::vector<std::uint8_t> lasts;
    std::vector<std::uint32_t> starts;

    void startRow(int) { this->starts.push_back(static_cast<std::uint32_t>(this->lasts.size())); }
    void add(T value, int begin, int end)
    {
      constexpr int most = std::numeric_limits<std::uint8_t>::max() + 1;
      for (; begin < end; begin += most)
      {
        this->values.push_back(value);
        this->lasts.push_back(static_cast<std::uint8_t>(std::min(end - begin, most) - 1));
      }
    }
    void finish(int) { this->startRow(0); }
  };

  /// A slice's chains, sorted.
  template <class Chain>
  struct Items
  {
    std::vector<Item<T, Chain>> all;
    int j = 0;

    void startRow(int row) { this->j = row; }
    void add(T value, int begin, int end)
    {
      if (value > leastValue<T>())
      {
        Item<T, Chain> item;
        item.value = value;
        item.chain.i = static_cast<std::uint16_t>(begin);
        item.chain.j = static_cast<std::uint16_t>(this->j);
        item.chain.last = static_cast<std::uint16_t>(end - begin - 1);
        this->all.push_back(item);
      }
    }
    void finish(int k)
    {
      for (Item<T, Chain>& item : this->all)
      {
        setSlice(item.chain, k);
      }
      std::sort(this->all.begin(), this->all.end(), precedes<T, Chain>);
    }
  };

  template <class Encoded, class Append>
  void encode(const Progress& progress, Append&& append)
  {
    constexpr int chunk = 32;
    for (int k = 0; k < this->Size.z; k += chunk)
    {
      std::vector<Encoded> slices(std::min(chunk, this->Size.z - k));
      parallelFor(0, static_cast<std::ptrdiff_t>(slices.size()), 1,
        [&](std::ptrdiff_t first, std::ptrdiff_t last)
        {
          for (std::ptrdiff_t s = first; s < last; ++s)
          {
            this->encodeSlice(k + static_cast<int>(s), slices[s]);
          }
        });
      for (const Encoded& slice : slices)
      {
        append(slice);
      }
      if (progress && !progress(double(std::min(k + chunk, this->Size.z)) / this->Size.z))
      {
        this->Index.Made = false;
        return;
      }
    }
  }

  template <class Encoded>
  void encodeSlice(int k, Encoded& slice) const
  {
    for (int j = 0; j < this->Size.y; ++j)
    {
      slice.startRow(j);
      this->encodeRow(static_cast<const T*>(this->Source.voxels) + j * this->Source.rowStride +
          k * this->Source.sliceStride,
        slice);
    }
    slice.finish(k);
  }

  template <class Encoded>
  void encodeRow(const T* row, Encoded& slice) const
  {
    const int width = this->Size.x;
    for (int i = 0; i < width;)
    {
      T value;
      const int end = chainEnd(row, i, width, this->Limit, value);
      slice.add(value, i, end);
      i = end;
    }
  }

  /// Sorted chains of a slice or of the volume.
  template <class Chain>
  void appendRuns(const std::vector<Item<T, Chain>>& items, std::vector<Chain>& chains)
  {
    this->Index.SliceStarts.push_back(this->Index.RunStarts.size());
    for (std::size_t n = 0; n < items.size(); ++n)
    {
      if (n == 0 || items[n].value != items[n - 1].value)
      {
        this->Index.RunStarts.push_back(chains.size());
        append(this->Index.Values, &items[n].value, 1);
      }
      chains.push_back(items[n].chain);
    }
  }

  /// Ends the last slice, and releases spare memory.
  void finish()
  {
    LineIndex& index = this->Index;
    index.SliceStarts.push_back(
      index.Encoding.order == LineOrder::Lines ? index.Lasts.size() : index.RunStarts.size() - 1);
    index.Values.shrink_to_fit();
    index.SliceStarts.shrink_to_fit();
    index.Lasts.shrink_to_fit();
    index.RunStarts.shrink_to_fit();
    index.SliceChains.shrink_to_fit();
    index.VolumeChains.shrink_to_fit();
  }

  LineIndex& Index;
  const Slices& Source;
  glm::ivec3 Size;
  Tolerance<T> Limit;
};

LineIndex::LineIndex(ScalarType type, const Slices& slices, const glm::ivec3& size,
  const LineEncoding& encoding, const Progress& progress)
  : Encoding(encoding),
    Made(true),
    Height(size.y)
{
  dispatch(type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      Builder<T>(*this, slices, size).build(progress);
    });
}

std::size_t LineIndex::chainCount() const
{
  return this->Lasts.size() + this->SliceChains.size() + this->VolumeChains.size();
}

std::size_t LineIndex::memorySize() const
{
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return bytes(this->Values) + bytes(this->SliceStarts) + bytes(this->RowStarts) +
    bytes(this->Lasts) + bytes(this->RunStarts) + bytes(this->SliceChains) +
    bytes(this->VolumeChains);
}
}
