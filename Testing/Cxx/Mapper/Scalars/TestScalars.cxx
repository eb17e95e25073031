// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Which array and which of its components are projected: the same numbers as plain point scalars
// give the same picture, bit for bit.
#include "ScalarTesting.h"

#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkFieldData.h"
#include "vtkGPUVolumeRayCastMapper.h"
#include "vtkImageMagnitude.h"
#include "vtkPiecewiseFunction.h"
#include "vtkRenderer.h"
#include "vtkSOADataArrayTemplate.h"
#include "vtkVolumeProperty.h"

#include <cmath>
#include <functional>
#include <iostream>

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
/// Types of each size, so that strides are told apart.
void testComponentsOfTypes(stage::Stage& stage, reference::Checks& check)
{
  for (int type : { VTK_SIGNED_CHAR, VTK_UNSIGNED_SHORT, VTK_INT, VTK_LONG_LONG, VTK_DOUBLE })
  {
    const auto vectors = noiseArray(type, Voxels, 3, 7);
    const auto mapper = stage::splatting(plainImage(size, vectors));
    mapper->SetVectorModeToComponent();
    for (int c : { 1, 2 })
    {
      mapper->SetVectorComponent(c);
      const auto plain = stage::splatting(plainImage(size, componentOf(vectors, c)));
      const std::string name =
        "Component " + std::to_string(c) + " of " + vtkImageScalarTypeNameMacro(type);
      expectSame(stage, plain, mapper, name, check);
      check(mapper->GetIndexMemorySize() ==
          plain->GetIndexMemorySize() + Voxels * vectors->GetDataTypeSize(),
        name, ": one copy, counted.");
    }
  }
}

//------------------------------------------------------------------------------
void testMagnitude(stage::Stage& stage, reference::Checks& check)
{
  for (int type : { VTK_UNSIGNED_CHAR, VTK_FLOAT, VTK_INT })
  {
    const auto vectors = noiseArray(type, Voxels, 3, 8);
    const int lengthType = type == VTK_INT ? VTK_DOUBLE : VTK_FLOAT;
    const auto lengths = componentOf(vectors, 0, lengthType);
    for (vtkIdType n = 0; n < Voxels; ++n)
    {
      const double* const v = vectors->GetTuple3(n);
      lengths->SetComponent(n, 0, std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]));
    }
    const auto mapper = stage::splatting(plainImage(size, vectors));
    mapper->SetVectorModeToMagnitude();
    expectSame(stage, stage::splatting(plainImage(size, lengths)), mapper,
      std::string("Magnitude of ") + vtkImageScalarTypeNameMacro(type), check);
  }
  // One component is what it is, even below zero.
  const auto single = noiseArray(VTK_SHORT, Voxels, 1, 9);
  single->SetComponent(3, 0, -40.0);
  const auto mapper = stage::splatting(plainImage(size, single));
  mapper->SetVectorModeToMagnitude();
  expectSame(
    stage, stage::splatting(plainImage(size, single)), mapper, "Magnitude of a scalar", check);
}

/// VTK's filter sums in float: 3 products, 2 sums, a root, each off by 2^-24 at most. The weights
/// are the same, so the shear images differ by no more than that share, and roundings of the
/// worksheets, for which 2^-20 leaves room.
void testMagnitudeOfVTK(stage::Stage& stage, reference::Checks& check)
{
  const auto image = plainImage(size, noiseArray(VTK_FLOAT, Voxels, 3, 8));
  vtkNew<vtkImageMagnitude> filter;
  filter->SetInputData(image);
  filter->Update();
  const auto mapper = stage::splatting(image);
  mapper->SetVectorModeToMagnitude();
  mapper->SetQualityModeToHigh();
  stage.show(mapper);
  stage.look(directions()[2], { 0.0, 1.0, 0.1 });
  stage.window->Render();
  const auto other = stage::splatting(filter->GetOutput());
  other->SetQualityModeToHigh();
  stage.show(other);
  stage.window->Render();
  vtkDataArray* const a = mapper->GetShearImage()->GetPointData()->GetScalars();
  vtkDataArray* const b = other->GetShearImage()->GetPointData()->GetScalars();
  double largest = 0.0;
  for (vtkIdType n = 0; n < a->GetNumberOfTuples(); ++n)
  {
    const bool hidden = mapper->GetShearImage()->GetPointGhostArray()->GetValue(n) != 0;
    largest =
      std::max(largest, hidden ? 0.0 : std::abs(a->GetComponent(n, 0) - b->GetComponent(n, 0)));
  }
  check(largest <= std::sqrt(3.0) * 100.0 * 0x1p-20, "The magnitude is vtkImageMagnitude's.");
}

//------------------------------------------------------------------------------
/// Components one after the other are splatted from where they are.
void testSeparateComponents(stage::Stage& stage, reference::Checks& check)
{
  const auto vectors = noiseArray(VTK_SHORT, Voxels, 3, 12);
  const auto interleaved = stage::splatting(plainImage(size, vectors));
  const auto separate = stage::splatting(plainImage(size, separated<short>(vectors)));
  expectSame(stage, interleaved, separate, "Separate components", check);
  check(separate->GetIndexMemorySize() ==
      interleaved->GetIndexMemorySize() - 3 * Voxels * vtkIdType(sizeof(short)),
    "Separate components: no copy.");
  separate->SetVectorModeToMagnitude();
  interleaved->SetVectorModeToMagnitude();
  expectSame(stage, interleaved, separate, "Magnitude of separate components", check);
  const auto single = noiseArray(VTK_DOUBLE, Voxels, 1, 13);
  const auto plain = stage::splatting(plainImage(size, single));
  const auto mapper = stage::splatting(plainImage(size, separated<double>(single)));
  expectSame(stage, plain, mapper, "A component by itself", check);
  check(
    mapper->GetIndexMemorySize() == plain->GetIndexMemorySize(), "A component by itself: no copy.");
}

/// VTK 9.3 to 9.6 interleave what should be separate: when they allocate it by themselves, and when
/// somebody asks for all of it.
void testComponentsThatVTKMoves(stage::Stage& stage, reference::Checks& check)
{
  const auto vectors = noiseArray(VTK_SHORT, Voxels, 3, 12);
  const auto interleaved = stage::splatting(plainImage(size, vectors));
  vtkNew<vtkSOADataArrayTemplate<short>> allocated;
  allocated->SetNumberOfComponents(3);
  allocated->SetNumberOfTuples(Voxels);
  for (vtkIdType n = 0; n < Voxels * 3; ++n)
  {
    allocated->SetComponent(n / 3, n % 3, vectors->GetComponent(n / 3, n % 3));
  }
  const auto mapper = stage::splatting(plainImage(size, allocated));
  const stage::Messages errors(allocated, vtkCommand::ErrorEvent);
  expectSame(stage, interleaved, mapper, "Allocated components", check);
  check(mapper->GetIndexMemorySize() <= interleaved->GetIndexMemorySize(),
    "Allocated components: no copy more than of ordinary arrays.");
  check(errors.texts.empty(), "Allocated components: no errors.");

  const auto separate = separated<short>(vectors);
  const auto moved = stage::splatting(plainImage(size, separate));
  const stage::Messages errorsOfMoved(separate, vtkCommand::ErrorEvent);
  const stage::Messages warnings(separate, vtkCommand::WarningEvent); // VTK's, of the copy
  expectSame(stage, interleaved, moved, "Components before a move", check);
  separate->GetVoidPointer(0);
  expectSame(stage, interleaved, moved, "Components after a move", check);
  check(moved->GetIndexMemorySize() <= interleaved->GetIndexMemorySize(),
    "Components after a move: no copy more than of ordinary arrays.");
  check(errorsOfMoved.texts.empty(), "Components after a move: no errors.");
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

/// Against VTK's GPU ray caster: smooth contents, each component another.
void testAgainstGPU(reference::Checks& check)
{
  stage::Stage stage(200, 190);
  const Size large = { 48, 40, 44 };
  const auto blobs = stage::blobsAndTubes(large, 14);
  const vtkIdType voxels = static_cast<vtkIdType>(blobs.voxels.size());
  vtkNew<vtkUnsignedCharArray> scalars;
  scalars->SetNumberOfComponents(2);
  scalars->SetNumberOfTuples(voxels);
  for (vtkIdType n = 0; n < voxels; ++n)
  {
    scalars->SetTypedComponent(n, 0, blobs.voxels[n]);
    scalars->SetTypedComponent(n, 1, blobs.voxels[voxels - 1 - n]);
  }
  const auto image = plainImage(large, scalars);
  stage.show(stage::splatting(image));
  for (int c = 0; c < 2; ++c)
  {
    vtkNew<vtkColorTransferFunction> color;
    color->AddRGBPoint(0.0, 0.0, 0.0, 0.0);
    color->AddRGBPoint(255.0, c ? 0.3 : 0.6, 1.0, 0.0);
    stage.property->SetColor(c, color);
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(0.0, 1.0);
    stage.property->SetScalarOpacity(c, opacity);
  }
  stage.property->SetComponentWeight(1, 0.6);
  stage.look({ 0.4, -0.3, 0.8 }, { 0.0, 1.0, 0.0 });
  const auto picture = stage.gray();
  const auto rayCaster = stage::gpuRayCaster(image, 0.2);
  stage.show(rayCaster);
  const stage::Likeness likeness(stage.gray(), picture);
  std::cout << "Independent components: " << likeness.text() << std::endl;
  check(likeness.psnr > 35.0 && likeness.largestShift() < 0.1,
    "Independent components are the GPU ray caster's.");
  rayCaster->ReleaseGraphicsResources(stage.window);
}
}

//------------------------------------------------------------------------------
int TestScalars(int, char*[])
{
  reference::Checks check;
  {
    stage::Stage stage(120, 110);
    stage.setGrayRamp(0.0, 110.0);
    for (double viewAngle : { 0.0, 50.0 })
    {
      stage.viewAngle = viewAngle;
      testArrays(stage, check);
      testComponentsOfTypes(stage, check);
      testMagnitude(stage, check);
      testMagnitudeOfVTK(stage, check);
      testSeparateComponents(stage, check);
      testComponentsThatVTKMoves(stage, check);
    }
  }
  for (int components = 1; components <= 4; ++components)
  {
    const auto scalars = noiseArray(VTK_UNSIGNED_SHORT, Voxels, components, 40 + components);
    testIndependentComponents(components, scalars, Mapper::HIGH, check);
    testIndependentComponents(components, scalars, Mapper::EXACT, check);
  }
  testReuse(check);
  testAgainstGPU(check);
  return check.exitCode();
}
