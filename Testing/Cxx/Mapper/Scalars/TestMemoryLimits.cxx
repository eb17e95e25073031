// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where memory ends, mapper and filter say so in one sentence and show nothing, wherever that
// happens; once there is room again they show what they should.
#include "Stage.h"

#include "vtkSplattingMIPProjection.h"
#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkVolume.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iostream>

#ifdef __linux__
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

#if defined(__linux__) && !defined(SPLATTINGMIP_SANITIZED)
namespace
{
/// As long as this lives, the program can have no more than so many bytes besides what it has.
class MemoryLimit
{
public:
  explicit MemoryLimit(std::size_t more)
  {
    getrlimit(RLIMIT_AS, &this->Before);
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit = this->Before;
    limit.rlim_cur = pages * sysconf(_SC_PAGESIZE) + more;
    setrlimit(RLIMIT_AS, &limit);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &this->Before); }
  MemoryLimit(const MemoryLimit&) = delete;
  MemoryLimit& operator=(const MemoryLimit&) = delete;

private:
  rlimit Before;
};

/// Interleaved components must be copied: 25 MB each.
constexpr int Size[3] = { 256, 220, 224 }, Components = 2;

vtkSmartPointer<vtkImageData> image()
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(Size);
  image->AllocateScalars(VTK_SHORT, Components);
  auto* const values = static_cast<short*>(image->GetScalarPointer());
  const vtkIdType count = image->GetPointData()->GetScalars()->GetNumberOfValues();
  for (vtkIdType n = 0; n < count; ++n)
  {
    values[n] = static_cast<short>(n * 7919 % 251);
  }
  return image;
}

bool isOneSentence(const std::vector<std::string>& texts)
{
  return texts.size() == 1 && texts.front().find("not enough memory") != std::string::npos;
}

bool isBlack(const stage::Pixels& pixels)
{
  return std::all_of(pixels.begin(), pixels.end(), [](unsigned char byte) { return byte == 0; });
}

/// In views along the slowest and the fastest axis, the second of which need another copy.
void testMapper(reference::Checks& check, stage::Stage& stage, const stage::Vector& direction)
{
  const auto volume = image();
  const stage::Vector up = { 0.0, 1.0, 0.1 };
  const auto fresh = stage::splatting(volume);
  stage.show(fresh);
  stage.look(direction, up);
  const stage::Pixels expected = stage.pixels();
  check(!isBlack(expected), "There is a picture.");
  for (int more : { 16, 32, 60, 90 }) // megabytes
  {
    const auto mapper = stage::splatting(volume);
    stage.show(mapper);
    stage.volume->SetVisibility(true);
    const std::string name = "Mapper, " + std::to_string(more) + " MB: ";
    const stage::Messages errors(mapper, vtkCommand::ErrorEvent);
    stage::Pixels pixels;
    {
      const MemoryLimit limit(std::size_t(more) << 20);
      pixels = stage.pixels();
    }
    const bool fitted = errors.texts.empty();
    check(fitted ? pixels == expected : isBlack(pixels), name, "all or nothing is drawn.");
    check(fitted || isOneSentence(errors.texts), name, "one sentence.");
    check(fitted || mapper->GetIndexMemorySize() == 0, name, "nothing is held.");
    check(!fitted || more > 48, name, "two copies do not fit.");
    check(stage.pixels() == expected, name, "the next frame draws.");
    const MemoryLimit limit(std::size_t(16) << 20);
    check(stage.pixels() == expected, name, "what is there can be drawn without more.");
  }
}

void testFilter(reference::Checks& check, const stage::Vector& direction, int mode)
{
  const auto volume = image();
  int failed = 0;
  stage::Pixels expected;
  const auto bytesOf = [](vtkSplattingMIPProjection* filter)
  {
    vtkImageData* const output = filter->GetOutput();
    const auto* const begin = static_cast<unsigned char*>(output->GetScalarPointer());
    return output->GetNumberOfPoints() > 0
      ? stage::Pixels(begin, begin + output->GetNumberOfPoints() * Components * sizeof(float))
      : stage::Pixels();
  };
  for (int more : { 0, 4, 8, 12, 16, 24, 32, 48, 54, 58, 64, 72, 80 }) // megabytes; 0: all
  {
    vtkNew<vtkSplattingMIPProjection> filter;
    const std::string name =
      "Filter, mode " + std::to_string(mode) + ", " + std::to_string(more) + " MB: ";
    filter->SetInputData(volume);
    filter->SetViewDirection(direction.data());
    filter->SetOutputSize(500, 400);
    filter->SetQualityMode(mode);
    filter->SetFootprintSampling(16);
    if (more == 0)
    {
      filter->Update();
      expected = bytesOf(filter);
      check(!expected.empty(), name, "there is an output.");
      continue;
    }
    const stage::Messages errors(filter, vtkCommand::ErrorEvent);
    {
      const MemoryLimit limit(std::size_t(more) << 20);
      filter->Update();
    }
    const bool fitted = errors.texts.empty();
    failed += !fitted;
    check(
      fitted || (errors.texts.size() == 1 && errors.texts[0].find("memory") != std::string::npos),
      name, "one sentence.");
    check(bytesOf(filter) == (fitted ? expected : stage::Pixels()), name, "all or nothing.");
    filter->Modified();
    filter->Update();
    check(bytesOf(filter) == expected, name, "the next update has the output.");
  }
  std::cout << failed << " of 12 limits were too low" << std::endl;
  check(failed >= 7, "Two copies do not fit into 48 MB.");
}
}

//------------------------------------------------------------------------------
int TestMemoryLimits(int, char*[])
{
  reference::Checks check;
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 1 << 20); // what is given back is the system's, then
#endif
  const stage::Vector slow = { 0.2, -0.1, -1.0 }, fast = { 1.0, 0.1, -0.2 };
  for (int mode : { vtkSplattingMIPProjection::HIGH, vtkSplattingMIPProjection::EXACT })
  {
    testFilter(check, slow, mode);
    testFilter(check, fast, mode);
  }
  stage::Stage stage(120, 110);
  testMapper(check, stage, slow);
  testMapper(check, stage, fast);
  return check.exitCode();
}
#else
int TestMemoryLimits(int, char*[])
{
  std::cout << "Memory cannot be limited here." << std::endl;
  return 125; // as VTK's tests say that they are skipped
}
#endif
