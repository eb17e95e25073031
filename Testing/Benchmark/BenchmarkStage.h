// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkStage_h
#define BenchmarkStage_h

#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"
#include "vtkVolumeMapper.h"
#include "vtkVolumeProperty.h"

#include <string>
#include <vector>

class vtkImageData;

/**
 * Who draws the volume.
 */
struct BenchmarkMapper
{
  enum Kinds
  {
    SPLATTING,
    CPU_RAY_CASTING,
    GPU_RAY_CASTING
  };

  std::string Name;
  Kinds Kind;
  int QualityMode;   // of the splatting mapper
  int Interpolation; // of the ray casters
};

/**
 * preview, standard, high, exact; raycast-nearest, raycast-linear; gpu.
 */
const std::vector<BenchmarkMapper>& GetBenchmarkMappers();

/**
 * The window, the camera and the volume's look, the same for all mappers: off screen, no
 * multisampling, grey from the least to the largest scalar, opaque, orthographic, and zoomed so
 * that the volume fills the window. There is one for the whole program, so that no first frame
 * includes the opening of a window.
 */
class BenchmarkStage
{
public:
  /**
   * Ends the program if there is no display.
   */
  static BenchmarkStage& GetInstance();

  /**
   * What OpenGL calls the device that it renders with.
   */
  std::string GetDeviceName();

  void SetSize(int pixels);

  /**
   * A fresh mapper for the image, as if the image were new: what VTK remembers of it (the range of
   * its scalars) is forgotten. One sample per voxel and pixel, no jittering, no adjustment of
   * sampling distances to the time.
   */
  void SetMapper(const BenchmarkMapper& mapper, vtkImageData* image);

  /**
   * No volume; the mapper's memory is returned.
   */
  void Clear();

  vtkVolumeMapper* GetMapper() { return this->Mapper; }

  /**
   * The views make two full turns, in 18 steps of 20 degrees each: around the vertical axis, the
   * camera raised by 7 degrees, and around the horizontal one, the camera 7 degrees aside. So all
   * three principal axes occur, the volume is sheared in both directions, and no two views are
   * opposite: their maxima would be the same, and the splatting mapper knows.
   */
  static const int NumberOfViews = 36;

  /**
   * Three views with principal axes 0, 1 and 2.
   */
  static const int ViewsOfAxes[3];

  /**
   * Perspective views with this view angle in degrees, or parallel ones (0, the default). In both
   * the volume is half as large again as when its bounding sphere fits the window.
   */
  void SetViewAngle(double degrees) { this->ViewAngle = degrees; }
  double GetViewAngle() const { return this->ViewAngle; }

  void LookFrom(int view);

  /**
   * Another window and level: white from this share of the range of scalars on. A fresh mapper has
   * 1.
   */
  void SetWhite(double share);

  /**
   * Draws, and reads the picture back. Seconds.
   */
  double MeasureFrame();

  /**
   * Whether the last frame was black.
   */
  bool IsFrameEmpty();

  /**
   * Whether the machine can draw with that mapper.
   */
  bool IsSupported(const BenchmarkMapper& mapper);

private:
  BenchmarkStage();

  double ViewAngle = 0.0;
  double Range[2] = { 0.0, 1.0 }; // of the image's scalars
  vtkNew<vtkVolumeProperty> Property;
  vtkNew<vtkVolume> Prop;
  vtkNew<vtkRenderer> Renderer;
  vtkNew<vtkRenderWindow> Window;
  vtkNew<vtkUnsignedCharArray> Pixels;
  vtkSmartPointer<vtkVolumeMapper> Mapper;
};

#endif
