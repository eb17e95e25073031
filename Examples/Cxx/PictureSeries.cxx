// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "PictureSeries.h"

#include "ProgressLine.h"
#include "Reading.h"

#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkSmartPointer.h"
#include "vtkUnsignedCharArray.h"
#ifdef SPLATMIP_HAS_AVI
#include "AVIFilm.h"
#endif
#ifdef SPLATMIP_HAS_DICOM
#include "DICOMFilm.h"
#endif
#ifdef SPLATMIP_HAS_THEORA
#include "vtkOggTheoraWriter.h"
#endif
#ifdef SPLATMIP_HAS_GIF
#include <gif_lib.h>
#endif

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

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

#ifdef SPLATMIP_HAS_GIF
/// Written by giflib, 256 colours for all pictures.
class GIFFile
{
public:
  GIFFile(const std::string& path, const int size[2], const Palette& palette) : Path(path)
  {
    // A file that giflib creates is for its owner alone.
    const std::ofstream usual(path, std::ios::binary);
    this->File = EGifOpenFileName(path.c_str(), false, nullptr);
    Size[0] = size[0];
    Size[1] = size[1];
    if (!this->File)
    {
      throw CannotWrite(path);
    }
    EGifSetGifVersion(this->File, true);
    const std::unique_ptr<ColorMapObject, decltype(&GifFreeMapObject)> colors(
      GifMakeMapObject(256, nullptr), &GifFreeMapObject);
    for (int n = 0; n < 256; ++n)
    {
      colors->Colors[n] = { palette[n][0], palette[n][1], palette[n][2] };
    }
    this->Check(EGifPutScreenDesc(this->File, size[0], size[1], 8, 0, colors.get()));
    // For ever, as browsers know it.
    const unsigned char times[3] = { 1, 0, 0 };
    this->Check(EGifPutExtensionLeader(this->File, APPLICATION_EXT_FUNC_CODE));
    this->Check(EGifPutExtensionBlock(this->File, 11, "NETSCAPE2.0"));
    this->Check(EGifPutExtensionBlock(this->File, 3, times));
    this->Check(EGifPutExtensionTrailer(this->File));
  }
  ~GIFFile()
  {
    if (this->File)
    {
      EGifCloseFile(this->File, nullptr);
    }
  }
  GIFFile(const GIFFile&) = delete;
  GIFFile& operator=(const GIFFile&) = delete;

  /// Bottom row first; the delay is in 1/100 s.
  void Add(const unsigned char* pixels, int delay)
  {
    GraphicsControlBlock control = { DISPOSE_DO_NOT, false, delay, NO_TRANSPARENT_COLOR };
    GifByteType bytes[4];
    this->Check(EGifPutExtension(this->File, GRAPHICS_EXT_FUNC_CODE,
      static_cast<int>(EGifGCBToExtension(&control, bytes)), bytes));
    this->Check(EGifPutImageDesc(this->File, 0, 0, this->Size[0], this->Size[1], false, nullptr));
    std::vector<GifPixelType> row(this->Size[0]); // giflib wants to write to it
    for (int y = this->Size[1] - 1; y >= 0; --y)
    {
      std::copy_n(pixels + std::ptrdiff_t(y) * this->Size[0], this->Size[0], row.begin());
      this->Check(EGifPutLine(this->File, row.data(), this->Size[0]));
    }
  }

  void Close()
  {
    GifFileType* const file = this->File;
    this->File = nullptr;
    this->Check(EGifCloseFile(file, nullptr));
  }

private:
  void Check(int result) const
  {
    if (result != GIF_OK)
    {
      throw CannotWrite(this->Path);
    }
  }

  std::string Path;
  GifFileType* File = nullptr;
  int Size[2];
};

void WriteGIF(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::string& path)
{
  GIFFile file(path, slices->GetDimensions(), palette);
  const int count = slices->GetDimensions()[2];
  ProgressLine line("writing");
  for (int n = 0; n < count; ++n)
  {
    line.Show(double(n) / count);
    file.Add(static_cast<unsigned char*>(slices->GetScalarPointer(0, 0, n)),
      std::max(2, (100 + settings.Rate / 2) / settings.Rate)); // browsers take less for more
  }
  file.Close();
}
#endif

#ifndef SPLATMIP_HAS_GIF
constexpr auto WriteGIF = nullptr;
#endif
#ifndef SPLATMIP_HAS_AVI
constexpr auto WriteAVI = nullptr;
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
  bool TakesColors;
};

constexpr SeriesFormat Formats[] = { { ".png", WritePNGs, "", true },
  { ".gif", WriteGIF, "giflib", false }, { ".avi", WriteAVI, "libavformat and libavcodec", false },
  { ".ogv", WriteTheora, "Ogg Theora in its VTK", true },
  { ".dcm", WriteDICOM, "vtk-dicom", true } };

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

std::string CheckSeriesName(const std::string& path, bool isColored)
{
  const SeriesFormat* const format = FindFormat(path);
  if (!format)
  {
    return "a turn is written as " + JoinWords(GetSeriesEndings());
  }
  if (!format->Write)
  {
    return std::string("this build has no ") + format->Library + " to write " + format->Ending +
      " with: take .png";
  }
  return isColored && !format->TakesColors
    ? std::string(format->Ending) + " does not hold the colours of depths: take .png"
    : "";
}

void WriteSeries(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::string& path)
{
  FindFormat(path)->Write(slices, palette, settings, path);
}
