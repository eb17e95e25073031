#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What hidden voxels cost, and small windows: whole frames beside VTK's ray caster.

    PYTHONPATH=BUILD/lib/python3/dist-packages \\
      xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" python3 hidden.py [--edge 128] [table ...]

Tables: hidden, windows; both if none is named. Needs NumPy. Times are milliseconds of processor
time over all threads, which other programs disturb less than the time that passes, and the least
of seven views.
"""
import argparse
import time

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk
from vtksplattingmip import vtkSplattingMIPVolumeMapper

MODES = ("preview", "standard", "high", "exact", "high, minimum")


def noise_with_vessels(edge, random):
    axes = numpy.linspace(-1.0, 1.0, edge)
    places = numpy.stack(numpy.meshgrid(axes, axes, axes, indexing="ij"))
    voxels = 60.0 + 20.0 * random.standard_normal((edge, edge, edge))
    for _ in range(8):
        direction = random.standard_normal(3)
        direction /= numpy.linalg.norm(direction)
        away = places - random.uniform(-0.5, 0.5, 3)[:, None, None, None]
        along = numpy.tensordot(direction, away, 1)
        voxels[(away ** 2).sum(0) - along ** 2 < 0.0008] = 200.0
    return voxels.clip(0, 255), (places ** 2).sum(0) < 0.5


def image_of(voxels):
    image = vtk.vtkImageData()
    image.SetDimensions(voxels.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(voxels.ravel(), deep=True))
    return image


def with_hidden(voxels, hidden):
    image = image_of(voxels)
    flags = numpy_to_vtk(hidden.astype(numpy.uint8).ravel() * vtk.vtkDataSetAttributes.HIDDENPOINT,
                         deep=True, array_type=vtk.VTK_UNSIGNED_CHAR)
    flags.SetName(vtk.vtkDataSetAttributes.GhostArrayName())
    image.GetPointData().AddArray(flags)
    return image


def milliseconds(mapper, image, parallel, size, frames=7):
    mapper.SetInputData(image)
    mapper.SetAutoAdjustSampleDistances(False)
    colors, opacity = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    for scalar in (0, 1):
        colors.AddRGBPoint(255 * scalar, scalar, scalar, scalar)
        opacity.AddPoint(255 * scalar, scalar)
    volume = vtk.vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(colors)
    volume.GetProperty().SetScalarOpacity(opacity)
    volume.GetProperty().SetInterpolationTypeToLinear()
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    renderer.AddVolume(volume)
    window.SetOffScreenRendering(True)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    camera = renderer.GetActiveCamera()
    camera.SetParallelProjection(parallel)
    renderer.ResetCamera()
    camera.Azimuth(20)
    camera.Elevation(15)
    window.Render()
    times = []
    for _ in range(frames):
        camera.Azimuth(7)
        start = time.process_time()
        window.Render()
        times.append(time.process_time() - start)
    return 1e3 * min(times)


def ray_caster():
    mapper = vtk.vtkFixedPointVolumeRayCastMapper()
    mapper.SetBlendModeToMaximumIntensity()
    return mapper


def splatter(mode, mask=None):
    mapper = vtkSplattingMIPVolumeMapper()
    mapper.SetQualityMode(min(mode, 3) if mode < 4 else 2)
    mapper.SetBlendMode(vtk.vtkVolumeMapper.MINIMUM_INTENSITY_BLEND if mode == 4
                        else vtk.vtkVolumeMapper.MAXIMUM_INTENSITY_BLEND)
    mapper.SetMaskInput(mask)
    return mapper


def print_hidden(voxels, ball, random):
    """In brackets: as multiples of the frame in which no voxel is hidden."""
    single = numpy.zeros(voxels.shape, bool)
    single[tuple(edge // 2 for edge in voxels.shape)] = True
    few, half = random.uniform(size=voxels.shape) < 0.01, random.uniform(size=voxels.shape) < 0.5
    floats, bytes_ = voxels.astype(numpy.float32), voxels.astype(numpy.uint8)
    nan = numpy.float32("nan")
    cases = {
        "one NaN": (floats, image_of(numpy.where(single, nan, floats)), None),
        "1 % NaN": (floats, image_of(numpy.where(few, nan, floats)), None),
        "one hidden point": (bytes_, with_hidden(bytes_, single), None),
        "a ball as mask": (bytes_, image_of(bytes_), image_of(ball.astype(numpy.uint8))),
        "half of all as mask": (bytes_, image_of(bytes_), image_of(half.astype(numpy.uint8))),
    }
    print("| view | mode | " + " | ".join(cases) + " |")
    print("|---|---|" + "---|" * len(cases))
    for parallel in (True, False):
        for mode, name in enumerate(MODES):
            row = []
            for plain, image, mask in cases.values():
                before = milliseconds(splatter(mode), image_of(plain), parallel, (300, 300))
                after = milliseconds(splatter(mode, mask), image, parallel, (300, 300))
                row.append(f"{after:.0f} ({after / before:.1f}×)")
            print(f"| {'parallel' if parallel else 'perspective'} | {name} | " + " | ".join(row) + " |")


def print_windows(voxels):
    """In brackets: how many times as long the ray caster takes."""
    image = image_of(voxels.astype(numpy.uint8))
    print("| view | window | " + " | ".join(MODES[:4]) + " |")
    print("|---|---|" + "---|" * 4)
    for parallel in (True, False):
        for size in ((30, 30), (1000, 4), (300, 300)):
            other = milliseconds(ray_caster(), image, parallel, size)
            own = [milliseconds(splatter(mode), image, parallel, size) for mode in range(4)]
            print(f"| {'parallel' if parallel else 'perspective'} | {size[0]} × {size[1]} | " +
                  " | ".join(f"{t:.1f} ({other / t:.2f}×)" for t in own) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--edge", type=int, default=128, help="of the volume, in voxels")
    parser.add_argument("tables", nargs="*", metavar="table", help="hidden or windows")
    arguments = parser.parse_args()
    random = numpy.random.default_rng(1)
    voxels, ball = noise_with_vessels(arguments.edge, random)
    print(f"noise and vessels, {arguments.edge}³, {vtk.vtkSMPTools.GetEstimatedNumberOfThreads()} threads")
    if not arguments.tables or "hidden" in arguments.tables:
        print_hidden(voxels, ball, random)
    if not arguments.tables or "windows" in arguments.tables:
        print_windows(voxels)


if __name__ == "__main__":
    main()
