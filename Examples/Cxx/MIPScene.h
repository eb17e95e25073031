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
 * Throws a sentence where a window cannot be opened; X would end the program.
 */
void CheckDisplay();

/**
 * One volume in one window under a parallel camera, drawn by either mapper.
 */
class MIPScene
{
public:
  MIPScene(const Volume& volume, const ProjectionSettings& settings, const LookSettings& look,
    const ViewSettings& view, bool isOffScreen);

  vtkRenderWindow* GetWindow() { return this->Window; }
  vtkSplattingMIPVolumeMapper* GetSplatting() { return this->Splatting; }

  /**
   * Draw with vtkSplattingMIPVolumeMapper in one of its QualityModes, ...
   */
  void UseSplatting(int qualityMode);

  /**
   * ... or with vtkFixedPointVolumeRayCastMapper, one sample per voxel, the value between the
   * voxels by VTK_NEAREST_INTERPOLATION or VTK_LINEAR_INTERPOLATION.
   */
  void UseRayCasting(int interpolation);

  /**
   * The median time of a whole frame in milliseconds: NumberOfTimedFrames calls of Render() after
   * one that warms up, each seen from one degree further, because nothing need be done again for an
   * unchanged view. What says in the progress line what is measured.
   */
  double MeasureFrame(const std::string& what);
  static const int NumberOfTimedFrames = 7;

  void SetLabel(const std::string& label);

private:
  void FitCamera(double azimuth);

  ViewSettings View;
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
