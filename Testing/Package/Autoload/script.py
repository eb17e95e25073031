# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""script.py MODE FILE

Renders VTK's wavelet in a blend mode (a number of vtkVolumeMapper) and writes the pixels: four
bytes each, bottom row first. program.cxx has the same scene.
"""

import sys

import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction,
    vtkRenderer,
    vtkRenderWindow,
    vtkVolume,
)
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkSmartVolumeMapper

SIZE = 150


def picture(mapper, mode):
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(-15, 15, -15, 15, -15, 15)
    mapper.SetInputConnection(source.GetOutputPort())
    mapper.SetBlendMode(mode)
    gray = vtkColorTransferFunction()
    gray.AddRGBPoint(37, 0, 0, 0)
    gray.AddRGBPoint(277, 1, 1, 1)
    opacity = vtkPiecewiseFunction()
    opacity.AddPoint(37, 0.2)
    opacity.AddPoint(277, 1)
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(gray)
    volume.GetProperty().SetScalarOpacity(opacity)
    volume.GetProperty().SetInterpolationTypeToLinear()
    renderer = vtkRenderer()
    renderer.AddVolume(volume)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.Azimuth(25)
    camera.Elevation(20)
    renderer.ResetCamera()
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    window.Render()
    pixels = vtkUnsignedCharArray()
    window.GetRGBACharPixelData(0, 0, SIZE - 1, SIZE - 1, 0, pixels)
    return bytes(memoryview(pixels))


if __name__ == "__main__":
    with open(sys.argv[2], "wb") as file:
        file.write(picture(vtkSmartVolumeMapper(), int(sys.argv[1])))
