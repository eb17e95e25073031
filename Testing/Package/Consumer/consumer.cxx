// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A program outside this tree: renders a volume and looks for it in the picture.
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkRTAnalyticSource.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSplattingMIPVolumeMapper.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <cstdlib>
#include <iostream>

namespace
{
/// Red in the middle, black in the corner.
bool showsVolume(vtkRenderWindow* window)
{
  window->Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetRGBACharPixelData(0, 0, 63, 63, 0, pixels);
  const vtkIdType centre = 32 * 64 + 32;
  return pixels->GetTypedComponent(centre, 0) > 250 && pixels->GetTypedComponent(centre, 1) == 0 &&
    pixels->GetTypedComponent(0, 0) == 0;
}
}

int main()
{
  vtkNew<vtkRTAnalyticSource> source;
  vtkNew<vtkSplattingMIPVolumeMapper> mapper;
  mapper->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkColorTransferFunction> red;
  red->AddRGBPoint(0.0, 1.0, 0.0, 0.0);
  vtkNew<vtkPiecewiseFunction> opaque;
  opaque->AddPoint(0.0, 1.0);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  volume->GetProperty()->SetColor(red);
  volume->GetProperty()->SetScalarOpacity(opaque);

  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  renderer->GetActiveCamera()->ParallelProjectionOn();
  renderer->ResetCamera();
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetSize(64, 64);
  window->AddRenderer(renderer);
  bool splatted = showsVolume(window) && !mapper->GetLastRenderUsedRayCasting();
  renderer->GetActiveCamera()->ParallelProjectionOff();
  renderer->ResetCamera();
  splatted = splatted && showsVolume(window) && !mapper->GetLastRenderUsedRayCasting();
  mapper->SetBlendModeToComposite();
  const bool rayCast = showsVolume(window) && mapper->GetLastRenderUsedRayCasting();
  if (!splatted || !rayCast)
  {
    std::cerr << "The volume is not in the picture." << std::endl;
    return EXIT_FAILURE;
  }
  std::cout << mapper->GetClassName() << " with " << mapper->GetInstructionSet() << std::endl;
  return EXIT_SUCCESS;
}
