// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PictureSeries_h
#define PictureSeries_h

#include "Look.h"

#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <stdexcept>
#include <string>
#include <vector>

/// What every writer throws whose file cannot be made or filled.
std::runtime_error CannotWrite(const std::string& path);

/**
 * Throws that if a picture, or the first of numbered ones, cannot be written: to be asked before
 * the work. What is not there yet is not there afterwards.
 */
void CheckWritable(const std::string& path, bool isNumbered);

/**
 * One of the slices in the palette's colours, if it has none of its own.
 */
vtkSmartPointer<vtkImageData> Paint(vtkImageData* slices, const Palette& palette, int n);

/**
 * Encode in memory and write by hand, so that a failure is one sentence and not VTK's report.
 * Throws std::runtime_error.
 */
void WritePNG(vtkImageData* image, const std::string& path);

/**
 * What a film says besides its pictures.
 */
struct FilmSettings
{
  int Rate = 12;                // per second
  bool IsInMillimeters = false; // the slices' spacing
  vtkObject* Study = nullptr;   // as of Volume
};

/**
 * How the names of series end, whether this build can write them or not.
 */
std::vector<std::string> GetSeriesEndings();

/**
 * What is wrong with the name of a series, or nothing: by its ending it is a film (Ogg Theora) or
 * DICOM, if this build has their libraries, or PNG pictures, of which each gets its number before
 * the ending.
 */
std::string CheckSeriesName(const std::string& path);

/**
 * Writes the slices of an image, bottom row first: bytes, which are places in the palette, or
 * colours. Throws std::runtime_error with one sentence.
 */
void WriteSeries(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::string& path);

#endif
