# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of ParaView's plugin share: volumes, views with one pixel per voxel, and pictures.

A test is run as `pvbatch TestX.py PLUGIN BASELINES OUTPUT`: the plugin's file, the folder with the
baselines, and one for what the test writes.
"""

import os
import sys
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGReader, vtkPNGWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from paraview import simple

PLUGIN, BASELINES, OUTPUT = sys.argv[1:4]
# The colour table has 16 entries for each integer; the picture has eight bits.
ROUNDING = 0.5 + 1 / 32 + 1e-9
DIMENSIONS = (40, 36, 44)  # along x, y and z: unlike, so that no axis passes for another
WINDOW = 64

# The screen's right and up, and the direction from the viewer on, of views along the axes.
VIEWS = {
    "from +z": ((1, 0, 0), (0, 1, 0), (0, 0, -1)),
    "from -z": ((-1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "from +x": ((0, 1, 0), (0, 0, 1), (-1, 0, 0)),
    "from -y": ((1, 0, 0), (0, 0, 1), (0, 1, 0)),
}


def main():
    """Runs the tests of the calling script, and lets it end: ParaView crashes on sys.exit()."""
    simple._DisableFirstRenderCameraReset()
    program = unittest.main(module="__main__", argv=[sys.argv[0]], verbosity=2, exit=False)
    if not program.result.wasSuccessful():
        raise RuntimeError("a test failed")


def load_plugin(remote=False):
    simple.LoadPlugin(PLUGIN, remote=remote, ns=globals())


def noise(seed, dimensions=DIMENSIONS):
    """Random bytes, indexed by z, y and x."""
    return numpy.random.default_rng(seed).integers(0, 256, dimensions[::-1], dtype=numpy.uint8)


def image(origin=(0, 0, 0), spacing=(1, 1, 1), **arrays):
    """vtkImageData with point arrays indexed by z, y, x (and component)."""
    data = vtkImageData()
    for name, values in arrays.items():
        depth, height, width = values.shape[:3]
        data.SetDimensions(width, height, depth)
        flat = values.reshape(width * height * depth, -1)
        array = numpy_to_vtk(numpy.ascontiguousarray(flat), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
    data.SetOrigin(origin)
    data.SetSpacing(spacing)
    return data


def path(name):
    os.makedirs(OUTPUT, exist_ok=True)
    return os.path.join(OUTPUT, name)


def open_images(name, *images):
    """A reader of the images, which are its time steps if there are several."""
    names = []
    for step, data in enumerate(images):
        names.append(path(f"{name}{step}.vti"))
        writer = vtkXMLImageDataWriter()
        writer.SetFileName(names[-1])
        writer.SetDataModeToBinary()
        writer.SetInputData(data)
        writer.Write()
    return simple.XMLImageDataReader(registrationName=name, FileName=names)


def new_view(size=WINDOW):
    view = simple.CreateView("RenderView")
    view.ViewSize = [size, size]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0, 0, 0]
    view.UseFXAA = 0  # would smooth what comes from a server
    view.CameraParallelProjection = 1
    return view


def look(view, direction, center=None, scale=None):
    """Pixels' centres on voxels' centres, if the spacing is 1 and the origin 0."""
    right, up, forward = (numpy.array(axis) for axis in VIEWS[direction])
    if center is None:
        # Even sizes have a voxel half a pixel beside the volume's middle, as the window has.
        center = [d / 2 - 0.5 for d in DIMENSIONS]
    view.CameraFocalPoint = list(center)
    view.CameraPosition = list(center - 200.0 * forward)
    view.CameraViewUp = list(up)
    view.CameraParallelScale = scale or view.ViewSize[1] / 2


def show(source, view, array="scalars", type="Splatting MIP"):
    """The display of the source, whose array's values are shown as gray levels from 0 to 255."""
    display = simple.Show(source, view)
    if not display.SetRepresentationType(type):
        raise RuntimeError("there is no representation " + type)
    if array:
        simple.ColorBy(display, ("POINTS", array))
        gray(array)
    display.MIPQuality = "Preview"
    return display


def gray(array):
    colors = simple.GetColorTransferFunction(array)
    colors.RGBPoints = [0, 0, 0, 0, 255, 1, 1, 1]
    colors.ColorSpace = "RGB"
    opacity = simple.GetOpacityTransferFunction(array)
    opacity.Points = [0, 1, 0.5, 0, 255, 1, 0.5, 0]


def picture(view, name=None, **options):
    """What a screenshot of the view shows: red, green, blue by rows, the lowest first."""
    file = path((name or "screenshot") + ".png")
    simple.SaveScreenshot(file, view, ImageResolution=list(view.ViewSize), **options)
    return read_picture(file)


def read_picture(file):
    reader = vtkPNGReader()
    reader.SetFileName(file)
    reader.Update()
    data = reader.GetOutput()
    width, height, _ = data.GetDimensions()
    return vtk_to_numpy(data.GetPointData().GetScalars()).reshape(height, width, -1)[:, :, :3]


def seen(volume, direction):
    """The volume (z, y, x) with axes turned to depth from the viewer on, screen up, screen right."""
    axes = []
    for axis in (VIEWS[direction][i] for i in (2, 1, 0)):
        x_y_z = next(i for i in range(3) if axis[i])
        axes.append((2 - x_y_z, axis[x_y_z] < 0))
    turned = volume.transpose([a for a, _ in axes])
    return numpy.flip(turned, [i for i, (_, is_flipped) in enumerate(axes) if is_flipped])


def shown(projection, pixels):
    """The part of the pixels that shows the projection, without its outermost voxels, and the
    projection without them. Whether a pixel on the very border is inside is anyone's choice."""
    height, width = projection.shape[:2]
    bottom = (pixels.shape[0] - height) // 2
    left = (pixels.shape[1] - width) // 2
    return (
        pixels[bottom + 1 : bottom + height - 1, left + 1 : left + width - 1].astype(int),
        projection[1:-1, 1:-1],
    )


def baseline_error(pixels, name):
    """The largest difference from the baseline, or why there is none to compare with."""
    file = os.path.join(BASELINES, name + ".png")
    if not os.path.exists(file):
        return "there is no " + file
    expected = read_picture(file)
    if expected.shape != pixels.shape:
        return f"the baseline's size is {expected.shape}"
    return int(numpy.abs(expected.astype(int) - pixels.astype(int)).max())


class Test(unittest.TestCase):
    """Each test starts with nothing but the plugin."""

    @classmethod
    def setUpClass(cls):
        load_plugin()

    def setUp(self):
        simple.ResetSession()

    def assertShows(self, projection, view, tolerance=0):
        """The gray levels in the view are those of the projection, the rest is black."""
        pixels = picture(view)
        inside, expected = shown(numpy.asarray(projection, float), pixels)
        for channel in range(3):
            error = numpy.abs(inside[:, :, channel] - expected).max()
            self.assertLessEqual(error, tolerance)
        height, width = projection.shape
        outside = numpy.ones(pixels.shape[:2], bool)
        bottom, left = (pixels.shape[0] - height) // 2, (pixels.shape[1] - width) // 2
        outside[bottom : bottom + height, left : left + width] = False
        self.assertEqual(pixels[outside].max(), 0)
