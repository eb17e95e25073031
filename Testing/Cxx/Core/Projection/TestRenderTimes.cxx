// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The choice of quality modes by times of frames that are made up.
#include "CoreTesting.h"

#include "Common/RenderTimes.h"

#include <cmath>

namespace
{
using splatting::RenderTimes;

constexpr int Preview = 0, Standard = 1, High = 2;
constexpr double Still = 10000.0;
int places[200];

RenderTimes::View viewNumber(int renderer, int volume)
{
  return { &places[renderer], &places[volume] };
}

const RenderTimes::View view = viewNumber(0, 1);

/// With a first frame behind it.
RenderTimes begun()
{
  RenderTimes times;
  times.add(view, High, 9.0);
  return times;
}

/// A frame on a machine where modes take these seconds.
int frame(RenderTimes& times, int wanted, double allocated, const double (&seconds)[3])
{
  const int mode = times.choose(view, wanted, allocated);
  times.add(view, mode, seconds[mode]);
  return mode;
}

void testStepsDown(reference::Checks& check)
{
  const double seconds[] = { 0.02, 0.05, 0.2 };
  RenderTimes times = begun();
  check(frame(times, High, 0.03, seconds) == High, "what was not measured fits");
  check(frame(times, High, 0.03, seconds) == Standard, "high gives way");
  check(frame(times, High, 0.03, seconds) == Preview, "standard gives way");
  for (int n = 0; n < 5; ++n)
  {
    check(frame(times, High, 0.03, seconds) == Preview, "preview stays");
  }
  check(frame(times, High, 0.001, seconds) == Preview, "preview stays where nothing fits");
  check(frame(times, High, 0.07, seconds) == Standard, "standard fits again");
  check(frame(times, High, Still, seconds) == High, "a still frame is what was wanted");
  check(frame(times, High, 0.07, seconds) == Standard, "what was measured is remembered");
  check(frame(times, Preview, Still, seconds) == Preview, "nothing is better than wanted");
  check(frame(times, Standard, Still, seconds) == Standard, "standard was wanted");
}

void testDoesNotAlternate(reference::Checks& check)
{
  const double seconds[] = { 0.01, 0.04, 0.09 };
  RenderTimes times = begun();
  frame(times, High, 0.08, seconds);
  check(frame(times, High, 0.08, seconds) == Standard, "high is too slow");
  check(frame(times, High, 0.1, seconds) == Standard, "no way up with little to spare");
  check(frame(times, High, 0.12, seconds) == High, "up with more to spare");
  check(frame(times, High, 0.1, seconds) == High, "once up, the whole time counts");
  check(frame(times, High, 0.09, seconds) == High, "exactly the time fits");
}

/// Modes that are not in use keep up with those that are.
void testFollowsTheLoad(reference::Checks& check)
{
  const double slow[] = { 0.04, 0.1, 0.4 }, fast[] = { 0.004, 0.01, 0.04 };
  RenderTimes times = begun();
  for (int n = 0; n < 4; ++n)
  {
    frame(times, High, 0.06, slow);
  }
  check(frame(times, High, 0.06, slow) == Preview, "a busy machine shows previews");
  check(frame(times, High, 0.06, fast) == Preview, "it cannot know before it has measured");
  check(frame(times, High, 0.06, fast) == High, "an idle one shows what is wanted");
  check(frame(times, High, 0.06, slow) == High, "it cannot know before it has measured");
  check(frame(times, High, 0.06, slow) == Preview, "all modes are slower again");
}

void testViews(reference::Checks& check)
{
  RenderTimes times = begun();
  times.add(view, High, 1.0);
  check(times.choose(view, High, 0.1) == Standard, "this view is slow");
  check(times.choose(viewNumber(0, 2), High, 0.1) == High, "another volume is not");
  check(times.choose(viewNumber(2, 1), High, 0.1) == High, "another renderer is not");
  times.clear();
  check(times.choose(view, High, 0.1) == High, "other volumes, other times");
  times.add(view, High, 1.0);
  check(times.choose(view, High, 0.1) == High, "the first frame of a view does not count");
  times.add(view, High, 1.0);
  for (int n = 0; n < 150; ++n)
  {
    times.choose(viewNumber(5, n), High, 0.1);
  }
  check(times.choose(view, High, 0.1) == High, "the oldest views are forgotten");
}

void testOddTimes(reference::Checks& check)
{
  RenderTimes times = begun();
  times.add(view, High, -1.0);
  times.add(view, High, 0.0);
  times.add(view, High, std::nan(""));
  check(times.choose(view, High, 0.1) == High, "clocks that go wrong are no measurements");
  times.add(view, High, 1.0);
  check(times.choose(view, High, std::nan("")) == High, "no limit that is a number, no limit");
  check(times.choose(view, High, 0.0) == Standard, "no time at all");
}
}

//------------------------------------------------------------------------------
int TestRenderTimes(int, char*[])
{
  reference::Checks check;
  testStepsDown(check);
  testDoesNotAlternate(check);
  testFollowsTheLoad(check);
  testViews(check);
  testOddTimes(check);
  return check.exitCode();
}
