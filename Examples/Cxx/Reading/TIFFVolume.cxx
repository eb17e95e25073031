// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/TIFFVolume.h"

#include "Reading/Placement.h"
#include "Reading/Reading.h"
#include "Reading/TIFFPages.h"

#include "vtkXMLDataElement.h"
#include "vtkXMLUtilities.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

namespace
{
/**
 * What the pages are, as far as the description says.
 */
struct Layout
{
  int Slices = 1;
  int Channels = 1;
  int Times = 1;
  std::vector<int> Pages;          // of (slice, channel, time), the slice changing fastest
  std::array<double, 3> Size = {}; // of a voxel, in the unit, or 0
  std::string Unit;
};

/**
 * The number of a page by those of slice, channel and time, which change in the order of the
 * letters Z, C and T.
 */
int FindPage(const Layout& layout, const std::string& order, int slice, int channel, int time)
{
  int page = 0;
  int step = 1;
  for (const char axis : order)
  {
    page += step * (axis == 'Z' ? slice : axis == 'C' ? channel : time);
    step *= axis == 'Z' ? layout.Slices : axis == 'C' ? layout.Channels : layout.Times;
  }
  return page;
}

/**
 * Number all pages in an order; none if there are more than any file has.
 */
void NumberPages(Layout& layout, const std::string& order)
{
  if (double(layout.Slices) * layout.Channels * layout.Times > 1e7)
  {
    return;
  }
  for (int time = 0; time < layout.Times; ++time)
  {
    for (int channel = 0; channel < layout.Channels; ++channel)
    {
      for (int slice = 0; slice < layout.Slices; ++slice)
      {
        layout.Pages.push_back(FindPage(layout, order, slice, channel, time));
      }
    }
  }
}

/**
 * Lines such as "slices=12"; channels change fastest, times slowest.
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
  const auto count = [&](const char* name) { return std::max(1, std::atoi(fields[name].c_str())); };
  Layout layout;
  layout.Channels = count("channels");
  layout.Times = count("frames");
  layout.Slices = fields.count("slices")
    ? count("slices")
    : std::max(count("images"), pages.GetCount()) / (layout.Channels * layout.Times);
  NumberPages(layout, "CZT");
  layout.Unit = fields["unit"] == "pixel" ? "" : fields["unit"];
  const double depth = std::atof(fields["spacing"].c_str());
  layout.Size = { 1.0 / pages.GetResolution()[0], 1.0 / pages.GetResolution()[1],
    depth != 0.0 ? std::abs(depth) : 1.0 };
  return layout;
}

int GetNumber(vtkXMLDataElement* element, const char* name, int usual)
{
  const char* const text = element->GetAttribute(name);
  return text ? std::atoi(text) : usual;
}

/**
 * Let elements TiffData say which pages the planes are.
 */
void AssignPages(Layout& layout, vtkXMLDataElement* pixels, const std::string& order)
{
  const int count = static_cast<int>(layout.Pages.size());
  std::vector<int> pages(static_cast<std::size_t>(count), -1); // by the number in the order
  for (int n = 0; n < pixels->GetNumberOfNestedElements(); ++n)
  {
    vtkXMLDataElement* const data = pixels->GetNestedElement(n);
    if (std::string(data->GetName()) != "TiffData")
    {
      continue;
    }
    const int first = FindPage(layout, order, GetNumber(data, "FirstZ", 0),
      GetNumber(data, "FirstC", 0), GetNumber(data, "FirstT", 0));
    const int page = GetNumber(data, "IFD", 0);
    const int planes = GetNumber(data, "PlaneCount", data->GetAttribute("IFD") ? 1 : count);
    for (int plane = 0; plane < planes && first >= 0 && first + plane < count; ++plane)
    {
      pages[static_cast<std::size_t>(first + plane)] = page + plane;
    }
  }
  if (std::any_of(pages.begin(), pages.end(), [](int page) { return page >= 0; }))
  {
    for (int& page : layout.Pages)
    {
      page = pages[static_cast<std::size_t>(page)];
    }
  }
}

/**
 * The first image of OME's XML.
 */
Layout ParseOME(const TIFFPages& pages, const std::string& path)
{
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
    vtkXMLUtilities::ReadElementFromString(pages.GetDescription().c_str()));
  vtkXMLDataElement* const image = root ? root->FindNestedElementWithName("Image") : nullptr;
  vtkXMLDataElement* const pixels = image ? image->FindNestedElementWithName("Pixels") : nullptr;
  const char* const order = pixels ? pixels->GetAttribute("DimensionOrder") : nullptr;
  if (!order || std::string(order).size() != 5)
  {
    Refuse(path, "its OME description is damaged; export the volume again.");
  }
  Layout layout;
  layout.Slices = std::max(1, GetNumber(pixels, "SizeZ", 1));
  layout.Channels = std::max(1, GetNumber(pixels, "SizeC", 1) / pages.GetComponents());
  layout.Times = std::max(1, GetNumber(pixels, "SizeT", 1));
  NumberPages(layout, order + 2);
  AssignPages(layout, pixels, order + 2);
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
  NumberPages(layout, "Z");
  return layout;
}

void PlaceStack(Volume& volume, const Layout& layout)
{
  const bool isSized = !layout.Unit.empty() &&
    std::all_of(layout.Size.begin(), layout.Size.end(),
      [](double length) { return length > 0.0 && std::isfinite(length); });
  const auto size = isSized ? layout.Size : std::array<double, 3>{ 1.0, 1.0, 1.0 };
  PlaceVolume(
    volume, { { { size[0], 0.0, 0.0 }, { 0.0, size[1], 0.0 }, { 0.0, 0.0, size[2] } } }, {});
  if (isSized)
  {
    ConvertToMillimeters(volume, layout.Unit);
    volume.Notes.push_back(
      "TIFF does not say how voxels lie: pages from the feet on, seen from the feet");
    return;
  }
  volume.Notes.push_back("TIFF does not say how large voxels are and how they lie: cubes of 1 mm, "
                         "pages from the feet on, seen from the feet");
  volume.Caution = "voxel size unknown";
}
}

Volume ReadTIFF(const std::string& path, const ReadSettings& settings, const QuietReading&)
{
  TIFFPages pages(path);
  const Layout layout = FindLayout(pages, path);
  const bool isBehind = pages.GetCount() == 1 && layout.Pages.size() > 1; // as ImageJ writes
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
  CheckChoice(path, "channel", settings.Channel, layout.Channels);
  CheckChoice(path, "volume", settings.Frame, layout.Times);
  const int channel = std::max(1, settings.Channel), time = std::max(1, settings.Frame);
  CheckMemory(double(pages.GetWidth()) * pages.GetHeight() * layout.Slices, path);
  Volume volume;
  volume.Image = vtkSmartPointer<vtkImageData>::New();
  volume.Image->SetDimensions(pages.GetWidth(), pages.GetHeight(), layout.Slices);
  volume.Image->AllocateScalars(pages.GetVTKType(), pages.GetComponents());
  for (int slice = 0; slice < layout.Slices; ++slice)
  {
    const int plane = ((time - 1) * layout.Channels + channel - 1) * layout.Slices + slice;
    const int page = layout.Pages[static_cast<std::size_t>(plane)];
    auto* const pixels = static_cast<char*>(volume.Image->GetScalarPointer(0, 0, slice));
    isBehind ? pages.ReadBehind(page, pixels) : pages.Read(page, pixels);
  }
  PlaceStack(volume, layout);
  if (layout.Channels > 1)
  {
    volume.Notes.push_back(DescribeChoice("channel", channel, layout.Channels));
  }
  if (layout.Times > 1)
  {
    volume.Notes.push_back(DescribeChoice("volume", time, layout.Times));
  }
  return volume;
}
