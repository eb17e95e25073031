// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Writing/ValueFile.h"

#include "Reading/QuietReading.h"
#include "Reading/Reading.h"
#include "Reading/VolumeReader.h"
#include "Writing/SafeFiles.h"

#include "vtkImageCast.h"
#include "vtkMatrix3x3.h"
#include "vtkMatrix4x4.h"
#include "vtkNIFTIImageWriter.h"
#include "vtkNew.h"
#include "vtkSmartPointer.h"
#include "vtkTIFFWriter.h"

#include <vtksys/SystemTools.hxx>

#include <tiffio.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace
{
/**
 * NIfTI counts from left to right and back to front. VTK's writer adds the image's origin as it
 * lies along the image's axes.
 */
vtkSmartPointer<vtkMatrix4x4> MakeForm(vtkImageData* values)
{
  auto form = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 3; ++row)
  {
    const double sign = row < 2 ? -1.0 : 1.0;
    double offset = values->GetOrigin()[row];
    for (int column = 0; column < 3; ++column)
    {
      const double element = values->GetDirectionMatrix()->GetElement(row, column);
      form->SetElement(row, column, sign * element);
      offset -= element * values->GetOrigin()[column];
    }
    form->SetElement(row, 3, sign * offset);
  }
  return form;
}

/**
 * By one of VTK's writers, whose reports are not for the user.
 */
bool WriteWith(vtkImageWriter* writer, vtkImageData* values, const std::string& path)
{
  const QuietReading quiet;
  writer->SetInputData(values);
  writer->SetFileName(path.c_str());
  writer->Write();
  return !writer->GetErrorCode() && !quiet.HasErrors();
}

bool WriteNIFTI(vtkImageData* values, const std::string& path)
{
  const auto form = MakeForm(values);
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
 * By hand, because VTK's writer leaves directions out.
 */
bool WriteMeta(vtkImageData* values, const std::string& path)
{
  const int* const size = values->GetDimensions();
  const double* const spacing = values->GetSpacing();
  const double* const origin = values->GetOrigin();
  std::ofstream file(path, std::ios::binary);
  file.precision(17);
  file << "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = ";
#ifdef VTK_WORDS_BIGENDIAN
  file << "True";
#else
  file << "False";
#endif
  file << "\nTransformMatrix =";
  for (int i = 0; i < 9; ++i)
  {
    file << ' ' << values->GetDirectionMatrix()->GetElement(i % 3, i / 3);
  }
  file << "\nOffset = " << origin[0] << ' ' << origin[1] << ' ' << origin[2]
       << "\nElementSpacing = " << spacing[0] << ' ' << spacing[1] << ' ' << spacing[2]
       << "\nDimSize = " << size[0] << ' ' << size[1]
       << " 1\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n";
  file.write(static_cast<const char*>(values->GetScalarPointer()),
    static_cast<std::streamsize>(values->GetNumberOfPoints() * sizeof(float)));
  file.close();
  return !file.fail();
}

struct ValueFormat
{
  const char* Name; // the ending
  bool (*Write)(vtkImageData* values, const std::string& path);
};

constexpr ValueFormat Formats[] = { { ".nii", WriteNIFTI }, { ".nii.gz", WriteNIFTI },
  { ".mha", WriteMeta }, { ".tif", WriteTIFF }, { ".tiff", WriteTIFF } };

const ValueFormat* FindFormat(const std::string& path)
{
  const auto* const found = std::find_if(std::begin(Formats), std::end(Formats),
    [&](const ValueFormat& format)
    { return vtksys::SystemTools::StringEndsWith(path, format.Name); });
  return found == std::end(Formats) ? nullptr : found;
}

/**
 * Whether a file has as many values: VTK's writers do not report that the disk is full.
 */
bool CanBeRead(const std::string& path, vtkImageData* values)
{
  try
  {
    return ReadVolume(path, {}).Image->GetNumberOfPoints() == values->GetNumberOfPoints();
  }
  catch (const std::runtime_error&)
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
  return FindFormat(path) != nullptr;
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
    [&](const std::vector<std::string>& names)
    { return FindFormat(path)->Write(values, names.front()) && CanBeRead(names.front(), values); });
}
