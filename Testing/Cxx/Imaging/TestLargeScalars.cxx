// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Scalars near the limits of their type: up to a documented magnitude projections are those of
// scaled-down scalars, above it they are refused.
#include "ProjectionTesting.h"

#include "vtkCamera.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
using reference::Checks;
using Filter = vtkSplattingMIPProjection;

/// The largest magnitude that is projected.
template <class T>
constexpr double mostOf = sizeof(T) == 4 ? 1e37 : 1e303;
/// The same in exact mode beside infinities.
template <class T>
constexpr double mostBesideInfinity = sizeof(T) == 4 ? 1e18 : 1e150;

template <class T>
vtkSmartPointer<vtkImageData> imageWith(int components, T value)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(7, 6, 5);
  image->AllocateScalars(vtkTypeTraits<T>::VTK_TYPE_ID, components);
  T* const scalars = static_cast<T*>(image->GetScalarPointer());
  std::fill_n(scalars, 7 * 6 * 5 * components, T(1));
  std::fill_n(scalars + 100 * components, components, value);
  return image;
}

template <class T>
std::vector<T> scalarsOf(vtkImageData* image)
{
  const T* const first = static_cast<const T*>(image->GetScalarPointer());
  return { first, first + image->GetNumberOfPoints() };
}

/// Powers of two change no digit of a result, unless something overflows.
template <class T>
void testScaling(Checks& check)
{
  reference::forScenes(sizeof(T) == 4 ? "large, float" : "large, double", 48,
    [&](int n, reference::Random& random)
    {
      const int mode = n % 4;
      const T scale = static_cast<T>(std::ldexp(1.0, std::ilogb(mostOf<T>)));
      auto volume = reference::uniformNoise<T>({ 13, 12, 14 }, random, T(-1), T(1));
      const auto small = projectiontesting::imageOf(volume);
      std::transform(volume.voxels.begin(), volume.voxels.end(), volume.voxels.begin(),
        [=](T voxel) { return voxel * scale; });
      const auto large = projectiontesting::imageOf(volume);
      const auto filter = projectiontesting::projectionOf(small);
      filter->SetQualityMode(mode);
      const int reduction = random.uniform(0, 4);
      filter->SetBlendMode(reduction == 1 ? int(Filter::MINIMUM_INTENSITY_BLEND)
          : reduction == 2                ? int(Filter::AVERAGE_INTENSITY_BLEND)
                                          : int(Filter::MAXIMUM_INTENSITY_BLEND));
      filter->SetMaximumType(reduction == 3 ? int(Filter::DEPTH_SHADED)
          : reduction == 4                  ? int(Filter::LOCAL)
                                            : int(Filter::GLOBAL));
      filter->SetLocalMaximumThreshold(0.0);
      filter->SetAverageIPScalarRange(-mostOf<T>, mostOf<T>);
      filter->SetOutputSize(40, 36);
      vtkNew<vtkCamera> camera;
      camera->SetFocalPoint(6.0, 5.5, 6.5);
      const glm::dvec3 direction = coretesting::anyDirection(random);
      camera->SetPosition(
        6.0 + 30.0 * direction.x, 5.5 + 30.0 * direction.y, 6.5 + 30.0 * direction.z);
      camera->SetViewUp(direction.y, direction.z, direction.x);
      camera->SetParallelProjection(random.uniform(0, 1));
      camera->SetParallelScale(!random.oneIn(4) ? 11.0 : 50.0);
      filter->SetCamera(camera);
      filter->Update();
      const std::vector<T> expected = scalarsOf<T>(filter->GetOutput());
      filter->SetInputData(large);
      filter->Update();
      const std::vector<T> found = scalarsOf<T>(filter->GetOutput());
      check(std::any_of(expected.begin(), expected.end(), [](T value) { return value != T(0); }),
        "the picture is empty");
      check(std::equal(expected.begin(), expected.end(), found.begin(), found.end(),
              [=](T a, T b) { return a * scale == b; }),
        "large scalars have another picture, mode ", mode, ", reduction ", reduction);
    });
}

template <class T>
void testRefusal(Checks& check, vtkImageData* image, const std::string& what)
{
  for (int mode = 0; mode < 4; ++mode)
  {
    const auto filter = projectiontesting::projectionOf(image);
    filter->SetQualityMode(mode);
    filter->SetVectorModeToMagnitude();
    {
      const projectiontesting::Errors errors(filter);
      filter->Update();
      check(errors.texts.size() == 1 &&
          errors.texts.front().find("magnitudes above") != std::string::npos,
        what, ": not one sentence");
      check(filter->GetOutput()->GetNumberOfPoints() == 0, what, ": there is an output");
    }
    filter->SetInputData(imageWith<T>(1, T(2)));
    filter->Update();
    check(filter->GetOutput()->GetNumberOfPoints() > 0, what, ": there is no output afterwards");
  }
}

/// Those of integers fit into double, however many bits they have.
void testIntegers(Checks& check)
{
  for (int mode = 0; mode < 4; ++mode)
  {
    const auto filter = projectiontesting::projectionOf(
      imageWith<unsigned long long>(1, std::numeric_limits<unsigned long long>::max()));
    filter->SetQualityMode(mode);
    const projectiontesting::Errors errors(filter);
    filter->Update();
    check(errors.texts.empty(), "large integers are refused");
  }
}

template <class T>
void testLimits(Checks& check)
{
  const T above = static_cast<T>(1.01 * mostOf<T>);
  const T greatest = std::numeric_limits<T>::max();
  for (const T value : { above, -above, greatest, -greatest })
  {
    testRefusal<T>(check, imageWith(1, value), "a large scalar");
    const auto infinite = imageWith(1, value);
    infinite->SetScalarComponentFromDouble(
      1, 1, 1, 0, std::numeric_limits<double>::infinity() * (value > 0 ? 1.0 : -1.0));
    testRefusal<T>(check, infinite, "a large scalar beside infinity");
    testRefusal<T>(check, imageWith(3, value), "a large vector");
  }
  for (int mode = 0; mode < 4; ++mode)
  {
    for (int n = 0; n < 8; ++n)
    {
      const bool besideInfinity = n >= 4;
      const double share = (n & 1 ? -1.0 : 1.0) * (n & 2 ? 1.01 : 0.99);
      const double most =
        besideInfinity && mode == Filter::EXACT ? mostBesideInfinity<T> : mostOf<T>;
      const auto image = imageWith(1, static_cast<T>(share * most));
      if (besideInfinity)
      {
        image->SetScalarComponentFromDouble(1, 1, 1, 0, std::numeric_limits<double>::infinity());
      }
      const auto filter = projectiontesting::projectionOf(image);
      filter->SetQualityMode(mode);
      const projectiontesting::Errors errors(filter);
      filter->Update();
      check(errors.texts.empty() == (std::abs(share) < 1.0), "a scalar of ", share,
        " times the limit of mode ", mode, " gives ", errors.texts.size(), " errors");
    }
  }
  // The squares of both overflow, or are lost, in double.
  const T power = sizeof(T) == 4 ? T(1e30) : T(1e300);
  for (const T length : { power, T(1) / power })
  {
    const auto filter = projectiontesting::projectionOf(imageWith(1, T(0)));
    const auto vectors = imageWith(2, T(0));
    T* const scalars = static_cast<T*>(vectors->GetScalarPointer());
    for (int n = 0; n < 7 * 6 * 5; ++n)
    {
      scalars[2 * n] = T(3) * length;
      scalars[2 * n + 1] = T(-4) * length;
    }
    filter->SetInputData(vectors);
    filter->SetVectorModeToMagnitude();
    filter->SetQualityModeToPreview();
    filter->Update();
    const std::vector<T> found = scalarsOf<T>(filter->GetOutput());
    const T largest = *std::max_element(found.begin(), found.end());
    check(
      std::abs(largest / length - T(5)) < T(1e-5), "a vector of length 5 has ", largest / length);
  }
}
}

int TestLargeScalars(int, char*[])
{
  Checks check;
  testScaling<float>(check);
  testScaling<double>(check);
  testLimits<float>(check);
  testLimits<double>(check);
  testIntegers(check);
  return check.exitCode();
}
