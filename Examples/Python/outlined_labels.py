#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Outline labels over a maximum intensity projection.

    python3 outlined_labels.py [--threshold 250] [--output outlined.png]

The volume is the CT angiogram that comes with the project. Its labels are the largest connected
parts above a threshold: the vessels with the stent (red), and bones. Left a pixel has the label of
the voxel that it shows, right the first label on its ray.
"""
import argparse
import pathlib

from vtkmodules.vtkImagingMorphological import vtkImageConnectivityFilter
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (provides the window)
from vtksplattingmip import vtkSplattingMIPVolumeMapper

AORTA = pathlib.Path(__file__).resolve().parent.parent / "Data" / "aorta-stent.vti"

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--threshold", type=float, default=250.0, help="the least scalar of a part")
parser.add_argument("--output", default="outlined.png")
arguments = parser.parse_args()

reader = vtkXMLImageDataReader()
reader.SetFileName(str(AORTA))
reader.Update()
image = reader.GetOutput()
parts = vtkImageConnectivityFilter()
parts.SetInputData(image)
parts.SetScalarRange(arguments.threshold, image.GetScalarRange()[1])
parts.SetSizeRange(1500, image.GetNumberOfPoints())
parts.SetExtractionModeToAllRegions()
parts.SetLabelModeToSizeRank()
parts.Update()

white = vtkColorTransferFunction()
white.AddRGBPoint(0.0, 0.0, 0.0, 0.0)
white.AddRGBPoint(900.0, 1.0, 1.0, 1.0)

window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(400, 300)
for side in range(2):
    mapper = vtkSplattingMIPVolumeMapper()
    mapper.SetInputData(image)
    mapper.SetLabelInput(parts.GetOutput())
    mapper.SetLabelMode(side)  # SAMPLE, PROJECTED
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(white)
    renderer = vtkRenderer()
    renderer.SetViewport(0.5 * side, 0.0, 0.5 * side + 0.5, 1.0)
    renderer.AddVolume(volume)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(0.0, -1.0, 0.0)  # the patient's front, ...
    camera.SetViewUp(0.0, 0.0, 1.0)  # ... head up
    renderer.ResetCamera()
    camera.SetParallelScale(0.5 * (image.GetBounds()[5] - image.GetBounds()[4]))
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
