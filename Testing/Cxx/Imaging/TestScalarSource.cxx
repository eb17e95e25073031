// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Compares the volumes that are projected with the input arrays, voxel by voxel: all types, layouts
// and scalar modes, hidden voxels, images and rectilinear grids. Tests when volumes are updated,
// and the memory of copies.
#include "Input/ScalarSource.h"
#include "ProjectionTesting.h"

#include "vtkAbstractMapper.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkRectilinearGrid.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace
{
using reference::Checks;
using namespace splatting;

enum class Layout
{
  Interleaved,
  Separate,
  AllocatedByVTK ///< VTK 9.3 to 9.6 interleave separate components
};

template <class T>
vtkSmartPointer<vtkDataArray> separateArray(int components, vtkIdType count, Layout layout)
{
  auto array = vtkSmartPointer<vtkSOADataArrayTemplate<T>>::New();
  array->SetNumberOfComponents(components);
  for (int c = 0; c < components && layout == Layout::Separate; ++c)
  {
    array->SetArray(c, new T[count], count, true, false, vtkAbstractArray::VTK_DATA_ARRAY_DELETE);
  }
  return array;
}

/// A random type, with values that all types can represent.
vtkSmartPointer<vtkDataArray> anyArray(
  const char* name, int components, vtkIdType count, Layout layout, reference::Random& random)
{
  constexpr int types[] = { VTK_UNSIGNED_CHAR, VTK_CHAR, VTK_SIGNED_CHAR, VTK_SHORT,
    VTK_UNSIGNED_SHORT, VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG, VTK_LONG_LONG,
    VTK_UNSIGNED_LONG_LONG, VTK_FLOAT, VTK_DOUBLE };
  const int type = random.uniform<int>(0, std::size(types) - 1);
  auto array = layout == Layout::Interleaved
    ? vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(types[type]))
    : type % 2 ? separateArray<short>(components, count, layout)
               : separateArray<double>(components, count, layout);
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(count);
  reference::Random many = random.fork();
  for (vtkIdType n = 0; n < count; ++n)
  {
    for (int c = 0; c < components; ++c)
    {
      const int value = many.uniform(1, 120);
      array->SetComponent(n, c, value);
    }
  }
  return array;
}

vtkIdType count(const glm::ivec3& size)
{
  return vtkIdType(size.x) * size.y * size.z;
}

/// An image, or a rectilinear grid with equal or unequal steps.
struct Scene
{
  glm::ivec3 voxels;
  bool cells, isGrid;
  vtkSmartPointer<vtkDataSet> data;
  vtkNew<vtkDoubleArray> places[3]; ///< of points, along each axis
  vtkSmartPointer<vtkDataArray> scalars;
  Layout layout;
  vtkNew<vtkUnsignedCharArray> ghosts, inside;
  vtkNew<vtkImageData> mask;
  ScalarChoice choice;

  explicit Scene(reference::Random& random)
    : voxels(coretesting::toGlm(coretesting::randomSize(random, 5))),
      cells(random.uniform(0, 1)),
      isGrid(random.uniform(0, 1)),
      layout(random.among({ Layout::Interleaved, Layout::Separate, Layout::AllocatedByVTK }))
  {
    this->makeData(random);
    this->chooseArray(random);
    if (random.oneIn(2))
    {
      const int flag = this->cells ? int(vtkDataSetAttributes::HIDDENCELL)
                                   : int(vtkDataSetAttributes::HIDDENPOINT);
      this->ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
      reference::Random many = random.fork();
      for (vtkIdType n = 0; n < count(this->voxels); ++n)
      {
        this->ghosts->InsertNextValue(static_cast<unsigned char>(many.oneIn(4) ? flag : 0));
      }
      this->attributes(this->cells)->AddArray(this->ghosts);
    }
    if (random.oneIn(3))
    {
      this->mask->SetDimensions(&this->voxels.x);
      reference::Random many = random.fork();
      for (vtkIdType n = 0; n < count(this->voxels); ++n)
      {
        this->inside->InsertNextValue(static_cast<unsigned char>(many.oneIn(4) ? 0 : 200));
      }
      this->mask->GetPointData()->SetScalars(this->inside);
      this->choice.mask = this->mask;
    }
    const int components = this->scalars->GetNumberOfComponents();
    this->choice.vectorMode = random.uniform(-1, 1);
    this->choice.vectorComponent = random.uniform(0, components - 1);
    this->choice.independentComponents = components > 2 || random.oneIn(2);
  }

  vtkDataSetAttributes* attributes(bool ofCells) const
  {
    return ofCells ? static_cast<vtkDataSetAttributes*>(this->data->GetCellData())
                   : this->data->GetPointData();
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
  bool isHidden(vtkIdType n) const
  {
    return (this->ghosts->GetNumberOfValues() > 0 && this->ghosts->GetValue(n) != 0) ||
      (this->choice.mask && this->inside->GetValue(n) == 0);
  }
  bool hidesAny() const
  {
    bool any = false;
    for (vtkIdType n = 0; n < count(this->voxels); ++n)
    {
      any = any || this->isHidden(n);
    }
    return any;
  }
  /// NaN where it is hidden.
  double voxel(const glm::ivec3& at, int c) const
  {
    const vtkIdType n = (vtkIdType(at.z) * this->voxels.y + at.y) * this->voxels.x + at.x;
    if (this->isHidden(n))
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

private:
  void makeData(reference::Random& random)
  {
    const glm::ivec3 points = this->voxels + (this->cells ? 1 : 0);
    if (!this->isGrid)
    {
      vtkNew<vtkImageData> image;
      image->SetDimensions(points.x, points.y, points.z);
      this->data = image;
      return;
    }
    vtkNew<vtkRectilinearGrid> grid;
    const bool isEven = random.oneIn(3);
    for (int a = 0; a < 3; ++a)
    {
      const double sign = random.sign();
      double place = random.uniform(-9.0, 9.0);
      for (int n = 0; n < points[a]; ++n)
      {
        this->places[a]->InsertNextValue(place);
        place += sign * (isEven ? 1.0 : random.uniform(1.0, 3.0));
      }
    }
    grid->SetDimensions(points.x, points.y, points.z);
    grid->SetXCoordinates(this->places[0]);
    grid->SetYCoordinates(this->places[1]);
    grid->SetZCoordinates(this->places[2]);
    this->data = grid;
  }

  /// Selects an array by default, as active scalars, by name or by number. There are other arrays.
  void chooseArray(reference::Random& random)
  {
    vtkDataSetAttributes* const own = this->attributes(this->cells);
    const int kind = random.uniform(0, 3);
    const bool isFirst = random.uniform(0, 1);
    this->scalars =
      anyArray("scalars", random.uniform(1, 4), count(this->voxels), this->layout, random);
    const auto other =
      anyArray("others", random.uniform(1, 4), count(this->voxels), this->layout, random);
    own->AddArray(isFirst ? this->scalars : other);
    own->AddArray(isFirst ? other : this->scalars);
    own->SetActiveScalars(kind < 2 ? "scalars" : "others");
    if (kind == 0)
    {
      return;
    }
    const vtkIdType others =
      this->cells ? this->data->GetNumberOfPoints() : this->data->GetNumberOfCells();
    this->attributes(!this->cells)
      ->SetScalars(anyArray("scalars", 1, others, this->layout, random));
    this->choice.scalarMode = kind == 1
      ? (this->cells ? VTK_SCALAR_MODE_USE_CELL_DATA : VTK_SCALAR_MODE_USE_POINT_DATA)
      : (this->cells ? VTK_SCALAR_MODE_USE_CELL_FIELD_DATA : VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
    this->choice.arrayAccessMode = kind == 2 ? VTK_GET_ARRAY_BY_NAME : VTK_GET_ARRAY_BY_ID;
    this->choice.arrayName = "scalars";
    this->choice.arrayId = isFirst ? 0 : 1;
  }
};

/// The points or the cell around a voxel of a resampled grid, along one axis.
struct Between
{
  int below = 0;
  double share = 0.0;

  Between(const Scene& scene, const VolumeGrid& grid, int a, int n)
  {
    vtkDoubleArray* const places = scene.places[a];
    const double at = grid.first[a] + n * grid.spacing[a];
    const auto shareOf = [&](int point)
    {
      const double from = places->GetValue(point);
      return (at - from) / (places->GetValue(point + 1) - from);
    };
    while (this->below + 2 < places->GetNumberOfValues() && shareOf(this->below) > 1.0)
    {
      ++this->below;
    }
    this->share = places->GetNumberOfValues() > 1 ? shareOf(this->below) : 0.0;
  }
};

struct Expected
{
  double value;
  bool isCertain = true;
};

/// Interpolates points trilinearly. Points with NaN are left out; NaN if the nearest one is NaN.
Expected interpolated(const Scene& scene, const Between (&axes)[3], int c)
{
  double sum = 0.0, weight = 0.0, best = 0.0, second = 0.0, nearest = std::nan("");
  bool isComplete = true;
  for (int corner = 0; corner < 8; ++corner)
  {
    glm::ivec3 at;
    double w = 1.0;
    for (int a = 0; a < 3; ++a)
    {
      const int step = corner >> a & 1;
      at[a] = axes[a].below + step;
      w *= step ? axes[a].share : 1.0 - axes[a].share;
    }
    if (w < 1e-12)
    {
      continue;
    }
    const double value = scene.voxel(at, c);
    second = std::max(second, std::min(w, best));
    nearest = w > best ? value : nearest;
    best = std::max(best, w);
    isComplete = isComplete && !std::isnan(value);
    sum += std::isnan(value) ? 0.0 : w * value;
    weight += std::isnan(value) ? 0.0 : w;
  }
  return { std::isnan(nearest) ? nearest : sum / weight, isComplete || best - second > 1e-9 };
}

Expected expectedAt(const Scene& scene, const ScalarSource& source, const glm::ivec3& at, int c)
{
  if (source.Grid().dimensions == scene.voxels)
  {
    return { scene.voxel(at, c) };
  }
  const Between axes[3] = { { scene, source.Grid(), 0, at.x }, { scene, source.Grid(), 1, at.y },
    { scene, source.Grid(), 2, at.z } };
  if (!scene.cells)
  {
    return interpolated(scene, axes, c);
  }
  const glm::ivec3 cell(axes[0].below, axes[1].below, axes[2].below);
  const bool isCertain = std::all_of(std::begin(axes), std::end(axes),
    [](const Between& axis) { return axis.share > 1e-9 && axis.share < 1.0 - 1e-9; });
  return { scene.voxel(cell, c), isCertain };
}

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
      source.Grid().cells == scene.cells,
    "other components or another array are projected");
  check(source.AreDependent() == (!scene.choice.independentComponents && scene.components() > 1),
    "components depend on each other, or do not");
  const glm::ivec3& size = source.Grid().dimensions;
  for (int c = 0; c < source.Components(); ++c)
  {
    const splatting::VoxelArray& volume = source.Volume(c);
    check(volume.dimensions == size, "the volume has another size");
    for (vtkIdType n = 0; n < count(size); ++n)
    {
      const glm::ivec3 at(n % size.x, n / size.x % size.y, n / size.x / size.y);
      const Expected expected = expectedAt(scene, source, at, c);
      const double found = valueOf(volume, n);
      check(!expected.isCertain ||
          (std::isnan(expected.value) ? std::isnan(found)
                                      : std::abs(found - expected.value) <= 1e-6 * expected.value),
        "voxel ", n, " of component ", c, " is ", found, ", not ", expected.value);
    }
  }
}

/// The memory of copied components. Averages are float, or double for types of four bytes or more.
void testMemory(Checks& check, const Scene& scene, const ScalarSource& source)
{
  vtkDataArray* const scalars = scene.scalars;
  const int size = scalars->GetDataTypeSize();
  const int average = size > 2 && scalars->GetDataType() != VTK_FLOAT ? 8 : 4;
  const bool isResampled = source.Grid().dimensions != scene.voxels;
  const bool isAverage = scene.hidesAny() || scene.isMagnitude() || (isResampled && !scene.cells);
  const bool isGathered = scalars->GetNumberOfComponents() > 1 && scene.layout != Layout::Separate;
  const vtkIdType bytes = scene.components() * count(source.Grid().dimensions) *
    (isAverage                      ? average
        : isResampled || isGathered ? size
                                    : 0);
  const auto found = static_cast<vtkIdType>(source.MemorySize());
  check(scene.layout == Layout::AllocatedByVTK ? found <= bytes : found == bytes, "copies take ",
    found, " bytes, not ", bytes);
}

/// What ray casters get: the same voxels, and the least where there is none.
void testImage(Checks& check, const Scene& scene, ScalarSource& source)
{
  vtkImageData* const image = source.Image();
  for (int c = 0; c < scene.components(); ++c)
  {
    const splatting::VoxelArray& volume = source.Volume(c);
    double least = std::numeric_limits<double>::infinity();
    for (vtkIdType n = 0; n < count(volume.dimensions); ++n)
    {
      const double voxel = valueOf(volume, n);
      least = std::min(least, std::isnan(voxel) ? least : voxel);
    }
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
    check(found->HasStandardMemoryLayout(), "ray casters get separate components");
    for (vtkIdType n = 0; n < found->GetNumberOfTuples(); ++n)
    {
      const double voxel = valueOf(volume, n), expected = std::isnan(voxel) ? least : voxel;
      check(found->GetComponent(n, c) == expected, "point ", n, " of the image is ",
        found->GetComponent(n, c), ", not ", expected);
    }
  }
}

void testAll(Checks& check, const Scene& scene, ScalarSource& source)
{
  const std::string problem = source.Examine(scene.data, scene.choice);
  if (check(problem.empty(), problem))
  {
    source.Update();
    testVolumes(check, scene, source);
    if (!source.HasImage()) // an image may have a copy
    {
      testMemory(check, scene, source);
    }
    testImage(check, scene, source);
  }
}

/// Settings without effect do not update volumes.
void testIdle(Checks& check, const Scene& scene, ScalarSource& source)
{
  const vtkIdType version = source.Version();
  const bool isSingle = scene.scalars->GetNumberOfComponents() == 1;
  ScalarChoice idle = scene.choice;
  const auto isSame = [&]
  {
    source.Examine(scene.data, idle);
    source.Update();
    return source.Version() == version;
  };
  check(isSame(), "volumes are made anew although nothing has changed");
  if (isSingle || idle.vectorMode != ScalarChoice::Disabled)
  {
    idle.independentComponents = !idle.independentComponents;
    check(isSame(), "what one component depends on is not idle");
  }
  if (idle.vectorMode != ScalarChoice::Component)
  {
    idle.vectorComponent = 3;
    check(isSame(), "a component that is not taken is not idle");
  }
  idle.vectorComponent = 0;
  for (int mode = ScalarChoice::Disabled; isSingle && mode <= ScalarChoice::Component; ++mode)
  {
    idle.vectorMode = mode;
    check(isSame(), "one component is not its own magnitude");
  }
}

/// Arrays that are modified in place update volumes.
void testChanges(Checks& check, Scene& scene, ScalarSource& source, reference::Random& random)
{
  const auto test = [&](const std::string& what)
  {
    const vtkIdType version = source.Version();
    testAll(check, scene, source);
    check(source.Version() != version, what, " are not noticed");
  };
  const vtkIdType last = scene.scalars->GetNumberOfTuples() - 1;
  scene.scalars->SetComponent(random.uniform<vtkIdType>(0, last), 0, 125.0);
  scene.scalars->Modified();
  test("other voxels");
  if (scene.choice.mask)
  {
    scene.inside->SetValue(random.uniform<vtkIdType>(0, last), 0);
    scene.inside->Modified();
    test("other voxels of the mask");
  }
  const vtkIdType end = scene.places[0]->GetNumberOfValues() - 1;
  if (end > 0)
  {
    const double from = scene.places[0]->GetValue(end - 1), to = scene.places[0]->GetValue(end);
    scene.places[0]->SetValue(end, to + 0.5 * (to - from));
    scene.places[0]->Modified();
    test("other coordinates");
  }
  if (scene.layout != Layout::Interleaved)
  {
    scene.layout = Layout::AllocatedByVTK;
    vtkObject::GlobalWarningDisplayOff(); // VTK warns that it copies
    scene.scalars->GetVoidPointer(0);     // VTK 9.3 to 9.6 interleave components
    vtkObject::GlobalWarningDisplayOn();
    testAll(check, scene, source);
  }
}

void testScene(Checks& check, reference::Random& random)
{
  Scene scene(random);
  ScalarSource source;
  testAll(check, scene, source);
  testIdle(check, scene, source);
  testChanges(check, scene, source, random);
  scene.choice.vectorMode = ScalarChoice::Component;
  scene.choice.vectorComponent = scene.scalars->GetNumberOfComponents();
  check(source.Examine(scene.data, scene.choice).find("VectorComponent") != std::string::npos,
    "a component that is missing is taken");
  scene.scalars->SetNumberOfTuples(scene.scalars->GetNumberOfTuples() - 1);
  check(source.Examine(scene.data, scene.choice).find("tuples") != std::string::npos,
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
