# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Shared by the tests of the program splatmip: volumes in files, and how to run the program.

    python3 TestSplatmip....py PROGRAM [unittest's arguments]

Volumes are values[z, y, x] with places: columns of a 3 x 4 matrix are the steps from voxel to voxel
and the first voxel, in the patient's coordinates (LPS).
"""
import os
import subprocess
import sys
import tempfile
import unittest

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "Python"))
import volume_files  # noqa: E402

PROGRAM = ""
SMALL = ("--size", "96x96", "--mode", "preview")
PLACES = numpy.array([[1.5, 0, 0, 0], [0, 1, 0, 0], [0, 0, 2, 0.0]])
REFERENCES = {}  # projections of volumes: see assert_volume()
TYPES = {"int8": "CHAR", "uint8": "UCHAR", "int16": "SHORT", "uint16": "USHORT", "int32": "INT",
         "uint32": "UINT", "int64": "LONG_LONG", "uint64": "ULONG_LONG", "float32": "FLOAT",
         "float64": "DOUBLE"}  # NumPy's, and MetaImage's less MET_


def make_block():
    """Dark, with a bright block at the patient's left and the feet."""
    values = numpy.zeros((14, 12, 10), numpy.int16)
    values[1:5, 4:8, 6:9] = 1000
    return values


def write_file(path, data):
    with open(path, "wb") as file:
        file.write(data)
    return path


def read_file(path):
    with open(path, "rb") as file:
        return file.read()


def patch_file(path, changes):
    """Replace bytes at places in a file."""
    data = bytearray(read_file(path))
    for place, content in changes.items():
        content = bytes(memoryview(content).cast("B"))
        data[place:place + len(content)] = content
    return write_file(path, data)


def encode_meta(values, places=None, **fields):
    """A .mha file."""
    header = {"ObjectType": "Image", "NDims": values.ndim, "BinaryData": "True",
              "BinaryDataByteOrderMSB": "False", "DimSize": " ".join(map(str, values.shape[::-1]))}
    if places is not None:
        lengths = numpy.linalg.norm(places[:, :3], axis=0)
        header["TransformMatrix"] = " ".join(map(repr, (places[:, :3] / lengths).T.ravel().tolist()))
        header["Offset"] = " ".join(map(repr, places[:, 3].tolist()))
        header["ElementSpacing"] = " ".join(map(repr, lengths.tolist()))
    header.update({"ElementType": "MET_" + TYPES[values.dtype.name], **fields})
    header.setdefault("ElementDataFile", "LOCAL")
    text = "".join(f"{key} = {value}\n" for key, value in header.items() if value is not None)
    return text.encode() + values.astype(values.dtype.newbyteorder("<")).tobytes()


def write_meta(path, values=None, places=PLACES):
    return write_file(path, encode_meta(make_block() if values is None else values, places))


def make_image(values, spacing=(1.5, 1.0, 2.0)):
    """VTK's image, of one value or several in each voxel."""
    image = vtk.vtkImageData()
    image.SetDimensions(values.shape[2::-1])
    image.SetSpacing(spacing)
    scalars = numpy_to_vtk(values.reshape(-1, *values.shape[3:]), deep=True)
    scalars.SetName("values")
    image.GetPointData().SetScalars(scalars)
    return image


def write_with(writer, data, path):
    writer.SetInputData(data)
    writer.SetFileName(path)
    writer.Write()
    return path


def write_vti(path, values=None):
    """VTK's files do not say how the patient lies."""
    return write_with(
        vtk.vtkXMLImageDataWriter(), make_image(make_block() if values is None else values), path)


def read_picture(path):
    """Rows from the top, of pixels of three colours."""
    reader = vtk.vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(height, width, 3)[::-1].astype(float)


def read_values(path):
    """Rows from the bottom, and the matrix from columns and rows to the patient (LPS)."""
    place = numpy.eye(4)
    if path.endswith(".mha"):
        header, values = read_file(path).split(b"ElementDataFile = LOCAL\n")
        fields = dict(line.split(" = ") for line in header.decode().splitlines())
        size = [int(n) for n in fields["DimSize"].split()]
        place[:3, :3] = numpy.reshape(fields["TransformMatrix"].split(), (3, 3)).astype(float).T
        place[:3, :3] *= numpy.array(fields["ElementSpacing"].split(), float)
        place[:3, 3] = fields["Offset"].split()
        return numpy.frombuffer(values, numpy.float32).reshape(size[1], size[0]), place
    reader = vtk.vtkNIFTIImageReader()
    reader.SetFileName(path)
    reader.Update()
    form, image = reader.GetSFormMatrix(), reader.GetOutput()
    for row, column in numpy.ndindex(3, 4):
        sign = -1 if row < 2 else 1
        length = image.GetSpacing()[column] if column < 3 else 1
        place[row, column] = sign * length * form.GetElement(row, column)
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    return values.reshape(image.GetDimensions()[1::-1]), place


class SplatmipTest(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)

    def path(self, name):
        return os.path.join(self.scratch.name, name)

    def run_program(self, *arguments, has_display=False):
        environment = {k: v for k, v in os.environ.items() if has_display or k != "DISPLAY"}
        return subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.scratch.name,
                              capture_output=True, encoding="utf-8", errors="replace", timeout=300,
                              check=False, env=environment)

    def has_dicom(self):
        """Whether the program was built with vtk-dicom."""
        arguments = ("missing.vti", "--rotate", "2", "--output", "a.dcm")
        return "no vtk-dicom" not in self.run_program(*arguments).stderr

    def run_well(self, *arguments, **options):
        """Returns what the program prints."""
        result = self.run_program(*arguments, **options)
        self.assertEqual((result.returncode, result.stderr), (0, ""), (arguments, result.stdout))
        return result.stdout

    def draw(self, *arguments, **options):
        """The picture, whose absolute path must be printed, and the text."""
        text = self.run_well(*arguments, **options)
        word, path = text.splitlines()[-1].split(": ", 1)
        self.assertEqual((word, os.path.isabs(path)), ("picture", True), text)
        return read_picture(path), text

    def project(self, path, *arguments):
        """Values of a view from aslant, with their places, and the text."""
        text = self.run_well(path, "--output", self.path("v.mha"), "--mode", "high", "--size",
                             "60x50", "--azimuth", "25", "--elevation", "15", *arguments)
        return *read_values(self.path("v.mha")), text

    def assert_volume(self, path, values, places, *arguments, options=(), words=""):
        """The file has these values at these places, and the text has these words. The options are
        also those of the reference. The browser viewer finds the same, or refuses the file."""
        reference = encode_meta(values, places)
        key = reference, options
        if key not in REFERENCES:
            write_file(self.path("reference.mha"), reference)
            REFERENCES[key] = self.project(self.path("reference.mha"), *options)
        wanted, wanted_place, _ = REFERENCES[key]
        picture, place, text = self.project(path, *arguments, *options)
        self.assertIn(": " + " x ".join(map(str, values.shape[::-1])) + " voxels", text)
        self.assertIn(words, text)
        scale = numpy.nanmax(abs(numpy.where(numpy.isfinite(values), values, 0))) + 1e-9
        # single precision
        self.assertLess(abs(place - wanted_place).max(), 1e-5 * abs(wanted_place).max(), path)
        if not options:  # the middle of the picture is that of the volume, whatever the reference is
            middle = places @ [*((n - 1) / 2 for n in values.shape[::-1]), 1]
            self.assertLess(abs((place @ [29.5, 24.5, 0, 1])[:3] - middle).max(),
                            1e-4 * abs(wanted_place).max(), path)
        self.assertTrue((numpy.isnan(picture) == numpy.isnan(wanted)).all(), path)
        self.assertGreater(numpy.nanstd(wanted), 0.01 * scale)
        self.assertLess(numpy.nanmax(abs(picture - wanted)), 1e-5 * scale, path)
        if not arguments and not options and path.lower().endswith(tuple(volume_files.READERS)):
            self.assert_viewed(path, values, places)
        return text

    def assert_viewed(self, path, values, places):
        try:
            image = volume_files.read_volume(path).image
        except volume_files.VolumeError:
            return
        found = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
        last = numpy.array(values.shape[::-1]) - 1
        for index in (0 * last, last * (1, 0, 0), last * (0, 1, 0), last * (0, 0, 1), last // 3):
            place = [0.0, 0.0, 0.0]
            image.TransformPhysicalPointToContinuousIndex(places @ (*index, 1), place)
            place = numpy.subtract(place, image.GetExtent()[::2])
            x, y, z = (int(round(number)) for number in place)
            self.assertLess(abs(numpy.array(place) - (x, y, z)).max(), 1e-3, path)
            self.assertAlmostEqual(found[z, y, x], values[tuple(index[::-1])], 3, path)

    def assert_refused(self, *arguments, words="", code=1):
        """One sentence on stderr, nothing else, and the exit status."""
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, code, (arguments, result.stderr))
        self.assertEqual(result.stdout, "")
        self.assertRegex(result.stderr, r"\Asplatmip: [^\n]*\.\n\Z")
        self.assertIn(words, result.stderr)


def main():
    global PROGRAM
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
