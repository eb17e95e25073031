#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pick a vessel in a maximum intensity projection: where a click falls, a ball marks the vessel.

    python3 pick_vessel.py [volume.vti]               opens a window; click with the left button
    python3 pick_vessel.py --click X Y --output picked.png   clicks by itself, without a window
"""
import argparse
import pathlib

from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkInteractionStyle import vtkInteractorStyleTrackballCamera
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkColorTransferFunction, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow,
    vtkRenderWindowInteractor, vtkVolume, vtkWindowToImageFilter)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401 (provides the window)
from vtksplattingmip import vtkSplattingMIPVolumeMapper

AORTA = pathlib.Path(__file__).resolve().parent.parent / "Data" / "aorta-stent.vti"

parser = argparse.ArgumentParser(description="Pick a vessel in a projection")
parser.add_argument("volume", nargs="?", type=pathlib.Path, default=AORTA, help="a .vti file")
parser.add_argument("--click", nargs=2, type=int, metavar=("X", "Y"), help="in pixels")
parser.add_argument("--output", default="picked.png", help="picture after --click")
arguments = parser.parse_args()

reader = vtkXMLImageDataReader()
reader.SetFileName(str(arguments.volume))
reader.Update()
image = reader.GetOutput()
low, high = image.GetScalarRange()

mapper = vtkSplattingMIPVolumeMapper()
mapper.SetInputConnection(reader.GetOutputPort())

gray = vtkColorTransferFunction()
gray.AddRGBPoint(low, 0.0, 0.0, 0.0)
gray.AddRGBPoint(low + 0.7 * (high - low), 1.0, 1.0, 1.0)
volume = vtkVolume()
volume.SetMapper(mapper)
volume.GetProperty().SetColor(gray)

ball = vtkSphereSource()
ball.SetRadius(0.02 * image.GetLength())
ball_mapper = vtkPolyDataMapper()
ball_mapper.SetInputConnection(ball.GetOutputPort())
marker = vtkActor()
marker.SetMapper(ball_mapper)
marker.GetProperty().SetColor(1.0, 0.3, 0.1)
marker.VisibilityOff()

renderer = vtkRenderer()
renderer.AddVolume(volume)
# The volume ends its rays at opaque things: the ball lies in a layer above.
above = vtkRenderer()
above.SetLayer(1)
above.AddActor(marker)
above.SetActiveCamera(renderer.GetActiveCamera())
camera = renderer.GetActiveCamera()
camera.SetPosition(0.0, -1.0, 0.0)  # the patient's front, ...
camera.SetViewUp(0.0, 0.0, 1.0)  # ... head up
renderer.ResetCamera()

window = vtkRenderWindow()
window.SetNumberOfLayers(2)
window.SetSize(400, 600)
window.AddRenderer(renderer)
window.AddRenderer(above)


def pick(x, y):
    """Moves the ball to what is seen at a pixel of the window."""
    position = [0.0, 0.0, 0.0]
    if mapper.PickWorldPosition(x, y, position):
        marker.SetPosition(position)
        marker.VisibilityOn()
        print("picked: %.1f %.1f %.1f" % tuple(position), flush=True)
    else:
        print("nothing there", flush=True)
    window.Render()


if arguments.click:
    window.SetOffScreenRendering(True)
    window.Render()
    pick(*arguments.click)
    picture = vtkWindowToImageFilter()
    picture.SetInput(window)
    picture.ReadFrontBufferOff()
    writer = vtkPNGWriter()
    writer.SetInputConnection(picture.GetOutputPort())
    writer.SetFileName(arguments.output)
    writer.Write()
    print("picture:", pathlib.Path(arguments.output).resolve())
else:
    interactor = vtkRenderWindowInteractor()
    interactor.SetRenderWindow(window)
    style = vtkInteractorStyleTrackballCamera()
    interactor.SetInteractorStyle(style)

    def click(*_):
        pick(*interactor.GetEventPosition())
        style.OnLeftButtonDown()

    style.AddObserver("LeftButtonPressEvent", click)
    window.Render()
    interactor.Start()
