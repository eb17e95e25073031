// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Placement.h"
#include "Reading/Reading.h"

#include "itkMetaDataObject.h"
#include "itkMetaImageIO.h"
#include "itkNrrdImageIO.h"

#include "vtkExtractVOI.h"
#include "vtkNew.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

namespace
{
std::string Trim(const std::string& text)
{
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r"), text.size());
  return text.substr(begin, text.find_last_not_of(" \t\r") + 1 - begin);
}

/**
 * Parts of a header that ITK does not report: the texts behind its keys, and the files with its
 * data.
 */
struct Header
{
  std::map<std::string, std::string> Fields; // less empty ones
  std::vector<std::string> Files;

  bool Has(const std::string& key) const { return this->Fields.count(key) > 0; }
  std::string Get(const std::string& key) const
  {
    return this->Has(key) ? this->Fields.at(key) : "";
  }
};

/**
 * Keys of NRRD are made lower-case; those of MetaImage are case-sensitive. ITK 5 cannot quote long
 * lines of NRRD in an error without a buffer overflow. Only values of private keys are so long in
 * sound files.
 */
Header ReadHeader(const std::string& path, char separator)
{
  constexpr std::size_t Longest = 500;
  Header header;
  std::istringstream text(ReadHead(path));
  for (std::string line; std::getline(text, line) && !Trim(line).empty();)
  {
    if (separator == ':' && line.size() > Longest && line[0] != '#' &&
      line.find(":=") == std::string::npos)
    {
      RefuseDamaged(path, "a line of its header is too long");
    }
    const std::size_t end = line.find(separator);
    const std::string value = Trim(line.substr(end == std::string::npos ? 0 : end + 1));
    const std::string key = end == std::string::npos ? "" : Trim(line.substr(0, end));
    if (!key.empty() && !value.empty())
    {
      header.Fields.emplace(separator == ':' ? vtksys::SystemTools::LowerCase(key) : key, value);
    }
    const std::filesystem::path file = std::filesystem::path(path).parent_path() / value;
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error)) // also in a list of files, a line each
    {
      header.Files.push_back(file.string());
    }
    if (key == "ElementDataFile" && value.compare(0, 4, "LIST") != 0)
    {
      break; // of MetaImage: data follow
    }
  }
  return header;
}

int GetScalarType(const itk::ImageIOBase* io, const std::string& path)
{
  const auto type = io->GetComponentType();
  const std::string name = itk::ImageIOBase::GetComponentTypeAsString(type); // of C, or unknown
  const bool isSigned = name.find("unsigned") == std::string::npos;
  const int found = type == itk::IOComponentEnum::UNKNOWNCOMPONENTTYPE
    ? VTK_VOID
    : FindScalarType(io->GetComponentSize(), name == "float" || name == "double", isSigned);
  if (found == VTK_VOID)
  {
    Refuse(path, "values of this type are not supported; save the volume as float.");
  }
  return found;
}

/**
 * Refuse a file for the last two of a chain of reasons, a line each, less the functions that report
 * them; or for the first of several reports.
 */
[[noreturn]] void RefuseUnread(const std::string& path, const std::string& report, bool isChain)
{
  std::vector<std::string> lines;
  for (std::string line : vtksys::SystemTools::SplitString(report, '\n'))
  {
    const std::size_t name = line.rfind("[nrrd] ", 0) == 0 ? line.find(": ") : std::string::npos;
    line.erase(0, name == std::string::npos ? 0 : name + 2);
    line.erase(line.find_last_not_of(" .:\r") + 1);
    if (!line.empty())
    {
      lines.push_back(line);
    }
  }
  std::string reason = lines.empty() ? "" : isChain ? lines.back() : lines.front();
  reason = lines.size() > 1 && isChain ? lines[lines.size() - 2] + ": " + reason : reason;
  if (reason.find("not available") != std::string::npos)
  {
    Refuse(path,
      "the encoding of its data is not supported (" + reason +
        "); save the volume with gzip or raw data.");
  }
  RefuseDamaged(path, reason);
}

/**
 * Read an image of at most three dimensions, with the frames behind each other along the third.
 */
vtkSmartPointer<vtkImageData> ReadImage(
  itk::ImageIOBase* io, const std::string& path, const QuietReading& quiet)
{
  try
  {
    itk::Object::GlobalWarningDisplayOff();
    io->SetFileName(path);
    io->ReadImageInformation();
    const int type = GetScalarType(io, path);
    const unsigned int dimensions = io->GetNumberOfDimensions();
    itk::ImageIORegion region(dimensions);
    double size[3] = { 1.0, 1.0, 1.0 };
    for (unsigned int axis = 0; axis < dimensions; ++axis)
    {
      region.SetSize(axis, io->GetDimensions(axis));
      size[std::min(axis, 2U)] *= static_cast<double>(io->GetDimensions(axis));
    }
    CheckMemory(size[0] * size[1] * size[2] * io->GetNumberOfComponents(), path);
    if (!(size[0] * size[1] * size[2] > 0.0) || *std::max_element(size, size + 3) > VTK_INT_MAX)
    {
      RefuseDamaged(path, "one of its sizes is 0 or too large");
    }
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(int(size[0]), int(size[1]), int(size[2]));
    image->AllocateScalars(type, static_cast<int>(io->GetNumberOfComponents()));
    io->SetIORegion(region);
    io->Read(image->GetScalarPointer());
    if (!quiet.GetPrinted().empty()) // by MetaIO, which reports incomplete data so
    {
      RefuseUnread(path, quiet.GetPrinted(), false);
    }
    return image;
  }
  catch (const itk::ExceptionObject& error)
  {
    const std::string printed = quiet.GetPrinted();
    RefuseUnread(path, printed.empty() ? error.GetDescription() : printed, printed.empty());
  }
}

/**
 * Return one of the frames along the third axis, from 1 on.
 */
vtkSmartPointer<vtkImageData> ExtractFrame(vtkImageData* image, int number, int count)
{
  const int* const size = image->GetDimensions();
  const int slices = size[2] / count;
  vtkNew<vtkExtractVOI> extract;
  extract->SetInputData(image);
  extract->SetVOI(0, size[0] - 1, 0, size[1] - 1, slices * (number - 1), slices * number - 1);
  extract->Update();
  return extract->GetOutput();
}

/**
 * Read the frame that the settings name, not placed yet.
 */
Volume ReadFrame(itk::ImageIOBase* io, const std::string& path, const ReadSettings& settings,
  const QuietReading& quiet, bool areComponentsFrames)
{
  Volume volume;
  volume.Image = ReadImage(io, path, quiet);
  int count = 1;
  for (unsigned int axis = 3; axis < io->GetNumberOfDimensions(); ++axis)
  {
    count *= static_cast<int>(io->GetDimensions(axis));
  }
  const bool isList = areComponentsFrames && count == 1;
  count = isList ? volume.Image->GetNumberOfScalarComponents() : count;
  const int number = Choose(path, "volume", settings.Frame, count, volume.Notes);
  if (count > 1)
  {
    volume.Image =
      isList ? ExtractComponent(volume.Image, number) : ExtractFrame(volume.Image, number, count);
  }
  return volume;
}

/**
 * Get steps and origin as ITK has them.
 */
void GetGrid(itk::ImageIOBase* io, Steps& steps, std::array<double, 3>& origin)
{
  steps = { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } };
  origin = {};
  const unsigned int dimensions = std::min(3U, io->GetNumberOfDimensions());
  for (unsigned int axis = 0; axis < dimensions; ++axis)
  {
    origin[axis] = io->GetOrigin(axis);
    for (unsigned int row = 0; row < dimensions; ++row)
    {
      steps[axis][row] = io->GetSpacing(axis) * io->GetDirection(axis)[row];
    }
  }
}

std::string GetEntry(itk::ImageIOBase* io, const std::string& key)
{
  std::string value;
  itk::ExposeMetaData<std::string>(io->GetMetaDataDictionary(), key, value);
  return value;
}

/**
 * Count the vectors in text such as "(1,0,0) none (nan,nan,nan)" that are not empty.
 */
std::size_t CountVectors(const std::string& text)
{
  std::size_t count = 0;
  for (std::size_t place = text.find('('); place != std::string::npos;
       place = text.find('(', place + 1))
  {
    count += text.compare(place, 4, "(nan") != 0;
  }
  return count;
}
}

Volume ReadNRRD(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  const Header header = ReadHeader(path, ':');
  const std::string kinds = header.Get("kinds");
  const auto io = itk::NrrdImageIO::New();
  Volume volume =
    ReadFrame(io, path, settings, quiet, kinds.empty() || kinds.find("list") != std::string::npos);
  volume.Files = header.Files;
  Steps steps;
  std::array<double, 3> origin;
  GetGrid(io, steps, origin);
  const std::string space = GetEntry(io, "NRRD_space");
  const std::string named = vtksys::SystemTools::LowerCase(header.Get("space"));
  if (vtksys::SystemTools::StringStartsWith(space, "right-anterior-superior-time") ||
    named == "left-anterior-superior" || named == "las")
  {
    TurnToLPS(steps, origin); // ITK turns no spaces with time, and x in place of y of LAS
  }
  volume.IsOriented = vtksys::SystemTools::StringStartsWith(space, "left-posterior-superior") ||
    vtksys::SystemTools::StringStartsWith(space, "right-anterior-superior");
  const std::string directions = header.Get("space directions");
  const unsigned int axes = std::min(3U, io->GetNumberOfDimensions());
  if (CountVectors(directions) < axes &&
    header.Get("spacings").find_first_of("0123456789") == std::string::npos)
  {
    steps = {};
    volume.IsOriented = false;
  }
  const std::string units = header.Get("space units"); // as in "mm" "mm" "mm"
  const std::size_t end = units.find('"', 1);
  PlaceVolume(volume, steps, origin,
    directions.empty()           ? ""
      : end == std::string::npos ? "mm"
                                 : units.substr(1, end - 1));
  return volume;
}

Volume ReadMeta(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  const Header header = ReadHeader(path, '=');
  const int dimensions = std::atoi(header.Get("NDims").c_str());
  if (dimensions < 2 || dimensions > 10) // ITK does not check the number
  {
    RefuseDamaged(path, "NDims is not a number from 2 to 10");
  }
  const auto io = itk::MetaImageIO::New();
  Volume volume = ReadFrame(io, path, settings, quiet, false);
  volume.Files = header.Files;
  Steps steps;
  std::array<double, 3> origin;
  GetGrid(io, steps, origin);
  volume.IsOriented =
    header.Has("TransformMatrix") || header.Has("Orientation") || header.Has("Rotation");
  const std::string unit = GetEntry(io, "ITK_VoxelUnits");
  PlaceVolume(volume, steps, origin,
    !header.Has("ElementSpacing") && !header.Has("ElementSize") ? ""
      : unit.empty() || unit == "?"                             ? "mm"
                                                                : unit);
  return volume;
}
