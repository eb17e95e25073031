// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of vtkSplattingMIPProjection share: images of random places, and views of them.
 */
#ifndef ProjectionTesting_h
#define ProjectionTesting_h

#include "CoreTesting.h"
#include "RandomImage.h"

#include "vtkSplattingMIPProjection.h"

#include "vtkCommand.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkTypeTraits.h"

#include <cstring>
#include <string>
#include <vector>

namespace projectiontesting
{
template <class T>
vtkSmartPointer<vtkImageData> imageOf(const reference::Volume<T>& volume)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(volume.size[0], volume.size[1], volume.size[2]);
  image->AllocateScalars(vtkTypeTraits<T>::VTK_TYPE_ID, 1);
  std::memcpy(image->GetScalarPointer(), volume.voxels.data(), volume.voxels.size() * sizeof(T));
  return image;
}

/// Noise like a CT's, anywhere.
inline vtkSmartPointer<vtkImageData> anyImage(
  const std::array<int, 3>& size, reference::Random& random)
{
  auto image = imageOf(reference::uniformNoise<std::int16_t>(size, random, -1000, 3000));
  coretesting::placeAtRandom(image, random, true);
  return image;
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
