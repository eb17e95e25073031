// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ProgressLine.h"
#include "Reading/Placement.h"
#include "Reading/Reading.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetReader.h"
#include "vtkIdList.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkXMLGenericDataObjectReader.h"
#include "vtkXMLImageDataReader.h"

#include <vtksys/SystemTools.hxx>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

namespace
{
/// Steps by which even coordinates of rectilinear grids may be off.
constexpr double EvenEnough = 1e-3;

/**
 * Return whether the end of an XML file is there: VTK's readers accept raw data without it.
 */
bool HasEnd(const std::string& path)
{
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::string tail(static_cast<std::size_t>(std::min<std::streamoff>(256, file.tellg())), ' ');
  file.seekg(-static_cast<std::streamoff>(tail.size()), std::ios::end);
  file.read(&tail[0], static_cast<std::streamsize>(tail.size()));
  return tail.find("</VTKFile>") != std::string::npos;
}

/**
 * Refuse an extent without points, or with more than fit into memory, before it is read.
 */
void CheckExtent(vtkInformation* info, const std::string& path, const QuietReading& quiet)
{
  const int* extent = info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  double voxels = 1.0;
  for (int axis = 0; axis < 3 && extent; ++axis)
  {
    const double count = double(extent[2 * axis + 1]) - extent[2 * axis] + 1.0;
    if (count < 1.0)
    {
      RefuseDamaged(path, quiet.GetReason());
    }
    voxels *= count;
  }
  CheckMemory(voxels, path);
}

vtkSmartPointer<vtkDataSet> RunReader(
  vtkAlgorithm* reader, const std::string& path, const QuietReading& quiet)
{
  const ProgressLine line("reading " + std::filesystem::path(path).filename().string(), reader);
  reader->UpdateInformation();
  vtkInformation* const info = reader->GetOutputInformation(0);
  if (HasFailed(reader, quiet) || !info)
  {
    RefuseDamaged(path, quiet.GetReason());
  }
  CheckExtent(info, path, quiet);
  reader->Update();
  vtkSmartPointer<vtkDataSet> data = vtkDataSet::SafeDownCast(reader->GetOutputDataObject(0));
  if (HasFailed(reader, quiet) || !data || data->GetNumberOfPoints() < 1)
  {
    RefuseDamaged(path, quiet.GetReason());
  }
  return data;
}

/**
 * Get the places of voxels along an axis: of points, or of the centres of cells.
 */
std::vector<double> GetPlaces(vtkDataSet* data, int axis, bool isOfCells)
{
  std::vector<double> places;
  if (auto* const grid = vtkRectilinearGrid::SafeDownCast(data))
  {
    vtkDataArray* const coordinates = axis == 0 ? grid->GetXCoordinates()
      : axis == 1                               ? grid->GetYCoordinates()
                                                : grid->GetZCoordinates();
    for (vtkIdType i = 0; i < coordinates->GetNumberOfTuples(); ++i)
    {
      places.push_back(coordinates->GetComponent(i, 0));
    }
  }
  else
  {
    auto* const image = vtkImageData::SafeDownCast(data);
    for (int i = 0; i < image->GetDimensions()[axis]; ++i)
    {
      places.push_back((image->GetExtent()[2 * axis] + i) * image->GetSpacing()[axis]);
    }
  }
  if (isOfCells && places.size() > 1)
  {
    std::transform(places.begin(), places.end() - 1, places.begin() + 1, places.begin(),
      [](double a, double b) { return 0.5 * (a + b); });
    places.pop_back();
  }
  return places;
}

/**
 * Find even places for coordinates along an axis, or refuse those that cannot be interpolated.
 */
std::vector<double> FindEvenPlaces(const std::vector<double>& places, const std::string& path)
{
  const double length = places.back() - places.front();
  for (std::size_t i = 1; i < places.size(); ++i)
  {
    if (!((places[i] - places[i - 1]) * length > 0.0) || !std::isfinite(length))
    {
      Refuse(path, "its coordinates neither rise nor fall; write the grid again.");
    }
  }
  const std::vector<double> even = SpaceEvenly(places, EvenEnough);
  if (even.empty())
  {
    Refuse(path, "its coordinates are too uneven to interpolate; resample the grid to an image.");
  }
  return even;
}

/**
 * Find the voxels that ghost arrays hide: points with HIDDENPOINT, and those all of whose cells
 * have HIDDENCELL; or cells with HIDDENCELL, and those with a hidden point. Returns nullptr if
 * there are no ghost arrays.
 */
vtkSmartPointer<vtkUnsignedCharArray> FindHidden(
  vtkDataSet* data, bool isOfCells, const std::string& path)
{
  vtkUnsignedCharArray* const points = data->GetPointGhostArray();
  vtkUnsignedCharArray* const cells = data->GetCellGhostArray();
  if ((points && points->GetNumberOfTuples() != data->GetNumberOfPoints()) ||
    (cells && cells->GetNumberOfTuples() != data->GetNumberOfCells()))
  {
    RefuseDamaged(path, "not a ghost value for each point or cell");
  }
  if (!points && !cells)
  {
    return nullptr;
  }
  const auto isHiddenPoint = [points](vtkIdType i)
  { return points && (points->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT) != 0; };
  const auto isHiddenCell = [cells](vtkIdType i)
  { return cells && (cells->GetValue(i) & vtkDataSetAttributes::HIDDENCELL) != 0; };
  auto hidden = vtkSmartPointer<vtkUnsignedCharArray>::New();
  hidden->SetName(vtkDataSetAttributes::GhostArrayName());
  hidden->SetNumberOfTuples(isOfCells ? data->GetNumberOfCells() : data->GetNumberOfPoints());
  vtkNew<vtkIdList> others;
  for (vtkIdType i = 0; i < hidden->GetNumberOfTuples(); ++i)
  {
    bool isHidden = false;
    if (isOfCells)
    {
      data->GetCellPoints(i, others);
      isHidden = isHiddenCell(i) || std::any_of(others->begin(), others->end(), isHiddenPoint);
    }
    else
    {
      data->GetPointCells(i, others);
      isHidden = isHiddenPoint(i) ||
        (others->GetNumberOfIds() > 0 && std::all_of(others->begin(), others->end(), isHiddenCell));
    }
    hidden->SetValue(i, isHidden ? vtkDataSetAttributes::HIDDENPOINT : 0);
  }
  return hidden;
}

/**
 * Copy values as floating point, less hidden ones.
 */
vtkSmartPointer<vtkDataArray> CopyShown(vtkDataArray* values, vtkUnsignedCharArray* hidden)
{
  const auto copy = vtkSmartPointer<vtkDataArray>::Take(
    vtkDataArray::CreateDataArray(FindFloatType(values->GetDataType())));
  copy->DeepCopy(values);
  for (vtkIdType i = 0; i < copy->GetNumberOfTuples(); ++i)
  {
    for (int n = 0; n < copy->GetNumberOfComponents() && hidden->GetValue(i) != 0; ++n)
    {
      copy->SetComponent(i, n, std::numeric_limits<double>::quiet_NaN());
    }
  }
  return copy;
}

/**
 * List the arrays of numbers of points or cells, the active one first.
 */
std::vector<vtkDataArray*> ListArrays(vtkDataSetAttributes* attributes)
{
  std::vector<vtkDataArray*> arrays;
  for (int n = 0; n < attributes->GetNumberOfArrays(); ++n)
  {
    vtkDataArray* const array = attributes->GetArray(n);
    const bool isGhost =
      array && array->GetName() && array->GetName() == std::string(attributes->GhostArrayName());
    if (array && array->GetDataType() != VTK_BIT && array->GetNumberOfComponents() > 0 && !isGhost)
    {
      arrays.push_back(array);
    }
  }
  vtkDataArray* const active = attributes->GetScalars();
  std::stable_partition(
    arrays.begin(), arrays.end(), [&](vtkDataArray* array) { return array == active; });
  return arrays;
}

std::string GetName(vtkDataArray* array)
{
  return array->GetName() && *array->GetName() ? array->GetName() : "unnamed";
}

/**
 * Choose the array that the settings name, else the active one, else the first, points before
 * cells.
 */
vtkDataArray* ChooseArray(
  vtkDataSet* data, const std::string& path, const std::string& wanted, Volume& volume)
{
  std::vector<vtkDataArray*> arrays = ListArrays(data->GetPointData());
  const auto cells = ListArrays(data->GetCellData());
  arrays.insert(arrays.end(), cells.begin(), cells.end());
  std::vector<std::string> names;
  std::transform(arrays.begin(), arrays.end(), std::back_inserter(names), GetName);
  if (arrays.empty())
  {
    Refuse(path, "no numeric value at each point or cell; save the volume with scalars.");
  }
  const auto found = wanted.empty() ? names.begin() : std::find(names.begin(), names.end(), wanted);
  if (found == names.end())
  {
    Refuse(path,
      "there is no array " + wanted + " here, only " + JoinWords(names) +
        "; give another --array.");
  }
  if (arrays.size() > 1)
  {
    volume.Notes.push_back("array " + *found + " (--array chooses " + JoinWords(names) + ")");
  }
  return arrays[static_cast<std::size_t>(found - names.begin())];
}

/// Places of voxels along three axes.
using Places = std::array<std::vector<double>, 3>;

void Place(Volume& volume, vtkImageData* image, const Places& even)
{
  Steps steps = {};
  std::array<double, 3> origin = {};
  for (int row = 0; row < 3; ++row)
  {
    origin[row] = image ? image->GetOrigin()[row] : 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto& along = even[axis];
      const double element =
        image ? image->GetDirectionMatrix()->GetElement(row, axis) : double(row == axis);
      const double spacing = image ? image->GetSpacing()[axis]
        : along.size() > 1         ? (along.back() - along.front()) / double(along.size() - 1)
                                   : 1.0;
      steps[axis][row] = element * spacing;
      origin[row] += element * along.front();
    }
  }
  PlaceVolume(volume, steps, origin, "");
}

Volume MakeVolume(vtkDataSet* data, const std::string& path, const std::string& wanted)
{
  auto* const image = vtkImageData::SafeDownCast(data);
  if (!image && !vtkRectilinearGrid::SafeDownCast(data))
  {
    Refuse(path, "no image and no rectilinear grid; resample it to an image.");
  }
  Volume volume;
  vtkSmartPointer<vtkDataArray> values = ChooseArray(data, path, wanted, volume);
  const auto cells = ListArrays(data->GetCellData());
  const bool isOfCells = std::find(cells.begin(), cells.end(), values) != cells.end();
  Places places, even;
  double voxels = 1.0, evenVoxels = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    places[axis] = GetPlaces(data, axis, isOfCells);
    even[axis] = image ? places[axis] : FindEvenPlaces(places[axis], path);
    voxels *= static_cast<double>(places[axis].size());
    evenVoxels *= static_cast<double>(even[axis].size());
  }
  if (static_cast<double>(values->GetNumberOfTuples()) != voxels)
  {
    Refuse(path, "no numeric value at each point or cell; save the volume with scalars.");
  }
  CheckMemory(evenVoxels, path);
  const auto hidden = FindHidden(data, isOfCells, path);
  if (hidden && even != places)
  {
    values = CopyShown(values, hidden);
  }
  values->SetName(GetName(values).c_str());
  volume.Image = vtkSmartPointer<vtkImageData>::New();
  volume.Image->SetDimensions(int(places[0].size()), int(places[1].size()), int(places[2].size()));
  volume.Image->GetPointData()->SetScalars(values);
  if (even != places)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      volume.Image = even[axis] == places[axis]
        ? volume.Image
        : Interpolate(volume.Image, axis, places[axis], even[axis]);
    }
    volume.Notes.push_back("the grid is uneven and was interpolated to even steps");
    AddCaution(volume, "grid interpolated");
  }
  else if (hidden)
  {
    volume.Image->GetPointData()->AddArray(hidden);
  }
  Place(volume, image, even);
  return volume;
}
}

Volume ReadVTK(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  const std::string ending =
    vtksys::SystemTools::LowerCase(std::filesystem::path(path).extension().string());
  vtkSmartPointer<vtkDataSet> data;
  if (ending == ".vtk")
  {
    vtkNew<vtkDataSetReader> reader;
    reader->SetFileName(path.c_str());
    reader->ReadAllScalarsOn();
    reader->ReadAllVectorsOn();
    reader->ReadAllFieldsOn();
    data = RunReader(reader, path, quiet);
  }
  else
  {
    if (!HasEnd(path))
    {
      RefuseDamaged(path, quiet.GetReason());
    }
    vtkNew<vtkXMLGenericDataObjectReader> reader;
    reader->SetFileName(path.c_str());
    data = RunReader(reader, path, quiet);
  }
  Volume volume = MakeVolume(data, path, settings.Array);
  Choose(path, "volume", settings.Frame, 1, volume.Notes);
  return volume;
}

Volume ReadVTKText(const std::string& text, const std::string& name, const QuietReading& quiet)
{
  vtkNew<vtkXMLImageDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(text);
  return MakeVolume(RunReader(reader, name, quiet), name, "");
}
