// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef MemoryFloor_h
#define MemoryFloor_h

#include <cstddef>

/**
 * The largest of the bytes, found by the threads of vtkSMPTools. No projection of a volume that
 * looks at every voxel takes less time than this: it reads each byte once and does next to nothing
 * with it.
 */
unsigned char LargestByte(const unsigned char* bytes, std::size_t count);

#endif
