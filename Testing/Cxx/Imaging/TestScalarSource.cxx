// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The volumes that are projected against the arrays that they come from, voxel by voxel, and when
// they are made anew.
#include "Input/Blanking.h"
#include "Input/ScalarSource.h"
#include "ProjectionTesting.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkFloatArray.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkShortArray.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
using reference::Checks;
using namespace splatting;

template <class Array>
vtkSmartPointer<vtkDataArray> anyArray(int components, vtkIdType count, reference::Random& random)
{
  auto array = vtkSmartPointer<Array>::New();
  array->SetName("scalars");
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(count);
  reference::Random many = random.fork();
  for (vtkIdType n = 0; n < count; ++n)
  {
    for (int c = 0; c < components; ++c)
    {
      const int value = many.uniform(1, 250);
      array->SetComponent(n, c, value);
    }
  }
  return array;
}

struct Scene
{
  vtkNew<vtkImageData> image;
  vtkSmartPointer<vtkDataArray> scalars;
  vtkNew<vtkUnsignedCharArray> ghosts;
  ScalarChoice choice;
  bool cells;

  explicit Scene(reference::Random& random) : cells(random.uniform(0, 1))
  {
    const auto size = coretesting::randomSize(random, 5);
    this->image->SetDimensions(size[0] + 1, size[1] + 1, size[2] + 1);
    vtkDataSetAttributes* const attributes = this->cells
      ? static_cast<vtkDataSetAttributes*>(this->image->GetCellData())
      : this->image->GetPointData();
    const vtkIdType count =
      this->cells ? this->image->GetNumberOfCells() : this->image->GetNumberOfPoints();
    const int components = random.uniform(1, 4), kind = random.uniform(0, 3);
    this->scalars = kind == 0 ? anyArray<vtkShortArray>(components, count, random)
      : kind == 1             ? anyArray<vtkUnsignedCharArray>(components, count, random)
      : kind == 2             ? anyArray<vtkFloatArray>(components, count, random)
                              : anyArray<vtkSOADataArrayTemplate<short>>(components, count, random);
    attributes->SetScalars(this->scalars);
    if (random.oneIn(2))
    {
      this->ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
      for (vtkIdType n = 0; n < count; ++n)
      {
        const bool isHidden = random.oneIn(4);
        const unsigned char flag =
          static_cast<unsigned char>(this->cells ? int(vtkDataSetAttributes::HIDDENCELL)
                                                 : int(vtkDataSetAttributes::HIDDENPOINT));
        this->ghosts->InsertNextValue(isHidden ? flag : 0);
      }
      attributes->AddArray(this->ghosts);
    }
    this->choice.vectorMode = random.uniform(-1, 1);
    this->choice.vectorComponent = random.uniform(0, components - 1);
  }

  bool isMagnitude() const
  {
    return this->choice.vectorMode == ScalarChoice::Magnitude &&
      this->scalars->GetNumberOfComponents() > 1;
  }
  int components() const
  {
    return this->choice.vectorMode == ScalarChoice::Disabled
      ? this->scalars->GetNumberOfComponents()
      : 1;
  }
  /// NaN where it is hidden.
  double voxel(vtkIdType n, int c) const
  {
    if (this->ghosts->GetNumberOfValues() > 0 && this->ghosts->GetValue(n))
    {
      return std::nan("");
    }
    if (this->choice.vectorMode == ScalarChoice::Component)
    {
      return this->scalars->GetComponent(n, this->choice.vectorComponent);
    }
    double sum = 0.0;
    for (int m = 0; m < this->scalars->GetNumberOfComponents(); ++m)
    {
      sum += std::pow(this->scalars->GetComponent(n, m), 2);
    }
    return this->isMagnitude() ? std::sqrt(sum) : this->scalars->GetComponent(n, c);
  }
};

double valueOf(const splatting::VoxelArray& volume, vtkIdType n)
{
  return splatting::dispatch(volume.type,
    [&](auto* null)
    {
      using T = std::remove_pointer_t<decltype(null)>;
      return static_cast<double>(static_cast<const T*>(volume.voxels)[n]);
    });
}

void testVolumes(Checks& check, const Scene& scene, const ScalarSource& source)
{
  check(source.Components() == scene.components() && source.Scalars() == scene.scalars.Get() &&
      !source.AreDependent() && source.Grid().cells == scene.cells,
    "other components or another array are projected");
  for (int c = 0; c < source.Components(); ++c)
  {
    const splatting::VoxelArray& volume = source.Volume(c);
    const glm::ivec3& size = volume.dimensions;
    check(vtkIdType(size.x) * size.y * size.z == scene.scalars->GetNumberOfTuples(),
      "the volume has another size");
    for (vtkIdType n = 0; n < scene.scalars->GetNumberOfTuples(); ++n)
    {
      const double found = valueOf(volume, n), expected = scene.voxel(n, c);
      check(
        std::isnan(expected) ? std::isnan(found) : std::abs(found - expected) <= 1e-7 * expected,
        "voxel ", n, " of component ", c, " is ", found, ", not ", expected);
    }
  }
}

/// What ray casters get: the same voxels, and the least where there is none.
void testImage(Checks& check, const Scene& scene, ScalarSource& source)
{
  for (int c = 0; c < scene.components(); ++c)
  {
    double least = std::numeric_limits<double>::infinity();
    for (vtkIdType n = 0; n < scene.scalars->GetNumberOfTuples(); ++n)
    {
      const double voxel = scene.voxel(n, c);
      least = std::min(least, std::isnan(voxel) ? least : voxel);
    }
    vtkImageData* const image = source.Image();
    if (!std::isfinite(least))
    {
      check(!image, "there is an image although nothing is to be seen");
      return;
    }
    if (!check(image, "there is no image"))
    {
      return;
    }
    vtkDataArray* const found = image->GetPointData()->GetScalars();
    for (vtkIdType n = 0; n < found->GetNumberOfTuples(); ++n)
    {
      const double voxel = scene.voxel(n, c), expected = std::isnan(voxel) ? least : voxel;
      check(std::abs(found->GetComponent(n, c) - expected) <= 1e-7 * expected, "point ", n,
        " of the image is ", found->GetComponent(n, c), ", not ", expected);
    }
  }
}

void testScene(Checks& check, reference::Random& random)
{
  Scene scene(random);
  ScalarSource source;
  const std::string problem = source.Examine(scene.image, scene.choice);
  if (!check(problem.empty(), problem))
  {
    return;
  }
  source.Update();
  testVolumes(check, scene, source);
  testImage(check, scene, source);
  const vtkIdType version = source.Version();
  source.Examine(scene.image, scene.choice);
  source.Update();
  check(source.Version() == version, "volumes are made anew although nothing has changed");
  const vtkIdType last = scene.scalars->GetNumberOfTuples() - 1;
  scene.scalars->SetComponent(random.uniform<vtkIdType>(0, last), 0, 251.0);
  scene.scalars->Modified();
  source.Examine(scene.image, scene.choice);
  source.Update();
  check(source.Version() != version, "other voxels are not noticed");
  testVolumes(check, scene, source);
  testImage(check, scene, source);
  scene.choice.vectorMode = ScalarChoice::Component;
  scene.choice.vectorComponent = scene.scalars->GetNumberOfComponents();
  check(source.Examine(scene.image, scene.choice).find("VectorComponent") != std::string::npos,
    "a component that is missing is taken");
  scene.scalars->SetNumberOfTuples(last);
  check(source.Examine(scene.image, scene.choice).find("tuples") != std::string::npos,
    "too few scalars are taken");
  check(source.Examine(nullptr, scene.choice).find("no input") != std::string::npos,
    "no input is taken");
}
}

int TestScalarSource(int, char*[])
{
  Checks check;
  reference::forScenes(
    "scalars", 600, [&](int, reference::Random& random) { testScene(check, random); });
  return check.exitCode();
}
