// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * Figures 10 to 13 of the paper: pictures and what can be measured in them.
 */
#ifndef PaperFigures_h
#define PaperFigures_h

#include "Paper/PaperReport.h"
#include "Paper/PaperScene.h"
#include "Paper/PaperTables.h"

/// Figures 10 and 11: the phantom of lines in the three modes, and by three methods.
void ReportPhantom(PaperReport& report, const PaperSettings& settings);

/// Figure 12: line encoding with tolerance and without.
void ReportEncoding(PaperReport& report, const PaperDataSet& data, const PaperTimes& times,
  const PaperSettings& settings);

/// Figure 13: three methods at two resolutions.
void ReportResolutions(
  PaperReport& report, const PaperDataSet& data, const PaperSettings& settings);

#endif
