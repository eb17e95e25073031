# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""NIfTI, NRRD, MetaImage and VTK's files: values and places are those that other libraries find."""
import bz2
import gzip
import os
import unittest
import zlib

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk

import SplatmipTesting as splatmip

try:
    import nibabel
except ImportError:
    nibabel = None
try:
    import SimpleITK
except ImportError:
    SimpleITK = None

SIZE = (30, 20, 6)  # z, y, x
PLACES = numpy.array([[1.5, 0, 0, 1], [0, 1.2, 0, 2], [0, 0, 2.5, 3.0]])
DAMAGED = "damaged, incomplete or not what its name says"


def make_values(dtype=numpy.int16, seed=0):
    return numpy.random.default_rng(seed).integers(0, 1000, SIZE).astype(dtype)


def make_stack(count, dtype=numpy.int16):
    return numpy.stack([make_values(dtype, seed) for seed in range(count)])


def turn(degrees):
    c, s = numpy.cos(numpy.radians(degrees)), numpy.sin(numpy.radians(degrees))
    return numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, c, -s], [0, s, c]]


def shift(places, *steps):
    """Places whose first voxel is so many steps away."""
    return numpy.column_stack((places[:, :3], places @ (*steps, 1)))


class FormatTest(splatmip.SplatmipTest):
    def judge_by_itk(self, path, values, places):
        if not SimpleITK:
            return
        image = SimpleITK.ReadImage(path)
        if image.GetDimension() == 3 and image.GetNumberOfComponentsPerPixel() == 1:
            self.assertTrue((SimpleITK.GetArrayFromImage(image) == values).all())
            steps = numpy.reshape(image.GetDirection(), (3, 3)) * image.GetSpacing()
            found = numpy.column_stack((steps, image.GetOrigin()))
            self.assertLess(abs(found - places).max(), 1e-9)


@unittest.skipUnless(nibabel, "skipped: no nibabel")
class TestNIfTI(FormatTest):
    OBLIQUE = numpy.vstack((numpy.column_stack((turn(30) * (1.5, 1.2, 2.5), [10, -20, 30])),
                            [0, 0, 0, 1]))
    OTHER = numpy.diag([-1.5, -1.2, 2.5, 1])

    def write(self, name="a.nii", values=None, sform=None, qform=None, kind=None, patches=None, **fields):
        """Values[..., z, y, x]; the patches are bytes by their places in the header."""
        values = make_values() if values is None else values
        image = (kind or nibabel.Nifti1Image)(values.T, None)
        image.header.set_zooms((1.5, 1.2, 2.5) + (1,) * (values.ndim - 3))
        if kind is not nibabel.AnalyzeImage:
            image.set_sform(sform, code=0 if sform is None else 1)
            image.set_qform(qform, code=0 if qform is None else 1)
        for key, value in fields.items():
            image.header[key] = value
        nibabel.save(image, self.path(name))
        return splatmip.patch_file(self.path(name), patches) if patches else self.path(name)

    def judge(self, path, *arguments, frame=0, affine=None, unit=1.0, words=""):
        """By nibabel, which counts to the right and the front."""
        image = nibabel.load(path)
        values = numpy.asarray(image.dataobj)
        values = values.reshape(*values.shape[:3], -1, order="F")[..., frame].T
        places = unit * numpy.diag([-1, -1, 1]) @ (image.affine if affine is None else affine)[:3]
        return self.assert_volume(path, values, places, *arguments, words=words)

    def test_forms(self):
        """The sform as it stands, whatever pixdim is; the qform if the sform is empty."""
        oblique, other, straight = self.OBLIQUE, self.OTHER, numpy.diag([1.5, 1.2, 2.5, 1])
        sheared = oblique.copy()
        sheared[0, 1] += 0.7
        for fields in ({"sform": oblique}, {"qform": oblique, "name": "A.NII.GZ"},
                       {"sform": oblique, "qform": other}, {"sform": sheared}, {"sform": 2 * oblique},
                       {"sform": oblique, "kind": nibabel.Nifti2Image},
                       {"sform": oblique, "kind": nibabel.Nifti1Pair, "name": "a.hdr"},
                       {"sform": oblique, "kind": nibabel.Nifti1Pair, "name": "a.img"},
                       {"sform": oblique, "kind": nibabel.Nifti1Pair, "name": "b.hdr.gz"},
                       {"sform": oblique, "kind": nibabel.Nifti1Pair, "name": "b.img.gz"}):
            self.judge(self.write(**fields))
        pixdim, srow = {80: numpy.float32([-1.5])}, {280: bytes(48)}
        self.judge(self.write(sform=straight, patches=pixdim), affine=straight)
        text = self.judge(self.write(sform=oblique, qform=other, patches=srow), affine=other)
        self.assertNotIn("exchanged", text)

    def test_no_form(self):
        """Pictures show what is unknown, each on a line of its own."""
        unknown = "left and right may be exchanged"
        for name in ("a.hdr", "a.img"):
            path = self.write(name, kind=nibabel.AnalyzeImage)
            self.assert_volume(path, make_values(), numpy.diag([-1.5, -1.2, 2.5, 1])[:3], words=unknown)
        lines = []
        for patches in ({}, {80: numpy.float32([1e12] * 3)}, {80: numpy.float32([0, 1, 1])}):
            picture, text = self.draw(self.write(patches=patches), "--output", "a.png")
            self.assertIn(unknown, text)
            lines.append((picture[:200, :200] == 255).all(axis=2).any(axis=1).sum())
        self.assertIn("has no voxel size: 1 mm is assumed", text)
        self.assertGreater(min(lines[1:]), 1.2 * lines[0])

    def test_types(self):
        form = numpy.eye(4)
        for dtype in (numpy.uint8, numpy.uint16, numpy.int32, numpy.float32, numpy.float64):
            self.judge(self.write(values=make_values(dtype), sform=form))
        self.judge(self.write(sform=form, patches={112: numpy.float32([0.5, -100])}))  # slope
        self.judge(self.write(sform=form, patches={112: numpy.float32([numpy.nan, 0])}), words="voxels, short\n")
        path = self.write(sform=form, patches={70: numpy.int16([1536, 128])})
        self.assert_refused(path, words="FLOAT128 (datatype 1536) are not supported; save")

    def test_components(self):
        """Complex numbers and colours have several values."""
        values = (make_values(numpy.float32) + 1j * make_values(numpy.float32, 1)).astype("complex64")
        path, places = self.write(values=values, sform=self.OTHER), numpy.diag([1.5, 1.2, 2.5, 1])[:3]
        self.assert_volume(path, values.real, places)
        self.assert_volume(path, values.imag, places, "--component", "2")
        self.assert_volume(path, abs(values), places, "--component", "magnitude")
        colors = numpy.zeros(SIZE, [("R", "u1"), ("G", "u1"), ("B", "u1")])
        for n, name in enumerate("RGB"):
            colors[name] = make_values(seed=n) % 256
        path = self.write(values=colors, sform=self.OTHER)
        self.assert_volume(path, colors["B"], places, "--component", "3")
        luminance = 0.299 * colors["R"] + 0.587 * colors["G"] + 0.114 * colors["B"]
        self.assert_volume(path, luminance, places, "--component", "luminance", words="luminance of 3 comp")
        self.assert_refused(path, "--component", "4", words="no component 4 here, only 3")
        self.assert_refused(path, "--component", "hue", words="luminance or magnitude", code=2)
        self.assert_refused(self.write(), "--component", "luminance", words="voxels have 1 value;")

    def test_frames(self):
        stack, form = make_stack(6), numpy.eye(4)
        path = self.write("a.nii.gz", stack, form)
        self.judge(path, words="volume 1 of 6 (--frame")
        self.judge(path, "--frame", "5", frame=4)
        self.assert_refused(path, "--frame", "7", words="no volume 7 here, only 6")
        path = self.write(values=stack.reshape(3, 2, *SIZE), sform=form)
        self.judge(path, "--frame", "6", frame=5)

    def test_units(self):
        """A slab is as thick as is said, in mm, whatever the file counts in."""
        for code, unit, length in ((1, "m", 1000), (3, "um", 0.001)):
            path = self.write(sform=self.OTHER, xyzt_units=code)
            self.judge(path, unit=length, words=f"unit of length is {unit}; lengths here are in mm\n")
            self.assert_volume(path, make_values(), length * numpy.diag([1.5, 1.2, 2.5, 1])[:3],
                               options=("--slab", 9 * length, "--slab-offset", 4 * length))

    def test_window(self):
        """The file's, in its values, unless the user gives one."""
        patches = {112: numpy.float32([2, 0]), 124: numpy.float32([250, -50])}
        for words, window, level in (((), 300, 100), (("--window", "7"), 7, 100), (("--level", "9"), 300, 9)):
            self.judge(self.write(sform=self.OTHER, patches=patches), *words,
                       words=f"shown with window {window}, level {level}\n")

    def test_damaged(self):
        self.assert_refused(self.write(kind=nibabel.Nifti2Image, patches={16: numpy.int64([9])}), words=DAMAGED)
        self.write("b.hdr", kind=nibabel.Nifti1Pair)
        self.write("b.nii")
        for change in (lambda name: os.truncate(name, 1000), os.remove):
            change(self.path("b.img"))
            self.assert_refused(self.path("b.hdr"), words=DAMAGED)

    def test_real_files(self):
        """Test data of nibabel, where its package has them."""
        folder = os.path.join(os.path.dirname(nibabel.__file__), "tests", "data")
        found = 0
        for name, arguments, frame in (("example4d.nii.gz", ("--frame", "2"), 1),
                                       ("example_nifti2.nii.gz", (), 0), ("anatomical.nii", (), 0),
                                       ("functional.nii", (), 0), ("minc2_4d.nii", (), 0)):
            if os.path.exists(os.path.join(folder, name)):
                self.judge(os.path.join(folder, name), *arguments, frame=frame)
                found += 1
        if not found:
            self.skipTest("skipped: no test data of nibabel")


class TestNRRD(FormatTest):
    DIRECTIONS = "(1.5,0,0) (0,1.2,0) (0,0,2.5)"
    FIELDS = {"type": "short", "dimension": "3", "space": "left-posterior-superior",
              "sizes": "6 20 30", "space directions": DIRECTIONS,
              "space origin": "(1,2,3)", "endian": "little", "encoding": "raw"}

    def write(self, data=None, lines=(), name="a.nrrd", **fields):
        """Fields by their names with _ for blanks; None leaves one out. Lines come as they are."""
        header = {**self.FIELDS, **{key.replace("_", " "): value for key, value in fields.items()}}
        text = "".join(f"{key}: {value}\n" for key, value in header.items() if value is not None)
        text = "NRRD0004\n" + text + "".join(line + "\n" for line in lines) + "\n"
        data = make_values().tobytes() if data is None else data
        return splatmip.write_file(self.path(name), text.encode() + data)

    def check(self, path, *arguments, values=None, places=PLACES, words="", by_itk=True):
        values = make_values() if values is None else values
        if by_itk and not arguments:
            self.judge_by_itk(path, values, places)
        return self.assert_volume(path, values, places, *arguments, words=words)

    def test_data(self):
        values = make_values()
        data = values.tobytes()
        text = " ".join(map(str, values.ravel())).encode()
        for content, lines, fields in (
                (data, (), {}), (text, (), {"encoding": "ascii", "endian": None}),
                (data.hex().encode(), (), {"encoding": "hex"}),
                (gzip.compress(data), (), {"encoding": "gzip"}),
                (values.astype(">i2").tobytes(), (), {"endian": "big"}),
                (b"one\ntwo\n" + data, ["line skip: 2"], {}),
                (b"1234567" + data, ["byte skip: 7"], {}), (b"1234567" + data, ["byte skip: -1"], {})):
            self.check(self.write(content, lines, **fields), words=": 6 x 20 x 30 voxels, short\n")
        path = self.write(bz2.compress(data), encoding="bzip2")
        self.assert_refused(path, words="bzip2 encoding not available in NrrdIO); save the volume with gzip")

    def test_file_of_data(self):
        """A header and its data are two files, neither of which may be replaced."""
        splatmip.write_file(self.path("data.nii"), make_values().tobytes())
        path = self.write(b"", ["# described at:", "data file: data.nii"], name="a.nhdr")
        self.check(path)
        self.assert_refused(path, "--output", "data.nii", words="one of the files to read")
        self.assertEqual(splatmip.read_file(self.path("data.nii")), make_values().tobytes())
        for change in (lambda name: os.truncate(name, 999), os.remove):
            change(self.path("data.nii"))
            self.assert_refused(path, words=DAMAGED)

    def test_bad_lines(self):
        """The error names the line."""
        for fields, lines, words in (
                ({"sizes": None}, ["sizes:6 20 30"], 'in "sizes:6 20 30": didn\'t see ": "'),
                ({"sizes": None}, ["sizes:\t6\t20\t30"], "sizes:"), ({"sizes": None}, [], DAMAGED),
                ({"sizes": None}, ["sizes: 6 20\0 30"], DAMAGED),
                ({"sizes": "100000 100000 100000"}, [], "more voxels than this machine has bytes"),
                ({"type": None}, ["type:float"], 'in "type:float"'),
                ({"endian": None}, ["endian:big"], 'in "endian:big"'),
                ({"dimension": None}, ["dimension: 3"], "6 20 30|: don't yet have a valid dim"),
                ({"type": None}, [], "required field: type"), ({"type": "block"}, [], "type is block"),
                ({"encoding": None}, [], "required field: encoding"),
                ({}, [9999 * "1 "], "a line of its header is too long")):
            self.assert_refused(self.write(None, lines, **fields), words=words)
        for ending in ("", " %s%s%s 1 9 0"):
            path = self.write(b"", ["data file: a" + ending], name="a.nhdr")
            self.assert_refused(path, words=DAMAGED)

    def test_spaces(self):
        oblique = numpy.hstack((turn(20) * [1.5, 1.2, 2.5], [[4], [5], [6]]))
        directions = " ".join(f"({x!r},{y!r},{z!r})" for x, y, z in oblique[:, :3].T.tolist())
        for space, signs in {"left-posterior-superior": (1, 1, 1), "LPS": (1, 1, 1),
                             "right-anterior-superior": (-1, -1, 1), "ras": (-1, -1, 1),
                             "left-anterior-superior": (1, -1, 1), "LAS": (1, -1, 1)}.items():
            path = self.write(space=space, space_directions=directions, space_origin="(4,5,6)")
            self.check(path, places=numpy.diag(signs) @ oblique, by_itk=space[:2] not in ("le", "LA")
                       or "posterior" in space)  # ITK turns x of LAS

    def test_frames(self):
        """A fourth axis, of time or a list, wherever it is; vectors are components."""
        stack = make_stack(3)
        first = numpy.moveaxis(stack, 0, 3)
        length = numpy.sqrt((stack.astype(float) ** 2).sum(axis=0))
        at_end = {"data": stack.tobytes(), "dimension": 4, "sizes": "6 20 30 3",
                  "space_directions": self.DIRECTIONS + " none"}
        at_start = {"data": first.tobytes(), "dimension": 4, "sizes": "3 6 20 30",
                    "space_directions": "none " + self.DIRECTIONS}
        times = {"space": "RAST", "space_origin": "(-1,-2,3,0)",
                 "space_directions": "(-1.5,0,0,0) (0,-1.2,0,0) (0,0,2.5,0) (0,0,0,1)"}
        for fields, words, values in (
                ({**at_end, "kinds": "domain domain domain list"}, (), stack[0]),
                ({**at_end, "kinds": "domain domain domain list"}, ("--frame", "3"), stack[2]),
                ({**at_start, "kinds": "list domain domain domain"}, ("--frame", "2"), stack[1]),
                ({**at_start, "kinds": "vector domain domain domain"}, ("--component", "2"), stack[1]),
                ({**at_start, "kinds": "vector domain domain domain"}, ("--component", "magnitude"), length),
                ({**at_end, **times}, ("--frame", "2"), stack[1])):
            self.check(self.write(**fields), *words, values=values)
        self.assert_refused(self.write(**at_end, kinds="domain domain domain list"), "--frame", "4", words="no volume 4 here, only 3")

    def test_units(self):
        for unit, length, words in (("um", 1e-3, "is um"), ("cm", 10, "is cm"), ("\u00b5m", 1e-3, "is um"),
                                    ("\x1bell", 1, "is ?ell, which is unknown: 1 mm is assumed")):
            path = self.write(space_units=f'"{unit}" "{unit}" "{unit}"')
            self.check(path, places=PLACES * length, words="unit of length " + words, by_itk=False)
            self.assert_volume(path, make_values(), PLACES * length, options=("--slab", 10 * length))

    def test_no_size(self):
        """Without a vector for each axis nothing is known."""
        first, _, last = self.DIRECTIONS.split()
        places = numpy.column_stack((numpy.eye(3), PLACES[:, 3]))
        for words in ("none none none", f"{first} none {last}", f"{first} (nan,nan,nan) {last}"):
            self.assert_volume(self.write(space_directions=words), make_values(), places,
                               words="the file has no voxel size: 1 mm is assumed\n")
        pictures = [self.draw(self.path("a.nrrd"), "--output", "a.png", *words)[0]
                    for words in ((), ("--no-marks",))]
        self.assertTrue((pictures[0] == pictures[1]).all())

    def test_incomplete(self):
        data = make_values().tobytes()
        self.assert_refused(self.write(data[:-100]), words="fread got only 3550")
        self.assert_refused(self.write(gzip.compress(data)[:-400], encoding="gzip"), words=DAMAGED)


class TestMetaImage(FormatTest):
    def write(self, values=None, places=PLACES, data=None, name="a.mha", **fields):
        content = splatmip.encode_meta(make_values() if values is None else values, places, **fields)
        if data is not None:
            content = content[:content.index(b"LOCAL\n") + 6] + data
        return splatmip.write_file(self.path(name), content)

    def check(self, path, places, *arguments, values=None):
        values = make_values() if values is None else values
        if not arguments:
            self.judge_by_itk(path, values, places)
        return self.assert_volume(path, values, places, *arguments)

    def test_geometry(self):
        turned = numpy.column_stack((turn(25) * [1.5, 1.2, 2.5], [4, 5, 6]))
        words = " ".join(map(repr, turn(25).T.ravel().tolist()))
        for key in ("TransformMatrix", "Orientation", "Rotation"):
            for place in ("Offset", "Position", "Origin"):
                self.check(self.write(places=None, ElementSpacing="1.5 1.2 2.5",
                                      **{key: words, place: "4 5 6"}), turned)
        both = numpy.column_stack((PLACES[:, :3], [7, 8, 9]))
        for fields, places in (({"ElementSpacing": None, "ElementSize": "1.5 1.2 2.5"}, PLACES),
                               ({"ElementSize": "9 9 9"}, PLACES), ({"Origin": "7 8 9"}, both),
                               ({"ElementSpacing": "1.5 1.2 -2.5"}, PLACES * [1, 1, -1, 1])):
            self.check(self.write(**fields), places)

    def test_frames(self):
        stack = make_stack(3)
        path = self.write(stack, places=None, ElementSpacing="1.5 1.2 2.5 1", Offset="1 2 3 0",
                          TransformMatrix="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1")
        self.check(path, PLACES, "--frame", "3", values=stack[2])

    def test_units(self):
        self.assert_volume(self.write(DistanceUnits="um"), make_values(), PLACES * 1e-3,
                           words="unit of length is um")

    def test_data(self):
        values = make_values()
        packed = zlib.compress(values.tobytes())
        text = " ".join(map(str, values.ravel())).encode() + b"\n"
        big = values.astype(">i2").view(numpy.int16)
        splatmip.write_file(self.path("a.raw"), values.tobytes())
        for fields in ({"data": packed, "CompressedData": "True", "CompressedDataSize": len(packed)},
                       {"values": big, "BinaryDataByteOrderMSB": "True"},
                       {"data": text, "BinaryData": "False"}):
            self.check(self.write(**fields), PLACES)
        self.check(self.write(name="a.mhd", ElementDataFile="a.raw"), PLACES)
        os.remove(self.path("a.raw"))
        self.assert_refused(self.path("a.mhd"), words=DAMAGED)
        for fields in ({"data": values.tobytes()[:-100]}, {"DimSize": "6 20 0"}, {"NDims": "99999"},
                       {"data": packed[:-200], "CompressedData": "True", "CompressedDataSize": len(packed)}):
            self.assert_refused(self.write(**fields), words=DAMAGED)
        self.assert_refused(self.write(ElementType=None), words="(ElementType required and not defined)")


class TestVTK(FormatTest):
    def make_image(self, arrays, spacing=(1.5, 1.2, 2.5), extent=(0, 0, 0), of_cells=False):
        """Arrays by name, of the points or of the cells."""
        image = vtk.vtkImageData()
        image.SetExtent(*(first + n for length, first in zip(SIZE[::-1], extent)
                          for n in (0, length - 1 + of_cells)))
        image.SetSpacing(*spacing)
        image.SetOrigin(1, 2, 3)
        self.add(image.GetCellData() if of_cells else image.GetPointData(), **arrays)
        return image

    def make_grid(self, values, *coordinates):
        grid = vtk.vtkRectilinearGrid()
        grid.SetDimensions(*(len(places) for places in coordinates))
        for axis, places in zip("XYZ", coordinates):
            getattr(grid, f"Set{axis}Coordinates")(numpy_to_vtk(numpy.array(places, float), deep=True))
        self.add(grid.GetPointData(), a=values)
        return grid

    def add(self, attributes, **arrays):
        for name, values in arrays.items():
            array = numpy_to_vtk(values.reshape(-1, *values.shape[3:]).copy(), deep=True)
            array.SetName(name)
            attributes.AddArray(array)

    def write(self, data, name="a.vti"):
        writers = {"vti": vtk.vtkXMLImageDataWriter, "vtr": vtk.vtkXMLRectilinearGridWriter,
                   "vtk": vtk.vtkDataSetWriter}
        return splatmip.write_with(writers[name[-3:]](), data, self.path(name))

    def test_places(self):
        """Numbers of voxels need not begin at 0, and may fall; a cell's value is in its middle."""
        falling = PLACES * [1, 1, -1, 1]
        turned = numpy.column_stack((turn(25) * [1.5, 1.2, 2.5], [1, 2, 3]))
        for name in ("a.vti", "a.vtk"):
            for places, fields in ((falling, {"spacing": (1.5, 1.2, -2.5)}),
                                   (shift(PLACES, 4, -5, 6), {"extent": (4, -5, 6)}),
                                   (shift(PLACES, 0.5, 0.5, 0.5), {"of_cells": True})):
                if name == "a.vti" or "extent" not in fields:  # legacy files have none
                    image = self.make_image({"a": make_values()}, **fields)
                    self.assert_volume(self.write(image, name), make_values(), places)
        image = self.make_image({"a": make_values()})
        image.SetDirectionMatrix(turn(25).ravel())
        self.assert_volume(self.write(image), make_values(), turned)

    def test_arrays(self):
        for name, first, printed in (("a.vti", "first", "first"), ("a.vtk", "\x1b\x9b[fir\u00e4st", "??[fir\u00e4st")):
            path = self.write(self.make_image({first: make_values(), "second": make_values(seed=1)}), name)
            self.assert_volume(path, make_values(), PLACES,
                               words=f"array {printed} (--array chooses {printed} or second)")
            self.assert_volume(path, make_values(seed=1), PLACES, "--array", "second")
            self.assert_refused(path, "--array", "third", words=f"no array third here, only {printed} or s")

    def test_grids(self):
        """Even rectilinear grids are images; others are interpolated, which is exact if linear."""
        places = [1 + 1.5 * numpy.arange(6), 2 + 1.2 * numpy.arange(20), 3 + 2.5 * numpy.arange(30)]
        ramp = (7 * numpy.arange(30)[:, None, None] + make_values()[:1]).astype(numpy.int16)
        keep = numpy.array([k for k in range(30) if k not in (4, 9, 10, 20)])
        for name in ("a.vtr", "a.vtk"):
            self.assert_volume(self.write(self.make_grid(make_values(), *places), name), make_values(), PLACES)
            grid = self.make_grid(ramp[keep], *places[:2], places[2][keep])
            self.assert_volume(self.write(grid, name), ramp.astype(numpy.float32), PLACES,
                               words="uneven and was interpolated to even steps")
        for z, words in ((numpy.r_[places[2][:29], 0], "neither rise nor fall"),
                         (numpy.r_[3, 3.01, places[2][2:]], "too uneven to interpolate")):
            self.assert_refused(self.write(self.make_grid(make_values(), *places[:2], z), name), words=words)

    def test_hidden(self):
        """What ghost arrays hide remains hidden in images and grids, of points and cells."""
        hidden = numpy.random.default_rng(5).random(SIZE) < 0.1
        wanted = numpy.where(hidden, numpy.nan, make_values()).astype(numpy.float32)
        points = numpy.where(hidden, vtk.vtkDataSetAttributes.HIDDENPOINT, 0).astype(numpy.uint8)
        cells = numpy.where(hidden, vtk.vtkDataSetAttributes.HIDDENCELL, 0).astype(numpy.uint8)
        places = [1 + 1.5 * numpy.arange(6), 2 + 1.2 * numpy.arange(20), 3 + 2.5 * numpy.arange(30)]
        grid = self.make_grid(make_values(), *places)
        self.add(grid.GetPointData(), vtkGhostType=points)
        several = self.make_image({"a": numpy.stack(2 * [make_values()], 3), "vtkGhostType": points})
        half = shift(PLACES, 0.5, 0.5, 0.5)
        for data, name, where, options in (
                (self.make_image({"a": make_values(), "vtkGhostType": points}), "a.vti", PLACES, ()),
                (self.make_image({"a": make_values(), "vtkGhostType": cells}, of_cells=True), "b.vti", half, ()),
                (several, "c.vti", PLACES, ("--component", "2")), (grid, "a.vtr", PLACES, ())):
            self.assert_volume(self.write(data, name), wanted, where, *options)
        points[:] = 0
        points[12] = vtk.vtkDataSetAttributes.HIDDENPOINT
        keep = numpy.array([k for k in range(30) if k != 20])
        grid = self.make_grid(make_values()[keep], *places[:2], places[2][keep])
        self.add(grid.GetPointData(), vtkGhostType=points[keep])
        wanted = make_values().astype(float)
        wanted[20] = (wanted[19] + wanted[21]) / 2
        wanted[12] = numpy.nan
        self.assert_volume(self.write(grid, "a.vtr"), wanted.astype(numpy.float32), PLACES)

    def test_components(self):
        colors = numpy.moveaxis(make_stack(3, numpy.uint8), 0, 3)
        path = self.write(self.make_image({"a": colors}))
        self.assert_volume(path, colors[..., 1], PLACES, "--component", "2", words="component 2 of 3 (--comp")
        length = numpy.sqrt((colors.astype(float) ** 2).sum(axis=3))
        self.assert_volume(path, length, PLACES, "--component", "magnitude")

    def test_no_numbers(self):
        """Of NaN alone there is no picture; a few numbers among a million are found."""
        values = numpy.full((160, 160, 160), numpy.nan, numpy.float32)
        path = splatmip.write_vti(self.path("a.vti"), values)
        self.assert_refused(path, "--rotate", "2", "--out", "turn.png", words="no finite value")
        self.assertEqual(os.listdir(self.scratch.name), ["a.vti"])
        values.flat[values.size // 2 + 1] = 7
        text = self.run_well(splatmip.write_vti(path, values), *splatmip.SMALL)
        self.assertIn("level 7\n", text)


class TestRefusals(splatmip.SplatmipTest):
    def write_all(self):
        files = [splatmip.write_vti(self.path("a.vti")), splatmip.write_meta(self.path("a.mha")),
                 splatmip.write_with(vtk.vtkDataSetWriter(), splatmip.make_image(splatmip.make_block()),
                                     self.path("a.vtk"))]
        for name in ("a.nii", "a.nii.gz"):
            self.run_well("--output", self.path(name), *splatmip.SMALL)
            files.append(self.path(name))
        return files

    def test_content(self):
        """Files of other content, and those that are cut off anywhere."""
        for path in self.write_all():
            data = splatmip.read_file(path)
            for part in (0.1, 0.5, 0.9):
                self.assert_refused(splatmip.write_file(path, data[:int(part * len(data))]), words=DAMAGED)
            self.assert_refused(splatmip.write_file(path, b"Not a volume.\n" * 99))
        sphere = vtk.vtkSphereSource()
        sphere.Update()
        image = vtk.vtkImageData()
        image.SetDimensions(4, 5, 6)
        for writer, data, name, words in ((vtk.vtkDataSetWriter(), sphere.GetOutput(), "a.vtk", "no image"),
                                          (vtk.vtkXMLImageDataWriter(), image, "a.vti", "no numeric value")):
            self.assert_refused(splatmip.write_with(writer, data, self.path(name)), words=words)

    def test_paths(self):
        os.makedirs(self.path("folder"))
        for name in ("empty.nrrd", "text.txt"):
            splatmip.write_file(self.path(name), b"Not a volume." if name == "text.txt" else b"")
        for name, words in (("missing.vti", "no such file"), ("missing", "no such file"), ("folder", "DICOM"),
                            ("empty.nrrd", "the file is empty"), ("text.txt", "unknown kind of file")):
            self.assert_refused(name, words=words)

    def test_choices(self):
        """Options that choose what a file does not have."""
        for path in self.write_all():
            for option, words in (("--frame", "there is no volume 2 here, only 1"),
                                  ("--series", "this is not DICOM"), ("--channel", "this is not TIFF"),
                                  ("--component", "no component 2 here, only 1")):
                self.assert_refused(path, option, "2", words=words)
        self.assert_refused(self.path("a.mha"), "--array", "a", words="leave --array out")


if __name__ == "__main__":
    splatmip.main()
