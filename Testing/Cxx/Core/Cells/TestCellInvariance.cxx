// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Exact projections give the same bits for any instruction set, number of threads, rectangle of the
 * viewport and division into pieces. Values near the largest number do not overflow.
 */
#include "CellViews.h"

#include <vtkSMPTools.h>

#include <chrono>
#include <mutex>
#include <set>
#include <thread>

namespace
{
using namespace celltesting;

template <class T>
using Picture = std::vector<std::pair<splatting::Accumulator<T>, float>>;

/// All pixels of the viewport.
template <class T>
Picture<T> pictureOf(const View& view, const CellScreen& screen)
{
  using A = splatting::Accumulator<T>;
  Picture<T> picture;
  for (int y = 0; y < view.viewport.y; ++y)
  {
    for (int x = 0; x < view.viewport.x; ++x)
    {
      const A value = valueAt<A>(screen, x, y);
      picture.emplace_back(value, value == value ? depthAt(screen, x, y) : 0.0f);
    }
  }
  return picture;
}

template <class T>
bool sameBits(const Picture<T>& a, const Picture<T>& b)
{
  return std::equal(a.begin(), a.end(), b.begin(),
    [](const auto& p, const auto& q)
    {
      const bool bothNone = p.first != p.first && q.first != q.first;
      return bothNone || (p.first == q.first && p.second == q.second);
    });
}

/// The picture of a rectangle, tile offsets and all; the rest is taken from the whole.
template <class T>
Picture<T> withRectangle(
  Engine<T>& engine, const Scene<T>& scene, const Picture<T>& whole, const glm::ivec2 (&within)[2])
{
  CellScreen screen;
  engine.project(within, screen);
  Picture<T> picture = whole;
  const Picture<T> part = pictureOf<T>(scene.view, screen);
  const int width = scene.view.viewport.x;
  for (int y = within[0].y; y < std::min(within[0].y + within[1].y, scene.view.viewport.y); ++y)
  {
    for (int x = within[0].x; x < std::min(within[0].x + within[1].x, width); ++x)
    {
      picture[y * width + x] = part[y * width + x];
    }
  }
  return picture;
}

/// The larger values of two pieces; of equal ones the nearer.
template <class A>
void reduce(const CellScreen& part, CellScreen& whole)
{
  const A* const from = part.row<A>(0);
  A* const to = whole.row<A>(0);
  for (std::size_t n = 0; n < whole.depths.size(); ++n)
  {
    if (from[n] > to[n] || to[n] != to[n])
    {
      to[n] = from[n];
      whole.depths[n] = part.depths[n];
    }
    else if (from[n] == to[n])
    {
      whole.depths[n] = std::min(whole.depths[n], part.depths[n]);
    }
  }
  for (std::size_t n = 0; n < whole.minima.size(); ++n)
  {
    reduce<A>(part.minima[n], whole.minima[n]);
  }
}

/// The picture of two pieces with a voxel layer in common.
template <class T>
Picture<T> fromPieces(const Scene<T>& scene, const splatting::VolumeIndex::Range& range,
  const splatting::RayEnds& ends, int axis, int layer)
{
  CellScreen result;
  const glm::ivec3 whole = scene.view.dimensions;
  for (int p = 0; p < 2; ++p)
  {
    glm::ivec3 first(0), size = whole;
    first[axis] = p ? layer : 0;
    size[axis] = p ? whole[axis] - layer : layer + 1;
    reference::Volume<T> piece({ size.x, size.y, size.z });
    for (int k = 0; k < size.z; ++k)
    {
      for (int j = 0; j < size.y; ++j)
      {
        for (int i = 0; i < size.x; ++i)
        {
          piece.at(i, j, k) = scene.volume.at(first.x + i, first.y + j, first.z + k);
        }
      }
    }
    splatting::CellIndex index;
    index.update(splatting::CellGrid({ piece.voxels.data(), splatting::scalarTypeOf<T>(), size },
                   first, whole, scene.view.showsBoxes),
      range);
    splatting::CellProjector projector;
    CellScreen screen;
    projector.projectPiece(index, scene.view, scene.settings, ends, true, screen);
    if (p == 0)
    {
      result = screen;
      continue;
    }
    reduce<splatting::Accumulator<T>>(screen, result);
    splatting::CellProjector::finish(index, scene.settings, result);
  }
  return pictureOf<T>(scene.view, result);
}

template <class T>
Scene<T> anyScene(const std::array<int, 3>& size, Random& random)
{
  Scene<T> scene;
  scene.volume = coretesting::volumeWithOddValues<T>(size, random);
  scene.view = randomCellView(size, 200, random);
  scene.view.showsBoxes = random.oneIn(3);
  scene.locate = true;
  constexpr Reduction reductions[] = { Reduction::Maximum, Reduction::Minimum,
    Reduction::DepthShaded, Reduction::Signed };
  scene.settings.reduction = reductions[random.uniform(0, 3)];
  if (random.oneIn(2))
  {
    scene.view.halfSpaces = coretesting::anyHalfSpaces(size, random);
  }
  if (random.oneIn(3))
  {
    scene.view.cropping = coretesting::anyCropping(size, random);
  }
  return scene;
}

template <class T>
void testInvariance(Checks& check)
{
  reference::forScenes(coretesting::seriesOf<T>("invariance"), 80,
    [&](int, Random& random)
    {
      const std::array<int, 3> size = coretesting::randomSize(random, 22);
      Scene<T> scene = anyScene<T>(size, random);
      Engine<T> engine(scene);
      CellScreen screen;
      engine.project(screen);
      const Picture<T> whole = pictureOf<T>(scene.view, screen);
      for (const splatting::InstructionSet set : coretesting::instructionSets)
      {
        scene.settings.instructionSet = set;
        engine.project(screen);
        check(sameBits<T>(whole, pictureOf<T>(scene.view, screen)), "instruction set ",
          static_cast<int>(set));
      }
      const glm::ivec2 from(
        random.uniform(0, scene.view.viewport.x - 1), random.uniform(0, scene.view.viewport.y - 1));
      const glm::ivec2 within[2] = { from,
        glm::ivec2(random.uniform(1, 200), random.uniform(1, 200)) };
      check(sameBits<T>(whole, withRectangle(engine, scene, whole, within)), "rectangle");
      const int axis = random.uniform(0, 2);
      if (size[axis] > 2)
      {
        const int layer = random.uniform(1, size[axis] - 2);
        check(sameBits<T>(whole, fromPieces(scene, engine.range(), engine.ends(), axis, layer)),
          "pieces along ", axis, " of ", size[axis], " at ", layer, ", reduction ",
          static_cast<int>(scene.settings.reduction), ", boxes ", scene.view.showsBoxes,
          ", cropping ", scene.view.cropping.cuts(), ", half-spaces ",
          scene.view.halfSpaces.size());
      }
    });
}

/// How many threads take part in a loop.
int threadsUsed()
{
  std::mutex mutex;
  std::set<std::thread::id> threads;
  vtkSMPTools::For(0, 64, 1,
    [&](vtkIdType, vtkIdType)
    {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::lock_guard<std::mutex> lock(mutex);
      threads.insert(std::this_thread::get_id());
    });
  return static_cast<int>(threads.size());
}

/// Pictures of many tiles, and of bricks enough for each thread.
template <class T>
void testThreads(Checks& check)
{
  reference::forScenes(coretesting::seriesOf<T>("threads"), 16,
    [&](int, Random& random)
    {
      Scene<T> scene = anyScene<T>({ 40, 37, 35 }, random);
      const glm::dmat3 placement = randomPlacement(random);
      const glm::dvec3 direction = randomDirection(random);
      scene.view = random.oneIn(2)
        ? parallelView(scene.volume.size, 9.0, 520, direction, placement, random)
        : perspectiveView(scene.volume.size, 9.0, 520, 1.5, direction, placement, random);
      Engine<T> engine(scene);
      CellScreen screen;
      const std::string usual = vtkSMPTools::GetBackend();
      Picture<T> expected;
      for (const char* backend : { "Sequential", "STDThread", "TBB" })
      {
        if (!vtkSMPTools::SetBackend(backend))
        {
          continue; // this VTK was built without it
        }
        // TBB starts no more threads than there are cores and says so; the others do as told.
        const int threads = backend == std::string("TBB") ? 2 : random.uniform(2, 7);
        int used = 0;
        vtkSMPTools::LocalScope(vtkSMPTools::Config{ threads },
          [&]()
          {
            used = threadsUsed();
            engine.project(screen);
          });
        check(used > 1 || backend != std::string("STDThread"), backend, " has one thread");
        const Picture<T> picture = pictureOf<T>(scene.view, screen);
        expected = expected.empty() ? picture : expected;
        check(sameBits<T>(expected, picture), backend, " with ", threads, " threads");
      }
      vtkSMPTools::SetBackend(usual.c_str());
    });
}

/// Noise up to the largest number of both signs.
template <class T>
void testLargestValues(Checks& check)
{
  forFamily<T>("largest values", 80, Continuous, check,
    [&](Random& random, Counts& counts)
    {
      Scene<T> scene;
      const std::array<int, 3> size = coretesting::randomSize(random, 14);
      scene.volume = reference::uniformNoise<T>(size, random);
      const T largest =
        random.oneIn(2) ? std::numeric_limits<T>::max() : std::numeric_limits<T>::max() / 64;
      for (T& voxel : scene.volume.voxels)
      {
        voxel *= largest;
      }
      scene.view = randomCellView(size, 80, random);
      scene.settings.reduction = random.oneIn(2) ? Reduction::Minimum : Reduction::Maximum;
      counts.add(compareScene(scene, check));
    });
}
}

int TestCellInvariance(int, char*[])
{
  Checks check;
  testInvariance<std::uint8_t>(check);
  testInvariance<std::int16_t>(check);
  testInvariance<std::int64_t>(check);
  testInvariance<float>(check);
  testInvariance<double>(check);
  testThreads<std::int16_t>(check);
  testThreads<double>(check);
  testLargestValues<float>(check);
  testLargestValues<double>(check);
  return check.exitCode();
}
