// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOMFrames_h
#define DICOMFrames_h

#include "Reading/QuietReading.h"
#include "Reading/SliceStack.h"

#include "vtkDICOMReader.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

/**
 * A DICOM file of one or several frames. Each has a reader of its own, because one for all would
 * take the first one's pixels for those of all.
 */
struct DICOMFile
{
  std::string Path;
  vtkSmartPointer<vtkDICOMReader> Reader;
  int ScalarType;   // of the values, of which each pixel has so many
  int Components;   //
  int Shift;        // bits of a pixel below the lowest of its code
  double Thickness; // of its slices, mm, or 1
};

struct DICOMFrame
{
  DICOMFile* File;
  int Number; // in the file
  SlicePlane Plane;
};

/**
 * The files of a series without copies of the same object, which notes tell of. Throws
 * std::runtime_error with one sentence, as do the others.
 */
std::vector<std::unique_ptr<DICOMFile>> OpenFiles(const std::vector<std::string>& paths,
  const QuietReading& quiet, std::vector<std::string>& notes);

/**
 * All frames of the files, and where they lie.
 */
std::vector<DICOMFrame> FindFrames(const std::vector<std::unique_ptr<DICOMFile>>& files);

/**
 * One of the frames at each place: all, or where each place has several, those that belong together
 * by time, echo or the like, by their number from 1 on; 0 takes the first.
 */
std::vector<std::size_t> ChooseTime(const std::vector<DICOMFrame>& frames,
  const std::vector<std::vector<std::size_t>>& places, int number, std::vector<std::string>& notes);

/**
 * The window that all these frames want to be shown with, the first if they give several; what is
 * passed stays as it is if they differ or give none.
 */
void FindWindow(const std::vector<DICOMFrame>& frames, const std::vector<std::size_t>& order,
  double& window, double& level);

/**
 * The values of a file's frames, in the unit that it gives.
 */
vtkImageData* ReadPixels(DICOMFile& file, const QuietReading& quiet);

#endif
