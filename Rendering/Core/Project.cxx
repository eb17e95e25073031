// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Project.h"

#include "BandWalk.h"
#include "LineWalk.h"
#include "LineWorksheets.h"

#include <vtkSMPThreadLocal.h>
#include <vtkSMPTools.h>

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

/// The bands are the part `share` of the work.
template <class Body>
void forBands(int height, int rows, Watch& watch, const glm::dvec2& share, Body&& body)
{
  const int bands = (height + rows - 1) / rows;
  watch.begin(bands, share[0], share[1]);
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
LineEncoding encodingFor(const ProjectionSettings& settings, const glm::ivec3& size, bool isCut)
{
  LineEncoding encoding;
  encoding.tolerance = settings.lineTolerance;
  // Half-spaces cut voxels away that hide others.
  if (settings.quality == Quality::Preview && !(settings.eliminateInvisible && isCut))
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
/// order, which is worth more where little is computed.
double worthwhileShare(Quality quality)
{
  return quality == Quality::Preview ? 0.3 : 0.5;
}

/// The rule of Acceleration::Auto.
Acceleration choose(const Experience& experience, Quality quality)
{
  constexpr int patience = 16;
  return experience.share > worthwhileShare(quality) && experience.framesSince < patience
    ? Acceleration::Dense
    : Acceleration::Bricks;
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
  std::vector<PreviewLayer> previewLayers;
  std::tuple<std::vector<SliceFootprint<float>>, std::vector<SliceFootprint<double>>> footprints;
  std::tuple<WorksheetReach<float>, WorksheetReach<double>> reach;
  std::vector<glm::dvec4> halfSpaces;
  std::vector<unsigned char> chunk;
  std::vector<LineReach> lineReaches;
  vtkSMPThreadLocal<LineScratch> lines;
};

Projector::Projector() : Memory(new Scratch) {}

Projector::~Projector() = default;

/// Walks all slices, or, where these would need a copy that there is no memory for, some at a time.
template <class T, class Layers>
void Projector::walk(
  VolumeIndex& index, Frame<T>& frame, const Layers& layers, Acceleration used, TileCount& count)
{
  using P = typename Layers::Pixel;
  const int axis = frame.geometry.principalAxis(), depth = frame.geometry.size().z;
  const bool whole = index.hasSlices(axis);
  const BrickMaxima* const bricks = used == Acceleration::Bricks ? &index.bricks(axis) : nullptr;
  for (int first = 0; first < depth; first += ChunkDepth)
  {
    const Span slices{ first, whole ? depth : std::min(first + ChunkDepth, depth) };
    frame.slices = whole ? index.slices(axis)
                         : index.someSlices(std::max(slices.begin - Layers::Beyond, 0),
                             std::min(slices.end + Layers::Beyond, depth), this->Memory->chunk);
    forBands(frame.image.height, bandHeight(frame.image.height), this->Observer,
      glm::dvec2(slices.begin, slices.end) / double(depth),
      [&](int v0, int v1)
      {
        if (slices.begin == 0)
        {
          openRows<P>(frame.image, layers.floor(), v0, v1);
        }
        BandWalk<Layers> band(frame, layers, this->Memory->bands.Local(), slices, v0, v1);
        bricks ? band.walkBricks(*bricks) : band.walkDensely();
        if (slices.end == depth)
        {
          layers.finish(v0, v1);
          closeRows<P>(frame.image, v0, v1);
        }
      });
    if (whole || this->stopped())
    {
      break;
    }
  }
  for (BandScratch& band : this->Memory->bands)
  {
    count.met += band.count.met;
    count.splatted += band.count.splatted;
    band.count = {};
  }
}

template <class T>
void Projector::previewLines(const Frame<T>& frame, const LineIndex& lines)
{
  const LinePreview<T> preview(frame, lines, this->Memory->lineReaches);
  // All bands look through sorted chains: there must be no more bands than threads.
  const int height = frame.image.height, threads = vtkSMPTools::GetEstimatedNumberOfThreads();
  const int rows = lines.encoding().order == LineOrder::Lines ? bandHeight(height)
                                                              : (height + threads - 1) / threads;
  forBands(height, rows, this->Observer, { 0.0, 1.0 },
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
  forBands(frame.image.height, bandHeight(frame.image.height), this->Observer, { 0.0, 1.0 },
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
  image.type = preview ? scalarTypeOf<T>() : scalarTypeOf<A>();
  image.bytes.resize(std::size_t(image.width) * image.height * (preview ? sizeof(T) : sizeof(A)));
  auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Memory->footprints);
  auto& reach = std::get<WorksheetReach<A>>(this->Memory->reach);
  if (!preview)
  {
    findFootprints(frame.geometry, standard ? Kernel{ Reconstruction::Box } : settings.kernel,
      settings.footprintSampling, weightBits<T>, footprints);
    findReach(frame.sliceGeometry, footprints, reach);
  }
  if (lines)
  {
    preview ? this->previewLines(frame, *lines) : this->splatLines(frame, *lines, standard);
    return;
  }
  TileCount count;
  if (preview)
  {
    this->walk(index, frame, PreviewLayers<T>(frame, this->Memory->previewLayers), used, count);
  }
  else
  {
    this->walk(
      index, frame, WorksheetLayers<T>(frame, footprints, reach, standard ? 0 : 1), used, count);
  }
  if (!this->stopped())
  {
    learn(index.experience(frame.geometry.principalAxis(), static_cast<int>(settings.quality)),
      used, count);
  }
}

Acceleration Projector::project(VolumeIndex& index, const ShearWarp& geometry,
  const ProjectionSettings& settings, const std::vector<glm::dvec4>& halfSpaces, ShearImage& image)
{
  Scratch& memory = *this->Memory;
  this->Observer.start();
  memory.halfSpaces.clear();
  for (const glm::dvec4& h : halfSpaces)
  {
    memory.halfSpaces.push_back(geometry.inPixels(h));
  }
  findSlices(geometry, memory.slices);
  outlineImage(geometry, memory.slices, memory.halfSpaces, image);
  const VolumeIndex::Range& range = index.range();
  image.special = range.special;
  const int axis = geometry.principalAxis();
  Acceleration used = settings.acceleration == Acceleration::Auto
    ? choose(index.experience(axis, static_cast<int>(settings.quality)), settings.quality)
    : settings.acceleration;
  const auto chainsMade = [this](double share)
  {
    if (this->Progress)
    {
      this->Progress(share);
    }
    return this->Observer.ask();
  };
  const LineIndex* const lines = used >= Acceleration::Lines && !range.special && !this->stopped()
    ? index.lines(axis, encodingFor(settings, geometry.size(), !halfSpaces.empty()), chainsMade)
    : nullptr;
  if (!lines && (used != Acceleration::Bricks || !index.hasBricks()))
  {
    used = Acceleration::Dense;
  }
  dispatch(index.volume().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      Frame<T> frame{ geometry, kernelsFor(settings.instructionSet), {}, range, memory.slices,
        memory.halfSpaces, settings.floor, image };
      this->projectType(index, settings, used, lines, frame);
    });
  return used;
}
}
