// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// vtkSplattingMIPReslice as a filter: what vtkImageReslice computes instead, parts of outputs,
// changed scalars, progress and aborts.
#include "ResliceTesting.h"

#include "vtkSplattingMIPReslice.h"

#include "vtkCallbackCommand.h"
#include "vtkDataArray.h"
#include "vtkGeneralTransform.h"
#include "vtkImageSincInterpolator.h"
#include "vtkPerspectiveTransform.h"

#include <functional>
#include <utility>

namespace
{
using reference::Checks;
using reference::Random;
using reslicetesting::Settings;

/// A slab through the middle of noise, not along its axes.
vtkSmartPointer<vtkImageData> someImage(Random& random, Settings& s)
{
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(9, 8, 7);
  image->AllocateScalars(VTK_SHORT, 1);
  auto* const voxels = static_cast<short*>(image->GetScalarPointer());
  for (vtkIdType n = 0; n < image->GetNumberOfPoints(); ++n)
  {
    voxels[n] = random.uniform<short>(-100, 100);
  }
  s.axes = glm::rotate(glm::dmat4(1.0), 0.4, glm::normalize(glm::dvec3(1.0, 2.0, 3.0)));
  s.spacing = glm::dvec3(0.5);
  const int extent[6] = { 0, 19, -2, 17, 3, 5 };
  std::copy(extent, extent + 6, s.extent);
  s.slices = 5;
  return image;
}

/// What is not exact has the bits of vtkImageReslice.
void testInherited(Checks& check)
{
  using Change = std::function<void(vtkImageReslice*)>;
  vtkNew<vtkPerspectiveTransform> perspective;
  vtkNew<vtkMatrix4x4> matrix;
  matrix->SetElement(3, 0, 0.01);
  perspective->SetMatrix(matrix);
  vtkNew<vtkGeneralTransform> general;
  vtkNew<vtkImageSincInterpolator> sinc;
  const std::pair<const char*, Change> changes[] = {
    { "nearest", [](auto* r) { r->SetInterpolationModeToNearestNeighbor(); } },
    { "cubic", [](auto* r) { r->SetInterpolationModeToCubic(); } },
    { "mean", [](auto* r) { r->SetSlabModeToMean(); } },
    { "sum", [](auto* r) { r->SetSlabModeToSum(); } },
    { "one slice", [](auto* r) { r->SetSlabNumberOfSlices(1); } },
    { "no thickness", [](auto* r) { r->SetSlabSliceSpacingFraction(0.0); } },
    { "wrap", [](auto* r) { r->WrapOn(); } },
    { "mirror", [](auto* r) { r->MirrorOn(); } },
    { "thick border", [](auto* r) { r->SetBorderThickness(1.0); } },
    { "perspective", [&](auto* r) { r->SetResliceTransform(perspective); } },
    { "general", [&](auto* r) { r->SetResliceTransform(general); } },
    { "sinc", [&](auto* r) { r->SetInterpolator(sinc); } },
    { "flat output", [](auto* r) { r->SetOutputSpacing(0.5, 0.5, 0.0); } },
  };
  Random random(17);
  Settings s;
  const auto image = someImage(random, s);
  for (const auto& [name, change] : changes)
  {
    vtkNew<vtkSplattingMIPReslice> filter;
    vtkNew<vtkImageReslice> reslice;
    for (vtkImageReslice* r : { static_cast<vtkImageReslice*>(filter), reslice.Get() })
    {
      r->SetInputData(image);
      s.apply(r);
    }
    filter->Update();
    check(filter->GetSlabIsExact(), name, ": not exact before");
    change(filter);
    change(reslice);
    filter->Update();
    reslice->Update();
    check(!filter->GetSlabIsExact(), name, ": exact");
    check(projectiontesting::sameScalars(filter->GetOutput(), reslice->GetOutput()), name,
      ": not vtkImageReslice's output");
  }
  // Values that would overflow.
  vtkNew<vtkImageData> large;
  large->SetDimensions(3, 3, 3);
  large->AllocateScalars(VTK_FLOAT, 1);
  std::fill_n(static_cast<float*>(large->GetScalarPointer()), 27, 2e37f);
  vtkNew<vtkSplattingMIPReslice> filter;
  filter->SetInputData(large);
  s.apply(filter);
  filter->Update();
  check(!filter->GetSlabIsExact(), "exact with 2e37");
}

/// Values that are clamped, or lie near the middle between two whole numbers.
void testRounding(Checks& check)
{
  Random random(16);
  Settings s;
  someImage(random, s);
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 3);
  image->AllocateScalars(VTK_DOUBLE, 1);
  for (const double value : { 2.5 - 0x1p-18, 2.5 - 0x1p-16, -2.5, -200.0, 300.0, 1e6, 1e12 })
  {
    std::fill_n(static_cast<double*>(image->GetScalarPointer()), 27, value);
    image->GetPointData()->GetScalars()->Modified();
    for (const int type : { VTK_UNSIGNED_CHAR, VTK_CHAR, VTK_SHORT, VTK_UNSIGNED_INT, VTK_FLOAT })
    {
      s.type = type;
      vtkNew<vtkSplattingMIPReslice> filter;
      vtkNew<vtkImageReslice> reslice;
      for (vtkImageReslice* r : { static_cast<vtkImageReslice*>(filter), reslice.Get() })
      {
        r->SetInputData(image);
        s.apply(r);
        r->Update();
      }
      double range[2], expected[2];
      filter->GetOutput()->GetScalarRange(range);
      reslice->GetOutput()->GetScalarRange(expected);
      check(filter->GetSlabIsExact() && range[0] == expected[0] && range[1] == expected[1], value,
        " as type ", type, " is ", range[0], " to ", range[1], ", not ", expected[0], " to ",
        expected[1]);
    }
  }
}

/// Default geometry, and a part of an output: the same bits as in the whole.
void testParts(Checks& check)
{
  Random random(18);
  Settings s;
  const auto image = someImage(random, s);
  vtkNew<vtkSplattingMIPReslice> whole, part;
  for (vtkSplattingMIPReslice* r : { whole.Get(), part.Get() })
  {
    r->SetInputData(image);
    s.apply(r);
    r->SetOutputExtentToDefault();
    r->SetOutputOriginToDefault();
    r->AutoCropOutputOn();
  }
  whole->Update();
  int extent[6];
  whole->GetOutput()->GetExtent(extent);
  check(extent[1] > 20 && extent[5] > 10, "no automatic extent");
  const int some[6] = { extent[0] + 5, extent[1] - 3, extent[2] + 7, extent[3], extent[4] + 2,
    extent[4] + 4 };
  part->UpdateExtent(some);
  int isSame = 0, all = 0;
  for (int z = some[4]; z <= some[5]; ++z)
  {
    for (int y = some[2]; y <= some[3]; ++y)
    {
      for (int x = some[0]; x <= some[1]; ++x, ++all)
      {
        isSame += whole->GetOutput()->GetScalarComponentAsDouble(x, y, z, 0) ==
          part->GetOutput()->GetScalarComponentAsDouble(x, y, z, 0);
      }
    }
  }
  check(isSame == all && whole->GetSlabIsExact(), all - isSame, " pixels of a part differ");
}

/// Scalars that change in place, or that are other ones.
void testChanges(Checks& check)
{
  Random random(19);
  Settings s;
  const auto image = someImage(random, s);
  vtkNew<vtkSplattingMIPReslice> filter;
  filter->SetInputData(image);
  s.apply(filter);
  filter->Update();
  for (int change = 0; change < 3; ++change)
  {
    vtkDataArray* const scalars = image->GetPointData()->GetScalars();
    if (change == 0)
    {
      scalars->SetComponent(4 + 9 * (4 + 8 * 3), 0, 3000.0);
      scalars->Modified();
    }
    else if (change == 1)
    {
      image->AllocateScalars(VTK_FLOAT, 2);
      std::fill_n(static_cast<float*>(image->GetScalarPointer()), 2 * 504, 5.0f);
    }
    else
    {
      image->SetDimensions(8, 9, 7); // of the same scalars
    }
    image->Modified();
    filter->Update();
    vtkNew<vtkSplattingMIPReslice> other;
    other->SetInputData(image);
    s.apply(other);
    other->Update();
    check(projectiontesting::sameScalars(filter->GetOutput(), other->GetOutput()), "change ",
      change, " is not seen");
    check(change != 0 || filter->GetOutput()->GetScalarRange()[1] > 1000.0, "no bright voxel");
  }
}

void testProgress(Checks& check)
{
  struct Course
  {
    vtkSplattingMIPReslice* filter;
    std::vector<double> events;
    bool stops = false;
  };
  Random random(20);
  Settings s;
  const auto image = someImage(random, s);
  vtkNew<vtkSplattingMIPReslice> filter, other;
  for (vtkSplattingMIPReslice* r : { filter.Get(), other.Get() })
  {
    r->SetInputData(image);
    s.apply(r);
  }
  other->Update();
  Course course{ filter, {} };
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(&course);
  command->SetCallback(
    [](vtkObject*, unsigned long, void* data, void*)
    {
      Course& course = *static_cast<Course*>(data);
      course.events.push_back(course.filter->GetProgress());
      if (course.stops && course.filter->GetProgress() > 0.3)
      {
        course.filter->AbortExecuteOn();
      }
    });
  filter->AddObserver(vtkCommand::ProgressEvent, command);
  filter->Update();
  check(std::is_sorted(course.events.begin(), course.events.end()) && course.events.size() > 3 &&
      course.events.size() < 110,
    course.events.size(), " progress events, or not in order");
  course.stops = true;
  filter->Modified();
  filter->Update();
  check(filter->GetOutput()->GetNumberOfPoints() == 0, "an aborted output is not empty");
  course.stops = false;
  filter->AbortExecuteOff();
  filter->Modified();
  filter->Update();
  check(projectiontesting::sameScalars(filter->GetOutput(), other->GetOutput()),
    "another output after an abort");
}
}

int TestReslicePipeline(int, char*[])
{
  Checks check;
  testInherited(check);
  testRounding(check);
  testParts(check);
  testChanges(check);
  testProgress(check);
  return check.exitCode();
}
