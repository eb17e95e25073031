// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Writing/PictureSeries.h"

#include "ProgressLine.h"
#include "Reading/QuietReading.h"
#include "Reading/Reading.h"
#include "Writing/SafeFiles.h"

#include "vtkExtractVOI.h"
#include "vtkImageMapToColors.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#ifdef SPLATMIP_HAS_THEORA
#include "vtkOggTheoraWriter.h"
#endif

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace
{
/// Make the name of a numbered picture.
std::string NumberName(const std::string& path, int n)
{
  const std::filesystem::path name(path);
  char number[16];
  std::snprintf(number, sizeof(number), "-%05d", n);
  return (name.parent_path() / (name.stem().string() + number + name.extension().string()))
    .string();
}

bool WritePNGs(
  vtkImageData* slices, const FilmSettings& settings, const std::vector<std::string>& names)
{
  const int count = slices->GetDimensions()[2];
  ProgressLine line("writing");
  bool isComplete = true;
  for (int n = 0; n < count && isComplete; ++n)
  {
    line.Show(double(n) / count);
    isComplete = WritePNG(Paint(slices, settings.Palette, n), names[n]);
  }
  return isComplete;
}

#ifdef SPLATMIP_HAS_THEORA
/**
 * Return whether the pages of an Ogg file follow each other up to the last: vtkOggTheoraWriter does
 * not report that the disk is full.
 */
bool IsCompleteOgg(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::array<unsigned char, 27> page = {};
  std::array<unsigned char, 255> lengths;
  const std::uint64_t size = std::filesystem::file_size(path);
  std::uint64_t end = 0;
  for (std::uint32_t number = 0; file.read(reinterpret_cast<char*>(page.data()), page.size());
       ++number)
  {
    file.read(reinterpret_cast<char*>(lengths.data()), page[26]);
    const auto body = std::accumulate(lengths.begin(), lengths.begin() + page[26], 0);
    const std::uint32_t found =
      page[18] | page[19] << 8 | page[20] << 16 | std::uint32_t(page[21]) << 24;
    file.seekg(body, std::ios::cur);
    end += page.size() + page[26] + body;
    if (!file || std::string(page.begin(), page.begin() + 4) != "OggS" || found != number)
    {
      return false;
    }
  }
  return end == size && (page[5] & 4) != 0;
}

bool WriteTheora(
  vtkImageData* slices, const FilmSettings& settings, const std::vector<std::string>& names)
{
  const QuietReading quiet;
  vtkNew<vtkOggTheoraWriter> writer;
  writer->SetFileName(names.front().c_str());
  writer->SetRate(settings.Rate);
  writer->SetQuality(2);
  writer->SubsamplingOff();
  const int count = slices->GetDimensions()[2];
  ProgressLine line("writing");
  for (int n = 0; n < count; ++n)
  {
    line.Show(double(n) / count);
    writer->SetInputData(Paint(slices, settings.Palette, n));
    if (n == 0)
    {
      writer->Start();
    }
    writer->Write();
  }
  writer->End();
  return !writer->GetError() && IsCompleteOgg(names.front());
}
#else
constexpr auto WriteTheora = nullptr;
#endif
#ifdef SPLATMIP_HAS_DICOM
constexpr auto DICOMWriter = WriteDICOM;
#else
constexpr auto DICOMWriter = nullptr;
#endif

struct SeriesFormat
{
  const char* Name; // the ending
  bool (*Write)(vtkImageData* slices, const FilmSettings& settings,
    const std::vector<std::string>& names); // nullptr if this build has no
  const char* Library;
};

constexpr SeriesFormat Formats[] = { { ".png", WritePNGs, "" },
  { ".ogv", WriteTheora, "Ogg Theora in its VTK" }, { ".dcm", DICOMWriter, "vtk-dicom" } };
}

vtkSmartPointer<vtkImageData> Paint(vtkImageData* slices, vtkColorTransferFunction* palette, int n)
{
  const int* const size = slices->GetDimensions();
  vtkNew<vtkExtractVOI> slice;
  slice->SetInputData(slices);
  slice->SetVOI(0, size[0] - 1, 0, size[1] - 1, n, n);
  vtkNew<vtkImageMapToColors> paint;
  paint->SetInputConnection(slice->GetOutputPort());
  paint->SetLookupTable(slices->GetNumberOfScalarComponents() == 1 ? palette : nullptr);
  paint->SetOutputFormatToRGB();
  paint->Update();
  return paint->GetOutput();
}

bool WritePNG(vtkImageData* image, const std::string& path)
{
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes->GetPointer(0)), bytes->GetNumberOfValues());
  file.close();
  return !file.fail();
}

std::vector<std::string> GetSeriesEndings()
{
  return ListNames(Formats);
}

std::string CheckSeriesName(const std::string& path)
{
  const SeriesFormat* const format = FindByEnding(Formats, path);
  if (!format)
  {
    return "a turn is written as " + JoinWords(GetSeriesEndings());
  }
  return format->Write ? ""
                       : std::string("this build has no ") + format->Library + " to write " +
      format->Name + " with: take .png";
}

std::vector<std::string> GetSeriesFiles(const std::string& path, int count)
{
  if (!vtksys::SystemTools::StringEndsWith(path, ".png"))
  {
    return { path };
  }
  std::vector<std::string> names;
  for (int n = 0; n < count; ++n)
  {
    names.push_back(NumberName(path, n));
  }
  return names;
}

void WriteSeries(vtkImageData* slices, const FilmSettings& settings, const std::string& path)
{
  WriteSafely(GetSeriesFiles(path, slices->GetDimensions()[2]),
    [&](const std::vector<std::string>& names)
    { return FindByEnding(Formats, path)->Write(slices, settings, names); });
}
