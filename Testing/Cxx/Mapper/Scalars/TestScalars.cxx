// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tests which array is projected, and the colours of its components. TestScalarSource compares all
// arrays and components voxel by voxel.
#include "ScalarTesting.h"

#include "vtkColorTransferFunction.h"
#include "vtkPiecewiseFunction.h"
#include "vtkVolumeProperty.h"

#include <functional>

using namespace scalartesting;

namespace
{
const Size size = { 11, 9, 14 };
constexpr vtkIdType Voxels = 11 * 9 * 14;

//------------------------------------------------------------------------------
struct Choice
{
  const char* name;
  std::function<void(Mapper*)> choose;
  const char* array;
};

/// Point arrays of three types, of which one is active.
void testArrays(stage::Stage& stage, reference::Checks& check)
{
  const auto image = bareImage(size);
  int types[] = { VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_FLOAT };
  const char* const names[] = { "first", "second", "third" };
  for (int n = 0; n < 3; ++n)
  {
    const auto array = noiseArray(types[n], Voxels, 1, 20 + n);
    array->SetName(names[n]);
    image->GetPointData()->AddArray(array);
  }
  image->GetPointData()->SetActiveScalars("second");
  const Choice choices[] = {
    { "default", [](Mapper* m) { m->SetScalarModeToDefault(); }, "second" },
    { "point data", [](Mapper* m) { m->SetScalarModeToUsePointData(); }, "second" },
    { "by name",
      [](Mapper* m)
      {
        m->SetScalarModeToUsePointFieldData();
        m->SelectScalarArray("third");
      },
      "third" },
    { "by number",
      [](Mapper* m)
      {
        m->SetScalarModeToUsePointFieldData();
        m->SelectScalarArray(0);
      },
      "first" },
  };
  // One mapper, so that every choice has to be noticed.
  const auto mapper = stage::splatting(image);
  for (const Choice& choice : choices)
  {
    choice.choose(mapper);
    const auto plain =
      stage::splatting(plainImage(size, image->GetPointData()->GetArray(choice.array)));
    expectSame(stage, plain, mapper, std::string("Array ") + choice.name, check);
    check(mapper->GetIndexMemorySize() == plain->GetIndexMemorySize(), "Array ", choice.name,
      ": no copy.");
  }
}

//------------------------------------------------------------------------------
/// Colours of component c: another hue and another ramp for each; opacity times a weight.
void setColors(vtkVolumeProperty* property, int index, int c, double weight)
{
  const double hues[4][3] = { { 1.0, 0.2, 0.0 }, { 0.0, 1.0, 0.4 }, { 0.1, 0.3, 1.0 },
    { 0.5, 0.5, 0.5 } };
  vtkNew<vtkColorTransferFunction> color;
  color->AddRGBPoint(5.0 * c, 0.0, 0.0, 0.0);
  color->AddRGBPoint(100.0, hues[c][0], hues[c][1], hues[c][2]);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(10.0, 0.25 * weight);
  opacity->AddPoint(60.0 + 10.0 * c, weight);
  property->SetColor(index, color);
  property->SetScalarOpacity(index, opacity);
}

constexpr double Weights[] = { 1.0, 0.5, 0.75, 0.25 };

/// Each component rendered by itself, over black, and added. Both sides round every component to
/// whole bytes; opacity times weight may be rounded to the other side: one byte per component.
void testIndependentComponents(
  int components, vtkDataArray* scalars, int mode, reference::Checks& check)
{
  stage::Stage together(120, 110);
  const auto mapper = stage::splatting(plainImage(size, scalars));
  mapper->SetQualityMode(mode);
  together.show(mapper);
  together.property->IndependentComponentsOn();
  for (int c = 0; c < components; ++c)
  {
    setColors(together.property, c, c, 1.0);
    together.property->SetComponentWeight(c, Weights[c]);
  }
  const std::string name = std::to_string(components) + " independent components, " +
    mapper->GetQualityModeAsString() + ": ";
  for (const stage::Vector& direction : directions())
  {
    together.look(direction, { 0.0, 1.0, 0.1 });
    const stage::Pixels picture = together.pixels();
    std::vector<int> sum(picture.size(), 0);
    for (int c = 0; c < components; ++c)
    {
      stage::Stage alone(120, 110);
      const auto single = stage::splatting(plainImage(size, componentOf(scalars, c)));
      single->SetQualityMode(mode);
      alone.show(single);
      setColors(alone.property, 0, c, components > 1 ? Weights[c] : 1.0);
      alone.look(direction, { 0.0, 1.0, 0.1 });
      const stage::Pixels pixels = alone.pixels();
      std::transform(sum.begin(), sum.end(), pixels.begin(), sum.begin(), std::plus<>());
      if (mode == Mapper::EXACT)
      {
        continue;
      }
      const auto part = plainImage({ mapper->GetShearImage()->GetDimensions()[0],
                                     mapper->GetShearImage()->GetDimensions()[1], 1 },
        componentOf(mapper->GetShearImage()->GetPointData()->GetScalars(), c));
      part->GetPointData()->AddArray(mapper->GetShearImage()->GetPointGhostArray());
      check(sameShearImages(single->GetShearImage(), part), name, "shear image ", c, ".");
    }
    int largest = 0, bright = 0;
    for (std::size_t n = 0; n < sum.size(); ++n)
    {
      largest = std::max(largest, std::abs(std::min(sum[n], 255) - picture[n]));
      bright = std::max(bright, sum[n]);
    }
    check(largest <= components && bright > 100, name,
      "the picture differs from the sum of its components by ", largest,
      " at most, and the brightest sum is ", bright, ".");
  }
  check(
    mode == Mapper::EXACT || mapper->GetShearImage()->GetNumberOfScalarComponents() == components,
    name, "as many in the shear image.");
}

/// A change of one component's functions or weight is no new projection.
void testReuse(reference::Checks& check)
{
  stage::Stage stage(120, 110);
  const auto mapper = stage::splatting(plainImage(size, noiseArray(VTK_SHORT, Voxels, 2, 3)));
  stage.show(mapper);
  setColors(stage.property, 0, 0, 1.0);
  setColors(stage.property, 1, 1, 1.0);
  stage.look(directions()[0], { 0.0, 1.0, 0.1 });
  const stage::Pixels before = stage.pixels();
  setColors(stage.property, 1, 2, 1.0);
  const stage::Pixels recolored = stage.pixels();
  stage.property->SetComponentWeight(0, 0.0);
  const stage::Pixels weighted = stage.pixels();
  check(before != recolored && recolored != weighted, "Colours of every component count.");
  check(mapper->GetNumberOfProjections() == 1, "Colours of components are no projection.");
}

}

//------------------------------------------------------------------------------
int TestScalars(int, char*[])
{
  reference::Checks check;
  {
    stage::Stage stage(120, 110);
    stage.setGrayRamp(0.0, 110.0);
    testArrays(stage, check);
  }
  for (int components = 1; components <= 4; ++components)
  {
    const auto scalars = noiseArray(VTK_UNSIGNED_SHORT, Voxels, components, 40 + components);
    testIndependentComponents(components, scalars, Mapper::HIGH, check);
    testIndependentComponents(components, scalars, Mapper::EXACT, check);
  }
  testReuse(check);
  return check.exitCode();
}
