// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What tests of the samples along rays share: volumes, cuts, and the comparison of an image with
 * what the reference makes of its samples.
 */
#ifndef ReductionTesting_h
#define ReductionTesting_h

#include "AverageTesting.h"
#include "CoreTesting.h"
#include "Reductions.h"
#include "Splat/Walks/Cuts.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace reductiontesting
{
using namespace coretesting;
using splatting::Quality;
using splatting::Reduction;

inline constexpr double Infinity = std::numeric_limits<double>::infinity();
inline const Reduction reductions[] = { Reduction::Maximum, Reduction::Minimum, Reduction::Mean,
  Reduction::DepthShaded, Reduction::Local };

template <class T>
constexpr bool isFloat = std::numeric_limits<T>::has_infinity;

/// Noise over the whole range, every other time of few levels, with plateaus along rays; of floats
/// one in three has NaN, and in the preview infinities.
template <class T>
reference::Volume<T> randomVolume(reference::Random& random, int largest, Quality quality)
{
  reference::Volume<T> volume = reference::uniformNoise<T>(randomSize(random, largest), random);
  const bool levels = random.uniform(0, 1);
  const int odd = isFloat<T> && random.oneIn(3) ? random.uniform(1, 5) : 0;
  reference::Random many = random.fork();
  for (T& voxel : volume.voxels)
  {
    if constexpr (!isFloat<T>)
    {
      const T step = std::numeric_limits<T>::max() / 4 + 1;
      voxel = levels ? static_cast<T>(voxel / step * step) : voxel;
    }
    else
    {
      voxel = levels ? std::round(voxel * T(4)) / T(4) : voxel;
      if (many.chance(odd / 10.0))
      {
        const T values[] = { std::numeric_limits<T>::quiet_NaN(),
          std::numeric_limits<T>::infinity(), -std::numeric_limits<T>::infinity() };
        voxel = values[quality == Quality::Preview ? std::max(0, many.uniform(-3, 2)) : 0];
      }
    }
  }
  return volume;
}

/// The samples of all rays in the type in which a mode has them.
template <class S>
reference::RaySamples<S> samplesOf(
  const reference::Volume<S>& volume, const splatting::ShearWarp& geometry, Quality quality)
{
  const reference::ImageRays rays = referenceRays(geometry);
  if constexpr (std::is_same_v<S, double>)
  {
    if (quality != Quality::Preview)
    {
      return reference::slabSamples(volume, rays, modeOf(quality).reference);
    }
  }
  return reference::voxelSamples(volume, rays);
}

/// How far samples and results may be off.
struct Bounds
{
  double sample = 0.0;
  double low = 0.0, high = 0.0; ///< of the volume
  double rounding = 0.0;        ///< of the accumulator, relative

  double magnitude() const { return std::max(std::abs(this->low), std::abs(this->high)); }

  /// Of a ray's samples. Weights and sums are rounded as errorBound() says; where a share w of the
  /// weights is left, dividing by it magnifies the error by 1 / w, and rounds the weights' sum as
  /// well. Infinity where so little is left that it may vanish.
  double ofSamples(double leastWeight) const
  {
    if (leastWeight > 1.0 - 1e-9)
    {
      return this->sample;
    }
    return leastWeight > 1e-3 ? 2.0 * this->sample / leastWeight : Infinity;
  }
  /// Sums of `count` doubles, a division, and the result in the accumulator's type.
  double ofMean(double error, std::size_t count) const
  {
    return error + this->magnitude() * ((count + 2) * 0x1p-53 + this->rounding);
  }
  /// low + (sample - low) f with f = ambient + (1 - n / N) rate <= F, where no value exceeds M:
  /// both operands of the difference are rounded (2 F M), the difference, f (four times) and the
  /// product (6 F 2 M), and the result and its low (2 F M + 2 M).
  double ofShade(double error, double factor) const
  {
    return factor * error + this->rounding * (16.0 * factor + 2.0) * this->magnitude();
  }
};

template <class T>
Bounds boundsOf(
  const reference::Volume<T>& volume, const splatting::ShearWarp& geometry, Quality quality)
{
  Bounds bounds;
  bounds.low = Infinity;
  bounds.high = -Infinity;
  for (T voxel : volume.voxels)
  {
    const double x = static_cast<double>(voxel);
    bounds.low = std::isfinite(x) ? std::min(bounds.low, x) : bounds.low;
    bounds.high = std::isfinite(x) ? std::max(bounds.high, x) : bounds.high;
  }
  if (bounds.low > bounds.high)
  {
    bounds.low = bounds.high = 0.0;
  }
  bounds.rounding = std::is_same_v<splatting::Accumulator<T>, float> ? 0x1p-24 : 0x1p-53;
  bounds.sample = averageBound<T>(geometry, modeOf(quality), bounds.low, bounds.high);
  return bounds;
}

/// What a pixel may be, and how far off.
template <class S>
struct Expected
{
  reference::Outcomes<S> exact;        ///< Maximum, Minimum, Local
  reference::Outcomes<double> inexact; ///< Mean, DepthShaded
  double bound = 0.0;
};

template <class S>
Expected<S> expectedOf(const reference::CutRay<S>& ray, const splatting::ProjectionSettings& s,
  const Bounds& bounds, double base)
{
  const double error = bounds.ofSamples(ray.leastWeight);
  Expected<S> expected;
  expected.bound = error;
  switch (s.reduction)
  {
    case Reduction::Maximum:
      expected.exact = reference::largest(ray);
      break;
    case Reduction::Minimum:
      expected.exact = reference::smallest(ray);
      break;
    case Reduction::Local:
      expected.exact = reference::firstLocalMaximum(ray, s.threshold, error);
      break;
    case Reduction::Mean:
      expected.inexact = reference::mean(reference::toDouble(ray), s.meanLow, s.meanHigh, error);
      expected.bound = bounds.ofMean(error, ray.samples.size());
      break;
    case Reduction::DepthShaded:
      expected.inexact =
        reference::depthShaded(reference::toDouble(ray), base, s.ambient, s.changeRate);
      expected.bound = bounds.ofShade(error, s.ambient + std::abs(s.changeRate));
      break;
    case Reduction::Signed:
      break; // two projections, see TestSignedMaximum
  }
  return expected;
}

/// Whether a pixel is one of the outcomes; `bound` 0 means exactly.
template <class P, class S>
bool isOneOf(bool hit, P value, const reference::Outcomes<S>& outcomes, double bound)
{
  return std::any_of(outcomes.begin(), outcomes.end(),
    [&](const reference::Outcome<S>& outcome)
    {
      if (!hit || !outcome.hit || std::isnan(double(outcome.value)))
      {
        return hit == (outcome.hit && !std::isnan(double(outcome.value)));
      }
      if (bound == 0.0 || std::isinf(double(outcome.value)))
      {
        return static_cast<S>(value) == outcome.value;
      }
      return std::abs(double(value) - double(outcome.value)) <= bound;
    });
}

/// Pixels that were compared, and what was not quite sure about them.
struct Count
{
  int all = 0, open = 0, skipped = 0;
};

/// Of each reduction: the pixels of averages, and the scenes where nearly all are compared.
struct Comparisons
{
  Count pixels[5];
  Sightings scenes[5];

  void add(Reduction reduction, const Count& count)
  {
    Count& all = this->pixels[int(reduction)];
    all.all += count.all;
    all.open += count.open;
    all.skipped += count.skipped;
    this->scenes[int(reduction)].add(50 * (count.open + count.skipped) <= count.all);
  }
  void judge(Checks& check) const
  {
    for (Reduction reduction : reductions)
    {
      const Count& all = this->pixels[int(reduction)];
      const Sightings& compared = this->scenes[int(reduction)];
      std::cout << "reduction " << int(reduction) << ": " << all.all << " pixels of averages, "
                << all.open << " open, " << all.skipped << " skipped; nearly all compared in "
                << compared << std::endl;
      check(compared.areEnough(0.4), "reduction ", int(reduction),
        ": nearly all pixels are compared in only ", compared);
    }
  }
};

/// Compares all pixels of one picture; returns how many are none of their outcomes.
template <class S>
int wrongPixels(const splatting::ShearImage& image, const reference::RaySamples<S>& rays,
  const reference::RayCutter& cutter, const Case& c, const Bounds& bounds, double base,
  Count& count)
{
  return splatting::dispatch(image.type,
    [&](auto* null)
    {
      using P = std::remove_pointer_t<decltype(null)>;
      reference::Image<P> found = toReference<P>(image);
      if (found.value.size() != rays.size())
      {
        return std::max(1, found.width * found.height);
      }
      forgetGrazes(
        c.geometry, [&](int u, int v) { return !rays[found.index(u, v)].empty(); }, found);
      int wrong = 0;
      for (int v = 0; v < found.height; ++v)
      {
        for (int u = 0; u < found.width; ++u)
        {
          const std::size_t pixel = found.index(u, v);
          const auto ray = reference::cutRay(rays[pixel], cutter, u, v, c.reversed);
          count.all += !rays[pixel].empty();
          if (std::isinf(bounds.ofSamples(ray.leastWeight)))
          {
            ++count.skipped;
            continue;
          }
          const Expected<S> e = expectedOf(ray, c.settings, bounds, base);
          count.open += e.exact.size() + e.inexact.size() > 1;
          wrong += !isOneOf(found.isHit(u, v), found.value[pixel], e.exact, e.bound) &&
            !isOneOf(found.isHit(u, v), found.value[pixel], e.inexact, e.bound);
        }
      }
      return wrong;
    });
}

/// One of the samples, as a level for comparisons. A double need not be a 64-bit integer's exact
/// value: the next one is as far from it for everybody.
template <class S>
double randomLevel(reference::Random& random, const reference::RaySamples<S>& rays)
{
  for (int trial = 0; trial < 20; ++trial)
  {
    const auto& ray = rays[random.uniform(0, int(rays.size()) - 1)];
    const double level =
      ray.empty() ? Infinity : double(ray[random.uniform(0, int(ray.size()) - 1)].value);
    if (std::isfinite(level))
    {
      return !isFloat<S> && sizeof(S) == 8 ? std::nextafter(level, Infinity) : level;
    }
  }
  return 0.0;
}

template <class S>
void chooseSettings(reference::Random& random, const reference::RaySamples<S>& rays,
  const Bounds& bounds, splatting::ProjectionSettings& s)
{
  s.ambient = random.uniform(0.05, 1.0);
  s.changeRate = !random.oneIn(4) ? random.uniform(0.0, 1.0) : -0.04;
  s.threshold = !random.oneIn(4) ? randomLevel(random, rays) : -Infinity;
  s.threshold = !random.oneIn(10) ? s.threshold : bounds.high;
  s.meanLow = -Infinity;
  s.meanHigh = Infinity;
  if (!random.oneIn(3))
  {
    // No level of plateaus: whole rays would hang on rounding errors of averages.
    const double range = bounds.high - bounds.low;
    s.meanLow = bounds.low + range * random.uniform(0.1, 0.5);
    s.meanHigh = bounds.high - range * random.uniform(0.1, 0.5);
  }
  // Both ends are in the range.
  if (random.oneIn(3) && s.quality == Quality::Preview)
  {
    s.meanLow = randomLevel(random, rays);
    s.meanHigh = random.oneIn(2) ? randomLevel(random, rays) : Infinity;
    s.meanHigh = std::max(s.meanLow, s.meanHigh);
  }
}

/// The picture does not depend on how it is made.
template <class T>
void testVariants(Checks& check, const reference::Volume<T>& volume, Case c,
  const splatting::ShearImage& expected, reference::Random& random)
{
  for (splatting::InstructionSet set : instructionSets)
  {
    c.settings.instructionSet = set;
    c.settings.acceleration = anyAcceleration(random);
    c.budget = random.oneIn(2) ? 0 : std::numeric_limits<std::size_t>::max();
    check(sameImages(projected(volume, c), expected), "type ", int(splatting::scalarTypeOf<T>()),
      ", mode ", int(c.settings.quality), ", reduction ", int(c.settings.reduction), ", axis ",
      c.geometry.principalAxis(), ": ", splatting::nameOf(set), ", acceleration ",
      int(c.settings.acceleration), " or a budget of ", c.budget, " changes the picture");
  }
}

/// All reductions, twice. Previews must be exact.
template <class T, class S>
void testReductions(Checks& check, const reference::Volume<T>& volume,
  const reference::Volume<S>& sampled, Case c, Quality quality, reference::Random& random,
  Comparisons& comparisons)
{
  const reference::RaySamples<S> rays = samplesOf(sampled, c.geometry, quality);
  const Bounds bounds = boundsOf(volume, c.geometry, quality);
  for (int cuts = 0; cuts < 2; ++cuts)
  {
    c.cuts = anyCuts(volume.size, random);
    c.settings.quality = quality;
    chooseSettings(random, rays, bounds, c.settings);
    for (Reduction reduction : reductions)
    {
      c.settings.reduction = reduction;
      const splatting::ShearImage image = projected(volume, c);
      const bool averages = reduction == Reduction::Mean || reduction == Reduction::DepthShaded;
      const splatting::ScalarType type = averages || quality != Quality::Preview
        ? splatting::scalarTypeOf<splatting::Accumulator<T>>()
        : splatting::scalarTypeOf<T>();
      check(image.type == type, "reduction ", int(reduction), " has pixels of another type");
      Count count;
      const int wrong = wrongPixels(image, rays, { referenceRays(c.geometry), c.cuts }, c, bounds,
        reference::lowestVoxel(volume), count);
      if (quality == Quality::Preview)
      {
        check(count.open + count.skipped == 0, "the preview is not exact");
      }
      else
      {
        comparisons.add(reduction, count);
      }
      check(wrong == 0, "type ", int(splatting::scalarTypeOf<T>()), ", mode ", int(quality),
        ", reduction ", int(reduction), ": ", wrong, " wrong pixels of ", rays.size(), "; axis ",
        c.geometry.principalAxis(), ", shear ", c.geometry.shear().x, " ", c.geometry.shear().y,
        ", eye ", c.geometry.eye().x, " ", c.geometry.eye().y, " ", c.geometry.eye().z, ", size ",
        volume.size[0], " ", volume.size[1], " ", volume.size[2], ", ",
        c.geometry.reversed() ? "reversed, " : "", c.cuts.halfSpaces.size(), " half-spaces, flags ",
        c.cuts.regions);
      testVariants(check, volume, c, image, random);
    }
  }
}

/// All reductions in the preview; that nothing else changes a picture in all modes.
template <class T>
void testLargeVolume(
  Checks& check, const reference::Volume<T>& volume, Case c, reference::Random& random)
{
  const auto rays = samplesOf(volume, c.geometry, Quality::Preview);
  const Bounds bounds = boundsOf(volume, c.geometry, Quality::Preview);
  for (Reduction reduction : reductions)
  {
    c.settings.reduction = reduction;
    c.settings.quality = Quality::Preview;
    chooseSettings(random, rays, bounds, c.settings);
    Count count;
    const splatting::ShearImage image = projected(volume, c);
    const double base = reference::lowestVoxel(volume);
    check(
      wrongPixels(image, rays, { referenceRays(c.geometry), c.cuts }, c, bounds, base, count) == 0,
      "large volume, axis ", c.geometry.principalAxis(), ", reduction ", int(reduction));
    for (Quality quality : { Quality::Preview, Quality::Standard, Quality::High })
    {
      c.settings.quality = quality;
      const splatting::ShearImage expected = projected(volume, c);
      testVariants(check, volume, c, expected, random);
      for (int threads : { 1, 2 })
      {
        vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads },
          [&]
          {
            check(sameImages(projected(volume, c), expected), threads, " threads change mode ",
              int(quality), ", reduction ", int(reduction));
          });
      }
    }
  }
}
}

#endif
