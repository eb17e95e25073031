// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Measures vtkSplattingMIPVolumeMapper beside VTK's ray casters. See --help.
 */
#include "BenchmarkCases.h"
#include "BenchmarkStage.h"
#include "BenchmarkVolumes.h"
#include "ProcessorName.h"

#include "vtkSMPTools.h"
#include "vtkSmartPointer.h"
#include "vtkSplattingMIPVolumeMapper.h"
#include "vtkVersion.h"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace
{
using Facts = std::vector<std::pair<std::string, std::string>>;

struct Options
{
  std::string Data = SPLATTINGMIP_TEST_DATA;
  double ViewAngle = 0.0;
  int Threads = 0;
  bool Quick = false;
};

void PrintHelp()
{
  std::cout <<
    R"(splatmip-benchmark: maximum intensity projections by splatting beside VTK's ray casters

  frame/VOLUME/WINDOW/MAPPER  a whole frame, render and read-back
  recolor/VOLUME/WINDOW/MODE  a whole frame of a view that is shown already, in another window/level
  projection/VOLUME/MODE      the projection alone, volume to shear image
  where/VOLUME/MODE           the same with RecordLocations
  cut/VOLUME/MODE/CUT         the projection alone, cut by clipping planes
  first/VOLUME/MODE           the slowest of the first frames along the three axes, 300^2
  index/VOLUME                making the bricks: one survey of the voxels
  floor/VOLUME                the largest byte of the volume, read once by all threads

VOLUME   vessels256-uint8 (noise and vessels), aorta-int16 and, if it is there, lidc0314-int16
WINDOW   300 or 1024 pixels along each side
CUT      none; plane: through the middle; box: six planes
MAPPER   preview, standard, high, exact: the modes of vtkSplattingMIPVolumeMapper
         raycast-nearest, raycast-linear: vtkFixedPointVolumeRayCastMapper
         gpu: vtkOpenGLGPUVolumeRayCastMapper, linear

Everything goes through the same two turns of the camera, 36 views in all; slow mappers and big
volumes through a part of them, evenly spaced (counter views). Counter median_ms is the median over
the views. figures.py makes the tables of the documents.

  --quick        64^3 voxels, 100 pixels, few views: whether it works, in a few seconds
  --data=DIR     where lidc-idri-0314.nrrd lies
  --threads=N    threads of vtkSMPTools and of the ray caster on the CPU
  --perspective=DEGREES  perspective cameras with this view angle, for all but floor and index

  For JSON, too: --benchmark_out=FILE. The rows that matter most:
    splatmip-benchmark --benchmark_filter='frame/vessels256-uint8/[0-9]+/[^g]'
  All but the GPU's:
    splatmip-benchmark --benchmark_filter=-gpu

)";
  benchmark::PrintDefaultHelp();
}

bool Starts(const std::string& text, const std::string& start, std::string& rest)
{
  if (text.compare(0, start.size(), start) != 0)
  {
    return false;
  }
  rest = text.substr(start.size());
  return true;
}

/// Takes the options that Google Benchmark does not know from the arguments.
Options TakeOptions(int& argc, char** argv)
{
  Options options;
  int kept = 1;
  for (int i = 1; i < argc; ++i)
  {
    std::string value;
    if (std::string(argv[i]) == "--quick")
    {
      options.Quick = true;
    }
    else if (Starts(argv[i], "--data=", value))
    {
      options.Data = value;
    }
    else if (Starts(argv[i], "--threads=", value))
    {
      options.Threads = std::atoi(value.c_str());
    }
    else if (Starts(argv[i], "--perspective=", value))
    {
      options.ViewAngle = std::atof(value.c_str());
    }
    else
    {
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
  return options;
}

std::string DescribeCamera()
{
  const double angle = BenchmarkStage::GetInstance().GetViewAngle();
  std::ostringstream text;
  text << "perspective, " << angle << " degrees";
  return angle > 0.0 ? text.str() : "parallel";
}

/// What the numbers depend on, besides the program.
Facts DescribeMachine()
{
  auto mapper = vtkSmartPointer<vtkSplattingMIPVolumeMapper>::New();
  return { { "processor", GetProcessorName() },
    { "threads",
      std::to_string(vtkSMPTools::GetEstimatedNumberOfThreads()) + " (vtkSMPTools, " +
        vtkSMPTools::GetBackend() + ")" },
    { "instruction set", mapper->GetInstructionSet() }, { "camera", DescribeCamera() },
    { "OpenGL renderer", BenchmarkStage::GetInstance().GetDeviceName() },
    { "VTK", vtkVersion::GetVTKVersion() } };
}

/// Few views where a single one takes a second or more; 5 and 9 of them have the three principal
/// axes in about the same proportion as all of them.
BenchmarkRotation ChooseRotation(const BenchmarkMapper& mapper, bool isBig, bool isQuick)
{
  if (isQuick)
  {
    return { 4, 1 };
  }
  if (mapper.Kind == BenchmarkMapper::SPLATTING)
  {
    return { isBig ? BenchmarkStage::NumberOfViews / 2 : BenchmarkStage::NumberOfViews, 3 };
  }
  return { isBig || mapper.Kind == BenchmarkMapper::GPU_RAY_CASTING ? 5 : 9, 1 };
}

template <class Function>
void Register(const std::string& name, int iterations, Function function)
{
  benchmark::RegisterBenchmark(name.c_str(), function)
    ->Iterations(iterations)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
}

void RegisterFrames(const BenchmarkVolume& volume, int window, bool isQuick)
{
  for (const BenchmarkMapper& mapper : GetBenchmarkMappers())
  {
    const BenchmarkRotation rotation = ChooseRotation(mapper, volume.IsBig, isQuick);
    Register("frame/" + volume.Name + "/" + std::to_string(window) + "/" + mapper.Name,
      rotation.Views * rotation.Passes,
      [=](benchmark::State& state) { MeasureFrames(state, volume, window, mapper, rotation); });
    if (mapper.Kind == BenchmarkMapper::SPLATTING)
    {
      const BenchmarkRotation rotation = { isQuick ? 4 : 9, 1 };
      Register("recolor/" + volume.Name + "/" + std::to_string(window) + "/" + mapper.Name,
        rotation.Views * rotation.Passes,
        [=](benchmark::State& state)
        { MeasureRecoloring(state, volume, window, mapper, rotation); });
    }
  }
}

void RegisterCuts(const BenchmarkVolume& volume, bool isQuick)
{
  for (const BenchmarkMapper& mapper : GetBenchmarkMappers())
  {
    if (mapper.Kind != BenchmarkMapper::SPLATTING)
    {
      continue;
    }
    const BenchmarkRotation rotation = ChooseRotation(mapper, volume.IsBig, isQuick);
    for (const auto& [name, cut] :
      { std::pair<const char*, BenchmarkCut>("none", BenchmarkCut::NONE),
        { "plane", BenchmarkCut::PLANE }, { "box", BenchmarkCut::BOX } })
    {
      Register("cut/" + volume.Name + "/" + mapper.Name + "/" + name,
        rotation.Views * rotation.Passes,
        [=, kind = cut](benchmark::State& state)
        { MeasureProjections(state, volume, mapper, rotation, kind); });
    }
  }
}

void RegisterVolume(const BenchmarkVolume& volume, bool isQuick)
{
  Register(
    "floor/" + volume.Name, 30, [=](benchmark::State& state) { MeasureFloor(state, volume); });
  Register("index/" + volume.Name, isQuick ? 2 : 10,
    [=](benchmark::State& state) { MeasureIndex(state, volume); });
  for (const BenchmarkMapper& mapper : GetBenchmarkMappers())
  {
    if (mapper.Kind != BenchmarkMapper::SPLATTING)
    {
      continue;
    }
    const BenchmarkRotation rotation = ChooseRotation(mapper, volume.IsBig, isQuick);
    Register("projection/" + volume.Name + "/" + mapper.Name, rotation.Views * rotation.Passes,
      [=](benchmark::State& state) { MeasureProjections(state, volume, mapper, rotation); });
    Register("where/" + volume.Name + "/" + mapper.Name, rotation.Views * rotation.Passes,
      [=](benchmark::State& state) { MeasureLocations(state, volume, mapper, rotation); });
    Register("first/" + volume.Name + "/" + mapper.Name, isQuick ? 1 : 5,
      [=](benchmark::State& state) { MeasureFirst(state, volume, mapper); });
  }
  RegisterCuts(volume, isQuick);
  for (int window : isQuick ? std::vector<int>{ 100 } : std::vector<int>{ 300, 1024 })
  {
    RegisterFrames(volume, window, isQuick);
  }
}

void RegisterAll(const Options& options)
{
  std::vector<std::string> missing;
  const std::vector<BenchmarkVolume> volumes =
    options.Quick ? ListQuickVolumes() : ListVolumes(options.Data, missing);
  for (const std::string& name : missing)
  {
    std::cerr << "skipped: no data for " << name << "\n";
  }
  for (const BenchmarkVolume& volume : volumes)
  {
    RegisterVolume(volume, options.Quick);
  }
}
}

int main(int argc, char** argv)
{
  const Options options = TakeOptions(argc, argv);
  benchmark::Initialize(&argc, argv, PrintHelp);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
  {
    return EXIT_FAILURE;
  }
  if (options.Threads > 0)
  {
    vtkSMPTools::Initialize(options.Threads);
  }
  BenchmarkStage::GetInstance().SetViewAngle(options.ViewAngle);
  RegisterAll(options);
  for (const auto& fact : DescribeMachine())
  {
    benchmark::AddCustomContext(fact.first, fact.second);
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return HasFailedBenchmark() ? EXIT_FAILURE : EXIT_SUCCESS;
}
