// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The arrays that locations are written to: names, types, and that they begin with "none".
#include "LocationArrays.h"
#include "ProjectionTesting.h"

#include "vtkDataArray.h"

#include <cmath>

namespace
{
using reference::Checks;
using namespace splatting;

/// One array, and that what is written through the pointer is in it.
template <class T>
void testArray(
  Checks& check, vtkImageData* image, const std::string& name, int components, int type, T* pointer)
{
  vtkDataArray* const array = image->GetPointData()->GetArray(name.c_str());
  if (!check(array && array->GetNumberOfComponents() == components &&
          array->GetDataType() == type && array->GetNumberOfTuples() == image->GetNumberOfPoints(),
        name, " is missing or of another kind"))
  {
    return;
  }
  for (vtkIdType n = 0; n < array->GetNumberOfValues(); ++n)
  {
    const double value = array->GetComponent(n / components, int(n % components));
    check(type == VTK_INT ? value == -1.0 : std::isnan(value), name, " begins with ", value);
    pointer[n] = static_cast<T>(n + 1);
    check(array->GetComponent(n / components, int(n % components)) == double(n + 1), name,
      " is written elsewhere");
  }
}
}

int TestLocationArrays(int, char*[])
{
  Checks check;
  reference::forScenes("location arrays", 40,
    [&](int, reference::Random& random)
    {
      vtkNew<vtkImageData> image;
      const int left = random.uniform(-5, 5), bottom = random.uniform(-5, 5);
      const int width = random.uniform(1, 6), height = random.uniform(1, 6);
      image->SetExtent(left, left + width - 1, bottom, bottom + height - 1, 0, 0);
      const splatting::Locator::Arrays arrays = addLocationArrays(image);
      check(image->GetPointData()->GetNumberOfArrays() == 3, "there are other arrays");
      testArray(check, image, "Voxel", 3, VTK_INT, arrays.voxels);
      testArray(check, image, "Depth", 1, VTK_FLOAT, arrays.depths);
      testArray(check, image, "Position", 3, VTK_DOUBLE, arrays.positions);
      check(!arrays.clipDepths, "depths of the screen are not asked for");
    });
  return check.exitCode();
}
