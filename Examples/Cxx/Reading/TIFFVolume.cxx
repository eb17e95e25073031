// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Placement.h"
#include "Reading/Reading.h"

#include "vtkXMLDataElement.h"
#include "vtkXMLUtilities.h"

#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <numeric>
#include <set>
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

/**
 * Get a number, which libtiff stores in 16 or 32 bits.
 */
std::uint32_t GetNumber(TIFF* file, std::uint32_t tag)
{
  return TIFFFieldDataType(TIFFFieldWithTag(file, tag)) == TIFF_SHORT
    ? GetTag<std::uint16_t>(file, tag)
    : GetTag<std::uint32_t>(file, tag);
}

/// libtiff's last error.
std::string Report;

void KeepReport(const char*, const char* format, va_list values)
{
  char text[200];
  std::vsnprintf(text, sizeof(text), format, values);
  Report = text;
}

/**
 * The pages of a TIFF file, which have the same size and type. Constructor and methods throw
 * std::runtime_error with one sentence, with tag and value where a page is not supported.
 */
class TIFFPages
{
public:
  explicit TIFFPages(const std::string& path);

  int GetWidth() const { return static_cast<int>(this->Width); }
  int GetHeight() const { return static_cast<int>(this->Height); }
  int GetVTKType() const;
  int GetComponents() const { return static_cast<int>(this->Samples); }

  /**
   * Get the number of pages, less masks and reduced copies of others.
   */
  int GetCount() const { return static_cast<int>(this->Pages.size()); }

  /**
   * Get the first page's description, and its pixels per unit, or 0.
   */
  const std::string& GetDescription() const { return this->Description; }
  const double* GetResolution() const { return this->Resolution; }

  /**
   * Read a page, from 0 on, top row first.
   */
  void Read(int page, char* pixels);

  /**
   * Read one of several pictures, from 0 on, that follow each other behind the only page.
   */
  void ReadBehind(int number, char* pixels);

private:
  [[noreturn]] void RefuseTag(const char* tag, double value, const std::string& advice) const;
  void CheckType() const;
  void CheckKind();
  [[noreturn]] void RefuseReported() const;
  std::size_t GetRowBytes() const { return this->Width * this->Samples * this->Bits / 8; }

  std::string Path;
  std::unique_ptr<tiff, void (*)(tiff*)> File;
  std::vector<std::uint32_t> Pages;
  std::uint32_t Width = 0;
  std::uint32_t Height = 0;
  std::uint32_t Bits = 1;
  std::uint32_t Format = 1;
  std::uint32_t Samples = 1;
  std::string Description;
  double Resolution[2] = { 0.0, 0.0 };
};

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
  const auto get = [file](std::uint32_t tag) { return GetNumber(file, tag); };
  const std::string asGray = "save the stack as gray values, uncompressed";
  const auto photometric = get(TIFFTAG_PHOTOMETRIC), compression = get(TIFFTAG_COMPRESSION);
  const auto planes = get(TIFFTAG_PLANARCONFIG), depth = get(TIFFTAG_IMAGEDEPTH);
  const auto bits = get(TIFFTAG_BITSPERSAMPLE), format = get(TIFFTAG_SAMPLEFORMAT);
  const bool isFloat = format == SAMPLEFORMAT_IEEEFP;
  const bool isInteger = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_INT;
  const bool hasBytes = bits == 8 || bits == 16 || bits == 32 || bits == 64;
  const std::tuple<const char*, std::uint32_t, bool, std::string> tags[] = {
    { "PhotometricInterpretation", photometric,
      photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_RGB,
      photometric == PHOTOMETRIC_MINISWHITE ? "invert the stack and save it again" : asGray },
    { "Compression", compression, TIFFIsCODECConfigured(compression) != 0, asGray },
    { "PlanarConfiguration", planes,
      planes == PLANARCONFIG_CONTIG || get(TIFFTAG_SAMPLESPERPIXEL) == 1,
      "save the stack with interleaved samples" },
    { "SampleFormat", format, isInteger || isFloat, "save the stack as integers or float" },
    { isFloat ? "SampleFormat = 3 (float) and BitsPerSample" : "BitsPerSample", bits,
      hasBytes && (bits >= 32 || !isFloat), "save the stack with 8, 16 or 32 bits" },
    { "ImageDepth", depth, depth <= 1, "save the stack with a page for each slice" }
  };
  for (const auto& [name, value, isSupported, advice] : tags)
  {
    if (!isSupported)
    {
      this->RefuseTag(name, value, advice);
    }
  }
}

void TIFFPages::CheckKind()
{
  TIFF* const file = this->File.get();
  if (this->Pages.empty())
  {
    const auto* const text = GetTag<const char*>(file, TIFFTAG_IMAGEDESCRIPTION);
    this->Description = text ? text : "";
    this->Resolution[0] = GetTag<float>(file, TIFFTAG_XRESOLUTION);
    this->Resolution[1] = GetTag<float>(file, TIFFTAG_YRESOLUTION);
  }
  const std::tuple<const char*, std::uint32_t, std::uint32_t&> tags[] = {
    { "ImageWidth", TIFFTAG_IMAGEWIDTH, this->Width },
    { "ImageLength", TIFFTAG_IMAGELENGTH, this->Height },
    { "SamplesPerPixel", TIFFTAG_SAMPLESPERPIXEL, this->Samples },
    { "BitsPerSample", TIFFTAG_BITSPERSAMPLE, this->Bits },
    { "SampleFormat", TIFFTAG_SAMPLEFORMAT, this->Format }
  };
  for (const auto& [name, tag, first] : tags)
  {
    const std::uint32_t found = GetNumber(file, tag);
    if (found < 1)
    {
      this->RefuseReported();
    }
    first = this->Pages.empty() ? found : first;
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

/// Damaged descriptions can have any numbers.
constexpr int MostPages = 10'000'000;

/**
 * The pages by the description. A plane is a picture of slice, channel and time, which change in
 * the order of the letters Z, C and T.
 */
struct Layout
{
  int Slices = 1;
  int Channels = 1;
  int Times = 1;
  std::string Order = "ZCT";
  bool IsContiguous = false;       // pictures may follow each other behind one page
  std::vector<int> Pages;          // of the planes
  std::array<double, 3> Size = {}; // of a voxel, in the unit, or 0
  std::string Unit;
};

/**
 * Find the number of a plane, from 0 on.
 */
std::int64_t FindPlane(const Layout& layout, int slice, int channel, int time)
{
  std::int64_t plane = 0, step = 1;
  for (const char axis : layout.Order)
  {
    plane += step * (axis == 'Z' ? slice : axis == 'C' ? channel : time);
    step *= axis == 'Z' ? layout.Slices : axis == 'C' ? layout.Channels : layout.Times;
  }
  return plane;
}

/**
 * Assign the pages to the planes in their order, none if there are too many.
 */
void NumberPages(Layout& layout)
{
  const double count = double(layout.Slices) * layout.Channels * layout.Times;
  layout.Pages.resize(count > MostPages ? 0 : static_cast<std::size_t>(count));
  std::iota(layout.Pages.begin(), layout.Pages.end(), 0);
}

/**
 * Convert text to a whole number that can be multiplied and added.
 */
int ParseNumber(const std::string& text)
{
  return static_cast<int>(std::clamp(std::strtol(text.c_str(), nullptr, 10), -1L, long(MostPages)));
}

/**
 * Parse lines such as "slices=12"; channels change fastest, times slowest.
 */
Layout ParseImageJ(const TIFFPages& pages)
{
  std::map<std::string, std::string> fields;
  std::istringstream text(pages.GetDescription());
  for (std::string line; std::getline(text, line);)
  {
    line.erase(line.find_last_not_of(" \r") + 1);
    const std::size_t end = line.find('=');
    if (end != std::string::npos)
    {
      fields.emplace(line.substr(0, end), line.substr(end + 1));
    }
  }
  const auto count = [&](const char* name) { return std::max(1, ParseNumber(fields[name])); };
  Layout layout;
  layout.IsContiguous = true;
  layout.Order = "CZT";
  layout.Channels = count("channels");
  layout.Times = count("frames");
  layout.Slices = fields.count("slices")
    ? count("slices")
    : std::max(1,
        static_cast<int>(
          std::max(count("images"), pages.GetCount()) / (double(layout.Channels) * layout.Times)));
  NumberPages(layout);
  layout.Unit = fields["unit"] == "pixel" ? "" : fields["unit"];
  const double depth = std::atof(fields["spacing"].c_str());
  layout.Size = { 1.0 / pages.GetResolution()[0], 1.0 / pages.GetResolution()[1],
    depth != 0.0 ? std::abs(depth) : 1.0 };
  return layout;
}

int GetNumber(vtkXMLDataElement* element, const char* name, int usual)
{
  const char* const text = element->GetAttribute(name);
  return text ? ParseNumber(text) : usual;
}

/**
 * Assign pages to planes by elements TiffData. Returns whether one file has all.
 */
bool AssignPages(Layout& layout, vtkXMLDataElement* pixels)
{
  const auto count = static_cast<int>(layout.Pages.size());
  std::vector<int> pages(layout.Pages.size(), -1);
  std::set<std::string> files;
  bool isAssigned = false;
  for (int n = 0; n < pixels->GetNumberOfNestedElements(); ++n)
  {
    vtkXMLDataElement* const data = pixels->GetNestedElement(n);
    if (std::string(data->GetName()) != "TiffData")
    {
      continue;
    }
    vtkXMLDataElement* const file = data->FindNestedElementWithName("UUID");
    const char* const name = file ? file->GetAttribute("FileName") : nullptr;
    files.insert(name ? name : "");
    const std::int64_t first = FindPlane(layout, GetNumber(data, "FirstZ", 0),
      GetNumber(data, "FirstC", 0), GetNumber(data, "FirstT", 0));
    const int page = GetNumber(data, "IFD", 0);
    const int planes = GetNumber(data, "PlaneCount", data->GetAttribute("IFD") ? 1 : count);
    for (int plane = 0; plane < planes && first >= 0 && first + plane < count; ++plane)
    {
      pages[static_cast<std::size_t>(first + plane)] = page + plane;
      isAssigned = true;
    }
  }
  layout.Pages = isAssigned ? pages : layout.Pages;
  return files.size() < 2;
}

/**
 * Parse the first image of OME's XML.
 */
Layout ParseOME(const TIFFPages& pages, const std::string& path)
{
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
    vtkXMLUtilities::ReadElementFromString(pages.GetDescription().c_str()));
  vtkXMLDataElement* const image = root ? root->FindNestedElementWithName("Image") : nullptr;
  vtkXMLDataElement* const pixels = image ? image->FindNestedElementWithName("Pixels") : nullptr;
  const char* const text = pixels ? pixels->GetAttribute("DimensionOrder") : nullptr;
  const std::string letters = text ? text : "", order = letters.substr(letters.find('Y') + 1);
  const std::string axes = "ZCT";
  if (!std::is_permutation(order.begin(), order.end(), axes.begin(), axes.end()))
  {
    Refuse(path, "its OME description is damaged; export the volume again.");
  }
  Layout layout;
  layout.Slices = std::max(1, GetNumber(pixels, "SizeZ", 1));
  layout.Channels = std::max(1, GetNumber(pixels, "SizeC", 1) / pages.GetComponents());
  layout.Times = std::max(1, GetNumber(pixels, "SizeT", 1));
  layout.Order = order;
  NumberPages(layout);
  if (!AssignPages(layout, pixels))
  {
    Refuse(path, "its planes are in several files, which is not supported; export one file.");
  }
  const char* const names[3] = { "PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ" };
  for (int axis = 0; axis < 3; ++axis)
  {
    const char* const size = pixels->GetAttribute(names[axis]);
    const char* const unit = pixels->GetAttribute((std::string(names[axis]) + "Unit").c_str());
    layout.Size[axis] = size ? std::atof(size) : axis == 2 ? layout.Size[0] : 0.0;
    layout.Unit = axis == 0 ? (unit ? unit : "um") : layout.Unit;
    if (unit && layout.Unit != unit)
    {
      Refuse(path, "its axes have different units of length; export the volume with one unit.");
    }
  }
  return layout;
}

Layout FindLayout(const TIFFPages& pages, const std::string& path)
{
  const std::string& text = pages.GetDescription();
  if (text.rfind("ImageJ=", 0) == 0)
  {
    return ParseImageJ(pages);
  }
  if (text.find("<OME ") != std::string::npos)
  {
    return ParseOME(pages, path);
  }
  Layout layout;
  layout.Slices = pages.GetCount();
  NumberPages(layout);
  return layout;
}

void PlaceStack(Volume& volume, const Layout& layout)
{
  const auto& size = layout.Size;
  const bool isSized = !layout.Unit.empty() &&
    std::all_of(size.begin(), size.end(),
      [](double length) { return length > 0.0 && std::isfinite(length); });
  const Steps steps = { { { size[0], 0.0, 0.0 }, { 0.0, size[1], 0.0 }, { 0.0, 0.0, size[2] } } };
  PlaceVolume(volume, isSized ? steps : Steps(), {}, isSized ? layout.Unit : "");
  volume.Notes.push_back(
    "the file has no orientation: the first page is at the feet, the first row in front");
}
}

Volume ReadTIFF(const std::string& path, const ReadSettings& settings, const QuietReading&)
{
  TIFFPages pages(path);
  const Layout layout = FindLayout(pages, path);
  const bool isBehind =
    layout.IsContiguous && pages.GetCount() == 1 && layout.Pages.size() > 1; // as ImageJ writes
  const bool hasAll = std::all_of(layout.Pages.begin(), layout.Pages.end(),
    [&](int page) { return page >= 0 && (page < pages.GetCount() || isBehind); });
  if (layout.Pages.empty() || !hasAll)
  {
    Refuse(path,
      "its description and its pages differ: " + std::to_string(layout.Slices) + " slices, " +
        std::to_string(layout.Channels) + " channels and " + std::to_string(layout.Times) +
        " times, but " + std::to_string(pages.GetCount()) +
        " pages; save the volume as one file again.");
  }
  Volume volume;
  const int channel = Choose(path, "channel", settings.Channel, layout.Channels, volume.Notes);
  const int time = Choose(path, "volume", settings.Frame, layout.Times, volume.Notes);
  CheckMemory(double(pages.GetWidth()) * pages.GetHeight() * layout.Slices, path);
  volume.Image = vtkSmartPointer<vtkImageData>::New();
  volume.Image->SetDimensions(pages.GetWidth(), pages.GetHeight(), layout.Slices);
  volume.Image->AllocateScalars(pages.GetVTKType(), pages.GetComponents());
  for (int slice = 0; slice < layout.Slices; ++slice)
  {
    const std::int64_t plane = FindPlane(layout, slice, channel - 1, time - 1);
    const int page = layout.Pages[static_cast<std::size_t>(plane)];
    auto* const pixels = static_cast<char*>(volume.Image->GetScalarPointer(0, 0, slice));
    isBehind ? pages.ReadBehind(page, pixels) : pages.Read(page, pixels);
  }
  PlaceStack(volume, layout);
  return volume;
}
