// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingParallel_h
#define splattingParallel_h

#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <unordered_map>

/**
 * @file
 * Parallel loops, on all cores with any VTK.
 *
 * vtkSMPTools runs them, with the backend and the number of threads that the program chose. One
 * case differs: some builds of VTK start with the backend "Sequential", among them the package vtk
 * of PyPI. There VTK's backend "STDThread" runs the loops, with
 *
 * - the number of vtkSMPTools::Initialize(n), if the program called it;
 * - else that of the environment variable VTK_SMP_MAX_THREADS;
 * - else one thread for each core.
 *
 * "Sequential" remains in use if the environment variable VTK_SMP_BACKEND_IN_USE is set, in builds
 * of VTK that start with another backend, and in a process that was forked after its first loop.
 * vtkSMPTools::SetBackend("Sequential") has no effect in builds that start with it: VTK does not
 * record such a call. Initialize(1) gives one thread.
 *
 * The backend of the process does not change. vtkSMPTools::LocalScope() would change it for a time,
 * in which filters of other threads lose their thread-local data.
 */
namespace splatting
{
/// Called with parts of a range.
using LoopBody = std::function<void(std::ptrdiff_t first, std::ptrdiff_t last)>;

/// Calls the body for parts of a range, each of `grain` numbers; 0 chooses a grain.
void parallelFor(
  std::ptrdiff_t first, std::ptrdiff_t last, std::ptrdiff_t grain, const LoopBody& body);

/// The number of threads that run a loop.
int numberOfThreads();

/// Run loops in place of the backend "Sequential". A loop in a loop runs on one thread.
void forInOwnThreads(
  std::ptrdiff_t first, std::ptrdiff_t last, std::ptrdiff_t grain, const LoopBody& body);
int numberOfOwnThreads();

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
