// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Sample positions of a volume's last picture, in VTK's terms.
 */
#ifndef SampleLocations_h
#define SampleLocations_h

#include "Cells/CellScreen.h"
#include "Clipping/ClosedSurface.h"
#include "Clipping/SceneDepth.h"
#include "Display/Locations.h"
#include "Display/Picture.h"
#include "Locations/ShownVolume.h"

#include "vtkSmartPointer.h"
#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"

#include <memory>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkImageData;
class vtkRenderer;
class vtkScalarsToColors;
class vtkVolume;
VTK_ABI_NAMESPACE_END

namespace splatting
{
class ComponentProjector;
class ScalarSource;
class SceneCuts;
struct VolumeGrid;

/**
 * Makes an image with the arrays "Voxel" (three ints, -1 for none), "Depth" (float, NaN for none)
 * and "Position" (three doubles, NaN for none). Its first pixel is the viewport's lower left one.
 * Independent of OpenGL.
 *
 * @param locator  nullptr: there are no samples
 */
vtkSmartPointer<vtkImageData> makeLocationImage(const Locator* locator, const int extent[6]);

/**
 * 256 colours, from the nearest to the farthest depth: those of a look-up table or transfer
 * function over its range, or by default the hues from red over green to blue.
 */
std::vector<glm::dvec3> depthColors(vtkScalarsToColors* colors);

/**
 * Sample positions of the last frame of each renderer. Uses projector and cuts as the last frame
 * left them. Before a frame of another renderer it copies the data that picks need.
 */
class SampleLocations
{
public:
  SampleLocations(const ScalarSource& source, ComponentProjector& projector, SceneCuts& cuts)
    : Source(source),
      Projector(projector),
      SceneCuts(cuts)
  {
  }

  /// Removes all frames.
  void Forget();
  /// Call it before a frame of a renderer, whose last frame is then no longer shown.
  void BeginFrame(vtkRenderer* renderer);
  /// Stores how this frame views the volume.
  void Remember(const View& view, const VolumeGrid& grid, vtkVolume* volume, vtkRenderer* renderer);

  /// The sample of a pixel of the last frame's window. Pick() searches the pictures that are still
  /// shown and whose voxels exist. It returns false if none has a sample at this pixel. Without
  /// winners it projects the pixel.
  struct Sample
  {
    glm::dvec3 position;
    glm::ivec3 voxel;
    double value;
  };
  bool Pick(int x, int y, Sample& sample);
  /// See makeLocationImage(): the last frame, in pixels of the window. nullptr before the first
  /// frame, and if the picture is no longer shown or its voxels are gone.
  vtkImageData* Image();

  /// The view of the last frame, after Remember().
  const View& LastView() const { return this->Last()->located.view; }
  /// Gives each pixel of a picture the colour of its depth, with its brightness.
  void ColorByDepth(Picture& picture, vtkScalarsToColors* colors, const double range[2]);
  /// The voxels, i, j and k, of a picture's samples; -1 for pixels without a visible sample.
  std::vector<int> VoxelsOf(const Picture& picture) const;
  /// The depth, 0 to 1, of each pixel of a picture with at least this opacity and a sample; 2 for
  /// other pixels.
  const std::vector<float>& ClipDepths(const Picture& picture, double opacity);

private:
  /// The last frame of a renderer.
  struct Frame
  {
    ShownVolume shown;
    vtkIdType version = 0; // of the source
    Located located;
    int left = 0, bottom = 0;
    bool hasWinners = false;
    bool canProject = false;
    // Owners of the data above, after Copy().
    std::vector<ShearImage> images;
    std::vector<ShearWarp> geometries;
    std::vector<Cuts> cuts;
    CellScreen screen;
    ClosedSurface surface;
    SceneDepth depth;

    void Copy();
  };

  Frame& FrameOf(vtkRenderer* renderer);
  const Frame* Last() const { return this->HasLast ? this->Frames.front().get() : nullptr; }
  bool HasWinners() const { return this->Last() && this->Last()->hasWinners; }
  bool IsIntact(const Frame& frame) const;
  bool PickFrame(const Frame& frame, const glm::ivec2& pixel, Sample& sample);

  const ScalarSource& Source;
  ComponentProjector& Projector;
  splatting::SceneCuts& SceneCuts;
  std::vector<std::unique_ptr<Frame>> Frames; // the last frame first
  bool HasLast = false; // whether projector and cuts belong to the first frame
  std::vector<float> Depths;
  vtkSmartPointer<vtkImageData> Output;
};
}

#endif
