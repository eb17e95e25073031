// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The library that VTK loads from VTK_AUTOLOAD_PATH, into any program with any VTK. It does not
// link VTK, because this would load a second VTK into programs with another version. It opens the
// factory only if that links the very library that calls.
//
// VTK compares the string of vtkGetFactoryVersion() with its own version. If they differ, it
// reports a warning with both and the name of this file, and continues without it. The string
// therefore reports all reasons not to serve.
#include "vtkVersionMacros.h"

#include <dlfcn.h>

#include <string>

namespace
{
using NewFactory = void* (*)();
NewFactory newFactory = nullptr;

std::string fileOf(void* address)
{
  Dl_info info;
  return dladdr(address, &info) && info.dli_fname ? info.dli_fname : "";
}

/// Whether code at an address belongs to the library that this program finds under a name.
bool belongsTo(void* address, const std::string& name)
{
  void* const library = dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD);
  return library && library == dlopen(fileOf(address).c_str(), RTLD_LAZY | RTLD_NOLOAD);
}

/// Opens the factory. Returns the version string for VTK.
std::string open(void* caller)
{
  const std::string version = VTK_SOURCE_VERSION;
  if (!belongsTo(caller, SPLATTINGMIP_VTK_LIBRARY))
  {
    return version + " in " SPLATTINGMIP_VTK_LIBRARY;
  }
  const std::string gate = fileOf(reinterpret_cast<void*>(&open));
  const std::string factory = gate.substr(0, gate.rfind('/') + 1) + SPLATTINGMIP_FACTORY;
  void* const library = dlopen(factory.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library)
  {
    newFactory = reinterpret_cast<NewFactory>(dlsym(library, "splattingmip_new_factory"));
  }
  return newFactory ? version : version + ", which cannot be loaded: " + dlerror();
}
}

extern "C" __attribute__((visibility("default"))) const char* vtkGetFactoryVersion()
{
  static const std::string version = open(__builtin_return_address(0));
  return version.c_str();
}

/// Called if the versions are equal.
extern "C" __attribute__((visibility("default"))) void* vtkLoad()
{
  return newFactory();
}
