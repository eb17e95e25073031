// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOMFilm_h
#define DICOMFilm_h

#include "Writing/PictureSeries.h"

#include <string>
#include <vector>

/**
 * Writes slices as one DICOM file with a frame for each: a multi-frame secondary capture of gray
 * bytes or true colours, in a series of its own in the study of the files that were read. Returns
 * whether the file is complete.
 */
bool WriteDICOM(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::vector<std::string>& names);

#endif
