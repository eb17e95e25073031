// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComponentProjector.h"

#include "Display/ScreenColors.h"
#include "Input/ScalarSource.h"
#include "PieceExchange.h"
#include "Projection/Piece.h"
#include "Projection/SignedMaximum.h"
#include "Volume/VoxelCopies.h"

#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace splatting
{
std::size_t mainImage(const std::vector<ShearWarp>& images)
{
  const auto largest = std::max_element(images.begin(), images.end(),
    [](const ShearWarp& a, const ShearWarp& b)
    { return a.rayCount().x * a.rayCount().y < b.rayCount().x * b.rayCount().y; });
  return static_cast<std::size_t>(largest - images.begin());
}

bool haveSameRays(const std::vector<ShearWarp>& a, const std::vector<ShearWarp>& b, bool ordered)
{
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
    [=](const ShearWarp& left, const ShearWarp& right)
    { return left.sameShear(right) && (!ordered || left.reversed() == right.reversed()); });
}

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
    settings.quality = Quality::High; // takeAtLocations() takes averages
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

bool ComponentProjector::ProjectChannel(Channel& channel, ShearImage& image,
  const ShearWarp& geometry, const ProjectionSettings& settings, const Cuts& cuts)
{
  channel.Settings = this->SettingsOf(channel, settings);
  if (this->Ranks && !channel.Index.volume().voxels)
  {
    image.nonFinite = channel.Index.range().nonFinite;
    blank(geometry, channel.Index.volume().type, channel.Settings, image);
    ++this->Done;
    return true;
  }
  const Acceleration used = this->Projector.project(channel.Index, geometry, channel.Settings, cuts,
    image, this->Ranks ? this->Ranks->First() : glm::ivec3(0));
  if (this->Projector.stopped())
  {
    return false;
  }
  channel.Used = used;
  channel.Range = channel.Index.range();
  ++this->Done;
  return true;
}

// Projects one image of all components. takeAtLocations() must follow the projection directly,
// because it uses the projector's state.
bool ComponentProjector::ProjectImage(
  std::size_t n, const ShearWarp& geometry, const ProjectionSettings& settings, const Cuts& cuts)
{
  if (!this->TakesAtLocations(settings))
  {
    return std::all_of(this->Channels.begin(), this->Channels.end(),
      [&](Channel& channel)
      { return this->ProjectChannel(channel, channel.Images[n], geometry, settings, cuts); });
  }
  Channel& last = this->Channels.back();
  const ShearImage& winners = last.Images[n];
  if (!this->ProjectChannel(last, last.Images[n], geometry, settings, cuts))
  {
    return false;
  }
  for (Channel& channel : this->Channels)
  {
    if (&channel != &last)
    {
      channel.Settings = last.Settings;
      channel.Used = last.Used;
      this->Projector.takeAtLocations(
        channel.Index.volume(), geometry, last.Settings, winners, channel.Images[n]);
    }
  }
  return true;
}

bool ComponentProjector::Project(const std::vector<ShearWarp>& geometries,
  const ProjectionSettings& settings, const std::vector<Cuts>& cuts)
{
  this->Projected = false;
  this->OnScreen = false;
  this->Done = 0;
  this->Parts = geometries.size();
  for (Channel& channel : this->Channels)
  {
    channel.Images.resize(std::max(channel.Images.size(), geometries.size()));
    channel.Settings = this->SettingsOf(channel, settings); // also if there is no image
  }
  bool done = true;
  for (std::size_t n = 0; n < geometries.size() && done; ++n)
  {
    done = this->ProjectImage(n, geometries[n], settings, cuts[n]);
  }
  // If one rank stops, all ranks stop.
  if (this->Ranks ? this->Ranks->Any(!done) : !done)
  {
    return false;
  }
  if (this->Ranks)
  {
    this->Exchange(geometries, settings, cuts);
  }
  this->Projected = true;
  return true;
}

bool ComponentProjector::HasWinners() const
{
  return this->Projected && this->LocatedChannel().Settings.recordLocations;
}

void ComponentProjector::Describe(Located& located) const
{
  const Channel& channel = this->LocatedChannel();
  located.images = this->OnScreen ? nullptr : &channel.Images;
  located.screen = this->OnScreen ? &channel.Screen : nullptr;
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

const PixelProjector::Pixel& ComponentProjector::ProjectPixel(const ProjectionSettings& settings,
  const ShearPixel& pixel, const std::vector<ShearWarp>& geometries, const std::vector<Cuts>& cuts)
{
  return this->Pixels.Project(this->LocatedChannel().Index, settings, pixel, geometries, cuts);
}

// Turns the images of pieces into those of the whole.
void ComponentProjector::Exchange(const std::vector<ShearWarp>& geometries,
  const ProjectionSettings& settings, const std::vector<Cuts>& cuts)
{
  for (std::size_t n = 0; n < geometries.size(); ++n)
  {
    for (Channel& channel : this->Channels)
    {
      this->Ranks->Reduce(channel.Images[n], geometries[n], settings.reduction);
      if (settings.reduction == Reduction::DepthShaded)
      {
        fillEmpty(channel.Images[n], channel.Range.low);
      }
      this->Projector.outline(geometries[n], settings, cuts[n], channel.Images[n]);
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

bool ComponentProjector::ProjectOnScreen(
  const View& view, const ProjectionSettings& settings, const RayEnds& ends)
{
  this->Projected = false;
  this->OnScreen = true;
  this->Done = 0;
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
  this->Projected = true;
  return true;
}

const CellScalars& ComponentProjector::ProjectPixelOnScreen(
  const View& view, ProjectionSettings settings, const RayEnds& ends, const glm::ivec2& pixel)
{
  settings.floor = ProjectionSettings().floor; // samples below the window are located, too
  Channel& channel = this->LocatedChannel();
  this->UpdateCells(channel, view);
  CellProjector projector; // without an observer
  if (!projector.project(
        channel.Cells, view, settings, ends, true, { pixel, glm::ivec2(1) }, this->PixelOnScreen))
  {
    this->PixelOnScreen.size = glm::ivec2(0);
  }
  return this->PixelOnScreen;
}

template <class F>
bool ComponentProjector::ForScreens(
  const std::vector<ShearWarp>& geometries, const View& view, const F& f)
{
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

bool ComponentProjector::MakePicture(
  const std::vector<ShearWarp>& geometries, const View& view, Picture& picture)
{
  return this->ForScreens(geometries, view,
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

bool ComponentProjector::CopyScalars(
  const std::vector<ShearWarp>& geometries, const View& view, double background, void* scalars)
{
  const std::size_t components = this->Channels.size();
  const std::size_t pixels = std::size_t(view.viewport.x) * view.viewport.y;
  const auto copy = [&](auto* to)
  {
    using A = std::remove_pointer_t<decltype(to)>;
    this->Plane.resize(components > 1 ? pixels * sizeof(A) : 0);
    A* const plane = components > 1 ? reinterpret_cast<A*>(this->Plane.data()) : to;
    return this->ForScreens(geometries, view,
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

vtkSmartPointer<vtkImageData> ComponentProjector::MakeShearImage(
  const std::vector<ShearWarp>& geometries, const ScalarSource& source) const
{
  const auto output = vtkSmartPointer<vtkImageData>::New();
  const std::size_t n = mainImage(geometries);
  const ShearWarp& geometry = geometries[n];
  const ShearImage& first = this->Channels.front().Images[n];
  const std::size_t components = this->Channels.size(), size = sizeOf(first.type);
  output->SetDimensions(first.width, first.height, 1);
  output->SetOrigin(geometry.columns().at.front(), geometry.rows().at.front(), 0.0);
  output->SetSpacing(geometry.pitch(), geometry.pitch(), 1.0);
  output->AllocateScalars(source.VtkTypeOf(first.type), static_cast<int>(components));
  const std::size_t pixels = static_cast<std::size_t>(output->GetNumberOfPoints());
  auto* const scalars = static_cast<unsigned char*>(output->GetScalarPointer());
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(output->GetNumberOfPoints());
  ghosts->Fill(vtkDataSetAttributes::HIDDENPOINT);
  for (std::size_t c = 0; c < components; ++c)
  {
    const ShearImage& projected = this->Channels[c].Images[n];
    const ShearImage combined = projected.minima.empty() ? ShearImage() : shownValues(projected);
    const ShearImage& image = projected.minima.empty() ? projected : combined;
    for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    {
      std::memcpy(
        scalars + (pixel * components + c) * size, image.bytes.data() + pixel * size, size);
      const int u = static_cast<int>(pixel % image.width),
                v = static_cast<int>(pixel / image.width);
      const vtkIdType id = static_cast<vtkIdType>(pixel);
      if (image.covers(u, v) &&
        !std::isnan(output->GetPointData()->GetScalars()->GetComponent(id, static_cast<int>(c))))
      {
        ghosts->SetValue(id, 0);
      }
    }
  }
  output->GetPointData()->AddArray(ghosts);
  return output;
}
}
