#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Slabs of maxima by vtkSplattingMIPReslice and by vtkImageReslice, in turns.

    PYTHONPATH=BUILD/lib/python3/dist-packages python3 slabs.py [--size 1024] [--rounds 5] [volume.vti]

Default: the aorta of Examples/Data. Times are milliseconds, the least of all rounds: of the
processor over all threads, which other programs disturb less, and that pass. The first column
of vtkSplattingMIPReslice is without the index, which is kept between slabs.
"""
import argparse
import time
from pathlib import Path

import vtk
from vtksplattingmip import vtkSplattingMIPReslice

AORTA = Path(__file__).parents[2] / "Examples" / "Data" / "aorta-stent.vti"
AXES = {
    "along z": (1, 0, 0, 0, 1, 0, 0, 0, 1),
    "along y": (1, 0, 0, 0, 0, 1, 0, -1, 0),
    "oblique": (0.8, 0.6, 0, -0.36, 0.48, 0.8, 0.48, -0.64, 0.6),
}


def slab(filter, image, axes, size, slices):
    bounds = image.GetBounds()
    extent = max(b - a for a, b in zip(bounds[::2], bounds[1::2]))
    step = min(image.GetSpacing())
    filter.SetInputData(image)
    filter.SetResliceAxesDirectionCosines(axes)
    filter.SetResliceAxesOrigin(image.GetCenter())
    filter.SetOutputExtent(0, size - 1, 0, size - 1, 0, 0)
    filter.SetOutputSpacing(extent / size, extent / size, step)
    filter.SetOutputOrigin(-extent / 2, -extent / 2, 0)
    filter.SetInterpolationModeToLinear()
    filter.SetSlabModeToMax()
    filter.SetSlabNumberOfSlices(slices or round(extent / step))
    return filter


def milliseconds(filter):
    start = time.perf_counter(), time.process_time()
    filter.Update()
    return [1e3 * t for t in (time.process_time() - start[1], time.perf_counter() - start[0])]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("volume", nargs="?", default=AORTA)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(str(arguments.volume))
    reader.Update()
    image = reader.GetOutput()
    print("| slab | samples | vtkImageReslice: processor, passed | first exact | exact | factors |")
    print("|---|---|---|---|---|---|")
    for name, axes in AXES.items():
        for slices in (0, 10):
            exact = slab(vtkSplattingMIPReslice(), image, axes, arguments.size, slices)
            sampled = slab(vtk.vtkImageReslice(), image, axes, arguments.size, slices)
            first = milliseconds(exact)
            times = {exact: first, sampled: [float("inf")] * 2}
            for filter in (sampled, exact) * arguments.rounds:
                filter.Modified()
                times[filter] = list(map(min, times[filter], milliseconds(filter)))
            assert exact.GetSlabIsExact()
            numbers = ["{:.1f}, {:.1f}".format(*t) for t in (times[sampled], first, times[exact])]
            factors = "{:.1f}, {:.1f}".format(*(a / b for a, b in zip(times[sampled], times[exact])))
            print(f"| {name} | {exact.GetSlabNumberOfSlices()} |", " | ".join(numbers),
                  f"| {factors} |", flush=True)


if __name__ == "__main__":
    main()
