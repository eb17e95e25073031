#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Show the channels of a fluorescence microscope, one volume each, in one picture.

    python3 fluorescence_channels.py [--output channels.png]

The program makes the channels: nuclei (blue), filaments (green) and spots (red). Left to right:
each channel, and the sum of their colours, in which spots on filaments are yellow.
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

WIDTH, SLICES, STEP = 96, 16, 2.0
COLORS = ((0.0, 0.3, 1.0), (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))


def channels():
    """Nuclei, filaments between them, and spots on the filaments, as bytes."""
    chance = np.random.default_rng(8)

    def blob(at, radius):
        x, y, z = (np.exp(-(step * (np.arange(size) - middle) / radius) ** 2)
                   for middle, size, step in zip(at, (WIDTH, WIDTH, SLICES), (1.0, 1.0, STEP)))
        return z[:, None, None] * y[:, None] * x

    nuclei, filaments, spots = np.zeros((3, SLICES, WIDTH, WIDTH))
    centres = np.array([(24, 24, 8), (70, 20, 6), (24, 72, 9), (72, 70, 7), (48, 46, 8)], float)
    for centre in centres:
        nuclei = np.maximum(nuclei, np.minimum(1.0, 1.6 * blob(centre, 9.0)))
        for _ in range(7):
            angle = chance.uniform(0.0, 2.0 * np.pi)
            at = centre + 6.0 * np.array([np.cos(angle), np.sin(angle), 0.0])
            spot = chance.integers(6, 22)
            for step in range(22):
                angle += chance.uniform(-0.2, 0.2)
                at += [np.cos(angle), np.sin(angle), chance.uniform(-0.3, 0.3)]
                filaments = np.maximum(filaments, blob(at, 1.3))
                if step == spot:
                    spots = np.maximum(spots, blob(at, 2.0))
    for values in (nuclei, filaments, spots):
        image = vtkImageData()
        image.SetDimensions(WIDTH, WIDTH, SLICES)
        image.SetSpacing(1.0, 1.0, STEP)
        image.GetPointData().SetScalars(
            numpy_to_vtk((255.0 * values).astype(np.uint8).ravel(), deep=True))
        yield image


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--output", default="channels.png")
arguments = parser.parse_args()

volumes = []
for image, color in zip(channels(), COLORS):
    mapper = vtkSplattingMIPVolumeMapper()
    mapper.SetInputData(image)
    mapper.SetPictureBlendingToAdd()
    function = vtkColorTransferFunction()
    function.AddRGBPoint(0.0, 0.0, 0.0, 0.0)
    function.AddRGBPoint(255.0, *color)
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(function)
    volumes.append(volume)

panels = [[volume] for volume in volumes] + [volumes]
window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(140 * len(panels), 140)
for n, shown in enumerate(panels):
    renderer = vtkRenderer()
    renderer.SetViewport(n / len(panels), 0.0, (n + 1) / len(panels), 1.0)
    for volume in shown:
        renderer.AddVolume(volume)
    renderer.GetActiveCamera().ParallelProjectionOn()
    renderer.ResetCamera()
    renderer.GetActiveCamera().SetParallelScale(0.5 * WIDTH)
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
