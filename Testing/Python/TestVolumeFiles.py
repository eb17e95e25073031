# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/volume_files.py: each kind of file gives the same volume at the same place."""
import bz2
import gzip
import pathlib
import re
import struct
import sys
import tempfile
import unittest
import zlib

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import VTK_BIT
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

import WebViewerTesting as testing

sys.path.insert(0, str(testing.EXAMPLES))
import volume_files  # noqa: E402

# Steps from voxel to voxel in columns, and the first voxel, in LPS: an oblique scan.
TURN = numpy.array([[0.6, -0.8, 0.0], [0.8, 0.6, 0.0], [0.0, 0.0, -1.0]])
AXES = TURN * (1.0, 0.5, 2.0)
ORIGIN = numpy.array([-20.0, 35.0, 7.0])
RAS = numpy.diag([-1.0, -1.0, 1.0])


def make_values(dtype="int16"):
    """Values[z, y, x], of which no two are the same in the first 100."""
    return numpy.arange(5 * 6 * 7).reshape(5, 6, 7).astype(dtype) - (0 if dtype[0] == "u" else 20)


def vectors(matrix):
    return " ".join("(%g,%g,%g)" % tuple(column) for column in matrix.T)


def nrrd(type_name="int16", dtype="<i2", encoding="raw", pack=bytes, **fields):
    lines = {"type": type_name, "dimension": 3, "sizes": "7 6 5", "endian": "big" if dtype[0] == ">" else "little",
             "encoding": encoding, "space": "left-posterior-superior", "space directions": vectors(AXES),
             "space origin": "(%g,%g,%g)" % tuple(ORIGIN)}
    lines.update({key.replace("_", " "): value for key, value in fields.items()})
    text = "NRRD0004\n# a comment: ignored\n" + "".join(f"{k}: {v}\n" for k, v in lines.items() if v is not None)
    return text.encode() + b"\n" + pack(make_values(dtype[1:]).astype(dtype).tobytes())


def meta(type_name="MET_SHORT", dtype="<i2", pack=bytes, **fields):
    lines = {"ObjectType": "Image", "NDims": 3, "BinaryData": "True", "BinaryDataByteOrderMSB": str(dtype[0] == ">"),
             "TransformMatrix": " ".join("%g" % x for x in TURN.T.ravel()), "Offset": "%g %g %g" % tuple(ORIGIN),
             "ElementSpacing": "1 0.5 2", "DimSize": "7 6 5", "ElementType": type_name}
    lines.update(fields)
    lines["ElementDataFile"] = fields.get("ElementDataFile", "LOCAL")
    text = "".join(f"{key} = {value}\n" for key, value in lines.items() if value is not None)
    return text.encode() + pack(make_values(dtype[1:]).astype(dtype).tobytes())


def nifti(order="<", slope=0.0, intercept=0.0, window=(0.0, 0.0), form="s", volumes=1, unit=2, code=4):
    header = bytearray(352)
    axes, origin = RAS @ AXES / (0.001 if unit == 3 else 1.0), RAS @ ORIGIN / (0.001 if unit == 3 else 1.0)
    struct.pack_into(order + "i", header, 0, 348)
    struct.pack_into(order + "8h", header, 40, 4 if volumes > 1 else 3, 7, 6, 5, volumes, 1, 1, 1)
    struct.pack_into(order + "2h", header, 70, code, 16)
    spacing = numpy.linalg.norm(axes, axis=0)
    struct.pack_into(order + "8f", header, 76, -1.0 if form == "q" else 1.0, *spacing, 1, 1, 1, 1)
    struct.pack_into(order + "3f", header, 108, 352.0, slope, intercept)
    header[123] = unit
    struct.pack_into(order + "2f", header, 124, window[1], window[0])
    struct.pack_into(order + "2h", header, 252, form == "q", form == "s")
    # Of the quaternion: a turn about z, after which the third axis is mirrored (qfac -1).
    half = numpy.arctan2((RAS @ TURN)[1, 0], (RAS @ TURN)[0, 0]) / 2.0
    struct.pack_into(order + "6f", header, 256, 0.0, 0.0, numpy.sin(half), *origin)
    for row in range(3 if form == "s" else 0):
        struct.pack_into(order + "4f", header, 280 + 16 * row, *axes[row], origin[row])
    header[344:348] = b"n+1\0"
    data = make_values().astype(order + "i2").tobytes()
    return bytes(header) + data + data[::-1] * (volumes - 1)


def vti():
    image = vtkImageData()
    image.SetDimensions(7, 6, 5)
    image.SetSpacing(1.0, 0.5, 2.0)
    image.SetOrigin(ORIGIN)
    image.SetDirectionMatrix(TURN.ravel())
    image.GetPointData().SetScalars(numpy_to_vtk(make_values().ravel()))
    image.GetPointData().GetScalars().SetName("values")
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    writer.WriteToOutputStringOn()
    writer.Write()
    return writer.GetOutputString().encode("latin-1")


class TestVolumeFiles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def read(self, name, data):
        path = self.folder / name
        path.write_bytes(data)
        return volume_files.read_volume(path)

    def check(self, volume, values=None, axes=AXES, origin=ORIGIN):
        """Each value lies where it should, however the reader orders voxels."""
        values = make_values() if values is None else values
        image = volume.image
        found = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
        self.assertEqual(sorted(found.ravel()), sorted(values.ravel()))
        point = [0.0, 0.0, 0.0]
        for x, y, z in ((0, 0, 0), (6, 0, 0), (0, 5, 0), (0, 0, 4), (3, 2, 1)):
            place = axes @ (x, y, z) + origin
            index = [0.0, 0.0, 0.0]
            image.TransformPhysicalPointToContinuousIndex(place, index)
            i, j, k = (round(number) for number in index)
            image.TransformContinuousIndexToPhysicalPoint((i, j, k), point)
            numpy.testing.assert_allclose(point, place, atol=1e-4)
            self.assertAlmostEqual(float(found[k, j, i]), float(values[z, y, x]), places=4)

    def refused(self, name, data, words="damaged, incomplete or not what its name says"):
        with self.assertRaises(volume_files.VolumeError) as caught:
            self.read(name, data)
        text = str(caught.exception)
        self.assertIn(name + ": ", text)
        self.assertIn(words, text)
        self.assertEqual(text.count("\n"), 0)
        self.assertTrue(text.endswith("."))

    def test_nrrd(self):
        for encoding, pack in (("raw", bytes), ("gzip", gzip.compress), ("bzip2", bz2.compress)):
            volume = self.read("a.nrrd", nrrd(encoding=encoding, pack=pack))
            self.check(volume)
            self.assertTrue(volume.is_oriented and volume.is_in_mm)
        self.check(self.read("a.nrrd", nrrd(dtype=">i2")))
        self.check(self.read("A.NRRD", nrrd()))
        for unit, length, is_in_mm in (('"mm" "mm" "mm"', 1.0, True), ('"um" "um" "um"', 0.001, True),
                                       ('"cm" "cm" "cm"', 10.0, True), ('"ell" "ell" "ell"', 1.0, False)):
            volume = self.read("a.nrrd", nrrd(space_units=unit))
            self.check(volume, axes=AXES * length, origin=ORIGIN * length)
            self.assertEqual(volume.is_in_mm, is_in_mm)
        for names, dtype in (("float", "<f4"), ("double", ">f8"), ("uchar", "<u1"), ("unsigned int", "<i4")):
            self.check(self.read("a.nrrd", nrrd(names, dtype)), make_values(dtype[1:]).astype("u4")
                       if "int" in names else make_values(dtype[1:]))

    def test_nrrd_of_other_spaces(self):
        for space, turn in (("right-anterior-superior", RAS), ("RAS", RAS),
                            ("left-anterior-superior", numpy.diag([1.0, -1.0, 1.0]))):
            origin = "(%g,%g,%g)" % tuple(turn @ ORIGIN)
            data = nrrd(space=space, space_directions=vectors(turn @ AXES), space_origin=origin)
            volume = self.read("a.nrrd", data)
            self.check(volume)
            self.assertTrue(volume.is_oriented)
        volume = self.read("a.nrrd", nrrd(space="scanner-xyz"))
        self.check(volume)
        self.assertEqual((volume.is_oriented, volume.is_in_mm), (False, True))
        volume = self.read("a.nrrd", nrrd(space=None, space_directions=None, space_origin=None, spacings="1 0.5 2"))
        self.check(volume, axes=numpy.diag([1.0, 0.5, 2.0]), origin=numpy.zeros(3))
        volume = self.read("a.nrrd", nrrd(space=None, space_directions=None, space_origin=None))
        self.check(volume, axes=numpy.eye(3), origin=numpy.zeros(3))
        self.assertIn("no voxel size", volume.note)

    def test_meta_image(self):
        for fields in ({}, {"dtype": ">i2"}, {"pack": zlib.compress, "CompressedData": "True"}):
            volume = self.read("a.mha", meta(**fields))
            self.check(volume)
            self.assertTrue(volume.is_oriented and volume.is_in_mm)
        volume = self.read("a.mha", meta(TransformMatrix=None, ElementSpacing=None))
        self.check(volume, axes=numpy.eye(3))
        self.assertFalse(volume.is_oriented or volume.is_in_mm)
        self.check(self.read("a.mha", meta("MET_FLOAT", "<f4")), make_values("f4"))
        volume = self.read("a.mha", meta(DistanceUnits="cm"))
        self.check(volume, axes=AXES * 10.0, origin=ORIGIN * 10.0)
        self.assertTrue(volume.is_in_mm)
        self.check(self.read("A.MHA", meta()))

    def test_nifti(self):
        for name, pack in (("a.nii", bytes), ("a.nii.gz", gzip.compress)):
            for form in "sq":
                for order in "<>":
                    with self.subTest(name, form=form, order=order):
                        volume = self.read(name, pack(nifti(order, form=form)))
                        self.check(volume)
                        self.assertTrue(volume.is_oriented and volume.is_in_mm)
                        self.assertIsNone(volume.window)
        self.check(self.read("a.nii", nifti(unit=3)))  # micrometres
        volume = self.read("a.nii", nifti(form=""))
        self.assertFalse(volume.is_oriented)
        self.assertIn("has no orientation", volume.note)
        volume = self.read("a.nii", nifti(volumes=3))
        self.check(volume)
        self.assertIn("the first of 3 volumes", volume.note)

    def test_nifti_in_the_files_unit(self):
        volume = self.read("a.nii", nifti(slope=0.5, intercept=-10.0, window=(-5.0, 40.0)))
        self.check(volume, 0.5 * make_values().astype(float) - 10.0)
        self.assertEqual(volume.window, (-5.0, 40.0))
        self.assertEqual(volume_files.choose_window(volume), (-5.0, 40.0))
        self.check(self.read("a.nii", nifti(slope=1.0, intercept=3.0)), make_values() + 3.0)
        self.check(self.read("a.nii", nifti(slope=numpy.nan)))
        self.check(self.read("a.nii", nifti(slope=1.0, intercept=numpy.inf)))

    def test_vti(self):
        volume = self.read("a.vti", vti())
        self.check(volume)
        self.assertFalse(volume.is_oriented or volume.is_in_mm)

    def test_cut_files(self):
        """However much of the end is missing."""
        for name, data in (("a.nrrd", nrrd()), ("b.nrrd", nrrd(encoding="gzip", pack=gzip.compress)),
                           ("a.mha", meta()), ("b.mha", meta(pack=zlib.compress, CompressedData="True")),
                           ("a.nii", nifti()), ("a.nii.gz", gzip.compress(nifti())), ("a.vti", vti())):
            for size in (len(data) - 30, len(data) // 2, 100, 10, 0):
                with self.subTest(name, size=size), self.assertRaises(volume_files.VolumeError):
                    self.read(name, data[:size])

    def test_what_is_refused(self):
        noise = numpy.random.default_rng(1).bytes(5000)
        for name in ("a.nrrd", "a.mha", "a.nii", "a.nii.gz", "a.vti"):
            with self.subTest(name), self.assertRaises(volume_files.VolumeError):
                self.read(name, noise)
        self.refused("a.nrrd", nrrd(sizes="7 6 500"))
        self.refused("a.nrrd", nrrd(sizes="7 6 0"))
        self.refused("a.nrrd", nrrd(sizes="7 6 -5"))
        self.refused("a.nrrd", nrrd(space_origin="(1,2)"))
        self.refused("a.nrrd", nrrd(space_directions=vectors(AXES * numpy.nan)))
        self.refused("a.nrrd", nrrd(space_origin="(1,nan,3)"))
        self.refused("a.nrrd", nrrd(space_directions=vectors(AXES * (1, 0, 1))))
        self.refused("a.nrrd", nrrd(space_directions="(1,0,0) (1,1,0) (0,0,1)"), "right angles")
        self.refused("a.nrrd", nrrd("block"), "'block' cannot be read")
        self.refused("a.nrrd", nrrd(encoding="hex"), "text")
        self.refused("a.nrrd", nrrd(dimension=4), "several values per voxel or times")
        self.refused("a.nrrd", nrrd(data_file="a.raw"), "in the same file")
        self.refused("a.mha", meta(ElementNumberOfChannels=3), "several values per voxel or times")
        self.refused("a.mha", meta(ElementDataFile="a.raw"), "in the same file")
        self.refused("a.mha", meta(BinaryData="False"), "text")
        self.refused("a.nii", nifti(code=128))
        self.refused("a.dcm", b"", ".nrrd, .nii, .nii.gz")

    def test_damaged_nifti_headers(self):
        """Of which some would end the program."""
        for place, number in ((40, 0), (40, 9), (40, -1), (42, 0), (44, -6), (46, 32767), (70, 999), (72, 0),
                              (72, -16)):
            data = bytearray(nifti())
            struct.pack_into("<h", data, place, number)
            with self.subTest(place=place, number=number):
                self.refused("a.nii", bytes(data))
                self.refused("a.nii.gz", gzip.compress(bytes(data)))

    def test_no_file(self):
        for path, words in ((self.folder / "none.nrrd", "there is no such file"), (self.folder, "cannot be read")):
            with self.assertRaisesRegex(volume_files.VolumeError, words):
                volume_files.read_volume(path)
        (self.folder / "a.nrrd").mkdir()
        with self.assertRaisesRegex(volume_files.VolumeError, "cannot be read"):
            volume_files.read_volume(self.folder / "a.nrrd")

    def test_window_of_the_values(self):
        values = numpy.zeros((20, 20, 20), "f4")
        values.ravel()[:] = numpy.random.default_rng(4).permutation(8000)
        values[0, 0, 0] = numpy.nan
        volume = volume_files.Volume(volume_files.make_image(values, numpy.eye(3), numpy.zeros(3)))
        low, high = volume_files.choose_window(volume)
        self.assertAlmostEqual(low, 4000, delta=2)
        self.assertAlmostEqual(high, 7996, delta=2)
        for fill, window in ((5.0, (4.5, 5.5)), (numpy.nan, None)):
            image = volume_files.make_image(numpy.full((2, 3, 4), fill), numpy.eye(3), numpy.zeros(3))
            if window:
                self.assertEqual(volume_files.choose_window(volume_files.Volume(image)), window)
            else:
                with self.assertRaisesRegex(volume_files.VolumeError, "no finite value"):
                    volume_files.choose_window(volume_files.Volume(image))

    def test_the_viewer_ends_with_one_sentence(self):
        bad = self.folder / "bad.nrrd"
        bad.write_bytes(nrrd()[:-2])
        for path in (bad, self.folder / "none.nii"):
            status, words = testing.run_to_end(path)
            self.assertEqual(status, 1)
            self.assertTrue(re.fullmatch(r"web_viewer.py: \S+: [^\n]+\.\n", words), words)

    def test_bits_are_refused_with_one_sentence(self):
        image = vtkImageData()
        image.SetDimensions(4, 5, 6)
        image.AllocateScalars(VTK_BIT, 1)
        writer = vtkXMLImageDataWriter()
        writer.SetInputData(image)
        writer.SetFileName(str(self.folder / "bits.vti"))
        writer.Write()
        status, words = testing.run_to_end(self.folder / "bits.vti")
        self.assertEqual(status, 1)
        self.assertTrue(re.fullmatch(r"web_viewer.py: \S+: its values are bits; [^\n]+\.\n", words), words)


if __name__ == "__main__":
    unittest.main()
