// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A program outside this tree, without OpenGL: projects a field and looks for its maximum.
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkSampleFunction.h>
#include <vtkSphere.h>
#include <vtkSplattingMIPProjection.h>

#include <cstdlib>
#include <iostream>

int main()
{
  vtkNew<vtkSphere> sphere;
  sphere->SetRadius(0.5);
  vtkNew<vtkSampleFunction> source; // 2.75 in the corners of the cube from -1 to 1
  source->SetImplicitFunction(sphere);
  source->SetSampleDimensions(41, 41, 41);
  source->ComputeNormalsOff();
  vtkNew<vtkSplattingMIPProjection> projection;
  projection->SetInputConnection(source->GetOutputPort());
  projection->SetOutputSize(41, 41);
  projection->SetOutputSpacing(0.05, 0.05);
  projection->SetQualityModeToPreview();
  projection->SetNumberOfViews(2);
  projection->Update();
  const double* const range = projection->GetOutput()->GetScalarRange();
  std::cout << projection->GetClassName() << " from " << range[0] << " to " << range[1]
            << std::endl;
  return range[0] > 0.7 && range[1] > 2.7 && range[1] < 2.8 ? EXIT_SUCCESS : EXIT_FAILURE;
}
