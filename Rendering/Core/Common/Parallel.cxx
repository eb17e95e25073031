// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Common/Parallel.h"

#include <vtkSMPTools.h>

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

bool usesOwnThreads()
{
  static const bool isChosen = std::getenv("VTK_SMP_BACKEND_IN_USE");
  return VTK_SMP_ENABLE_STDTHREAD && smp::DefaultBackend == smp::BackendType::Sequential &&
    smp::vtkSMPToolsAPI::GetInstance().GetBackendType() == smp::DefaultBackend && !isChosen &&
    !isForked();
}

#if VTK_SMP_ENABLE_STDTHREAD
using Threads = smp::vtkSMPToolsImpl<smp::BackendType::STDThread>;

/// With the number of threads that the program chose.
Threads& ownThreads()
{
  static struct Unnested : Threads
  {
    Unnested() { this->SetNestedParallelism(false); }
  } threads;
  // Each backend has a number of its own. vtkSMPTools initialises that of the current backend only;
  // Initialize(0) reads VTK_SMP_MAX_THREADS.
  static std::atomic<int> number{ -1 };
  const int wanted = smp::vtkSMPToolsAPI::GetInstance().GetInternalDesiredNumberOfThread();
  if (number.exchange(wanted) != wanted)
  {
    threads.Initialize(wanted);
  }
  return threads;
}
#endif
}

void parallelFor(
  std::ptrdiff_t first, std::ptrdiff_t last, std::ptrdiff_t grain, const LoopBody& body)
{
  if (usesOwnThreads())
  {
    forInOwnThreads(first, last, grain, body);
    return;
  }
  vtkSMPTools::For(first, last, grain, body);
}

int numberOfThreads()
{
  return usesOwnThreads() ? numberOfOwnThreads() : vtkSMPTools::GetEstimatedNumberOfThreads();
}

#if VTK_SMP_ENABLE_STDTHREAD
void forInOwnThreads(
  std::ptrdiff_t first, std::ptrdiff_t last, std::ptrdiff_t grain, const LoopBody& body)
{
  struct
  {
    const LoopBody& body;
    void Execute(vtkIdType begin, vtkIdType end) const { this->body(begin, end); }
  } functor{ body };
  ownThreads().For(first, last, grain, functor);
}

int numberOfOwnThreads()
{
  return ownThreads().GetEstimatedNumberOfThreads();
}
#else
void forInOwnThreads(
  std::ptrdiff_t first, std::ptrdiff_t last, std::ptrdiff_t, const LoopBody& body)
{
  if (first < last)
  {
    body(first, last);
  }
}

int numberOfOwnThreads()
{
  return 1;
}
#endif
}
