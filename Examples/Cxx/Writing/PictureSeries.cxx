// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Writing/PictureSeries.h"

#include "ProgressLine.h"
#include "Reading/Reading.h"

#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#ifdef SPLATMIP_HAS_DICOM
#include "Writing/DICOMFilm.h"
#endif
#ifdef SPLATMIP_HAS_THEORA
#include "vtkOggTheoraWriter.h"
#endif

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace
{
/// The file of one of numbered pictures.
std::string NumberName(const std::string& path, int n)
{
  const std::filesystem::path name(path);
  char number[16];
  std::snprintf(number, sizeof(number), "-%05d", n);
  return (name.parent_path() / (name.stem().string() + number + name.extension().string()))
    .string();
}

void WritePNGs(
  vtkImageData* slices, const Palette& palette, const FilmSettings&, const std::string& path)
{
  const int count = slices->GetDimensions()[2];
  ProgressLine line("writing");
  for (int n = 0; n < count; ++n)
  {
    line.Show(double(n) / count);
    WritePNG(Paint(slices, palette, n), NumberName(path, n));
  }
}

#ifdef SPLATMIP_HAS_THEORA
void WriteTheora(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::string& path)
{
  if (!std::ofstream(path, std::ios::binary))
  {
    throw CannotWrite(path);
  }
  vtkNew<vtkOggTheoraWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetRate(settings.Rate);
  writer->SetQuality(2);
  writer->SubsamplingOff();
  const int count = slices->GetDimensions()[2];
  ProgressLine line("writing");
  for (int n = 0; n < count; ++n)
  {
    line.Show(double(n) / count);
    writer->SetInputData(Paint(slices, palette, n));
    if (n == 0)
    {
      writer->Start();
    }
    writer->Write();
  }
  writer->End();
  if (writer->GetError())
  {
    throw CannotWrite(path);
  }
}
#endif

#ifndef SPLATMIP_HAS_THEORA
constexpr auto WriteTheora = nullptr;
#endif
#ifndef SPLATMIP_HAS_DICOM
constexpr auto WriteDICOM = nullptr;
#endif

struct SeriesFormat
{
  const char* Ending;
  void (*Write)(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
    const std::string& path); // nullptr if there is no
  const char* Library;
};

constexpr SeriesFormat Formats[] = { { ".png", WritePNGs, "" },
  { ".ogv", WriteTheora, "Ogg Theora in its VTK" }, { ".dcm", WriteDICOM, "vtk-dicom" } };

const SeriesFormat* FindFormat(const std::string& path)
{
  const std::string ending = std::filesystem::path(path).extension().string();
  const auto* const found = std::find_if(std::begin(Formats), std::end(Formats),
    [&](const SeriesFormat& format) { return ending == format.Ending; });
  return found == std::end(Formats) ? nullptr : found;
}
}

std::runtime_error CannotWrite(const std::string& path)
{
  return std::runtime_error(
    path + ": this cannot be written; give a file in a folder that you may write to (--output).");
}

void CheckWritable(const std::string& path, bool isNumbered)
{
  const std::string name = isNumbered ? NumberName(path, 0) : path;
  std::error_code error;
  const bool isThere = std::filesystem::exists(name, error);
  if (!std::ofstream(name, std::ios::binary | std::ios::app))
  {
    throw CannotWrite(name);
  }
  if (!isThere)
  {
    std::filesystem::remove(name, error);
  }
}

vtkSmartPointer<vtkImageData> Paint(vtkImageData* slices, const Palette& palette, int n)
{
  const int* const size = slices->GetDimensions();
  auto picture = vtkSmartPointer<vtkImageData>::New();
  picture->SetDimensions(size[0], size[1], 1);
  picture->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const auto* const from = static_cast<unsigned char*>(slices->GetScalarPointer(0, 0, n));
  auto* const to = static_cast<unsigned char*>(picture->GetScalarPointer());
  if (slices->GetNumberOfScalarComponents() == 3)
  {
    std::copy_n(from, 3 * picture->GetNumberOfPoints(), to);
    return picture;
  }
  for (vtkIdType p = 0; p < picture->GetNumberOfPoints(); ++p)
  {
    std::copy_n(palette[from[p]].data(), 3, to + 3 * p);
  }
  return picture;
}

void WritePNG(vtkImageData* image, const std::string& path)
{
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes->GetPointer(0)), bytes->GetNumberOfValues());
  file.close();
  if (!file)
  {
    throw CannotWrite(path);
  }
}

std::vector<std::string> GetSeriesEndings()
{
  std::vector<std::string> endings;
  for (const SeriesFormat& format : Formats)
  {
    endings.emplace_back(format.Ending);
  }
  return endings;
}

std::string CheckSeriesName(const std::string& path)
{
  const SeriesFormat* const format = FindFormat(path);
  if (!format)
  {
    return "a turn is written as " + JoinWords(GetSeriesEndings());
  }
  return format->Write ? ""
                       : std::string("this build has no ") + format->Library + " to write " +
      format->Ending + " with: take .png";
}

void WriteSeries(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::string& path)
{
  FindFormat(path)->Write(slices, palette, settings, path);
}
