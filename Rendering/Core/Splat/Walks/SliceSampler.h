// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The interface of a projection mode. Walks decide the order of slices and what is skipped, kernels
 * process weights and pointers, and a SliceSampler computes samples of pixels from slices.
 *
 * There are five samplers: preview and worksheets, for parallel and perspective views, and
 * worksheets from chains. Each mode is a file of its own, for all voxel types, and is accessed only
 * through ProjectionMode. A new mode implements these two classes.
 */
#ifndef splattingSliceSampler_h
#define splattingSliceSampler_h

#include "Splat/Projection/Project.h"
#include "Splat/Projection/ProjectionContext.h"
#include "Splat/Walks/Cuts.h"
#include "Splat/Walks/LoadedVoxels.h"

#include <functional>
#include <memory>
#include <tuple>
#include <type_traits>
#include <vector>

namespace splatting
{
/// Properties that walks use.
struct SamplerTraits
{
  bool perspective; ///< whether each tile reads its own window
  int beyond;       ///< slices beyond its own that a layer reads
  int runUnit;      ///< preferred multiple of pixels at which runs begin and end
};

/// Rows of pixels into which samples are taken: those of the image, or copies.
template <class P>
struct PixelRows
{
  P* origin; ///< pixel (0, 0), which need not exist
  std::ptrdiff_t stride;
  /// Distance to the rows of the next slice, if slices are taken separately.
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
 * Computes samples of pixels of type P from voxels of type T: voxels (P is T), or worksheets (P is
 * Accumulator<T>), before finish(). Slices are processed in layers of BrickDepth.
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

  /// The voxels that the pixels of a layer read, relative to the pixel.
  virtual VoxelWindow window(int) const { return {}; }
  /// In perspective the voxels of a layer that some columns (or rows) of pixels read, from first to
  /// last; may be outside the volume.
  virtual Span columnsOf(int, const Span&) const { return {}; }
  virtual Span rowsOf(int, const Span&) const { return {}; }

  // Bounds of a layer's samples relative to the largest voxel of its bricks in a tile. Used only if
  // a layer reads beyond its own slices. TileBounds computes
  //   value = own + share * max(0, neighbours - own),
  //   bound = value + slack * max(|value|, magnitude),
  // where `own` and `neighbours` are the largest voxels of the layer, and of the two beside it.
  // Bounds that are too high cost time, bounds that are too low lose samples.

  /// The largest weight, 0 to 1, of neighbouring layers' voxels in any sample of a layer.
  virtual P share(int) const { return 0; }
  /// The rounding error of a sample relative to its summands.
  virtual P slack() const { return 0; }
  /// The magnitude of the summands, relative to base(). It is used where the bound is smaller,
  /// because a sum near 0 may have voxels far below 0.
  virtual P magnitude() const { return 0; }

  /// What is subtracted from voxels.
  virtual P base() const { return 0; }
  /// The initial value of pixels. No sample is below it.
  virtual P floor() const = 0;

  /// Takes the samples of some slices of a layer into pixels of some rows and runs of columns, and
  /// possibly into pixels of these rows beside the runs. NaN is no sample. Volumes with infinities
  /// use forSamples().
  virtual void splat(const Span& slices, int v0, int v1, const std::vector<Span>& runs,
    const PixelRows<P>& pixels, LoadedVoxels& loaded) const = 0;

  /// The same for all slices of some layers, and for all pixels of some rows of the image, in the
  /// order that suits memory. `all` contains one run, a whole row.
  virtual void splatAll(const Span& layers, int v0, int v1, const std::vector<Span>& all,
    LoadedVoxels& loaded) const = 0;

  /// Samples of one step of the rays in a row of pixels, with steps as in ShearImage::winners, and
  /// a mask of the pixels that have the step, or nullptr if all do. A worksheet without a sample is
  /// NaN.
  using Samples = std::function<void(
    int step, int v, const Span& pixels, const P* samples, const unsigned char* present)>;
  /// Calls the function for all samples of some slices and of pixels in some rows and columns, in
  /// the order of the rays from the first slice on, or reversed.
  virtual void forSamples(const Span& slices, bool reversed, int v0, int v1, const Span& columns,
    LoadedVoxels& loaded, const Samples& f) const = 0;

  /// Converts samples of some rows to the image's scalars, after all slices.
  virtual void finish(int v0, int v1) const = 0;

private:
  SamplerTraits Traits;
};

/// Projects with a sampler, according to the context: see BandWalk and RayWalk.
template <class T, class P>
void walkBands(ProjectionContext& context, const SliceSampler<T, P>& sampler);
template <class T, class P>
void walkRays(ProjectionContext& context, const SliceSampler<T, P>& sampler);
template <class T, class P>
void walk(ProjectionContext& context, const SliceSampler<T, P>& sampler)
{
  context.byRays ? walkRays(context, sampler) : walkBands(context, sampler);
}

/// Calls body(v0, v1) for bands of rows, in parallel, until the observer stops them.
void forBands(int height, int rows, ProgressObserver& observer,
  const std::function<void(int v0, int v1)>& body);
/// Rows of a band: many, for long memory streams, but with enough bands for all threads.
int bandHeight(int rows);

/// Arguments for taking the values of another volume at winners.
struct AtWinners
{
  const VoxelArray& other;
  const ShearWarp& geometry;
  const std::vector<SliceGeometry>& slices;
  const ShearImage& projected;
  ShearImage& image;
};

/// A mode, and the work space that it keeps between frames.
class ProjectionMode
{
public:
  virtual ~ProjectionMode() = default;
  /// Walks a sampler for the voxel type.
  virtual void project(ProjectionContext& context) = 0;
  /// Call it after project(). Only for modes whose samples are voxels or averages.
  virtual void takeAtLocations(const AtWinners&) const = 0;
};

/// The mode of a Space, which has the data kept between frames for A = Accumulator<T>, and projects
/// voxels of type T; see ProjectionMode.
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
  void takeAtLocations(const AtWinners& winners) const override
  {
    dispatch(winners.other.type,
      [&](auto* null)
      {
        using T = std::remove_pointer_t<decltype(null)>;
        std::get<Space<Accumulator<T>>>(this->Spaces).template takeAtLocations<T>(winners);
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
