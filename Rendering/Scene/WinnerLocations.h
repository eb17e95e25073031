// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Where the samples lie that a volume's last picture shows, in VTK's terms.
 */
#ifndef WinnerLocations_h
#define WinnerLocations_h

#include "Cells/CellProjector.h"
#include "Clipping/ClosedSurface.h"
#include "Clipping/SceneDepth.h"
#include "Display/Picture.h"
#include "Projection/Locations.h"
#include "Scene/ShownVolume.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <memory>
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
 * The locations of the last frame of each renderer. Looks at projector and cuts as the last frame
 * of all has left them. Before a frame of another renderer it copies what picks need of them.
 */
class WinnerLocations
{
public:
  WinnerLocations(const ScalarSource& source, ComponentProjector& projector, SceneCuts& cuts,
    const std::vector<ShearWarp>& images)
    : Source(source),
      Projector(projector),
      SceneCuts(cuts),
      Images(images)
  {
  }

  /// Forgets all frames.
  void Forget();
  /// To be called before a frame of a renderer, whose last one is no longer shown.
  void BeginFrame(vtkRenderer* renderer);
  /// Remembers how this frame has seen the volume.
  void Remember(const View& view, const VolumeGrid& grid, vtkVolume* volume, vtkRenderer* renderer);

  /// What a pixel of the window of the last frame shows: point of the world, voxel and value. False
  /// if no picture has a sample there that is still shown and whose voxels exist. Without winners,
  /// looks along rays.
  struct Sample
  {
    glm::dvec3 position;
    glm::ivec3 voxel;
    double value;
  };
  bool Pick(int x, int y, Sample& sample);
  /// See makeLocationImage(), of the last frame, its extent in pixels of the window; nullptr before
  /// the first frame, and if the picture is no longer shown or its voxels are gone.
  vtkImageData* Image();

  /// Gives each pixel of a picture its depth's colour, as bright as the picture is.
  void ColorByDepth(Picture& picture, vtkScalarsToColors* colors, const double range[2]);
  /// For each pixel of a picture its depth, 0 to 1, if it is at least this opaque and has a sample;
  /// else 2.
  const std::vector<float>& ClipDepths(const Picture& picture, double opacity);

private:
  /// The last frame of a renderer.
  struct Frame
  {
    ShownVolume shown;
    vtkIdType version = 0; // of the source
    Located located;
    int left = 0, bottom = 0;
    bool onScreen = false; // whether the projection was by cells
    RayEnds ends;          // of those
    const std::vector<Cuts>* projectionCuts = nullptr;
    bool canProject = false;
    // What the members above point at, once it is copied.
    std::vector<ShearImage> images;
    std::vector<ShearWarp> geometries;
    std::vector<Cuts> cuts;
    ScreenScalars screen;
    ClosedSurface surface;
    SceneDepth depth;

    void Copy();
  };

  Frame& FrameOf(vtkRenderer* renderer);
  const Frame* Last() const { return this->HasLast ? this->Frames.front().get() : nullptr; }
  bool HasWinners() const;
  bool IsIntact(const Frame& frame) const;
  bool PickFrame(const Frame& frame, const glm::ivec2& pixel, Sample& sample);
  bool HasSample(const Frame& frame, const ShearPixel& pixel);
  bool PickRay(const Frame& frame, const glm::ivec2& pixel, Sample& sample);
  bool PickOnScreen(const Frame& frame, const glm::ivec2& pixel, Sample& sample);

  const ScalarSource& Source;
  ComponentProjector& Projector;
  splatting::SceneCuts& SceneCuts;
  const std::vector<ShearWarp>& Images;
  std::vector<std::unique_ptr<Frame>> Frames; // the last one first
  bool HasLast = false;                       // whether projector and cuts are of the first
  std::vector<float> Depths;
  vtkSmartPointer<vtkImageData> Output;
};
}

#endif
