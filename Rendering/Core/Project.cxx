// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Project.h"

#include "BandWalk.h"
#include "Carry.h"
#include "LineWalk.h"
#include "LineWorksheets.h"
#include "ParallelWorksheets.h"
#include "PerspectiveExact.h"
#include "PerspectivePreview.h"
#include "PerspectiveWorksheets.h"
#include "Piece.h"
#include "RayWalk.h"
#include "WinnerFinder.h"

#include <vtkSMPThreadLocal.h>
#include <vtkSMPTools.h>

#include <functional>
#include <tuple>

namespace splatting
{
namespace
{
/// Rows of a band: many, for long streams through memory, but enough bands for all threads.
int bandHeight(int rows)
{
  const int share = rows / (4 * vtkSMPTools::GetEstimatedNumberOfThreads());
  return std::clamp(share / TileHeight * TileHeight, 2 * TileHeight, 8 * TileHeight);
}

/// Not a template: threads are started in one place, whatever is projected.
void forBands(int height, int rows, Watch& watch, const std::function<void(int v0, int v1)>& body)
{
  const int bands = (height + rows - 1) / rows;
  watch.begin(bands);
  vtkSMPTools::For(0, bands, 1,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType b = first; b < last && !watch.stopped(); ++b)
      {
        const int v0 = static_cast<int>(b) * rows;
        body(v0, std::min(v0 + rows, height));
        watch.bandDone();
      }
    });
  watch.ask();
}

/// The chains that a projection needs.
LineEncoding encodingFor(const ProjectionSettings& settings, const glm::ivec3& size)
{
  LineEncoding encoding;
  encoding.tolerance = settings.lineTolerance;
  if (settings.quality == Quality::Preview)
  {
    encoding.eliminate = settings.eliminateInvisible;
    if (std::max({ size.x, size.y, size.z }) <= LineIndex::MostSorted)
    {
      encoding.order = settings.acceleration == Acceleration::SortedLines ? LineOrder::SortedLines
        : settings.acceleration == Acceleration::SortedVolume             ? LineOrder::SortedVolume
                                                                          : LineOrder::Lines;
    }
  }
  return encoding;
}

/// Slices that are transposed at a time where there is no memory for a copy of all.
constexpr int ChunkDepth = 8 * BrickDepth;

/// A share of tiles above which skipping the others does not pay: the plain walk reads memory in
/// order, which is worth more where little is computed, or where registers are wide and compute it
/// fast.
double worthwhileShare(const ProjectionSettings& settings, bool perspective)
{
  const VoxelLoops<float>& loops = kernelsFor(settings.instructionSet);
  const bool computesFast = loops.lanes >= 16;
  switch (settings.quality)
  {
    case Quality::Preview:
      return 0.3;
    case Quality::Standard:
      return perspective ? 0.5 : computesFast ? 0.3 : 0.4;
    default:
      return computesFast ? 0.5 : 0.6;
  }
}

/// The rule of Acceleration::Auto.
Acceleration choose(
  VolumeIndex& index, const ShearWarp& geometry, bool isCut, const ProjectionSettings& settings)
{
  const Experience& experience =
    index.experience(geometry.principalAxis(), static_cast<int>(settings.quality), isCut);
  const double worthwhile = worthwhileShare(settings, geometry.isPerspective());
  double patience = experience.share > worthwhile ? 32.0 : 0.0; // frames
  if (settings.quality == Quality::High || settings.quality == Quality::Exact)
  {
    // Views change little from frame to frame. Where bricks nearly pay, the next ones may, and
    // trying costs little where much is computed. (Whole registers can make the share exceed 1.)
    patience *= std::min((experience.share - worthwhile) / (1.0 - worthwhile), 1.0);
  }
  return experience.framesSince < patience ? Acceleration::Dense : Acceleration::Bricks;
}

/// Whether each sample has to be looked at by itself.
bool looksAtAll(
  const ProjectionSettings& settings, const VolumeIndex::Range& range, const ShearWarp& geometry)
{
  return settings.reduction != Reduction::Maximum ||
    (settings.keepWinners && (range.special || geometry.size().z > MostNoted));
}

/// Room for what a reduction keeps of each pixel.
void openState(const ShearImage& image, Reduction reduction, RayState& state)
{
  const std::size_t pixels = std::size_t(image.width) * image.height;
  if (reduction == Reduction::Mean)
  {
    state.sums.resize(pixels);
    state.counts.resize(pixels);
  }
  if (reduction == Reduction::Local)
  {
    state.ended.resize(pixels);
  }
}

void learn(Experience& experience, Acceleration used, const TileCount& count)
{
  if (used == Acceleration::Bricks)
  {
    experience.share = count.met > 0 ? double(count.splatted) / double(count.met) : 0.0;
    experience.framesSince = 0;
  }
  else
  {
    ++experience.framesSince;
  }
}
}

struct Projector::Scratch
{
  vtkSMPThreadLocal<BandScratch> bands;
  std::vector<SliceGeometry> slices;
  PreviewStorage previewLayers;
  std::tuple<std::vector<SliceFootprint<float>>, std::vector<SliceFootprint<double>>> footprints;
  std::tuple<PerspectiveFootprints<float>, PerspectiveFootprints<double>> perspectiveFootprints;
  std::tuple<std::vector<ExactPath<float>>, std::vector<ExactPath<double>>> paths;
  std::vector<Span> field;
  std::tuple<std::array<FanCells<float>, 2>, std::array<FanCells<double>, 2>> cells;
  std::tuple<WorksheetReach<float>, WorksheetReach<double>> reach;
  PerspectiveSteps steps;
  std::vector<unsigned char> none;
  CutMap cuts;
  OutlineSpace outline;
  RayState rays;
  vtkSMPThreadLocal<RayScratch> rayBands;
  std::vector<std::int16_t> orders;
  vtkSMPThreadLocal<WinnerScratch> winners;
  std::vector<unsigned char> chunk;
  std::vector<LineReach> lineReaches;
  vtkSMPThreadLocal<LineScratch> lines;
  // Of pieces only:
  ShearWarp part;
  Cuts partCuts;
  std::vector<SliceGeometry> wholeSlices;
  PerspectiveSteps wholeSteps;
  CutMap wholeCuts;
};

Projector::Projector() : Memory(new Scratch) {}

Projector::~Projector() = default;

/// Calls body(slices, isFirst, isLast) with frame.slices set: for all slices, or, where these would
/// need a copy that there is no memory for, for some at a time, from the last on if reversed.
template <class T, class Body>
void Projector::forSlices(
  VolumeIndex& index, Frame<T>& frame, int beyond, bool reversed, Body&& body)
{
  const int axis = frame.geometry.principalAxis(), depth = frame.geometry.size().z;
  if (index.hasSlices(axis))
  {
    frame.slices = index.slices(axis);
    body(Span{ 0, depth }, true, true);
    return;
  }
  const int chunks = (depth + ChunkDepth - 1) / ChunkDepth;
  for (int c = 0; c < chunks && !this->stopped(); ++c)
  {
    const int first = (reversed ? chunks - 1 - c : c) * ChunkDepth;
    const Span slices{ first, std::min(first + ChunkDepth, depth) };
    this->Observer.setPart(double(c) / chunks, double(c + 1) / chunks);
    frame.slices = index.someSlices(std::max(slices.begin - beyond, 0),
      std::min(slices.end + beyond, depth), this->Memory->chunk);
    body(slices, c == 0, c == chunks - 1);
  }
}

template <class T, class Layers>
void Projector::walk(
  VolumeIndex& index, Frame<T>& frame, const Layers& layers, Acceleration used, TileCount& count)
{
  using P = typename Layers::Pixel;
  const bool notes = frame.image.keepsWinners();
  if (notes)
  {
    this->openNotes(frame);
  }
  const bool preview = std::is_same_v<P, T> && Layers::Beyond == 0;
  const WinnerFinder<Layers> finder(frame, layers, this->Memory->outline.crossed, preview);
  const BrickMaxima* const bricks =
    used == Acceleration::Bricks ? &index.bricks(frame.geometry.principalAxis()) : nullptr;
  frame.nearestFirst = notes && !bricks;
  this->forSlices(index, frame, Layers::Beyond, notes && frame.geometry.reversed(),
    [&](const Span& slices, bool isFirst, bool isLast)
    {
      forBands(frame.image.height, bandHeight(frame.image.height), this->Observer,
        [&](int v0, int v1)
        {
          if (isFirst)
          {
            openRows<P>(frame.image, layers.floor(), v0, v1);
            if (notes)
            {
              openOrders(frame, v0, v1);
            }
          }
          BandWalk<Layers> band(frame, layers, this->Memory->bands.Local(), slices, v0, v1);
          bricks ? band.walkBricks(*bricks) : band.walkDensely();
          if (isLast)
          {
            if (notes)
            {
              finder.find(v0, v1, this->Memory->winners.Local());
            }
            layers.finish(v0, v1);
            closeRows<P>(frame.image, v0, v1);
          }
        });
    });
  for (BandScratch& band : this->Memory->bands)
  {
    count.met += band.count.met;
    count.splatted += band.count.splatted;
    band.count = {};
  }
}

/// Room for what walks note of winners.
template <class T>
void Projector::openNotes(Frame<T>& frame)
{
  this->Memory->orders.resize(frame.image.winners.size());
  frame.orders = this->Memory->orders.data();
  this->Memory->outline.crossed.reset(frame.sliceGeometry, frame.image.width);
}

template <class T, class Layers>
void Projector::walkRays(
  VolumeIndex& index, Frame<T>& frame, const Layers& layers, const ProjectionSettings& settings)
{
  using Walk = RayWalk<Layers>;
  const bool computes = Walk::computes(settings.reduction);
  RayState& state = this->Memory->rays;
  openState(frame.image, settings.reduction, state);
  const Walk walk(frame, layers, settings, state);
  this->forSlices(index, frame, Layers::Beyond, walk.isReversed(),
    [&](const Span& slices, bool isFirst, bool isLast)
    {
      forBands(frame.image.height, bandHeight(frame.image.height), this->Observer,
        [&](int v0, int v1)
        {
          if (isFirst)
          {
            walk.open(v0, v1);
          }
          walk.walk(slices, v0, v1, this->Memory->rayBands.Local());
          if (isLast)
          {
            walk.close(v0, v1);
            computes ? closeRows<typename Walk::A>(frame.image, v0, v1)
                     : closeRows<typename Walk::P>(frame.image, v0, v1);
          }
        });
    });
}

template <class T>
void Projector::previewLines(const Frame<T>& frame, const LineIndex& lines)
{
  const LinePreview<T> preview(frame, lines, this->Memory->lineReaches);
  // All bands look through sorted chains: there must be no more bands than threads.
  const int height = frame.image.height, threads = vtkSMPTools::GetEstimatedNumberOfThreads();
  const int rows = lines.encoding().order == LineOrder::Lines ? bandHeight(height)
                                                              : (height + threads - 1) / threads;
  forBands(height, rows, this->Observer,
    [&](int v0, int v1)
    {
      openRows<T>(frame.image, previewFloor(frame), v0, v1);
      preview.splat(v0, v1, this->Memory->lines.Local());
      closeRows<T>(frame.image, v0, v1);
    });
}

template <class T>
void Projector::splatLines(const Frame<T>& frame, const LineIndex& lines, bool standard)
{
  using A = Accumulator<T>;
  const LineWorksheets<T> worksheets(frame,
    std::get<std::vector<SliceFootprint<A>>>(this->Memory->footprints),
    std::get<WorksheetReach<A>>(this->Memory->reach), standard ? 0 : 1, lines);
  const Span slices{ 0, frame.geometry.size().z };
  forBands(frame.image.height, bandHeight(frame.image.height), this->Observer,
    [&](int v0, int v1)
    {
      openRows<A>(frame.image, worksheets.floor(), v0, v1);
      BandWalk<LineWorksheets<T>>(frame, worksheets, this->Memory->bands.Local(), slices, v0, v1)
        .walkDensely();
      worksheets.finish(v0, v1);
      closeRows<A>(frame.image, v0, v1);
    });
}

template <class T>
void Projector::projectType(VolumeIndex& index, const ProjectionSettings& settings,
  Acceleration used, const LineIndex* lines, Frame<T>& frame)
{
  using A = Accumulator<T>;
  ShearImage& image = frame.image;
  const bool preview = settings.quality == Quality::Preview;
  const bool standard = settings.quality == Quality::Standard;
  const bool exact = settings.quality == Quality::Exact;
  const bool samples = preview && !RayWalk<PreviewLayers<T>>::computes(settings.reduction);
  image.type = samples ? scalarTypeOf<T>() : scalarTypeOf<A>();
  image.bytes.resize(std::size_t(image.width) * image.height * (samples ? sizeof(T) : sizeof(A)));
  image.winners.resize(settings.keepWinners ? std::size_t(image.width) * image.height : 0);
  auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Memory->footprints);
  auto& reach = std::get<WorksheetReach<A>>(this->Memory->reach);
  const Kernel kernel = standard ? Kernel{ Reconstruction::Box } : settings.kernel;
  const bool perspective = frame.geometry.isPerspective();
  auto& own = std::get<PerspectiveFootprints<A>>(this->Memory->perspectiveFootprints);
  auto& paths = std::get<std::vector<ExactPath<A>>>(this->Memory->paths);
  auto& cells = std::get<std::array<FanCells<A>, 2>>(this->Memory->cells);
  if (exact && perspective)
  {
    cells[0].find(frame.whole, frame.geometry, 0);
    cells[1].find(frame.whole, frame.geometry, 1);
    findExactReach(frame.geometry, reach);
  }
  else if (exact)
  {
    findExactPaths(frame.whole, frame.geometry, paths);
    findFieldSpans(frame.whole, this->Memory->field);
    findReach(paths, reach);
  }
  else if (!preview && perspective)
  {
    own.find(frame.whole, frame.geometry, kernel, frame.kernels);
    findReach(frame.geometry, own, reach);
  }
  else if (!preview)
  {
    findFootprints(frame.geometry, kernel, settings.footprintSampling, weightBits<T>, footprints);
    findReach(frame.sliceGeometry, footprints, reach);
  }
  if (lines)
  {
    preview ? this->previewLines(frame, *lines) : this->splatLines(frame, *lines, standard);
    return;
  }
  const auto splat = [&](const auto& layers)
  {
    if (looksAtAll(settings, frame.range, frame.geometry))
    {
      this->walkRays(index, frame, layers, settings);
      return;
    }
    TileCount count;
    this->walk(index, frame, layers, used, count);
    if (!this->stopped())
    {
      learn(index.experience(frame.geometry.principalAxis(), static_cast<int>(settings.quality),
              !frame.cuts.none()),
        used, count);
    }
  };
  const int depth = standard ? 0 : 1;
  if (preview && perspective)
  {
    const VoxelLoops<T>& loops = frame.kernels;
    this->Memory->steps.windows.find(this->Memory->steps.columns, loops.group, sizeof(T));
    splat(PerspectivePreview<T>(frame, this->Memory->none));
  }
  else if (preview)
  {
    splat(PreviewLayers<T>(frame, this->Memory->previewLayers));
  }
  else if (exact && perspective)
  {
    splat(PerspectiveExact<T>(frame, cells[0], cells[1], reach));
  }
  else if (exact)
  {
    splat(ExactWorksheets<T>(frame, paths, this->Memory->field, reach));
  }
  else if (perspective)
  {
    splat(PerspectiveWorksheets<T>(frame, own, reach, depth));
  }
  else
  {
    splat(ParallelWorksheets<T>(frame, footprints, reach, depth));
  }
}

template <class T>
void Projector::carryType(const VoxelArray& other, const ShearWarp& geometry,
  const ProjectionSettings& settings, const ShearImage& projected, ShearImage& image)
{
  using A = Accumulator<T>;
  const bool preview = settings.quality == Quality::Preview;
  const std::vector<SliceGeometry>& slices = this->Memory->slices;
  const auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Memory->footprints);
  const auto& own = std::get<PerspectiveFootprints<A>>(this->Memory->perspectiveFootprints);
  const bool perspective = geometry.isPerspective();
  const PermutedVoxels<T> voxels(other, geometry);
  const auto voxel = [&](int u, int v, int k, int step)
  {
    return perspective ? carriedVoxel(voxels, geometry, u, v, step)
                       : carriedVoxel(voxels, slices[k].path, u, v, step);
  };
  const auto average = [&](int u, int v, int k)
  {
    return perspective ? carriedAverage<T>(voxels, own, u, v, k)
                       : carriedAverage<T>(voxels, footprints[k], u, v, k);
  };
  image.type = projected.type;
  image.bytes.resize(projected.bytes.size());
  image.special = std::numeric_limits<T>::has_quiet_NaN;
  const auto fill = [&](int v, auto* row)
  {
    using P = std::remove_pointer_t<decltype(row)>;
    const std::int32_t* const winners = &projected.winners[std::size_t(v) * projected.width];
    for (int u = 0; u < image.width; ++u)
    {
      const int step = winners[u], k = std::max(step, 0) / StepsPerSlice;
      row[u] = step < 0 ? P(0)
        : preview       ? static_cast<P>(voxel(u, v, k, step))
                        : static_cast<P>(average(u, v, k));
    }
  };
  vtkSMPTools::For(0, image.height, TileHeight,
    [&](vtkIdType begin, vtkIdType end)
    {
      for (int v = static_cast<int>(begin); v < end; ++v)
      {
        image.type == scalarTypeOf<T>() ? fill(v, image.row<T>(v)) : fill(v, image.row<A>(v));
      }
    });
}

void Projector::carry(const VoxelArray& other, const ShearWarp& geometry,
  const ProjectionSettings& settings, const ShearImage& projected, ShearImage& image)
{
  image.width = projected.width;
  image.height = projected.height;
  image.spans = projected.spans;
  image.mask = projected.mask;
  dispatch(other.type,
    [&](auto* null)
    {
      this->carryType<std::remove_pointer_t<decltype(null)>>(
        other, geometry, settings, projected, image);
    });
}

/// What can be used at all of what was asked for.
Acceleration Projector::possible(Acceleration wanted, VolumeIndex& index,
  const ProjectionSettings& settings, const ShearWarp& geometry, const Cuts& cuts,
  const LineIndex*& lines)
{
  if (looksAtAll(settings, index.range(), geometry) || index.range().special)
  {
    return Acceleration::Dense;
  }
  if (wanted >= Acceleration::Lines && cuts.none() && !geometry.isPerspective() &&
    !settings.keepWinners && settings.quality != Quality::Exact &&
    &geometry != &this->Memory->part && !this->stopped())
  {
    lines = index.lines(geometry.principalAxis(), encodingFor(settings, geometry.size()),
      [this](double share)
      {
        if (this->Progress)
        {
          this->Progress(share);
        }
        return this->Observer.ask();
      });
    return lines ? wanted : Acceleration::Dense;
  }
  return wanted != Acceleration::Dense && index.hasBricks() ? Acceleration::Bricks
                                                            : Acceleration::Dense;
}

/// How the rays of a whole volume run, where a piece of it is projected.
void Projector::findWhole(const ShearWarp& geometry, const ProjectionSettings& settings)
{
  Scratch& memory = *this->Memory;
  if (geometry.isPerspective())
  {
    const Kernels& kernels = kernelsFor(settings.instructionSet);
    memory.wholeSteps.columns.find(geometry, 0, kernels);
    memory.wholeSteps.rows.find(geometry, 1, kernels);
  }
  findSlices(geometry, memory.wholeSlices, memory.wholeSteps);
}

void Projector::outline(const ShearWarp& geometry, const ProjectionSettings& settings,
  const Cuts& cuts, ShearImage& image)
{
  Scratch& memory = *this->Memory;
  this->findWhole(geometry, settings);
  memory.wholeCuts.reset(cuts, geometry, { 0, geometry.size().z });
  outlineImage(geometry, memory.wholeSlices, memory.wholeCuts, memory.outline, image);
}

/// The geometry of a piece of a volume, and its cuts.
const ShearWarp& Projector::findPart(
  const ShearWarp& whole, const glm::ivec3& first, const glm::ivec3& dimensions, const Cuts& cuts)
{
  Scratch& memory = *this->Memory;
  whole.findPart(first, dimensions, memory.part);
  memory.partCuts.cropping = cuts.cropping;
  memory.partCuts.intervals.setShifted(cuts.intervals, memory.part.first().z);
  return memory.part;
}

/// Along each ray the slices that are samples of it, for shading by depth: those of the whole
/// volume.
void Projector::countSteps(const ShearWarp& whole, const ShearWarp& geometry,
  const ProjectionSettings& settings, const Cuts& cuts, int width, int height)
{
  Scratch& memory = *this->Memory;
  const bool isPart = &whole != &geometry;
  if (isPart)
  {
    this->findWhole(whole, settings);
  }
  memory.outline.crossed.reset(isPart ? memory.wholeSlices : memory.slices, width);
  memory.rays.crossed.findCrossed(memory.outline.crossed, width, height, cuts.intervals);
  if (isPart)
  {
    memory.rays.crossed.setShifted(memory.rays.crossed, geometry.first().z);
  }
}

Acceleration Projector::project(VolumeIndex& index, const ShearWarp& whole,
  const ProjectionSettings& settings, const Cuts& cuts, ShearImage& image,
  const glm::ivec3& firstVoxel)
{
  Scratch& memory = *this->Memory;
  this->Observer.start();
  const glm::ivec3& held = index.volume().dimensions;
  const std::array<int, 3>& axes = whole.axes();
  const bool isPart = glm::ivec3(held[axes[0]], held[axes[1]], held[axes[2]]) != whole.size();
  const ShearWarp& geometry = isPart ? this->findPart(whole, firstVoxel, held, cuts) : whole;
  const int slice = geometry.first().z;
  memory.cuts.reset(isPart ? memory.partCuts : cuts, whole, { slice, slice + geometry.size().z });
  if (geometry.isPerspective())
  {
    const Kernels& kernels = kernelsFor(settings.instructionSet);
    memory.steps.columns.find(geometry, 0, kernels);
    memory.steps.rows.find(geometry, 1, kernels);
  }
  findSlices(geometry, memory.slices, memory.steps);
  if (isPart)
  {
    keepInterior(whole, geometry, settings.quality, memory.slices);
  }
  outlineImage(geometry, memory.slices, memory.cuts, memory.outline, image);
  if (settings.reduction == Reduction::DepthShaded)
  {
    this->countSteps(whole, geometry, settings, cuts, image.width, image.height);
  }
  const VolumeIndex::Range& range = index.range();
  // The mean of no sample is none.
  image.special = range.special || settings.reduction == Reduction::Mean;
  const LineIndex* lines = nullptr;
  const Acceleration used = this->possible(settings.acceleration == Acceleration::Auto
      ? choose(index, geometry, !memory.cuts.none(), settings)
      : settings.acceleration,
    index, settings, geometry, cuts, lines);
  dispatch(index.volume().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      Frame<T> frame{ geometry, kernelsFor(settings.instructionSet), {}, range, memory.slices,
        memory.steps, memory.cuts, settings.floor, image, whole };
      this->projectType(index, settings, used, lines, frame);
    });
  return used;
}
}
