// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Turns on the override of vtkSplattingMIPGPUVolumeRayCastMapper in unchanged programs, when VTK
// loads libraries from VTK_AUTOLOAD_PATH. Environment variables replace calls:
//
// SPLATTINGMIP_QUALITY  preview, standard, high or exact (the default)
// SPLATTINGMIP_LOG      a file in an existing folder. VTK's log of verbosity up to 1 is appended
//                       to it: the mapper that renders, and all warnings and errors
#include "vtkLogger.h"
#include "vtkObjectFactory.h"
#include "vtkSplattingMIPGPUVolumeRayCastMapper.h"
#include "vtkSplattingMIPVolumeMapper.h"
#include "vtkVersion.h"

#include <cstdlib>
#include <fstream>
#include <string>

namespace
{
/// VTK registers the factory that this library returns after all others. The factory of VTK's
/// OpenGL classes, which this library loads, precedes it. The override therefore has another
/// factory, which is registered before all others.
class EmptyFactory : public vtkObjectFactory
{
public:
  static EmptyFactory* New();
  vtkTypeMacro(EmptyFactory, vtkObjectFactory);
  const char* GetVTKSourceVersion() override { return VTK_SOURCE_VERSION; }
  const char* GetDescription() override { return "SplattingMIP for all programs"; }
};
vtkStandardNewMacro(EmptyFactory);

std::string valueOf(const char* variable)
{
  const char* const value = std::getenv(variable);
  return value ? value : "";
}

/// VTK's logger would create missing folders.
void setLog(const std::string& file)
{
  if (file.empty())
  {
    return;
  }
  if (!std::ofstream(file, std::ios::app))
  {
    vtkGenericWarningMacro(<< "SPLATTINGMIP_LOG is \"" << file
                           << "\", which cannot be written, so that nothing is logged: name a file "
                              "in a folder that is there.");
    return;
  }
  vtkLogger::SetInternalVerbosityLevel(vtkLogger::VERBOSITY_1);
  vtkLogger::LogToFile(file.c_str(), vtkLogger::APPEND, vtkLogger::VERBOSITY_1);
}

void setQuality(const std::string& quality)
{
  using Override = vtkSplattingMIPGPUVolumeRayCastMapper;
  if (quality == "preview")
  {
    Override::SetGlobalQualityMode(vtkSplattingMIPVolumeMapper::PREVIEW);
  }
  else if (quality == "standard")
  {
    Override::SetGlobalQualityMode(vtkSplattingMIPVolumeMapper::STANDARD);
  }
  else if (quality == "high")
  {
    Override::SetGlobalQualityMode(vtkSplattingMIPVolumeMapper::HIGH);
  }
  else if (!quality.empty() && quality != "exact")
  {
    vtkGenericWarningMacro(
      << "SPLATTINGMIP_QUALITY is \"" << quality
      << "\", which is taken as exact: set it to preview, standard, high or exact.");
  }
}
}

extern "C" VTK_ABI_EXPORT vtkObjectFactory* splattingmip_new_factory()
{
  setLog(valueOf("SPLATTINGMIP_LOG"));
  setQuality(valueOf("SPLATTINGMIP_QUALITY"));
  vtkSplattingMIPGPUVolumeRayCastMapper::GlobalOverrideOn();
  return EmptyFactory::New();
}
