// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef AVIFilm_h
#define AVIFilm_h

#include "PictureSeries.h"

/**
 * WriteSeries for .avi, by libavformat and libavcodec: Motion JPEG of the best quality, which
 * players have known for the longest. Throws std::runtime_error with one sentence.
 */
void WriteAVI(vtkImageData* slices, const Palette& palette, const FilmSettings& settings,
  const std::string& path);

#endif
