// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOMSeries_h
#define DICOMSeries_h

#include "Reading/QuietReading.h"

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

#endif
