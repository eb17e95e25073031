# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of Examples/Python/web_viewer.py share: a volume, a running viewer, an oracle."""
import contextlib
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile
import urllib.error
import urllib.parse
import urllib.request

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkJPEGReader, vtkPNGReader
from vtksplattingmip import vtkSplattingMIPProjection

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "Examples" / "Python"
VIEWER = EXAMPLES / "web_viewer.py"

# Patient coordinates, another size and spacing along each axis, and no symmetry.
SIZE = (40, 48, 44)  # x, y, z
SPACING = (1.0, 0.75, 1.25)
ORIGIN = (-30.0, 12.0, -7.0)
BRIGHT = (9, 30, 33)  # a voxel, whose value is that of no other
BRIGHT_VALUE = 3000


def make_values():
    """Values[z, y, x]: weak noise, two bars, a bright voxel."""
    values = numpy.random.default_rng(3).integers(0, 200, SIZE[::-1], numpy.int16)
    values[5:40, 10:14, 28:32] = 1200
    values[8:12, 20:40, 6:30] = 800
    values[BRIGHT[::-1]] = BRIGHT_VALUE
    return values


def write_nrrd(path, values=None):
    values = make_values() if values is None else values
    header = ["NRRD0004", "type: int16", "dimension: 3", "space: left-posterior-superior",
              "sizes: %d %d %d" % SIZE, "space directions: (%g,0,0) (0,%g,0) (0,0,%g)" % SPACING,
              "endian: little", "encoding: raw", "space origin: (%g,%g,%g)" % ORIGIN]
    pathlib.Path(path).write_bytes("\n".join(header + ["", ""]).encode() + values.astype("<i2").tobytes())
    return path


def run_to_end(*arguments):
    """The viewer with arguments that make it end by itself: its status, and what it said."""
    done = subprocess.run([sys.executable, VIEWER, *map(str, arguments)], timeout=60, text=True,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return done.returncode, done.stdout


class Running:
    """A viewer that runs."""

    def __init__(self, process, words):
        self.process = process
        self.words = words
        self.address = re.search(r"Open (\S+/)", words).group(1)
        self.port = urllib.parse.urlsplit(self.address).port

    def get(self, path, **fields):
        """Status, type and body of an answer."""
        query = "?" + urllib.parse.urlencode(fields, safe=",") if fields else ""
        try:
            with urllib.request.urlopen(self.address + path + query, timeout=60) as answer:
                return answer.status, answer.headers["Content-Type"], answer.read()
        except urllib.error.HTTPError as error:
            return error.code, error.headers["Content-Type"], error.read()

    def get_json(self, path, **fields):
        status, _, body = self.get(path, **fields)
        assert status == 200, body
        return json.loads(body)


@contextlib.contextmanager
def running_viewer(*arguments):
    """A Running viewer of the file that write_nrrd() makes, or of the arguments."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = arguments or (write_nrrd(pathlib.Path(folder) / "phantom.nrrd"),)
        process = subprocess.Popen([sys.executable, VIEWER, *map(str, arguments)], text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        try:
            words = ""
            while "Open " not in words:
                line = process.stdout.readline()
                assert line, "the viewer ended: " + words
                words += line
            yield Running(process, words)
            assert process.poll() is None, "the viewer ended"
        finally:
            process.terminate()
            rest = process.communicate(timeout=10)[0]
        assert rest == "", "the viewer complained: " + rest


class View:
    """A view of the phantom, as the viewer's help says that it is at the start."""

    def __init__(self, info, size):
        self.direction = numpy.array([0.0, 1.0, 0.0])
        self.up = numpy.array([0.0, 0.0, 1.0])
        self.focal_point = numpy.array(ORIGIN) + (numpy.array(SIZE) - 1) * SPACING / 2.0
        self.extent = 1.1 * max((numpy.array(SIZE) - 1) * SPACING)
        self.window, self.level = info["window"], info["level"]
        self.slab = (0.0, 0.0)  # thickness, how far behind the focal point
        self.mode = "exact"
        self.size = size

    def turn(self, axis, degrees):
        """The volume turns about an axis of the screen: x to the right, y up, z to the viewer."""
        x = numpy.cross(self.direction, self.up)
        axis = axis[0] * x + axis[1] * self.up - axis[2] * self.direction
        axis /= numpy.linalg.norm(axis)
        k = numpy.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        angle = math.radians(-degrees)  # the camera goes the other way
        matrix = numpy.eye(3) + math.sin(angle) * k + (1.0 - math.cos(angle)) * k @ k
        self.direction, self.up = matrix @ self.direction, matrix @ self.up

    def spacing(self):
        return self.extent / min(self.size)

    def fields(self, kind="png"):
        """Of a request."""
        def text(*numbers):
            return ",".join(repr(float(number)) for number in numbers)
        return {"direction": text(*self.direction), "up": text(*self.up), "focalPoint": text(*self.focal_point),
                "size": "%d,%d" % self.size, "spacing": text(self.spacing()), "window": text(self.window),
                "level": text(self.level), "thickness": text(self.slab[0]), "offset": text(self.slab[1]),
                "mode": self.mode, "kind": kind}

    def query(self):
        """The fields as the end of an address."""
        return urllib.parse.urlencode(self.fields(), safe=",")

    def pixel_of(self, point):
        """Column and row of a point of the world, from the picture's upper left, in pixels."""
        right = numpy.cross(self.direction, self.up)
        offset = (numpy.asarray(point) - self.focal_point) / self.spacing()
        return ((self.size[0] - 1) / 2.0 + offset @ right, (self.size[1] - 1) / 2.0 - offset @ self.up)

    def picture(self):
        """The filter's own, gray[row, column] from the top."""
        image = vtkImageData()
        image.SetDimensions(SIZE)
        image.SetSpacing(SPACING)
        image.SetOrigin(ORIGIN)
        image.GetPointData().SetScalars(numpy_to_vtk(make_values().ravel()))
        projection = vtkSplattingMIPProjection()
        projection.SetInputData(image)
        projection.SetBackgroundValue(-1e9)
        projection.SetViewDirection(self.direction)
        projection.SetViewUp(self.up)
        projection.CenterOnVolumeOff()
        projection.SetFocalPoint(self.focal_point)
        projection.SetOutputSize(self.size)
        projection.SetOutputSpacing(self.spacing(), self.spacing())
        getattr(projection, "SetQualityModeTo" + self.mode.capitalize())()
        if self.slab[0]:
            projection.SlabOn()
            projection.SetSlabThickness(self.slab[0])
            projection.SetSlabCenter(self.focal_point + self.slab[1] * self.direction)
        projection.Update()
        values = vtk_to_numpy(projection.GetOutput().GetPointData().GetScalars())
        gray = (values - self.level) / self.window * 255.0 + 127.5
        return numpy.clip(gray, 0.0, 255.0).reshape(self.size[::-1])[::-1]


def decode(body):
    """Gray[row, column] of a JPEG or PNG file, or with its colours, [row, column, colour]."""
    is_png = body.startswith(b"\x89PNG")
    with tempfile.NamedTemporaryFile(suffix=".png" if is_png else ".jpg") as file:
        file.write(body)
        file.flush()
        reader = vtkPNGReader() if is_png else vtkJPEGReader()
        reader.SetFileName(file.name)
        reader.Update()
        image = reader.GetOutput()
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    return values.reshape(image.GetDimensions()[1::-1] + values.shape[1:])[::-1].copy()
