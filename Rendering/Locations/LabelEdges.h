// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Edges of labels, drawn over a picture.
 */
#ifndef LabelEdges_h
#define LabelEdges_h

#include "Display/Picture.h"

#include "vtkSplattingMIPNamespace.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <memory>
#include <string>

VTK_ABI_NAMESPACE_BEGIN
class vtkAbstractSplattingMIPVolumeMapper;
class vtkDataArray;
class vtkImageData;
VTK_ABI_NAMESPACE_END

namespace splatting
{
class ProjectedLabels;
class SampleLocations;
class SceneCuts;

/// The point scalars or, without any, the cell scalars.
vtkDataArray* scalarsOfLabels(vtkImageData* labels);

/// An error message for labels of a volume with so many voxels along each axis, or an empty string.
std::string validateLabels(vtkImageData* labels, const glm::ivec3& size);

/**
 * Draws the edges of a mapper's labels over its pictures: each pixel whose label is not 0 and
 * differs from that of one of its four neighbours, in the label's colour, opaque. Pixels outside
 * the picture have label 0.
 */
class LabelEdges
{
public:
  LabelEdges();
  ~LabelEdges();

  /// Releases what this frame does not need.
  void BeginFrame(vtkAbstractSplattingMIPVolumeMapper* mapper);
  /// Draws the edges, if the mapper has labels.
  /// @param locations  of the picture
  /// @param cuts       of the current frame
  void Draw(vtkAbstractSplattingMIPVolumeMapper* mapper, const SampleLocations& locations,
    SceneCuts& cuts, Picture& picture);
  void Clear();
  /// Bytes of the data kept between frames.
  std::size_t MemorySize() const;

private:
  std::unique_ptr<ProjectedLabels> Projected; // while LabelMode is PROJECTED
};
}

#endif
