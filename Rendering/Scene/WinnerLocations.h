// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where the samples lie that a volume's last picture shows, in VTK's terms.
 */
#ifndef WinnerLocations_h
#define WinnerLocations_h

#include "Display/Picture.h"
#include "Projection/Locations.h"
#include "Scene/ShownVolume.h"

#include "vtkSmartPointer.h"

#include <cstdint>
#include <vector>

class vtkImageData;
class vtkRenderer;
class vtkScalarsToColors;
class vtkVolume;

namespace splatting
{
class ComponentProjector;
class ScalarSource;
class SceneCuts;
struct VolumeGrid;

/**
 * Arrays "Voxel" (three ints, -1 for none), "Depth" (float, NaN for none) and "Position" (three
 * doubles, NaN for none) for the pixels of a viewport, as an image with this extent, whose first
 * pixel is the viewport's lower left one. Free of OpenGL.
 *
 * @param locator  nullptr: there are no samples
 */
vtkSmartPointer<vtkImageData> makeLocationImage(const Locator* locator, const int extent[6]);

/**
 * 256 colours, from the nearest to the farthest depth: those of a look-up table or transfer
 * function over its range, or, without one, the hues from red over green to blue.
 */
std::vector<glm::dvec3> depthColors(vtkScalarsToColors* colors);

/**
 * The locations of one frame. Looks at projector and cuts as that frame has left them.
 */
class WinnerLocations
{
public:
  WinnerLocations(const ScalarSource& source, ComponentProjector& projector, const SceneCuts& cuts,
    const std::vector<ShearWarp>& images)
    : Source(source),
      Projector(projector),
      Cuts(cuts),
      Images(images)
  {
  }

  /// Forgets the frame: nothing has been rendered.
  void Forget();
  /// Remembers how a frame has seen the volume.
  void Remember(const View& view, const VolumeGrid& grid, vtkVolume* volume, vtkRenderer* renderer);

  /// What a pixel of the window shows: point of the world, voxel and value. False if the picture
  /// has no sample there, is no longer shown or its voxels are gone. Without winners, looks along
  /// rays.
  struct Sample
  {
    glm::dvec3 position;
    glm::ivec3 voxel;
    double value;
  };
  bool Pick(int x, int y, Sample& sample);
  /// See makeLocationImage(), its extent in pixels of the window; nullptr before the first frame,
  /// and if the picture is no longer shown or its voxels are gone.
  vtkImageData* Image();

  /// Gives each pixel of a picture its depth's colour, as bright as the picture is.
  void ColorByDepth(Picture& picture, vtkScalarsToColors* colors, const double range[2]);
  /// For each pixel of a picture its depth, 0 to 1, if it is at least this opaque and has a sample;
  /// else 2.
  const std::vector<float>& ClipDepths(const Picture& picture, double opacity);

private:
  bool HasWinners() const;
  Located Describe() const;
  Locator Locate() const;
  bool HasSample(const ShearImage& image, const ShearPixel& pixel);
  bool PickRay(const glm::ivec2& pixel, Sample& sample);

  const ScalarSource& Source;
  ComponentProjector& Projector;
  const SceneCuts& Cuts;
  const std::vector<ShearWarp>& Images;
  Located Frame; // but for what the projector knows
  int Left = 0, Bottom = 0;
  ShownVolume Shown;
  bool Known = false;
  std::vector<float> Depths;
  vtkSmartPointer<vtkImageData> Output;
};
}

#endif
