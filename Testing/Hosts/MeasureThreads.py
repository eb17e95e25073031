# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Exact frames use all cores by default, and a program's choice holds.

    MeasureThreads.py               measures each choice in a process of its own, and checks it
    MeasureThreads.py CHOICE        prints seconds per frame, backend, busy cores and a checksum

A frame is the exact projection of 160³ voxels of noise and vessels, from another direction each time. Prints
a line for each check; fails if one does.
"""

import hashlib
import os
import statistics
import subprocess
import sys
import time

FRAMES = 5
ROUNDS = 8  # of all choices in turn; the speed of a shared machine changes in between
# How a program chooses: statements before the first projection, and variables of the environment.
CHOICES = {
    "default": ("", {}),
    "two threads": ("", {"VTK_SMP_MAX_THREADS": "2"}),
    "one thread": ("", {"VTK_SMP_MAX_THREADS": "1"}),
    "Initialize(1)": ("vtkSMPTools.Initialize(1)", {}),
    "Initialize(2)": ("vtkSMPTools.Initialize(2)", {}),
    "Sequential": ("", {"VTK_SMP_BACKEND_IN_USE": "Sequential"}),
    "STDThread": ("vtkSMPTools.SetBackend('STDThread')", {"VTK_SMP_MAX_THREADS": "2"}),
}
# Of one thread's time. Two threads must take 0.65; the others only show that a choice has an effect.
MOST_OF_PARALLEL = {"default": 0.65, "two threads": 0.65, "Initialize(2)": 0.8, "STDThread": 0.8}


def measure(choice):
    import numpy
    import vtksplattingmip.functions

    vtkSMPTools = vtksplattingmip._vtk_module("vtkCommonCore").vtkSMPTools
    exec(CHOICES[choice][0], {"vtkSMPTools": vtkSMPTools})
    backend = vtkSMPTools.GetBackend()
    volume = numpy.random.default_rng(1).integers(0, 200, (160, 160, 160), numpy.uint8)
    for n in range(20):
        volume[:, 8 * n, (37 * n) % 160] = 255
    image = vtksplattingmip.functions._image(volume, (1, 1, 1))
    projection = vtksplattingmip.vtkSplattingMIPProjection()
    projection.SetInputData(image)
    projection.SetOutputSize(512, 512)
    projection.Update()
    support = vtksplattingmip._vtk_module("util.numpy_support")
    checksum = hashlib.sha256()
    wall, busy = time.perf_counter(), time.process_time()
    for n in range(FRAMES):
        projection.SetViewDirection(1, 0.1 * n, 0.3)
        projection.Update()
        checksum.update(support.vtk_to_numpy(projection.GetOutput().GetPointData().GetScalars()))
    wall, busy = time.perf_counter() - wall, time.process_time() - busy
    if vtkSMPTools.GetBackend() != backend:
        sys.exit(f"The backend was {backend} and is {vtkSMPTools.GetBackend()}.")
    print(f"{wall / FRAMES:.4f} {backend} {busy / wall:.2f} {checksum.hexdigest()[:12]}")


def run(choice):
    """The words that a process for a choice prints."""
    environment = {key: value for key, value in os.environ.items() if not key.startswith("VTK_SMP")}
    return subprocess.run(
        [sys.executable, __file__, choice],
        env={**environment, **CHOICES[choice][1]},
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()


def main():
    failures = 0
    rounds = [{choice: run(choice) for choice in CHOICES} for _ in range(ROUNDS)]
    for choice in CHOICES:
        seconds = statistics.median(float(each[choice][0]) for each in rounds)
        ratio = statistics.median(float(each[choice][0]) / float(each["one thread"][0]) for each in rounds)
        busy = statistics.median(float(each[choice][2]) for each in rounds)
        backend, checksum = rounds[0][choice][1], rounds[0][choice][3]
        passed = all(each[choice][3] == rounds[0]["default"][3] for each in rounds)
        if choice in MOST_OF_PARALLEL:
            passed = passed and ratio <= MOST_OF_PARALLEL[choice]
        else:
            passed = passed and ratio >= 0.8 and busy < 1.1
        print(
            "ok:" if passed else "FAILED:",
            f"{choice}: {1000 * seconds:.1f} ms per frame, {ratio:.2f} of one thread's, "
            f"{busy:.2f} cores busy, backend {backend}, checksum {checksum}",
        )
        failures += not passed
    sys.exit(failures)


if __name__ == "__main__":
    measure(sys.argv[1]) if len(sys.argv) > 1 else main()
