// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/Parallel.h"

#include <atomic>
#include <cstdlib>
#if __has_include(<unistd.h>)
#include <unistd.h>
#endif

namespace splatting
{
namespace
{
namespace smp = vtk::detail::smp;

/// Whether this process was forked after its first loop: the threads did not survive that.
bool isForked()
{
#if __has_include(<unistd.h>)
  static const pid_t first = getpid();
  return getpid() != first;
#else
  return false;
#endif
}
}

bool usesOwnThreads()
{
  static const bool isChosen = std::getenv("VTK_SMP_BACKEND_IN_USE");
  return VTK_SMP_ENABLE_STDTHREAD && smp::DefaultBackend == smp::BackendType::Sequential &&
    smp::vtkSMPToolsAPI::GetInstance().GetBackendType() == smp::DefaultBackend && !isChosen &&
    !isForked();
}

int numberOfThreads()
{
#if VTK_SMP_ENABLE_STDTHREAD
  if (usesOwnThreads())
  {
    return ownThreads().GetEstimatedNumberOfThreads();
  }
#endif
  return vtkSMPTools::GetEstimatedNumberOfThreads();
}

#if VTK_SMP_ENABLE_STDTHREAD
OwnThreads& ownThreads()
{
  static struct Threads : OwnThreads
  {
    Threads() { this->SetNestedParallelism(false); }
  } threads;
  // Each backend has a number of its own, and Initialize(n) sets that of the current backend.
  static std::atomic<int> number{ 0 };
  const int wanted = smp::vtkSMPToolsAPI::GetInstance().GetInternalDesiredNumberOfThread();
  if (number.exchange(wanted) != wanted)
  {
    threads.Initialize(wanted);
  }
  return threads;
}
#endif
}
