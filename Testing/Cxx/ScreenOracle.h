// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    ScreenOracle.h
 * @brief   what pixels of a window must show, from the camera's matrices and the mapper's settings
 *
 * Nothing here asks the mapper where it has put anything.
 */
#ifndef ScreenOracle_h
#define ScreenOracle_h

#include "CellBounds.h"
#include "MapperOracle.h"
#include "ScreenPixels.h"
#include "SlabAverages.h"
#include "Traversal.h"

#include "vtkRenderWindow.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace stage
{

/**
 * The rays of a window's pixels in index space, the image's first voxel at the origin.
 */
class ScreenRays
{
public:
  using Point = std::array<double, 3>;

  ScreenRays(Stage& stage, vtkImageData* image)
  {
    const int* const size = stage.window->GetSize();
    std::copy(size, size + 2, this->Size);
    for (int a = 0; a < 3; ++a)
    {
      this->First[a] = image->GetExtent()[2 * a];
    }
    vtkNew<vtkMatrix4x4> toWorld;
    vtkMatrix4x4::Multiply4x4(
      stage.volume->GetMatrix(), image->GetIndexToPhysicalMatrix(), toWorld);
    vtkCamera* const camera = stage.renderer->GetActiveCamera();
    // The camera's composite matrix leaves stereo out.
    vtkMatrix4x4::Multiply4x4(camera->GetViewTransformMatrix(), toWorld, this->ToIndex);
    vtkMatrix4x4::Multiply4x4(
      camera->GetProjectionTransformMatrix(stage.renderer->GetTiledAspectRatio(), -1.0, 1.0),
      this->ToIndex, this->ToIndex);
    this->ToIndex->Invert();
    toWorld->Invert();
    const double* const eye = camera->GetPosition();
    this->Eye = this->pointOf(toWorld, { eye[0], eye[1], eye[2] });
    this->BeginsAtEye = !camera->GetParallelProjection() && !camera->GetStereo();
  }

  /// Where a pixel's ray begins: at the eye or, in parallel views and those of one of two eyes
  /// beside the camera's place, on the near plane.
  Point begin(double x, double y) const
  {
    return this->BeginsAtEye ? this->Eye : this->at(x, y, -1.0);
  }
  Point end(double x, double y) const { return this->at(x, y, 1.0); }

private:
  Point pointOf(vtkMatrix4x4* matrix, const Point& p) const
  {
    double q[4] = { p[0], p[1], p[2], 1.0 };
    matrix->MultiplyPoint(q, q);
    return { q[0] / q[3] - this->First[0], q[1] / q[3] - this->First[1],
      q[2] / q[3] - this->First[2] };
  }
  Point at(double x, double y, double depth) const
  {
    return this->pointOf(this->ToIndex,
      { (2.0 * x + 1.0) / this->Size[0] - 1.0, (2.0 * y + 1.0) / this->Size[1] - 1.0, depth });
  }

  vtkNew<vtkMatrix4x4> ToIndex;
  int Size[2];
  int First[3];
  Point Eye;
  bool BeginsAtEye;
};

/// The largest (or smallest) value of the field on the ray of a pixel.
inline reference::CellBounds extremumOnRay(const reference::CellScene<double>& field,
  const ScreenRays& rays, double x, double y, bool isMinimum = false)
{
  const ScreenRays::Point begin = rays.begin(x, y), end = rays.end(x, y);
  return reference::boundsBetween(
    field, { begin[0], begin[1], begin[2] }, { end[0], end[1], end[2] }, isMinimum, 0x1p-18);
}

/// How far a gray may be from the field's extremum in a picture with 255 grays for bytes from 0 to
/// 255: half a gray, and 1/16 that the table of colours is off.
constexpr double FieldTolerance = 0.5 + 1.0 / 16 + 0.01;

/// The largest (or least) voxel within so many voxels along each axis.
template <class Pick>
reference::Volume<std::uint8_t> spread(
  reference::Volume<std::uint8_t> volume, int radius, const Pick& pick)
{
  for (int a = 0; a < 3; ++a)
  {
    const reference::Volume<std::uint8_t> source = volume;
    std::array<int, 3> p;
    for (p[2] = 0; p[2] < volume.size[2]; ++p[2])
    {
      for (p[1] = 0; p[1] < volume.size[1]; ++p[1])
      {
        for (p[0] = 0; p[0] < volume.size[0]; ++p[0])
        {
          std::uint8_t& voxel = volume.at(p);
          std::array<int, 3> q = p;
          for (q[a] = std::max(p[a] - radius, 0); q[a] <= p[a] + radius && q[a] < volume.size[a];
               ++q[a])
          {
            voxel = pick(voxel, source.at(q));
          }
        }
      }
    }
  }
  return volume;
}

inline reference::Volume<std::uint8_t> dilated(
  const reference::Volume<std::uint8_t>& volume, int radius)
{
  return spread(volume, radius, [](std::uint8_t a, std::uint8_t b) { return std::max(a, b); });
}
inline reference::Volume<std::uint8_t> eroded(
  const reference::Volume<std::uint8_t>& volume, int radius)
{
  return spread(volume, radius, [](std::uint8_t a, std::uint8_t b) { return std::min(a, b); });
}

/**
 * A parallel view's pixels by definition: where a pixel's ray meets the shear image, between the
 * four rays beside it, each reduced sample by sample. For volumes that stay while this lives.
 */
class Definition
{
public:
  using Bytes = reference::Volume<std::uint8_t>;
  using Pixel = reference::ExpectedPixel;

  explicit Definition(const Bytes& volume)
    : Volume(volume),
      Exact(reference::toDouble(volume)),
      Least(eroded(volume, Reach)),
      Most(dilated(volume, Reach)),
      Lowest(reference::lowestVoxel(volume))
  {
  }

  /// Before pixel(): the view, of a mapper without planes other than those of cropping. False if
  /// two axes are so nearly as near to the rays that either may be the principal one.
  bool look(Stage& stage, vtkImageData* image, vtkSplattingMIPVolumeMapper* mapper)
  {
    this->Known.clear();
    this->Mapper = mapper;
    this->Rays.emplace(stage, image);
    const auto begin = this->Rays->begin(0, 0), end = this->Rays->end(0, 0);
    std::array<double, 3> d;
    for (int a = 0; a < 3; ++a)
    {
      d[a] = end[a] - begin[a];
    }
    int k = 0;
    for (int a = 1; a < 3; ++a)
    {
      k = std::abs(d[a]) > std::abs(d[k]) ? a : k;
    }
    reference::ShearView view;
    view.axis = k;
    this->Reversed = d[k] < 0.0;
    const int across[2] = { k == 0 ? 1 : 0, k == 2 ? 1 : 2 };
    double largest = 0.0;
    for (int a = 0; a < 2; ++a)
    {
      const double shear = -d[across[a]] / d[k];
      view.shear[a] = std::ldexp(std::round(std::ldexp(shear, 24)), -24);
      largest = std::max(largest, std::abs(shear));
    }
    this->Shear = reference::raysOf(this->Volume.size, view);
    this->Cutter.emplace(this->Shear, croppingOf(mapper, image));
    return largest < 0.999;
  }

  Pixel pixel(int x, int y)
  {
    const auto point = this->Rays->begin(x, y);
    return reference::betweenRays(
      this->Shear, { point[0], point[1], point[2] }, [&](int u, int v) { return this->ray(u, v); });
  }

private:
  static constexpr int Reach = 3; ///< of a worksheet about the voxels that its ray crosses

  reference::Kernel kernel() const
  {
    if (this->Mapper->GetQualityMode() == vtkSplattingMIPVolumeMapper::STANDARD)
    {
      return { reference::Kernel::Nearest, 1.0 };
    }
    return { reference::Kernel::Trilinear, 1.0 };
  }

  /// A slice's sample; voxels that are all the same need no integral.
  reference::Sample<double> sampleAt(
    int u, int v, int slice, std::uint8_t low, std::uint8_t high) const
  {
    if (low == high)
    {
      return { slice, double(low), 1.0 };
    }
    return reference::slabSample(this->Exact, this->Shear, this->kernel(), u, v, slice);
  }

  const reference::ReducedRay& ray(int u, int v)
  {
    const auto found = this->Known.find({ u, v });
    if (found != this->Known.end())
    {
      return found->second;
    }
    std::vector<reference::Sample<double>> samples;
    const auto crossed = reference::crossedVoxels(this->Shear, u, v);
    const int k = this->Shear.axes[2];
    for (std::size_t n = 0; n < crossed.size();)
    {
      const int slice = crossed[n][k];
      std::uint8_t low = 255, high = 0;
      for (; n < crossed.size() && crossed[n][k] == slice; ++n)
      {
        low = std::min(low, this->Least.at(crossed[n]));
        high = std::max(high, this->Most.at(crossed[n]));
        if (this->Mapper->GetQualityMode() == vtkSplattingMIPVolumeMapper::PREVIEW)
        {
          samples.push_back({ slice, double(this->Volume.at(crossed[n])), 1.0 });
        }
      }
      if (this->Mapper->GetQualityMode() != vtkSplattingMIPVolumeMapper::PREVIEW)
      {
        samples.push_back(this->sampleAt(u, v, slice, low, high));
      }
    }
    const auto cut = reference::cutRay(samples, *this->Cutter, u, v, this->Reversed);
    const auto outcome = reduced(cut, this->Lowest, this->Mapper);
    return this->Known[{ u, v }] = { !crossed.empty(), outcome.hit, outcome.value };
  }

  const Bytes& Volume;
  const reference::Volume<double> Exact;
  const Bytes Least, Most;
  const double Lowest;
  vtkSplattingMIPVolumeMapper* Mapper = nullptr;
  std::optional<ScreenRays> Rays;
  std::optional<reference::RayCutter> Cutter;
  bool Reversed = false;
  reference::ImageRays Shear;
  std::map<std::pair<int, int>, reference::ReducedRay> Known;
};

/**
 * How far a gray may be from the definition of a picture with 255 grays for bytes from 0 to 255:
 * half a gray, 1/16 that the table of colours is off, the weights' rounding, as the mapper's class
 * documentation has it (75 weights by 2^-17), and some for rounded places in the shear image.
 */
constexpr double GrayTolerance = 0.5 + 1.0 / 16 + 255.0 * 75.0 / 131072.0 + 0.01;

/**
 * Between what a maximum of any mode must lie, in any view: no more than the largest voxel near the
 * ray and no less than the largest of the least ones there.
 *
 * A pixel is a mean of four pixels of the shear image, which are a voxel wide at most. So where the
 * pixel's own ray is at p, theirs are within a voxel along each axis but the principal one. From
 * there it is half a voxel to the voxel that is crossed; in STANDARD also a voxel, as a slice's
 * rays move by up to one, and one that a footprint reaches; in HIGH half a voxel more. From the
 * middle of the voxel that p is in that makes less than 2, 3.5 and 4.
 *
 * Cropping is decided in the middle of a slice, two voxels from there at most, or three if a region
 * is thinner than a slice.
 */
class Envelope
{
public:
  using Bytes = reference::Volume<std::uint8_t>;

  Envelope(const Bytes& volume, int mode, const reference::RayCuts& cuts = {})
    : Envelope(volume, cuts, mode == vtkSplattingMIPVolumeMapper::PREVIEW ? 1 : 3)
  {
  }

  /// The ray's own voxels: both limits are the largest of them.
  explicit Envelope(const Bytes& volume) : Low(volume), High(volume) {}

  struct Limits
  {
    double low = 0.0, high = 0.0;
  };

  Limits at(const ScreenRays& rays, int x, int y) const
  {
    const auto begin = rays.begin(x, y), end = rays.end(x, y);
    std::array<reference::AxisMotion, 3> ray;
    for (int a = 0; a < 3; ++a)
    {
      ray[a].start = std::llround(std::ldexp(begin[a], 34));
      ray[a].velocity = std::llround(std::ldexp(end[a] - begin[a], 34));
    }
    Limits limits;
    for (const std::array<int, 3>& p : reference::traverse(ray, 1, this->Low.size))
    {
      limits.low = std::max<double>(limits.low, this->Low.at(p));
      limits.high = std::max<double>(limits.high, this->High.at(p));
    }
    return limits;
  }

private:
  Envelope(const Bytes& volume, const reference::RayCuts& cuts, int reach)
  {
    Bytes low = volume, high = volume;
    std::array<int, 3> p;
    for (p[2] = 0; p[2] < volume.size[2]; ++p[2])
    {
      for (p[1] = 0; p[1] < volume.size[1]; ++p[1])
      {
        for (p[0] = 0; p[0] < volume.size[0]; ++p[0])
        {
          low.at(p) = shownAbout(p, cuts, 3.0).all ? low.at(p) : 0;
          high.at(p) = shownAbout(p, cuts, reach + 3.0).any ? high.at(p) : 0;
        }
      }
    }
    this->Low = eroded(low, reach);
    this->High = dilated(high, reach);
  }

  struct Shown
  {
    bool any, all;
  };

  /// Of the regions within some distance of a voxel.
  static Shown shownAbout(const std::array<int, 3>& p, const reference::RayCuts& cuts, double reach)
  {
    int first[3], last[3];
    for (int a = 0; a < 3; ++a)
    {
      const auto region = [&](double at) {
        return at < cuts.planes[a][0] ? 0 : at <= cuts.planes[a][1] ? 1 : 2;
      };
      first[a] = region(p[a] - reach);
      last[a] = region(p[a] + reach);
    }
    Shown shown = { false, true };
    for (int k = first[2]; k <= last[2]; ++k)
    {
      for (int j = first[1]; j <= last[1]; ++j)
      {
        for (int i = first[0]; i <= last[0]; ++i)
        {
          const bool is = (cuts.regions >> (i + 3 * j + 9 * k)) & 1u;
          shown.any = shown.any || is;
          shown.all = shown.all && is;
        }
      }
    }
    return shown;
  }

  Bytes Low, High;
};

/// A pixel of the picture, every other time one that a picture by other means shows something in.
inline std::array<int, 2> somePixel(
  const reference::Image<double>& other, bool bright, reference::Random& random)
{
  std::array<int, 2> pixel;
  for (int tries = 0; tries < 100; ++tries)
  {
    pixel[0] = random.uniform(0, other.width - 1);
    pixel[1] = random.uniform(0, other.height - 1);
    if (!bright || other.at(pixel[0], pixel[1]) > 0.0)
    {
      break;
    }
  }
  return pixel;
}

} // namespace stage

#endif
