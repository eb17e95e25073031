// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    Stage.h
 * @brief   what the rendering tests share: a window with one volume, its pixels, and the ray
 *          casters that it is compared with
 */
#ifndef Stage_h
#define Stage_h

#include "Checks.h"
#include "ImageComparison.h"
#include "Projection.h"
#include "RandomImage.h"
#include "Scenes.h"
#include "Volume.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

class vtkFixedPointVolumeRayCastMapper;
class vtkGPUVolumeRayCastMapper;
class vtkImageData;
class vtkObject;
class vtkRenderer;
class vtkRenderWindow;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;
class vtkVolumeMapper;
class vtkVolumeProperty;

namespace stage
{

using Vector = std::array<double, 3>;
using Pixels = std::vector<unsigned char>;

/**
 * The warnings or errors of an object, which are not printed while this lives.
 */
class Messages
{
public:
  /**
   * The event is vtkCommand::WarningEvent or ErrorEvent.
   */
  Messages(vtkObject* object, unsigned long event);
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  std::vector<std::string> texts;

private:
  vtkSmartPointer<vtkObject> Object;
  unsigned long Tag;
};

/**
 * Whether a message is a sentence, without the line feeds that vtkErrorMacro adds.
 */
inline bool isSentence(std::string text)
{
  text.erase(text.find_last_not_of(" \n") + 1);
  return !text.empty() && text.back() == '.';
}

/**
 * An off-screen window, a renderer with a black background that fills it and a volume whose colours
 * are a gray ramp without transparency.
 */
class Stage
{
public:
  Stage(int width, int height);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  void show(vtkVolumeMapper* mapper);
  void setGrayRamp(double black, double white);
  /**
   * Looks along the direction at the middle of the volume's bounds, where the height of the window
   * is the scale times their diagonal: with a parallel projection from far enough, or in
   * perspective if viewAngle is above 0.
   */
  void look(const Vector& direction, const Vector& up, double scale = 1.0);

  /**
   * Render and take the picture: three bytes a pixel, bottom row first.
   */
  Pixels pixels();
  /**
   * The same as gray values from 0 to 255: the red component.
   */
  reference::Image<double> gray();

  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  vtkNew<vtkVolume> volume;
  vtkNew<vtkVolumeProperty> property;
  /// Of the views that look() sets, in degrees.
  double viewAngle = 0.0;

private:
  int Width;
  int Height;
};

/**
 * Of length 1, and anywhere.
 */
Vector anyDirection(reference::Random& random);

/**
 * A copy of a volume of bytes, spacing 1, origin 0, first voxel 0.
 */
vtkSmartPointer<vtkImageData> toImageData(const reference::Volume<std::uint8_t>& volume);

/// Sets which samples of an image's rays a mapper takes, and which of them counts: maximum type,
/// slab and cropping.
void chooseSamples(
  vtkSplattingMIPVolumeMapper* mapper, vtkImageData* image, reference::Random& random);

/**
 * Blobs and tubes with soft rims and values up to 255 at random places, without symmetry, and
 * nothing within 5 voxels of the border, so that it does not matter where rays end. At least 32
 * voxels along each axis.
 */
reference::Volume<std::uint8_t> blobsAndTubes(
  const std::array<int, 3>& size, int count, reference::Random& random);
/// From 4 to 16 of them, in a volume of 32 to 52 voxels along each axis.
reference::Volume<std::uint8_t> anyBlobs(reference::Random& random);
/**
 * The same ones whatever SPLATTINGMIP_TEST_SEED is, for tests that know what their pictures look
 * like.
 */
reference::Volume<std::uint8_t> blobsAndTubes(const std::array<int, 3>& size, int count);

vtkSmartPointer<vtkSplattingMIPVolumeMapper> splatting(vtkImageData* image);
/**
 * A MIP by vtkFixedPointVolumeRayCastMapper, one ray a pixel; the distance is in world units.
 */
vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> fixedPointRayCaster(
  vtkImageData* image, double sampleDistance);
/**
 * A MIP by vtkGPUVolumeRayCastMapper, one ray a pixel; the distance is in world units.
 */
vtkSmartPointer<vtkGPUVolumeRayCastMapper> gpuRayCaster(vtkImageData* image, double sampleDistance);

/**
 * How alike two gray pictures are.
 */
struct Likeness
{
  double psnr;
  double ssim;
  reference::Shift shift;

  Likeness(const reference::Image<double>& truth, const reference::Image<double>& picture);
  /**
   * The larger of the two components of the shift, in pixels.
   */
  double largestShift() const;
  std::string text() const;
};

/**
 * What a test was called with after the option, or nothing.
 */
std::string argument(int argc, char* argv[], const std::string& option);

} // namespace stage

#endif
