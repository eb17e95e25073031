// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "BenchmarkCases.h"

#include "MemoryFloor.h"
#include "PeakMemory.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace
{
bool failed = false;

void Fail(benchmark::State& state, const char* reason)
{
  failed = true;
  state.SkipWithError(reason);
}

double Median(std::vector<double> values)
{
  if (values.empty())
  {
    return 0.0;
  }
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The seconds that each view took, pass by pass.
class ViewTimes
{
public:
  explicit ViewTimes(int views) : Seconds(views) {}

  /// The frame counts through the views, pass by pass; this is the stage's number of the view.
  int GetView(std::size_t frame) const
  {
    const std::size_t views = this->Seconds.size();
    const std::size_t middle = 2 * (frame % views) + 1;
    return static_cast<int>(middle * BenchmarkStage::NumberOfViews / (2 * views));
  }

  void Add(std::size_t frame, double seconds)
  {
    this->Seconds[frame % this->Seconds.size()].push_back(seconds);
  }

  void Report(benchmark::State& state) const
  {
    std::vector<double> views;
    for (const std::vector<double>& passes : this->Seconds)
    {
      views.push_back(1e3 * Median(passes));
    }
    state.counters["views"] = static_cast<double>(views.size());
    state.counters["median_ms"] = Median(views);
    state.counters["worst_ms"] = *std::max_element(views.begin(), views.end());
  }

private:
  std::vector<std::vector<double>> Seconds;
};

/// Draws a frame that is not measured with every kind of mapper, because shaders are compiled once
/// in the life of a program, and whoever came first would pay for it.
void WarmUp(const BenchmarkMapper& mapper, vtkImageData* image)
{
  static std::set<std::string> known;
  if (known.insert(mapper.Name).second)
  {
    BenchmarkStage& stage = BenchmarkStage::GetInstance();
    stage.SetSize(64);
    stage.SetMapper(mapper, image);
    stage.LookFrom(BenchmarkStage::ViewsOfAxes[0]);
    stage.MeasureFrame();
    stage.Clear();
  }
}

double MeasureFirstFrame(const BenchmarkMapper& mapper, vtkImageData* image, int view)
{
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  stage.SetMapper(mapper, image);
  stage.LookFrom(view);
  return stage.MeasureFrame();
}

/// One frame along each axis with the present mapper.
void ShowEachAxis()
{
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  for (int view : BenchmarkStage::ViewsOfAxes)
  {
    stage.LookFrom(view);
    stage.MeasureFrame();
  }
}

/// The slowest first frame; the last of the mappers stays.
double MeasureFirstFrames(const BenchmarkMapper& mapper, vtkImageData* image)
{
  double slowest = 0.0;
  for (int view : BenchmarkStage::ViewsOfAxes)
  {
    slowest = std::max(slowest, MeasureFirstFrame(mapper, image, view));
  }
  return slowest;
}

/// A sentence if the last frames do not show what was to be measured.
const char* FindFault(vtkSplattingMIPVolumeMapper* splatting, vtkIdType projections)
{
  if (splatting && splatting->GetLastRenderUsedRayCasting())
  {
    return "the splatting mapper has ray cast";
  }
  if (splatting && splatting->GetNumberOfProjections() != projections)
  {
    return "not every view was projected";
  }
  return BenchmarkStage::GetInstance().IsFrameEmpty() ? "the picture is empty" : nullptr;
}

/// Goes through the views. Of each frame, a function that is given the frame's seconds returns the
/// seconds that count.
template <class Function>
void Rotate(benchmark::State& state, const BenchmarkRotation& rotation, Function chooseSeconds)
{
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  auto* splatting = vtkSplattingMIPVolumeMapper::SafeDownCast(stage.GetMapper());
  const vtkIdType before = splatting ? splatting->GetNumberOfProjections() : 0;
  ViewTimes times(rotation.Views);
  vtkIdType frame = 0;
  for (auto _ : state)
  {
    stage.LookFrom(times.GetView(frame));
    const double seconds = chooseSeconds(stage.MeasureFrame());
    state.SetIterationTime(seconds);
    times.Add(frame++, seconds);
  }
  times.Report(state);
  if (const char* fault = FindFault(splatting, before + frame))
  {
    Fail(state, fault);
  }
}

/// A window in which no volume is an overview, whose projections are others.
vtkSplattingMIPVolumeMapper* ShowProjections(const BenchmarkMapper& mapper, vtkImageData* image)
{
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  stage.SetSize(1024);
  stage.SetMapper(mapper, image);
  return vtkSplattingMIPVolumeMapper::SafeDownCast(stage.GetMapper());
}

void AddPlane(vtkVolumeMapper* mapper, const double origin[3], double x, double y, double z)
{
  vtkNew<vtkPlane> plane;
  plane->SetOrigin(origin[0], origin[1], origin[2]);
  plane->SetNormal(x, y, z);
  mapper->AddClippingPlane(plane);
}

/// The margin is a share of the size.
void AddBox(vtkVolumeMapper* mapper, const double bounds[6], double margin)
{
  for (int side = 0; side < 6; ++side)
  {
    const int axis = side / 2;
    const double inwards = side % 2 ? -1.0 : 1.0;
    double origin[3] = { 0.0, 0.0, 0.0 };
    origin[axis] = bounds[side] + inwards * margin * (bounds[2 * axis + 1] - bounds[2 * axis]);
    AddPlane(mapper, origin, axis == 0 ? inwards : 0.0, axis == 1 ? inwards : 0.0,
      axis == 2 ? inwards : 0.0);
  }
}

void AddCut(vtkVolumeMapper* mapper, vtkImageData* image, BenchmarkCut cut)
{
  switch (cut)
  {
    case BenchmarkCut::NONE:
      break;
    case BenchmarkCut::PLANE:
      AddPlane(mapper, image->GetCenter(), 1.0, 0.0, 1.0);
      break;
    case BenchmarkCut::BOX:
      AddBox(mapper, image->GetBounds(), 0.2);
      break;
  }
}

/// Nullptr, and the benchmark has failed, if the volume cannot be read.
vtkImageData* LoadOrFail(benchmark::State& state, const BenchmarkVolume& volume)
{
  vtkImageData* image = LoadVolume(volume);
  if (!image)
  {
    Fail(state, "the volume cannot be read");
  }
  return image;
}
}

//------------------------------------------------------------------------------
void MeasureFrames(benchmark::State& state, const BenchmarkVolume& volume, int window,
  const BenchmarkMapper& mapper, const BenchmarkRotation& rotation)
{
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  if (!stage.IsSupported(mapper))
  {
    state.SkipWithError("this OpenGL cannot run the mapper");
    return;
  }
  vtkImageData* image = LoadOrFail(state, volume);
  if (!image)
  {
    return;
  }
  WarmUp(mapper, image);
  stage.SetSize(window);
  const PeakMemory memory;
  state.counters["first_ms"] = 1e3 * MeasureFirstFrames(mapper, image);
  if (mapper.Kind == BenchmarkMapper::SPLATTING)
  {
    ShowEachAxis(); // it makes a copy for one of the axes; that is a matter of first frames
  }
  Rotate(state, rotation, [](double seconds) { return seconds; });
  if (memory.GetGrowth() >= 0.0)
  {
    state.counters["peak_MB"] = memory.GetGrowth();
  }
  stage.Clear();
}

//------------------------------------------------------------------------------
void MeasureRecoloring(benchmark::State& state, const BenchmarkVolume& volume, int window,
  const BenchmarkMapper& mapper, const BenchmarkRotation& rotation)
{
  vtkImageData* image = LoadOrFail(state, volume);
  if (!image)
  {
    return;
  }
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  stage.SetSize(window);
  stage.SetMapper(mapper, image);
  auto* splatting = vtkSplattingMIPVolumeMapper::SafeDownCast(stage.GetMapper());
  ShowEachAxis();
  const vtkIdType before = splatting->GetNumberOfProjections();
  ViewTimes times(rotation.Views);
  std::vector<double> turns;
  vtkIdType frame = 0;
  for (auto _ : state)
  {
    stage.LookFrom(times.GetView(frame));
    turns.push_back(1e3 * stage.MeasureFrame());
    stage.SetWhite(frame % 2 ? 1.0 : 0.8);
    const double seconds = stage.MeasureFrame();
    state.SetIterationTime(seconds);
    times.Add(frame++, seconds);
  }
  times.Report(state);
  state.counters["share"] = state.counters["median_ms"] / Median(turns);
  if (const char* fault = FindFault(splatting, before + frame))
  {
    Fail(state, fault);
  }
  stage.Clear();
}

//------------------------------------------------------------------------------
void MeasureProjections(benchmark::State& state, const BenchmarkVolume& volume,
  const BenchmarkMapper& mapper, const BenchmarkRotation& rotation, BenchmarkCut cut)
{
  vtkImageData* image = LoadOrFail(state, volume);
  if (!image)
  {
    return;
  }
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  auto* splatting = ShowProjections(mapper, image);
  AddCut(splatting, image, cut);
  ShowEachAxis();
  Rotate(state, rotation, [=](double) { return splatting->GetProjectionTime(); });
  stage.Clear();
}

//------------------------------------------------------------------------------
void MeasureLocations(benchmark::State& state, const BenchmarkVolume& volume,
  const BenchmarkMapper& mapper, const BenchmarkRotation& rotation)
{
  vtkImageData* image = LoadOrFail(state, volume);
  if (!image)
  {
    return;
  }
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  auto* splatting = ShowProjections(mapper, image);
  splatting->RecordLocationsOn();
  ShowEachAxis();
  Rotate(state, rotation, [=](double) { return splatting->GetProjectionTime(); });
  stage.Clear();
}

//------------------------------------------------------------------------------
void MeasureIndex(benchmark::State& state, const BenchmarkVolume& volume)
{
  vtkImageData* image = LoadOrFail(state, volume);
  if (!image)
  {
    return;
  }
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  stage.SetSize(64);
  std::vector<double> times;
  for (auto _ : state)
  {
    stage.SetMapper(GetBenchmarkMappers()[0], image);
    stage.LookFrom(BenchmarkStage::ViewsOfAxes[2]); // not along the axis that needs a copy
    stage.MeasureFrame();
    times.push_back(vtkSplattingMIPVolumeMapper::SafeDownCast(stage.GetMapper())->GetIndexTime());
    state.SetIterationTime(times.back());
  }
  state.counters["median_ms"] = 1e3 * Median(times);
  stage.Clear();
}

//------------------------------------------------------------------------------
void MeasureFirst(
  benchmark::State& state, const BenchmarkVolume& volume, const BenchmarkMapper& mapper)
{
  vtkImageData* image = LoadOrFail(state, volume);
  if (!image)
  {
    return;
  }
  BenchmarkStage& stage = BenchmarkStage::GetInstance();
  WarmUp(mapper, image);
  stage.SetSize(300);
  std::vector<double> times;
  for (auto _ : state)
  {
    times.push_back(MeasureFirstFrames(mapper, image));
    state.SetIterationTime(times.back());
  }
  state.counters["median_ms"] = 1e3 * Median(times);
  stage.Clear();
}

//------------------------------------------------------------------------------
void MeasureFloor(benchmark::State& state, const BenchmarkVolume& volume)
{
  vtkImageData* image = LoadOrFail(state, volume);
  if (!image)
  {
    return;
  }
  vtkDataArray* scalars = image->GetPointData()->GetScalars();
  const auto* bytes = static_cast<const unsigned char*>(scalars->GetVoidPointer(0));
  const std::size_t count =
    static_cast<std::size_t>(scalars->GetNumberOfValues()) * scalars->GetDataTypeSize();
  std::vector<double> times;
  for (auto _ : state)
  {
    const auto start = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(LargestByte(bytes, count));
    const auto end = std::chrono::steady_clock::now();
    times.push_back(std::chrono::duration<double>(end - start).count());
    state.SetIterationTime(times.back());
  }
  const double median = Median(times);
  state.counters["median_ms"] = 1e3 * median;
  state.counters["GB_per_s"] = 1e-9 * static_cast<double>(count) / median;
}

//------------------------------------------------------------------------------
bool HasFailedBenchmark()
{
  return failed;
}
