#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Write a maximum intensity projection of a volume as a PNG picture.

    python3 splatmip.py [volume.vti] [--mode preview|standard|high|exact] [--output splatmip.png]
"""
import argparse
import pathlib

from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (provides the window)
from vtksplattingmip import vtkSplattingMIPVolumeMapper

AORTA = pathlib.Path(__file__).resolve().parent.parent / "Data" / "aorta-stent.vti"

parser = argparse.ArgumentParser(description="Maximum intensity projection by splatting")
parser.add_argument("volume", nargs="?", type=pathlib.Path, default=AORTA, help="a .vti file")
parser.add_argument("--mode", choices=("preview", "standard", "high", "exact"), default="exact")
parser.add_argument("--output", default="splatmip.png")
arguments = parser.parse_args()
if not arguments.volume.is_file():
    parser.error(f"there is no file {arguments.volume}")

reader = vtkXMLImageDataReader()
reader.SetFileName(str(arguments.volume))
reader.Update()
low, high = reader.GetOutput().GetScalarRange()

mapper = vtkSplattingMIPVolumeMapper()
mapper.SetInputConnection(reader.GetOutputPort())
mapper.SetBlendModeToMaximumIntensity()
getattr(mapper, "SetQualityModeTo" + arguments.mode.capitalize())()

gray = vtkColorTransferFunction()
gray.AddRGBPoint(low, 0.0, 0.0, 0.0)
gray.AddRGBPoint(low + 0.7 * (high - low), 1.0, 1.0, 1.0)
volume = vtkVolume()
volume.SetMapper(mapper)
volume.GetProperty().SetColor(gray)
volume.GetProperty().SetInterpolationTypeToLinear()

renderer = vtkRenderer()
renderer.AddVolume(volume)
camera = renderer.GetActiveCamera()
camera.ParallelProjectionOn()
camera.SetPosition(0.0, -1.0, 0.0)  # the patient's front, ...
camera.SetViewUp(0.0, 0.0, 1.0)  # ... head up
renderer.ResetCamera()
camera.Azimuth(20.0)
camera.Elevation(10.0)
camera.Zoom(1.15)

window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(400, 600)
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
