// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef BoundingSurface_h
#define BoundingSurface_h

#include "Clipping/ClosedSurface.h"

#include "vtkSplattingMIPNamespace.h"
#include "vtkType.h"

#include <glm/mat4x4.hpp>

VTK_ABI_NAMESPACE_BEGIN
class vtkPolyData;
VTK_ABI_NAMESPACE_END

namespace splatting
{
/**
 * A vtkPolyData as triangles of a volume's index space, updated when the data or the matrix change.
 */
class BoundingSurface
{
public:
  /// Sets the surface, which may be nullptr. Returns an error message, or nullptr.
  const char* Update(vtkPolyData* data, const glm::dmat4& worldToIndex);

  /// Whether the surface of the last Update() is open.
  bool IsOpen() const { return this->Open; }

  /// Changes with each Update() that changes the triangles.
  vtkIdType Version() const { return this->NumberOfUpdates; }

  /// nullptr if there is no surface
  ClosedSurface* Get() { return this->Surface.empty() ? nullptr : &this->Surface; }

private:
  const char* MakeTriangles(vtkPolyData* data);
  const char* MakeSurface();

  vtkPolyData* Data = nullptr; // compared only
  vtkMTimeType DataTime = 0;
  glm::dmat4 WorldToIndex{ 1.0 };
  const char* Fault = nullptr;
  bool Open = false;
  vtkIdType NumberOfUpdates = 0;
  std::vector<glm::dvec3> Points; // in world coordinates
  std::vector<glm::ivec3> Triangles;
  ClosedSurface Surface;
};
}

#endif
