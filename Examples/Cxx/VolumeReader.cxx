// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeReader.h"

#include "FileHeaders.h"
#include "ProgressLine.h"
#include "QuietReading.h"
#include "SplatmipAorta.h" // made from aorta-stent.vti by the build

#include "vtkAlgorithm.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkErrorCode.h"
#include "vtkImageExtractComponents.h"
#include "vtkInformation.h"
#include "vtkMatrix3x3.h"
#include "vtkMetaImageReader.h"
#include "vtkNIFTIImageReader.h"
#include "vtkNew.h"
#include "vtkNrrdReader.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredPointsReader.h"
#include "vtkXMLImageDataReader.h"

#ifdef SPLATMIP_HAS_DICOM
#include "vtkDICOMDirectory.h"
#include "vtkDICOMMetaData.h"
#include "vtkDICOMParser.h"
#include "vtkDICOMReader.h"
#include "vtkStringArray.h"
#endif

#include <vtksys/SystemInformation.hxx>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <new>
#include <sstream>
#include <stdexcept>

namespace
{
[[noreturn]] void Refuse(const std::string& path, const std::string& reason)
{
  throw std::runtime_error(path + ": " + reason);
}

[[noreturn]] void RefuseDamaged(const std::string& path, const QuietReading& quiet)
{
  Refuse(path,
    "damaged, incomplete or not what its name says" + quiet.GetReason() +
      "; check it, or export the volume again.");
}

/**
 * The number of voxels that a reader has announced. A damaged header can ask for any amount of
 * memory: refuse before it is allocated.
 */
std::uintmax_t CheckExtent(vtkInformation* info, const std::string& path, const QuietReading& quiet)
{
  const int* extent = info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT());
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double first = extent ? extent[2 * axis] : 0.0;
    const double last = extent ? extent[2 * axis + 1] : -1.0;
    if (last < first)
    {
      RefuseDamaged(path, quiet);
    }
    voxels *= last - first + 1.0;
  }
  vtksys::SystemInformation machine;
  machine.RunMemoryCheck();
  const double mebibytes = static_cast<double>(machine.GetTotalPhysicalMemory());
  if (voxels > mebibytes * 1024.0 * 1024.0)
  {
    Refuse(path,
      "the header asks for more voxels than this machine has bytes of memory; it is damaged, or "
      "the volume must be reduced first.");
  }
  return static_cast<std::uintmax_t>(voxels);
}

void ShowProgress(vtkObject* caller, unsigned long, void* line, void*)
{
  static_cast<ProgressLine*>(line)->Show(static_cast<vtkAlgorithm*>(caller)->GetProgress());
}

template <class Reader>
bool HasFailed(Reader* reader, const QuietReading& quiet)
{
  return quiet.HasErrors() || reader->GetErrorCode() != vtkErrorCode::NoError;
}

/**
 * Refuse what VTK's readers of text headers cannot be trusted with.
 */
void CheckHeader(const TextHeader& header, const std::string& path, const QuietReading& quiet)
{
  if (header.IsSplit())
  {
    Refuse(path, "the data are in several files; save the volume as one file.");
  }
  if (!header.IsSound())
  {
    RefuseDamaged(path, quiet);
  }
}

/**
 * Whether the end of a file is there: VTK's reader does not miss it behind raw data.
 */
bool EndsXML(const std::string& path)
{
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::string tail(static_cast<std::size_t>(std::min<std::streamoff>(256, file.tellg())), ' ');
  file.seekg(-static_cast<std::streamoff>(tail.size()), std::ios::end);
  file.read(&tail[0], static_cast<std::streamsize>(tail.size()));
  return tail.find("</VTKFile>") != std::string::npos;
}

/**
 * Run a reader to its image; whatever goes wrong becomes one sentence. The header, where the format
 * has one, tells whether the data are complete.
 */
vtkSmartPointer<vtkImageData> Run(vtkAlgorithm* reader, const std::string& path,
  const QuietReading& quiet, const TextHeader* header = nullptr)
{
  ProgressLine line("reading " + std::filesystem::path(path).filename().string());
  vtkNew<vtkCallbackCommand> observer;
  observer->SetCallback(ShowProgress);
  observer->SetClientData(&line);
  reader->AddObserver(vtkCommand::ProgressEvent, observer);

  reader->UpdateInformation();
  vtkInformation* info = reader->GetOutputInformation(0);
  if (HasFailed(reader, quiet) || !info)
  {
    RefuseDamaged(path, quiet);
  }
  const std::uintmax_t voxels = CheckExtent(info, path, quiet);
  const auto components =
    static_cast<std::uintmax_t>(vtkImageData::GetNumberOfScalarComponents(info));
  const int bytes = vtkDataArray::GetDataTypeSize(vtkImageData::GetScalarType(info));
  if (header && !header->HasData(voxels * components, static_cast<std::uintmax_t>(bytes)))
  {
    RefuseDamaged(path, quiet);
  }
  reader->Update();
  reader->RemoveObserver(observer);

  auto* image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  if (HasFailed(reader, quiet) || !image || image->GetNumberOfPoints() < 1)
  {
    RefuseDamaged(path, quiet);
  }
  auto copy = vtkSmartPointer<vtkImageData>::New();
  copy->ShallowCopy(image);
  return copy;
}

/**
 * The matrix whose columns are the image axes in patient coordinates, or the identity where they do
 * not span space. Files that count from left to right and back to front (RAS) are turned to LPS.
 */
vtkSmartPointer<vtkMatrix4x4> MakeOrientation(const double axes[3][3], bool isRAS = false)
{
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int column = 0; column < 3; ++column)
  {
    const double* axis = axes[column];
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    for (int row = 0; row < 3; ++row)
    {
      const double sign = isRAS && row < 2 ? -1.0 : 1.0;
      matrix->SetElement(row, column, sign * axis[row] / length);
    }
  }
  if (!(std::fabs(matrix->Determinant()) > 1e-3)) // so that it catches NaN as well
  {
    matrix->Identity();
  }
  return matrix;
}

vtkSmartPointer<vtkMatrix4x4> MakeOrientation(vtkMatrix4x4* columns, bool isRAS = false)
{
  double axes[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  for (int i = 0; columns && i < 9; ++i)
  {
    axes[i / 3][i % 3] = columns->GetElement(i % 3, i / 3);
  }
  return MakeOrientation(axes, isRAS);
}

/**
 * VTK's readers for NRRD and MetaImage pass over the directions of the axes: nine numbers in the
 * header, axis after axis.
 */
vtkSmartPointer<vtkMatrix4x4> ParseOrientation(std::string numbers, bool isRAS = false)
{
  const std::size_t bracket = numbers.find('('); // NRRD may have "none" before
  numbers.erase(0, bracket == std::string::npos ? 0 : bracket);
  std::replace_if(
    numbers.begin(), numbers.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream stream(numbers);
  double axes[3][3];
  for (int i = 0; i < 9; ++i)
  {
    if (!(stream >> axes[i / 3][i % 3]))
    {
      return vtkSmartPointer<vtkMatrix4x4>::New();
    }
  }
  return MakeOrientation(axes, isRAS);
}

Volume ReadXML(const std::string& path, const QuietReading& quiet)
{
  if (!EndsXML(path))
  {
    RefuseDamaged(path, quiet);
  }
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  volume.Image = Run(reader, path, quiet);
  return volume;
}

Volume ReadLegacy(const std::string& path, const QuietReading& quiet)
{
  vtkNew<vtkStructuredPointsReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  volume.Image = Run(reader, path, quiet);
  return volume;
}

Volume ReadMeta(const std::string& path, const QuietReading& quiet)
{
  vtkNew<vtkMetaImageReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  const TextHeader header(path);
  CheckHeader(header, path, quiet);
  volume.Image = Run(reader, path, quiet, &header);
  volume.Orientation = ParseOrientation(header.Get("TransformMatrix"));
  return volume;
}

Volume ReadNRRD(const std::string& path, const QuietReading& quiet)
{
  vtkNew<vtkNrrdReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  const TextHeader header(path);
  CheckHeader(header, path, quiet);
  volume.Image = Run(reader, path, quiet, &header);
  const std::string space = header.Get("space");
  const bool isRAS = space.find("right-anterior-superior") != std::string::npos ||
    space.find("RAS") != std::string::npos;
  volume.Orientation = ParseOrientation(header.Get("space directions"), isRAS);
  return volume;
}

Volume ReadNIFTI(const std::string& path, const QuietReading& quiet)
{
  if (!HasSoundNIFTIHeader(path))
  {
    RefuseDamaged(path, quiet);
  }
  vtkNew<vtkNIFTIImageReader> reader;
  reader->SetFileName(path.c_str());
  Volume volume;
  volume.Image = Run(reader, path, quiet);
  vtkMatrix4x4* sform = reader->GetSFormMatrix();
  volume.Orientation = MakeOrientation(sform ? sform : reader->GetQFormMatrix(), true);
  return volume;
}

#ifdef SPLATMIP_HAS_DICOM
/**
 * vtk-dicom 0.8 ends the program when bytes after the pixels look like elements of group 0, as
 * zeros do, and another file of the series has none.
 */
void CheckDICOMFile(const std::string& path, const QuietReading& quiet)
{
  vtkNew<vtkDICOMMetaData> elements;
  vtkNew<vtkDICOMParser> parser;
  parser->SetFileName(path.c_str());
  parser->SetMetaData(elements);
  parser->Update();
  if (HasFailed(parser.Get(), quiet) || elements->Begin() == elements->End() ||
    elements->Begin()->GetTag().GetGroup() == 0)
  {
    RefuseDamaged(path, quiet);
  }
}

Volume ReadDICOM(const std::string& path, const QuietReading& quiet)
{
  vtkNew<vtkDICOMDirectory> directory;
  directory->SetDirectoryName(path.c_str());
  directory->RequirePixelDataOn();
  directory->Update();
  if (HasFailed(directory.Get(), quiet))
  {
    RefuseDamaged(path, quiet);
  }
  const int numberOfSeries = directory->GetNumberOfSeries();
  if (numberOfSeries < 1)
  {
    Refuse(path, "no DICOM images in this folder; give the folder of a CT or MR series.");
  }
  vtkStringArray* files = directory->GetFileNamesForSeries(0);
  for (int i = 1; i < numberOfSeries; ++i)
  {
    vtkStringArray* candidate = directory->GetFileNamesForSeries(i);
    files = candidate->GetNumberOfValues() > files->GetNumberOfValues() ? candidate : files;
  }
  for (vtkIdType i = 0; i < files->GetNumberOfValues(); ++i)
  {
    CheckDICOMFile(files->GetValue(i), quiet);
  }
  vtkNew<vtkDICOMReader> reader;
  reader->SetFileNames(files);
  reader->SetMemoryRowOrderToFileNative();
  Volume volume;
  volume.Image = Run(reader, path, quiet);
  volume.Orientation = MakeOrientation(reader->GetPatientMatrix());
  if (numberOfSeries > 1)
  {
    volume.Note = "the largest of " + std::to_string(numberOfSeries) + " series";
  }
  return volume;
}
#else
Volume ReadDICOM(const std::string& path, const QuietReading&)
{
  Refuse(path,
    "this build has no DICOM reader; build it with vtk-dicom, or convert the series to .nrrd.");
}
#endif

/**
 * Move the direction matrix, if the reader set one, from the image to the prop's matrix, and put
 * voxels of size 1 where the file has no size or a useless one.
 */
void FinishGeometry(Volume& volume)
{
  vtkImageData* image = volume.Image;
  if (!volume.Orientation)
  {
    double axes[3][3];
    for (int i = 0; i < 9; ++i)
    {
      axes[i / 3][i % 3] = image->GetDirectionMatrix()->GetElement(i % 3, i / 3);
    }
    volume.Orientation = MakeOrientation(axes);
  }
  image->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  image->SetOrigin(0.0, 0.0, 0.0); // of no use here, and a damaged one may be not a number
  double spacing[3];
  image->GetSpacing(spacing);
  for (double& length : spacing)
  {
    length = std::fabs(length);
    length = length > 1e-9 && length < 1e9 ? length : 1.0;
  }
  image->SetSpacing(spacing);
}

/**
 * See that the image has point scalars of one component; choose the first array and its first
 * component where there is a choice.
 */
void FinishScalars(Volume& volume, const std::string& path)
{
  vtkPointData* points = volume.Image->GetPointData();
  vtkDataArray* scalars = points->GetScalars() ? points->GetScalars() : points->GetArray(0);
  if (!scalars || scalars->GetDataType() == VTK_BIT || scalars->GetNumberOfComponents() < 1 ||
    scalars->GetNumberOfTuples() != volume.Image->GetNumberOfPoints())
  {
    Refuse(path, "no numeric value at each point; save the volume with point data (scalars).");
  }
  points->SetScalars(scalars);
  const int components = scalars->GetNumberOfComponents();
  if (components > 1)
  {
    vtkNew<vtkImageExtractComponents> first;
    first->SetInputData(volume.Image);
    first->SetComponents(0);
    first->Update();
    volume.Image = first->GetOutput();
    volume.Note = "the first of " + std::to_string(components) + " components";
  }
}

using ReadFunction = Volume (*)(const std::string&, const QuietReading&);

ReadFunction ChooseReader(const std::string& path)
{
  static const struct
  {
    const char* Suffix;
    ReadFunction Read;
  } formats[] = { { ".vti", ReadXML }, { ".vtk", ReadLegacy }, { ".mha", ReadMeta },
    { ".mhd", ReadMeta }, { ".nrrd", ReadNRRD }, { ".nhdr", ReadNRRD }, { ".nii", ReadNIFTI },
    { ".nii.gz", ReadNIFTI } };

  std::string lower = path;
  std::transform(lower.begin(), lower.end(), lower.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& format : formats)
  {
    const std::string suffix = format.Suffix;
    if (lower.size() > suffix.size() &&
      lower.compare(lower.size() - suffix.size(), suffix.size(), suffix) == 0)
    {
      return format.Read;
    }
  }
  Refuse(path,
    "unknown kind of file; give a .vti, .vtk, .mha, .mhd, .nrrd, .nhdr, .nii or .nii.gz file, or "
    "the folder of a DICOM series.");
}

/**
 * Refuse what no reader needs to be asked about.
 */
void CheckFile(const std::string& path)
{
  std::error_code error;
  if (!std::filesystem::exists(path, error))
  {
    Refuse(path, "no such file or folder; check the spelling and the current folder.");
  }
  if (std::filesystem::is_directory(path, error))
  {
    return;
  }
  if (!std::ifstream(path, std::ios::binary))
  {
    Refuse(path, "the file cannot be opened; check its permissions.");
  }
  if (std::filesystem::is_regular_file(path, error) && std::filesystem::file_size(path, error) == 0)
  {
    Refuse(path, "the file is empty; get it again or export the volume again.");
  }
}
}

Volume ReadVolume(const std::string& path)
{
  CheckFile(path);
  std::error_code error;
  const bool isFolder = std::filesystem::is_directory(path, error);
  const ReadFunction read = isFolder ? ReadDICOM : ChooseReader(path);
  try
  {
    QuietReading quiet;
    Volume volume = read(path, quiet);
    FinishGeometry(volume);
    FinishScalars(volume, path);
    volume.Name = std::filesystem::path(path).filename().string();
    return volume;
  }
  catch (const std::bad_alloc&)
  {
    Refuse(path, "there is not enough memory for this volume; reduce it first.");
  }
  catch (const std::length_error&)
  {
    Refuse(path, "the header asks for too much; it is damaged.");
  }
}

Volume ReadBuiltInVolume()
{
  const std::string name = "the built-in volume";
  QuietReading quiet;
  vtkNew<vtkXMLImageDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(
    std::string(reinterpret_cast<const char*>(SplatmipAorta), sizeof(SplatmipAorta)));
  Volume volume;
  volume.Image = Run(reader, name, quiet);
  FinishGeometry(volume);
  FinishScalars(volume, name);
  volume.Name = "aorta-stent (built in)";
  return volume;
}
