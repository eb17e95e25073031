// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/ITKVolume.h"

#include "Reading/Placement.h"
#include "Reading/Reading.h"

#include "itkMetaDataObject.h"
#include "itkMetaImageIO.h"
#include "itkNrrdImageIO.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cstdlib>
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
 * The text behind a key and a separator in a header, which ITK does not report; empty if there is
 * none. Keys of MetaImage are case-sensitive.
 */
std::string FindField(const std::string& path, const std::string& key, char separator)
{
  std::istringstream header(ReadHead(path));
  for (std::string line; std::getline(header, line) && !Trim(line).empty();)
  {
    const std::size_t end = line.find(separator);
    if (end != std::string::npos && Trim(line.substr(0, end)) == key)
    {
      return Trim(line.substr(end + 1));
    }
  }
  return "";
}

[[noreturn]] void RefuseUnread(const std::string& path, const std::string& reason)
{
  if (reason.find("not available") != std::string::npos)
  {
    Refuse(path,
      "the encoding of its data is not supported (" + reason +
        "); save the volume with gzip or raw data.");
  }
  Refuse(path,
    "damaged, incomplete or not what its name says (" + reason +
      "); check it, or export the volume again.");
}

/**
 * Refuse lines that ITK 5 cannot quote in an error without a buffer overflow. Only values of keys
 * of one's own are so long in sound files.
 */
void CheckLines(const std::string& path)
{
  constexpr std::size_t Longest = 500;
  std::istringstream header(ReadHead(path));
  for (std::string line; std::getline(header, line) && !Trim(line).empty();)
  {
    if (line.size() > Longest && line[0] != '#' && line.find(":=") == std::string::npos)
    {
      RefuseUnread(path, "a line of its header is too long");
    }
  }
}

int GetScalarType(const itk::ImageIOBase* io, const std::string& path)
{
  using Type = itk::IOComponentEnum;
  const Type type = io->GetComponentType();
  const bool isFloat = type == Type::FLOAT || type == Type::DOUBLE;
  const auto all = { Type::CHAR, Type::SHORT, Type::INT, Type::LONG, Type::LONGLONG };
  const bool isSigned = std::find(all.begin(), all.end(), type) != all.end();
  const int found = type == Type::UNKNOWNCOMPONENTTYPE
    ? VTK_VOID
    : FindScalarType(io->GetComponentSize(), isFloat, isSigned);
  if (found == VTK_VOID)
  {
    Refuse(path, "values of this type are not supported; save the volume as float.");
  }
  return found;
}

/**
 * The last two of a chain of reasons, a line each, without the functions that report them; or the
 * first of several reports.
 */
std::string GetReason(const std::string& report, bool isChain)
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
  std::string text = lines.empty() ? "" : isChain ? lines.back() : lines.front();
  text = lines.size() > 1 && isChain ? lines[lines.size() - 2] + ": " + text : text;
  std::replace_if(
    text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

/**
 * The file's image of at most three dimensions, with the frames one behind the other along the
 * third.
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
      RefuseUnread(path, "one of its sizes is 0 or too large");
    }
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetDimensions(int(size[0]), int(size[1]), int(size[2]));
    image->AllocateScalars(type, static_cast<int>(io->GetNumberOfComponents()));
    io->SetIORegion(region);
    io->Read(image->GetScalarPointer());
    if (!quiet.GetPrinted().empty()) // by MetaIO, which reports incomplete data so
    {
      RefuseUnread(path, GetReason(quiet.GetPrinted(), false));
    }
    return image;
  }
  catch (const itk::ExceptionObject& error)
  {
    const std::string printed = quiet.GetPrinted();
    RefuseUnread(
      path, GetReason(printed.empty() ? error.GetDescription() : printed, printed.empty()));
  }
}

/**
 * One of the frames along the third axis.
 */
vtkSmartPointer<vtkImageData> ExtractFrame(vtkImageData* image, int number, int count)
{
  const int* const size = image->GetDimensions();
  const int slices = size[2] / count;
  auto frame = vtkSmartPointer<vtkImageData>::New();
  frame->SetDimensions(size[0], size[1], slices);
  frame->AllocateScalars(image->GetScalarType(), image->GetNumberOfScalarComponents());
  const auto bytes = static_cast<std::size_t>(frame->GetNumberOfPoints()) * image->GetScalarSize() *
    image->GetNumberOfScalarComponents();
  std::copy_n(static_cast<const char*>(image->GetScalarPointer(0, 0, slices * (number - 1))), bytes,
    static_cast<char*>(frame->GetScalarPointer()));
  return frame;
}

/**
 * The frame that the settings name, not placed yet.
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
  CheckChoice(path, "volume", settings.Frame, count);
  if (count > 1)
  {
    const int number = std::max(1, settings.Frame);
    volume.Notes.push_back(DescribeChoice("volume", number, count));
    volume.Image =
      isList ? ExtractComponent(volume.Image, number) : ExtractFrame(volume.Image, number, count);
  }
  return volume;
}

/**
 * Steps and origin as ITK has them.
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
 * The number of vectors in text such as "(1,0,0) none (nan,nan,nan)" that are not empty.
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

bool StartsWith(const std::string& text, const std::string& start)
{
  return text.rfind(start, 0) == 0;
}
}

Volume ReadNRRD(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  CheckLines(path);
  const std::string kinds = FindField(path, "kinds", ':');
  const auto io = itk::NrrdImageIO::New();
  Volume volume =
    ReadFrame(io, path, settings, quiet, kinds.empty() || kinds.find("list") != std::string::npos);
  Steps steps;
  std::array<double, 3> origin;
  GetGrid(io, steps, origin);
  const std::string space = GetEntry(io, "NRRD_space");
  const std::string named = vtksys::SystemTools::LowerCase(FindField(path, "space", ':'));
  if (StartsWith(space, "right-anterior-superior-time") || named == "left-anterior-superior" ||
    named == "las")
  {
    TurnToLPS(steps, origin); // ITK turns no spaces with time, and x in place of y of LAS
  }
  volume.IsOriented =
    StartsWith(space, "left-posterior-superior") || StartsWith(space, "right-anterior-superior");
  const std::string directions = FindField(path, "space directions", ':');
  const std::string spacings = FindField(path, "spacings", ':');
  if (CountVectors(directions) < std::min(3U, io->GetNumberOfDimensions()) &&
    spacings.find_first_of("0123456789") == std::string::npos)
  {
    steps = {};
    volume.IsOriented = false;
  }
  PlaceVolume(volume, steps, origin);
  const std::string units = FindField(path, "space units", ':'); // as in "mm" "mm" "mm"
  const std::size_t end = units.find('"', 1);
  if (!directions.empty())
  {
    ConvertToMillimeters(volume, end == std::string::npos ? "mm" : units.substr(1, end - 1));
  }
  return volume;
}

Volume ReadMeta(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  const int dimensions = std::atoi(FindField(path, "NDims", '=').c_str());
  if (dimensions < 2 || dimensions > 10) // ITK trusts the number
  {
    RefuseUnread(path, "NDims is not a number from 2 to 10");
  }
  const auto io = itk::MetaImageIO::New();
  Volume volume = ReadFrame(io, path, settings, quiet, false);
  Steps steps;
  std::array<double, 3> origin;
  GetGrid(io, steps, origin);
  const auto has = [&](const char* key) { return !FindField(path, key, '=').empty(); };
  volume.IsOriented = has("TransformMatrix") || has("Orientation") || has("Rotation");
  PlaceVolume(volume, steps, origin);
  if (has("ElementSpacing") || has("ElementSize"))
  {
    const std::string unit = GetEntry(io, "ITK_VoxelUnits");
    ConvertToMillimeters(volume, unit.empty() || unit == "?" ? "mm" : unit);
  }
  return volume;
}
