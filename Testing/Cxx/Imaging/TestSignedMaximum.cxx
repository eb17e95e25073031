// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Signed maxima of vtkSplattingMIPProjection against its maxima and minima: each pixel has the bits
// of the one that is farther from the origin, and its location. If both are equally far, it has the
// maximum. In all quality modes and in overviews, from all sides, with cuts, holes and infinities.
#include "ProjectionTesting.h"
#include "Volume.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkUnsignedCharArray.h"

#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <string>
#include <type_traits>

namespace
{
using reference::Checks;
using Filter = vtkSplattingMIPProjection;

/// Pixels of the views that have been compared.
struct Count
{
  long maxima = 0, minima = 0, ties = 0, infinite = 0;

  bool areAll() const { return this->maxima && this->minima && this->ties && this->infinite; }
};

/// What a filter projects: the picture, and the shear image (nullptr in exact mode).
struct Projection
{
  vtkNew<vtkImageData> picture, shear;
};

void project(Filter* filter, int blendMode, int maximumType, Projection& result)
{
  filter->SetBlendMode(blendMode);
  filter->SetMaximumType(maximumType);
  filter->Update();
  result.picture->DeepCopy(filter->GetOutput());
  if (vtkImageData* const shear = filter->GetShearImage())
  {
    result.shear->DeepCopy(shear);
  }
}

bool sameTuple(vtkDataArray* a, vtkDataArray* b, vtkIdType n)
{
  bool same = true;
  for (int c = 0; c < a->GetNumberOfComponents(); ++c)
  {
    const double x = a->GetComponent(n, c), y = b->GetComponent(n, c);
    same = same && (x == y || (std::isnan(x) && std::isnan(y)));
  }
  return same;
}

/// Compares the pixels of an image with those of the maxima and the minima.
class Comparison
{
public:
  Comparison(vtkImageData* found, vtkImageData* maxima, vtkImageData* minima, double origin)
    : Found(found),
      Maxima(maxima),
      Minima(minima),
      Origin(origin)
  {
  }

  void compare(const std::string& what, Checks& check, Count& count) const
  {
    check(this->Found->GetNumberOfPoints() == this->Maxima->GetNumberOfPoints(), what, ": size");
    const int components = this->Found->GetNumberOfScalarComponents();
    for (vtkIdType n = 0; n < this->Found->GetNumberOfPoints(); ++n)
    {
      for (int c = 0; c < components; ++c)
      {
        this->comparePixel(what, n, c, check, count);
      }
    }
  }

private:
  static double valueOf(vtkImageData* image, vtkIdType n, int c)
  {
    return image->GetPointData()->GetScalars()->GetComponent(n, c);
  }

  void comparePixel(const std::string& what, vtkIdType n, int c, Checks& check, Count& count) const
  {
    const double high = valueOf(this->Maxima, n, c), low = valueOf(this->Minima, n, c);
    const double found = valueOf(this->Found, n, c);
    check(std::isnan(high) == std::isnan(low), what, ": pixel ", n, " has one extremum only");
    if (std::isnan(high))
    {
      check(std::isnan(found), what, ": pixel ", n, " is ", found, ", but has no sample");
      return;
    }
    const double above = std::abs(high - this->Origin), below = std::abs(low - this->Origin);
    const bool isMinimum = below > above;
    check(found == (isMinimum ? low : high), what, ": pixel ", n, " is ", found, ", with extrema ",
      low, " and ", high, ", origin ", this->Origin);
    ++(isMinimum ? count.minima : count.maxima);
    count.ties += above == below && high != low;
    count.infinite += std::isinf(found);
    this->compareLocations(what, n, isMinimum || high == low, !isMinimum, check);
  }

  /// Locations are those of the first component. Of equal extrema either will do.
  void compareLocations(
    const std::string& what, vtkIdType n, bool minimum, bool maximum, Checks& check) const
  {
    for (const char* const name : { "Voxel", "Depth", "Position" })
    {
      vtkDataArray* const array = this->Found->GetPointData()->GetArray(name);
      if (array && this->Found->GetNumberOfScalarComponents() == 1)
      {
        const bool isOfMinimum = sameTuple(array, this->Minima->GetPointData()->GetArray(name), n);
        const bool isOfMaximum = sameTuple(array, this->Maxima->GetPointData()->GetArray(name), n);
        check((minimum && isOfMinimum) || (maximum && isOfMaximum), what, ": the ", name,
          " of pixel ", n, " is that of the other extremum");
      }
    }
  }

  vtkImageData* Found;
  vtkImageData* Maxima;
  vtkImageData* Minima;
  double Origin;
};

/// Noise of few values about 0, so that extrema are often equally far from it; or of all values.
template <class T>
reference::Volume<T> anyVolume(
  const std::array<int, 3>& size, bool isOdd, reference::Random& random)
{
  if constexpr (!std::is_integral_v<T>)
  {
    if (isOdd)
    {
      return coretesting::volumeWithOddValues<T>(size, random);
    }
  }
  if (random.oneIn(2))
  {
    return reference::uniformNoise<T>(size, random);
  }
  const T low = std::is_signed_v<T> ? T(-5) : T(0);
  return reference::uniformNoise<T>(size, random, low, T(low + 10));
}

/// An origin between the least and the largest finite voxel.
template <class T>
double originOf(const reference::Volume<T>& volume, reference::Random& random)
{
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const T voxel : volume.voxels)
  {
    const double value = static_cast<double>(voxel);
    low = std::isfinite(value) ? std::min(low, value) : low;
    high = std::isfinite(value) ? std::max(high, value) : high;
  }
  return low <= high
    ? 0.5 * low + 0.5 * high + random.uniform(0, 1) * 0.1 * (0.5 * high - 0.5 * low)
    : 0.0;
}

/// A view from anywhere, parallel or in perspective, magnified or an overview.
void lookAtRandom(Filter* filter, vtkImageData* image, reference::Random& random)
{
  const glm::dvec3 direction = coretesting::anyDirection(random);
  const glm::dvec3 up = coretesting::anyDirection(random);
  const double* const spacing = image->GetSpacing();
  const double least = std::min({ spacing[0], spacing[1], spacing[2] });
  const double pixel = least * (!random.oneIn(3) ? random.uniform(0.3, 1.0) : 2.5);
  const int size[2] = { random.uniform(16, 32), random.uniform(16, 32) };
  filter->SetOutputSize(size[0], size[1]);
  filter->SetOutputSpacing(pixel, pixel);
  if (!random.oneIn(3))
  {
    filter->SetViewDirection(direction.x, direction.y, direction.z);
    filter->SetViewUp(up.x, up.y, up.z);
    return;
  }
  const double* const center = image->GetCenter();
  const double distance = image->GetLength() * random.uniform(0.6, 2.0);
  vtkNew<vtkCamera> camera;
  camera->SetFocalPoint(center);
  camera->SetPosition(center[0] - distance * direction.x, center[1] - distance * direction.y,
    center[2] - distance * direction.z);
  camera->SetViewUp(up.x, up.y, up.z);
  filter->SetCamera(camera);
}

void chooseAtRandom(Filter* filter, vtkImageData* image, int mode, reference::Random& random)
{
  filter->SetQualityMode(mode);
  filter->SetKernel(random.uniform(0, 1));
  filter->SetAcceleration(random.uniform<int>(Filter::AUTO, Filter::SORTED_VOLUME));
  filter->SetRecordLocations(random.uniform(0, 1));
  filter->SetBackgroundValue(NAN);
  filter->SetSlab(random.oneIn(4));
  filter->SetSlabThickness(0.3 * image->GetLength());
  filter->SetSlabCenter(image->GetCenter());
  filter->SetCropping(random.oneIn(4));
  const double* const b = image->GetBounds();
  filter->SetCroppingRegionPlanes(0.7 * b[0] + 0.3 * b[1], 0.2 * b[0] + 0.8 * b[1],
    0.6 * b[2] + 0.4 * b[3], 0.3 * b[2] + 0.7 * b[3], 0.6 * b[4] + 0.4 * b[5],
    0.3 * b[4] + 0.7 * b[5]);
  filter->SetCroppingRegionFlags(random.uniform(1, 0x7ffffff));
}

template <class T>
void testType(Checks& check, Count& count)
{
  const std::string type = vtkTypeTraits<T>::SizedName();
  reference::forScenes(type, 48,
    [&](int n, reference::Random& random)
    {
      const auto volume =
        anyVolume<T>(coretesting::randomSize(random, 14), !random.oneIn(2), random);
      const auto image = projectiontesting::imageOf(volume);
      coretesting::placeAtRandom(image, random, true);
      const auto filter = projectiontesting::projectionOf(image);
      lookAtRandom(filter, image, random);
      chooseAtRandom(filter, image, n % 4, random);
      const double origin = originOf(volume, random);
      Projection maxima, minima, found;
      project(filter, Filter::MAXIMUM_INTENSITY_BLEND, Filter::GLOBAL, maxima);
      project(filter, Filter::MINIMUM_INTENSITY_BLEND, Filter::SIGNED, minima);
      filter->SetSignedOrigin(origin);
      project(filter, Filter::MAXIMUM_INTENSITY_BLEND, Filter::SIGNED, found);
      const std::string what = type + ", mode " + std::to_string(n % 4);
      Comparison(found.picture, maxima.picture, minima.picture, origin).compare(what, check, count);
      Count ofShear;
      if (!found.shear->GetPointGhostArray() || !found.shear->GetPointGhostArray()->GetSize())
      {
        return;
      }
      // Hidden points of shear images have undefined scalars.
      Projection* const all[] = { &maxima, &minima, &found };
      for (vtkIdType p = 0; p < found.shear->GetNumberOfPoints(); ++p)
      {
        for (Projection* const projection : all)
        {
          if (projection->shear->GetPointGhostArray()->GetValue(p))
          {
            projection->shear->GetPointData()->GetScalars()->SetComponent(p, 0, 0.0);
          }
        }
      }
      Comparison(found.shear, maxima.shear, minima.shear, origin)
        .compare(what + ", shear image", check, ofShear);
    });
}

/// Each component by itself, and another origin projects again.
void testComponents(Checks& check)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(9, 10, 11);
  image->AllocateScalars(VTK_SHORT, 2);
  reference::Random random(7);
  auto* const voxels = static_cast<short*>(image->GetScalarPointer());
  for (vtkIdType n = 0; n < 2 * image->GetNumberOfPoints(); ++n)
  {
    voxels[n] = static_cast<short>(random.uniform(-100, 100));
  }
  const auto filter = projectiontesting::projectionOf(image);
  filter->SetOutputSize(20, 20);
  filter->SetOutputSpacing(0.5, 0.5);
  filter->SetBackgroundValue(NAN);
  Count count;
  Projection maxima, minima, found;
  project(filter, Filter::MAXIMUM_INTENSITY_BLEND, Filter::GLOBAL, maxima);
  project(filter, Filter::MINIMUM_INTENSITY_BLEND, Filter::GLOBAL, minima);
  for (const double origin : { 0.0, 10.0, -10.0 })
  {
    filter->SetSignedOrigin(origin);
    project(filter, Filter::MAXIMUM_INTENSITY_BLEND, Filter::SIGNED, found);
    Comparison(found.picture, maxima.picture, minima.picture, origin)
      .compare("two components", check, count);
  }
  check(count.maxima > 0 && count.minima > 0, "one extremum only");
}
}

int TestSignedMaximum(int, char*[])
{
  Checks check;
  Count count;
  coretesting::forEachType(
    [&](auto* null) { testType<std::remove_pointer_t<decltype(null)>>(check, count); });
  testComponents(check);
  std::cout << count.maxima << " maxima, " << count.minima << " minima, " << count.ties
            << " pixels whose extrema are equally far, " << count.infinite << " infinite\n";
  check(reference::scenesRun() < 80 || count.areAll(), "not all cases have occurred");
  return check.exitCode();
}
