// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingParallel_h
#define splattingParallel_h

#include <vtkSMPTools.h>
#include <vtkType.h>

#include <mutex>
#include <thread>
#include <unordered_map>

/**
 * @file
 * Parallel loops, on all cores with any VTK.
 *
 * vtkSMPTools runs them, with the backend and the number of threads that the program chose. One case
 * differs: some builds of VTK start with the backend "Sequential", among them the package vtk of PyPI.
 * There VTK's backend "STDThread" runs the loops, with
 *
 * - the number of vtkSMPTools::Initialize(n), if the program called it;
 * - else that of the environment variable VTK_SMP_MAX_THREADS;
 * - else one thread for each core.
 *
 * "Sequential" remains in use if the environment variable VTK_SMP_BACKEND_IN_USE is set, and in
 * builds of VTK that start with another backend. vtkSMPTools::SetBackend("Sequential") has no effect
 * in builds that start with it: VTK does not record such a call. Initialize(1) gives one thread.
 *
 * The backend of the process does not change. vtkSMPTools::LocalScope() would change it for a time,
 * in which filters of other threads lose their thread-local data.
 */
namespace splatting
{
/// Whether loops run by STDThread although vtkSMPTools uses Sequential.
bool usesOwnThreads();

/// The number of threads that run a loop.
int numberOfThreads();

#if VTK_SMP_ENABLE_STDTHREAD
using OwnThreads = vtk::detail::smp::vtkSMPToolsImpl<vtk::detail::smp::BackendType::STDThread>;

/// With the number of threads that the program chose. A loop in a loop runs on one thread.
OwnThreads& ownThreads();

template <class Function>
void forInOwnThreads(
  vtkIdType first, vtkIdType last, vtkIdType grain, const Function& function)
{
  struct
  {
    const Function& function;
    void Execute(vtkIdType begin, vtkIdType end) const { this->function(begin, end); }
  } body{ function };
  ownThreads().For(first, last, grain, body);
}
#endif

/**
 * Calls function(first, last) for parts of a range, each of at least `grain` numbers; 0 chooses a
 * grain.
 */
template <class Function>
void parallelFor(vtkIdType first, vtkIdType last, vtkIdType grain, const Function& function)
{
#if VTK_SMP_ENABLE_STDTHREAD
  if (usesOwnThreads())
  {
    forInOwnThreads(first, last, grain, function);
    return;
  }
#endif
  vtkSMPTools::For(first, last, grain, function);
}

/**
 * An object for each thread that asks for one. vtkSMPThreadLocal is not used, because it
 * distinguishes threads of the current backend only.
 */
template <class T>
class PerThread
{
public:
  /// The calling thread's object. The reference stays valid.
  T& Local()
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    return this->Objects[std::this_thread::get_id()];
  }

  /// Calls function(object) for all objects. Not during a loop.
  template <class Function>
  void forAll(const Function& function)
  {
    for (auto& object : this->Objects)
    {
      function(object.second);
    }
  }

private:
  std::mutex Mutex;
  std::unordered_map<std::thread::id, T> Objects;
};
}

#endif
