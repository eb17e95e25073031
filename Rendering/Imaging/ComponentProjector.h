// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ComponentProjector_h
#define ComponentProjector_h

#include "Cells/CellProjector.h"
#include "ComponentColors.h"
#include "Display/Warp.h"
#include "PixelProjector.h"
#include "Projection/Locations.h"
#include "Projection/Project.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstddef>
#include <optional>
#include <vector>

class vtkImageData;
class vtkVolumeProperty;

namespace splatting
{
class PieceExchange;
class ScalarSource;

/// The largest of a view's images, of which there is at least one.
std::size_t mainImage(const std::vector<ShearWarp>& images);

/// Whether two views have the same rays, in images as sharp, and from the same side if they are
/// ordered.
bool haveSameRays(const std::vector<ShearWarp>& a, const std::vector<ShearWarp>& b, bool ordered);

/**
 * From the volumes of a data set's components to one picture.
 *
 * Independent components are projected and coloured one by one, and their colours add up. Of
 * dependent ones the last, the opacity, is projected, and the others, one colour index or red,
 * green and blue, are those of the samples that win; means are taken of each.
 */
class ComponentProjector
{
public:
  /// Points the indices at the source's volumes, anew if these changed. Returns whether other times
  /// are to be expected now, because there are more voxels, larger ones or other components.
  bool SetSource(ScalarSource& source);

  /// In place of SetSource() on a rank that holds nothing of a volume of this type.
  void SetEmpty(ScalarType type, std::size_t components);

  /// As before the first volume: gives back what it holds, whatever state that is in.
  void Clear();

  /// What volumes hold, and of a piece the range of its own voxels.
  std::size_t NumberOfComponents() const { return this->Channels.size(); }
  bool AreDependent() const { return this->Dependent; }
  ScalarType VolumeType() const { return this->Channels.front().Index.volume().type; }
  const VolumeIndex::Range& RangeOfPiece(std::size_t component);

  /// From now on the volumes are pieces, of which the images are exchanged; nullptr: they are
  /// whole. Must outlive its use.
  void SetRanks(PieceExchange* ranks);

  /// What is wrong with voxels that are too large to be computed with, or nullptr.
  const char* FaultOfVoxels(Quality quality);

  /// Every component gets the same share. A change gives up what is there; returns whether it has
  /// changed.
  bool SetBudget(std::size_t bytes);
  bool ExceedsBudget() const;
  /// Bytes and seconds of all indices.
  std::size_t MemorySize() const;
  double Time() const;

  /// Tables of colours for what these settings project, anew if something changed.
  void UpdateColors(
    vtkVolumeProperty* property, const FinalColor& finalColor, const ProjectionSettings& settings);

  /// Whether scalars at or below the window are told apart: see CullBelowWindow. Needs
  /// UpdateColors().
  void SetCullBelowWindow(bool cull) { this->Cull = cull; }

  /// Whether these settings are projected by ProjectOnScreen(), not by Project().
  bool UsesCells(const ProjectionSettings& settings) const
  {
    return settings.quality == Quality::Exact && !this->TakesAtWinners(settings);
  }

  /**
   * Whether the images are those that project() would make, the viewer's side aside.
   */
  bool Shows(const ProjectionSettings& settings) const;

  /**
   * Projects all components into all images of a view, each with its cuts. False if the projector's
   * observer has stopped it: there are no images then.
   */
  bool Project(const std::vector<ShearWarp>& geometries, const ProjectionSettings& settings,
    const std::vector<Cuts>& cuts);

  /// Whether there are images.
  bool IsProjected() const { return this->Projected; }
  /// The images no longer show what they should.
  void Forget() { this->Projected = false; }

  /**
   * Projects all components onto the screen, by cells. Collective.
   * @return  false if the observer has stopped it or the view is invalid; there is no picture then
   */
  bool ProjectOnScreen(const View& view, const ProjectionSettings& settings, const RayEnds& ends);
  /// Whether the last projection was by cells. It needs no geometries.
  bool IsOnScreen() const { return this->OnScreen; }
  /// The same of one pixel of the viewport, with its depth; not of pieces. The reference is valid
  /// until the next call.
  const ScreenScalars& ProjectPixelOnScreen(
    const View& view, ProjectionSettings settings, const RayEnds& ends, const glm::ivec2& pixel);

  /// The picture of the images in a view with these geometries. False if the warper's observer has
  /// stopped it: there is no picture then.
  bool Warp(const std::vector<ShearWarp>& geometries, const View& view, Picture& picture);

  /**
   * The same as scalars, component after component of each pixel, row after row of the whole
   * viewport from the bottom.
   * @param background  of pixels without a sample
   * @param scalars     of type averageType() of the images' type
   * @return  false if the warper's observer has stopped it; the scalars are invalid then
   */
  bool WarpScalars(
    const std::vector<ShearWarp>& geometries, const View& view, double background, void* scalars);

  /// Told the share of a projection that is done; returns whether to go on.
  void SetObserver(const ProgressObserver::Callback& callback);

  /// The largest image, with all components. Its ghost array hides pixels without a sample. There
  /// must be images.
  vtkSmartPointer<vtkImageData> MakeShearImage(
    const std::vector<ShearWarp>& geometries, const ScalarSource& source) const;

  /// Whether the images tell where their samples lie: those of the component that is located, the
  /// last of dependent ones, else the first.
  bool HasWinners() const;
  /// Sets what is located: images, volume and its range, settings. There must be winners.
  void Describe(Located& located) const;

  /// See PixelProjector: not of pieces, nor of means.
  bool CanProjectPixels() const;
  /// @param settings  of the projection that is located
  const PixelProjector::Pixel& ProjectPixel(const ProjectionSettings& settings,
    const ShearPixel& pixel, const std::vector<ShearWarp>& geometries,
    const std::vector<Cuts>& cuts);

  /// Of the last projection.
  const ProjectionSettings& Settings() const { return this->Channels.front().Settings; }
  Acceleration Used() const { return this->Channels.front().Used; }

  /// From the share that is done of the projection in progress to the share of all components' and
  /// images'.
  double ShareOfAll(double done) const;

  splatting::Projector& GetProjector() { return this->Projector; }
  splatting::Warper& GetWarper() { return this->Warper; }

private:
  struct Channel
  {
    VolumeIndex Index;
    std::optional<VolumeIndex::Range> Here, Whole; // of pieces only
    ProjectionSettings Settings;
    std::vector<ShearImage> Images; // at least as many as the view has
    CellIndex Cells;
    ScreenScalars Screen;     // of projections by cells
    VolumeIndex::Range Range; // of what was projected
    Acceleration Used = Acceleration::Dense;
  };

  void FindShown(const std::vector<ShearWarp>& geometries, const View& view);
  ProjectionSettings SettingsOf(const Channel& channel, ProjectionSettings settings) const;
  bool TakesAtWinners(const ProjectionSettings& settings) const;
  const Channel& LocatedChannel() const
  {
    return this->Dependent ? this->Channels.back() : this->Channels.front();
  }
  Channel& LocatedChannel()
  {
    return this->Dependent ? this->Channels.back() : this->Channels.front();
  }
  void Exchange(const std::vector<ShearWarp>& geometries, const ProjectionSettings& settings,
    const std::vector<Cuts>& cuts);
  bool ProjectImage(
    std::size_t n, const ShearWarp& geometry, const ProjectionSettings& settings, const Cuts& cuts);
  void UpdateCells(Channel& channel, const View& view);
  bool ProjectChannel(Channel& channel, ShearImage& image, const ShearWarp& geometry,
    const ProjectionSettings& settings, const Cuts& cuts);

  std::vector<Channel> Channels = std::vector<Channel>(1);
  bool Dependent = false;
  bool Cull = false;
  bool Projected = false;
  bool OnScreen = false;
  int Done = 0;          // of the present projection's images of channels
  std::size_t Parts = 1; // images of a channel
  vtkIdType Version = 0; // of the source
  PieceExchange* Ranks = nullptr;

  ComponentColors Colors;
  splatting::Projector Projector;
  CellProjector Cells;
  PixelProjector Pixels;
  ScreenScalars PixelOnScreen;
  splatting::Warper Warper;
  Picture Layer; // of one component
  std::vector<ShearPixel> Shown;
  std::vector<unsigned char> Plane; // likewise, scalars
};
}

#endif
