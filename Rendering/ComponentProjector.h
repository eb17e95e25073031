// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ComponentProjector_h
#define ComponentProjector_h

#include "Project.h"
#include "TransferFunctions.h"
#include "Warp.h"

#include "vtkType.h"

#include <cstddef>
#include <optional>
#include <vector>

class RankAgreement;
struct RankReport;
class ScalarSource;
class vtkImageData;
class vtkVolumeProperty;

/**
 * From the volumes of a data set's components to one picture.
 *
 * Independent components are projected and coloured one by one, and their colours add up. Of
 * dependent ones the last, the opacity, is projected, and the others, one colour index or red,
 * green and blue, are carried along with the samples that win; means are taken of each.
 */
class ComponentProjector
{
public:
  /// Points the indices at the source's volumes, anew if these changed. Returns whether other times
  /// are to be expected now, because there are more voxels, larger ones or other components.
  bool LookAt(ScalarSource& source);

  /// In place of LookAt() on a rank that holds nothing of a volume of this type.
  void LookAtNothing(splatting::ScalarType type, std::size_t components);

  /// Adds the scalars of a piece to what its rank reports.
  void Describe(const ScalarSource& source, RankReport& report);

  /// From now on the volumes are pieces, of which the images are exchanged; nullptr: they are
  /// whole. Must outlive its use.
  void SetRanks(RankAgreement* ranks);

  /// Every component gets the same share. A change gives up what is there; returns whether it is
  /// one.
  bool SetBudget(std::size_t bytes);
  bool ExceedsBudget() const;
  /// Bytes and seconds of all indices.
  std::size_t MemorySize() const;
  double Time() const;

  /// Tables of colours for what these settings project, anew if something changed.
  void UpdateColors(vtkVolumeProperty* property, const FinalColor& finalColor,
    const splatting::ProjectionSettings& settings);

  /// Values at or below the window are not told apart; needs the colours.
  void SetCullBelowWindow(bool cull) { this->Cull = cull; }

  /**
   * Whether the images are those that project() would make, the viewer's side aside.
   */
  bool Shows(const splatting::ProjectionSettings& settings) const;

  /**
   * Projects all components into all images of a view, each with its cuts. False if the projector's
   * watch has stopped it: there are no images then.
   */
  bool Project(const std::vector<splatting::ShearWarp>& geometries,
    const splatting::ProjectionSettings& settings, const std::vector<splatting::Cuts>& cuts);

  /// Whether there are images.
  bool IsProjected() const { return this->Projected; }
  /// The images no longer show what they should.
  void Forget() { this->Projected = false; }

  /// The picture of the images in a view with these geometries.
  void Warp(const std::vector<splatting::ShearWarp>& geometries, const splatting::View& view,
    splatting::Picture& picture);

  /// One image of all components as one with as many components, and which pixels have no sample in
  /// its ghost array.
  void CopyImage(
    std::size_t n, const splatting::ShearWarp& geometry, int vtkType, vtkImageData* output) const;

  /// Of the last projection.
  const splatting::ProjectionSettings& Settings() const { return this->Channels.front().Settings; }
  splatting::Acceleration Used() const { return this->Channels.front().Used; }
  splatting::ScalarType ImageType() const { return this->Channels.front().Images.front().type; }

  /// Part of all components that the projection of one is, from the share of that.
  double ShareOfAll(double done) const;

  splatting::Projector& GetProjector() { return this->Projector; }

private:
  struct Channel
  {
    splatting::VolumeIndex Index;
    std::optional<splatting::VolumeIndex::Range> Here, Whole; // of pieces only
    splatting::ColorTable Colors;
    splatting::ProjectionSettings Settings;
    std::vector<splatting::ShearImage> Images; // at least as many as the view has
    splatting::Acceleration Used = splatting::Acceleration::Dense;

    double FloorOfWindow() const;
  };

  splatting::ProjectionSettings SettingsOf(
    const Channel& channel, splatting::ProjectionSettings settings) const;
  bool Carries(const splatting::ProjectionSettings& settings) const;
  void Exchange(const std::vector<splatting::ShearWarp>& geometries,
    const splatting::ProjectionSettings& settings, const std::vector<splatting::Cuts>& cuts);
  bool ProjectImage(std::size_t n, const splatting::ShearWarp& geometry,
    const splatting::ProjectionSettings& settings, const splatting::Cuts& cuts);
  bool ProjectChannel(Channel& channel, std::size_t n, const splatting::ShearWarp& geometry,
    const splatting::ProjectionSettings& settings, const splatting::Cuts& cuts);
  ScalarRange RangeOf(Channel& channel) const;
  splatting::ColorTable ColorsOf(
    int channel, vtkVolumeProperty* property, const FinalColor& finalColor);

  std::vector<Channel> Channels = std::vector<Channel>(1);
  bool Dependent = false;
  bool Cull = false;
  bool Projected = false;
  int Done = 0;           // of the present projection's images of channels
  std::size_t Images = 1; // of a channel
  vtkIdType Version = 0;  // of the source
  RankAgreement* Ranks = nullptr;

  vtkVolumeProperty* ColoredBy = nullptr; // only compared
  vtkMTimeType ColorTime = 0;
  FinalColor ColoredFor;
  double Shading[2] = { 0.0, 1.0 }; // of all samples, the least and the greatest factor
  bool Colored = false;

  splatting::Projector Projector;
  splatting::Warper Warper;
  splatting::Picture Layer; // of one component
};

#endif
