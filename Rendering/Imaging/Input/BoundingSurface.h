// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef BoundingSurface_h
#define BoundingSurface_h

#include "Clipping/ClosedSurface.h"

#include "vtkType.h"

#include <glm/mat4x4.hpp>

class vtkPolyData;

namespace splatting
{
/**
 * A vtkPolyData that a volume is shown in, as triangles of the volume's index space. They are made
 * anew only when the data or the matrix changes.
 */
class BoundingSurface
{
public:
  /// Takes the surface, which may be nullptr. Returns what is wrong with it, or nullptr.
  const char* Update(vtkPolyData* data, const glm::dmat4& worldToIndex);

  /// Of the last Update().
  bool IsOpen() const { return this->Open; }

  /// Another number after each Update() that changed the triangles.
  vtkIdType Version() const { return this->NumberOfUpdates; }

  /// Nullptr if there is none.
  ClosedSurface* Get() { return this->Surface.empty() ? nullptr : &this->Surface; }

private:
  const char* MakeTriangles(vtkPolyData* data);
  const char* MakeSurface();

  vtkPolyData* Data = nullptr; // only compared
  vtkMTimeType DataTime = 0;
  glm::dmat4 WorldToIndex{ 1.0 };
  const char* Fault = nullptr;
  bool Open = false;
  vtkIdType NumberOfUpdates = 0;
  std::vector<glm::dvec3> Points; // in the world
  std::vector<glm::ivec3> Triangles;
  ClosedSurface Surface;
};
}

#endif
