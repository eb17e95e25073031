// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the tests of scalars share: data sets made by hand, and whether two mappers show the same.
 */
#ifndef ScalarTesting_h
#define ScalarTesting_h

#include "Stage.h"

#include "vtkSplattingMIPVolumeMapper.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkPointData.h"
#include "vtkRenderWindow.h"
#include "vtkUnsignedCharArray.h"

#include <array>
#include <cstring>
#include <string>

namespace scalartesting
{
using Mapper = vtkSplattingMIPVolumeMapper;
using Size = std::array<int, 3>;

/// One view along each principal axis.
inline const std::array<stage::Vector, 3>& directions()
{
  static const std::array<stage::Vector, 3> all{ { { -0.8, 0.3, 0.45 }, { 0.5, 0.7, -0.1 },
    { 0.3, -0.45, 0.8 } } };
  return all;
}

/// Integers from 0 to 100 in an array of any type, for any number of components.
inline vtkSmartPointer<vtkDataArray> noiseArray(
  int type, vtkIdType tuples, int components, std::uint64_t seed)
{
  auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  reference::Random random(seed);
  for (vtkIdType n = 0; n < tuples * components; ++n)
  {
    array->SetComponent(n / components, static_cast<int>(n % components), random.uniform(0, 100));
  }
  return array;
}

/// The component as an array by itself, of another type if wanted.
inline vtkSmartPointer<vtkDataArray> componentOf(vtkDataArray* array, int c, int type = VTK_VOID)
{
  auto result = vtkSmartPointer<vtkDataArray>::Take(
    vtkDataArray::CreateDataArray(type == VTK_VOID ? array->GetDataType() : type));
  result->SetNumberOfTuples(array->GetNumberOfTuples());
  for (vtkIdType n = 0; n < array->GetNumberOfTuples(); ++n)
  {
    result->SetComponent(n, 0, array->GetComponent(n, c));
  }
  return result;
}

inline vtkSmartPointer<vtkImageData> bareImage(const Size& size)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(size[0], size[1], size[2]);
  image->SetSpacing(1.0, 1.25, 0.75);
  image->SetOrigin(-3.0, 2.0, 5.5);
  return image;
}

/// What all else is compared with: plain point scalars.
inline vtkSmartPointer<vtkImageData> plainImage(const Size& size, vtkDataArray* scalars)
{
  auto image = bareImage(size);
  image->GetPointData()->SetScalars(scalars);
  return image;
}

/// Plain cell scalars, for so many cells.
inline vtkSmartPointer<vtkImageData> cellImage(const Size& cells, vtkDataArray* scalars)
{
  auto image = bareImage({ cells[0] + 1, cells[1] + 1, cells[2] + 1 });
  image->GetCellData()->SetScalars(scalars);
  return image;
}

/// About a share of the flags have the value, in lumps.
inline vtkSmartPointer<vtkUnsignedCharArray> flags(
  vtkIdType count, unsigned char value, double share, std::uint64_t seed)
{
  auto array = vtkSmartPointer<vtkUnsignedCharArray>::New();
  array->SetNumberOfValues(count);
  array->SetName(vtkDataSetAttributes::GhostArrayName());
  reference::Random random(seed);
  unsigned char current = 0;
  for (vtkIdType n = 0; n < count; ++n)
  {
    current = n % 3 == 0 ? (random.chance(share) ? value : 0) : current;
    array->SetValue(n, current);
  }
  return array;
}

/// What hidden voxels are compared with: NaN in their place.
template <class IsHidden>
vtkSmartPointer<vtkDataArray> withoutHidden(vtkDataArray* scalars, int type, IsHidden&& isHidden)
{
  const auto result = componentOf(scalars, 0, type);
  for (vtkIdType n = 0; n < result->GetNumberOfTuples(); ++n)
  {
    if (isHidden(n))
    {
      result->SetComponent(n, 0, vtkMath::Nan());
    }
  }
  return result;
}

/// Whether type, size, scalars and ghosts are equal, bit for bit. EXACT has no shear images.
inline bool sameShearImages(vtkImageData* a, vtkImageData* b)
{
  if (!a && !b)
  {
    return true;
  }
  if (!a || !b || a->GetScalarType() != b->GetScalarType() ||
    a->GetNumberOfPoints() != b->GetNumberOfPoints() ||
    a->GetNumberOfScalarComponents() != b->GetNumberOfScalarComponents())
  {
    return false;
  }
  bool same = true;
  for (vtkIdType n = 0; n < a->GetNumberOfPoints() && same; ++n)
  {
    same = a->GetPointGhostArray()->GetValue(n) == b->GetPointGhostArray()->GetValue(n);
    for (int c = 0; c < a->GetNumberOfScalarComponents() && same; ++c)
    {
      // Hidden pixels have no value.
      same = a->GetPointGhostArray()->GetValue(n) != 0 ||
        a->GetPointData()->GetScalars()->GetComponent(n, c) ==
          b->GetPointData()->GetScalars()->GetComponent(n, c);
    }
  }
  return same;
}

inline bool isBlack(const stage::Pixels& pixels)
{
  for (unsigned char byte : pixels)
  {
    if (byte != 0)
    {
      return false;
    }
  }
  return true;
}

/// Whether both give the same shear images (and, unless voxels are of another kind, pictures).
inline void expectSame(stage::Stage& stage, vtkVolumeMapper* expected, vtkVolumeMapper* actual,
  const std::string& name, reference::Checks& check, bool pictures = true)
{
  auto* const left = Mapper::SafeDownCast(expected);
  auto* const right = Mapper::SafeDownCast(actual);
  for (std::size_t view = 0; view < directions().size(); ++view)
  {
    for (int mode : { Mapper::PREVIEW, Mapper::STANDARD, Mapper::HIGH, Mapper::EXACT })
    {
      left->SetQualityMode(mode);
      right->SetQualityMode(mode);
      const std::string where =
        name + ", axis " + std::to_string(view) + ", " + left->GetQualityModeAsString();
      stage.show(left);
      stage.look(directions()[view], { 0.0, 1.0, 0.1 });
      const stage::Pixels truth = stage.pixels();
      stage.show(right);
      const stage::Pixels picture = stage.pixels();
      check(!right->GetLastRenderUsedRayCasting(), where, ": splatted.");
      check(!isBlack(truth), where, ": there is something to see.");
      check(!pictures || truth == picture, where, ": the same picture.");
      check(sameShearImages(left->GetShearImage(), right->GetShearImage()), where,
        ": the same shear image.");
    }
  }
}
}

#endif
