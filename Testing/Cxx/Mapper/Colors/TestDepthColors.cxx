// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The colours that depths are shown in, and the image of locations where there are none.
#include "CoreTesting.h"
#include "Locations/SampleLocations.h"

#include "vtkColorTransferFunction.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>

namespace
{
using reference::Checks;
using namespace splatting;

void compare(Checks& check, const std::vector<glm::dvec3>& table, std::size_t n, const double* rgb)
{
  check(glm::length(table.at(n) - glm::dvec3(rgb[0], rgb[1], rgb[2])) < 1e-9, "colour ", n, " is ",
    table.at(n).x, " ", table.at(n).y, " ", table.at(n).z);
}

void testFunction(Checks& check, reference::Random& random)
{
  vtkNew<vtkColorTransferFunction> colors;
  const double low = random.uniform(-50.0, 50.0), high = low + random.uniform(1.0, 90.0);
  for (const double x : { low, 0.5 * (low + high), high })
  {
    const glm::dvec3 rgb = coretesting::anyVector(random, 0.0, 1.0);
    colors->AddRGBPoint(x, rgb.x, rgb.y, rgb.z);
  }
  const auto table = depthColors(colors);
  check(table.size() == 256, table.size(), " colours");
  const int n = random.uniform(0, 255);
  double rgb[3];
  colors->GetColor(low + n / 255.0 * (high - low), rgb);
  compare(check, table, std::size_t(n), rgb);
}

void testNothing(Checks& check, reference::Random& random)
{
  const int left = random.uniform(0, 9), bottom = random.uniform(0, 9);
  const int extent[6] = { left, left + random.uniform(0, 5), bottom, bottom + 3, 0, 0 };
  const auto image = makeLocationImage(nullptr, extent);
  check(std::equal(extent, extent + 6, image->GetExtent()), "another extent");
  for (const char* name : { "Voxel", "Depth", "Position" })
  {
    vtkDataArray* const array = image->GetPointData()->GetArray(name);
    for (vtkIdType n = 0; check(array, name, " is missing") && n < array->GetNumberOfTuples(); ++n)
    {
      const double value = array->GetComponent(n, array->GetNumberOfComponents() - 1);
      check(value == -1.0 || std::isnan(value), name, " is ", value, " where nothing is");
    }
  }
}
}

int TestDepthColors(int, char*[])
{
  Checks check;
  // From the nearest to the farthest: red, yellow, green, cyan, blue.
  const double hues[5][3] = { { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 1, 1 }, { 0, 0, 1 } };
  const auto table = depthColors(nullptr);
  for (int n = 0; n <= 255; ++n)
  {
    const double at = 4.0 * n / 255.0;
    const int below = std::min(int(at), 3);
    double rgb[3];
    for (int c = 0; c < 3; ++c)
    {
      rgb[c] = hues[below][c] + (at - below) * (hues[below + 1][c] - hues[below][c]);
    }
    compare(check, table, std::size_t(n), rgb);
  }
  reference::forScenes("colours", 100,
    [&](int, reference::Random& random)
    {
      testFunction(check, random);
      testNothing(check, random);
    });
  return check.exitCode();
}
