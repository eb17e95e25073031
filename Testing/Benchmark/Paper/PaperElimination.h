// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What the elimination of voxels that can never be seen costs and brings [Mroz, Hauser, Groeller,
 * "Real-Time Maximum Intensity Projection", 2000]: 94 seconds for a factor of 1.3 in their paper.
 */
#ifndef PaperElimination_h
#define PaperElimination_h

#include "Paper/PaperReport.h"
#include "Paper/PaperTables.h"

void ReportElimination(
  PaperReport& report, const std::vector<PaperDataSet>& sets, const PaperSettings& settings);

#endif
