// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ValueFile.h"

#include "PictureSeries.h"

#include "vtkCamera.h"
#include "vtkImageCast.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNIFTIImageWriter.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <fstream>

namespace
{
bool EndsWith(const std::string& text, const std::string& end)
{
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/**
 * The picture's axes, right, up and to the viewer, and its first pixel, in the patient (LPS).
 */
vtkSmartPointer<vtkMatrix4x4> FindPlane(
  vtkSplattingMIPProjection* projection, const std::array<double, 3>& origin)
{
  vtkNew<vtkCamera> camera;
  projection->GetViewCamera(0, camera);
  camera->OrthogonalizeViewUp();
  double away[3], axes[3][3], center[3];
  camera->GetDirectionOfProjection(away);
  camera->GetViewUp(axes[1]);
  camera->GetFocalPoint(center);
  vtkMath::Cross(away, axes[1], axes[0]);
  const double* const first = projection->GetOutput()->GetOrigin();
  auto plane = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 3; ++row)
  {
    axes[2][row] = -away[row];
    for (int column = 0; column < 3; ++column)
    {
      plane->SetElement(row, column, axes[column][row]);
    }
    plane->SetElement(
      row, 3, origin[row] + center[row] + first[0] * axes[0][row] + first[1] * axes[1][row]);
  }
  return plane;
}

void WriteNIFTI(vtkImageData* values, vtkMatrix4x4* plane, const std::string& path)
{
  vtkNew<vtkMatrix4x4> form; // which counts from left to right and back to front
  form->DeepCopy(plane);
  for (int column = 0; column < 4; ++column)
  {
    form->SetElement(0, column, -plane->GetElement(0, column));
    form->SetElement(1, column, -plane->GetElement(1, column));
  }
  vtkNew<vtkNIFTIImageWriter> writer;
  writer->SetInputData(values);
  writer->SetFileName(path.c_str());
  writer->SetQFormMatrix(form);
  writer->SetSFormMatrix(form);
  writer->Write();
  if (writer->GetErrorCode())
  {
    throw CannotWrite(path);
  }
}

/**
 * By hand, because VTK's writer leaves directions out.
 */
void WriteMeta(vtkImageData* values, vtkMatrix4x4* plane, const std::string& path)
{
  const int* const size = values->GetDimensions();
  const double* const spacing = values->GetSpacing();
  std::ofstream file(path, std::ios::binary);
  file.precision(12);
  file << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = ";
#ifdef VTK_WORDS_BIGENDIAN
  file << "True";
#else
  file << "False";
#endif
  file << "\nTransformMatrix =";
  for (int i = 0; i < 9; ++i)
  {
    file << ' ' << plane->GetElement(i % 3, i / 3);
  }
  file << "\nOffset = " << plane->GetElement(0, 3) << ' ' << plane->GetElement(1, 3) << ' '
       << plane->GetElement(2, 3) << "\nElementSpacing = " << spacing[0] << ' ' << spacing[1] << ' '
       << spacing[2] << "\nDimSize = " << size[0] << ' ' << size[1]
       << " 1\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n";
  file.write(static_cast<const char*>(values->GetScalarPointer()),
    static_cast<std::streamsize>(values->GetNumberOfPoints() * sizeof(float)));
  file.close();
  if (!file)
  {
    throw CannotWrite(path);
  }
}
}

bool IsValueFile(const std::string& path)
{
  return EndsWith(path, ".nii") || EndsWith(path, ".nii.gz") || EndsWith(path, ".mha");
}

void WriteValues(vtkSplattingMIPProjection* projection, const std::array<double, 3>& origin,
  const std::string& path)
{
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(projection->GetOutput());
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  vtkImageData* const values = cast->GetOutput();
  const double* const spacing = values->GetSpacing();
  values->SetSpacing(
    spacing[0], spacing[1], projection->GetSlab() ? projection->GetSlabThickness() : 1.0);
  values->SetOrigin(0.0, 0.0, 0.0);
  const auto plane = FindPlane(projection, origin);
  EndsWith(path, ".mha") ? WriteMeta(values, plane, path) : WriteNIFTI(values, plane, path);
}
