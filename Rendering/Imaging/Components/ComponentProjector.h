// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ComponentProjector_h
#define ComponentProjector_h

#include "Cells/CellProjector.h"
#include "Clipping/SceneDepth.h"
#include "Components/ComponentColors.h"
#include "Components/PixelProjector.h"
#include "Display/Locations.h"
#include "Splat/Projection/Project.h"
#include "Splat/Projection/SplatView.h"
#include "Splat/Warp/Warp.h"

#include "vtkImageData.h"
#include "vtkSmartPointer.h"
#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkVolumeProperty;
VTK_ABI_NAMESPACE_END

namespace splatting
{
class PieceExchange;
class ScalarSource;

/**
 * Projects the components of a data set and combines them to one picture.
 *
 * Independent components are projected and coloured one by one, and their colours are added. Of
 * dependent components the last one, the opacity, is projected. The others, a colour index or red,
 * green and blue, are taken from the same samples. Averages are taken of each component.
 */
class ComponentProjector
{
public:
  /// Sets the source's volumes. Returns whether projection times will differ, because the number of
  /// voxels, their type or the number of components has changed.
  bool SetSource(ScalarSource& source);

  /// Replaces SetSource() on a rank without voxels, for a volume of this type.
  void SetEmpty(ScalarType type, std::size_t components);

  /// Releases all memory, also in an invalid state.
  void Clear();

  /// Number, kind and type of the components; the range of a piece's own voxels.
  std::size_t NumberOfComponents() const { return this->Channels.size(); }
  bool AreDependent() const { return this->Dependent; }
  ScalarType VolumeType() const { return this->Channels.front().Index.volume().type; }
  const VolumeIndex::Range& RangeOfPiece(std::size_t component);

  /// Sets the interface to the other ranks, if the volumes are pieces; nullptr: they are whole. The
  /// interface must exist while it is used.
  void SetRanks(PieceExchange* ranks);

  /// An error message if voxels are too large for the arithmetic, or nullptr.
  const char* ValidateVoxels(Quality quality);

  /// Sets the memory budget, which the components share equally. A change discards all indices.
  /// Returns whether it has changed.
  bool SetBudget(std::size_t bytes);
  bool ExceedsBudget() const;
  /// Bytes and seconds of all indices.
  std::size_t MemorySize() const;
  double Time() const;

  /// Updates the colour tables for these settings.
  void UpdateColors(
    vtkVolumeProperty* property, const FinalColor& finalColor, const ProjectionSettings& settings);

  /// Sets whether scalars below the window are clamped; see CullBelowWindow. Needs UpdateColors().
  void SetCullBelowWindow(bool cull) { this->Cull = cull; }

  /**
   * Projects all components by the engine for the settings, unless the last projection shows the
   * view. If the observer stops it, there is no projection. Collective.
   * @param shown   settings: if the last projection has these, it is kept
   * @param wanted  settings of a new projection
   * @return  false if the view is invalid
   */
  bool Project(const View& view, const ProjectionSettings& shown, const ProjectionSettings& wanted,
    const RayEnds& ends);

  /// Whether there is a projection.
  bool IsProjected() const { return this->Projected; }
  /// Marks the projection as outdated.
  void Forget() { this->Projected = false; }
  /// How often Project() has projected.
  vtkIdType NumberOfProjections() const { return this->Projections; }

  /// Makes the picture of a view. Returns false, without a picture, if the observer has stopped it.
  bool MakePicture(const View& view, Picture& picture);

  /**
   * Copies scalars instead of colours: all components of each pixel, row by row of the whole
   * viewport from the bottom.
   * @param background  the value of pixels without a sample
   * @param scalars     of type averageType() of the images' type
   * @return  false, with invalid scalars, if the observer has stopped it
   */
  bool CopyScalars(const View& view, double background, void* scalars);
  /// Sets the function that returns whether to continue these two; see WarpedScalars.
  void SetScreenObserver(const ProgressObserver::Callback& callback)
  {
    this->Warped.setObserver(callback);
  }

  /// Sets the function that gets the completed share of a projection and returns whether to
  /// continue.
  void SetObserver(const ProgressObserver::Callback& callback);

  /// The geometry of the largest shear image; nullptr if there is none.
  const ShearWarp* MainImage() const { return this->Projected ? this->Splat.main() : nullptr; }
  /// The largest shear image, with all components; nullptr if there is none. Its ghost array hides
  /// pixels without a sample.
  vtkImageData* ShearImageOf(const ScalarSource& source);

  /// Whether there are sample positions of the located component: the last of dependent ones, else
  /// the first.
  bool HasWinners() const;
  /// Sets the located component's projection, volume, range and settings.
  /// @param ends  of the last Project()
  void Describe(const RayEnds& ends, Located& located) const;

  /// Whether FindSample() works: not for pieces and averages.
  bool CanProjectPixels() const;
  /// Projects a pixel of the viewport again and finds its sample; see PixelProjector.
  Locator::Sample FindSample(const Located& located, const glm::ivec2& pixel);

  /// Settings and acceleration of the last projection.
  const ProjectionSettings& Settings() const { return this->Channels.front().Settings; }
  Acceleration Used() const { return this->Channels.front().Used; }

  /// Converts the completed share of the current projection to that of all components and images.
  double OverallProgress(double done) const;

  splatting::Projector& GetProjector() { return this->Projector; }

private:
  struct Channel
  {
    VolumeIndex Index;
    std::optional<VolumeIndex::Range> Here, Whole; // of pieces only
    ProjectionSettings Settings;
    std::vector<ShearImage> Images; // at least as many as the view has
    CellIndex Cells;
    CellScreen Screen;        // of projections by cells
    VolumeIndex::Range Range; // of the projected volume
    Acceleration Used = Acceleration::Dense;
  };

  /// Calls f(component, scalars). Returns false if the observer has stopped it.
  template <class F>
  bool ForScreens(const View& view, const F& f);
  ProjectionSettings SettingsOf(const Channel& channel, ProjectionSettings settings) const;
  bool TakesAtLocations(const ProjectionSettings& settings) const;
  const Channel& LocatedChannel() const
  {
    return this->Dependent ? this->Channels.back() : this->Channels.front();
  }
  Channel& LocatedChannel()
  {
    return this->Dependent ? this->Channels.back() : this->Channels.front();
  }
  bool UsesCells(const ProjectionSettings& settings) const
  {
    return settings.quality == Quality::Exact && !this->TakesAtLocations(settings);
  }
  bool IsUpToDate(const ProjectionSettings& settings) const;
  bool ShowsCells(const View& view, const RayEnds& ends) const;
  bool ProjectCells(const View& view, const ProjectionSettings& settings, const RayEnds& ends);
  bool ProjectImages(const ProjectionSettings& settings);
  bool ProjectImage(std::size_t n, const ProjectionSettings& settings);
  void Exchange(const ProjectionSettings& settings);
  void UpdateCells(Channel& channel, const View& view);
  bool ProjectChannel(Channel& channel, std::size_t n, const ProjectionSettings& settings,
    const std::vector<AtSamples>& others);

  std::vector<Channel> Channels = std::vector<Channel>(1);
  bool Dependent = false;
  bool Cull = false;
  bool Projected = false;
  bool OnScreen = false;
  int Done = 0;          // completed images of components
  std::size_t Parts = 1; // images of a component
  vtkIdType Projections = 0;
  SplatView Splat; // of the last projection; none if it was by cells
  SplatView Next;  // of the next one
  View CellView;   // of the last projection by cells, and what ended its rays
  SceneDepth CellDepth;
  std::int64_t CellSurface = 0;
  vtkIdType Version = 0; // of the source
  PieceExchange* Ranks = nullptr;

  ComponentColors Colors;
  splatting::Projector Projector;
  CellProjector Cells;
  PixelProjector Pixels;
  WarpedScalars Warped;
  Picture Layer; // picture of one component
  ShearPixelScalars Shown;
  std::vector<AtSamples> Others;    // dependent components except the last; reused by frames
  std::vector<unsigned char> Plane; // scalars of one component
  vtkSmartPointer<vtkImageData> ShearImageOutput;
};
}

#endif
