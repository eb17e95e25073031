// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * The paper's claim that splatting in sheared object space is more accurate than projective
 * shear-warp.
 */
#ifndef PaperAccuracy_h
#define PaperAccuracy_h

#include "Paper/PaperReport.h"
#include "Paper/PaperScene.h"

/**
 * The errors of both, on the shear grid, over so many views (8 at most).
 */
void ReportAccuracy(
  PaperReport& report, const std::string& name, const PaperVolume& volume, int views);

#endif
