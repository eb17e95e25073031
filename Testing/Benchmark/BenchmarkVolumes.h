// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
#ifndef BenchmarkVolumes_h
#define BenchmarkVolumes_h

#include "vtkImageData.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

/**
 * A volume of the benchmark. It is made or read only when a benchmark asks for it.
 */
struct BenchmarkVolume
{
  std::string Name; // what-type
  std::function<vtkSmartPointer<vtkImageData>()> Load;
  bool IsBig = false; // slow mappers get fewer views
};

/**
 * All volumes, the real ones if their files are there; the names of those that are not, with the
 * file that was looked for, are appended to missing.
 */
std::vector<BenchmarkVolume> ListVolumes(
  const std::string& folder, std::vector<std::string>& missing);

/**
 * One small volume that is made in no time.
 */
std::vector<BenchmarkVolume> ListQuickVolumes();

/**
 * Keeps the volume last asked for, and only that: the benchmarks run volume by volume. Returns
 * nullptr if the volume cannot be read.
 */
vtkImageData* LoadVolume(const BenchmarkVolume& volume);

#endif
