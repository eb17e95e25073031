// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What VTK loads from VTK_AUTOLOAD_PATH, into any program that uses any VTK. It links nothing of
// VTK, which would bring a second one into programs with another version, and opens the factory
// only if that links the very library that calls.
//
// VTK compares the string of vtkGetFactoryVersion() with its own version. Where they differ, it
// warns with both, says which file this was, and goes on without it; so that is the place for all
// reasons not to serve.
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

/// Whether code at an address belongs to the library that goes by a name in this program.
bool belongsTo(void* address, const std::string& name)
{
  void* const library = dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD);
  return library && library == dlopen(fileOf(address).c_str(), RTLD_LAZY | RTLD_NOLOAD);
}

/// Opens the factory. Returns what VTK is to take for its version.
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

/// Called where the versions agree.
extern "C" __attribute__((visibility("default"))) void* vtkLoad()
{
  return newFactory();
}
