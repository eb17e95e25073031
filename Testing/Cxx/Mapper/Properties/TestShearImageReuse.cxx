// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The shear image as the mapper hands it out, and when the volume is projected again.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkPlane.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <cmath>

namespace
{
using Mapper = vtkSplattingMIPVolumeMapper;
using Bytes = reference::Volume<std::uint8_t>;

const stage::Vector oblique = { 0.3, -0.45, 0.8 };
const stage::Vector up = { 0.0, 1.0, 0.1 };

Bytes smallNoise()
{
  return reference::uniformNoise<std::uint8_t>({ 11, 9, 14 }, 5);
}

vtkSmartPointer<vtkImageData> asType(const Bytes& volume, int type)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(volume.size[0], volume.size[1], volume.size[2]);
  image->AllocateScalars(type, 1);
  for (std::size_t voxel = 0; voxel < volume.voxels.size(); ++voxel)
  {
    image->GetPointData()->GetScalars()->SetComponent(
      static_cast<vtkIdType>(voxel), 0, volume.voxels[voxel] / 2); // fits signed bytes
  }
  return image;
}

int floatTypeFor(int type)
{
  const bool isSmall = vtkDataArray::GetDataTypeSize(type) <= 2 || type == VTK_FLOAT;
  return isSmall ? VTK_FLOAT : VTK_DOUBLE;
}

void testTypes(stage::Stage& stage, reference::Checks& check)
{
  for (int type : { VTK_CHAR, VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT,
         VTK_INT, VTK_UNSIGNED_INT, VTK_LONG, VTK_UNSIGNED_LONG, VTK_LONG_LONG,
         VTK_UNSIGNED_LONG_LONG, VTK_FLOAT, VTK_DOUBLE })
  {
    const auto image = asType(smallNoise(), type);
    const auto mapper = stage::splatting(image);
    stage.show(mapper);
    stage.look(oblique, up);
    for (int mode : { Mapper::PREVIEW, Mapper::STANDARD, Mapper::HIGH })
    {
      mapper->SetQualityMode(mode);
      stage.window->Render();
      vtkImageData* const shear = mapper->GetShearImage();
      const int expected = mode == Mapper::PREVIEW ? type : floatTypeFor(type);
      check(shear && shear->GetScalarType() == expected, "The shear image of ",
        vtkImageScalarTypeNameMacro(type), " in mode ", mapper->GetQualityModeAsString(), " is ",
        vtkImageScalarTypeNameMacro(expected), ".");
    }
  }
}

/// One view along each principal axis. What its pixels show is compared by other tests.
void testGeometry(stage::Stage& stage, reference::Checks& check)
{
  const Bytes volume = smallNoise();
  const auto image = stage::toImageData(volume);
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  const stage::Vector directions[] = { { -0.8, 0.3, 0.45 }, { 0.5, 0.7, -0.1 }, oblique };
  for (int axis = 0; axis < 3; ++axis)
  {
    stage.look(directions[axis], up);
    reference::ShearView view;
    view.axis = axis;
    const std::string where = " along axis " + std::to_string(axis) + ".";
    mapper->SetQualityModeToPreview();
    stage.window->Render();
    mapper->GetShear(view.shear);
    check(mapper->GetPrincipalAxis() == axis, "The principal axis", where);
    check(std::abs(view.shear[0]) <= 1.0 && std::abs(view.shear[1]) <= 1.0, "Shears", where);
    const reference::ShearGrid grid = reference::makeShearGrid(volume.size, view);
    const double* origin = mapper->GetShearImage()->GetOrigin();
    check(mapper->GetShearImage()->GetSpacing()[0] == 1.0, "Shear spacing", where);
    check(origin[0] == -grid.margin[0] && origin[1] == -grid.margin[1], "Shear origin", where);
  }
}

/// Whether the step makes the next render project the given number of times.
template <class Step>
bool projects(stage::Stage& stage, Mapper* mapper, int times, Step step)
{
  stage.window->Render();
  const vtkIdType before = mapper->GetNumberOfProjections();
  step();
  stage.window->Render();
  return mapper->GetNumberOfProjections() - before == times;
}

void testReuse(stage::Stage& stage, Mapper* mapper, reference::Checks& check)
{
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  const auto keeps = [&](const char* what, auto step)
  { check(projects(stage, mapper, 0, step), "No projection when ", what); };
  keeps("nothing changes.", [] {});
  keeps("colours change.", [&] { stage.setGrayRamp(20.0, 200.0); });
  keeps("the camera zooms.", [&] { camera->Zoom(1.7); });
  keeps("the camera is panned.", [&] { camera->SetWindowCenter(0.2, -0.1); });
  keeps("the camera moves sideways.",
    [&]
    {
      double position[3], focus[3];
      camera->GetPosition(position);
      camera->GetFocalPoint(focus);
      camera->SetPosition(position[0] + 3.0, position[1], position[2]);
      camera->SetFocalPoint(focus[0] + 3.0, focus[1], focus[2]);
      stage.renderer->ResetCameraClippingRange();
    });
  keeps("the camera moves back.",
    [&]
    {
      camera->Dolly(0.7);
      stage.renderer->ResetCameraClippingRange();
    });
  keeps("the camera rolls.", [&] { camera->Roll(25.0); });
  keeps("the window changes its size.", [&] { stage.window->SetSize(120, 150); });
}

void testModes(stage::Stage& stage, Mapper* mapper, reference::Checks& check)
{
  const auto again = [&](const char* what, auto step)
  { check(projects(stage, mapper, 1, step), "One projection when ", what); };
  again("the mode changes.", [&] { mapper->SetQualityModeToStandard(); });
  again("the mode changes back.", [&] { mapper->SetQualityModeToHigh(); });
  again("the kernel changes.", [&] { mapper->SetKernelToCosineBell(); });
  again("the kernel's radius changes.", [&] { mapper->SetKernelRadius(1.3); });
  again("the weights change.", [&] { mapper->SetFootprintSampling(8); });
}

void testProjection(
  stage::Stage& stage, Mapper* mapper, vtkImageData* image, reference::Checks& check)
{
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  const std::string mode = mapper->GetQualityModeAsString();
  const auto again = [&](const char* what, auto step)
  { check(projects(stage, mapper, 1, step), "In mode ", mode, " one projection when ", what); };
  again("the view turns.",
    [&]
    {
      camera->Azimuth(10.0);
      stage.renderer->ResetCameraClippingRange();
    });
  again("a plane cuts the volume.",
    [&]
    {
      vtkNew<vtkPlane> plane;
      plane->SetOrigin(image->GetCenter());
      mapper->AddClippingPlane(plane);
    });
  again("the plane goes.", [&] { mapper->RemoveAllClippingPlanes(); });
  again("the prop is stretched.", [&] { stage.volume->SetScale(1.0, 1.4, 1.0); });
  again("scalars are modified.",
    [&]
    {
      image->SetScalarComponentFromDouble(3, 4, 5, 0, 255.0);
      image->GetPointData()->GetScalars()->Modified();
    });
  again("the image is modified.",
    [&]
    {
      image->SetScalarComponentFromDouble(3, 4, 6, 0, 255.0);
      image->Modified();
    });
  const auto other = stage::toImageData(reference::constant<std::uint8_t>({ 11, 9, 14 }, 90));
  again("the input is replaced.", [&] { mapper->SetInputData(other); });
  // An array may be given other voxels without a word; the old ones may be gone by then.
  std::vector<unsigned char> buffer(11 * 9 * 14, 70);
  auto* array = vtkUnsignedCharArray::SafeDownCast(other->GetPointData()->GetScalars());
  again("the array gets another buffer.",
    [&] { array->SetArray(buffer.data(), static_cast<vtkIdType>(buffer.size()), 1); });
  mapper->SetInputData(image); // the buffer ends here
}

/// What makes no difference to the scalars that are projected.
void testIdleChoices(stage::Stage& stage, reference::Checks& check)
{
  for (int components : { 1, 3 })
  {
    vtkNew<vtkImageData> image;
    image->SetDimensions(11, 9, 14);
    image->AllocateScalars(VTK_UNSIGNED_CHAR, components);
    for (int c = 0; c < components; ++c)
    {
      image->GetPointData()->GetScalars()->FillComponent(c, 60.0 + c);
    }
    const auto mapper = stage::splatting(image);
    stage.show(mapper);
    stage.look(oblique, up);
    mapper->SetVectorMode(components == 1 ? Mapper::DISABLED : Mapper::MAGNITUDE);
    stage.window->Render();
    const double time = mapper->GetIndexTime();
    const auto stays = [&](const std::string& when)
    {
      stage.window->Render();
      check(mapper->GetNumberOfProjections() == 1 && mapper->GetIndexTime() == time, components,
        " components are not projected again when ", when);
    };
    mapper->SetVectorComponent(2);
    stays("an idle VectorComponent changes.");
    stage.property->SetIndependentComponents(0);
    stays("IndependentComponents changes, but there is one.");
    stage.property->SetIndependentComponents(1);
    if (components == 1)
    {
      mapper->SetVectorModeToMagnitude();
      stays("it is itself that is the magnitude.");
      mapper->SetVectorComponent(0);
      mapper->SetVectorModeToComponent();
      stays("it is itself that is chosen.");
    }
    else
    {
      mapper->SetVectorModeToComponent();
      stage.window->Render();
      check(mapper->GetNumberOfProjections() == 2, "Another choice is projected.");
    }
  }
}

void testNumberOfProjections(stage::Stage& stage, reference::Checks& check)
{
  const auto image = stage::toImageData(smallNoise());
  const auto mapper = stage::splatting(image);
  stage.show(mapper);
  mapper->SetQualityModeToHigh();
  stage.look(oblique, up);
  testReuse(stage, mapper, check);
  testModes(stage, mapper, check);
  for (int mode : { Mapper::HIGH, Mapper::EXACT })
  {
    mapper->SetQualityMode(mode);
    stage.volume->SetScale(1.0);
    stage.look(oblique, up);
    testProjection(stage, mapper, image, check);
  }
}
}

//------------------------------------------------------------------------------
int TestShearImageReuse(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(150, 120);
  testTypes(stage, check);
  testGeometry(stage, check);
  testNumberOfProjections(stage, check);
  testIdleChoices(stage, check);
  return check.exitCode();
}
