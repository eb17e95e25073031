// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Project.h"

#include "BandWalk.h"

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
void forBands(int height, Body&& body)
{
  const int rows = bandHeight(height);
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

/// Slices that are transposed at a time where there is no memory for a copy of all.
constexpr int ChunkDepth = 8 * BrickDepth;

/// A share of tiles above which skipping the others does not pay: the plain walk reads memory in
/// order, which is worth more where little is computed.
double worthwhileShare(Quality quality)
{
  return quality == Quality::Preview ? 0.4 : 0.7;
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
};

Projector::Projector() : Memory(new Scratch) {}

Projector::~Projector() = default;

/// Walks all slices, or, where these would need a copy that there is no memory for, some at a time.
template <class T, class Layers>
void Projector::walk(VolumeIndex& index, const Frame<T>& frame, const Layers& layers,
  Acceleration used, TileCount& count)
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
    forBands(frame.image.height,
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
    if (whole)
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
void Projector::projectType(
  VolumeIndex& index, const ProjectionSettings& settings, Acceleration used, const Frame<T>& frame)
{
  ShearImage& image = frame.image;
  const std::size_t pixels = std::size_t(image.width) * image.height;
  TileCount count;
  if (settings.quality == Quality::Preview)
  {
    image.type = scalarTypeOf<T>();
    image.bytes.resize(pixels * sizeof(T));
    this->walk(index, frame, PreviewLayers<T>(frame, this->Memory->previewLayers), used, count);
  }
  else
  {
    using A = Accumulator<T>;
    image.type = scalarTypeOf<A>();
    image.bytes.resize(pixels * sizeof(A));
    const bool standard = settings.quality == Quality::Standard;
    auto& footprints = std::get<std::vector<SliceFootprint<A>>>(this->Memory->footprints);
    findFootprints(frame.geometry, standard ? Kernel{ Reconstruction::Box } : settings.kernel,
      settings.footprintSampling, weightBits<T>, footprints);
    auto& reach = std::get<WorksheetReach<A>>(this->Memory->reach);
    findReach(frame.sliceGeometry, footprints, reach);
    this->walk(
      index, frame, WorksheetLayers<T>(frame, footprints, reach, standard ? 0 : 1), used, count);
  }
  learn(index.experience(frame.geometry.principalAxis(), static_cast<int>(settings.quality)), used,
    count);
}

Acceleration Projector::project(VolumeIndex& index, const ShearWarp& geometry,
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
  Acceleration used = settings.acceleration;
  if (used == Acceleration::Auto)
  {
    used = choose(index.experience(geometry.principalAxis(), static_cast<int>(settings.quality)),
      settings.quality);
  }
  if (range.special || !index.hasBricks())
  {
    used = Acceleration::Dense;
  }
  dispatch(index.volume().type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      const Frame<T> frame{ geometry, kernelsFor(settings.instructionSet), {}, range, memory.slices,
        memory.halfSpaces, settings.floor, image };
      this->projectType(index, settings, used, frame);
    });
  return used;
}
}
