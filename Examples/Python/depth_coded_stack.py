#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Show a microscopy stack with depth coded as hue: red is nearest, blue farthest.

    python3 depth_coded_stack.py [stack.vti] [--output depths.png]

Without a stack one is made: a neuron, as a confocal microscope sees it, whose branches wind through
the depths; with dim noise and slices farther apart than pixels.
"""
import argparse
import math
import pathlib
import random

from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (provides the window)
from vtksplattingmip import vtkSplattingMIPVolumeMapper

WIDTH, SLICES, STEP = 160, 40, 2.5


def neuron():
    """A cell body with branches, as bytes."""
    chance = random.Random(7)
    voxels = bytearray(chance.choices(range(12), k=WIDTH * WIDTH * SLICES))

    def draw(x, y, z, radius, value):
        reach = int(radius) + 1
        for k in range(max(int(z) - 1, 0), min(int(z) + 2, SLICES)):
            for j in range(max(int(y) - reach, 0), min(int(y) + reach + 1, WIDTH)):
                for i in range(max(int(x) - reach, 0), min(int(x) + reach + 1, WIDTH)):
                    off = math.hypot(i - x, j - y, STEP * (k - z)) / radius
                    at = (k * WIDTH + j) * WIDTH + i
                    voxels[at] = max(voxels[at], int(value * max(0.0, 1.0 - 0.5 * off * off)))

    draw(WIDTH / 2, WIDTH / 2, SLICES / 2, 9.0, 230)
    for branch in range(9):
        angle, z = 2.0 * math.pi * branch / 9.0, SLICES / 2
        climb = (branch - 4) / 4.0 * 0.3
        x = y = WIDTH / 2
        for step in range(70):
            angle += chance.uniform(-0.15, 0.15)
            x, y, z = x + math.cos(angle), y + math.sin(angle), z + climb
            draw(x, y, z, 2.2 - 0.015 * step, 220)
    stack = vtkImageData()
    stack.SetDimensions(WIDTH, WIDTH, SLICES)
    stack.SetSpacing(1.0, 1.0, STEP)
    stack.AllocateScalars(VTK_UNSIGNED_CHAR, 1)
    memoryview(stack.GetPointData().GetScalars())[:] = bytes(voxels)
    return stack


parser = argparse.ArgumentParser(description="Depth-coded projection of a microscopy stack")
parser.add_argument("stack", nargs="?", type=pathlib.Path, help="a .vti file")
parser.add_argument("--output", default="depths.png")
arguments = parser.parse_args()
if arguments.stack:
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(arguments.stack))
    reader.Update()
    image = reader.GetOutput()
else:
    image = neuron()
low, high = image.GetScalarRange()

mapper = vtkSplattingMIPVolumeMapper()
mapper.SetInputData(image)
mapper.DepthCodingOn()

white = vtkColorTransferFunction()  # how bright; the hue comes from the depth
white.AddRGBPoint(low + 0.1 * (high - low), 0.0, 0.0, 0.0)
white.AddRGBPoint(low + 0.8 * (high - low), 1.0, 1.0, 1.0)
volume = vtkVolume()
volume.SetMapper(mapper)
volume.GetProperty().SetColor(white)

renderer = vtkRenderer()
renderer.AddVolume(volume)
camera = renderer.GetActiveCamera()
camera.ParallelProjectionOn()
renderer.ResetCamera()
camera.Zoom(1.6)

window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(500, 500)
window.AddRenderer(renderer)
window.Render()

picture = vtkWindowToImageFilter()
picture.SetInput(window)
picture.ReadFrontBufferOff()
writer = vtkPNGWriter()
writer.SetInputConnection(picture.GetOutputPort())
writer.SetFileName(arguments.output)
writer.Write()
print("picture:", pathlib.Path(arguments.output).resolve())
