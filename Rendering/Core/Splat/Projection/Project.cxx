// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Splat/Projection/Project.h"

#include "Splat/Projection/Piece.h"
#include "Splat/Walks/SliceSampler.h"
#include "Splat/Walks/WalkSpace.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace splatting
{
namespace
{
/// The chains that a projection needs.
LineEncoding encodingFor(const ProjectionSettings& settings, const glm::ivec3& size)
{
  LineEncoding encoding;
  encoding.tolerance = settings.lineTolerance;
  if (settings.quality == Quality::Preview)
  {
    if (std::max({ size.x, size.y, size.z }) <= LineIndex::MostSorted)
    {
      encoding.order = settings.acceleration == Acceleration::SortedLines ? LineOrder::SortedLines
        : settings.acceleration == Acceleration::SortedVolume             ? LineOrder::SortedVolume
                                                                          : LineOrder::Lines;
    }
  }
  return encoding;
}

/// The share of tiles above which skipping the others does not pay, because the dense walk reads
/// memory in order. This matters more if little is computed, or if wide registers compute it fast.
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
  const SkipStatistics& statistics =
    index.statistics(geometry.principalAxis(), static_cast<int>(settings.quality), isCut);
  const double worthwhile = worthwhileShare(settings, geometry.isPerspective());
  double patience = statistics.share > worthwhile ? 32.0 : 0.0; // frames
  if (settings.quality == Quality::High)
  {
    // Views change little from frame to frame. Near the limit the next frames may be below it, and
    // high mode computes so much that trying costs little. (Whole registers can make the share
    // exceed 1.)
    patience *= std::min((statistics.share - worthwhile) / (1.0 - worthwhile), 1.0);
  }
  return statistics.framesSince < patience ? Acceleration::Dense : Acceleration::Bricks;
}

/// Whether every sample must be evaluated.
bool needsEverySample(const ProjectionSettings& settings, const VolumeIndex::Range& range)
{
  return settings.reduction != Reduction::Maximum || range.hasInfinities() ||
    settings.recordLocations;
}

/// Allocates pixels: samples, or sums of worksheets.
void openImage(const ProjectionSettings& settings, ScalarType voxels, ShearImage& image)
{
  const bool samples = settings.quality == Quality::Preview && !computesWith(settings.reduction);
  const std::size_t pixels = std::size_t(image.width) * image.height;
  image.type = samples ? voxels : averageType(voxels);
  image.bytes.resize(pixels * sizeOf(image.type));
  image.winners.resize(settings.recordLocations ? pixels : 0);
}

void learn(SkipStatistics& statistics, Acceleration used, const TileCount& count)
{
  if (used == Acceleration::Bricks)
  {
    statistics.share = count.met > 0 ? double(count.splatted) / double(count.met) : 0.0;
    statistics.framesSince = 0;
  }
  else
  {
    ++statistics.framesSince;
  }
}
}

struct Projector::Scratch
{
  /// Made on demand.
  std::array<std::array<std::unique_ptr<ProjectionMode>, 2>, 3> modes; // parallel, perspective
  std::unique_ptr<ProjectionMode> chains;
  WalkSpace walks;
  std::vector<SliceGeometry> slices;
  PerspectiveSteps steps;
  CutMap cuts;
  // For pieces only:
  ShearWarp part;
  Cuts partCuts;
  std::vector<SliceGeometry> wholeSlices;
  PerspectiveSteps wholeSteps;
  CutMap wholeCuts;
};

Projector::Projector() : Memory(new Scratch) {}

Projector::~Projector() = default;

ProjectionMode& Projector::mode(Quality quality, bool perspective)
{
  using Make = std::unique_ptr<ProjectionMode> (*)();
  static constexpr Make make[3][2] = { { &makePreview, &makePerspectivePreview },
    { &makeWorksheets, &makePerspectiveWorksheets },
    { &makeWorksheets, &makePerspectiveWorksheets } };
  const int q = static_cast<int>(quality);
  std::unique_ptr<ProjectionMode>& mode = this->Memory->modes[q][perspective];
  if (!mode)
  {
    mode = make[q][perspective]();
  }
  return *mode;
}

/// The acceleration that is possible instead of the wanted one.
Acceleration Projector::possible(Acceleration wanted, VolumeIndex& index,
  const ProjectionSettings& settings, const ShearWarp& geometry, const Cuts& cuts,
  const LineIndex*& lines)
{
  if (needsEverySample(settings, index.range()))
  {
    return Acceleration::Dense;
  }
  if (wanted >= Acceleration::Lines && !index.range().nonFinite && cuts.none() &&
    !geometry.isPerspective() && &geometry != &this->Memory->part && !this->stopped())
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

/// Finds the rays of a whole volume, for the projection of a piece.
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
  outlineImage(geometry, memory.wholeSlices, memory.wholeCuts, memory.walks.outline, image);
  for (ShearImage& minima : image.minima)
  {
    minima.spans = image.spans;
    minima.mask = image.mask;
  }
}

/// Finds the geometry of a piece of a volume, and its cuts.
const ShearWarp& Projector::findPart(
  const ShearWarp& whole, const glm::ivec3& first, const glm::ivec3& dimensions, const Cuts& cuts)
{
  Scratch& memory = *this->Memory;
  whole.findPart(first, dimensions, memory.part);
  memory.partCuts.cropping = cuts.cropping;
  memory.partCuts.intervals.setShifted(cuts.intervals, memory.part.first().z);
  return memory.part;
}

/// Finds the slices of the whole volume that are samples of each ray, for depth shading.
void Projector::countSteps(const ShearWarp& whole, const ShearWarp& geometry,
  const ProjectionSettings& settings, const Cuts& cuts, int width, int height)
{
  Scratch& memory = *this->Memory;
  const bool isPart = &whole != &geometry;
  if (isPart)
  {
    this->findWhole(whole, settings);
  }
  memory.walks.outline.crossed.reset(isPart ? memory.wholeSlices : memory.slices, width);
  memory.walks.rays.crossed.findCrossed(
    memory.walks.outline.crossed, width, height, cuts.intervals);
  if (isPart)
  {
    memory.walks.rays.crossed.setShifted(memory.walks.rays.crossed, geometry.first().z);
  }
}

/// After a projection, with the slices and the work space that it has left.
void Projector::takeAtLocations(const AtSamples& other, const ShearWarp& geometry,
  const ProjectionSettings& settings, const ShearImage& projected)
{
  ShearImage& image = other.image;
  const ScalarType type = other.volume.type;
  image.width = projected.width;
  image.height = projected.height;
  image.spans = projected.spans;
  image.mask = projected.mask;
  image.minima.clear();
  image.type = projected.type;
  image.bytes.resize(projected.bytes.size());
  image.nonFinite = type == ScalarType::Float32 || type == ScalarType::Float64;
  this->mode(settings.quality, geometry.isPerspective())
    .takeAtLocations({ other.volume, geometry, this->Memory->slices, projected, image });
}

Acceleration Projector::project(VolumeIndex& index, const ShearWarp& geometry,
  const ProjectionSettings& settings, const Cuts& cuts, ShearImage& image, const glm::ivec3& first,
  const std::vector<AtSamples>& others)
{
  this->Observer.start();
  image.minima.resize(settings.reduction == Reduction::Signed ? 1 : 0);
  if (image.minima.empty())
  {
    const Acceleration used = this->projectReduction(index, geometry, settings, cuts, image, first);
    for (std::size_t n = 0; n < others.size() && !this->stopped(); ++n)
    {
      this->takeAtLocations(others[n], geometry, settings, image);
    }
    return used;
  }
  image.origin = settings.origin;
  ProjectionSettings part = settings;
  part.reduction = Reduction::Maximum;
  this->Observer.setStage(0.0, 0.5);
  const Acceleration used = this->projectReduction(index, geometry, part, cuts, image, first);
  if (!this->stopped())
  {
    part.reduction = Reduction::Minimum;
    this->Observer.setStage(0.5, 1.0);
    this->projectReduction(index, geometry, part, cuts, image.minima.front(), first);
  }
  return used;
}

Acceleration Projector::projectReduction(VolumeIndex& index, const ShearWarp& whole,
  const ProjectionSettings& settings, const Cuts& cuts, ShearImage& image,
  const glm::ivec3& firstVoxel)
{
  Scratch& memory = *this->Memory;
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
  outlineImage(geometry, memory.slices, memory.cuts, memory.walks.outline, image);
  if (settings.reduction == Reduction::DepthShaded)
  {
    this->countSteps(whole, geometry, settings, cuts, image.width, image.height);
  }
  const VolumeIndex::Range& range = index.range();
  // The mean of no sample is NaN.
  image.nonFinite = range.nonFinite || settings.reduction == Reduction::Mean;
  const LineIndex* lines = nullptr;
  const Acceleration used = this->possible(settings.acceleration == Acceleration::Auto
      ? choose(index, geometry, !memory.cuts.none(), settings)
      : settings.acceleration,
    index, settings, geometry, cuts, lines);
  openImage(settings, index.volume().type, image);
  const bool byRays = needsEverySample(settings, range);
  const bool skips = used == Acceleration::Bricks;
  ProjectionContext context{ index, settings, geometry, whole, kernelsFor(settings.instructionSet),
    range, memory.slices, memory.steps, memory.cuts, settings.floor, image, memory.walks,
    this->Observer, byRays, lines, skips ? &index.bricks(geometry.principalAxis()) : nullptr };
  if (lines)
  {
    if (!memory.chains)
    {
      memory.chains = makeChains();
    }
    memory.chains->project(context);
    return used;
  }
  this->mode(settings.quality, geometry.isPerspective()).project(context);
  if (!byRays && !this->stopped())
  {
    learn(index.statistics(
            geometry.principalAxis(), static_cast<int>(settings.quality), !memory.cuts.none()),
      used, context.count);
  }
  return used;
}
}
