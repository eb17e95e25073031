// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOM_h
#define DICOM_h

#include "Reading/QuietReading.h"
#include "Reading/VolumeReader.h"

#include "vtkDICOMReader.h"
#include "vtkDICOMValue.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

/**
 * Choose the files of one series of a folder and the folders in it, of a DICOMDIR, or of a file and
 * those beside it: by its number from 1 on, or if that is 0 the file's own, or the largest. If
 * there are several series, notes list them. Files become those of all series. Throws
 * std::runtime_error with one sentence.
 */
std::vector<std::string> ChooseSeries(const std::string& path, int number,
  const QuietReading& quiet, std::vector<std::string>& notes, std::vector<std::string>& files);

/**
 * Explain why a wrapped DICOM file cannot be read, and what to do. Returns nothing for other files.
 */
std::string ExplainFile(const std::string& path);

/**
 * Return whether a file is DICOM, by its content.
 */
bool IsDICOMFile(const std::string& path);

using Vector3 = std::array<double, 3>;

/**
 * Where a slice lies in the patient according to DICOM, in millimetres.
 */
struct SlicePlane
{
  std::string Name;                // of the file, and of the frame if there are several
  Vector3 Position;                // of the centre of the first pixel
  Vector3 Row;                     // unit vector along the rows, ...
  Vector3 Column;                  // ... along the columns
  std::array<double, 2> Spacing;   // from pixel to pixel along rows and columns
  std::array<std::size_t, 2> Size; // pixels along rows and columns
};

/**
 * Make vectors from voxel to voxel of a stack whose slices follow in a direction, a unit vector.
 */
std::array<Vector3, 3> MakeSteps(const SlicePlane& plane, const Vector3& direction, double step);

/**
 * Describe a plane by its name and position.
 */
std::string Describe(const SlicePlane& plane);

/**
 * A DICOM file of one or several frames. Each has a reader of its own, because a common one would
 * use the pixel format of the first file for all.
 */
struct DICOMFile
{
  std::string Path;
  vtkSmartPointer<vtkDICOMReader> Reader;
  int ScalarType;   // of the stored values
  int Components;   // values of each pixel
  int Shift;        // bits of a pixel below the lowest of its code
  double Thickness; // of its slices, mm; 0 if it is unknown

  vtkDICOMValue Get(vtkDICOMTag tag, int frame = 0) const;
};

struct DICOMFrame
{
  DICOMFile* File;
  int Number; // in the file
  SlicePlane Plane;

  vtkDICOMValue Get(vtkDICOMTag tag) const { return this->File->Get(tag, this->Number); }
};

using DICOMFrames = std::vector<DICOMFrame>;
using DICOMFiles = std::vector<std::unique_ptr<DICOMFile>>;

/**
 * Open the files of a series, less copies of the same object, which notes name. Throws
 * std::runtime_error with one sentence, as do the functions below.
 */
DICOMFiles OpenFiles(const std::vector<std::string>& paths, const QuietReading& quiet,
  std::vector<std::string>& notes);

/**
 * Find all frames of the files, and where they lie.
 */
DICOMFrames FindFrames(const DICOMFiles& files);

/**
 * Find the largest number of frames that agree in orientation, pixels and size. A note says which
 * do not.
 */
DICOMFrames FindLargestStack(const DICOMFrames& frames, std::vector<std::string>& notes);

/**
 * Find the frames of a stack at each place, in the order of the places along the normal.
 */
std::vector<DICOMFrames> FindPlaces(const DICOMFrames& frames);

/**
 * Choose one of the frames at each place: where each place has several, those that belong together
 * by time, echo or the like, by their number from 1 on; 0 takes the first.
 */
DICOMFrames ChooseTime(
  const std::vector<DICOMFrames>& places, int number, std::vector<std::string>& notes);

/**
 * The line along which slices follow each other. Its direction, a unit vector, is that from the
 * first slice to the last: not along the normal if a gantry tilts.
 */
struct SliceLine
{
  Vector3 Direction;
  std::vector<double> Places; // of the slices, from 0
};

/**
 * Find the line of slices in an order of rising places. Throws std::runtime_error with one sentence
 * if they are not above each other.
 */
SliceLine FindLine(const DICOMFrames& slices);

/**
 * Read the stored values of a file's frames.
 */
vtkImageData* ReadPixels(DICOMFile& file, const QuietReading& quiet);

/**
 * Conversion of the stored bits of a frame to values in the file's unit.
 */
struct ValueMap
{
  int Bits = 0;  // of a code; 0 if pixels are floating point
  int Shift = 0; // bits of a pixel below the code
  bool IsSigned = false;
  double Slope = 1.0;
  double Intercept = 0.0;
  std::vector<double> Table;        // of values, in place of slope and intercept, or empty
  double FirstOfTable = 0.0;        // its first code
  double Padding[2] = { 1.0, 0.0 }; // codes from, to, that become NaN; none if they fall

  double GetValue(double stored) const;
};

/**
 * Find the conversion of a frame by rescale slope and intercept, Modality LUT, dose grid scaling or
 * real world values. Notes name what is not applied. Padding is hidden if its code is in the upper
 * half, or if the caller asks for that.
 */
ValueMap FindValueMap(const DICOMFrame& frame, bool hidesPadding, std::vector<std::string>& notes);

/**
 * Find the type that holds all possible values.
 */
int FindScalarType(const DICOMFrames& frames, const std::vector<ValueMap>& maps);

/**
 * Convert a frame of pixels to a slice of values.
 */
void ConvertSlice(
  vtkImageData* stored, int frame, const ValueMap& map, vtkImageData* to, int slice);

/**
 * Return whether a file is a DICOM segmentation (SEG).
 */
bool IsSegmentation(const DICOMFile& file);

/**
 * Read a segmentation as a volume of segment numbers, 0 where no segment is, or of one segment
 * alone if a label is given. Frames that the file leaves out are empty. Throws std::runtime_error
 * with one sentence.
 */
void ReadSegments(const DICOMFiles& files, int label, const QuietReading& quiet, Volume& volume);

#endif
