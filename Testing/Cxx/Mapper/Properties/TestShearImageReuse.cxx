// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Type and position of the shear image that the mapper returns, and changes of a view that do not
// project again. TestWalk tests changes that do.
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

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

void testReuse(stage::Stage& stage, reference::Checks& check)
{
  const auto mapper = stage::splatting(stage::toImageData(smallNoise()));
  mapper->SetQualityModeToHigh();
  stage.show(mapper);
  stage.look(oblique, up);
  stage.window->Render();
  vtkCamera* const camera = stage.renderer->GetActiveCamera();
  const auto keeps = [&](const char* what, auto step)
  {
    step();
    stage.window->Render();
    check(mapper->GetNumberOfProjections() == 1, "No projection when ", what);
  };
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
}

//------------------------------------------------------------------------------
int TestShearImageReuse(int, char*[])
{
  reference::Checks check;
  stage::Stage stage(150, 120);
  testTypes(stage, check);
  testGeometry(stage, check);
  testReuse(stage, check);
  return check.exitCode();
}
