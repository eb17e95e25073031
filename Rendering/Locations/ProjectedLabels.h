// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The first label on each ray.
 */
#ifndef ProjectedLabels_h
#define ProjectedLabels_h

#include "Display/Picture.h"
#include "Splat/Projection/Project.h"
#include "Splat/Projection/SplatView.h"

#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"

#include <vector>

VTK_ABI_NAMESPACE_BEGIN
class vtkImageData;
VTK_ABI_NAMESPACE_END

namespace splatting
{
class SceneCuts;

/**
 * Projects labels along the rays: a maximum in preview, with locations, of a volume that is 1 where
 * the label is not 0. Of equal samples the nearest to the viewer is located, so the location is the
 * first voxel with a label. Labels are not interpolated. The projection is kept until labels, rays
 * or cuts change.
 */
class ProjectedLabels
{
public:
  /**
   * The first voxel with a label, i, j and k, on the ray of each pixel of a picture. Rays without
   * such a voxel have one of label 0; -1: no visible voxel.
   *
   * @param labels  valid for this view, see validateLabels()
   * @param scene   the cuts of the current frame
   * @param budget  the bytes that the index of the labels may hold
   */
  std::vector<int> VoxelsOf(const Picture& picture, vtkImageData* labels, const View& view,
    SceneCuts& scene, std::size_t budget);

  /// Bytes of the copy and its index.
  std::size_t MemorySize() const { return this->IsLabel.size() + this->Index.memorySize(); }

private:
  bool Load(vtkImageData* labels, const glm::ivec3& size);

  vtkImageData* Labels = nullptr; // compared, never dereferenced
  vtkMTimeType Time = 0;
  std::vector<unsigned char> IsLabel;
  VolumeIndex Index;
  splatting::Projector Projector;
  SplatView Rays;
  std::vector<ShearImage> Images;
};
}

#endif
