// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#include "Reading/NIFTIVolume.h"

#include "Reading/FileHeaders.h"
#include "Reading/Orientation.h"
#include "Reading/Reading.h"

#include "vtkImageExtractComponents.h"
#include "vtkImageShiftScale.h"
#include "vtkNIFTIImageHeader.h"
#include "vtkNIFTIImageReader.h"
#include "vtkNew.h"

#include <algorithm>
#include <cmath>

namespace
{
/**
 * One of several volumes, which take as much memory as all while they are read.
 */
vtkSmartPointer<vtkImageData> ExtractVolume(vtkImageData* image, int number, int count)
{
  const int components = image->GetNumberOfScalarComponents() / count;
  vtkNew<vtkImageExtractComponents> extract;
  extract->SetInputData(image);
  extract->SetComponents((number - 1) * components);
  extract->Update();
  return extract->GetOutput();
}

/**
 * Codes become values.
 */
vtkSmartPointer<vtkImageData> Scale(vtkImageData* image, double slope, double intercept)
{
  const int bytes = image->GetScalarSize();
  vtkNew<vtkImageShiftScale> scale;
  scale->SetInputData(image);
  scale->SetShift(intercept / slope);
  scale->SetScale(slope);
  scale->SetOutputScalarType(
    image->GetScalarType() == VTK_FLOAT || bytes <= 2 ? VTK_FLOAT : VTK_DOUBLE);
  scale->Update();
  return scale->GetOutput();
}

/**
 * How long one of the header's units of length is: metres, millimetres or micrometres.
 */
double GetMillimeters(int unit)
{
  return unit == 1 ? 1000.0 : unit == 3 ? 0.001 : 1.0;
}

/**
 * Millimetres: the header may count in metres or micrometres, and the columns of an sform may be
 * longer than 1, so that voxels are larger than the header's pixdim.
 */
void ScaleSpacing(vtkImageData* image, vtkMatrix4x4* columns, int unit)
{
  double spacing[3];
  image->GetSpacing(spacing);
  for (int axis = 0; axis < 3; ++axis)
  {
    spacing[axis] *= GetMillimeters(unit);
    spacing[axis] *= columns ? std::hypot(columns->GetElement(0, axis),
                                 columns->GetElement(1, axis), columns->GetElement(2, axis))
                             : 1.0;
  }
  image->SetSpacing(spacing);
}

void PlaceVolume(Volume& volume, vtkNIFTIImageReader* reader)
{
  vtkMatrix4x4* const columns =
    reader->GetSFormMatrix() ? reader->GetSFormMatrix() : reader->GetQFormMatrix();
  volume.Orientation = MakeOrientation(columns, true);
  volume.IsOriented = columns != nullptr;
  volume.IsInMillimeters = true;
  const int unit = reader->GetNIFTIHeader()->GetXYZTUnits() & 7;
  ScaleSpacing(volume.Image, columns, unit);
  for (int axis = 0; columns && axis < 3; ++axis)
  {
    volume.Origin[axis] =
      (axis < 2 ? -1.0 : 1.0) * GetMillimeters(unit) * columns->GetElement(axis, 3);
  }
  if (!columns)
  {
    volume.Notes.push_back("the file does not say how the patient lies; left and right may be "
                           "exchanged");
    volume.Caution = "orientation unknown";
  }
}
}

Volume ReadNIFTI(const std::string& path, const ReadSettings& settings, const QuietReading& quiet)
{
  if (!HasSoundNIFTIHeader(path))
  {
    RefuseDamaged(path, quiet);
  }
  vtkNew<vtkNIFTIImageReader> reader;
  reader->SetFileName(path.c_str());
  reader->SetTimeAsVector(settings.Frame > 1);
  reader->UpdateInformation();
  const int count = std::max(1, reader->GetTimeDimension());
  CheckFrame(path, settings.Frame, count);
  Volume volume;
  volume.Image = RunReader(reader, path, quiet);
  if (count > 1)
  {
    const int number = std::max(1, settings.Frame);
    volume.Image = number > 1 ? ExtractVolume(volume.Image, number, count) : volume.Image;
    volume.Notes.push_back(
      "volume " + std::to_string(number) + " of " + std::to_string(count) + " (--frame chooses)");
  }
  const double slope = reader->GetRescaleSlope(), intercept = reader->GetRescaleIntercept();
  if (std::isfinite(slope) && std::isfinite(intercept) && slope != 0.0 &&
    (slope != 1.0 || intercept != 0.0))
  {
    volume.Image = Scale(volume.Image, slope, intercept);
  }
  PlaceVolume(volume, reader);
  const double low = reader->GetNIFTIHeader()->GetCalMin();
  const double high = reader->GetNIFTIHeader()->GetCalMax();
  volume.Window = high > low && std::isfinite(high - low) ? high - low : 0.0;
  volume.Level = 0.5 * (low + high);
  return volume;
}
