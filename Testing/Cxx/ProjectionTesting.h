// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of vtkSplattingMIPProjection share: images of random places, and views of them.
 */
#ifndef ProjectionTesting_h
#define ProjectionTesting_h

#include "CoreTesting.h"

#include "vtkSplattingMIPProjection.h"

#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkTypeTraits.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cstring>
#include <string>
#include <vector>

namespace projectiontesting
{
/// Of length 1, and not near 0 before.
inline glm::dvec3 randomDirection(reference::Random& random)
{
  glm::dvec3 v(0.0);
  while (glm::length(v) < 0.2 || glm::length(v) > 1.0)
  {
    v = { random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0) };
  }
  return glm::normalize(v);
}

template <class T>
vtkSmartPointer<vtkImageData> imageOf(const reference::Volume<T>& volume)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(volume.size[0], volume.size[1], volume.size[2]);
  image->AllocateScalars(vtkTypeTraits<T>::VTK_TYPE_ID, 1);
  std::memcpy(image->GetScalarPointer(), volume.voxels.data(), volume.voxels.size() * sizeof(T));
  return image;
}

/// Another extent, spacing, origin and direction.
inline void placeAtRandom(vtkImageData* image, reference::Random& random)
{
  int extent[6];
  image->GetExtent(extent);
  for (int a = 0; a < 3; ++a)
  {
    const int first = random.uniform(-5, 5);
    extent[2 * a + 1] += first - extent[2 * a];
    extent[2 * a] = first;
  }
  image->SetExtent(extent);
  double spacing[3], origin[3];
  for (int a = 0; a < 3; ++a)
  {
    spacing[a] = random.uniform(0.5, 2.0);
    origin[a] = random.uniform(-50.0, 50.0);
  }
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
  const double angle = random.uniform(0.0, 6.3);
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, randomDirection(random));
  for (int r = 0; r < 3; ++r)
  {
    for (int c = 0; c < 3; ++c)
    {
      image->GetDirectionMatrix()->SetElement(r, c, turn[c][r]);
    }
  }
  // The image does not watch its matrix.
  vtkNew<vtkMatrix3x3> direction;
  direction->DeepCopy(image->GetDirectionMatrix());
  image->SetDirectionMatrix(direction);
}

inline vtkSmartPointer<vtkSplattingMIPProjection> projectionOf(vtkImageData* image)
{
  auto filter = vtkSmartPointer<vtkSplattingMIPProjection>::New();
  filter->SetInputData(image);
  return filter;
}

/// Whether two images have the same scalars, bit for bit.
inline bool sameScalars(vtkImageData* a, vtkImageData* b)
{
  return a->GetNumberOfPoints() == b->GetNumberOfPoints() &&
    a->GetScalarType() == b->GetScalarType() &&
    a->GetNumberOfScalarComponents() == b->GetNumberOfScalarComponents() &&
    std::memcmp(a->GetScalarPointer(), b->GetScalarPointer(),
      a->GetNumberOfPoints() * a->GetNumberOfScalarComponents() * a->GetScalarSize()) == 0;
}

/// A copy of one slice.
inline vtkSmartPointer<vtkImageData> sliceOf(vtkImageData* image, int n)
{
  const int* const size = image->GetDimensions();
  auto slice = vtkSmartPointer<vtkImageData>::New();
  slice->SetDimensions(size[0], size[1], 1);
  slice->AllocateScalars(image->GetScalarType(), image->GetNumberOfScalarComponents());
  std::memcpy(slice->GetScalarPointer(), image->GetScalarPointer(0, 0, n),
    slice->GetNumberOfPoints() * slice->GetNumberOfScalarComponents() * slice->GetScalarSize());
  return slice;
}

/// Collects the errors of a filter, which are not printed while this lives.
class Errors
{
public:
  explicit Errors(vtkObject* object) : Object(object)
  {
    this->Tag = object->AddObserver(vtkCommand::ErrorEvent, this, &Errors::note);
  }
  ~Errors() { this->Object->RemoveObserver(this->Tag); }
  Errors(const Errors&) = delete;
  Errors& operator=(const Errors&) = delete;

  std::vector<std::string> texts;

private:
  void note(vtkObject*, unsigned long, void* text)
  {
    this->texts.emplace_back(static_cast<const char*>(text));
  }

  vtkSmartPointer<vtkObject> Object;
  unsigned long Tag;
};
}

#endif
