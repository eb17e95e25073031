// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Where the output of vtkSplattingMIPProjection lies in the world: its pixels are on the rays that
// they show, in memory, downstream, and after writing and reading.
#include "ProjectionTesting.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkImageShiftScale.h"
#include "vtkMatrix4x4.h"
#include "vtkNIFTIImageReader.h"
#include "vtkNIFTIImageWriter.h"
#include "vtkXMLImageDataReader.h"
#include "vtkXMLImageDataWriter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace
{
using reference::Checks;
using Filter = vtkSplattingMIPProjection;

/// Pixels are less than half a voxel wide, so that they show points.
constexpr int Size[2] = { 296, 232 };

glm::dvec3 vector(const double* v)
{
  return { v[0], v[1], v[2] };
}

glm::dvec3 placeOf(vtkImageData* picture, double x, double y)
{
  double point[3];
  picture->TransformContinuousIndexToPhysicalPoint(x, y, 0.0, point);
  return vector(point);
}

/// A camera that sees some of a volume from anywhere, its middle not in the middle of the picture.
vtkSmartPointer<vtkCamera> someCamera(vtkImageData* image, bool parallel, reference::Random& random)
{
  const glm::dvec3 focus = vector(image->GetCenter());
  const glm::dvec3 eye = focus - 2.0 * image->GetLength() * coretesting::anyDirection(random);
  const glm::dvec3 up = coretesting::anyDirection(random);
  auto camera = vtkSmartPointer<vtkCamera>::New();
  camera->SetFocalPoint(&focus.x);
  camera->SetPosition(&eye.x);
  camera->SetViewUp(&up.x);
  camera->SetParallelProjection(parallel);
  camera->SetParallelScale(0.4 * image->GetLength());
  camera->SetViewAngle(random.uniform(15.0, 40.0));
  const double x = random.uniform(-0.3, 0.3), y = random.uniform(-0.3, 0.3);
  camera->SetWindowCenter(x, y);
  return camera;
}

vtkSmartPointer<Filter> someView(vtkImageData* image, bool parallel, reference::Random& random)
{
  auto filter = projectiontesting::projectionOf(image);
  const auto camera = someCamera(image, parallel, random);
  filter->SetCamera(camera);
  filter->SetOutputSize(Size[0], Size[1]);
  if (random.oneIn(2))
  {
    const double step = image->GetLength() / 320.0;
    const double x = step * random.uniform(0.5, 1.5), y = step * random.uniform(0.5, 1.5);
    filter->SetOutputSpacing(x, y);
  }
  filter->SetQualityMode(random.uniform(0, 3));
  return filter;
}

/// How far a line through a point, away from the viewer, is from the ray of a camera through
/// another.
double missOf(vtkCamera* camera, const glm::dvec3& pixel, const glm::dvec3& sample)
{
  const glm::dvec3 ray = camera->GetParallelProjection()
    ? vector(camera->GetDirectionOfProjection())
    : glm::normalize(pixel - vector(camera->GetPosition()));
  const glm::dvec3 aside = sample - pixel;
  return glm::length(aside - glm::dot(aside, ray) * ray);
}

/// The samples that pixels show lie on the rays through the places of the pixels.
void testRays(Checks& check, bool parallel, reference::Random& random)
{
  const auto image = projectiontesting::anyImage({ 17, 21, 19 }, random);
  const auto filter = someView(image, parallel, random);
  filter->RecordLocationsOn();
  filter->Update();
  vtkImageData* const output = filter->GetOutput();
  vtkDataArray* const positions = output->GetPointData()->GetArray("Position");
  double worst = 0.0;
  int seen = 0;
  for (int y = 0; y < Size[1]; ++y)
  {
    for (int x = 0; x < Size[0]; ++x)
    {
      const glm::dvec3 sample = vector(positions->GetTuple3(x + vtkIdType(y) * Size[0]));
      if (std::isfinite(sample.x))
      {
        ++seen;
        worst = std::max(worst, missOf(filter->GetCamera(), placeOf(output, x, y), sample));
      }
    }
  }
  check(seen > 9, "some of the volume is seen: ", seen);
  check(worst < 1e-9 * image->GetLength(), parallel, ": samples are off their rays by ", worst);
}

/// Axes are right-handed and of length 1, the third to the viewer; the slab's middle is the plane.
void testAxes(Checks& check, bool parallel, reference::Random& random)
{
  const auto image = projectiontesting::anyImage({ 17, 21, 19 }, random);
  const auto filter = someView(image, parallel, random);
  vtkCamera* const camera = filter->GetCamera();
  for (const bool slab : { false, true })
  {
    const glm::dvec3 centre = vector(image->GetCenter()) + 3.0 * coretesting::anyDirection(random);
    filter->SetSlab(slab);
    filter->SetSlabThickness(7.5);
    filter->SetSlabCenter(&const_cast<glm::dvec3&>(centre).x);
    filter->Update();
    vtkImageData* const output = filter->GetOutput();
    vtkMatrix3x3* const axes = output->GetDirectionMatrix();
    const glm::dvec3 away = vector(camera->GetDirectionOfProjection());
    glm::dvec3 axis[3];
    for (int n = 0; n < 9; ++n)
    {
      axis[n % 3][n / 3] = axes->GetElement(n / 3, n % 3);
    }
    check(glm::length(axis[2] + away) < 1e-9, "the third axis goes to the viewer");
    check(std::abs(axes->Determinant() - 1.0) < 1e-9, "axes are right-handed");
    check(std::abs(glm::dot(axis[0], axis[1])) < 1e-9, "axes are perpendicular");
    check(glm::dot(axis[1], vector(camera->GetViewUp())) > 0.0, "y goes up");
    check(output->GetSpacing()[2] == (slab ? 7.5 : 1.0), "a slice is as thick as the slab");
    const glm::dvec3 through = slab && parallel ? centre : vector(camera->GetFocalPoint());
    check(std::abs(glm::dot(placeOf(output, 3.0, 5.0) - through, away)) < 1e-9 * image->GetLength(),
      "the plane goes through its middle");
  }
}

/// A turn lies where its first view lies, and tells the angles.
void testTurn(Checks& check, reference::Random& random)
{
  const auto image = projectiontesting::anyImage({ 17, 21, 19 }, random);
  const auto filter = someView(image, true, random);
  filter->Update();
  vtkNew<vtkImageData> first;
  first->DeepCopy(filter->GetOutput());
  filter->SetNumberOfViews(5);
  filter->SetTotalAngle(-90.0);
  filter->Update();
  vtkImageData* const output = filter->GetOutput();
  check(glm::length(placeOf(first, 4.0, 9.0) - placeOf(output, 4.0, 9.0)) == 0.0, "as the first");
  vtkDataArray* const angles = output->GetFieldData()->GetArray("ViewAngle");
  check(angles && angles->GetNumberOfTuples() == 5, "each view has an angle");
  for (int n = 0; angles && n < 5; ++n)
  {
    check(angles->GetTuple1(n) == -18.0 * n, "view ", n, " is turned by ", angles->GetTuple1(n));
  }
}

/// How far the corners of two images are from each other.
double distanceOf(vtkImageData* a, vtkImageData* b)
{
  double farthest = 0.0;
  for (const double x : { 0.0, Size[0] - 1.0 })
  {
    for (const double y : { 0.0, Size[1] - 1.0 })
    {
      farthest = std::max(farthest, glm::length(placeOf(a, x, y) - placeOf(b, x, y)));
    }
  }
  return farthest;
}

/// Filters that ask before there is an output are told the same. (VTK 9.1's filters pass on no
/// directions.)
void testDownstream(Checks& check, bool parallel, reference::Random& random)
{
  const auto image = projectiontesting::anyImage({ 17, 21, 19 }, random);
  const auto filter = someView(image, parallel, random);
  vtkNew<vtkImageShiftScale> scale;
  scale->SetInputConnection(filter->GetOutputPort());
  scale->Update();
  vtkNew<vtkImageData> told;
  told->CopyInformationFromPipeline(filter->GetOutputInformation(0));
  vtkImageData* const output = filter->GetOutput();
  check(distanceOf(told, output) == 0.0, "the pipeline knows the place");
  for (int a = 0; a < 3; ++a)
  {
    check(scale->GetOutput()->GetSpacing()[a] == output->GetSpacing()[a], "spacing downstream");
    check(scale->GetOutput()->GetOrigin()[a] == output->GetOrigin()[a], "origin downstream");
  }
}

void testXML(Checks& check, Filter* filter)
{
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetInputConnection(filter->GetOutputPort());
  writer->WriteToOutputStringOn();
  writer->Write();
  vtkNew<vtkXMLImageDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(writer->GetOutputString());
  reader->Update();
  const double miss = distanceOf(reader->GetOutput(), filter->GetOutput());
  check(miss < 1e-6, "VTK's XML puts the picture ", miss, " off");
  check(projectiontesting::sameScalars(reader->GetOutput(), filter->GetOutput()), "XML's values");
}

/// As vtkSplattingMIPProjection.h says. Version 1 of the format keeps numbers in single precision.
void testNIFTI(Checks& check, Filter* filter, int version)
{
  filter->Update();
  vtkImageData* const output = filter->GetOutput();
  vtkNew<vtkMatrix4x4> form;
  for (int row = 0; row < 3; ++row)
  {
    const double sign = row < 2 ? -1.0 : 1.0;
    double offset = output->GetOrigin()[row];
    for (int column = 0; column < 3; ++column)
    {
      const double element = output->GetDirectionMatrix()->GetElement(row, column);
      form->SetElement(row, column, sign * element);
      offset -= element * output->GetOrigin()[column];
    }
    form->SetElement(row, 3, sign * offset);
  }
  const std::string name = "TestPlacement.nii";
  vtkNew<vtkNIFTIImageWriter> writer;
  writer->SetInputConnection(filter->GetOutputPort());
  writer->SetNIFTIVersion(version);
  writer->SetQFormMatrix(form);
  writer->SetSFormMatrix(form);
  writer->SetFileName(name.c_str());
  writer->Write();
  vtkNew<vtkNIFTIImageReader> reader;
  reader->SetFileName(name.c_str());
  reader->Update();
  std::remove(name.c_str());
  double miss = 0.0, farthest = 0.0;
  for (const double x : { 0.0, Size[0] - 1.0 })
  {
    for (const double y : { 0.0, Size[1] - 1.0 })
    {
      const double* const spacing = reader->GetOutput()->GetSpacing();
      double point[4] = { x * spacing[0], y * spacing[1], 0.0, 1.0 };
      reader->GetSFormMatrix()->MultiplyPoint(point, point);
      const glm::dvec3 place = placeOf(output, x, y);
      miss = std::max(miss, glm::length(glm::dvec3(-point[0], -point[1], point[2]) - place));
      farthest = std::max(farthest, glm::length(place) + glm::length(vector(output->GetOrigin())));
    }
  }
  // Three products and their sum, each off by half a unit in the last place, in three coordinates.
  const double bound = version == 2 ? 1e-6 : 12.0 * std::ldexp(farthest, -24);
  check(miss < bound, "NIfTI-", version, " puts the picture ", miss, " off");
  check(projectiontesting::sameScalars(reader->GetOutput(), output), "NIfTI's values");
}
}

int TestPlacement(int, char*[])
{
  Checks check;
  reference::Random random(2601);
  for (int round = 0; round < 12; ++round)
  {
    for (const bool parallel : { true, false })
    {
      testRays(check, parallel, random);
      testAxes(check, parallel, random);
      testDownstream(check, parallel, random);
      const auto image = projectiontesting::anyImage({ 17, 21, 19 }, random);
      const auto filter = someView(image, parallel, random);
      filter->SlabOn();
      filter->SetSlabCenter(image->GetCenter());
      filter->SetSlabThickness(random.uniform(3.0, 9.0));
      testXML(check, filter);
      testNIFTI(check, filter, 1);
      testNIFTI(check, filter, 2);
    }
    testTurn(check, random);
  }
  return check.exitCode();
}
