// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// program MODE FILE
//
// Renders VTK's wavelet in a blend mode (a number of vtkVolumeMapper) and writes the pixels: four
// bytes each, bottom row first. script.py has the same scene.
#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkRTAnalyticSource.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <cstdlib>
#include <fstream>

int main(int, char* argv[])
{
  constexpr int size = 150;
  vtkNew<vtkRTAnalyticSource> source;
  source->SetWholeExtent(-15, 15, -15, 15, -15, 15);
  const auto mapper = vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New();
  mapper->SetInputConnection(source->GetOutputPort());
  mapper->SetBlendMode(std::atoi(argv[1]));
  vtkNew<vtkColorTransferFunction> gray;
  gray->AddRGBPoint(37.0, 0.0, 0.0, 0.0);
  gray->AddRGBPoint(277.0, 1.0, 1.0, 1.0);
  vtkNew<vtkPiecewiseFunction> opacity;
  opacity->AddPoint(37.0, 0.2);
  opacity->AddPoint(277.0, 1.0);
  vtkNew<vtkVolume> volume;
  volume->SetMapper(mapper);
  volume->GetProperty()->SetColor(gray);
  volume->GetProperty()->SetScalarOpacity(opacity);
  volume->GetProperty()->SetInterpolationTypeToLinear();
  vtkNew<vtkRenderer> renderer;
  renderer->AddVolume(volume);
  vtkCamera* const camera = renderer->GetActiveCamera();
  camera->ParallelProjectionOn();
  camera->Azimuth(25.0);
  camera->Elevation(20.0);
  renderer->ResetCamera();
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(size, size);
  window->AddRenderer(renderer);
  window->Render();
  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetRGBACharPixelData(0, 0, size - 1, size - 1, 0, pixels);
  std::ofstream(argv[2], std::ios::binary)
    .write(reinterpret_cast<const char*>(pixels->GetPointer(0)), pixels->GetNumberOfValues());
}
