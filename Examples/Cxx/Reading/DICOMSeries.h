// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef DICOMSeries_h
#define DICOMSeries_h

#include "Reading/QuietReading.h"

#include <string>
#include <vector>

/**
 * The files of one series: of a folder, what lies in its folders too, of a DICOMDIR, or of a file,
 * with those beside it. By its number from 1 on; 0 takes the file's own, or the one with most
 * bytes. Notes become a list of all series where there are more, and files those of all series.
 * Throws std::runtime_error with one sentence.
 */
std::vector<std::string> ChooseSeries(const std::string& path, int number,
  const QuietReading& quiet, std::vector<std::string>& notes, std::vector<std::string>& files);

/**
 * Why a file cannot be read that is DICOM in some wrapping, and what to do; else nothing.
 */
std::string ExplainFile(const std::string& path);

/**
 * Whether a file looks like DICOM's, whatever its name is.
 */
bool IsDICOMFile(const std::string& path);

#endif
