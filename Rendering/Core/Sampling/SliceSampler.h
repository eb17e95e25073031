// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a mode of projection is. Walks know the order in which slices are met and what can be left
 * out; kernels know weights and pointers; a SliceSampler says how slices become samples of pixels.
 *
 * There are five samplers: preview and worksheets, for parallel and perspective views, and one for
 * worksheets from chains. Each mode is a file of its own, for all types of voxels,
 * which the others enter by ProjectionMode alone. Who adds a mode implements these two classes.
 */
#ifndef splattingSliceSampler_h
#define splattingSliceSampler_h

#include "Clipping/Cuts.h"
#include "Projection/Project.h"
#include "Projection/ProjectionContext.h"
#include "Sampling/LoadedVoxels.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <tuple>
#include <type_traits>
#include <vector>

// For explicit instantiations: f of each type of voxels.
#define SPLATTING_INTEGERS(f)                                                                      \
  f(std::int8_t) f(std::uint8_t) f(std::int16_t) f(std::uint16_t) f(std::int32_t) f(std::uint32_t) \
    f(std::int64_t) f(std::uint64_t)
#define SPLATTING_TYPES(f) SPLATTING_INTEGERS(f) f(float) f(double)

namespace splatting
{
/// How a sampler is best walked.
struct SamplerTraits
{
  bool perspective; ///< whether each tile reads a window of its own
  int beyond;       ///< how many slices beyond its own a layer reads
  int runUnit;      ///< pixels whose multiples runs had best begin and end at
};

/// Rows of pixels that samples are taken into: the image's, or copies of them.
template <class P>
struct PixelRows
{
  P* origin; ///< pixel (0, 0), which need not exist
  std::ptrdiff_t stride;
  /// To the rows of the next slice, if slices are to be taken apart.
  std::ptrdiff_t sliceStride = 0;

  P* at(int u, int v) const { return this->origin + v * this->stride + u; }
  /// The rows of the n-th slice.
  PixelRows slice(int n) const
  {
    return { this->origin + n * this->sliceStride, this->stride, this->sliceStride };
  }
};
template <class P>
PixelRows<P> pixelsOf(ShearImage& image)
{
  return { image.row<P>(0), image.width };
}

/**
 * How voxels of type T become samples of pixels of type P: the voxels themselves (P is T), or
 * worksheets (P is Accumulator<T>), before finish(). Slices go in layers of BrickDepth.
 */
template <class T, class P>
class SliceSampler
{
public:
  explicit SliceSampler(const SamplerTraits& traits) : Traits(traits) {}
  virtual ~SliceSampler() = default;
  SliceSampler(const SliceSampler&) = delete;
  void operator=(const SliceSampler&) = delete;

  const SamplerTraits& traits() const { return this->Traits; }

  /// How far it reads: the voxels that the pixels of a layer read, relative to the pixel.
  virtual VoxelWindow window(int) const { return {}; }
  /// In perspective the voxels of a layer that some columns (or rows) of pixels read, from first to
  /// last; they may lie outside the volume.
  virtual Span columnsOf(int, const Span&) const { return {}; }
  virtual Span rowsOf(int, const Span&) const { return {}; }

  // How far samples of a layer can be above the largest of its voxels that bricks know in a tile.
  // Asked only where a layer reads beyond its own slices. TileBounds computes
  //   value = own + share * max(0, neighbours - own),
  //   bound = value + slack * max(|value|, magnitude),
  // where `own` and `neighbours` are the largest voxels of the layer, and of the two beside it.
  // Bounds that are too high cost time, one that is too low loses samples.

  /// The most that voxels of the layers beside it weigh in any sample of a layer, 0 to 1.
  virtual P share(int) const { return 0; }
  /// How far rounding can take a sample, as a share of the numbers that are added up.
  virtual P slack() const { return 0; }
  /// How large these numbers can be where the bound is small: less base(), as samples are. A sum
  /// near 0 may have voxels far below 0 in it.
  virtual P magnitude() const { return 0; }

  /// What is subtracted from voxels.
  virtual P base() const { return 0; }
  /// What pixels start from: no sample ends below.
  virtual P floor() const = 0;

  /// Takes the samples of some slices of a layer into pixels of some rows and runs of columns, and
  /// perhaps into pixels of these rows beside the runs. NaN is no sample; volumes with
  /// infinities go by forSamples().
  virtual void splat(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const PixelRows<P>& pixels, LoadedVoxels& loaded) const = 0;

  /// The same for all pixels of some of the image's rows, which are one run, and all slices of some
  /// layers, in the order that suits memory.
  virtual void splatAll(const Span& layers, int v0, int v1, const std::vector<Span>& all,
    LoadedVoxels& loaded) const = 0;

  /// The first step of the ray of pixel (u, v), from the viewer on, whose sample in some slices of
  /// a layer is above the limit; there is one. Where samples reach beyond their slices it is asked
  /// for one slice at a time.
  virtual int firstAbove(int /*u*/, int /*v*/, const Span& slices, P /*limit*/) const
  {
    return StepsPerSlice * slices.begin;
  }
  /// The number of the first sample of pixel (u, v) in slice k, which its ray crosses, among the
  /// steps of that slice; -1 if there is none.
  virtual int firstSample(int /*u*/, int /*v*/, int /*k*/) const { return 0; }

  /// Samples of one step of the rays in a row of pixels, steps as in ShearImage::winners; and which
  /// of the pixels have that step, or nullptr if all do. A worksheet that is none is NaN.
  using Samples = std::function<void(
    int step, int v, const Span& pixels, const P* samples, const unsigned char* present)>;
  /// Tells all samples of some slices and of pixels in some rows and columns, in the order of the
  /// rays if they come from the first slice, or else reversed.
  virtual void forSamples(const Span& slices, bool reversed, int v0, int v1, const Span& columns,
    LoadedVoxels& loaded, const Samples& f) const = 0;

  /// From samples to the image's scalars, for some rows, when all slices have been taken.
  virtual void finish(int v0, int v1) const = 0;

private:
  SamplerTraits Traits;
};

/// Projects by a sampler, as the context says: see BandWalk and RayWalk.
template <class T, class P>
void walkBands(ProjectionContext& context, const SliceSampler<T, P>& sampler);
/// After walkBands(), before SliceSampler::finish(): see WinnerWalk.
template <class T, class P>
void findWinners(ProjectionContext& context, const SliceSampler<T, P>& sampler);
template <class T, class P>
void walkRays(ProjectionContext& context, const SliceSampler<T, P>& sampler);
template <class T, class P>
void walk(ProjectionContext& context, const SliceSampler<T, P>& sampler)
{
  context.byRays ? walkRays(context, sampler) : walkBands(context, sampler);
}

/// Calls body(v0, v1) for bands of so many rows, in parallel, until the observer stops them.
void forBands(int height, int rows, ProgressObserver& observer,
  const std::function<void(int v0, int v1)>& body);
/// Rows of a band: many, for long streams through memory, but enough bands for all threads.
int bandHeight(int rows);

/// What another volume has where a projection found its winners.
struct AtWinners
{
  const VoxelArray& other;
  const ShearWarp& geometry;
  const std::vector<SliceGeometry>& slices;
  const ShearImage& projected;
  ShearImage& image;
};

/// A mode with the work space that it keeps between frames.
class ProjectionMode
{
public:
  virtual ~ProjectionMode() = default;
  /// Walks a sampler for the type of the voxels.
  virtual void project(ProjectionContext& context) = 0;
  /// After project(). Only for modes whose samples are voxels or averages.
  virtual void takeAtWinners(const AtWinners&) const = 0;
};

/// The mode that a Space is: what it keeps, A being Accumulator<T>, and how it projects voxels of
/// type T, as ProjectionMode does.
template <template <class A> class Space>
class TypedMode : public ProjectionMode
{
public:
  void project(ProjectionContext& context) override
  {
    dispatch(context.index.volume().type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        std::get<Space<Accumulator<T>>>(this->Spaces).template project<T>(context);
      });
  }
  void takeAtWinners(const AtWinners& winners) const override
  {
    dispatch(winners.other.type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        std::get<Space<Accumulator<T>>>(this->Spaces).template takeAtWinners<T>(winners);
      });
  }

private:
  std::tuple<Space<float>, Space<double>> Spaces;
};
std::unique_ptr<ProjectionMode> makePreview();
std::unique_ptr<ProjectionMode> makePerspectivePreview();
std::unique_ptr<ProjectionMode> makeWorksheets();
std::unique_ptr<ProjectionMode> makePerspectiveWorksheets();
std::unique_ptr<ProjectionMode> makeChains();
}

#endif
