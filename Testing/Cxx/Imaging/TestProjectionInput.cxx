// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What vtkSplattingMIPProjection refuses: one sentence each, an empty output, and all is well
// afterwards.
#include "ProjectionTesting.h"

#include "vtkBitArray.h"
#include "vtkCamera.h"
#include "vtkDataSetAttributes.h"

#include <cmath>
#include <functional>
#include <sstream>

namespace
{
using reference::Checks;
using Filter = vtkSplattingMIPProjection;
using Change = std::function<void(Filter*)>;

vtkSmartPointer<vtkImageData> someImage()
{
  return projectiontesting::imageOf(reference::uniformNoise<std::uint8_t>({ 9, 8, 7 }, 3));
}

/// One sentence with the word in it; then, after the change is taken back, the same picture.
void testRefusal(Checks& check, const std::string& word, const Change& spoil, const Change& mend)
{
  const auto filter = projectiontesting::projectionOf(someImage());
  filter->SetOutputSize(12, 10);
  filter->Update();
  const auto before = vtkSmartPointer<vtkImageData>::New();
  before->DeepCopy(filter->GetOutput());
  {
    const projectiontesting::Errors errors(filter);
    spoil(filter);
    filter->Update();
    if (check(errors.texts.size() == 1, word, ": ", errors.texts.size(), " errors"))
    {
      const std::string& text = errors.texts.front();
      check(text.find(word) != std::string::npos, word, " is not in: ", text);
      check(text.find_last_of('.') != std::string::npos, "no sentence: ", text);
    }
    check(filter->GetOutput()->GetNumberOfPoints() == 0, word, ": there is an output");
    check(!filter->GetShearImage(), word, ": there is a shear image");
  }
  mend(filter);
  filter->Update();
  check(projectiontesting::sameScalars(filter->GetOutput(), before), word, ": not as before");
}

/// Settings of the picture and of where it is seen from.
void testViewSettings(Checks& check)
{
  testRefusal(
    check, "OutputSize", [](Filter* f) { f->SetOutputSize(0, 10); },
    [](Filter* f) { f->SetOutputSize(12, 10); });
  testRefusal(
    check, "OutputSize", [](Filter* f) { f->SetOutputSize(12, 20000); },
    [](Filter* f) { f->SetOutputSize(12, 10); });
  for (const double bad : { -1.0, double(NAN), double(INFINITY) })
  {
    testRefusal(
      check, "OutputSpacing", [=](Filter* f) { f->SetOutputSpacing(1.0, bad); },
      [](Filter* f) { f->SetOutputSpacing(0.0, 0.0); });
    testRefusal(
      check, "ViewDirection", [=](Filter* f) { f->SetViewDirection(0.0, bad - bad, 0.0); },
      [](Filter* f) { f->SetViewDirection(0.0, 1.0, 0.0); });
  }
  testRefusal(
    check, "OutputSpacing", [](Filter* f) { f->SetOutputSpacing(1.0, 0.0); },
    [](Filter* f) { f->SetOutputSpacing(0.0, 0.0); });
  testRefusal(
    check, "ViewUp", [](Filter* f) { f->SetViewUp(0.0, -3.0, 0.0); },
    [](Filter* f) { f->SetViewUp(0.0, 0.0, 1.0); });
  testRefusal(
    check, "ViewUp", [](Filter* f) { f->SetViewUp(0.0, 0.0, NAN); },
    [](Filter* f) { f->SetViewUp(0.0, 0.0, 1.0); });
  testRefusal(
    check, "TotalAngle", [](Filter* f) { f->SetTotalAngle(0.0); },
    [](Filter* f) { f->SetTotalAngle(360.0); });
  testRefusal(
    check, "RotationAxis", [](Filter* f) { f->SetRotationAxis(0.0, NAN, 0.0); },
    [](Filter* f) { f->SetRotationAxis(0.0, 0.0, 0.0); });
  testRefusal(
    check, "FocalPoint",
    [](Filter* f)
    {
      f->CenterOnVolumeOff();
      f->SetFocalPoint(0.0, INFINITY, 0.0);
    },
    [](Filter* f) { f->CenterOnVolumeOn(); });
}

/// Settings of which samples count.
void testSampleSettings(Checks& check)
{
  testRefusal(
    check, "SlabThickness",
    [](Filter* f)
    {
      f->SlabOn();
      f->SetSlabThickness(-1.0);
    },
    [](Filter* f) { f->SlabOff(); });
  testRefusal(
    check, "CroppingRegionPlanes",
    [](Filter* f)
    {
      f->CroppingOn();
      f->SetCroppingRegionPlanes(0.0, NAN, 0.0, 1.0, 0.0, 1.0);
    },
    [](Filter* f) { f->CroppingOff(); });
  testRefusal(
    check, "AverageIPScalarRange",
    [](Filter* f)
    {
      f->SetBlendModeToAverageIntensity();
      f->SetAverageIPScalarRange(2.0, 1.0);
    },
    [](Filter* f) { f->SetBlendModeToMaximumIntensity(); });
}

void testCameras(Checks& check)
{
  const auto with = [](const std::function<void(vtkCamera*)>& spoil)
  {
    return [spoil](Filter* f)
    {
      vtkNew<vtkCamera> camera;
      spoil(camera);
      f->SetCamera(camera);
    };
  };
  const Change mend = [](Filter* f) { f->SetCamera(nullptr); };
  testRefusal(check, "explicit",
    with([](vtkCamera* c) { c->UseExplicitProjectionTransformMatrixOn(); }), mend);
  testRefusal(check, "view-up",
    with(
      [](vtkCamera* c)
      {
        c->SetViewUp(0.0, 0.0, 1.0);
        c->SetPosition(0.0, 0.0, 5.0);
        c->ParallelProjectionOn();
      }),
    mend);
  testRefusal(check, "parallel scale",
    with(
      [](vtkCamera* c)
      {
        c->ParallelProjectionOn();
        c->SetParallelScale(0.0);
      }),
    mend);
  testRefusal(check, "camera", with([](vtkCamera* c) { c->SetPosition(0.0, NAN, 0.0); }), mend);
}

void testInputs(Checks& check)
{
  const auto replace = [](vtkImageData* image) -> Change
  {
    const vtkSmartPointer<vtkImageData> held = image;
    return [held](Filter* f) { f->SetInputData(held); };
  };
  const Change mend = [](Filter* f) { f->SetInputData(someImage()); };
  vtkNew<vtkImageData> empty;
  testRefusal(check, "input", replace(empty), mend);
  vtkNew<vtkImageData> bare;
  bare->SetDimensions(4, 4, 4);
  testRefusal(check, "scalars", replace(bare), mend);
  vtkNew<vtkImageData> bits;
  bits->SetDimensions(4, 4, 4);
  bits->AllocateScalars(VTK_BIT, 1);
  testRefusal(check, "bits", replace(bits), mend);
  const auto flat = someImage();
  flat->SetSpacing(1.0, 0.0, 1.0);
  testRefusal(check, "pacing", replace(flat), mend);
  vtkNew<vtkImageData> five;
  five->SetDimensions(4, 4, 4);
  five->AllocateScalars(VTK_FLOAT, 5);
  testRefusal(check, "components", replace(five), mend);
}

void testArrays(Checks& check)
{
  testRefusal(
    check, "nowhere",
    [](Filter* f)
    { f->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "nowhere"); },
    [](Filter* f)
    {
      f->SetInputArrayToProcess(
        0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
    });
}

/// More than 2^47 bytes.
void testMemory(Checks& check)
{
  vtkNew<vtkImageData> wide;
  wide->SetDimensions(2, 2, 2);
  wide->AllocateScalars(VTK_DOUBLE, 4);
  wide->GetPointData()->GetScalars()->Fill(1.0);
  const auto filter = projectiontesting::projectionOf(wide);
  const projectiontesting::Errors errors(filter);
  filter->SetOutputSize(16384, 16384);
  filter->SetNumberOfViews(36000);
  filter->Update();
  check(errors.texts.size() == 1 && errors.texts.front().find("memory") != std::string::npos,
    errors.texts.size(), " errors where there is no memory");
  check(filter->GetOutput()->GetNumberOfPoints() == 0, "there is an output");
  filter->SetOutputSize(4, 4);
  filter->SetNumberOfViews(2);
  filter->Update();
  check(filter->GetOutput()->GetNumberOfPoints() == 32 && errors.texts.size() == 1,
    "a small one is made");
}

/// Extreme settings that have a meaning: no errors.
void testExtremes(Checks& check)
{
  vtkNew<vtkImageData> voxel;
  voxel->SetDimensions(1, 1, 1);
  voxel->AllocateScalars(VTK_SHORT, 1);
  voxel->SetScalarComponentFromDouble(0, 0, 0, 0, -300.0);
  const auto filter = projectiontesting::projectionOf(voxel);
  const projectiontesting::Errors errors(filter);
  filter->SetNumberOfViews(0);
  check(filter->GetNumberOfViews() == 1, "views are clamped");
  filter->SetOutputSize(1, 1);
  filter->Update();
  check(filter->GetOutput()->GetNumberOfPoints() == 1 &&
      filter->GetOutput()->GetScalarComponentAsDouble(0, 0, 0, 0) == -300.0,
    "one voxel in one pixel");
  filter->CenterOnVolumeOff();
  filter->SetFocalPoint(1e6, 0.0, 0.0);
  filter->Update();
  check(filter->GetOutput()->GetScalarComponentAsDouble(0, 0, 0, 0) == 0.0, "beside the volume");
  // Seen from behind: nothing.
  vtkNew<vtkCamera> camera;
  camera->SetPosition(0.0, 0.0, 10.0);
  camera->SetFocalPoint(0.0, 0.0, 20.0);
  filter->SetCamera(camera);
  filter->SetBackgroundValue(4.0);
  filter->Update();
  check(filter->GetOutput()->GetScalarComponentAsDouble(0, 0, 0, 0) == 4.0, "behind the eye");
  check(errors.texts.empty(), errors.texts.size(), " errors");
  std::ostringstream text;
  filter->Print(text);
  check(text.str().find("NumberOfViews: 1") != std::string::npos, "prints itself");
}
}

int TestProjectionInput(int, char*[])
{
  Checks check;
  testViewSettings(check);
  testSampleSettings(check);
  testCameras(check);
  testInputs(check);
  testArrays(check);
  testMemory(check);
  testExtremes(check);
  return check.exitCode();
}
