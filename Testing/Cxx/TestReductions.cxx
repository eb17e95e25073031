// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What becomes of the samples along rays equals its definition, sample by sample: five reductions,
// three modes, every scalar type, views from both sides, half-spaces, cropping and NaN. Memory,
// accelerations, instruction sets and threads do not change a bit.
#include "CoreTesting.h"
#include "Reductions.h"

#include "Cuts.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace coretesting;
using splatting::Quality;
using splatting::Reduction;

namespace
{
constexpr double Infinity = std::numeric_limits<double>::infinity();
const Reduction reductions[] = { Reduction::Maximum, Reduction::Minimum, Reduction::Mean,
  Reduction::DepthShaded, Reduction::Local };

template <class T>
constexpr bool isFloat = std::numeric_limits<T>::has_infinity;

/// Noise over the whole range, every other time of few levels, with plateaus along rays; of floats
/// one in three has NaN, and in the preview infinities.
template <class T>
reference::Volume<T> randomVolume(reference::Random& random, int largest, Quality quality)
{
  reference::Volume<T> volume = wholeRangeNoise<T>(randomSize(random, largest), random.bits());
  const bool levels = random.uniform(0, 1);
  const int odd = isFloat<T> && random.uniform(0, 2) == 0 ? random.uniform(1, 5) : 0;
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
      if (random.uniform(0, 9) < odd)
      {
        const T values[] = { std::numeric_limits<T>::quiet_NaN(),
          std::numeric_limits<T>::infinity(), -std::numeric_limits<T>::infinity() };
        voxel = values[quality == Quality::Preview ? std::max(0, random.uniform(-3, 2)) : 0];
      }
    }
  }
  return volume;
}

/// From either side of the volume, now and then with a matrix of negative w.
splatting::View viewFromAnySide(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::View view = anyView(size, random);
  const double side = random.uniform(0, 1) ? 1.0 : -1.0;
  const double w = random.uniform(0, 7) ? 1.0 : -1.0;
  for (int c = 0; c < 4; ++c)
  {
    view.indexToClip[c] *= w;
    view.indexToClip[c][2] *= side;
  }
  return view;
}

/// Whether the highest slice is nearest to the viewer: clip depth falls along +k of the ray.
bool isReversed(const splatting::View& view, const splatting::ShearWarp& geometry)
{
  glm::dvec4 ray(0.0);
  ray[geometry.axes()[0]] = -geometry.shear().x;
  ray[geometry.axes()[1]] = -geometry.shear().y;
  ray[geometry.axes()[2]] = 1.0;
  return (view.indexToClip * ray).z / view.indexToClip[3][3] < 0.0;
}

struct Case
{
  splatting::View view;
  splatting::ShearWarp geometry;
  splatting::ProjectionSettings settings;
  reference::RayCuts cuts;
  std::size_t budget = std::numeric_limits<std::size_t>::max();
};

std::array<double, 4> randomHalfSpace(reference::Random& random, const std::array<int, 3>& size)
{
  std::array<double, 4> h{ random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
    random.uniform(-1.0, 1.0), 0.0 };
  for (int a = 0; a < 3; ++a)
  {
    h[3] -= h[a] * random.uniform(0.0, double(size[a]));
  }
  return h;
}

/// None, some anywhere, one across an axis, or two that leave a slab which may be thinner than a
/// slice.
std::vector<std::array<double, 4>> randomHalfSpaces(
  reference::Random& random, const std::array<int, 3>& size)
{
  std::vector<std::array<double, 4>> halfSpaces;
  switch (random.uniform(0, 4))
  {
    case 0:
      break;
    case 1: // through voxel centres or between them
    {
      const int a = random.uniform(0, 2);
      std::array<double, 4> h{};
      h[a] = random.uniform(0, 1) ? 1.0 : -1.0;
      h[3] = -h[a] * 0.5 * random.uniform(0, 2 * size[a] - 2);
      halfSpaces.push_back(h);
      break;
    }
    case 2:
      halfSpaces.push_back(randomHalfSpace(random, size));
      halfSpaces.push_back(halfSpaces[0]);
      for (double& h : halfSpaces[1])
      {
        h = -h;
      }
      halfSpaces[1][3] += random.uniform(0.05, 2.5);
      break;
    default:
      for (int n = random.uniform(1, 3); n > 0; --n)
      {
        halfSpaces.push_back(randomHalfSpace(random, size));
      }
  }
  return halfSpaces;
}

/// Planes anywhere, on voxel centres, or closer than voxels.
void cropAtRandom(
  reference::Random& random, const std::array<int, 3>& size, reference::RayCuts& cuts)
{
  for (int a = 0; a < 3; ++a)
  {
    double p = random.uniform(-1.5, size[a] + 0.5), q = random.uniform(-1.5, size[a] + 0.5);
    if (random.uniform(0, 3) == 0)
    {
      p = std::round(p);
      q = std::round(q);
    }
    else if (random.uniform(0, 3) == 0)
    {
      q = p + random.uniform(0.0, 0.7);
    }
    cuts.planes[a] = { std::min(p, q), std::max(p, q) };
  }
  cuts.regions = static_cast<unsigned>(random.bits() & random.bits()) & ((1u << 27) - 1);
}

splatting::Cropping croppingOf(const reference::RayCuts& cuts)
{
  splatting::Cropping cropping;
  for (int a = 0; a < 3; ++a)
  {
    cropping.planes[a] = { cuts.planes[a][0], cuts.planes[a][1] };
  }
  cropping.flags = cuts.regions;
  return cropping;
}

template <class T>
splatting::ShearImage projected(const reference::Volume<T>& volume, const Case& c)
{
  std::vector<glm::dvec4> halfSpaces;
  for (const auto& h : c.cuts.halfSpaces)
  {
    halfSpaces.push_back({ h[0], h[1], h[2], h[3] });
  }
  const splatting::Cuts cuts = cutsBy(c.geometry, halfSpaces, croppingOf(c.cuts));
  splatting::VolumeIndex index;
  index.setBudget(c.budget);
  index.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) });
  splatting::Projector projector;
  splatting::ShearImage image;
  projector.project(index, c.geometry, c.settings, cuts, image);
  return image;
}

bool sameImages(const splatting::ShearImage& a, const splatting::ShearImage& b)
{
  return splatting::dispatch(a.type,
    [&](auto* null)
    {
      using P = std::remove_pointer_t<decltype(null)>;
      return a.type == b.type && sameBits(toReference<P>(a), toReference<P>(b));
    });
}

/// The samples of all rays in the type in which a mode has them.
template <class S>
reference::RaySamples<S> samplesOf(
  const reference::Volume<S>& volume, const reference::ShearView& view, Quality quality)
{
  if constexpr (std::is_same_v<S, double>)
  {
    if (quality != Quality::Preview)
    {
      const reference::Kernel kernel{ quality == Quality::Standard ? reference::Kernel::Nearest
                                                                   : reference::Kernel::Trilinear,
        1.0 };
      return reference::slabSamples(volume, view, kernel);
    }
  }
  return reference::voxelSamples(volume, view);
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
Bounds boundsOf(const reference::Volume<T>& volume, Quality quality)
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
  if (quality != Quality::Preview)
  {
    // The reference itself is good to some rounding errors of double.
    bounds.sample =
      errorBound<T>(quality, bounds.low, bounds.high) + 2e-13 * bounds.magnitude() + 1e-300;
  }
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

/// Compares all pixels of one picture; returns how many are none of their outcomes.
template <class S>
int wrongPixels(const splatting::ShearImage& image, const reference::RaySamples<S>& rays,
  const reference::ShearGrid& grid, const Case& c, const Bounds& bounds, double base, Count& count)
{
  const reference::RayCutter cutter(grid, referenceView(c.geometry), c.cuts);
  const bool reversed = isReversed(c.view, c.geometry);
  return splatting::dispatch(image.type,
    [&](auto* null)
    {
      using P = std::remove_pointer_t<decltype(null)>;
      const reference::Image<P> found = toReference<P>(image);
      if (found.width != grid.width || found.height != grid.height)
      {
        return found.width * found.height;
      }
      int wrong = 0;
      for (int v = 0; v < grid.height; ++v)
      {
        for (int u = 0; u < grid.width; ++u)
        {
          const std::size_t pixel = found.index(u, v);
          const auto ray = reference::cutRay(rays[pixel], cutter, u, v, reversed);
          ++count.all;
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
  s.changeRate = random.uniform(0, 3) ? random.uniform(0.0, 1.0) : -0.04;
  s.threshold = random.uniform(0, 3) ? randomLevel(random, rays) : -Infinity;
  s.threshold = random.uniform(0, 9) ? s.threshold : bounds.high;
  s.meanLow = -Infinity;
  s.meanHigh = Infinity;
  if (random.uniform(0, 2))
  {
    // No level of plateaus: whole rays would hang on rounding errors of averages.
    const double range = bounds.high - bounds.low;
    s.meanLow = bounds.low + range * random.uniform(0.1, 0.5);
    s.meanHigh = bounds.high - range * random.uniform(0.1, 0.5);
  }
  if (random.uniform(0, 2) == 0 && s.quality == Quality::Preview)
  {
    s.meanLow = randomLevel(random, rays);
  }
}

/// The picture does not depend on how it is made.
template <class T>
void testVariants(Checks& check, const reference::Volume<T>& volume, Case c,
  const splatting::ShearImage& expected, reference::Random& random)
{
  for (int n = 0; n < 3; ++n)
  {
    c.settings.instructionSet = static_cast<splatting::InstructionSet>(n);
    c.settings.acceleration = static_cast<splatting::Acceleration>(random.uniform(0, 5));
    c.budget = random.uniform(0, 1) ? 0 : std::numeric_limits<std::size_t>::max();
    check(sameImages(projected(volume, c), expected), "type ", int(splatting::scalarTypeOf<T>()),
      ", mode ", int(c.settings.quality), ", reduction ", int(c.settings.reduction), ", axis ",
      c.geometry.principalAxis(), ": instruction set ", n, ", acceleration ",
      int(c.settings.acceleration), " or a budget of ", c.budget, " changes the picture");
  }
}

template <class T, class S>
void testReductions(Checks& check, const reference::Volume<T>& volume,
  const reference::Volume<S>& sampled, Quality quality, reference::Random& random,
  Count (&counts)[5])
{
  Case c;
  c.view = viewFromAnySide(volume.size, random);
  c.geometry = splatting::ShearWarp(c.view);
  check(c.geometry.reversed() == isReversed(c.view, c.geometry), "the viewer is on another side");
  const reference::ShearView view = referenceView(c.geometry);
  const reference::ShearGrid grid = reference::makeShearGrid(volume.size, view);
  const reference::RaySamples<S> rays = samplesOf(sampled, view, quality);
  const Bounds bounds = boundsOf(volume, quality);
  for (int cuts = 0; cuts < 2; ++cuts)
  {
    c.cuts = {};
    c.cuts.halfSpaces = randomHalfSpaces(random, volume.size);
    if (random.uniform(0, 1))
    {
      cropAtRandom(random, volume.size, c.cuts);
    }
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
      const int wrong = wrongPixels(
        image, rays, grid, c, bounds, reference::lowestVoxel(volume), counts[int(reduction)]);
      check(wrong == 0, "type ", int(splatting::scalarTypeOf<T>()), ", mode ", int(quality),
        ", reduction ", int(reduction), ": ", wrong, " wrong pixels of ", grid.width * grid.height,
        "; axis ", view.axis, ", shear ", view.shear[0], " ", view.shear[1], ", size ",
        volume.size[0], " ", volume.size[1], " ", volume.size[2], ", ",
        c.geometry.reversed() ? "reversed, " : "", c.cuts.halfSpaces.size(), " half-spaces, flags ",
        c.cuts.regions);
      testVariants(check, volume, c, image, random);
    }
  }
}

template <class T>
void testType(Checks& check, std::uint64_t seed)
{
  reference::Random random(seed);
  Count preview[5], averages[5];
  for (int n = 0; n < 80; ++n)
  {
    const auto volume = randomVolume<T>(random, 12, Quality::Preview);
    testReductions(check, volume, volume, Quality::Preview, random, preview);
  }
  for (int n = 0; n < 24; ++n)
  {
    const Quality quality = n % 2 ? Quality::Standard : Quality::High;
    const auto volume = randomVolume<T>(random, 6, quality);
    testReductions(check, volume, reference::toDouble(volume), quality, random, averages);
  }
  std::cout << "type " << int(splatting::scalarTypeOf<T>()) << ", pixels of averages:";
  for (Reduction reduction : reductions)
  {
    const Count& count = averages[int(reduction)];
    std::cout << " " << count.all << " (" << count.open << " open, " << count.skipped
              << " skipped)";
    check(preview[int(reduction)].open + preview[int(reduction)].skipped == 0,
      "the preview is not exact");
    check(count.open + count.skipped < 0.02 * count.all, "nearly all pixels are compared");
  }
  std::cout << std::endl;
}

/// Volumes of several bands, blocks of registers and bricks; threads.
template <class T>
void testLarge(Checks& check, std::uint64_t seed)
{
  reference::Random random(seed);
  const auto volume = wholeRangeNoise<T>({ 75, 50, 41 }, seed);
  for (int n = 0; n < 4; ++n)
  {
    const int axis = n % 3; // from both sides along the first one, where slices may be transposed
    Case c;
    c.view = viewWithShear(volume.size, axis, random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    c.view.indexToClip[axis][2] *= n % 2 ? 1.0 : -1.0;
    c.geometry = splatting::ShearWarp(c.view);
    c.cuts.halfSpaces = randomHalfSpaces(random, volume.size);
    if (axis)
    {
      cropAtRandom(random, volume.size, c.cuts);
    }
    const reference::ShearView view = referenceView(c.geometry);
    const auto grid = reference::makeShearGrid(volume.size, view);
    const auto rays = reference::voxelSamples(volume, view);
    const Bounds bounds = boundsOf(volume, Quality::Preview);
    for (Reduction reduction : reductions)
    {
      c.settings.reduction = reduction;
      c.settings.quality = Quality::Preview;
      chooseSettings(random, rays, bounds, c.settings);
      Count count;
      const splatting::ShearImage image = projected(volume, c);
      const double base = reference::lowestVoxel(volume);
      check(wrongPixels(image, rays, grid, c, bounds, base, count) == 0, "large volume, axis ",
        axis, ", reduction ", int(reduction));
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

/// What holds between pictures.
void testRelations(Checks& check)
{
  reference::Random random(8);
  int differ[5] = {};
  for (int n = 0; n < 30; ++n)
  {
    const auto volume = wholeRangeNoise<std::int16_t>(randomSize(random, 9), random.bits());
    Case c;
    c.view = viewFromAnySide(volume.size, random);
    c.geometry = splatting::ShearWarp(c.view);
    c.settings.quality = static_cast<Quality>(n % 3);
    Case far = c;
    for (int column = 0; column < 4; ++column)
    {
      far.view.indexToClip[column][2] *= -1.0;
    }
    far.geometry = splatting::ShearWarp(far.view);
    for (Reduction reduction : reductions)
    {
      c.settings.reduction = far.settings.reduction = reduction;
      far.settings.quality = c.settings.quality;
      differ[int(reduction)] += !sameImages(projected(volume, c), projected(volume, far));
    }
    c.settings.reduction = Reduction::Maximum;
    const splatting::ShearImage maximum = projected(volume, c);
    c.settings.reduction = Reduction::Local;
    c.settings.threshold = 1e9;
    check(sameImages(projected(volume, c), maximum), "no local maximum, and not the maximum");
    auto negative = volume;
    for (auto& voxel : negative.voxels)
    {
      voxel = static_cast<std::int16_t>(~voxel); // -1 - voxel
    }
    c.settings.quality = Quality::Preview;
    c.settings.reduction = Reduction::Maximum;
    auto negated = toReference<std::int16_t>(projected(negative, c));
    for (std::size_t p = 0; p < negated.value.size(); ++p)
    {
      negated.value[p] = static_cast<std::int16_t>(negated.hit[p] ? ~negated.value[p] : 0);
    }
    c.settings.reduction = Reduction::Minimum;
    check(sameBits(toReference<std::int16_t>(projected(volume, c)), negated),
      "the minimum is not the negative's maximum");
  }
  check(!differ[int(Reduction::Maximum)] && !differ[int(Reduction::Minimum)] &&
      differ[int(Reduction::Mean)] == 0,
    "the far side has another maximum, minimum or mean");
  check(differ[int(Reduction::DepthShaded)] > 20 && differ[int(Reduction::Local)] > 10,
    "depth shades and local maxima are the same from the far side");
}
}

int TestReductions(int, char*[])
{
  Checks check;
  std::uint64_t seed = 900;
  forEachType([&](auto* null) { testType<std::remove_pointer_t<decltype(null)>>(check, ++seed); });
  testLarge<std::uint8_t>(check, 1);
  testLarge<std::int32_t>(check, 2);
  testLarge<float>(check, 3);
  testRelations(check);
  return check.result();
}
