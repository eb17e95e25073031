#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Show a stack of a light-sheet microscope without resampling: the prop's matrix deskews it.

    python3 skewed_stack.py [stack.vti] [--shift 1.5] [--output skewed.png]

Such microscopes move the sample across a tilted sheet of light, so each slice is displaced against
the one before it. Left is the stack as it is stored, right the sample. Without a stack one is made:
a ball of beads.
"""
import argparse
import math
import pathlib

from vtkmodules.vtkCommonCore import VTK_UNSIGNED_CHAR
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (provides the window)
from vtksplattingmip import vtkSplattingMIPVolumeMapper

WIDTH, HEIGHT, SLICES = 84, 48, 40


def beads(shift):
    """A spiral of beads on a ball, in slices each of which is displaced by -shift along x."""
    voxels = bytearray(WIDTH * HEIGHT * SLICES)
    for bead in range(40):
        height = 2.0 * (bead + 0.5) / 40 - 1.0
        angle, radius = 2.399963 * bead, 16.0 * math.sqrt(1.0 - height * height)
        y, z = HEIGHT / 2 + radius * math.sin(angle), SLICES / 2 + 16.0 * height
        for k in range(int(z) - 2, int(z) + 4):
            x = WIDTH / 2 + radius * math.cos(angle) - shift * (k - SLICES / 2)
            for j in range(int(y) - 2, int(y) + 4):
                for i in range(int(x) - 2, int(x) + 4):
                    value = 255 * math.exp(-((i - x) ** 2 + (j - y) ** 2 + (k - z) ** 2) / 2)
                    at = (k * HEIGHT + j) * WIDTH + i
                    voxels[at] = max(voxels[at], int(value))
    stack = vtkImageData()
    stack.SetDimensions(WIDTH, HEIGHT, SLICES)
    stack.AllocateScalars(VTK_UNSIGNED_CHAR, 1)
    memoryview(stack.GetPointData().GetScalars())[:] = bytes(voxels)
    return stack


parser = argparse.ArgumentParser(description="Deskewed projection of a light-sheet stack")
parser.add_argument("stack", nargs="?", type=pathlib.Path, help="a .vti file")
parser.add_argument("--shift", type=float, default=1.0,
                    help="by which each slice lies farther along x, in units of the distance of slices")
parser.add_argument("--output", default="skewed.png")
arguments = parser.parse_args()
if arguments.stack:
    reader = vtkXMLImageDataReader()
    reader.SetFileName(str(arguments.stack))
    reader.Update()
    image = reader.GetOutput()
else:
    image = beads(arguments.shift)
low, high = image.GetScalarRange()

mapper = vtkSplattingMIPVolumeMapper()
mapper.SetInputData(image)
gray = vtkColorTransferFunction()
gray.AddRGBPoint(low + 0.3 * (high - low), 0.0, 0.0, 0.0)
gray.AddRGBPoint(low + 0.5 * (high - low), 1.0, 1.0, 1.0)

window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(220, 90)
for side, shift in enumerate((0.0, arguments.shift)):
    deskew = vtkMatrix4x4()  # x grows with z
    deskew.SetElement(0, 2, shift)
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(gray)
    volume.SetUserMatrix(deskew)
    renderer = vtkRenderer()
    renderer.SetViewport(0.5 * side, 0.0, 0.5 * side + 0.5, 1.0)
    renderer.AddVolume(volume)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(0.0, -1.0, 0.0)
    camera.SetViewUp(0.0, 0.0, 1.0)
    renderer.ResetCamera()
    camera.SetParallelScale(0.6 * (image.GetBounds()[5] - image.GetBounds()[4]))
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
