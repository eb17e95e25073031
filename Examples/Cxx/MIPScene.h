// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef MIPScene_h
#define MIPScene_h

#include "Look.h"
#include "Projector.h"
#include "Reading/VolumeReader.h"
#include "View.h"

#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSplattingMIPVolumeMapper.h"
#include "vtkTextActor.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <string>

/**
 * Throw std::runtime_error if no window can be opened; X would end the program.
 */
void CheckDisplay();

/**
 * One volume in one window, drawn by either mapper.
 */
class MIPScene
{
public:
  MIPScene(const Volume& volume, const ProjectionSettings& settings, const LookSettings& look,
    const ViewSettings& view, bool isOffScreen);

  vtkRenderWindow* GetWindow() { return this->Window; }
  vtkSplattingMIPVolumeMapper* GetSplatting() { return this->Splatting; }

  /**
   * Use vtkSplattingMIPVolumeMapper in one of its QualityModes.
   */
  void UseSplatting(int qualityMode);

  /**
   * Use vtkFixedPointVolumeRayCastMapper with one sample per voxel, interpolated by
   * VTK_NEAREST_INTERPOLATION or VTK_LINEAR_INTERPOLATION.
   */
  void UseRayCasting(int interpolation);

  /**
   * Measure the median time of a whole frame in milliseconds. Calls Render() once to warm up, then
   * NumberOfTimedFrames times, each view turned by one degree, because an unchanged view is not
   * projected again. The text names the measurement in the progress line.
   */
  double MeasureFrame(const std::string& what);
  static const int NumberOfTimedFrames = 7;

  void SetLabel(const std::string& label);

private:
  void FitCamera(double azimuth);

  ViewSettings View;
  vtkSmartPointer<vtkImageData> Image;
  vtkNew<vtkSplattingMIPVolumeMapper> Splatting;
  vtkNew<vtkFixedPointVolumeRayCastMapper> RayCasting;
  vtkNew<vtkVolumeProperty> Property;
  vtkNew<vtkVolume> Prop;
  vtkNew<vtkTextActor> Label;
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
};

/**
 * Format milliseconds with as many digits as are significant.
 */
std::string FormatTime(double milliseconds);

#endif
