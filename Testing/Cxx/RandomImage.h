// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file    RandomImage.h
 * @brief   draws where images lie
 */
#ifndef RandomImage_h
#define RandomImage_h

#include "RandomScene.h"

#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"

#include <glm/gtc/matrix_transform.hpp>

namespace coretesting
{
/// Gives an image another extent, spacing, origin and, if it `turns`, direction.
inline void placeAtRandom(vtkImageData* image, reference::Random& random, bool turns)
{
  int extent[6];
  image->GetExtent(extent);
  double spacing[3], origin[3];
  for (int a = 0; a < 3; ++a)
  {
    const int first = random.uniform(-40, 40);
    extent[2 * a + 1] += first - extent[2 * a];
    extent[2 * a] = first;
    spacing[a] = random.uniform(0.6, 1.4);
    origin[a] = random.uniform(-90.0, 90.0);
  }
  image->SetExtent(extent);
  image->SetSpacing(spacing);
  image->SetOrigin(origin);
  vtkNew<vtkMatrix3x3> direction;
  if (turns)
  {
    const double angle = random.uniform(0.0, 6.3);
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, anyDirection(random));
    for (int n = 0; n < 9; ++n)
    {
      direction->SetElement(n / 3, n % 3, turn[n % 3][n / 3]);
    }
  }
  image->SetDirectionMatrix(direction);
  random.note("image with first voxel ", extent[0], " ", extent[2], " ", extent[4], ", spacing ",
    spacing[0], " ", spacing[1], " ", spacing[2], ", origin ", origin[0], " ", origin[1], " ",
    origin[2], turns ? ", turned" : "");
}
}

#endif
