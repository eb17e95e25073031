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

template <class Body>
void forBands(int height, int rows, Body&& body)
{
  vtkSMPTools::For(0, (height + rows - 1) / rows, 1,
    [&](vtkIdType first, vtkIdType last)
    {
      for (vtkIdType b = first; b < last; ++b)
      {
        const int v0 = static_cast<int>(b) * rows;
        body(v0, std::min(v0 + rows, height));
      }
    });
}

bool walksLines(const ProjectionSettings& settings, const ShearImage& image)
{
  return settings.acceleration >= Acceleration::Lines && !image.special;
}

LineEncoding encodingFor(
  const ProjectionSettings& settings, const glm::ivec3& size, bool hasHalfSpaces)
{
  LineEncoding encoding;
  encoding.tolerance = settings.lineTolerance;
  // Half-spaces cut voxels away that hide others.
  if (settings.quality == Quality::Preview && !(settings.eliminateInvisible && hasHalfSpaces))
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

/// Pixels that no ray meets were marked for the walk; they are "no sample" again.
template <class P>
void closeRows(ShearImage& image, int v0, int v1)
{
  const P empty = image.special ? std::numeric_limits<P>::quiet_NaN() : leastValue<P>();
  for (int v = v0; v < v1; ++v)
  {
    P* const row = image.row<P>(v);
    const Span& span = image.spans[v];
    std::fill(row, row + std::min(span.begin, image.width), empty);
    std::fill(row + std::max(span.begin, span.end), row + image.width, empty);
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
  std::vector<LineReach> lineReaches;
  vtkSMPThreadLocal<LineScratch> lines;
};

Projector::Projector() : Memory(new Scratch) {}

Projector::~Projector() = default;

template <class T, class Layers>
void Projector::walk(const Frame<T>& frame, const Layers& layers, const BrickMaxima* bricks)
{
  using P = typename Layers::Pixel;
  forBands(frame.image.height, bandHeight(frame.image.height),
    [&](int v0, int v1)
    {
      openRows<P>(frame.image, v0, v1);
      BandWalk<Layers> band(frame, layers, this->Memory->bands.Local(), v0, v1);
      if (bricks)
      {
        band.walkBricks(*bricks);
      }
      else
      {
        band.walkDensely();
      }
      layers.finish(v0, v1);
      closeRows<P>(frame.image, v0, v1);
    });
}

template <class T>
void Projector::previewLines(const Frame<T>& frame, const LineIndex& lines, double floor)
{
  const LinePreview<T> preview(frame, lines, floor, this->Memory->lineReaches);
  // All bands look through sorted chains: there must be no more bands than threads.
  const int height = frame.image.height, threads = vtkSMPTools::GetEstimatedNumberOfThreads();
  const int rows = lines.encoding().order == LineOrder::Lines ? bandHeight(height)
                                                              : (height + threads - 1) / threads;
  forBands(height, rows,
    [&](int v0, int v1)
    {
      openRows<T>(frame.image, v0, v1);
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
  forBands(frame.image.height, bandHeight(frame.image.height),
    [&](int v0, int v1)
    {
      openRows<A>(frame.image, v0, v1);
      BandWalk<LineWorksheets<T>>(frame, worksheets, this->Memory->bands.Local(), v0, v1)
        .walkDensely();
      worksheets.finish(v0, v1);
      closeRows<A>(frame.image, v0, v1);
    });
}

template <class T>
void Projector::projectType(
  VolumeIndex& index, const Frame<T>& frame, const ProjectionSettings& settings)
{
  ShearImage& image = frame.image;
  const std::size_t pixels = std::size_t(image.width) * image.height;
  const LineIndex* const lines = walksLines(settings, image)
    ? &index.lines(frame.geometry.principalAxis(),
        encodingFor(settings, frame.geometry.size(), !frame.halfSpaces.empty()))
    : nullptr;
  const BrickMaxima* const bricks = settings.acceleration < Acceleration::Lines &&
      settings.acceleration != Acceleration::Dense && !image.special
    ? &index.bricks(frame.geometry.principalAxis())
    : nullptr;
  if (settings.quality == Quality::Preview)
  {
    image.type = scalarTypeOf<T>();
    image.bytes.resize(pixels * sizeof(T));
    if (lines)
    {
      this->previewLines(frame, *lines, settings.floor);
      return;
    }
    this->walk(frame, PreviewLayers<T>(frame, this->Memory->previewLayers), bricks);
    return;
  }
  using A = Accumulator<T>;
  image.type = scalarTypeOf<A>();
  image.bytes.resize(pixels * sizeof(A));
  const bool standard = settings.quality == Quality::Standard;
  auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Memory->footprints);
  findFootprints(frame.geometry, standard ? Kernel{ Reconstruction::Box } : settings.kernel,
    settings.footprintSampling, weightBits<T>, footprints);
  auto& reach = std::get<WorksheetReach<A>>(this->Memory->reach);
  findReach(frame.sliceGeometry, footprints, reach);
  if (lines)
  {
    this->splatLines(frame, *lines, standard);
    return;
  }
  this->walk(frame, WorksheetLayers<T>(frame, footprints, reach, standard ? 0 : 1), bricks);
}

void Projector::project(VolumeIndex& index, const ShearWarp& geometry,
  const ProjectionSettings& settings, const std::vector<glm::dvec4>& halfSpaces, ShearImage& image)
{
  Scratch& memory = *this->Memory;
  memory.halfSpaces.clear();
  for (const glm::dvec4& h : halfSpaces)
  {
    memory.halfSpaces.push_back(geometry.inPixels(h));
  }
  findSlices(geometry, memory.slices);
  outlineImage(geometry, memory.slices, memory.halfSpaces, image);
  const VolumeIndex::Range& range = index.range();
  image.special = range.special;
  dispatch(index.volume().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      const Frame<T> frame{ geometry, kernelsFor(settings.instructionSet),
        walksLines(settings, image) ? Slices{} : index.slices(geometry.principalAxis()), range,
        memory.slices, memory.halfSpaces, image };
      this->projectType(index, frame, settings);
    });
}
}
