// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of the core share: checks, views with chosen shears, and the bridge between the
 * reference's volumes and images and the core's.
 */
#ifndef CoreTesting_h
#define CoreTesting_h

#include "Checks.h"
#include "Geometry/ShearWarp.h"
#include "Projection.h"
#include "RandomScene.h"
#include "Reductions.h"
#include "Scenes.h"
#include "SlabAverages.h"
#include "Splat/Projection/Project.h"
#include "Volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

namespace coretesting
{
using reference::Checks;

/**
 * Counts the scenes of a series that show something, so that no test passes because there was
 * nothing to see.
 */
class Sightings
{
public:
  void add(bool isSeen)
  {
    ++this->Scenes;
    this->Seen += isSeen;
  }
  /// Whether as many scenes show it as may be expected where it is in at least `share` of all:
  /// fewer come once in 10^9 series by chance. A scene that is run alone says nothing of its
  /// series.
  bool areEnough(double share) const
  {
    double chance = 0.0; // of so many or fewer: the binomial distribution
    for (int n = 0; n <= this->Seen && chance < 1e-9; ++n)
    {
      const double ways = std::lgamma(this->Scenes + 1.0) - std::lgamma(n + 1.0) -
        std::lgamma(this->Scenes - n + 1.0);
      chance += std::exp(ways + n * std::log(share) + (this->Scenes - n) * std::log1p(-share));
    }
    return !reference::onlyScene().empty() || chance >= 1e-9;
  }
  friend std::ostream& operator<<(std::ostream& stream, const Sightings& sightings)
  {
    return stream << sightings.Seen << " of " << sightings.Scenes << " scenes";
  }

private:
  int Scenes = 0, Seen = 0;
};

/// The name of a series of scenes that there is for each voxel type.
template <class T>
std::string seriesOf(const std::string& scenes)
{
  return scenes + ", type " + std::to_string(static_cast<int>(splatting::scalarTypeOf<T>()));
}

/// The name of a series of parallel or of perspective views.
inline std::string nameOf(const std::string& series, bool perspective)
{
  return series + (perspective ? ", in perspective" : "");
}

/// A random image.
inline splatting::ShearWarp anyGeometry(
  const std::array<int, 3>& size, bool perspective, reference::Random& random)
{
  return perspective ? randomPerspectiveImage(size, random)
                     : splatting::ShearWarp(anyView(size, random));
}

/// The view of a volume whose axes were permuted and reversed, so that it looks the same.
inline splatting::View transformedView(
  const splatting::View& view, const reference::AxisSymmetry& symmetry)
{
  splatting::View result = view;
  glm::dvec4 last = view.indexToClip[3];
  for (int a = 0; a < 3; ++a)
  {
    const int source = symmetry.axis[a];
    result.dimensions[a] = view.dimensions[source];
    result.indexToClip[a] = view.indexToClip[source] * double(symmetry.sign[a]);
    if (symmetry.sign[a] < 0)
    {
      last += view.indexToClip[source] * double(view.dimensions[source] - 1);
    }
  }
  result.indexToClip[3] = last;
  return result;
}

inline reference::ShearView referenceView(const splatting::ShearWarp& geometry)
{
  return { geometry.principalAxis(), { geometry.shear().x, geometry.shear().y } };
}

/// Describes an image, for messages.
inline std::string describe(const splatting::ShearWarp& image)
{
  std::ostringstream text;
  text << "axis " << image.principalAxis() << (image.reversed() ? " reversed" : "") << ", size "
       << image.size().x << " " << image.size().y << " " << image.size().z << ", shear "
       << image.shear().x << " " << image.shear().y << ", eye " << image.eye().x << " "
       << image.eye().y << " " << image.eye().z;
  return text.str();
}

/// The rays of an image: exact ones in parallel views, those of the image in perspective.
inline reference::ImageRays referenceRays(const splatting::ShearWarp& geometry)
{
  reference::ImageRays rays;
  rays.axes = geometry.axes();
  rays.size = toArray(geometry.size());
  if (!geometry.isPerspective())
  {
    return reference::raysOf(toArray(rays.volumeSize()), referenceView(geometry));
  }
  rays.at = { { geometry.columns().at, geometry.rows().at } };
  rays.slope = { { geometry.columns().slope, geometry.rows().slope } };
  rays.start = geometry.reference();
  rays.pitch = geometry.pitch();
  rays.eye = geometry.eye().z;
  rays.reversed = geometry.reversed();
  return rays;
}

/// Half-spaces of index space and cropping, as a projection takes them.
inline splatting::Cuts cutsBy(const splatting::ShearWarp& geometry,
  const std::vector<glm::dvec4>& halfSpaces, const splatting::Cropping& cropping = {})
{
  splatting::Cuts cuts;
  cuts.cropping = cropping;
  cuts.intervals.find(geometry, halfSpaces);
  return cuts;
}

/// The same cuts, as the references take them.
inline reference::RayCuts rayCutsOf(
  const std::vector<glm::dvec4>& halfSpaces, const splatting::Cropping& cropping)
{
  reference::RayCuts cuts;
  for (const glm::dvec4& h : halfSpaces)
  {
    cuts.halfSpaces.push_back({ h.x, h.y, h.z, h.w });
  }
  for (int a = 0; a < 3; ++a)
  {
    cuts.planes[a] = { cropping.planes[a].x, cropping.planes[a].y };
  }
  cuts.regions = cropping.flags;
  return cuts;
}

inline reference::RayCuts anyCuts(const std::array<int, 3>& size, reference::Random& random)
{
  std::vector<glm::dvec4> halfSpaces;
  if (random.chance(0.8))
  {
    halfSpaces = anyHalfSpaces(size, random);
  }
  splatting::Cropping cropping;
  if (random.oneIn(2))
  {
    cropping = anyCropping(size, random);
  }
  return rayCutsOf(halfSpaces, cropping);
}

inline splatting::Cuts cutsBy(const splatting::ShearWarp& geometry, const reference::RayCuts& cuts)
{
  std::vector<glm::dvec4> halfSpaces;
  for (const auto& h : cuts.halfSpaces)
  {
    halfSpaces.emplace_back(h[0], h[1], h[2], h[3]);
  }
  splatting::Cropping cropping;
  for (int a = 0; a < 3; ++a)
  {
    cropping.planes[a] = { cuts.planes[a][0], cuts.planes[a][1] };
  }
  cropping.flags = cuts.regions;
  return cutsBy(geometry, halfSpaces, cropping);
}

inline splatting::ShearImage project(splatting::VolumeIndex& index,
  const splatting::ShearWarp& geometry, const splatting::ProjectionSettings& settings,
  const splatting::Cuts& cuts)
{
  splatting::ShearImage image;
  splatting::Projector().project(index, geometry, settings, cuts, image);
  return image;
}

template <class T>
splatting::ShearImage project(const reference::Volume<T>& volume,
  const splatting::ShearWarp& geometry, const splatting::ProjectionSettings& settings,
  const splatting::Cuts& cuts = {})
{
  splatting::VolumeIndex index;
  index.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) });
  return project(index, geometry, settings, cuts);
}

/// What is projected to one image, except for the volume.
struct Case
{
  splatting::ShearWarp geometry;
  bool reversed = false; ///< the viewer is at the highest slice
  splatting::ProjectionSettings settings;
  reference::RayCuts cuts;
  std::size_t budget = std::numeric_limits<std::size_t>::max();
};

template <class T>
splatting::ShearImage projected(const reference::Volume<T>& volume, const Case& c)
{
  splatting::VolumeIndex index;
  index.setBudget(c.budget);
  index.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) });
  return project(index, c.geometry, c.settings, cutsBy(c.geometry, c.cuts));
}

/// The pixels of an image of type P in the reference's form.
template <class P>
reference::Image<P> toReference(const splatting::ShearImage& image)
{
  reference::Image<P> result(image.width, image.height);
  for (int v = 0; v < image.height; ++v)
  {
    for (int u = 0; u < image.width; ++u)
    {
      const P value = image.row<P>(v)[u];
      if (image.covers(u, v) && value == value)
      {
        result.value[result.index(u, v)] = value;
        result.hit[result.index(u, v)] = 1;
      }
    }
  }
  return result;
}

template <class P>
bool sameBits(const reference::Image<P>& a, const reference::Image<P>& b)
{
  return a.width == b.width && a.height == b.height && a.hit == b.hit && a.value == b.value;
}

/// Whether type and pixels are the same. What lies outside the volume has no meaning.
inline bool sameImages(const splatting::ShearImage& a, const splatting::ShearImage& b)
{
  return splatting::dispatch(a.type,
    [&](auto* null)
    {
      using P = std::remove_pointer_t<decltype(null)>;
      return a.type == b.type && sameBits(toReference<P>(a), toReference<P>(b));
    });
}

/// Infinity where one has a sample and the other one not.
template <class P>
double largestDifference(const reference::Image<P>& a, const reference::Image<P>& b)
{
  if (a.width != b.width || a.height != b.height || a.hit != b.hit)
  {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0.0;
  for (std::size_t p = 0; p < a.value.size(); ++p)
  {
    largest = std::max(largest, std::abs(double(a.value[p]) - double(b.value[p])));
  }
  return largest;
}

/// The depths at which a ray is in a box. Only slices whose centre is in front of the eye are used.
inline reference::Stretch<double> depthsInside(
  const std::vector<glm::dvec4>& box, const reference::ImageRays& rays, int u, int v)
{
  int first = 0, last = rays.size[2] - 1;
  while (first < last && !rays.sees(first))
  {
    ++first;
  }
  while (first < last && !rays.sees(last))
  {
    --last;
  }
  const std::array<double, 2> faces = rays.faces(first, last);
  auto depths = reference::inside(box, rays.point(u, v, 0.0), rays.direction(u, v));
  depths.narrow({ faces[0], faces[1] });
  return depths;
}

/// More than a few roundings of rays.
constexpr double GrazeWidth = 1e-5;

/// Whether a ray crosses the volume, enlarged by `margin` voxels.
inline bool meets(const reference::ImageRays& rays, int u, int v, double margin)
{
  return depthsInside(reference::boxOfVolume(rays.volumeSize(), true, margin), rays, u, v)
           .length() >= 0.0;
}

/// Takes the pixels off an image that it may count to the volume although their rays pass beside an
/// edge of it, see ShearImage::spans.
template <class T, class IsHit>
void forgetGrazes(const splatting::ShearWarp& image, IsHit&& isHit, reference::Image<T>& found)
{
  const reference::ImageRays rays = referenceRays(image);
  for (int v = 0; !rays.isParallel() && v < rays.height(); ++v)
  {
    // From the right, because a removed pixel must not keep the next one.
    for (int u = rays.width() - 1; u > 0; --u)
    {
      if (found.isHit(u, v) && !isHit(u, v) && found.isHit(u - 1, v) &&
        meets(rays, u, v, GrazeWidth))
      {
        found.at(u, v) = T();
        found.hit[found.index(u, v)] = 0;
      }
    }
  }
}

/// Calls f with a null pointer to each voxel type.
template <class F>
void forEachType(F&& f)
{
  for (int type = 0; type <= static_cast<int>(splatting::ScalarType::Float64); ++type)
  {
    splatting::dispatch(static_cast<splatting::ScalarType>(type), f);
  }
}

/// Modes standard and high, with the kernels that matter.
struct Mode
{
  splatting::Quality quality;
  splatting::Kernel kernel;
  reference::Kernel reference;
};

inline std::vector<Mode> modes()
{
  using splatting::Quality;
  using splatting::Reconstruction;
  return { { Quality::Standard, {}, { reference::Kernel::Nearest, 1.0 } },
    { Quality::High, { Reconstruction::Hat, 1.0 }, { reference::Kernel::Trilinear, 1.0 } },
    { Quality::High, { Reconstruction::CosineBell, 1.0 }, { reference::Kernel::CosineBell, 1.0 } },
    { Quality::High, { Reconstruction::CosineBell, 0.6 }, { reference::Kernel::CosineBell, 0.6 } },
    { Quality::High, { Reconstruction::CosineBell, 1.5 },
      { reference::Kernel::CosineBell, 1.5 } } };
}

/// A mode with its usual kernel. Previews ignore the kernel.
inline Mode modeOf(splatting::Quality quality)
{
  Mode mode = modes()[quality == splatting::Quality::High ? 1 : 0];
  mode.quality = quality;
  return mode;
}

inline splatting::ProjectionSettings settingsOf(const Mode& mode)
{
  splatting::ProjectionSettings settings;
  settings.quality = mode.quality;
  settings.kernel = mode.kernel;
  return settings;
}
}

#endif
