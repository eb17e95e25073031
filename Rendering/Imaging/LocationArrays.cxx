// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "LocationArrays.h"

#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <limits>

namespace splatting
{
namespace
{
template <class Array, class T>
T* addArray(vtkImageData* image, const char* name, int components, T none)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(image->GetNumberOfPoints());
  array->Fill(none);
  image->GetPointData()->AddArray(array);
  return array->GetPointer(0);
}
}

Locator::Arrays addLocationArrays(vtkImageData* image)
{
  Locator::Arrays arrays;
  arrays.voxels = addArray<vtkIntArray>(image, "Voxel", 3, -1);
  arrays.depths =
    addArray<vtkFloatArray>(image, "Depth", 1, std::numeric_limits<float>::quiet_NaN());
  arrays.positions =
    addArray<vtkDoubleArray>(image, "Position", 3, std::numeric_limits<double>::quiet_NaN());
  return arrays;
}
}
