// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ComponentProjector.h"

#include "RankAgreement.h"
#include "ScalarSource.h"

#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

//------------------------------------------------------------------------------
bool ComponentProjector::LookAt(ScalarSource& source)
{
  source.Update();
  this->Dependent = source.AreDependent();
  if (this->Version == source.Version())
  {
    return false;
  }
  const splatting::VoxelArray before = this->Channels.front().Index.volume();
  const splatting::VoxelArray now = source.Volume(0);
  const std::size_t components = source.Components();
  const bool differs = before.dimensions != now.dimensions || before.type != now.type ||
    this->Channels.size() != components;
  this->Version = source.Version();
  this->Channels.resize(components);
  for (std::size_t c = 0; c < components; ++c)
  {
    this->Channels[c].Index.reset(source.Volume(static_cast<int>(c)));
    this->Channels[c].Here.reset();
    this->Channels[c].Whole.reset();
  }
  this->Projected = false;
  this->Colored = false;
  return differs;
}

//------------------------------------------------------------------------------
void ComponentProjector::LookAtNothing(splatting::ScalarType type, std::size_t components)
{
  const splatting::VolumeIndex& before = this->Channels.front().Index;
  if (before.volume().voxels || before.volume().type != type || this->Channels.size() != components)
  {
    this->Channels.resize(components);
    for (Channel& channel : this->Channels)
    {
      channel.Index.reset({ nullptr, type, glm::ivec3(0) });
      channel.Whole.reset();
    }
    this->Dependent = false;
    this->Version = 0;
    this->Projected = false;
    this->Colored = false;
  }
}

//------------------------------------------------------------------------------
void ComponentProjector::Describe(const ScalarSource& source, RankReport& report)
{
  report.cells = source.Grid().cells;
  report.vtkType = source.GetVtkType();
  report.type = static_cast<std::int32_t>(this->Channels.front().Index.volume().type);
  report.components = static_cast<std::int32_t>(this->Channels.size());
  for (std::size_t c = 0; c < this->Channels.size(); ++c)
  {
    Channel& channel = this->Channels[c];
    if (!channel.Here)
    {
      channel.Here = channel.Index.range();
    }
    report.ranges[c] = { channel.Here->low, channel.Here->high, channel.Here->special ? 1.0 : 0.0 };
  }
  if (this->Dependent)
  {
    report.setProblem(
      "Several ranks do not project dependent components, which go with the place of "
      "the maximum: set IndependentComponents of the vtkVolumeProperty.");
  }
}

//------------------------------------------------------------------------------
void ComponentProjector::SetRanks(RankAgreement* ranks)
{
  this->Projected = this->Projected && this->Ranks == ranks;
  this->Ranks = ranks;
  for (std::size_t c = 0; c < this->Channels.size(); ++c)
  {
    Channel& channel = this->Channels[c];
    if (!ranks)
    {
      if (channel.Whole) // what the index knows is of that
      {
        channel.Index.reset(channel.Index.volume());
        channel.Whole.reset();
        this->Colored = this->Projected = false;
      }
      continue;
    }
    const auto& range = ranks->Common().ranges[c];
    if (!channel.Whole || channel.Whole->low != range.low || channel.Whole->high != range.high ||
      channel.Whole->special != (range.special != 0.0))
    {
      this->Colored = this->Projected = false;
    }
    channel.Whole = { range.low, range.high, range.special != 0.0 };
    channel.Index.setRangeOfWhole(*channel.Whole); // again if the budget has changed
  }
}

//------------------------------------------------------------------------------
bool ComponentProjector::SetBudget(std::size_t bytes)
{
  bool changed = false;
  for (Channel& channel : this->Channels)
  {
    changed = channel.Index.setBudget(bytes / this->Channels.size()) || changed;
  }
  this->Projected = this->Projected && !changed; // so that the answer to "what was used" is right
  return changed;
}

//------------------------------------------------------------------------------
bool ComponentProjector::ExceedsBudget() const
{
  return std::any_of(this->Channels.begin(), this->Channels.end(),
    [](const Channel& channel) { return channel.Index.exceedsBudget(); });
}

//------------------------------------------------------------------------------
std::size_t ComponentProjector::MemorySize() const
{
  std::size_t size = 0;
  for (const Channel& channel : this->Channels)
  {
    size += channel.Index.memorySize();
  }
  return size;
}

//------------------------------------------------------------------------------
double ComponentProjector::Time() const
{
  double seconds = 0.0;
  for (const Channel& channel : this->Channels)
  {
    seconds += channel.Index.time();
  }
  return seconds;
}

//------------------------------------------------------------------------------
// Of what is projected: depth shading can leave the range of the voxels.
ScalarRange ComponentProjector::RangeOf(Channel& channel) const
{
  const splatting::VolumeIndex::Range& range = channel.Index.range();
  const bool integers = channel.Index.volume().type < splatting::ScalarType::Float32;
  if (this->Shading[0] >= 0.0 && this->Shading[1] <= 1.0)
  {
    return { range.low, range.high, integers };
  }
  const double low = std::isfinite(range.low) ? range.low : 0.0;
  return { std::min(range.low, low + this->Shading[0] * (range.high - low)),
    std::max(range.high, low + this->Shading[1] * (range.high - low)), integers };
}

//------------------------------------------------------------------------------
splatting::ColorTable ComponentProjector::ColorsOf(
  int channel, vtkVolumeProperty* property, const FinalColor& finalColor)
{
  const ScalarRange scalars = this->RangeOf(this->Channels[channel]);
  const int components = static_cast<int>(this->Channels.size());
  if (!this->Dependent)
  {
    const double weight = components > 1 ? property->GetComponentWeight(channel) : 1.0;
    return tabulateColors(property, channel, weight, scalars, finalColor);
  }
  if (channel == components - 1)
  {
    return tabulateOpacity(property, scalars);
  }
  return components == 2 ? tabulateOpaque(property, scalars, finalColor)
                         : tabulatePrimary(channel, finalColor);
}

//------------------------------------------------------------------------------
void ComponentProjector::UpdateColors(vtkVolumeProperty* property, const FinalColor& finalColor,
  const splatting::ProjectionSettings& settings)
{
  double shading[2] = { 0.0, 1.0 };
  if (settings.reduction == splatting::Reduction::DepthShaded)
  {
    const double nearest = settings.ambient + settings.changeRate;
    shading[0] = std::min({ 0.0, settings.ambient, nearest });
    shading[1] = std::max({ 1.0, settings.ambient, nearest });
  }
  if (this->Colored && std::equal(shading, shading + 2, this->Shading) &&
    this->ColoredBy == property && this->ColorTime == property->GetMTime() &&
    this->ColoredFor == finalColor)
  {
    return;
  }
  std::copy(shading, shading + 2, this->Shading);
  for (std::size_t c = 0; c < this->Channels.size(); ++c)
  {
    this->Channels[c].Colors = this->ColorsOf(static_cast<int>(c), property, finalColor);
  }
  this->ColoredFor = finalColor;
  this->ColoredBy = property;
  this->ColorTime = property->GetMTime();
  this->Colored = true;
}

//------------------------------------------------------------------------------
// The scalar up to which all have the colour of the lowest.
double ComponentProjector::Channel::FloorOfWindow() const
{
  const std::vector<std::uint32_t>& colors = this->Colors.colors;
  const auto last = std::adjacent_find(colors.begin(), colors.end(), std::not_equal_to<>());
  const double steps = std::max<double>(static_cast<double>(colors.size()) - 1.0, 1.0);
  const double share =
    last == colors.end() ? 1.0 : static_cast<double>(last - colors.begin()) / steps;
  return this->Colors.low + share * (this->Colors.high - this->Colors.low);
}

//------------------------------------------------------------------------------
// Whether all but the last component go with the winners.
bool ComponentProjector::Carries(const splatting::ProjectionSettings& settings) const
{
  return this->Dependent && settings.reduction != splatting::Reduction::Mean;
}

//------------------------------------------------------------------------------
splatting::ProjectionSettings ComponentProjector::SettingsOf(
  const Channel& channel, splatting::ProjectionSettings settings) const
{
  settings.keepWinners = this->Carries(settings);
  // Colours that are carried matter below the window, too.
  if (this->Cull && !this->Dependent && settings.reduction == splatting::Reduction::Maximum)
  {
    settings.floor = channel.FloorOfWindow();
  }
  return settings;
}

//------------------------------------------------------------------------------
bool ComponentProjector::Shows(const splatting::ProjectionSettings& settings) const
{
  return this->Projected &&
    std::all_of(this->Channels.begin(), this->Channels.end(),
      [&](const Channel& channel)
      { return this->SettingsOf(channel, settings) == channel.Settings; });
}

//------------------------------------------------------------------------------
bool ComponentProjector::ProjectChannel(Channel& channel, std::size_t n,
  const splatting::ShearWarp& geometry, const splatting::ProjectionSettings& settings,
  const splatting::Cuts& cuts)
{
  channel.Settings = this->SettingsOf(channel, settings);
  if (this->Ranks && !channel.Index.volume().voxels)
  {
    splatting::blank(geometry, channel.Index.volume().type, channel.Settings, channel.Images[n]);
    channel.Images[n].special = channel.Index.range().special;
    ++this->Done;
    return true;
  }
  const splatting::Acceleration used = this->Projector.project(channel.Index, geometry,
    channel.Settings, cuts, channel.Images[n], this->Ranks ? this->Ranks->First() : glm::ivec3(0));
  if (this->Projector.stopped())
  {
    return false;
  }
  channel.Used = used;
  ++this->Done;
  return true;
}

//------------------------------------------------------------------------------
// One image of all channels: what is carried needs the projector as the projection has left it.
bool ComponentProjector::ProjectImage(std::size_t n, const splatting::ShearWarp& geometry,
  const splatting::ProjectionSettings& settings, const splatting::Cuts& cuts)
{
  if (!this->Carries(settings))
  {
    return std::all_of(this->Channels.begin(), this->Channels.end(),
      [&](Channel& channel) { return this->ProjectChannel(channel, n, geometry, settings, cuts); });
  }
  Channel& last = this->Channels.back();
  if (!this->ProjectChannel(last, n, geometry, settings, cuts))
  {
    return false;
  }
  for (Channel& channel : this->Channels)
  {
    if (&channel != &last)
    {
      channel.Settings = last.Settings;
      channel.Used = last.Used;
      this->Projector.carry(
        channel.Index.volume(), geometry, last.Settings, last.Images[n], channel.Images[n]);
    }
  }
  return true;
}

//------------------------------------------------------------------------------
bool ComponentProjector::Project(const std::vector<splatting::ShearWarp>& geometries,
  const splatting::ProjectionSettings& settings, const std::vector<splatting::Cuts>& cuts)
{
  this->Projected = false;
  this->Done = 0;
  this->Images = geometries.size();
  for (Channel& channel : this->Channels)
  {
    channel.Images.resize(std::max(channel.Images.size(), this->Images));
    channel.Settings = this->SettingsOf(channel, settings); // there may be no image
  }
  bool done = true;
  for (std::size_t n = 0; n < this->Images && done; ++n)
  {
    done = this->ProjectImage(n, geometries[n], settings, cuts[n]);
  }
  // Where one rank has stopped all do.
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

//------------------------------------------------------------------------------
// From the images of pieces to those of the whole.
void ComponentProjector::Exchange(const std::vector<splatting::ShearWarp>& geometries,
  const splatting::ProjectionSettings& settings, const std::vector<splatting::Cuts>& cuts)
{
  for (std::size_t n = 0; n < this->Images; ++n)
  {
    for (Channel& channel : this->Channels)
    {
      this->Ranks->Reduce(channel.Images[n], settings.reduction);
      this->Projector.outline(geometries[n], settings, cuts[n], channel.Images[n]);
    }
  }
}

//------------------------------------------------------------------------------
double ComponentProjector::ShareOfAll(double done) const
{
  const std::size_t channels = this->Carries(this->Settings()) ? 1 : this->Channels.size();
  return (this->Done + done) /
    static_cast<double>(channels * std::max<std::size_t>(this->Images, 1));
}

//------------------------------------------------------------------------------
void ComponentProjector::Warp(const std::vector<splatting::ShearWarp>& geometries,
  const splatting::View& view, splatting::Picture& picture)
{
  for (Channel& channel : this->Channels)
  {
    const bool first = &channel == &this->Channels.front();
    this->Warper.warp(channel.Images, geometries, channel.Colors, view.viewport,
      channel.Settings.instructionSet, first ? picture : this->Layer);
    if (first)
    {
      continue;
    }
    if (this->Dependent && &channel == &this->Channels.back())
    {
      splatting::multiplyByOpacity(this->Layer, picture);
    }
    else
    {
      splatting::addSaturated(this->Layer, picture);
    }
  }
}

//------------------------------------------------------------------------------
void ComponentProjector::CopyImage(
  std::size_t n, const splatting::ShearWarp& geometry, int vtkType, vtkImageData* output) const
{
  const splatting::ShearImage& first = this->Channels.front().Images[n];
  const std::size_t components = this->Channels.size(), size = splatting::sizeOf(first.type);
  output->SetDimensions(first.width, first.height, 1);
  output->SetOrigin(geometry.columns().at.front(), geometry.rows().at.front(), 0.0);
  output->SetSpacing(geometry.pitch(), geometry.pitch(), 1.0);
  output->AllocateScalars(vtkType, static_cast<int>(components));
  const std::size_t pixels = static_cast<std::size_t>(output->GetNumberOfPoints());
  auto* const scalars = static_cast<unsigned char*>(output->GetScalarPointer());
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfValues(output->GetNumberOfPoints());
  ghosts->Fill(vtkDataSetAttributes::HIDDENPOINT);
  for (std::size_t c = 0; c < components; ++c)
  {
    const splatting::ShearImage& image = this->Channels[c].Images[n];
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
}
