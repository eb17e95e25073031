// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef Interaction_h
#define Interaction_h

#include "Options.h"
#include "Reading/VolumeReader.h"

/**
 * Show a volume in a window until the user closes it.
 */
void Interact(const Volume& volume, const LookSettings& look, const Options& options);

#endif
