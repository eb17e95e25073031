// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    MapperOracle.h
 * @brief   the shear image that a mapper must have in mode PREVIEW, from its settings and the
 * camera
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
#include "vtkUnsignedCharArray.h"
#include "vtkVolume.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

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

/**
 * After a render in mode PREVIEW, the largest difference of the mapper's shear image to the
 * reference; infinity where one has a sample and the other has not.
 *
 * The half-spaces, of index space with the image's first voxel at the origin, are what planes
 * leave.
 */
inline double shearImageError(Stage& stage, vtkSplattingMIPVolumeMapper* mapper,
  vtkImageData* image, const reference::Volume<std::uint8_t>& volume,
  const std::vector<std::array<double, 4>>& halfSpaces = {})
{
  const reference::ShearView view = viewOf(mapper);
  const reference::ImageRays rays = reference::raysOf(volume.size, view);
  reference::RayCuts cuts = croppingOf(mapper, image);
  cuts.halfSpaces = halfSpaces;
  const reference::RayCutter cutter(rays, cuts);
  const auto samples = reference::voxelSamples(volume, rays);
  const double lowest = reference::lowestVoxel(volume);
  const bool reversed = looksBackwards(stage, image, view.axis);
  vtkImageData* const shear = mapper->GetShearImage();
  const int* size = shear->GetDimensions();
  if (size[0] != rays.width() || size[1] != rays.height())
  {
    return HUGE_VAL;
  }
  double largest = 0.0;
  for (int v = 0; v < rays.height(); ++v)
  {
    for (int u = 0; u < rays.width(); ++u)
    {
      const vtkIdType pixel = vtkIdType(v) * rays.width() + u;
      const auto ray = reference::cutRay(samples[pixel], cutter, u, v, reversed);
      const auto expected = reduced(reference::toDouble(ray), lowest, mapper);
      const double found = shear->GetScalarComponentAsDouble(u, v, 0, 0);
      const bool hit = shear->GetPointGhostArray()->GetValue(pixel) == 0;
      const double error = hit && expected.hit ? std::abs(found - expected.value) : 0.0;
      largest = std::max(largest, hit == expected.hit ? error : HUGE_VAL);
    }
  }
  return largest;
}

/**
 * What rounding may do to the error: samples of bytes are exact; means are rounded once to float,
 * depth shades sixteen times and twice (see TestReductions).
 */
inline double allowedError(vtkSplattingMIPVolumeMapper* mapper)
{
  if (mapper->GetBlendMode() == vtkVolumeMapper::AVERAGE_INTENSITY_BLEND)
  {
    return 255.0 * 0x1p-24;
  }
  const bool isShaded = mapper->GetBlendMode() == vtkVolumeMapper::MAXIMUM_INTENSITY_BLEND &&
    mapper->GetMaximumType() == vtkSplattingMIPVolumeMapper::DEPTH_SHADED;
  const double factor =
    std::abs(mapper->GetDepthShadingAmbient()) + std::abs(mapper->GetDepthShadingChangeRate());
  return isShaded ? (16.0 * factor + 2.0) * 255.0 * 0x1p-24 : 0.0;
}

} // namespace stage

#endif
