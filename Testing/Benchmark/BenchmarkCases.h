// SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What is measured: whole frames, the projection alone, and the floor below it.
 */
#ifndef BenchmarkCases_h
#define BenchmarkCases_h

#include "BenchmarkStage.h"
#include "BenchmarkVolumes.h"

#include <benchmark/benchmark.h>

/**
 * How many of the BenchmarkStage's views, evenly spaced over all of them, and how often each.
 */
struct BenchmarkRotation
{
  int Views = BenchmarkStage::NumberOfViews;
  int Passes = 3;
};

/**
 * Whole frames, render and read-back. Counters: median_ms and worst_ms over the views (a view
 * counts with the median of its passes); first_ms, the slowest of three first frames, each by a
 * fresh mapper along another axis, in a program that has drawn with such a mapper before; views;
 * and peak_MB (10^6 bytes), by which the resident memory of the process was larger at most, during
 * first frames and rotation, than before the first of these mappers was made. The volume is not in
 * it, what OpenGL and its driver hold in main memory is.
 */
void MeasureFrames(benchmark::State& state, const BenchmarkVolume& volume, int window,
  const BenchmarkMapper& mapper, const BenchmarkRotation& rotation);

/**
 * Frames of a view that is shown already, after a change of window and level, for the splatting
 * mapper: no voxel is projected. Counters median_ms, worst_ms and views as above; share, the median
 * divided by that of the frames that showed the views first, in the same run.
 */
void MeasureRecoloring(benchmark::State& state, const BenchmarkVolume& volume, int window,
  const BenchmarkMapper& mapper, const BenchmarkRotation& rotation);

/**
 * Clipping planes.
 */
enum class BenchmarkCut
{
  NONE,
  PLANE, // through the middle, at 45 degrees to two axes
  BOX    // six planes, with a fifth of the volume's size beyond each
};

/**
 * GetProjectionTime() of the splatting mapper. Counters median_ms, worst_ms and views as above;
 * what is made once per volume is made before.
 */
void MeasureProjections(benchmark::State& state, const BenchmarkVolume& volume,
  const BenchmarkMapper& mapper, const BenchmarkRotation& rotation,
  BenchmarkCut cut = BenchmarkCut::NONE);

/**
 * The same with RecordLocations.
 */
void MeasureLocations(benchmark::State& state, const BenchmarkVolume& volume,
  const BenchmarkMapper& mapper, const BenchmarkRotation& rotation);

/**
 * Makes the index of a volume, again and again: counter median_ms.
 */
void MeasureIndex(benchmark::State& state, const BenchmarkVolume& volume);

/**
 * The slowest of the first frames of a fresh mapper along the three axes: counter median_ms.
 */
void MeasureFirst(
  benchmark::State& state, const BenchmarkVolume& volume, const BenchmarkMapper& mapper);

/**
 * The largest byte of the volume. Counters median_ms and GB_per_s (10^9 bytes).
 */
void MeasureFloor(benchmark::State& state, const BenchmarkVolume& volume);

/**
 * Whether a benchmark has failed so far.
 */
bool HasFailedBenchmark();

#endif
