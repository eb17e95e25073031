# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Values in the unit of the file, its window, and files with several volumes."""
import gzip
import os
import shutil
import struct

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import SplatmipTesting as splatmip


def patch(path, **fields):
    """Change numbers in the header of a NIfTI file."""
    places = {"scl_slope": 112, "scl_inter": 116, "cal_max": 124, "cal_min": 128,
              "pixdim": 80, "srow": 280}
    with open(path, "r+b") as file:
        for name, value in fields.items():
            file.seek(places.get(name, 254))
            file.write(struct.pack("<h", value) if name == "sform_code" else
                       struct.pack(f"<{numpy.size(value)}f", *numpy.ravel(value)))
    return path


class TestNIfTI(splatmip.SplatmipTest):
    def show(self, path, *arguments):
        pixels, text = self.draw(path, "--mode", "high", "--size", "128x128", "--output", "a.png",
                                 "--no-marks", *arguments)
        return pixels[24:], text

    def look(self, *arguments, path="a.nii"):
        return self.show(self.path(path), *arguments)[1].splitlines()[-3]

    def test_window(self):
        path = splatmip.write_nifti(self.path("a.nii"))
        patch(path, cal_min=-50, cal_max=250, scl_slope=2.0, scl_inter=0)
        self.assertEqual(self.look(), "shown with window 300, level 100")
        self.assertEqual(self.look("--window", "7"), "shown with window 7, level 100")
        patch(path, cal_min=0, cal_max=0)
        self.assertEqual(self.look(), "shown with window 2000, level 1000")

    def test_unit_of_length(self):
        """The scale bar knows micrometres."""
        def bar(unit, zoom):
            path = splatmip.write_nifti(self.path("u.nii"))
            with open(path, "r+b") as file:
                file.seek(123)
                file.write(bytes([unit]))
            return self.draw(path, "--output", "u.png", "--zoom", str(zoom))[0][-60:]
        self.assertTrue((bar(2, 1) == bar(0, 1)).all())
        self.assertFalse((bar(2, 1) == bar(3, 1)).all())

    def test_no_form(self):
        path = splatmip.write_nifti(self.path("a.nii"), has_form=False)
        _, text = self.draw(path, "--output", "a.png")
        self.assertIn("left and right may be exchanged", text)

    def test_pairs(self):
        for ending in ("hdr", "img"):
            splatmip.write_nifti(self.path("a.hdr"))
            self.draw_block(self.path("a." + ending))
        for ending in ("hdr", "img"):
            with open(self.path("a." + ending), "rb") as file:
                splatmip.write_file(self.path(f"b.{ending}.gz"), gzip.compress(file.read()))
        self.draw_block(self.path("b.hdr.gz"))
        self.draw_block(self.path("b.img.gz"))
        os.truncate(self.path("a.img"), 1000)
        self.assert_refused(self.path("a.hdr"))
        os.remove(self.path("a.img"))
        self.assert_refused(self.path("a.hdr"))


class TestOthers(splatmip.SplatmipTest):
    def test_no_size(self):
        path = splatmip.write_nrrd(self.path("a.nrrd"), directions="none none none")
        pixels, text = self.draw(path, "--output", "a.png")
        self.assertIn("the file does not say how large voxels are: 1 mm was taken\n", text)

    def test_one_volume(self):
        for path in (splatmip.write_vti(self.path("a.vti")), splatmip.write_vtk(self.path("a.vtk")),
                     splatmip.write_meta(self.path("a.mha")),
                     splatmip.write_nrrd(self.path("a.nrrd")),
                     splatmip.write_nifti(self.path("a.nii"))):
            self.assert_refused(path, "--frame", "2", word="there is no volume 2 here, only 1")
            self.assert_refused(path, "--series", "2", word="this is not DICOM")


class TestValueFiles(splatmip.SplatmipTest):
    def write_volume(self, origin):
        """A cube of 5 voxels of -321 at (5, 4, 8), in an oblique stack of -900; returns its place."""
        values = numpy.full((20, 15, 13), -900, numpy.int16)
        values[6:11, 2:7, 3:8] = -321
        turn = vtk.vtkTransform()
        turn.RotateWXYZ(50, 1, 2, 3)
        axes = numpy.array([turn.TransformVector(*axis) for axis in numpy.eye(3)])
        axes *= numpy.array([1.5, 1.0, 2.0])[:, None]
        vectors = " ".join("(" + ",".join(map(repr, axis.tolist())) + ")" for axis in axes)
        header = f"""NRRD0004
type: short
dimension: 3
space: left-posterior-superior
sizes: 13 15 20
space directions: {vectors}
space origin: ({origin[0]},{origin[1]},{origin[2]})
endian: little
encoding: raw

"""
        splatmip.write_file(self.path("a.nrrd"), header.encode() + values.tobytes())
        self.middle = numpy.array(origin) + numpy.array([6, 7, 9.5]) @ axes
        return numpy.array(origin) + numpy.array([5, 4, 8]) @ axes

    def check(self, name, *arguments):
        """Values and places are the patient's: the cube lies behind its picture."""
        place = self.write_volume((12, -34, 56))
        result = self.run_program(self.path("a.nrrd"), "--output", name, "--size", "90x120",
                                  *arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(result.stdout.splitlines()[-1], "values: " + self.path(name))
        values, matrix = splatmip.read_values(self.path(name))
        self.assertEqual(values.shape, (120, 90))
        self.assertLess(abs(numpy.nanmax(values) + 321), 1)
        self.assertTrue(numpy.isnan(values[0, 0]))
        self.assertLess(abs(numpy.nanmin(values) + 900), 1)
        rows, columns = numpy.nonzero(numpy.nan_to_num(values, nan=-900) > -600)
        seen = matrix @ [columns.mean(), rows.mean(), 0, 1]
        away = matrix[:3, 2] / numpy.linalg.norm(matrix[:3, 2])
        aside = place - seen[:3]
        aside -= (aside @ away) * away
        self.assertLess(numpy.linalg.norm(aside), numpy.linalg.norm(matrix[:3, 0]))
        return matrix

    def test_values(self):
        for name in ("v.nii", "v.nii.gz", "v.mha"):
            matrix = self.check(name, "--view", "anterior", "--mode", "high")
            axes = matrix[:3, :3] / numpy.linalg.norm(matrix[:3, :3], axis=0)
            self.assertLess(abs(axes - [[1, 0, 0], [0, 0, -1], [0, 1, 0]]).max(), 1e-6)
            self.check(name, "--azimuth", "70", "--elevation", "-25", "--roll", "40")
        self.assertAlmostEqual(
            numpy.linalg.norm(self.check("v.nii", "--slab", "90")[:3, 2]), 90, 4)

    def test_slab(self):
        """The picture of a slab lies in the slab's middle, as thick as it; bits are kept."""
        self.write_volume((12, -34, 56))
        for offset in (0, 4, -3):
            options = ("--view", "left", "--mode", "exact", "--slab", "5", "--slab-offset",
                       str(offset), "--size", "64x64")
            planes = []
            for name in ("v.mha", "v.nii"):
                result = self.run_program(self.path("a.nrrd"), "--output", name, *options)
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                values, matrix = splatmip.read_values(self.path(name))
                planes.append((values, matrix))
                self.assertAlmostEqual(numpy.linalg.norm(matrix[:3, 2]), 5, 5)
                middle = (matrix @ [31.5, 31.5, 0, 1])[:3]
                self.assertLess(abs(middle - self.middle - [offset, 0, 0]).max(), 1e-4)
            self.assertTrue(numpy.array_equal(planes[0][0], planes[1][0], equal_nan=True))
            # NIfTI keeps numbers in single precision.
            self.assertLess(abs(planes[0][1] - planes[1][1]).max(), 100 * 2 ** -23)

    def test_tiff(self):
        """The values and the size of pixels; that the place is lost is told."""
        self.write_volume((12, -34, 56))
        options = ("--view", "left", "--mode", "exact", "--size", "50x64")
        self.run_program(self.path("a.nrrd"), "--output", "v.mha", *options)
        expected, matrix = splatmip.read_values(self.path("v.mha"))
        for name in ("v.tif", "v.tiff"):
            result = self.run_program(self.path("a.nrrd"), "--output", name, *options)
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertIn("TIFF holds the size of a pixel, but not where", result.stdout)
            reader = vtk.vtkTIFFReader()
            reader.SetFileName(splatmip.look_at(self.path(name)))
            reader.Update()
            image = reader.GetOutput()
            self.assertEqual(image.GetScalarTypeAsString(), "float")
            # The first row of the file is the top one, which VTK's reader leaves first.
            values = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(64, 50)[::-1]
            self.assertTrue(numpy.array_equal(values, expected, equal_nan=True))
            with open(self.path(name), "rb") as file:
                data = file.read()
            tags = {}
            start = struct.unpack_from("<I", data, 4)[0]
            for n in range(struct.unpack_from("<H", data, start)[0]):
                tag, _, _, value = struct.unpack_from("<HHII", data, start + 2 + 12 * n)
                tags[tag] = value
            above, below = struct.unpack_from("<II", data, tags[282])  # pixels per cm
            self.assertEqual(tags[296] & 0xFFFF, 3)
            length = numpy.linalg.norm(matrix[:3, 0])
            self.assertLess(abs(above / below * length / 10 - 1), 1e-5)

    def test_origins(self):
        """Of each format: the picture goes through the middle of the volume."""
        image = splatmip.make_image()
        image.SetOrigin(12, -34, 56)
        form = vtk.vtkMatrix4x4()
        form.DeepCopy([-1, 0, 0, -12, 0, -1, 0, 34, 0, 0, 1, 56, 0, 0, 0, 1])
        splatmip.write_with(vtk.vtkXMLImageDataWriter(), image, self.path("a.vti"))
        splatmip.write_with(vtk.vtkDataSetWriter(), image, self.path("a.vtk"))
        splatmip.write_with(vtk.vtkMetaImageWriter(), image, self.path("a.mha"))
        image.SetOrigin(0, 0, 0)
        splatmip.write_nifti(self.path("a.nii"), image, has_form=False, QFormMatrix=form)
        for space, place in (("left-posterior-superior", "(12,-34,56)"),
                             ("right-anterior-superior", "(-12,34,56)")):
            name = space[:4] + ".nrrd"
            turned = "(1.5,0,0) (0,1,0) (0,0,2)"
            turned = turned if place[1] == "1" else "(-1.5,0,0) (0,-1,0) (0,0,2)"
            splatmip.write_nrrd(self.path(name), space=space, directions=turned, origin=place)
        for name in ("a.vti", "a.vtk", "a.mha", "a.nii", "left.nrrd", "righ.nrrd"):
            self.assert_center(self.path(name), [18.75, -28.5, 69])

    def test_read_again(self):
        """What is written can be read."""
        self.check("v.nii.gz", "--view", "left")
        _, text = self.draw(self.path("v.nii.gz"), "--view", "left", "--output", "a.png")
        self.assertIn("90 x 120 x 1 voxels, float", text)

    def test_refusals(self):
        self.assert_refused("--output", "v.nii", "--compare", word=".png", code=2)
        self.assert_refused("--output", "v.nii", "--rotate", "5", word=".ogv", code=2)
        self.assert_refused("--output", "no/v.nii", word="no/v.nii: this cannot be written")


if __name__ == "__main__":
    splatmip.main()
