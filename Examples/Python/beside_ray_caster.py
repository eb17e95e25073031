#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Show the same view by quality modes and by VTK's CPU ray caster, side by side.

    python3 beside_ray_caster.py [volume.vti] [--of exact ray-caster] [--zoom 1] [--enlarge 1]
        [--output beside.png]

Left to right in the order of --of: preview, standard, high, exact, ray-caster. The volume is the
CT angiogram that comes with the project if none is given.
"""
import argparse
import pathlib

from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper
from vtkmodules.vtkImagingCore import vtkImageExtractComponents, vtkImageMagnify
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401 (draws the ray caster's image)
from vtksplattingmip import vtkSplattingMIPVolumeMapper

MODES = ("preview", "standard", "high", "exact")
AORTA = pathlib.Path(__file__).resolve().parent.parent / "Data" / "aorta-stent.vti"

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("volume", nargs="?", type=pathlib.Path, default=AORTA, help="a .vti file")
parser.add_argument("--of", nargs="+", default=["exact", "ray-caster"],
                    choices=MODES + ("ray-caster",))
parser.add_argument("--view", nargs=3, type=float, default=[0.2, 1.0, 0.1], metavar=("X", "Y", "Z"),
                    help="the direction in which the camera looks")
parser.add_argument("--at", nargs=3, type=float, default=[0.5, 0.5, 0.5], metavar=("X", "Y", "Z"),
                    help="the middle of the pictures, in shares of the volume")
parser.add_argument("--zoom", type=float, default=1.0)
parser.add_argument("--window", nargs=2, type=float, metavar=("LOW", "HIGH"),
                    help="the scalars that are black and white")
parser.add_argument("--size", nargs=2, type=int, default=[200, 300], help="of each picture")
parser.add_argument("--enlarge", type=int, default=1, help="show each pixel as so many squared")
parser.add_argument("--output", default="beside.png")
arguments = parser.parse_args()

reader = vtkXMLImageDataReader()
reader.SetFileName(str(arguments.volume))
reader.Update()
image = reader.GetOutput()
low, high = arguments.window or image.GetScalarRange()
white, opaque = vtkColorTransferFunction(), vtkPiecewiseFunction()
white.AddRGBPoint(low, 0.0, 0.0, 0.0)
white.AddRGBPoint(high, 1.0, 1.0, 1.0)
opaque.AddPoint(low, 1.0)
opaque.AddPoint(high, 1.0)

window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetMultiSamples(0)
window.SetSize(arguments.size[0] * len(arguments.of), arguments.size[1])
camera = None
for n, name in enumerate(arguments.of):
    if name == "ray-caster":
        mapper = vtkFixedPointVolumeRayCastMapper()
        mapper.SetBlendModeToMaximumIntensity()
    else:
        mapper = vtkSplattingMIPVolumeMapper()
        mapper.SetQualityMode(MODES.index(name))
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetInputData(image)
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(white)
    volume.GetProperty().SetScalarOpacity(opaque)
    volume.GetProperty().SetInterpolationTypeToLinear()
    renderer = vtkRenderer()
    renderer.SetViewport(n / len(arguments.of), 0.0, (n + 1) / len(arguments.of), 1.0)
    renderer.AddVolume(volume)
    window.AddRenderer(renderer)
    if camera is None:
        camera = renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        bounds = image.GetBounds()
        at = [bounds[2 * a] + s * (bounds[2 * a + 1] - bounds[2 * a])
              for a, s in enumerate(arguments.at)]
        camera.SetFocalPoint(at)
        camera.SetPosition([p - v for p, v in zip(at, arguments.view)])
        camera.SetViewUp(0.0, 0.0, 1.0)
        renderer.ResetCamera()
        shift = [p - f for p, f in zip(at, camera.GetFocalPoint())]
        camera.SetPosition([p + s for p, s in zip(camera.GetPosition(), shift)])
        camera.SetFocalPoint(at)
        camera.Zoom(arguments.zoom)
    renderer.SetActiveCamera(camera)
    renderer.ResetCameraClippingRange()
window.Render()

shot = vtkWindowToImageFilter()
shot.SetInput(window)
gray = vtkImageExtractComponents()
gray.SetComponents(0)
gray.SetInputConnection(shot.GetOutputPort())
enlarged = vtkImageMagnify()
enlarged.SetMagnificationFactors(arguments.enlarge, arguments.enlarge, 1)
enlarged.SetInputConnection(gray.GetOutputPort())
writer = vtkPNGWriter()
writer.SetInputConnection(enlarged.GetOutputPort())
writer.SetFileName(arguments.output)
writer.Write()
print("picture:", arguments.output)
