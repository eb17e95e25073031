// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    MapperOracle.h
 * @brief   view, cropping and reduction of a mapper, from its settings and the camera
 */
#ifndef MapperOracle_h
#define MapperOracle_h

#include "Reductions.h"
#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkImageData.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <cmath>

namespace stage
{

/**
 * Whether the highest slice along the axis is nearest to the viewer.
 */
inline bool looksBackwards(Stage& stage, vtkImageData* image, int axis)
{
  vtkNew<vtkMatrix4x4> worldToIndex;
  vtkMatrix4x4::Multiply4x4(
    stage.volume->GetMatrix(), image->GetIndexToPhysicalMatrix(), worldToIndex);
  worldToIndex->Invert();
  const double* view = stage.renderer->GetActiveCamera()->GetDirectionOfProjection();
  double direction[4] = { view[0], view[1], view[2], 0.0 };
  worldToIndex->MultiplyPoint(direction, direction);
  return direction[axis] < 0.0;
}

/**
 * The mapper's cropping in index space, the image's first voxel at the origin.
 */
inline reference::RayCuts croppingOf(vtkVolumeMapper* mapper, vtkImageData* image)
{
  reference::RayCuts cuts;
  if (mapper->GetCropping())
  {
    cuts.regions = static_cast<unsigned>(mapper->GetCroppingRegionFlags());
    for (int plane = 0; plane < 6; ++plane)
    {
      const int a = plane / 2;
      const double inIndices =
        (mapper->GetCroppingRegionPlanes()[plane] - image->GetOrigin()[a]) / image->GetSpacing()[a];
      cuts.planes[a][plane % 2] = inIndices - image->GetExtent()[2 * a];
    }
  }
  return cuts;
}

inline reference::Outcome<double> reduced(
  const reference::CutRay<double>& ray, double lowest, vtkSplattingMIPVolumeMapper* mapper)
{
  switch (mapper->GetBlendMode())
  {
    case vtkVolumeMapper::MINIMUM_INTENSITY_BLEND:
      return reference::smallest(ray)[0];
    case vtkVolumeMapper::AVERAGE_INTENSITY_BLEND:
      return reference::mean(
        ray, mapper->GetAverageIPScalarRange()[0], mapper->GetAverageIPScalarRange()[1], 0.0)[0];
  }
  switch (mapper->GetMaximumType())
  {
    case vtkSplattingMIPVolumeMapper::DEPTH_SHADED:
      return reference::depthShaded(
        ray, lowest, mapper->GetDepthShadingAmbient(), mapper->GetDepthShadingChangeRate())[0];
    case vtkSplattingMIPVolumeMapper::LOCAL:
      return reference::firstLocalMaximum(ray, mapper->GetLocalMaximumThreshold(), 0.0)[0];
    case vtkSplattingMIPVolumeMapper::SIGNED:
    {
      const auto high = reference::largest(ray)[0], low = reference::smallest(ray)[0];
      const double origin = mapper->GetSignedOrigin();
      return std::abs(low.value - origin) > std::abs(high.value - origin) ? low : high;
    }
    default:
      return reference::largest(ray)[0];
  }
}

/**
 * The last render's view, if it was parallel.
 */
inline reference::ShearView viewOf(vtkSplattingMIPVolumeMapper* mapper)
{
  reference::ShearView view;
  view.axis = mapper->GetPrincipalAxis();
  mapper->GetShear(view.shear);
  return view;
}

} // namespace stage

#endif
