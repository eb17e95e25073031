// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Reading.h"

#include "ProgressLine.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <vtksys/SystemInformation.hxx>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <stdexcept>

namespace
{
/**
 * The number of voxels that a reader has announced.
 */
std::uintmax_t CheckExtent(vtkInformation* info, const std::string& path, const QuietReading& quiet)
{
  const int* extent = info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double first = extent ? extent[2 * axis] : 0.0;
    const double last = extent ? extent[2 * axis + 1] : -1.0;
    if (last < first)
    {
      RefuseDamaged(path, quiet);
    }
    voxels *= last - first + 1.0;
  }
  CheckMemory(voxels, path);
  return static_cast<std::uintmax_t>(voxels);
}

void ShowProgress(vtkObject* caller, unsigned long, void* line, void*)
{
  static_cast<ProgressLine*>(line)->Show(static_cast<vtkAlgorithm*>(caller)->GetProgress());
}

}

void Refuse(const std::string& path, const std::string& reason)
{
  throw std::runtime_error(path + ": " + reason);
}

void RefuseDamaged(const std::string& path, const QuietReading& quiet)
{
  Refuse(path,
    "damaged, incomplete or not what its name says" + quiet.GetReason() +
      "; check it, or export the volume again.");
}

void CheckFrame(const std::string& path, int number, int count)
{
  if (number > count)
  {
    Refuse(path,
      "there is no volume " + std::to_string(number) + " here, only " + std::to_string(count) +
        "; give another --frame.");
  }
}

void CheckComponent(const std::string& path, int number, int count)
{
  if (number > count)
  {
    Refuse(path,
      "there is no component " + std::to_string(number) + " here, only " + std::to_string(count) +
        "; give another --component.");
  }
}

std::string DescribeComponent(int number, int count)
{
  return "component " + std::to_string(std::max(number, 1)) + " of " + std::to_string(count) +
    " (--component chooses)";
}

std::string JoinWords(const std::vector<std::string>& words)
{
  std::string text;
  for (std::size_t n = 0; n < words.size(); ++n)
  {
    text += n == 0 ? "" : n + 1 < words.size() ? ", " : " or ";
    text += words[n];
  }
  return text;
}

void CheckMemory(double voxels, const std::string& path)
{
  vtksys::SystemInformation machine;
  machine.RunMemoryCheck();
  const double mebibytes = static_cast<double>(machine.GetTotalPhysicalMemory());
  if (voxels > mebibytes * 1024.0 * 1024.0)
  {
    Refuse(path,
      "the header asks for more voxels than this machine has bytes of memory; it is damaged, or "
      "the volume must be reduced first.");
  }
}

vtkSmartPointer<vtkImageData> RunReader(vtkAlgorithm* reader, const std::string& path,
  const QuietReading& quiet, const TextHeader* header)
{
  ProgressLine line("reading " + std::filesystem::path(path).filename().string());
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(ShowProgress);
  observer->SetClientData(&line);
  reader->AddObserver(vtkCommand::ProgressEvent, observer);

  reader->UpdateInformation();
  vtkInformation* info = reader->GetOutputInformation(0);
  if (HasFailed(reader, quiet) || !info)
  {
    RefuseDamaged(path, quiet);
  }
  const std::uintmax_t voxels = CheckExtent(info, path, quiet);
  const auto components =
    static_cast<std::uintmax_t>(vtkImageData::GetNumberOfScalarComponents(info));
  const int bytes = vtkDataArray::GetDataTypeSize(vtkImageData::GetScalarType(info));
  if (header && !header->HasData(voxels * components, static_cast<std::uintmax_t>(bytes)))
  {
    RefuseDamaged(path, quiet);
  }
  reader->Update();
  reader->RemoveObserver(observer);

  auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  if (HasFailed(reader, quiet) || !image || image->GetNumberOfPoints() < 1)
  {
    RefuseDamaged(path, quiet);
  }
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->ShallowCopy(image);
  return copy;
}
