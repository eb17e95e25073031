// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef MIPScene_h
#define MIPScene_h

#include "VolumeReader.h"

#include "vtkFixedPointVolumeRayCastMapper.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSplattingMIPVolumeMapper.h"
#include "vtkTextActor.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <array>
#include <string>
#include <vector>

class vtkColorTransferFunction;
class vtkTransform;

/**
 * From where the volume is seen: with all angles 0 from the patient's front, head up. Degrees.
 */
struct ViewSettings
{
  std::array<int, 2> Size = { 400, 600 };
  double Azimuth = 20.0;   // the camera goes round to the patient's left
  double Elevation = 10.0; // the camera rises
  double Roll = 0.0;       // the camera turns clockwise
  double Zoom = 1.0;       // 1: the volume's box just fits
};

/**
 * How values become colours: Window wide around Level, in Colormap.
 */
struct LookSettings
{
  double Window = 1.0;
  double Level = 0.5;
  std::string Colormap = "gray";
};

/**
 * The colours of values.
 */
vtkSmartPointer<vtkColorTransferFunction> MakeColors(const LookSettings& look);

/**
 * The camera's frame as a turn of the front view's: x to the right, y away, z up.
 */
vtkSmartPointer<vtkTransform> MakeViewTurn(const ViewSettings& view, double azimuth);

/**
 * The parallel scale with which a box, oriented as the volume is, fits into the view.
 */
double GetFittingScale(
  const double box[6], vtkMatrix4x4* orientation, const ViewSettings& view, vtkTransform* turn);

/**
 * The names that LookSettings::Colormap may have.
 */
std::vector<std::string> GetColormapNames();

/**
 * Black at the median value, white at the value that one voxel in 2000 exceeds: the maximum
 * of a ray is seldom below the one, and a few outliers do not decide the other. The whole range
 * where these two are equal. Throws a sentence if no value is finite.
 */
void ChooseWindowLevel(vtkImageData* image, double& window, double& level);

/**
 * One volume in one window under a parallel camera, drawn by either mapper.
 */
class MIPScene
{
public:
  MIPScene(
    const Volume& volume, const LookSettings& look, const ViewSettings& view, bool isOffScreen);

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

  /**
   * A picture (RGB) of the current view with a label in its corner.
   */
  vtkSmartPointer<vtkImageData> TakePicture(const std::string& label);

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

#endif
