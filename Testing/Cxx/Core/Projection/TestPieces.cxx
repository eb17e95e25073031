// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The maximum (or minimum) of the images of a volume's pieces is the image of the whole, bit for
// bit.
#include "CoreTesting.h"
#include "Splat/Projection/Piece.h"

#include <algorithm>
#include <cstring>

using namespace coretesting;
using splatting::Box;
using splatting::Quality;
using splatting::Reduction;

namespace
{
const Quality Qualities[] = { Quality::Preview, Quality::Standard, Quality::High };

/// Cuts a box into a number of parts, at any place, some of which hold nothing.
void cut(const Box& box, int count, reference::Random& random, std::vector<Box>& parts)
{
  if (count == 1)
  {
    parts.push_back(box);
    return;
  }
  const int axis = random.uniform(0, 2), first = random.uniform(1, count - 1);
  Box low = box, high = box;
  low.end[axis] = high.begin[axis] = random.uniform(box.begin[axis], box.end[axis]);
  cut(low, first, random, parts);
  cut(high, count - first, random, parts);
}

Box grown(const Box& box, int layers, const glm::ivec3& whole)
{
  return { glm::max(box.begin - layers, glm::ivec3(0)), glm::min(box.end + layers, whole) };
}

template <class T>
std::vector<T> voxelsOf(const reference::Volume<T>& volume, const Box& box)
{
  std::vector<T> voxels;
  for (int k = box.begin.z; k < box.end.z; ++k)
  {
    for (int j = box.begin.y; j < box.end.y; ++j)
    {
      for (int i = box.begin.x; i < box.end.x; ++i)
      {
        voxels.push_back(volume.at(i, j, k));
      }
    }
  }
  return voxels;
}

/// Raises (or lowers) numbers to others.
void reduce(splatting::ShearImage& all, const splatting::ShearImage& one,
  splatting::ScalarType keys, Reduction reduction)
{
  splatting::dispatch(keys,
    [&](auto* null)
    {
      using Key = std::remove_pointer_t<decltype(null)>;
      Key* const to = reinterpret_cast<Key*>(all.bytes.data());
      const Key* const from = reinterpret_cast<const Key*>(one.bytes.data());
      for (std::size_t n = 0; n < std::size_t(all.width) * all.height; ++n)
      {
        to[n] =
          reduction == Reduction::Minimum ? std::min(to[n], from[n]) : std::max(to[n], from[n]);
      }
    });
}

template <class T>
splatting::ShearImage projectPieces(const reference::Volume<T>& volume, const Case& scene,
  const std::vector<Box>& pieces, splatting::Projector& projector)
{
  splatting::VolumeIndex whole;
  whole.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) });
  const splatting::Cuts cuts = cutsBy(scene.geometry, scene.cuts);
  splatting::ShearImage all;
  splatting::ScalarType type = splatting::ScalarType::UInt8;
  for (const Box& piece : pieces)
  {
    if (piece.empty())
    {
      continue;
    }
    const std::vector<T> voxels = voxelsOf(volume, piece);
    splatting::VolumeIndex index;
    index.reset({ voxels.data(), splatting::scalarTypeOf<T>(), piece.end - piece.begin });
    index.setRangeOfWhole(whole.range());
    splatting::ShearImage image;
    projector.project(index, scene.geometry, scene.settings, cuts, image, piece.begin);
    type = image.type;
    const splatting::ScalarType keys = encode(image, scene.settings.reduction);
    all.bytes.empty() ? void(all = image) : reduce(all, image, keys, scene.settings.reduction);
  }
  projector.outline(scene.geometry, scene.settings, cuts, all);
  decode(all, type, scene.settings.reduction);
  return all;
}

Case randomScene(const std::array<int, 3>& size, reference::Random& random)
{
  Case scene;
  const bool perspective = random.uniform(0, 1);
  splatting::View view = anyView(size, random);
  view.showsBoxes = random.oneIn(4);
  scene.geometry = perspective ? randomPerspectiveImage(size, random) : splatting::ShearWarp(view);
  splatting::ProjectionSettings& settings = scene.settings;
  settings.quality = Qualities[random.uniform(0, 2)];
  if (settings.quality == Quality::High && random.oneIn(3))
  {
    settings.kernel = { splatting::Reconstruction::CosineBell, random.uniform(0.5, 1.5) };
  }
  settings.footprintSampling = random.oneIn(6) ? 10 : 0;
  const Reduction reductions[] = { Reduction::Maximum, Reduction::Maximum, Reduction::Minimum,
    Reduction::DepthShaded };
  settings.reduction = reductions[random.uniform(0, 3)];
  settings.acceleration = static_cast<splatting::Acceleration>(random.uniform(0, 3));
  if (random.oneIn(2))
  {
    scene.cuts = anyCuts(size, random);
  }
  return scene;
}

template <class T>
void testPieces(Checks& check, const char* series, int count, int largest, Sightings& empty)
{
  reference::forScenes(seriesOf<T>(series), count,
    [&](int, reference::Random& random)
    {
      splatting::Projector projector;
      // The second volume, too, is projected as if it were the first one.
      for (int turn = 0; turn < 2; ++turn)
      {
        const std::array<int, 3> size = randomSize(random, largest);
        const reference::Volume<T> volume = volumeWithOddValues<T>(size, random);
        const Case scene = randomScene(size, random);
        std::vector<Box> parts;
        cut({ glm::ivec3(0), toGlm(size) }, random.uniform(1, 4), random, parts);
        empty.add(
          std::any_of(parts.begin(), parts.end(), [](const Box& part) { return part.empty(); }));
        const int layers = splatting::reachOf(scene.settings.quality).layers();
        for (Box& part : parts)
        {
          part = part.empty() ? part : grown(part, layers, toGlm(size));
        }
        splatting::VolumeIndex index;
        index.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(size) });
        const splatting::Cuts cuts = cutsBy(scene.geometry, scene.cuts);
        splatting::ShearImage expected;
        projector.project(index, scene.geometry, scene.settings, cuts, expected);
        const splatting::ShearImage found = projectPieces(volume, scene, parts, projector);
        check(sameImages(found, expected), "a scene of type ", int(splatting::scalarTypeOf<T>()),
          " differs: quality ", int(scene.settings.quality), ", reduction ",
          int(scene.settings.reduction), ", ", parts.size(), " pieces, perspective ",
          scene.geometry.isPerspective(), ", axis ", scene.geometry.principalAxis(), ", cut ",
          !cuts.none(), ", NaN ", index.range().nonFinite, ", acceleration ",
          int(scene.settings.acceleration), ", size ", size[0], " ", size[1], " ", size[2]);
      }
    });
}

/// Boxes cover a volume if each voxel is in one.
void testCover(Checks& check)
{
  Sightings covered, uncovered;
  reference::forScenes("covers", 2000,
    [&](int, reference::Random& random)
    {
      const glm::ivec3 size = toGlm(randomSize(random, 5));
      std::vector<Box> boxes;
      cut({ glm::ivec3(0), size }, random.uniform(1, 5), random, boxes);
      for (Box& box : boxes)
      {
        const int first = random.uniform(0, 2), last = random.uniform(0, 2);
        box.begin[first] -= random.uniform(0, 1);
        box.end[last] -= random.oneIn(4);
      }
      bool all = true;
      for (int v = 0; v < size.x * size.y * size.z; ++v)
      {
        const glm::ivec3 voxel(v % size.x, v / size.x % size.y, v / size.x / size.y);
        all = all &&
          std::any_of(boxes.begin(), boxes.end(),
            [&](const Box& box)
            {
              return glm::all(glm::greaterThanEqual(voxel, box.begin)) &&
                glm::all(glm::lessThan(voxel, box.end));
            });
      }
      covered.add(all);
      uncovered.add(!all);
      check(splatting::cover(boxes, size) == all, "boxes cover the volume: ", all);
    });
  check(covered.areEnough(0.2) && uncovered.areEnough(0.2), "boxes cover the volume in ", covered);
  const Box piece{ { 0, 4, 4 }, { 5, 9, 10 } };
  check(
    splatting::interiorOf(piece, { 10, 10, 10 }, { 1, 2, 1 }) == Box{ { 0, 6, 5 }, { 4, 7, 10 } },
    "the interior has other layers");
}

/// Numbers keep their order as integers, and what is none loses to all.
void testKeys(Checks& check)
{
  const float infinity = std::numeric_limits<float>::infinity();
  const float numbers[] = { -infinity, -std::numeric_limits<float>::max(), -1.0f, -1e-40f, -0.0f,
    0.0f, 1e-40f, 1.0f, std::numeric_limits<float>::max(), infinity,
    std::numeric_limits<float>::quiet_NaN() };
  constexpr int count = sizeof numbers / sizeof *numbers;
  for (const Reduction reduction : { Reduction::Maximum, Reduction::Minimum })
  {
    splatting::ShearImage image;
    image.type = splatting::ScalarType::Float32;
    image.width = count;
    image.height = 1;
    image.nonFinite = true;
    image.spans.assign(1, { 0, count });
    image.bytes.resize(sizeof numbers);
    std::memcpy(image.bytes.data(), numbers, sizeof numbers);
    check(splatting::encode(image, reduction) == splatting::ScalarType::Int32, "keys are no int");
    std::int32_t keys[count];
    std::memcpy(keys, image.bytes.data(), sizeof keys);
    check(std::is_sorted(keys, keys + count - 1), "numbers lose their order");
    check(reduction == Reduction::Minimum ? keys[count - 1] > keys[count - 2]
                                          : keys[count - 1] < keys[0],
      "no number is a number");
    splatting::decode(image, splatting::ScalarType::Float32, reduction);
    check(std::memcmp(image.bytes.data(), numbers, sizeof numbers - sizeof(float)) == 0 &&
        std::isnan(image.row<float>(0)[count - 1]),
      "numbers come back as others");
  }
}
}

int TestPieces(int, char*[])
{
  Checks check;
  testCover(check);
  testKeys(check);
  Sightings empty;
  forEachType(
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      testPieces<T>(check, "pieces", 100, 12, empty);
      testPieces<T>(check, "large pieces", 10, 70, empty);
    });
  check(empty.areEnough(0.02), "pieces hold nothing in only ", empty);
  return check.exitCode();
}
