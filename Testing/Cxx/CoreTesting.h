// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of the core share: checks, views with chosen shears, and the bridge between the
 * reference's volumes and images and the core's.
 */
#ifndef CoreTesting_h
#define CoreTesting_h

#include "Geometry/ShearWarp.h"
#include "PerspectiveProjection.h"
#include "Projection.h"
#include "Projection/Project.h"
#include "Random.h"
#include "Volume.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace coretesting
{
/// Counts failures and prints the first few of them.
class Checks
{
public:
  template <class... Message>
  bool operator()(bool condition, const Message&... message)
  {
    if (!condition && ++this->Failures <= 20)
    {
      std::cerr << "ERROR: ";
      (std::cerr << ... << message) << reference::howToRepeat() << std::endl;
    }
    return condition;
  }
  int result()
  {
    (*this)(reference::onlyScene().empty() || reference::scenesRun() > 0, "There is no scene ",
      reference::onlyScene());
    if (this->Failures)
    {
      std::cerr << this->Failures << " checks failed" << std::endl;
    }
    return this->Failures ? EXIT_FAILURE : EXIT_SUCCESS;
  }

private:
  int Failures = 0;
};

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

/// All of them; those that the processor lacks are the best that it has.
inline constexpr splatting::InstructionSet instructionSets[] = {
  splatting::InstructionSet::Baseline, splatting::InstructionSet::AVX2,
  splatting::InstructionSet::AVX512, splatting::InstructionSet::AVX512VBMI
};

inline splatting::InstructionSet anyInstructionSet(reference::Random& random)
{
  return instructionSets[random.uniform(0, 3)];
}

inline splatting::Acceleration anyAcceleration(reference::Random& random)
{
  return static_cast<splatting::Acceleration>(random.uniform(0, 5));
}

/// Any in a box.
inline glm::dvec3 anyVector(reference::Random& random, double low, double high)
{
  glm::dvec3 v;
  for (int a = 0; a < 3; ++a)
  {
    v[a] = random.uniform(low, high);
  }
  return v;
}

inline glm::ivec3 toGlm(const std::array<int, 3>& size)
{
  return { size[0], size[1], size[2] };
}

/// A parallel view with a given principal axis and shears, one screen pixel per shear pixel.
inline splatting::View viewWithShear(
  const std::array<int, 3>& size, int axis, double shearX, double shearY)
{
  const int i = axis == 0 ? 1 : 0, j = axis == 2 ? 1 : 2;
  splatting::View view;
  view.dimensions = toGlm(size);
  view.viewport = { 400, 400 };
  glm::dmat4& m = view.indexToClip;
  m = glm::dmat4(0.0);
  m[i][0] = m[j][1] = 2.0 / 400;
  m[axis][0] = shearX * 2.0 / 400;
  m[axis][1] = shearY * 2.0 / 400;
  m[axis][2] = 1e-3;
  m[3][3] = 1.0;
  return view;
}

/// A view from anywhere, with any spacing.
inline splatting::View randomView(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::View view;
  view.dimensions = toGlm(size);
  view.viewport = { random.uniform(50, 400), random.uniform(50, 400) };
  glm::dmat4 m(1.0);
  m = glm::scale(m, glm::dvec3(0.02, 0.02, 0.001));
  for (int turn = 0; turn < 3; ++turn)
  {
    const glm::dvec3 axis{ random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0),
      random.uniform(0.1, 1.0) };
    m = glm::rotate(m, random.uniform(0.0, 6.3), glm::normalize(axis));
  }
  m = glm::scale(m, anyVector(random, 0.3, 3.0));
  view.indexToClip = glm::translate(m, -0.5 * glm::dvec3(view.dimensions - 1));
  return view;
}

/// A perspective view: from inside the volume, from nearby or from afar, some from half-way between
/// voxels or along an axis, with any spacing, view angles from 5 to 120 degrees, some off-axis.
inline splatting::View randomPerspective(const std::array<int, 3>& size, reference::Random& random)
{
  splatting::View view;
  view.dimensions = toGlm(size);
  view.viewport = { random.uniform(20, 200), random.uniform(20, 200) };
  const glm::dvec3 spacing = anyVector(random, 0.5, 2.0);
  const double reach = std::pow(10.0, random.uniform(-1.0, 2.5));
  glm::dvec3 eye, focus;
  for (int a = 0; a < 3; ++a)
  {
    focus[a] = random.uniform(0.0, size[a] - 1.0);
    eye[a] = 0.5 * (size[a] - 1) + reach * size[a] * random.uniform(-1.0, 1.0);
  }
  if (random.uniform(0, 3) == 0)
  {
    // Where rays meet edges, and look along an axis or a diagonal.
    eye = glm::round(2.0 * eye) / 2.0;
    for (int a = 0; a < 3; ++a)
    {
      focus[a] = eye[a] + random.uniform(-1, 1);
    }
  }
  const glm::dvec3 up{ random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.9 };
  const double angle = glm::radians(random.uniform(5.0, 120.0));
  const double top = 0.1 * std::tan(0.5 * angle), right = top * view.viewport.x / view.viewport.y;
  const double shift = random.uniform(0, 1) ? random.uniform(-0.5, 0.5) : 0.0;
  const glm::dmat4 projection =
    glm::frustum((shift - 1.0) * right, (shift + 1.0) * right, -top, top, 0.1, 10000.0);
  view.indexToClip = projection *
    glm::lookAt(eye * spacing, focus * spacing + glm::dvec3(1e-9), up) *
    glm::scale(glm::dmat4(1.0), spacing);
  return view;
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

/// One of the images of a perspective view.
inline splatting::ShearWarp randomPerspectiveImage(
  const std::array<int, 3>& size, reference::Random& random)
{
  std::vector<splatting::ShearWarp> images;
  while (images.empty())
  {
    const splatting::View view = randomPerspective(size, random);
    splatting::ShearWarp::factorise(view, images);
  }
  return images[random.uniform(0, static_cast<int>(images.size()) - 1)];
}

/// Shears at which rays meet edges and corners: no shear, diagonals, simple fractions.
inline double specialShear(reference::Random& random)
{
  static const double shears[] = { 0.0, 1.0, 0.5, 0.25, 0.75, 1.0 / 3.0, 0x1p-24, 1.0 - 0x1p-24 };
  const double shear = shears[random.uniform(0, 7)];
  return random.uniform(0, 1) ? shear : -shear;
}

/// Half of the views are random, half have special shears.
inline splatting::View anyView(const std::array<int, 3>& size, reference::Random& random)
{
  if (random.uniform(0, 1))
  {
    return randomView(size, random);
  }
  const int axis = random.uniform(0, 2);
  const double shearX = specialShear(random), shearY = specialShear(random);
  return viewWithShear(size, axis, shearX, shearY);
}

inline std::array<int, 3> randomSize(reference::Random& random, int largest)
{
  return { random.uniform(1, largest), random.uniform(1, largest), random.uniform(1, largest) };
}

/// Noise over the whole range of a type; [-1, 1] for floating point.
template <class T>
reference::Volume<T> wholeRangeNoise(const std::array<int, 3>& size, std::uint64_t seed)
{
  using Limits = std::numeric_limits<T>;
  return reference::uniformNoise<T>(size, seed, Limits::is_integer ? Limits::lowest() : T(-1),
    Limits::is_integer ? Limits::max() : T(1));
}

template <class T>
reference::Volume<T> wholeRangeNoise(const std::array<int, 3>& size, reference::Random& random)
{
  return wholeRangeNoise<T>(size, random.bits());
}

/// Noise; of floating point one volume in three has NaN and infinities, some of them mostly NaN.
template <class T>
reference::Volume<T> volumeWithOddValues(const std::array<int, 3>& size, reference::Random& random)
{
  reference::Volume<T> volume = wholeRangeNoise<T>(size, random);
  if constexpr (std::numeric_limits<T>::has_infinity)
  {
    const int share = random.uniform(0, 2) == 0 ? random.uniform(1, 9) : 0;
    for (T& voxel : volume.voxels)
    {
      if (random.uniform(0, 9) < share)
      {
        const T odd[] = { std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::quiet_NaN(),
          std::numeric_limits<T>::infinity(), -std::numeric_limits<T>::infinity() };
        voxel = odd[random.uniform(0, 3)];
      }
    }
  }
  return volume;
}

inline reference::ShearView referenceView(const splatting::ShearWarp& geometry)
{
  return { geometry.principalAxis(), { geometry.shear().x, geometry.shear().y } };
}

/// The rays of a perspective image.
inline reference::PerspectiveRays referenceRays(const splatting::ShearWarp& geometry)
{
  reference::PerspectiveRays rays;
  rays.axes = geometry.axes();
  rays.size = { geometry.size().x, geometry.size().y, geometry.size().z };
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
  const std::vector<glm::dvec4>& halfSpaces = {}, const splatting::Cropping& cropping = {})
{
  splatting::VolumeIndex index;
  index.reset({ volume.voxels.data(), splatting::scalarTypeOf<T>(), toGlm(volume.size) });
  return project(index, geometry, settings, cutsBy(geometry, halfSpaces, cropping));
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

/// Whether a ray of a perspective image passes the volume, grown by `margin` voxels.
inline bool meets(const splatting::ShearWarp& image, int u, int v, double margin)
{
  double near = image.faces(image.slices().begin).x, far = image.faces(image.slices().end - 1).y;
  for (int a = 0; a < 2; ++a)
  {
    const splatting::AxisRays& rays = a == 0 ? image.columns() : image.rows();
    const int n = a == 0 ? u : v;
    const double low = -0.5 - margin - rays.at[n];
    const double high = image.size()[a] - 0.5 + margin - rays.at[n];
    const double first = low / rays.slope[n], second = high / rays.slope[n];
    near = std::max(near, image.reference() + std::min(first, second));
    far = std::min(far, image.reference() + std::max(first, second));
  }
  return near <= far;
}

/// More than a few roundings of rays.
constexpr double GrazeWidth = 1e-5;

/// Takes the pixels off an image that it may count to the volume although their rays pass beside an
/// edge of it, see ShearImage::spans.
template <class T, class IsHit>
void forgetGrazes(const splatting::ShearWarp& image, IsHit&& isHit, reference::Image<T>& found)
{
  for (int v = 0; image.isPerspective() && v < image.rayCount().y; ++v)
  {
    for (int u = 1; u + 1 < image.rayCount().x; ++u)
    {
      if (found.isHit(u, v) && !isHit(u, v) && found.isHit(u - 1, v) &&
        meets(image, u, v, GrazeWidth))
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

inline splatting::ProjectionSettings settingsOf(const Mode& mode)
{
  splatting::ProjectionSettings settings;
  settings.quality = mode.quality;
  settings.kernel = mode.kernel;
  return settings;
}
}

#endif
