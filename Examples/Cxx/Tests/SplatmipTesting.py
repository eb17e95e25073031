# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the program splatmip share: volumes in files, and how to run the program.

    python3 TestSplatmip....py PROGRAM [unittest's arguments]
"""
import gzip
import os
import re
import subprocess
import sys
import tempfile
import unittest

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

PROGRAM = ""
RUNS = {}       # what has been written, and by which arguments
LOOKS = set()   # of which something was looked at: see look_at()
SIZE = (10, 12, 14)
REFERENCES = {}  # projections of volumes: see assert_volume()


def make_image(x_of_left=1):
    """A dark image, coordinates as the patient's, with a bright block at the left and the feet."""
    image = vtk.vtkImageData()
    image.SetDimensions(*SIZE)
    image.SetSpacing(1.5, 1.0, 2.0)
    image.AllocateScalars(vtk.VTK_SHORT, 1)
    image.GetPointData().GetScalars().SetName("intensity")
    image.GetPointData().GetScalars().Fill(0)
    for k in range(1, 5):
        for j in range(4, 8):
            for i in range(1, 4):
                x = SIZE[0] - 1 - i if x_of_left else i
                image.SetScalarComponentFromDouble(x, j, k, 0, 1000)
    return image


def get_bytes(image):
    return bytes(memoryview(image.GetPointData().GetScalars()))


def write_with(writer, image, path):
    writer.SetInputData(image)
    writer.SetFileName(path)
    writer.Write()
    return path


def write_file(path, data):
    with open(path, "wb") as file:
        file.write(data)
    return path


def write_vti(path):
    return write_with(vtk.vtkXMLImageDataWriter(), make_image(), path)


def write_vtk(path):
    return write_with(vtk.vtkDataSetWriter(), make_image(), path)


def write_meta(path):
    """A .mha file, or a .mhd file with the voxels in a file of its own."""
    return write_with(vtk.vtkMetaImageWriter(), make_image(), path)


def write_nifti(path, image=None, has_form=True, **settings):
    """NIfTI counts x to the patient's right. The settings are those of VTK's writer."""
    writer = vtk.vtkNIFTIImageWriter()
    if has_form:
        writer.SetQFormMatrix(vtk.vtkMatrix4x4())
    for name, value in settings.items():
        getattr(writer, "Set" + name)(value)
    return write_with(writer, image or make_image(x_of_left=0), path)


def write_nrrd(path, encoding="raw", space="left-posterior-superior", x_of_left=1,
               directions="(1.5,0,0) (0,1,0) (0,0,2)", origin="(0,0,0)"):
    data = get_bytes(make_image(x_of_left))
    data = gzip.compress(data) if encoding == "gzip" else data
    header = f"""NRRD0004
type: short
dimension: 3
space: {space}
sizes: {SIZE[0]} {SIZE[1]} {SIZE[2]}
space directions: {directions}
space origin: {origin}
kinds: domain domain domain
endian: little
encoding: {encoding}
"""
    if path.endswith(".nhdr"):
        write_file(path + ".raw", data)
        return write_file(path, (header + f"data file: {os.path.basename(path)}.raw\n").encode())
    return write_file(path, header.encode() + b"\n" + data)


TYPES = {"int8": "CHAR", "uint8": "UCHAR", "int16": "SHORT", "uint16": "USHORT", "int32": "INT",
         "uint32": "UINT", "int64": "LONG_LONG", "uint64": "ULONG_LONG", "float32": "FLOAT",
         "float64": "DOUBLE"}  # NumPy's, and MetaImage's less MET_


def encode_meta(values, axes=None, **fields):
    """A .mha file of values[..., z, y, x]; columns of axes, 3 x 4, are steps and origin (LPS)."""
    header = {"ObjectType": "Image", "NDims": values.ndim, "BinaryData": "True",
              "BinaryDataByteOrderMSB": "False", "DimSize": " ".join(map(str, values.shape[::-1]))}
    if axes is not None:
        lengths = numpy.linalg.norm(axes[:, :3], axis=0)
        header["TransformMatrix"] = " ".join(map(repr, (axes[:, :3] / lengths).T.ravel().tolist()))
        header["Offset"] = " ".join(map(repr, axes[:, 3].tolist()))
        header["ElementSpacing"] = " ".join(map(repr, lengths.tolist()))
    header.update({"ElementType": "MET_" + TYPES[values.dtype.name], **fields})
    header.setdefault("ElementDataFile", "LOCAL")
    text = "".join(f"{key} = {value}\n" for key, value in header.items() if value is not None)
    return text.encode() + values.astype(values.dtype.newbyteorder("<")).tobytes()


def remember_run(folder, arguments):
    """Which file this run writes."""
    words = [*arguments, "splatmip.png"]
    names = [words[n + 1] for n, word in enumerate(words) if word in ("--output", "--out")]
    output = os.path.abspath(os.path.join(folder, (names or words[-1:])[0]))
    RUNS[output] = arguments


def find_kind(path):
    """How the name ends, or what of DICOM it is."""
    match = re.search(r"\.[a-z]+(?:\.gz)?$", path.lower())
    return ("folder" if os.path.isdir(path) else match.group() if match else
            os.path.basename(path))


def look_at(path):
    """Returns the path, and notes what has led to the file: options (with their words), kinds."""
    arguments = RUNS.get(os.path.abspath(re.sub(r"-\d{5}(?=\.png$)", "", path)))
    if arguments is not None:
        LOOKS.add("output " + find_kind(path))
        LOOKS.update(word for word in arguments if word.startswith("--"))
        LOOKS.update(f"{word} {(*arguments, '')[n + 1]}" for n, word in enumerate(arguments))
        LOOKS.update("input " + find_kind(word) for word in arguments[:1] if word[0] != "-")
    return path


def read_picture(reader, path):
    """Rows from the top, of pixels of three colours."""
    reader.SetFileName(look_at(path))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
    return pixels.reshape(height, width, 3)[::-1].astype(float)


def read_values(path):
    """Rows from the bottom, and the matrix from columns and rows to the patient (LPS)."""
    look_at(path)
    place = numpy.eye(4)
    if path.endswith(".mha"):
        with open(path, "rb") as file:
            data = file.read()
        header, values = data.split(b"ElementDataFile = LOCAL\n")
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
        remember_run(self.scratch.name, arguments)
        environment = {k: v for k, v in os.environ.items() if has_display or k != "DISPLAY"}
        return subprocess.run([PROGRAM, *arguments], cwd=self.scratch.name, capture_output=True,
                              text=True, errors="replace", timeout=300, check=False,
                              env=environment)

    def draw(self, *arguments, has_display=False):
        """Run the program and return the picture, which it must have announced, and the text."""
        result = self.run_program(*arguments, has_display=has_display)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        last = result.stdout.splitlines()[-1]
        self.assertTrue(last.startswith("picture: "), result.stdout)
        path = last[len("picture: "):]
        self.assertTrue(os.path.isabs(path))
        return read_picture(vtk.vtkPNGReader(), path), result.stdout

    def draw_block(self, path, *arguments):
        """Seen from the front, left is right and the feet are at the bottom. Returns the text."""
        pixels, text = self.draw(path, "--mode", "preview", "--size", "128x128", "--azimuth", "0",
                                 "--elevation", "0", "--no-marks", "--output", "a.png", *arguments)
        self.assertEqual(pixels.shape, (128, 128, 3))
        self.assertGreater(pixels[78:, 66:].max(), 200)
        self.assertLess(pixels[78:, :62].max(), 50)
        self.assertLess(pixels[12:62, 66:].max(), 50)
        return text

    def project(self, path, *arguments):
        """Values of a view from aslant, with their places (LPS), and the text."""
        result = self.run_program(path, "--output", self.path("v.mha"), "--mode", "high", "--size",
                                  "60x50", "--azimuth", "25", "--elevation", "15", *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""), (path, arguments))
        return *read_values(self.path("v.mha")), result.stdout

    def assert_volume(self, path, values, axes, *arguments, options=()):
        """The file has these values[z, y, x] at these places, 3 x 4 (LPS). The options are of both.
        Returns the text."""
        reference = encode_meta(values, axes)
        key = reference, options
        if key not in REFERENCES:
            write_file(self.path("reference.mha"), reference)
            REFERENCES[key] = self.project(self.path("reference.mha"), *options)
        wanted, wanted_place, _ = REFERENCES[key]
        picture, place, text = self.project(path, *arguments, *options)
        self.assertIn(": " + " x ".join(map(str, values.shape[::-1])) + " voxels", text)
        scale = numpy.nanmax(abs(numpy.where(numpy.isfinite(values), values, 0))) + 1e-9
        # single precision
        self.assertLess(abs(place - wanted_place).max(), 1e-5 * abs(wanted_place).max(), path)
        if not options:  # the middle of the picture is that of the volume, whatever the reference is
            middle = axes @ [*((n - 1) / 2 for n in values.shape[::-1]), 1]
            self.assertLess(abs((place @ [29.5, 24.5, 0, 1])[:3] - middle).max(),
                            1e-4 * abs(wanted_place).max(), path)
        self.assertTrue((numpy.isnan(picture) == numpy.isnan(wanted)).all(), path)
        self.assertGreater(numpy.nanstd(wanted), 0.01 * scale)
        self.assertLess(numpy.nanmax(abs(picture - wanted)), 1e-5 * scale, path)
        return text

    def assert_center(self, path, center):
        """The middle of the plane of values."""
        self.run_program(path, "--output", self.path("v.mha"), "--size", "64x64")
        _, matrix = read_values(self.path("v.mha"))
        self.assertLess(abs((matrix @ [31.5, 31.5, 0, 1])[:3] - center).max(), 1e-3, path)

    def assert_refused(self, *arguments, word="", code=1):
        """One sentence on stderr, nothing else, and the exit status."""
        result = self.run_program(*arguments)
        self.assertEqual(result.returncode, code, (arguments, result.stderr))
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("splatmip: "), result.stderr)
        self.assertTrue(result.stderr.endswith(".\n"), result.stderr)
        self.assertIn(word, result.stderr)


def main():
    """With --looks FILE what was looked at is noted, for TestSplatmipComplete.py."""
    global PROGRAM
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    notes = None
    if sys.argv[1:2] == ["--looks"]:
        notes = sys.argv[2]
        del sys.argv[1:3]
    program = unittest.main(exit=False)
    if notes:
        write_file(notes, "\n".join(sorted(LOOKS)).encode())
    sys.exit(not program.result.wasSuccessful())
