#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Show the same view by quality modes and by VTK's ray casters, side by side.

    python3 beside_ray_caster.py [volume.vti | --phantom] [--of exact ray-caster] [--zoom 1]
        [--enlarge 1] [--output beside.png]

Left to right in the order of --of: preview, standard, high, exact, ray-caster, gpu-ray-caster. The
volume is the CT angiogram that comes with the project if none is given. --phantom makes one: a
vessel 1.8 voxels wide in front of bone, which is 0.6 times as bright.
"""
import argparse
import pathlib

import numpy as np

from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPiecewiseFunction
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction, vtkRenderer, vtkRenderWindow, vtkVolume, vtkWindowToImageFilter)
from vtkmodules.vtkRenderingVolume import (
    vtkFixedPointVolumeRayCastMapper, vtkGPUVolumeRayCastMapper)
from vtkmodules.vtkImagingCore import vtkImageExtractComponents, vtkImageMagnify
import vtkmodules.vtkRenderingVolumeOpenGL2  # noqa: F401 (both ray casters draw by it)
from vtksplattingmip import vtkSplattingMIPVolumeMapper

MODES = ("preview", "standard", "high", "exact")
RAY_CASTERS = {"ray-caster": vtkFixedPointVolumeRayCastMapper,
               "gpu-ray-caster": vtkGPUVolumeRayCastMapper}
AORTA = pathlib.Path(__file__).resolve().parent.parent / "Data" / "aorta-stent.vti"



def vessel_before_bone(size=64, width=1.8, vessel=1000.0, bone=600.0):
    """A wavy vessel across x in front of a plate, along the view direction y."""
    z, y, x = np.mgrid[0:size, 0:size, 0:size].astype(float)
    distance2 = ((y - 0.3 * size - 2.0 * np.cos(x / 5.0)) ** 2 +
                 (z - 0.5 * size - 6.0 * np.sin(x / 9.0)) ** 2)
    inside = vessel * np.exp2(-4.0 * distance2 / width ** 2)
    plate = bone * ((y > 0.6 * size) & (y < 0.8 * size) & (abs(z - 0.5 * size) < 0.3 * size))
    image = vtkImageData()
    image.SetDimensions(size, size, size)
    scalars = numpy_to_vtk(np.maximum(inside, plate).astype(np.int16).ravel(), deep=True)
    image.GetPointData().SetScalars(scalars)
    return image


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("volume", nargs="?", type=pathlib.Path, default=AORTA, help="a .vti file")
parser.add_argument("--of", nargs="+", default=["exact", "ray-caster"],
                    choices=MODES + tuple(RAY_CASTERS))
parser.add_argument("--phantom", action="store_true", help="a vessel in front of bone")
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

if arguments.phantom:
    image = vessel_before_bone()
else:
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
    if name in RAY_CASTERS:
        mapper = RAY_CASTERS[name]()
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
