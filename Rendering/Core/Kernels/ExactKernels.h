// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The loops of exact mode: maxima of cubics, and those of parallel views. For Kernels.cxx only,
 * which says why all of this is in an anonymous namespace.
 */
#ifndef splattingExactKernels_h
#define splattingExactKernels_h

#include "Kernels/ResamplingKernels.h"

#include <math.h>

#include <limits>

namespace splatting
{
namespace
{
/// Correctly rounded, as IEEE 754 has it, whatever the instruction set. C's functions, because
/// C++'s are inline: of those one copy, for any instruction set, would serve all.
inline float squareRoot(float x)
{
  return ::sqrtf(x);
}
inline double squareRoot(double x)
{
  return ::sqrt(x);
}
#if defined(__AVX512F__)
inline Pack<float> squareRoot(Pack<float> x)
{
  return _mm512_sqrt_ps(x);
}
inline Pack<double> squareRoot(Pack<double> x)
{
  return _mm512_sqrt_pd(x);
}
#elif defined(__AVX2__)
inline Pack<float> squareRoot(Pack<float> x)
{
  return _mm256_sqrt_ps(x);
}
inline Pack<double> squareRoot(Pack<double> x)
{
  return _mm256_sqrt_pd(x);
}
#elif defined(__SSE2__)
inline Pack<float> squareRoot(Pack<float> x)
{
  return _mm_sqrt_ps(x);
}
inline Pack<double> squareRoot(Pack<double> x)
{
  return _mm_sqrt_pd(x);
}
#elif defined(__GNUC__)
template <class R>
inline R squareRoot(R x)
{
  for (std::size_t n = 0; n < sizeof(R) / sizeof(x[0]); ++n)
  {
    x[n] = squareRoot(x[n]);
  }
  return x;
}
#endif

/// The peak of cubics between their ends, if they have one there, else `none`. Limited to their
/// largest coefficient: whether a peak is looked for must not change a pixel by rounding.
template <class A, class R>
inline R peakOf(const R (&b)[4], R inner, R none)
{
  // The derivative, d0 (1 - t)^2 + 2 d1 t (1 - t) + d2 t^2, from positive to negative.
  const R d0 = b[1] - b[0], d1 = b[2] - b[1], d2 = b[3] - b[2];
  const R half = d1 - d0, square = (d2 - d1) - half;
  const R discriminant = d1 * d1 - d0 * d2;
  const R zero = d0 - d0;
  const R root = squareRoot(discriminant > zero ? discriminant : zero);
  // Of the two forms of the same root the one that does not cancel.
  const R t = half >= zero ? (-half - root) / square : d0 / (root - half);
  const R s = A(1) - t;
  const R b01 = s * b[0] + t * b[1], b12 = s * b[1] + t * b[2], b23 = s * b[2] + t * b[3];
  const R value = s * (s * b01 + t * b12) + t * (s * b12 + t * b23);
  // What is no number compares with nothing.
  return ((t > zero) & (t < A(1))) ? smaller(value, inner) : none;
}

template <class R>
inline R between(R a, R b, R share)
{
  return a + share * (b - a);
}

/// The larger of the best so far and of the cubic from one place in a cell to another.
template <class A, class R>
inline R largestOnWay(const R (&corners)[8], const R (&from)[3], const R (&to)[3], R best)
{
  R near[4], far[4]; // along x, at either end
#pragma GCC unroll 4
  for (int n = 0; n < 4; ++n)
  {
    near[n] = between(corners[2 * n], corners[2 * n + 1], from[0]);
    far[n] = between(corners[2 * n], corners[2 * n + 1], to[0]);
  }
  const R near0[2] = { between(near[0], near[1], from[1]), between(near[2], near[3], from[1]) };
  const R near1[2] = { between(near[0], near[1], to[1]), between(near[2], near[3], to[1]) };
  const R far0[2] = { between(far[0], far[1], from[1]), between(far[2], far[3], from[1]) };
  const R far1[2] = { between(far[0], far[1], to[1]), between(far[2], far[3], to[1]) };
  const A third = A(1) / A(3);
  // The blossom: the coordinates of one end mixed with those of the other in all ways.
  const R b[4] = { between(near0[0], near0[1], from[2]),
    third *
      (between(far0[0], far0[1], from[2]) + between(near1[0], near1[1], from[2]) +
        between(near0[0], near0[1], to[2])),
    third *
      (between(far1[0], far1[1], from[2]) + between(far0[0], far0[1], to[2]) +
        between(near1[0], near1[1], to[2])),
    between(far1[0], far1[1], to[2]) };
  R raised = larger(b[3], larger(b[0], best));
  const R inner = larger(b[1], b[2]);
  if (anyLarger(inner, raised))
  {
    raised = larger(peakOf<A>(b, inner, raised), raised);
  }
  return raised;
}

/// A register of elements of type A, or one of them, of type R.
template <class A, class R>
struct Lanes
{
  using M = decltype(R{} > R{});
  using I = Integer<A>;
  static constexpr bool single = std::is_same_v<R, A>;

  static R all(A value)
  {
    if constexpr (single)
    {
      return value;
    }
    else
    {
      return Pack<A>{} + value;
    }
  }
  static R loadFrom(const A* p)
  {
    if constexpr (single)
    {
      return *p;
    }
    else
    {
      return load<A>(p);
    }
  }
  static void storeTo(A* p, R value)
  {
    if constexpr (single)
    {
      *p = value;
    }
    else
    {
      store<A>(p, value);
    }
  }
  /// The largest corner; minus infinity if one is NaN, so that such cells are left out.
  template <bool NonFinite>
  static inline R largestOf(const R (&corners)[8])
  {
    const R most = larger(larger(larger(corners[0], corners[1]), larger(corners[2], corners[3])),
      larger(larger(corners[4], corners[5]), larger(corners[6], corners[7])));
    if constexpr (NonFinite)
    {
      const R sum = ((corners[0] + corners[1]) + (corners[2] + corners[3])) +
        ((corners[4] + corners[5]) + (corners[6] + corners[7]));
      return sum == sum ? most : all(-std::numeric_limits<A>::infinity());
    }
    else
    {
      return most;
    }
  }

  /// Limits a raised pixel to the largest corner, which rounding can exceed. A pixel whose best is
  /// no less may be skipped, so it must not change if it is not skipped.
  static inline R limitedTo(R raised, R most, R best)
  {
    return larger(smaller(raised, most), best);
  }

  /// What pixels start from: minus infinity if they are NaN, which means without a sample.
  template <bool NonFinite>
  static inline R opened(R before)
  {
    return NonFinite ? (before == before ? before : all(-std::numeric_limits<A>::infinity()))
                     : before;
  }
  /// Stores what has been raised.
  template <bool NonFinite>
  static inline void close(A* pixels, R before, R best)
  {
    const R none = all(-std::numeric_limits<A>::infinity());
    storeTo(pixels, NonFinite ? (best > none ? best : before) : best);
  }
};

/// The largest value between the ends of a side, from the three voxels that follow each other, of
/// which the last counts only if it crosses.
template <class A, class R>
inline R largestBetween(const BoxSide<A>& side, R a, R b, R c)
{
  const R first = a + side.begin * (b - a);
  return side.crosses ? larger(first, larger(b, b + side.end * (c - b)))
                      : larger(first, a + side.end * (b - a));
}

/// What the field is at most where its ray passes a voxel: between two slices it is between what
/// these have, and half of it at least is of the nearer one.
template <class A, class R>
inline R largestAt(const PathBox<A>& box, std::ptrdiff_t at)
{
  using L = Lanes<A, R>;
  const R own = L::loadFrom(box.own + at);
  const R others = larger(L::loadFrom(box.before + at), L::loadFrom(box.behind + at));
  return larger(own, A(0.5) * (own + others));
}

/// The largest values in the boxes of a register of pixels, row after row.
template <class A, class R>
class BoxRows
{
public:
  /// @param at  from the voxels of pixel (0, 0) to those of the first pixel
  BoxRows(const PathBox<A>& box, std::ptrdiff_t stride, std::ptrdiff_t at)
    : Box(box),
      Stride(stride),
      At(at)
  {
    this->Rows[0] = this->takeRow();
    this->Rows[1] = box.rows.crosses ? this->takeRow() : this->Rows[0];
  }

  inline R take()
  {
    const R next = this->takeRow();
    const R largest = this->Box.rows.crosses
      ? largestBetween(this->Box.rows, this->Rows[0], this->Rows[1], next)
      : largestBetween(this->Box.rows, this->Rows[1], next, next);
    this->Rows[0] = this->Rows[1];
    this->Rows[1] = next;
    return largest;
  }

private:
  inline R takeRow()
  {
    const std::ptrdiff_t at = this->At;
    this->At += this->Stride;
    const R a = largestAt<A, R>(this->Box, at), b = largestAt<A, R>(this->Box, at + 1);
    const BoxSide<A>& side = this->Box.columns;
    return largestBetween(side, a, b, side.crosses ? largestAt<A, R>(this->Box, at + 2) : b);
  }

  const PathBox<A>& Box;
  std::ptrdiff_t Stride, At;
  R Rows[2]; // the last two
};

/// The cubics of a parallel view.
template <class A, class R, bool NonFinite>
struct CubicLoop : Lanes<A, R>
{
  using typename Lanes<A, R>::M;
  using typename Lanes<A, R>::I;
  using Lanes<A, R>::all;
  using Lanes<A, R>::loadFrom;
  const Cubics<A>& cubics;

  explicit CubicLoop(const Cubics<A>& own) : cubics(own) {}

  inline void loadCorners(const CubicSegment<A>& segment, std::ptrdiff_t at, R (&corners)[8]) const
  {
    const A* const rows[4] = { segment.low + at, segment.low + at + this->cubics.sourceStride,
      segment.high + at, segment.high + at + this->cubics.sourceStride };
#pragma GCC unroll 8
    for (int n = 0; n < 8; ++n)
    {
      corners[n] = loadFrom(rows[n / 2] + n % 2);
    }
  }

  static inline R combine(const A* weights, const R (&corners)[8])
  {
    R sum = weights[0] * corners[0];
#pragma GCC unroll 8
    for (int n = 1; n < 8; ++n)
    {
      sum = sum + weights[n] * corners[n];
    }
    return sum;
  }

  /// The field at the start of segment p as the end of the one before has it or, where that has
  /// NaN, as its own cell has it.
  inline R numberOf(R start, int p, const R (&corners)[8]) const
  {
    if constexpr (NonFinite)
    {
      return start == start ? start : combine(this->cubics.segments[p].weights, corners);
    }
    else
    {
      (void)p;
      (void)corners;
      return start;
    }
  }

  /// The field at the start of segment p, which is the end of the one before.
  inline R startOf(int p, const R (&corners)[8], std::ptrdiff_t at) const
  {
    if (p == 0)
    {
      return combine(this->cubics.segments[0].weights, corners);
    }
    const CubicSegment<A>& before = this->cubics.segments[p - 1];
    R others[8];
    this->loadCorners(before, at, others);
    return this->numberOf(combine(before.weights + 24, others), p, corners);
  }

  /// The pixels from (x, v) on that a segment counts for.
  inline M counting(const CubicSegment<A>& segment, std::ptrdiff_t x, std::ptrdiff_t v) const
  {
    const auto inRow = [=](const Span* pixels)
    { return v >= pixels[1].begin && v < pixels[1].end ? pixels[0] : Span{}; };
    const Span field = this->cubics.field[v], own = inRow(segment.inField),
               boxes = inRow(segment.inBoxes);
    M lane;
    if constexpr (std::is_same_v<R, A>)
    {
      const Span& span = x >= field.begin && x < field.end ? own : boxes;
      lane = x >= span.begin && x < span.end;
      return lane;
    }
    else
    {
      for (std::ptrdiff_t n = 0; n < width<A>; ++n)
      {
        lane[n] = static_cast<I>(x + n);
      }
      const auto inSpan = [&lane](const Span& span)
      { return (lane >= static_cast<I>(span.begin)) & (lane < static_cast<I>(span.end)); };
      const M inField = inSpan(field);
      return (inField & inSpan(own)) | (~inField & inSpan(boxes));
    }
  }

  /// Whether all segments count for all of a register's pixels, which see the field.
  inline bool allCount(std::ptrdiff_t x, std::ptrdiff_t v) const
  {
    const auto inSpan = [](const Span& span, std::ptrdiff_t begin, std::ptrdiff_t end)
    { return begin >= span.begin && end <= span.end; };
    bool all = inSpan(this->cubics.field[v], x, x + width<A>);
    for (int p = 0; p < this->cubics.count; ++p)
    {
      const Span* const pixels = this->cubics.segments[p].inField;
      all = all && inSpan(pixels[0], x, x + width<A>) && inSpan(pixels[1], v, v + 1);
    }
    return all;
  }

  template <bool Masked>
  inline void run(std::ptrdiff_t x, std::ptrdiff_t v) const
  {
    const std::ptrdiff_t at = v * this->cubics.sourceStride + x;
    A* const pixels = this->cubics.image + v * this->cubics.imageStride + x;
    const R before = loadFrom(pixels);
    R best = Lanes<A, R>::template opened<NonFinite>(before);
    R b[4], corners[8];
    bool follows = false; // whether b[3] is where this segment starts
    for (int p = 0; p < this->cubics.count; ++p)
    {
      const CubicSegment<A>& segment = this->cubics.segments[p];
      this->loadCorners(segment, at, corners);
      const R most = Lanes<A, R>::template largestOf<NonFinite>(corners);
      if (!anyLarger(most, best))
      {
        follows = false;
        continue;
      }
      b[0] = follows ? this->numberOf(b[3], p, corners) : this->startOf(p, corners, at);
      b[3] = combine(segment.weights + 24, corners);
      follows = true;
      R raised = larger(b[3], larger(b[0], best));
      if (segment.curved)
      {
        b[1] = combine(segment.weights + 8, corners);
        b[2] = combine(segment.weights + 16, corners);
        const R inner = larger(b[1], b[2]);
        if (anyLarger(inner, raised))
        {
          raised = larger(peakOf<A>(b, inner, raised), raised);
        }
      }
      raised = Lanes<A, R>::limitedTo(raised, most, best);
      if constexpr (Masked)
      {
        raised = this->counting(segment, x, v) ? raised : best;
      }
      best = raised;
    }
    Lanes<A, R>::template close<NonFinite>(pixels, before, best);
  }

  /// All rows of a register of columns.
  inline void runRows(std::ptrdiff_t x) const
  {
    const Span& rows = this->cubics.rows;
    for (std::ptrdiff_t v = rows.begin; v < rows.end; ++v)
    {
      this->allCount(x, v) ? this->template run<false>(x, v) : this->template run<true>(x, v);
    }
  }

  /// The same, but for those that have seen more than their boxes have.
  inline void runRowsAboveBoxes(std::ptrdiff_t x) const
  {
    const Span& rows = this->cubics.rows;
    const std::ptrdiff_t stride = this->cubics.sourceStride;
    BoxRows<A, R> boxes(this->cubics.box, stride, rows.begin * stride + x);
    for (std::ptrdiff_t v = rows.begin; v < rows.end; ++v)
    {
      const R most = boxes.take() + this->cubics.box.slack;
      if (anyLarger(most, loadFrom(this->cubics.image + v * this->cubics.imageStride + x)))
      {
        this->allCount(x, v) ? this->template run<false>(x, v) : this->template run<true>(x, v);
      }
    }
  }
};

template <class A, bool NonFinite>
inline void raiseCubicRows(const Cubics<A>& cubics)
{
  constexpr std::ptrdiff_t w = width<A>;
  const std::ptrdiff_t begin = cubics.columns.begin, end = cubics.columns.end;
  if (end - begin < w)
  {
    for (std::ptrdiff_t v = cubics.rows.begin; v < cubics.rows.end; ++v)
    {
      for (std::ptrdiff_t x = begin; x < end; ++x)
      {
        CubicLoop<A, A, NonFinite>(cubics).template run<true>(x, v);
      }
    }
    return;
  }
  // A maximum may be taken twice, so the last register overlaps the one before.
  const CubicLoop<A, Pack<A>, NonFinite> loop(cubics);
  for (std::ptrdiff_t x = begin; x < end; x += w)
  {
    const std::ptrdiff_t at = x + w <= end ? x : end - w;
    NonFinite ? loop.runRows(at) : loop.runRowsAboveBoxes(at);
  }
}

/// One pixel's maximum is the same in a register and by itself.
template <class A>
void raiseCubics(const Cubics<A>& cubics)
{
  cubics.nonFinite ? raiseCubicRows<A, true>(cubics) : raiseCubicRows<A, false>(cubics);
}
}
}

#endif
