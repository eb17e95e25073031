// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ProjectedVolume_h
#define ProjectedVolume_h

#include "Common/RenderTimes.h"
#include "ComponentProjector.h"
#include "Input/ScalarSource.h"
#include "Ranks/RankAgreement.h"
#include "Scene/SceneCuts.h"

#include "vtkSmartPointer.h"

#include <vector>

class vtkImageData;
class vtkRenderer;
class vtkSplattingMIPVolumeMapper;
class vtkVolume;

namespace splatting
{
/**
 * A mapper's data, and the shear images of its last frame: which of them the next one can show
 * again, and in which quality mode the others are projected.
 */
class ProjectedVolume
{
public:
  RankAgreement Ranks;
  ScalarSource Source;
  ComponentProjector Components;
  SceneCuts Cuts;
  std::vector<ShearWarp> Images;

  /// Where the voxels lie, of several ranks those of the whole.
  const VolumeGrid& Grid() const
  {
    return this->Ranks.AreMany() ? this->Ranks.Grid() : this->Source.Grid();
  }

  /// To be called before and after a frame is rendered, which took so many seconds.
  void BeginFrame();
  void EndFrame(vtkRenderer* renderer, vtkVolume* volume, double seconds);

  /// The components are others, from which other times are to be expected.
  void ForgetTimes() { this->Times.clear(); }

  /// Makes indices and colours of data that can be projected.
  void Prepare(vtkSplattingMIPVolumeMapper* mapper, const View& view, vtkVolume* volume,
    const FinalColor& finalColor);

  /**
   * Projects, unless the last projection shows the same, or better within what is wanted. There is
   * none after an abort.
   * @return  false if the view is invalid
   */
  bool Project(vtkSplattingMIPVolumeMapper* mapper, const View& view, vtkRenderer* renderer,
    vtkVolume* volume, const SceneCuts::DepthReader& readDepth);

  /// Gives back all memory, after a frame that there was not enough for.
  void Clear();

  /// The largest image; nullptr if there is none.
  const ShearWarp* MainImage() const;
  /// The same as vtkSplattingMIPVolumeMapper::GetShearImage() gives it.
  vtkImageData* ShearImage();

  /// As the mapper's methods of these names.
  vtkIdType NumberOfProjections() const { return this->Projections; }
  int QualityModeUsed() const;
  double ProjectionTime() const { return this->TimeToProject; }
  double IndexTime() const { return this->Source.Time() + this->Components.Time(); }
  std::size_t IndexMemorySize() const
  {
    return this->Source.MemorySize() + this->Components.MemorySize();
  }

private:
  int ChooseMode(vtkSplattingMIPVolumeMapper* mapper, vtkRenderer* renderer, vtkVolume* volume);
  bool FindCuts(vtkSplattingMIPVolumeMapper* mapper, const View& view, vtkRenderer* renderer,
    vtkVolume* volume, const SceneCuts::DepthReader& readDepth, const ProjectionSettings& settings);
  bool Shows(const View& view, const ProjectionSettings& settings) const;

  std::vector<ShearWarp> ImagesBefore; // of the frame before the last
  vtkIdType Projections = 0, ProjectionsBefore = 0;
  int ModeUsed = 3; // in the last projection that was not aborted
  double TimeToProject = 0.0;
  double CutTime = 0.0; // of it, to find what cuts the present images
  RenderTimes Times;
  double IndexTimeBefore = 0.0; // before what the present frame makes of the index
  vtkSmartPointer<vtkImageData> ShearImageOutput;
};
}

#endif
