// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/TIFFPages.h"

#include "Reading/Reading.h"

#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <tuple>

namespace
{
template <class Value>
Value GetTag(TIFF* file, std::uint32_t tag)
{
  Value value = {};
  TIFFGetFieldDefaulted(file, tag, &value);
  return value;
}

/// libtiff's last error.
std::string Report;

void KeepReport(const char*, const char* format, va_list values)
{
  char text[200];
  std::vsnprintf(text, sizeof(text), format, values);
  Report = text;
}
}

TIFFPages::TIFFPages(const std::string& path) : Path(path), File(nullptr, TIFFClose)
{
  Report.clear();
  TIFFSetErrorHandler(KeepReport);
  TIFFSetWarningHandler(nullptr);
  this->File.reset(TIFFOpen(path.c_str(), "r"));
  if (!this->File)
  {
    this->RefuseReported();
  }
  TIFF* const file = this->File.get();
  std::uint32_t page = 0;
  do
  {
    const auto kind = GetTag<std::uint32_t>(file, TIFFTAG_SUBFILETYPE);
    if ((kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0)
    {
      this->CheckType();
      this->CheckKind();
      this->Pages.push_back(page);
    }
    ++page;
  } while (TIFFReadDirectory(file));
  if (!Report.empty() || this->Pages.empty())
  {
    this->RefuseReported();
  }
}

void TIFFPages::RefuseReported() const
{
  RefuseDamaged(this->Path, Report);
}

void TIFFPages::RefuseTag(const char* tag, double value, const std::string& advice) const
{
  std::ostringstream text;
  text << "page " << this->Pages.size() + 1 << " has " << tag << " = " << value
       << ", which is not supported; " << advice << ".";
  Refuse(this->Path, text.str());
}

void TIFFPages::CheckType() const
{
  TIFF* const file = this->File.get();
  const std::string asGray = "save the stack as gray values, uncompressed";
  const auto photometric = GetTag<std::uint16_t>(file, TIFFTAG_PHOTOMETRIC);
  if (photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_RGB)
  {
    this->RefuseTag("PhotometricInterpretation", photometric,
      photometric == PHOTOMETRIC_MINISWHITE ? "invert the stack and save it again" : asGray);
  }
  const auto compression = GetTag<std::uint16_t>(file, TIFFTAG_COMPRESSION);
  if (!TIFFIsCODECConfigured(compression))
  {
    this->RefuseTag("Compression", compression, asGray);
  }
  const auto planes = GetTag<std::uint16_t>(file, TIFFTAG_PLANARCONFIG);
  if (planes != PLANARCONFIG_CONTIG && GetTag<std::uint16_t>(file, TIFFTAG_SAMPLESPERPIXEL) > 1)
  {
    this->RefuseTag("PlanarConfiguration", planes, "save the stack with interleaved samples");
  }
  const auto bits = GetTag<std::uint16_t>(file, TIFFTAG_BITSPERSAMPLE);
  const auto format = GetTag<std::uint16_t>(file, TIFFTAG_SAMPLEFORMAT);
  const bool isFloat = format == SAMPLEFORMAT_IEEEFP;
  if (format != SAMPLEFORMAT_UINT && format != SAMPLEFORMAT_INT && !isFloat)
  {
    this->RefuseTag("SampleFormat", format, "save the stack as integers or float");
  }
  if ((bits != 8 && bits != 16 && bits != 32 && bits != 64) || (isFloat && bits < 32))
  {
    this->RefuseTag(isFloat ? "SampleFormat = 3 (float) and BitsPerSample" : "BitsPerSample", bits,
      "save the stack with 8, 16 or 32 bits");
  }
  const auto depth = GetTag<std::uint32_t>(file, TIFFTAG_IMAGEDEPTH);
  if (depth > 1)
  {
    this->RefuseTag("ImageDepth", depth, "save the stack with a page for each slice");
  }
}

void TIFFPages::CheckKind()
{
  TIFF* const file = this->File.get();
  const auto bits = GetTag<std::uint16_t>(file, TIFFTAG_BITSPERSAMPLE);
  const auto format = GetTag<std::uint16_t>(file, TIFFTAG_SAMPLEFORMAT);
  const auto width = GetTag<std::uint32_t>(file, TIFFTAG_IMAGEWIDTH);
  const auto height = GetTag<std::uint32_t>(file, TIFFTAG_IMAGELENGTH);
  const auto samples = GetTag<std::uint16_t>(file, TIFFTAG_SAMPLESPERPIXEL);
  if (width < 1 || height < 1 || samples < 1)
  {
    this->RefuseReported();
  }
  if (this->Pages.empty())
  {
    this->Width = width;
    this->Height = height;
    this->Samples = samples;
    this->Bits = bits;
    this->Format = format;
    const auto* const text = GetTag<const char*>(file, TIFFTAG_IMAGEDESCRIPTION);
    this->Description = text ? text : "";
    this->Resolution[0] = GetTag<float>(file, TIFFTAG_XRESOLUTION);
    this->Resolution[1] = GetTag<float>(file, TIFFTAG_YRESOLUTION);
    return;
  }
  const std::tuple<const char*, std::uint32_t, std::uint32_t> tags[] = { { "ImageWidth", width,
                                                                           this->Width },
    { "ImageLength", height, this->Height }, { "SamplesPerPixel", samples, this->Samples },
    { "BitsPerSample", bits, this->Bits }, { "SampleFormat", format, this->Format } };
  for (const auto& [name, found, first] : tags)
  {
    if (found != first)
    {
      this->RefuseTag(name, found,
        "the first page has " + std::to_string(first) +
          ": save the pages of each kind as a stack of their own");
    }
  }
}

int TIFFPages::GetVTKType() const
{
  return FindScalarType(
    this->Bits / 8U, this->Format == SAMPLEFORMAT_IEEEFP, this->Format == SAMPLEFORMAT_INT);
}

void TIFFPages::Read(int page, char* pixels)
{
  if (!TIFFSetDirectory(this->File.get(), static_cast<tdir_t>(this->Pages[page])))
  {
    this->RefuseReported();
  }
  TIFF* const file = this->File.get();
  const bool isTiled = TIFFIsTiled(file) != 0; // else strips, which are tiles as wide as the page
  const auto width = isTiled ? GetTag<std::uint32_t>(file, TIFFTAG_TILEWIDTH) : this->Width;
  const auto height = isTiled
    ? GetTag<std::uint32_t>(file, TIFFTAG_TILELENGTH)
    : std::min(this->Height, GetTag<std::uint32_t>(file, TIFFTAG_ROWSPERSTRIP));
  const std::size_t pixel = this->Samples * this->Bits / 8U;
  const std::size_t bytes = pixel * width * height;
  if (bytes == 0 || (isTiled && TIFFTileSize(file) != static_cast<tmsize_t>(bytes)))
  {
    this->RefuseReported();
  }
  std::vector<char> block(bytes);
  for (std::uint32_t y = 0; y < this->Height; y += height)
  {
    const std::uint32_t rows = std::min(height, this->Height - y);
    for (std::uint32_t x = 0; x < this->Width; x += width)
    {
      const std::uint32_t columns = std::min(width, this->Width - x);
      const auto found = isTiled ? TIFFReadTile(file, block.data(), x, y, 0, 0)
                                 : TIFFReadEncodedStrip(file, TIFFComputeStrip(file, y, 0),
                                     block.data(), static_cast<tmsize_t>(bytes));
      if (found < static_cast<tmsize_t>(pixel * width * rows))
      {
        this->RefuseReported();
      }
      for (std::uint32_t row = 0; row < rows; ++row)
      {
        std::memcpy(pixels + pixel * (std::size_t(y + row) * this->Width + x),
          block.data() + pixel * width * row, pixel * columns);
      }
    }
  }
}

void TIFFPages::ReadBehind(int number, char* pixels)
{
  TIFF* const file = this->File.get();
  const auto* const offsets = GetTag<const std::uint64_t*>(file, TIFFTAG_STRIPOFFSETS);
  if (!offsets || GetTag<std::uint16_t>(file, TIFFTAG_COMPRESSION) != COMPRESSION_NONE)
  {
    this->RefuseReported();
  }
  const std::size_t bytes = this->GetRowBytes() * this->Height;
  std::ifstream data(this->Path, std::ios::binary);
  data.seekg(static_cast<std::streamoff>(offsets[0] + bytes * static_cast<std::size_t>(number)));
  data.read(pixels, static_cast<std::streamsize>(bytes));
  if (!data)
  {
    this->RefuseReported();
  }
  const std::size_t size = this->Bits / 8U;
  for (std::size_t i = 0; i < bytes && TIFFIsByteSwapped(file); i += size)
  {
    std::reverse(pixels + i, pixels + i + size);
  }
}
