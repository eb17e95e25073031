// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Prints a checksum of scalars and pictures for each type, mode and kind of view. Two
// processors must print the same: test-arm64.sh compares them. Scenes are made of what IEEE 754
// rounds correctly (no sines but those of cosine bells, which are the product's own).
#include "Cells/CellProjector.h"
#include "CoreTesting.h"
#include "Display/ScreenColors.h"
#include "Splat/Warp/Warp.h"

#include <cstring>
#include <iomanip>

using namespace coretesting;

namespace
{
/// The hash FNV-1a of numbers, given as their bytes.
class Checksum
{
public:
  template <class T>
  void add(T number)
  {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &number, sizeof(T));
    for (const unsigned char byte : bytes)
    {
      this->Hash = (this->Hash ^ byte) * 0x100000001B3u;
    }
  }
  void add(const splatting::ShearImage& image)
  {
    splatting::dispatch(image.type,
      [&](auto* null)
      {
        using P = std::remove_pointer_t<decltype(null)>;
        const reference::Image<P> pixels = toReference<P>(image);
        this->add(pixels.width);
        this->add(pixels.height);
        for (std::size_t p = 0; p < pixels.value.size(); ++p)
        {
          this->add(pixels.hit[p]);
          // Zeros are equal.
          this->add(pixels.value[p] == P() ? P() : pixels.value[p]);
        }
      });
  }
  void add(const splatting::CellScreen& screen)
  {
    splatting::dispatch(screen.type,
      [&](auto* null)
      {
        using P = std::remove_pointer_t<decltype(null)>;
        for (int y = 0; y < screen.size.y; ++y)
        {
          for (int x = 0; x < screen.size.x; ++x)
          {
            const P value = screen.row<P>(y)[x];
            this->add(value == value);
            this->add(value == value && value != P() ? value : P());
          }
        }
      });
    for (const float depth : screen.depths)
    {
      this->add(depth == depth);
      this->add(depth == depth ? depth : 0.0f);
    }
  }
  void add(const splatting::Picture& picture)
  {
    for (int a = 0; a < 2; ++a)
    {
      this->add(picture.origin[a]);
      this->add(picture.size[a]);
    }
    for (const std::uint32_t pixel : picture.pixels)
    {
      this->add(pixel);
    }
  }
  std::uint64_t hash() const { return this->Hash; }

private:
  std::uint64_t Hash = 0xCBF29CE484222325u;
};

/// From near the volume, or parallel; with any spacing.
splatting::View viewOf(const std::array<int, 3>& size, bool perspective, reference::Random& random)
{
  splatting::View view;
  view.dimensions = toGlm(size);
  view.viewport = { 90, 70 };
  const glm::dvec3 spacing = anyVector(random, 0.5, 2.0);
  const glm::dvec3 center = 0.5 * spacing * glm::dvec3(view.dimensions - 1);
  const glm::dvec3 eye = center + anyVector(random, -30.0, 30.0);
  const glm::dvec3 up = anyVector(random, -1.0, 1.0);
  const glm::dmat4 projection = perspective ? glm::frustum(-0.06, 0.07, -0.05, 0.05, 0.1, 1000.0)
                                            : glm::ortho(-30.0, 30.0, -25.0, 25.0, 0.1, 1000.0);
  view.indexToClip =
    projection * glm::lookAt(eye, center, up) * glm::scale(glm::dmat4(1.0), spacing);
  return view;
}

/// Entries that are all different, for the whole range of noise.
template <class T>
splatting::ColorTable tableFor()
{
  splatting::ColorTable table;
  table.low = std::numeric_limits<T>::is_integer ? double(std::numeric_limits<T>::lowest()) : -1.0;
  table.high = std::numeric_limits<T>::is_integer ? double(std::numeric_limits<T>::max()) : 1.0;
  for (std::uint32_t entry = 0; entry < 65536; ++entry)
  {
    table.colors.push_back(entry + 1);
  }
  return table;
}

/// What a view shows by cells, as numbers and as colours.
template <class T>
std::uint64_t checksumOfCells(const reference::Volume<T>& volume, const splatting::View& view,
  const splatting::ProjectionSettings& settings)
{
  const splatting::VoxelArray voxels{ volume.voxels.data(), splatting::scalarTypeOf<T>(),
    toGlm(volume.size) };
  splatting::VolumeIndex whole;
  whole.reset(voxels);
  splatting::CellIndex index;
  index.update({ voxels, glm::ivec3(0), toGlm(volume.size), view.showsBoxes }, whole.range());
  splatting::CellScreen screen;
  splatting::CellProjector().project(index, view, settings, {}, true, screen);
  Checksum sum;
  sum.add(screen);
  splatting::Picture picture;
  splatting::colorScreen(screen, tableFor<T>(), settings.instructionSet, picture);
  sum.add(picture);
  return sum.hash();
}

/// The same by shear images.
template <class T>
std::uint64_t checksumOf(const reference::Volume<T>& volume, const splatting::View& view,
  const splatting::ProjectionSettings& settings)
{
  std::vector<splatting::ShearWarp> geometries;
  splatting::ShearWarp::factorise(view, geometries);
  Checksum sum;
  std::vector<splatting::ShearImage> images;
  for (const splatting::ShearWarp& geometry : geometries)
  {
    images.push_back(project(volume, geometry, settings, cutsBy(geometry, view.halfSpaces)));
    sum.add(images.back());
  }
  splatting::WarpedScalars warped;
  warped.set(images, geometries, settings.reduction, view.viewport, settings.instructionSet);
  splatting::Picture picture;
  splatting::colorScreen(warped, tableFor<T>(), settings.instructionSet, picture);
  sum.add(picture);
  return sum.hash();
}

template <class T>
void printChecksums(const char* mode, const splatting::ProjectionSettings& settings)
{
  for (const bool perspective : { false, true })
  {
    reference::Random random(17);
    for (int scene = 0; scene < 4; ++scene)
    {
      const auto volume = reference::uniformNoise<T>({ 23, 31, 17 }, random);
      splatting::View view = viewOf(volume.size, perspective, random);
      if (scene >= 2)
      {
        const glm::dvec3 normal = anyVector(random, -1.0, 1.0);
        view.halfSpaces = { glm::dvec4(normal, -glm::dot(normal, glm::dvec3(11.0, 15.0, 8.0))) };
      }
      std::cout << mode << ", type " << static_cast<int>(splatting::scalarTypeOf<T>())
                << (perspective ? ", perspective" : ", parallel") << (scene < 2 ? "" : ", cut")
                << ", scene " << scene << ": " << std::hex << std::setw(16) << std::setfill('0')
                << (settings.quality == splatting::Quality::Exact
                       ? checksumOfCells(volume, view, settings)
                       : checksumOf(volume, view, settings))
                << std::dec << "\n";
    }
  }
}

void printForAllTypes(const char* mode, const splatting::ProjectionSettings& settings)
{
  forEachType(
    [&](auto* null) { printChecksums<std::remove_pointer_t<decltype(null)>>(mode, settings); });
}
}

int main()
{
  using splatting::Quality;
  using splatting::Reduction;
  const std::pair<Reduction, const char*> reductions[] = { { Reduction::Maximum, "maximum" },
    { Reduction::Minimum, "minimum" }, { Reduction::Mean, "mean" },
    { Reduction::DepthShaded, "depth-shaded" }, { Reduction::Local, "local maximum" } };
  const std::pair<Quality, const char*> qualities[] = { { Quality::Preview, "preview" },
    { Quality::Standard, "standard" }, { Quality::High, "high" }, { Quality::Exact, "exact" } };
  for (const auto& [reduction, reductionName] : reductions)
  {
    for (const auto& [quality, qualityName] : qualities)
    {
      if (quality == Quality::Exact && reduction == Reduction::Mean)
      {
        continue; // there are none
      }
      splatting::ProjectionSettings settings;
      settings.reduction = reduction;
      settings.quality = quality;
      printForAllTypes((qualityName + std::string(", ") + reductionName).c_str(), settings);
    }
  }
  splatting::ProjectionSettings settings;
  settings.kernel = { splatting::Reconstruction::CosineBell, 1.5 };
  printForAllTypes("high, cosine bell", settings);
  return 0;
}
