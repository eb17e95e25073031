// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Components/ComponentProjector.h"

#include "Components/PieceExchange.h"
#include "Components/ShearImageOutput.h"
#include "Display/ScreenColors.h"
#include "Input/ScalarSource.h"
#include "Splat/Projection/Piece.h"
#include "Volume/VoxelCopies.h"

#include "vtkImageData.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace splatting
{
bool ComponentProjector::SetSource(ScalarSource& source)
{
  source.Update();
  this->Dependent = source.AreDependent();
  if (this->Version == source.Version())
  {
    return false;
  }
  const VoxelArray before = this->Channels.front().Index.volume();
  const VoxelArray now = source.Volume(0);
  const std::size_t components = source.Components();
  const bool differs = before.dimensions != now.dimensions || before.type != now.type ||
    this->Channels.size() != components;
  this->Version = source.Version();
  this->Channels.resize(components);
  for (std::size_t c = 0; c < components; ++c)
  {
    this->Channels[c].Index.reset(source.Volume(static_cast<int>(c)));
    this->Channels[c].Cells.clear();
    this->Channels[c].Here.reset();
    this->Channels[c].Whole.reset();
  }
  this->Projected = false;
  this->Colors.Forget();
  return differs;
}

void ComponentProjector::SetEmpty(ScalarType type, std::size_t components)
{
  const VolumeIndex& before = this->Channels.front().Index;
  if (before.volume().voxels || before.volume().type != type || this->Channels.size() != components)
  {
    this->Channels.resize(components);
    for (Channel& channel : this->Channels)
    {
      channel.Index.reset({ nullptr, type, glm::ivec3(0) });
      channel.Cells.clear();
      channel.Whole.reset();
    }
    this->Dependent = false;
    this->Version = 0;
    this->Projected = false;
    this->Colors.Forget();
  }
}

void ComponentProjector::Clear()
{
  this->Channels.clear();
  this->Channels.resize(1);
  this->Layer = {};
  this->Plane = {};
  this->Splat = {};
  this->Next = {};
  this->CellDepth = {};
  this->Shown = {};
  this->ShearImageOutput = nullptr;
  this->Dependent = false;
  this->Version = 0;
  this->Projected = false;
  this->Colors.Forget();
}

const VolumeIndex::Range& ComponentProjector::RangeOfPiece(std::size_t component)
{
  Channel& channel = this->Channels[component];
  if (!channel.Here)
  {
    channel.Here = channel.Index.range();
  }
  return *channel.Here;
}

void ComponentProjector::SetRanks(PieceExchange* ranks)
{
  this->Projected = this->Projected && this->Ranks == ranks;
  this->Ranks = ranks;
  for (std::size_t c = 0; c < this->Channels.size(); ++c)
  {
    Channel& channel = this->Channels[c];
    if (!ranks)
    {
      if (channel.Whole) // the index has the range of the whole
      {
        channel.Index.reset(channel.Index.volume());
        channel.Whole.reset();
        this->Colors.Forget();
        this->Projected = false;
      }
      continue;
    }
    const VolumeIndex::Range range = ranks->RangeOfWhole(c);
    if (!channel.Whole || channel.Whole->low != range.low || channel.Whole->high != range.high ||
      channel.Whole->nonFinite != range.nonFinite)
    {
      this->Colors.Forget();
      this->Projected = false;
    }
    channel.Whole = range;
    channel.Index.setRangeOfWhole(*channel.Whole); // also if the budget has changed
  }
}

// Sums of weighted voxels, or of a ray's samples, would overflow.
const char* ComponentProjector::ValidateVoxels(Quality quality)
{
  const bool isTooLarge = std::any_of(this->Channels.begin(), this->Channels.end(),
    [isExact = quality == Quality::Exact](Channel& channel)
    {
      const VolumeIndex::Range& range = channel.Index.range();
      return range.magnitude >
        mostMagnitude(channel.Index.volume().type, isExact ? range : VolumeIndex::Range());
    });
  return isTooLarge
    ? "The scalars have magnitudes above 1e37 (double: 1e303; with infinities in exact mode "
      "1e18 and 1e150), so that sums overflow: scale them, and set voxels without a value to NaN."
    : nullptr;
}

bool ComponentProjector::SetBudget(std::size_t bytes)
{
  bool changed = false;
  for (Channel& channel : this->Channels)
  {
    changed = channel.Index.setBudget(bytes / this->Channels.size()) || changed;
  }
  this->Projected = this->Projected && !changed; // so that Used() is updated
  return changed;
}

bool ComponentProjector::ExceedsBudget() const
{
  return std::any_of(this->Channels.begin(), this->Channels.end(),
    [](const Channel& channel) { return channel.Index.exceedsBudget(); });
}

std::size_t ComponentProjector::MemorySize() const
{
  std::size_t size = 0;
  for (const Channel& channel : this->Channels)
  {
    size += channel.Index.memorySize() + channel.Cells.memorySize();
  }
  return size;
}

double ComponentProjector::Time() const
{
  double seconds = 0.0;
  for (const Channel& channel : this->Channels)
  {
    seconds += channel.Index.time() + channel.Cells.time();
  }
  return seconds;
}

void ComponentProjector::UpdateColors(
  vtkVolumeProperty* property, const FinalColor& finalColor, const ProjectionSettings& settings)
{
  std::vector<VolumeIndex*> components;
  for (Channel& channel : this->Channels)
  {
    components.push_back(&channel.Index);
  }
  this->Colors.Update(property, finalColor, settings, components, this->Dependent);
}

// Whether all components but the last are taken from the samples of the last.
bool ComponentProjector::TakesAtLocations(const ProjectionSettings& settings) const
{
  return this->Dependent && settings.reduction != Reduction::Mean;
}

ProjectionSettings ComponentProjector::SettingsOf(
  const Channel& channel, ProjectionSettings settings) const
{
  // Only the mapper's located component needs winners.
  settings.recordLocations = this->TakesAtLocations(settings) ||
    (settings.recordLocations && &channel == &this->LocatedChannel());
  if (this->TakesAtLocations(settings) && settings.quality == Quality::Exact)
  {
    settings.quality = Quality::High; // other components are averages
  }
  // Other components and locations need samples below the window, too.
  if (this->Cull && !settings.recordLocations && settings.reduction == Reduction::Maximum)
  {
    settings.floor = this->Colors.FloorOfWindow(&channel - this->Channels.data());
  }
  return settings;
}

bool ComponentProjector::IsUpToDate(const ProjectionSettings& settings) const
{
  return this->Projected &&
    std::all_of(this->Channels.begin(), this->Channels.end(),
      [&](const Channel& channel)
      { return this->SettingsOf(channel, settings) == channel.Settings; });
}

bool ComponentProjector::ProjectChannel(Channel& channel, std::size_t n,
  const ProjectionSettings& settings, const std::vector<AtSamples>& others)
{
  ShearImage& image = channel.Images[n];
  const ShearWarp& geometry = this->Splat.geometries[n];
  channel.Settings = this->SettingsOf(channel, settings);
  if (this->Ranks && !channel.Index.volume().voxels)
  {
    image.nonFinite = channel.Index.range().nonFinite;
    blank(geometry, channel.Index.volume().type, channel.Settings, image);
    ++this->Done;
    return true;
  }
  const Acceleration used = this->Projector.project(channel.Index, geometry, channel.Settings,
    this->Splat.cuts[n], image, this->Ranks ? this->Ranks->First() : glm::ivec3(0), others);
  if (this->Projector.stopped())
  {
    return false;
  }
  channel.Used = used;
  channel.Range = channel.Index.range();
  ++this->Done;
  return true;
}

// Projects one image of all components. Of dependent ones the last is projected.
bool ComponentProjector::ProjectImage(std::size_t n, const ProjectionSettings& settings)
{
  if (!this->TakesAtLocations(settings))
  {
    return std::all_of(this->Channels.begin(), this->Channels.end(),
      [&](Channel& channel) { return this->ProjectChannel(channel, n, settings, {}); });
  }
  Channel& last = this->Channels.back();
  this->Others.clear();
  for (std::size_t c = 0; c + 1 < this->Channels.size(); ++c)
  {
    this->Others.push_back({ this->Channels[c].Index.volume(), this->Channels[c].Images[n] });
  }
  const bool done = this->ProjectChannel(last, n, settings, this->Others);
  for (Channel& channel : this->Channels)
  {
    channel.Used = last.Used;
  }
  return done;
}

// Projects all components into all images. Returns false if it was stopped.
bool ComponentProjector::ProjectImages(const ProjectionSettings& settings)
{
  const std::size_t images = this->Splat.geometries.size();
  this->Parts = images;
  for (Channel& channel : this->Channels)
  {
    channel.Images.resize(std::max(channel.Images.size(), images));
    channel.Settings = this->SettingsOf(channel, settings); // also if there is no image
  }
  bool done = true;
  for (std::size_t n = 0; n < images && done; ++n)
  {
    done = this->ProjectImage(n, settings);
  }
  // If one rank stops, all ranks stop.
  if (this->Ranks ? this->Ranks->Any(!done) : !done)
  {
    return false;
  }
  if (this->Ranks)
  {
    this->Exchange(settings);
  }
  return true;
}

// Whether the last projection was by cells of this view.
bool ComponentProjector::ShowsCells(const View& view, const RayEnds& ends) const
{
  return this->OnScreen && this->CellView == view && this->CellSurface == ends.surfaceVersion &&
    (ends.depth ? *ends.depth == this->CellDepth : this->CellDepth.empty());
}

bool ComponentProjector::Project(const View& view, const ProjectionSettings& shown,
  const ProjectionSettings& wanted, const RayEnds& ends)
{
  const bool isOfCells = this->UsesCells(shown), usesCells = this->UsesCells(wanted);
  if (isOfCells ? !PixelRays().find(view) : !this->Next.set(view, ends))
  {
    return false;
  }
  // Of equal samples the nearest is located.
  const bool ordered = isOrdered(shown.reduction) || shown.recordLocations || this->Dependent;
  const bool isShown = this->IsUpToDate(shown) &&
    (isOfCells ? this->ShowsCells(view, ends)
               : !this->OnScreen && this->Next.projectsAs(this->Splat, ordered));
  // If one rank projects, all ranks project.
  const bool isKept = this->Ranks ? !this->Ranks->Any(!isShown) : isShown;
  if (!isKept && isOfCells && !usesCells && !this->Next.set(view, ends))
  {
    return false;
  }
  if (!isKept || !isOfCells)
  {
    std::swap(this->Splat, this->Next); // also of a kept projection, for its warp
  }
  if (isKept)
  {
    return true;
  }
  this->Projected = false;
  this->ShearImageOutput = nullptr;
  this->OnScreen = usesCells;
  this->Done = 0;
  this->Projected =
    usesCells ? this->ProjectCells(view, wanted, ends) : this->ProjectImages(wanted);
  this->Projections += this->Projected;
  return true;
}

bool ComponentProjector::HasWinners() const
{
  return this->Projected && (this->OnScreen || !this->Splat.geometries.empty()) &&
    this->LocatedChannel().Settings.recordLocations;
}

void ComponentProjector::Describe(const RayEnds& ends, Located& located) const
{
  const Channel& channel = this->LocatedChannel();
  located.ends = ends;
  if (this->OnScreen)
  {
    located.screen = channel.Settings.recordLocations ? &channel.Screen : nullptr;
  }
  else
  {
    located.ends.surface = nullptr; // is in the cuts
    located.images = &channel.Images;
    located.geometries = &this->Splat.geometries;
    located.cuts = &this->Splat.cuts;
  }
  located.volume = channel.Index.volume();
  if (this->Ranks)
  {
    located.volume.voxels = nullptr; // a piece does not contain all voxels
  }
  located.settings = channel.Settings;
  located.low = std::isfinite(channel.Range.low) ? channel.Range.low : 0.0;
  located.high = std::isfinite(channel.Range.high) ? channel.Range.high : 0.0;
}

bool ComponentProjector::CanProjectPixels() const
{
  return this->Projected && !this->Ranks &&
    this->LocatedChannel().Settings.reduction != Reduction::Mean;
}

Locator::Sample ComponentProjector::FindSample(const Located& located, const glm::ivec2& pixel)
{
  Channel& channel = this->LocatedChannel();
  return this->Pixels.Find(channel.Index, channel.Cells, located, pixel);
}

// Turns the images of pieces into those of the whole.
void ComponentProjector::Exchange(const ProjectionSettings& settings)
{
  for (std::size_t n = 0; n < this->Splat.geometries.size(); ++n)
  {
    const ShearWarp& geometry = this->Splat.geometries[n];
    for (Channel& channel : this->Channels)
    {
      this->Ranks->Reduce(channel.Images[n], geometry, settings.reduction);
      if (settings.reduction == Reduction::DepthShaded)
      {
        fillEmpty(channel.Images[n], channel.Range.low);
      }
      this->Projector.outline(geometry, settings, this->Splat.cuts[n], channel.Images[n]);
    }
  }
}

double ComponentProjector::OverallProgress(double done) const
{
  const std::size_t channels = this->TakesAtLocations(this->Settings()) ? 1 : this->Channels.size();
  return (this->Done + done) /
    static_cast<double>(channels * std::max<std::size_t>(this->Parts, 1));
}

void ComponentProjector::SetObserver(const ProgressObserver::Callback& callback)
{
  this->Projector.setObserver(callback);
  this->Cells.observer().setCallback(callback);
}

void ComponentProjector::UpdateCells(Channel& channel, const View& view)
{
  const glm::ivec3 first = this->Ranks ? this->Ranks->First() : glm::ivec3(0);
  const VolumeIndex::Range range = channel.Index.range();
  channel.Cells.update(
    CellGrid(channel.Index.volume(), first, view.dimensions, view.showsBoxes), range);
  channel.Range = range;
}

// Projects all components by cells. Returns false if it was stopped.
bool ComponentProjector::ProjectCells(
  const View& view, const ProjectionSettings& settings, const RayEnds& ends)
{
  this->Splat = {};
  this->Parts = 1;
  bool done = true;
  for (Channel& channel : this->Channels)
  {
    channel.Settings = this->SettingsOf(channel, settings);
    channel.Used = Acceleration::Bricks;
    if (done)
    {
      this->UpdateCells(channel, view);
      const bool locate = channel.Settings.recordLocations;
      done = this->Ranks
        ? this->Cells.projectPiece(
            channel.Cells, view, channel.Settings, ends, locate, channel.Screen)
        : this->Cells.project(channel.Cells, view, channel.Settings, ends, locate, channel.Screen);
      ++this->Done;
    }
  }
  // If one rank stops, all ranks stop.
  if (this->Ranks ? this->Ranks->Any(!done) : !done)
  {
    return false;
  }
  for (Channel& channel : this->Channels)
  {
    if (this->Ranks && !channel.Screen.bytes.empty())
    {
      this->Ranks->Reduce(channel.Screen);
      CellProjector::finish(channel.Cells, channel.Settings, channel.Screen);
    }
  }
  this->CellView = view;
  this->CellSurface = ends.surfaceVersion;
  ends.depth ? void(this->CellDepth = *ends.depth) : this->CellDepth.clear();
  return true;
}

template <class F>
bool ComponentProjector::ForScreens(const View& view, const F& f)
{
  const std::vector<ShearWarp>& geometries = this->Splat.geometries;
  // In overviews the other components are taken from the sample that the area shows.
  const Channel& last = this->Channels.back();
  const bool takesPixels = !this->OnScreen && !geometries.empty() &&
    geometries.front().minifiesAnyAxis() && this->TakesAtLocations(last.Settings);
  if (takesPixels)
  {
    this->Shown.find(last.Images, geometries, last.Settings.reduction, view.viewport);
  }
  for (std::size_t c = 0; c < this->Channels.size(); ++c)
  {
    const Channel& channel = this->Channels[c];
    if (this->OnScreen)
    {
      f(c, channel.Screen);
    }
    else if (takesPixels)
    {
      this->Shown.set(channel.Images);
      f(c, this->Shown);
    }
    else
    {
      this->Warped.set(channel.Images, geometries, channel.Settings.reduction, view.viewport,
        channel.Settings.instructionSet);
      f(c, this->Warped);
      if (this->Warped.stopped())
      {
        return false;
      }
    }
  }
  return true;
}

bool ComponentProjector::MakePicture(const View& view, Picture& picture)
{
  return this->ForScreens(view,
    [&](std::size_t c, const ScreenScalars& screen)
    {
      Picture& layer = c == 0 ? picture : this->Layer;
      colorScreen(screen, this->Colors.Of(c), this->Settings().instructionSet, layer);
      if (c > 0)
      {
        this->Dependent&& c + 1 == this->Channels.size() ? multiplyByOpacity(layer, picture)
                                                         : addSaturated(layer, picture);
      }
    });
}

bool ComponentProjector::CopyScalars(const View& view, double background, void* scalars)
{
  const std::size_t components = this->Channels.size();
  const std::size_t pixels = std::size_t(view.viewport.x) * view.viewport.y;
  const auto copy = [&](auto* to)
  {
    using A = std::remove_pointer_t<decltype(to)>;
    this->Plane.resize(components > 1 ? pixels * sizeof(A) : 0);
    A* const plane = components > 1 ? reinterpret_cast<A*>(this->Plane.data()) : to;
    return this->ForScreens(view,
      [&](std::size_t c, const ScreenScalars& screen)
      {
        std::fill_n(plane, pixels, static_cast<A>(background));
        copyScreen(screen, view.viewport, plane);
        for (std::size_t n = 0; components > 1 && n < pixels; ++n)
        {
          to[n * components + c] = plane[n];
        }
      });
  };
  return averageType(this->VolumeType()) == ScalarType::Float32
    ? copy(static_cast<float*>(scalars))
    : copy(static_cast<double*>(scalars));
}

vtkImageData* ComponentProjector::ShearImageOf(const ScalarSource& source)
{
  const ShearWarp* const geometry = this->MainImage();
  if (!geometry)
  {
    this->ShearImageOutput = nullptr;
  }
  else if (!this->ShearImageOutput)
  {
    std::vector<const ShearImage*> images;
    for (const Channel& channel : this->Channels)
    {
      images.push_back(&channel.Images[geometry - this->Splat.geometries.data()]);
    }
    this->ShearImageOutput =
      makeShearImage(images, *geometry, source.VtkTypeOf(images.front()->type));
  }
  return this->ShearImageOutput;
}
}
