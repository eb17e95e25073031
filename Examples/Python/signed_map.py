#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Show a statistical map by its signed maximum: on each ray the value that is farthest from 0.

    python3 signed_map.py [--output signed.png]

The program makes the map: smooth noise with regions that rise (red to yellow) and regions that fall
(blue to cyan), some behind others. Left to right: maximum, minimum, signed maximum.
"""
import argparse
import pathlib

import numpy as np

from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (provides the window)
from vtksplattingmip import vtkSplattingMIPVolumeMapper

SIZE = 64
# Position from -1 to 1, radius, value in the middle.
REGIONS = (((-0.5, -0.4, 0.3), 0.25, 8.0), ((-0.4, 0.5, 0.2), 0.4, -6.0),
           ((0.4, -0.2, -0.4), 0.35, -7.0), ((0.5, 0.5, 0.3), 0.3, 6.0),
           ((0.4, 0.4, -0.5), 0.15, 9.0))
COLORS = ((-8.0, (0.3, 1.0, 1.0)), (-4.0, (0.0, 0.2, 1.0)), (-1.5, (0.0, 0.0, 0.0)),
          (1.5, (0.0, 0.0, 0.0)), (4.0, (1.0, 0.2, 0.0)), (8.0, (1.0, 1.0, 0.3)))


def statistical_map():
    """Noise inside a ball, with regions that rise and fall."""
    z, y, x = np.mgrid[-1:1:SIZE * 1j, -1:1:SIZE * 1j, -1:1:SIZE * 1j]
    values = np.random.default_rng(5).normal(size=x.shape)
    for axis in range(3):
        for _ in range(4):
            values = (np.roll(values, 1, axis) + 2.0 * values + np.roll(values, -1, axis)) / 4.0
    values *= 0.8 / values.std()
    for centre, radius, value in REGIONS:
        distance2 = (x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2
        values += value * np.exp(-2.0 * distance2 / radius ** 2)
    values[x * x + y * y + z * z > 0.95] = 0.0
    image = vtkImageData()
    image.SetDimensions(SIZE, SIZE, SIZE)
    image.GetPointData().SetScalars(numpy_to_vtk(values.astype(np.float32).ravel(), deep=True))
    return image


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--output", default="signed.png")
arguments = parser.parse_args()

image = statistical_map()
diverging = vtkColorTransferFunction()
for value, color in COLORS:
    diverging.AddRGBPoint(value, *color)

window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(450, 150)
for n in range(3):
    mapper = vtkSplattingMIPVolumeMapper()
    mapper.SetInputData(image)
    if n == 1:
        mapper.SetBlendModeToMinimumIntensity()
    if n == 2:
        mapper.SetMaximumTypeToSigned()
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(diverging)
    renderer = vtkRenderer()
    renderer.SetViewport(n / 3.0, 0.0, (n + 1) / 3.0, 1.0)
    renderer.AddVolume(volume)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(0.0, -1.0, 0.0)
    camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    camera.SetParallelScale(0.5 * SIZE)
    window.AddRenderer(renderer)
window.Render()

picture = vtkWindowToImageFilter()
picture.SetInput(window)
picture.ReadFrontBufferOff()
writer = vtkPNGWriter()
writer.SetInputConnection(picture.GetOutputPort())
writer.SetCompressionLevel(9)
writer.SetFileName(arguments.output)
writer.Write()
print("picture:", pathlib.Path(arguments.output).resolve())
