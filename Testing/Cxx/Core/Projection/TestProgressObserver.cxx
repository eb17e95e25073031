// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A projection asks whether to go on, on the thread that wants it only, and does no more once told
// not to, with every backend.
#include "CoreTesting.h"

#include <vtkSMPTools.h>

#include <algorithm>
#include <string>
#include <thread>

using namespace coretesting;
using splatting::Quality;

namespace
{
struct Scene
{
  std::array<int, 3> size{ 40, 300, 30 };
  reference::Volume<std::uint8_t> volume =
    reference::uniformNoise<std::uint8_t>({ 40, 300, 30 }, 5, 1, 255);
  splatting::ShearWarp geometry{ viewWithShear(this->size, 2, 0.3, -0.2) };
  splatting::VolumeIndex index;
  splatting::Projector projector;
  splatting::ShearImage image;

  Scene()
  {
    this->index.reset(
      { this->volume.voxels.data(), splatting::ScalarType::UInt8, toGlm(this->volume.size) });
  }

  /// Returns how often it was asked; it says no at the n-th time.
  int project(const splatting::ProjectionSettings& settings, int n, Checks& check)
  {
    const std::thread::id thread = std::this_thread::get_id();
    int asked = 0;
    double last = 0.0;
    this->projector.setObserver(
      [&](double share)
      {
        check(std::this_thread::get_id() == thread, "another thread asks");
        check(share >= last && share <= 1.0, "shares go from ", last, " to ", share);
        last = share;
        return ++asked != n;
      });
    this->projector.project(this->index, this->geometry, settings, {}, this->image);
    check(this->projector.stopped() == (asked == n), "the answer is not heard");
    check(this->projector.stopped() || last == 1.0, "it ends at ", last);
    return asked;
  }
};

void testStops(const splatting::ProjectionSettings& settings, Checks& check)
{
  Scene scene;
  const int asked = scene.project(settings, -1, check);
  check(asked >= 2, "it asks ", asked, " times");
  const splatting::ShearImage whole = scene.image;
  for (int n = 1; n < asked; ++n)
  {
    // Where it was not written to, the mark stays.
    std::fill(scene.image.bytes.begin(), scene.image.bytes.end(), std::uint8_t(0x5a));
    check(scene.project(settings, n, check) <= n, "it goes on asking after ", n);
    const bool isUntouched = std::all_of(scene.image.bytes.begin(), scene.image.bytes.end(),
      [](unsigned char byte) { return byte == 0x5a; });
    check(n != 1 || isUntouched, "it goes on although it was stopped before it began");
  }
  scene.project(settings, -1, check);
  check(scene.image.bytes == whole.bytes, "the next image differs");
}
}

//------------------------------------------------------------------------------
int TestProgressObserver(int, char*[])
{
  Checks check;
  const std::string usual = vtkSMPTools::GetBackend();
  for (const char* backend : { "Sequential", "STDThread", "TBB" })
  {
    if (!vtkSMPTools::SetBackend(backend))
    {
      continue; // this VTK was built without it
    }
    for (Quality quality : { Quality::Preview, Quality::Standard, Quality::High })
    {
      for (auto acceleration : { splatting::Acceleration::Dense, splatting::Acceleration::Bricks,
             splatting::Acceleration::Lines, splatting::Acceleration::SortedVolume })
      {
        splatting::ProjectionSettings settings;
        settings.quality = quality;
        settings.acceleration = acceleration;
        testStops(settings, check);
        settings.reduction = splatting::Reduction::Signed;
        testStops(settings, check);
      }
    }
  }
  vtkSMPTools::SetBackend(usual.c_str());
  return check.exitCode();
}
