# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""NIfTI, NRRD, MetaImage and VTK's files: values and places are those that other libraries find."""
import bz2
import gzip
import os
import sys
import unittest
import zlib

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

import SplatmipTesting as splatmip

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "Python"))
import volume_files  # noqa: E402

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


def make_values(dtype=numpy.int16, seed=0):
    return numpy.random.default_rng(seed).integers(0, 1000, SIZE).astype(dtype)


def check_viewer(test, path, values, places):
    """The browser viewer has the same values at the same places."""
    image = volume_files.read_volume(path).image
    found = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
    for index in ((0, 0, 0), (5, 0, 0), (0, 19, 0), (0, 0, 29), (3, 7, 11)):
        place = [0.0, 0.0, 0.0]
        image.TransformPhysicalPointToContinuousIndex(places @ (*index, 1), place)
        x, y, z = (int(round(number)) for number in place)
        test.assertLess(abs(numpy.array(place) - (x, y, z)).max(), 1e-3)
        test.assertEqual(found[z, y, x], values[index[::-1]], path)


def turn(degrees):
    c, s = numpy.cos(numpy.radians(degrees)), numpy.sin(numpy.radians(degrees))
    return numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ [[1, 0, 0], [0, c, -s], [0, s, c]]


@unittest.skipUnless(nibabel, "skipped: no nibabel")
class TestNIfTI(splatmip.SplatmipTest):
    def write(self, name, values, sform=None, qform=None, zooms=(1.5, 1.2, 2.5), kind=None, **fields):
        """Values[x, y, z, ...]."""
        image = (kind or nibabel.Nifti1Image)(values, None)
        if zooms:
            image.header.set_zooms(zooms + (1,) * (values.ndim - 3))
        image.set_sform(sform, code=0 if sform is None else 1)
        image.set_qform(qform, code=0 if qform is None else 1)
        for key, value in fields.items():
            image.header[key] = value
        nibabel.save(image, self.path(name))
        return self.path(name)

    def judge(self, path, *arguments, frame=0, affine=None, unit=1.0, is_viewed=False):
        """As nibabel reads it, which counts to the right and the front."""
        image = nibabel.load(path)
        values = numpy.asarray(image.dataobj)
        values = values.reshape(*values.shape[:3], -1, order="F")[..., frame].T
        axes = unit * numpy.diag([-1, -1, 1]) @ (image.affine if affine is None else affine)[:3]
        if is_viewed:
            check_viewer(self, path, values, axes)
        return self.assert_volume(path, values, axes, *arguments)

    def test_forms(self):
        """The sform as it stands, whatever pixdim is; the qform if the sform is empty."""
        values = make_values().T
        oblique, other = numpy.eye(4), numpy.diag([-1.5, -1.2, 2.5, 1])
        oblique[:3, :3] = turn(30) * [1.5, 1.2, 2.5]
        oblique[:3, 3] = 10, -20, 30
        sheared = oblique.copy()
        sheared[0, 1] += 0.7
        self.judge(self.write("a.nii", values, oblique), is_viewed=True)
        self.judge(self.write("a.nii.gz", values, None, oblique), is_viewed=True)
        self.judge(self.write("a.nii", values, oblique, other), is_viewed=True)
        self.judge(self.write("a.nii", values, sheared))
        self.judge(self.write("a.nii", values, 2 * oblique))
        self.judge(self.write("a.nii", values, oblique, kind=nibabel.Nifti2Image))
        path = self.write("a.nii", values, numpy.diag([1.5, 1.2, 2.5, 1]))
        with open(path, "r+b") as file:  # pixdim[1]
            file.seek(80)
            file.write(numpy.float32(-1.5).tobytes())
        self.judge(path, affine=numpy.diag([1.5, 1.2, 2.5, 1]), is_viewed=True)
        path = self.write("a.nii", values, oblique, other)
        with open(path, "r+b") as file:  # srow
            file.seek(280)
            file.write(bytes(48))
        text = self.judge(path, affine=other, is_viewed=True)
        self.assertNotIn("exchanged", text)

    def test_types(self):
        for dtype in (numpy.uint8, numpy.uint16, numpy.int32, numpy.float32, numpy.float64):
            self.judge(self.write("a.nii", make_values(dtype).T, numpy.eye(4)))
        values = make_values()
        path = self.write("a.nii", values.T, numpy.eye(4))
        with open(path, "r+b") as file:  # scl_slope, scl_inter
            file.seek(112)
            file.write(numpy.float32([0.5, -100]).tobytes())
        self.judge(path)
        with open(path, "r+b") as file:
            file.seek(112)
            file.write(numpy.float32([numpy.nan, 0]).tobytes())
        self.assertIn("voxels, short", self.judge(path))

    def test_components(self):
        """Complex numbers and colours have several values."""
        values = make_values(numpy.float32) + 1j * make_values(numpy.float32, 1)
        path = self.write("a.nii", values.astype(numpy.complex64).T, numpy.eye(4))
        axes = numpy.diag([-1, -1, 1, 1])[:3]
        self.assert_volume(path, values.real, axes)
        self.assert_volume(path, values.imag, axes, "--component", "2")
        self.assert_volume(path, abs(values), axes, "--component", "magnitude")
        colors = numpy.zeros(SIZE[::-1], [("R", "u1"), ("G", "u1"), ("B", "u1")])
        for n, name in enumerate("RGB"):
            colors[name] = make_values(seed=n).T % 256
        path = self.write("a.nii", colors, numpy.eye(4))
        self.assert_volume(path, colors["B"].T, axes, "--component", "3")
        luminance = 0.299 * colors["R"] + 0.587 * colors["G"] + 0.114 * colors["B"]
        text = self.assert_volume(path, luminance.T, axes, "--component", "luminance")
        self.assertIn("luminance of 3 components\n", text)
        self.assert_refused(self.write("b.nii", make_values().T), "--component", "luminance",
                            word="luminance is of red, green and blue, and voxels have 1 value;")
        self.assert_refused(path, "--component", "hue", word="luminance or magnitude", code=2)

    def test_frames(self):
        values = numpy.stack([make_values(seed=n).T for n in range(6)], 3)
        path = self.write("a.nii.gz", values, numpy.eye(4))
        self.assertIn("volume 1 of 6 (--frame", self.judge(path))
        self.judge(path, "--frame", "5", frame=4)
        self.assert_refused(path, "--frame", "7", word="no volume 7 here, only 6")
        path = self.write("b.nii", values.reshape(*SIZE[::-1], 2, 3, order="F"), numpy.eye(4))
        self.judge(path, "--frame", "6", frame=5)

    def test_units(self):
        """A slab is as thick as is said, in mm, whatever the file counts in."""
        for code, unit, length in ((1, "m", 1000), (3, "um", 0.001)):
            values, form = make_values().T, numpy.diag([1.5, 1.2, 2.5, 1])
            text = self.judge(self.write("a.nii", values, form, xyzt_units=code), unit=length)
            self.assertIn(f"the file's unit of length is {unit}; lengths here are in mm\n", text)
            axes = length * numpy.diag([-1, -1, 1]) @ form[:3]
            slab = ("--slab", str(9 * length), "--slab-offset", str(4 * length))
            self.assert_volume(self.path("a.nii"), values.T, axes, options=slab)

    def test_not_supported(self):
        path = self.write("a.nii", make_values().T, numpy.eye(4))
        with open(path, "r+b") as file:  # datatype and bitpix: float128
            file.seek(70)
            file.write(numpy.int16([1536, 128]).tobytes())
        self.assert_refused(path, word="FLOAT128 (datatype 1536) are not supported; save")

    def test_damaged(self):
        """Numbers that libnifti would trust."""
        path = self.write("a.nii", make_values().T, numpy.eye(4), kind=nibabel.Nifti2Image)
        with open(path, "r+b") as file:  # dim[0]
            file.seek(21)
            file.write(b"9")
        self.assert_refused(path, word="a.nii: damaged, incomplete")

    def test_real_files(self):
        """Test data of nibabel, where its package has them."""
        folder = os.path.join(os.path.dirname(nibabel.__file__), "tests", "data")
        found = 0
        for name, arguments, frame in (("example4d.nii.gz", ("--frame", "2"), 1),
                                       ("example_nifti2.nii.gz", (), 0),
                                       ("anatomical.nii", (), 0), ("functional.nii", (), 0),
                                       ("minc2_4d.nii", (), 0)):
            if os.path.exists(os.path.join(folder, name)):
                self.judge(os.path.join(folder, name), *arguments, frame=frame)
                found += 1
        if not found:
            self.skipTest("skipped: no test data of nibabel")

    def test_analyze(self):
        image = nibabel.AnalyzeImage(make_values().T, None)
        image.header.set_zooms((1.5, 1.2, 2.5))
        nibabel.save(image, self.path("a.img"))
        for name in ("a.img", "a.hdr"):
            axes = numpy.diag([-1.5, -1.2, 2.5, 1])[:3]
            text = self.assert_volume(self.path(name), make_values(), axes)
            self.assertIn("left and right may be exchanged", text)


class TestNRRD(splatmip.SplatmipTest):
    FIELDS = {"type": "short", "dimension": "3", "space": "left-posterior-superior",
              "sizes": "6 20 30", "space directions": "(1.5,0,0) (0,1.2,0) (0,0,2.5)",
              "space origin": "(1,2,3)", "endian": "little", "encoding": "raw"}

    def write(self, data=None, lines=(), **fields):
        """Fields by their names with _ for blanks; None leaves one out. Lines come as they are."""
        header = {**self.FIELDS, **{key.replace("_", " "): value for key, value in fields.items()}}
        text = "".join(f"{key}: {value}\n" for key, value in header.items() if value is not None)
        text = "NRRD0004\n" + text + "".join(line + "\n" for line in lines) + "\n"
        data = make_values().tobytes() if data is None else data
        return splatmip.write_file(self.path("a.nrrd"), text.encode() + data)

    def check(self, path, *arguments, values=None, places=PLACES):
        values = make_values() if values is None else values
        if SimpleITK and not arguments and values.ndim == 3 and "LAS" not in str(places):
            image = SimpleITK.ReadImage(path)
            if image.GetNumberOfComponentsPerPixel() == 1 and image.GetDimension() == 3:
                self.assertTrue((SimpleITK.GetArrayFromImage(image) == values).all())
        return self.assert_volume(path, values, places, *arguments)

    def test_first_axis(self):
        """Few samples along the first axis are no components."""
        self.assertIn("6 x 20 x 30", self.check(self.write()))

    def test_encodings(self):
        values = make_values()
        data = values.tobytes()
        text = " ".join(map(str, values.ravel())).encode()
        self.check(self.write(text, encoding="ascii", endian=None))
        self.check(self.write(data.hex().encode(), encoding="hex"))
        self.check(self.write(gzip.compress(data), encoding="gzip"))
        self.check(self.write(values.astype(">i2").tobytes(), endian="big"))
        self.assert_refused(
            self.write(bz2.compress(data), encoding="bzip2"),
            word="bzip2 encoding not available in NrrdIO); save the volume with gzip or raw data")

    def test_skips(self):
        data = make_values().tobytes()
        self.check(self.write(b"one\ntwo\n" + data, ["line skip: 2"]))
        self.check(self.write(b"1234567" + data, ["byte skip: 7"]))
        self.check(self.write(b"1234567" + data, ["byte skip: -1"]))

    def test_bad_lines(self):
        """The line is named that cannot be understood."""
        for fields, lines, word in (
                ({"sizes": None}, ["sizes:6 20 30"], 'in "sizes:6 20 30": didn\'t see ": "'),
                ({"sizes": None}, ["sizes:\t6\t20\t30"], "sizes:"),
                ({"type": None}, ["type:float"], 'in "type:float"'),
                ({"endian": None}, ["endian:big"], 'in "endian:big"'),
                ({"dimension": None}, ["dimension: 3"], "6 20 30|: don't yet have a valid dim"),
                ({"type": None}, [], "required field: type"),
                ({"encoding": None}, [], "required field: encoding"),
                ({"type": "block"}, [], "type is block"),
                ({}, [9999 * "1 "], "a line of its header is too long")):
            self.assert_refused(self.write(None, lines, **fields), word=word)

    def test_spaces(self):
        signs = {"left-posterior-superior": (1, 1, 1), "LPS": (1, 1, 1),
                 "right-anterior-superior": (-1, -1, 1), "ras": (-1, -1, 1),
                 "left-anterior-superior": (1, -1, 1), "LAS": (1, -1, 1)}
        oblique = numpy.hstack((turn(20) * [1.5, 1.2, 2.5], [[4], [5], [6]]))
        directions = " ".join(f"({x!r},{y!r},{z!r})" for x, y, z in oblique[:, :3].T.tolist())
        for space, factors in signs.items():
            path = self.write(space=space, space_directions=directions, space_origin="(4,5,6)")
            self.check(path, places=numpy.diag(factors) @ oblique)

    def test_frames(self):
        """A fourth axis, of time or a list, wherever it is; vectors are components."""
        stack = numpy.stack([make_values(seed=n) for n in range(3)])
        directions = self.FIELDS["space directions"]
        last = self.write(stack.tobytes(), dimension="4", sizes="6 20 30 3",
                          kinds="domain domain domain list", space_directions=directions + " none")
        self.check(last, values=stack[0])
        self.check(last, "--frame", "3", values=stack[2])
        self.assert_refused(last, "--frame", "4", word="no volume 4 here, only 3")
        first = numpy.moveaxis(stack, 0, 3)
        fields = {"dimension": "4", "sizes": "3 6 20 30", "space_directions": "none " + directions}
        path = self.write(first.tobytes(), **fields, kinds="list domain domain domain")
        self.check(path, "--frame", "2", values=stack[1])
        path = self.write(first.tobytes(), **fields, kinds="vector domain domain domain")
        self.check(path, "--component", "2", values=stack[1])
        length = numpy.sqrt((stack.astype(float) ** 2).sum(axis=0))
        self.check(path, "--component", "magnitude", values=length)
        path = self.write(
            stack.tobytes(), dimension="4", sizes="6 20 30 3", space="RAST",
            space_directions="(-1.5,0,0,0) (0,-1.2,0,0) (0,0,2.5,0) (0,0,0,1)",
            space_origin="(-1,-2,3,0)")
        self.check(path, "--frame", "2", values=stack[1])

    def test_units(self):
        for unit, length in (("um", 1e-3), ("cm", 10), ("\u00b5m", 1e-3)):
            path = self.write(space_units=f'"{unit}" "{unit}" "{unit}"')
            text = self.check(path, places=PLACES * length)
            self.assertIn("unit of length is " + ("um" if length < 1 else "cm"), text)
            self.assert_volume(path, make_values(), PLACES * length,
                               options=("--slab", str(10 * length)))
        text = self.check(self.write(space_units='"ell" "ell" "ell"'))
        self.assertIn("ell, which is unknown: 1 mm was taken for it", text)

    def test_no_size(self):
        """Without a vector for each axis nothing is known."""
        first, _, last = self.FIELDS["space directions"].split()
        for words in ("none none none", f"{first} none {last}", f"{first} (nan,nan,nan) {last}"):
            places = numpy.eye(3, 4) + numpy.array([[0, 0, 0, 1], [0, 0, 0, 2], [0, 0, 0, 3]])
            text = self.assert_volume(self.write(space_directions=words), make_values(), places)
            self.assertIn("the file does not say how large voxels are: 1 mm was taken\n", text)
        pictures = [self.draw(self.path("a.nrrd"), "--output", "a.png", *words)[0]
                    for words in ((), ("--no-marks",))]
        self.assertTrue((pictures[0] == pictures[1]).all())

    def test_incomplete(self):
        self.assert_refused(self.write(make_values().tobytes()[:-100]), word="fread got only 3550")
        self.assert_refused(self.write(gzip.compress(make_values().tobytes())[:-400],
                                       encoding="gzip"))


class TestMetaImage(splatmip.SplatmipTest):
    def write(self, values=None, axes=PLACES, data=None, name="a.mha", **fields):
        content = splatmip.encode_meta(make_values() if values is None else values, axes, **fields)
        if data is not None:
            content = content[:content.rindex(b"\n", 0, content.index(b"ElementDataFile"))] + \
                b"\nElementDataFile = LOCAL\n" + data
        return splatmip.write_file(self.path(name), content)

    def check(self, path, places, *arguments, values=None):
        values = make_values() if values is None else values
        if SimpleITK and not arguments:
            image = SimpleITK.ReadImage(path)
            if image.GetDimension() == 3:
                self.assertTrue((SimpleITK.GetArrayFromImage(image) == values).all())
                axes = numpy.reshape(image.GetDirection(), (3, 3)) * image.GetSpacing()
                self.assertLess(abs(numpy.column_stack((axes, image.GetOrigin())) - places).max(),
                                1e-9)
        if not arguments:
            check_viewer(self, path, values, places)
        self.assert_volume(path, values, places, *arguments)

    def test_geometry(self):
        turned = numpy.hstack((turn(25), [[0], [0], [0]])) * [1.5, 1.2, 2.5, 1]
        turned[:, 3] = 4, 5, 6
        words = " ".join(map(repr, turn(25).T.ravel().tolist()))
        for key in ("TransformMatrix", "Orientation", "Rotation"):
            for place in ("Offset", "Position", "Origin"):
                path = self.write(axes=None, ElementSpacing="1.5 1.2 2.5",
                                  **{key: words, place: "4 5 6"})
                self.check(path, turned)
        self.check(self.write(ElementSpacing=None, ElementSize="1.5 1.2 2.5"), PLACES)
        self.check(self.write(ElementSize="9 9 9"), PLACES)
        both = PLACES.copy()
        both[:, 3] = 7, 8, 9
        self.check(self.write(Origin="7 8 9"), both)

    def test_negative_spacing(self):
        self.check(self.write(ElementSpacing="1.5 1.2 -2.5"), PLACES * [1, 1, -1, 1])

    def test_frames(self):
        stack = numpy.stack([make_values(seed=n) for n in range(3)])
        path = self.write(stack, axes=None, ElementSpacing="1.5 1.2 2.5 1", Offset="1 2 3 0",
                          TransformMatrix="1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1")
        self.check(path, PLACES, "--frame", "3", values=stack[2])

    def test_units(self):
        text = self.assert_volume(self.write(DistanceUnits="um"), make_values(), PLACES * 1e-3)
        self.assertIn("unit of length is um", text)

    def test_data(self):
        values = make_values()
        packed = zlib.compress(values.tobytes())
        self.check(self.write(CompressedData="True", CompressedDataSize=len(packed), data=packed),
                   PLACES)
        self.check(self.write(values.astype(">i2").view(numpy.int16), BinaryDataByteOrderMSB="True"),
                   PLACES)
        text = " ".join(map(str, values.ravel())).encode() + b"\n"
        self.assert_volume(self.write(BinaryData="False", data=text), values, PLACES)
        for name in ("raw", "gzip", "no sizes"):
            path = (self.write(data=values.tobytes()[:-100]) if name == "raw" else
                    self.write(CompressedData="True", CompressedDataSize=len(packed),
                               data=packed[:-200]) if name == "gzip" else self.write(DimSize="6 20 0"))
            self.assert_refused(path, word="a.mha: damaged, incomplete")
        self.assert_refused(self.write(ElementType=None), word="(ElementType required and not defined)")


class TestVTK(splatmip.SplatmipTest):
    def make_image(self, values, spacing=(1.5, 1.2, 2.5), extent=(0, 0, 0), of_cells=False):
        image = vtk.vtkImageData()
        more = 1 if of_cells else 0
        size = values.shape[2::-1]
        image.SetExtent(*(first + n for length, first in zip(size, extent)
                          for n in (0, length - 1 + more)))
        image.SetSpacing(*spacing)
        image.SetOrigin(1, 2, 3)
        return image

    def add(self, attributes, values, name):
        array = numpy_to_vtk(values.reshape(-1, *values.shape[3:]).copy(), deep=True)
        array.SetName(name)
        attributes.AddArray(array)

    def write(self, data, name):
        writers = {"vti": vtk.vtkXMLImageDataWriter, "vtr": vtk.vtkXMLRectilinearGridWriter,
                   "vtk": vtk.vtkDataSetWriter}
        return splatmip.write_with(writers[name[-3:]](), data, self.path(name))

    def test_negative_spacing(self):
        """The file counts from the first voxel in the direction of its spacing."""
        for name in ("a.vti", "a.vtk"):
            image = self.make_image(make_values(), (1.5, 1, -2))
            self.add(image.GetPointData(), make_values(), "a")
            places = numpy.array([[1.5, 0, 0, 1], [0, 1, 0, 2], [0, 0, -2, 3.0]])
            self.assert_volume(self.write(image, name), make_values(), places)

    def test_extent(self):
        """Numbers of voxels need not begin at 0."""
        image = self.make_image(make_values(), extent=(4, -5, 6))
        self.add(image.GetPointData(), make_values(), "a")
        places = PLACES.copy()
        places[:, 3] += [4 * 1.5, -5 * 1.2, 6 * 2.5]
        self.assert_volume(self.write(image, "a.vti"), make_values(), places)

    def test_arrays(self):
        for name in ("a.vti", "a.vtk"):
            image = self.make_image(make_values())
            for n, word in enumerate(("first", "second")):
                self.add(image.GetPointData(), make_values(seed=n), word)
            path = self.write(image, name)
            text = self.assert_volume(path, make_values(), PLACES)
            self.assertIn("array first (--array chooses first or second)", text)
            self.assert_volume(path, make_values(seed=1), PLACES, "--array", "second")
            self.assert_refused(path, "--array", "third", word="no array third here, only first or s")
        self.assert_refused(splatmip.write_nrrd(self.path("a.nrrd")), "--array", "a",
                            word="leave --array out")

    def test_cells(self):
        """A value of a cell is a voxel in its middle."""
        for name in ("a.vti", "a.vtk"):
            image = self.make_image(make_values(), of_cells=True)
            self.add(image.GetCellData(), make_values(), "a")
            places = PLACES.copy()
            places[:, 3] += [0.75, 0.6, 1.25]
            self.assert_volume(self.write(image, name), make_values(), places)

    def test_grids(self):
        """Even rectilinear grids are images; others are interpolated, which is exact if linear."""
        for name in ("a.vtr", "a.vtk"):
            for uneven in (False, True):
                coordinates = [1 + 1.5 * numpy.arange(6), 2 + 1.2 * numpy.arange(20),
                               3 + 2.5 * numpy.arange(30)]
                values = make_values()
                if uneven:
                    ramp = 7.0 * numpy.arange(30)[:, None, None]
                    keep = numpy.array([k for k in range(30) if k not in (4, 9, 10, 20)])
                    ramp = ramp + make_values()[:1] * 1.0
                    coordinates[2], values, whole = coordinates[2][keep], ramp[keep], ramp
                grid = vtk.vtkRectilinearGrid()
                grid.SetDimensions(*(len(places) for places in coordinates))
                grid.SetXCoordinates(numpy_to_vtk(coordinates[0]))
                grid.SetYCoordinates(numpy_to_vtk(coordinates[1]))
                grid.SetZCoordinates(numpy_to_vtk(coordinates[2]))
                self.add(grid.GetPointData(), values, "a")
                path = self.write(grid, name)
                text = self.assert_volume(path, whole if uneven else values, PLACES)
                self.assertEqual("interpolated to the least of its steps" in text, uneven)

    def test_components(self):
        colors = numpy.stack([make_values(numpy.uint8, n) for n in range(3)], 3)
        image = self.make_image(colors)
        self.add(image.GetPointData(), colors, "a")
        path = self.write(image, "a.vti")
        self.assert_volume(path, colors[..., 1], PLACES, "--component", "2")
        length = numpy.sqrt((colors.astype(float) ** 2).sum(axis=3))
        self.assert_volume(path, length, PLACES, "--component", "magnitude")


if __name__ == "__main__":
    splatmip.main()
