// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOMFrames_h
#define DICOMFrames_h

#include "Reading/QuietReading.h"
#include "Reading/SliceStack.h"

#include "vtkDICOMReader.h"
#include "vtkDICOMValue.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

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
std::vector<DICOMFrame> FindFrames(const DICOMFiles& files);

std::vector<SlicePlane> GetPlanes(const std::vector<DICOMFrame>& frames);

/**
 * Choose one of the frames at each place: where each place has several, those that belong together
 * by time, echo or the like, by their number from 1 on; 0 takes the first.
 */
std::vector<std::size_t> ChooseTime(const std::vector<DICOMFrame>& frames,
  const std::vector<std::vector<std::size_t>>& places, int number, std::vector<std::string>& notes);

/**
 * Read the stored values of a file's frames.
 */
vtkImageData* ReadPixels(DICOMFile& file, const QuietReading& quiet);

#endif
