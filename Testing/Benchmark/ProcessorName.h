// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef ProcessorName_h
#define ProcessorName_h

#include <string>

/**
 * The processor's name as Linux, or else VTK's system library, has it.
 */
std::string GetProcessorName();

#endif
