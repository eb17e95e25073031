// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/Placement.h"
#include "Reading/Reading.h"

#include "vtkDataArray.h"
#include "vtkImageShiftScale.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <nifti2_io.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <vector>

namespace
{
struct Free
{
  void operator()(void* header) const { std::free(header); }
  void operator()(nifti_image* image) const { nifti_image_free(image); }
};

/// Of the values of a voxel.
struct Type
{
  int VTKType;
  int Components;
};

Type FindType(const nifti_image& header, const std::string& path)
{
  const int code = header.datatype;
  const bool isComplex = code == DT_COMPLEX64 || code == DT_COMPLEX128;
  const bool isSigned = code == DT_INT8 || code == DT_INT16 || code == DT_INT32 || code == DT_INT64;
  const int components = code == DT_RGB24 ? 3 : code == DT_RGBA32 ? 4 : isComplex ? 2 : 1;
  const int type =
    FindScalarType(header.nbyper / components, nifti_is_inttype(code) == 0, isSigned);
  if (type == VTK_VOID)
  {
    Refuse(path,
      std::string("values of type ") + nifti_datatype_string(code) + " (datatype " +
        std::to_string(code) + ") are not supported; save the volume as float.");
  }
  return { type, components };
}

/**
 * Read sizes of voxels, which libnifti replaces where they are 0. Returns nothing if the header has
 * not 1 to 7 dimensions: libnifti 3.0.1 does not check NIfTI-2.
 */
std::vector<double> ReadSizes(const std::string& path)
{
  int version = 0;
  const std::unique_ptr<void, Free> header(nifti_read_header(path.c_str(), &version, 0));
  const auto* const first = static_cast<const nifti_1_header*>(header.get());
  const auto* const second = static_cast<const nifti_2_header*>(header.get());
  if (header && version != 2)
  {
    return { first->pixdim + 1, first->pixdim + 4 };
  }
  const bool isSound = header && second->dim[0] >= 1 && second->dim[0] <= 7;
  return isSound ? std::vector<double>(second->pixdim + 1, second->pixdim + 4)
                 : std::vector<double>();
}

/**
 * Return whether the file of the data exists, or a compressed one. Otherwise libnifti would read
 * any other file of that name.
 */
bool HasData(const nifti_image& header)
{
  std::filesystem::path path = header.iname;
  path = path.extension() == ".gz" ? path.replace_extension() : path;
  return std::filesystem::exists(path) || std::filesystem::exists(path.string() + ".gz");
}

/**
 * Read one of the volumes along the axes beyond the third, from 0 on. Returns nullptr if it is
 * incomplete.
 */
vtkSmartPointer<vtkImageData> ReadFrame(nifti_image* header, std::int64_t number, const Type& type)
{
  std::int64_t place[8] = { 7, -1, -1, -1, 0, 0, 0, 0 }; // -1: all
  for (int axis = 4; axis <= header->ndim; ++axis)
  {
    place[axis] = number % header->dim[axis];
    number /= header->dim[axis];
  }
  void* values = nullptr;
  if (nifti_read_collapsed_image(header, place, &values) <= 0)
  {
    return nullptr;
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(int(header->nx), int(header->ny), int(header->nz));
  const auto scalars =
    vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type.VTKType));
  scalars->SetNumberOfComponents(type.Components);
  scalars->SetVoidArray(
    values, image->GetNumberOfPoints() * type.Components, 0, vtkAbstractArray::VTK_DATA_ARRAY_FREE);
  scalars->SetName("values");
  image->GetPointData()->SetScalars(scalars);
  return image;
}

/**
 * Convert codes to values.
 */
vtkSmartPointer<vtkImageData> Scale(vtkImageData* image, double slope, double intercept)
{
  vtkNew<vtkImageShiftScale> scale;
  scale->SetInputData(image);
  scale->SetShift(intercept / slope);
  scale->SetScale(slope);
  scale->SetOutputScalarType(FindFloatType(image->GetScalarType()));
  scale->Update();
  return scale->GetOutput();
}

/**
 * Return whether the axes of a matrix span space.
 */
bool IsUsable(const nifti_dmat44& matrix)
{
  nifti_dmat33 axes;
  for (int column = 0; column < 3; ++column)
  {
    const double length = std::hypot(matrix.m[0][column], matrix.m[1][column], matrix.m[2][column]);
    for (int row = 0; row < 3; ++row)
    {
      axes.m[row][column] = matrix.m[row][column] / length;
    }
  }
  return std::fabs(nifti_dmat33_determ(axes)) > 1e-3; // false for NaN
}

/**
 * Place a volume by the sform as it stands, else by the qform, else by the voxel size alone.
 */
void Place(Volume& volume, const nifti_image& header, const std::vector<double>& sizes)
{
  const nifti_dmat44* const form = header.sform_code > 0 && IsUsable(header.sto_xyz)
    ? &header.sto_xyz
    : header.qform_code > 0 && IsUsable(header.qto_xyz) ? &header.qto_xyz
                                                        : nullptr;
  Steps steps = { { { std::fabs(sizes[0]), 0.0, 0.0 }, { 0.0, std::fabs(sizes[1]), 0.0 },
    { 0.0, 0.0, std::fabs(sizes[2]) } } };
  std::array<double, 3> origin = {};
  for (int row = 0; row < 3 && form; ++row)
  {
    for (int column = 0; column < 3; ++column)
    {
      steps[column][row] = form->m[row][column];
    }
    origin[row] = form->m[row][3];
  }
  TurnToLPS(steps, origin);
  volume.IsOriented = form != nullptr;
  const int unit = header.xyz_units;
  PlaceVolume(volume, steps, origin,
    unit == NIFTI_UNITS_METER      ? "m"
      : unit == NIFTI_UNITS_MICRON ? "um"
                                   : "mm");
  if (!form)
  {
    volume.Notes.push_back("the file has no orientation; left and right may be exchanged");
    AddCaution(volume, "orientation unknown");
  }
}
}

Volume ReadNIFTI(const std::string& path, const ReadSettings& settings, const QuietReading&)
{
  const SilentErrors silent; // the library prints errors at any debug level
  const std::vector<double> sizes = ReadSizes(path);
  const std::unique_ptr<nifti_image, Free> header(
    sizes.empty() ? nullptr : nifti_image_read(path.c_str(), 0));
  const auto isSound = [](std::int64_t size) { return size >= 1 && size <= VTK_INT_MAX; };
  if (!header || !HasData(*header) || !isSound(header->nx) || !isSound(header->ny) ||
    !isSound(header->nz))
  {
    RefuseDamaged(path, "");
  }
  const Type type = FindType(*header, path);
  CheckMemory(double(header->nx) * double(header->ny) * double(header->nz), path);
  const int count = static_cast<int>(header->nvox / (header->nx * header->ny * header->nz));
  Volume volume;
  const int frame = Choose(path, "volume", settings.Frame, count, volume.Notes);
  volume.Image = ReadFrame(header.get(), frame - 1, type);
  if (!volume.Image)
  {
    RefuseDamaged(path, "");
  }
  const double slope = header->scl_slope, intercept = header->scl_inter;
  if (std::isfinite(slope) && std::isfinite(intercept) && slope != 0.0 &&
    (slope != 1.0 || intercept != 0.0) && type.Components == 1)
  {
    volume.Image = Scale(volume.Image, slope, intercept);
  }
  Place(volume, *header, sizes);
  const double low = header->cal_min, high = header->cal_max;
  volume.Window = high > low && std::isfinite(high - low) ? high - low : 0.0;
  volume.Level = 0.5 * (low + high);
  return volume;
}
