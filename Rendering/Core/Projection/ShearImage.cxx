// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Projection/ShearImage.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <type_traits>

namespace splatting
{
namespace
{
/// Puts the pixels of a phase between those of others.
template <class T>
void scatter(
  const ShearImage& part, const T* from, int phases, const glm::ivec2& phase, T* to, int width)
{
  vtkSMPTools::For(0, part.height, 16,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (vtkIdType v = begin; v < end; ++v)
      {
        const T* const source = from + v * part.width;
        T* const target = to + (v * phases + phase.y) * width + phase.x;
        for (int u = 0; u < part.width; ++u)
        {
          target[u * phases] = source[u];
        }
      }
    });
}

/// Room for the pixels of all phases.
void begin(const ShearImage& part, int phases, ShearImage& whole)
{
  whole.type = part.type;
  whole.width = part.width * phases;
  whole.height = part.height * phases;
  const std::size_t bytes = std::size_t(whole.width) * whole.height * sizeOf(part.type);
  whole.bytes.resize(std::max(whole.bytes.size(), bytes));
  whole.winners.resize(part.winners.empty() ? 0 : std::size_t(whole.width) * whole.height);
  whole.nonFinite = false;
}

/// The pixels of a row that see the volume are neighbours, whatever phase they belong to.
void addSpans(const ShearImage& part, int phases, const glm::ivec2& phase, ShearImage& whole)
{
  for (int v = 0; v < part.height; ++v)
  {
    const Span& from = part.spans[v];
    if (from.empty())
    {
      continue;
    }
    Span& to = whole.spans[v * phases + phase.y];
    const int first = from.begin * phases + phase.x;
    const int end = (from.end - 1) * phases + phase.x + 1;
    to = to.empty() ? Span{ first, end } : Span{ std::min(to.begin, first), std::max(to.end, end) };
  }
}
}

void interleaveOutline(
  const ShearImage& part, int phases, const glm::ivec2& phase, ShearImage& whole)
{
  if (phase == glm::ivec2(0))
  {
    whole.spans.assign(whole.height, {});
    whole.mask.clear();
  }
  addSpans(part, phases, phase, whole);
  if (!part.mask.empty())
  {
    if (whole.mask.empty())
    {
      whole.mask.assign(std::size_t(whole.width) * whole.height, 1);
    }
    scatter(part, part.mask.data(), phases, phase, whole.mask.data(), whole.width);
  }
}

void interleave(const ShearImage& part, int phases, const glm::ivec2& phase, ShearImage& whole)
{
  if (phase == glm::ivec2(0))
  {
    begin(part, phases, whole);
  }
  dispatch(part.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      scatter(part, part.row<T>(0), phases, phase, whole.row<T>(0), whole.width);
    });
  interleaveOutline(part, phases, phase, whole);
  if (!part.winners.empty())
  {
    scatter(part, part.winners.data(), phases, phase, whole.winners.data(), whole.width);
  }
  whole.nonFinite = whole.nonFinite || part.nonFinite;
}
}
