// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PictureSeries_h
#define PictureSeries_h

#include "Look.h"

#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

/**
 * One of the slices in the palette's colours, if it has none of its own.
 */
vtkSmartPointer<vtkImageData> Paint(vtkImageData* slices, const Palette& palette, int n);

/**
 * Writes a PNG file and returns whether it is complete.
 */
bool WritePNG(vtkImageData* image, const std::string& path);

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
 * The files of a series: a film, or so many numbered pictures.
 */
std::vector<std::string> GetSeriesFiles(const std::string& path, int count);

/**
 * Writes the slices of an image, bottom row first: bytes, which are places in the palette, or
 * colours. Throws std::runtime_error with one sentence.
 */
void WriteSeries(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::string& path);

/**
 * Write slices as one DICOM file with a frame for each: a multi-frame secondary capture of gray
 * bytes or true colours, in a series of its own in the study of the files that were read. Returns
 * whether the file is complete. Only in builds with vtk-dicom.
 */
bool WriteDICOM(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::vector<std::string>& names);

#endif
