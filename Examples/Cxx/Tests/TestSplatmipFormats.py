# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Kinds of files, good and bad."""
import os
import struct

import vtk

import SplatmipTesting as splatmip


class TestFormats(splatmip.SplatmipTest):
    def test_vti(self):
        self.draw_block(splatmip.write_vti(self.path("a.vti")))

    def test_vti_direction(self):
        image = splatmip.make_image(x_of_left=0)
        image.SetDirectionMatrix(-1, 0, 0, 0, -1, 0, 0, 0, 1)
        self.draw_block(splatmip.write_with(vtk.vtkXMLImageDataWriter(), image, self.path("a.vti")))

    def test_legacy(self):
        self.draw_block(splatmip.write_vtk(self.path("a.vtk")))

    def test_meta(self):
        self.draw_block(splatmip.write_meta(self.path("a.mha")))
        self.draw_block(splatmip.write_meta(self.path("a.mhd")))

    def test_nrrd(self):
        self.draw_block(splatmip.write_nrrd(self.path("a.nrrd")))
        self.draw_block(splatmip.write_nrrd(self.path("b.nrrd"), encoding="gzip"))
        self.draw_block(splatmip.write_nrrd(self.path("c.nhdr")))

    def test_nifti(self):
        self.draw_block(splatmip.write_nifti(self.path("a.nii")))
        self.draw_block(splatmip.write_nifti(self.path("a.nii.gz")))
        self.draw_block(splatmip.write_nifti(self.path("A.NII.GZ")))


class TestRefusals(splatmip.SplatmipTest):
    def test_no_data(self):
        self.assert_refused("missing.vti", word="no such file")
        self.assert_refused("missing", word="no such file")
        self.assert_refused(splatmip.write_file(self.path("empty.nrrd"), b""), word="empty")
        os.makedirs(self.path("folder"))
        self.assert_refused("folder", word="DICOM")

    def test_other_content(self):
        for suffix in ("vti", "vtk", "mha", "mhd", "nrrd", "nhdr", "nii", "nii.gz"):
            self.assert_refused(splatmip.write_file(self.path("text." + suffix), b"Not a volume.\n" * 99))
        self.assert_refused(splatmip.write_file(self.path("text.txt"), b"Not a volume."), word="unknown")
        sphere = vtk.vtkSphereSource()
        sphere.Update()
        self.assert_refused(
            splatmip.write_with(vtk.vtkDataSetWriter(), sphere.GetOutput(), self.path("sphere.vtk")))

    def test_truncated(self):
        files = [splatmip.write_vti(self.path("a.vti")), splatmip.write_vtk(self.path("a.vtk")),
                 splatmip.write_meta(self.path("a.mha")), splatmip.write_nrrd(self.path("a.nrrd")),
                 splatmip.write_nrrd(self.path("b.nrrd"), encoding="gzip"),
                 splatmip.write_nifti(self.path("a.nii")), splatmip.write_nifti(self.path("a.nii.gz"))]
        for path in files:
            with open(path, "rb") as file:
                data = file.read()
            for part in (0.1, 0.5, 0.9):
                self.assert_refused(splatmip.write_file(path, data[:int(part * len(data))]))

    def test_truncated_companion(self):
        for path in (splatmip.write_meta(self.path("a.mhd")), splatmip.write_nrrd(self.path("a.nhdr"))):
            companion = self.path("a.zraw") if path.endswith(".mhd") else path + ".raw"
            with open(companion, "rb") as file:
                data = file.read()
            self.assert_refused(splatmip.write_file(companion, data[:len(data) // 2]) and path)
            os.remove(companion)
            self.assert_refused(path)

    def test_damaged_header(self):
        """Headers that VTK 9.1's readers, or vtk-dicom, do not return from."""
        def damage(path, old, new):
            with open(path, "rb") as file:
                data = file.read()
            self.assertIn(old, data)
            self.assert_refused(splatmip.write_file(path, data.replace(old, new, 1)))
        damage(splatmip.write_nrrd(self.path("a.nrrd")), b"sizes: 10 12 14", b"sizes: 10 12\0 14")
        damage(splatmip.write_nrrd(self.path("a.nrrd")), b"sizes: 10 12 14\n", b"")
        damage(splatmip.write_nrrd(self.path("a.nhdr")), b".raw\n", b".raw")
        damage(splatmip.write_nrrd(self.path("a.nhdr")), b"a.nhdr.raw", b"a%s%s%s.raw 1 9 0")
        damage(splatmip.write_meta(self.path("a.mha")), b"NDims = 3", b"NDims = 99999")
        damage(splatmip.write_nifti(self.path("a.nii")),
               struct.pack("<2H", 4, 16), struct.pack("<2H", 10, 16))

    def test_huge_header(self):
        self.assert_refused(splatmip.write_file(
            self.path("a.nrrd"), b"NRRD0004\ntype: short\ndimension: 3\nendian: little\n"
            b"sizes: 100000 100000 100000\nencoding: raw\n\nxx"), word="memory")

    def test_no_point_scalars(self):
        image = vtk.vtkImageData()
        image.SetDimensions(*splatmip.SIZE)
        self.assert_refused(splatmip.write_with(
            vtk.vtkXMLImageDataWriter(), image, self.path("a.vti")), word="no numeric value")

    def test_no_numbers(self):
        """Of NaN alone there is no picture; a few numbers among a million are found."""
        image = vtk.vtkImageData()
        image.SetDimensions(160, 160, 160)
        image.AllocateScalars(vtk.VTK_FLOAT, 1)
        scalars = image.GetPointData().GetScalars()
        scalars.SetName("intensity")
        scalars.Fill(float("nan"))
        path = splatmip.write_with(vtk.vtkXMLImageDataWriter(), image, self.path("a.vti"))
        self.assert_refused(path, word="no finite value")
        self.assert_refused(path, "--rotate", "2", "--out", "turn.png", word="no finite value")
        self.assertEqual(os.listdir(self.scratch.name), ["a.vti"])
        scalars.SetValue(160 ** 3 // 2 + 1, 7.0)
        splatmip.write_with(vtk.vtkXMLImageDataWriter(), image, path)
        _, text = self.draw(path, "--mode", "preview", "--size", "50x50")
        self.assertIn("level 7\n", text)

    def test_options(self):
        self.assert_refused("--mode", "best", code=2)
        self.assert_refused("--size", "12", code=2)
        self.assert_refused("--window", "-1", code=2)
        self.assert_refused("--output", "picture.jpg", code=2)
        self.assert_refused("--unknown", code=2)


if __name__ == "__main__":
    splatmip.main()
