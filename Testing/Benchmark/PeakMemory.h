// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef PeakMemory_h
#define PeakMemory_h

/**
 * How far the resident memory of this process has grown at its peak since this object was made.
 * Linux only.
 */
class PeakMemory
{
public:
  /**
   * Returns freed memory to the system and forgets earlier peaks.
   */
  PeakMemory();

  /**
   * Megabytes (10^6 bytes), or a negative number where the system does not tell.
   */
  double GetGrowth() const;

private:
  double Start;
};

#endif
