// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PictureSeries_h
#define PictureSeries_h

#include "vtkColorTransferFunction.h"
#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <string>
#include <vector>

/**
 * Make a picture of one slice, by the palette if it has no colours.
 */
vtkSmartPointer<vtkImageData> Paint(vtkImageData* slices, vtkColorTransferFunction* palette, int n);

/**
 * Write a PNG file. Returns whether it is complete.
 */
bool WritePNG(vtkImageData* image, const std::string& path);

/**
 * Settings of a film.
 */
struct FilmSettings
{
  vtkSmartPointer<vtkColorTransferFunction> Palette; // of bytes
  int Rate = 12;                                     // per second
  bool IsInMillimeters = false;                      // unit of the slices' spacing
  vtkObject* Study = nullptr;                        // see Volume
};

/**
 * List the endings of series, also of those that this build cannot write.
 */
std::vector<std::string> GetSeriesEndings();

/**
 * Check the name of a series: a film (Ogg Theora), DICOM, or numbered PNG pictures. Returns what is
 * wrong, or nothing.
 */
std::string CheckSeriesName(const std::string& path);

/**
 * List the files of a series: a film, or numbered pictures.
 */
std::vector<std::string> GetSeriesFiles(const std::string& path, int count);

/**
 * Write the slices of an image, bottom row first: bytes, which are indices of the palette, or
 * colours. Throws std::runtime_error with one sentence.
 */
void WriteSeries(vtkImageData* slices, const FilmSettings& settings, const std::string& path);

/**
 * Write slices as one DICOM file with a frame for each: a multi-frame secondary capture of gray
 * bytes or true colours, in a series of its own in the study of the files that were read. Returns
 * whether the file is complete. Only in builds with vtk-dicom.
 */
bool WriteDICOM(
  vtkImageData* slices, const FilmSettings& settings, const std::vector<std::string>& names);

#endif
