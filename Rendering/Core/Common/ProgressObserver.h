// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef splattingProgressObserver_h
#define splattingProgressObserver_h

#include <atomic>
#include <functional>
#include <thread>

namespace splatting
{
/**
 * Reports the progress of a projection to its caller, and asks whether to continue. The callback
 * runs only on the calling thread, between its own bands of rows; the other threads test a flag. If
 * a thread pool gives the calling thread no bands, the callback runs when all are done.
 */
class ProgressObserver
{
public:
  /// Gets the completed share, 0 to 1, in ascending order. Returns whether to continue.
  using Callback = std::function<bool(double)>;

  void setCallback(const Callback& callback) { this->Told = callback; }

  /// Call it first, on the thread that calls the projection.
  void start()
  {
    this->Owner = std::this_thread::get_id();
    this->Stopped = false;
    this->setStage(0.0, 1.0);
    this->begin(1);
    this->ask();
  }

  /// Sets the stage of the whole work that comes next: from share `from` to share `to`. Default:
  /// all of it.
  void setStage(double from, double to)
  {
    this->StageFrom = from;
    this->StageTo = to;
    this->setPart(0.0, 1.0);
  }

  /// Sets which part of the stage comes next: from share `from` to share `to`. Default: all of it.
  void setPart(double from, double to)
  {
    this->From = this->StageFrom + (this->StageTo - this->StageFrom) * from;
    this->To = this->StageFrom + (this->StageTo - this->StageFrom) * to;
  }

  /// Starts a part that consists of some bands.
  void begin(int bands)
  {
    this->Done = 0;
    this->Step = (this->To - this->From) / bands;
  }

  /// Call it when a band is done, on any thread.
  void bandDone()
  {
    ++this->Done;
    this->ask();
  }

  /// Runs the callback on the owner's thread. The callback may start parallel work in which this
  /// thread finishes bands of this projection; it is not called recursively.
  bool ask()
  {
    if (this->Told && std::this_thread::get_id() == this->Owner && !this->Asking)
    {
      this->Asking = true;
      if (!this->stopped() && !this->Told(this->From + this->Step * this->Done))
      {
        this->Stopped = true;
      }
      this->Asking = false;
    }
    return !this->stopped();
  }

  bool stopped() const { return this->Stopped.load(std::memory_order_relaxed); }

private:
  Callback Told;
  std::thread::id Owner;
  std::atomic<bool> Stopped{ false };
  bool Asking = false; // of the owner, which alone uses it
  std::atomic<int> Done{ 0 };
  double StageFrom = 0.0;
  double StageTo = 1.0;
  double From = 0.0;
  double To = 1.0;
  double Step = 1.0;
};
}

#endif
