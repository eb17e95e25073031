// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Writing/ValueFile.h"

#include "Reading/QuietReading.h"
#include "Reading/Reading.h"
#include "Reading/VolumeReader.h"
#include "Writing/SafeFiles.h"

#include "itkMetaImageIO.h"

#include "vtkImageCast.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkNIFTIImageWriter.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkTIFFWriter.h"

#include <tiffio.h>

#include <cstdio>

namespace
{
/**
 * NIfTI counts from left to right and back to front.
 */
vtkSmartPointer<vtkMatrix4x4> MakeForm(vtkImageData* values)
{
  auto form = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 3; ++row)
  {
    const double sign = row < 2 ? -1.0 : 1.0;
    for (int column = 0; column < 3; ++column)
    {
      form->SetElement(row, column, sign * values->GetDirectionMatrix()->GetElement(row, column));
    }
    form->SetElement(row, 3, sign * values->GetOrigin()[row]);
  }
  return form;
}

/**
 * Write by one of VTK's writers.
 */
bool WriteWith(vtkImageWriter* writer, vtkImageData* values, const std::string& path)
{
  writer->SetInputData(values);
  writer->SetFileName(path.c_str());
  writer->Write();
  return !writer->GetErrorCode();
}

bool WriteNIFTI(vtkImageData* values, const std::string& path)
{
  const auto form = MakeForm(values);
  values->SetOrigin(0.0, 0.0, 0.0); // which VTK's writer would add
  vtkNew<vtkNIFTIImageWriter> writer;
  writer->SetQFormMatrix(form);
  writer->SetSFormMatrix(form);
  return WriteWith(writer, values, path);
}

bool WriteTIFF(vtkImageData* values, const std::string& path)
{
  TIFFSetErrorHandler(nullptr); // which writes to stderr
  vtkNew<vtkTIFFWriter> writer;
  writer->SetCompressionToNoCompression();
  std::printf("TIFF holds the size of a pixel, but not where the picture lies: .nii and .mha do\n");
  return WriteWith(writer, values, path);
}

/**
 * Write by ITK, because VTK's writer leaves directions out.
 */
bool WriteMeta(vtkImageData* values, const std::string& path)
{
  const auto writer = itk::MetaImageIO::New();
  writer->SetFileName(path);
  writer->SetNumberOfDimensions(3);
  writer->SetComponentType(itk::IOComponentEnum::FLOAT);
  itk::ImageIORegion region(3);
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto* const direction = values->GetDirectionMatrix();
    region.SetSize(axis, values->GetDimensions()[axis]);
    writer->SetDimensions(axis, values->GetDimensions()[axis]);
    writer->SetSpacing(axis, values->GetSpacing()[axis]);
    writer->SetOrigin(axis, values->GetOrigin()[axis]);
    writer->SetDirection(axis,
      { direction->GetElement(0, axis), direction->GetElement(1, axis),
        direction->GetElement(2, axis) });
  }
  writer->SetIORegion(region);
  writer->Write(values->GetScalarPointer());
  return true; // unless it throws
}

struct ValueFormat
{
  const char* Name; // the ending
  bool (*Write)(vtkImageData* values, const std::string& path);
};

constexpr ValueFormat Formats[] = { { ".nii", WriteNIFTI }, { ".nii.gz", WriteNIFTI },
  { ".mha", WriteMeta }, { ".tif", WriteTIFF }, { ".tiff", WriteTIFF } };

/**
 * Write a file and read it: the writers do not report all errors, such as that the disk is full.
 */
bool WriteAndRead(vtkImageData* values, const std::string& path)
{
  try
  {
    const QuietReading quiet;
    return FindByEnding(Formats, path)->Write(values, path) && !quiet.HasErrors() &&
      ReadVolume(path, {}).Image->GetNumberOfPoints() == values->GetNumberOfPoints();
  }
  catch (const std::exception&)
  {
    return false;
  }
}
}

std::vector<std::string> GetValueEndings()
{
  return ListNames(Formats);
}

bool IsValueFile(const std::string& path)
{
  return FindByEnding(Formats, path) != nullptr;
}

void WriteValues(
  vtkImageData* picture, const std::array<double, 3>& origin, const std::string& path)
{
  vtkNew<vtkImageCast> cast;
  cast->SetInputData(picture);
  cast->SetOutputScalarTypeToFloat();
  cast->Update();
  vtkImageData* const values = cast->GetOutput();
  const double* const first = picture->GetOrigin();
  values->SetOrigin(first[0] + origin[0], first[1] + origin[1], first[2] + origin[2]);
  values->SetDirectionMatrix(picture->GetDirectionMatrix()); // which filters do not pass on
  WriteSafely({ path },
    [&](const std::vector<std::string>& names) { return WriteAndRead(values, names.front()); });
}
