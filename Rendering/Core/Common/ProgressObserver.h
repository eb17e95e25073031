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
 * Tells whoever wants a projection how far it is, and asks whether to go on. Only the thread that
 * wants it is asked, between its own bands of rows; the others see a flag. If a
 * thread pool gives that thread no bands, it is asked when all are done.
 */
class ProgressObserver
{
public:
  /// Told the share that is done, 0 to 1, never less than before; returns whether to go on.
  using Callback = std::function<bool(double)>;

  void setCallback(const Callback& callback) { this->Told = callback; }

  /// To be called by the thread that wants the projection, before all else.
  void start()
  {
    this->Owner = std::this_thread::get_id();
    this->Stopped = false;
    this->setPart(0.0, 1.0);
    this->begin(1);
    this->ask();
  }

  /// What follows is this part of the whole work, from one share to another. Without a call it is
  /// all.
  void setPart(double from, double to)
  {
    this->From = from;
    this->To = to;
  }

  /// This part consists of the so many bands that follow.
  void begin(int bands)
  {
    this->Done = 0;
    this->Step = (this->To - this->From) / bands;
  }

  /// A band is done, by any thread.
  void bandDone()
  {
    ++this->Done;
    this->ask();
  }

  /// Asks, if this is the thread to ask. The callback may start parallel work, in which this
  /// thread may finish bands of this projection; it is not asked again from within.
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
  bool Asking = false; // by the owner, who alone looks at it
  std::atomic<int> Done{ 0 };
  double From = 0.0;
  double To = 1.0;
  double Step = 1.0;
};
}

#endif
