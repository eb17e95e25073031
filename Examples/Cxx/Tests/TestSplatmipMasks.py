# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which voxels are shown: masks, their labels, and components."""
import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk

import SplatmipTesting as splatmip

SPACING = (1.5, 1.0, 2.0)
ORIGIN = (-12.0, 30.0, 7.0)


def write_nrrd(path, values, axes=numpy.eye(3), origin=ORIGIN, spacing=SPACING):
    """Slices of rows; the axes are rows, in the patient (LPS)."""
    directions = " ".join("(" + ",".join(map(repr, (length * axis).tolist())) + ")"
                          for length, axis in zip(spacing, numpy.array(axes, float)))
    header = f"""NRRD0004
type: {'short' if values.dtype == numpy.int16 else 'float'}
dimension: 3
space: left-posterior-superior
sizes: {values.shape[2]} {values.shape[1]} {values.shape[0]}
space directions: {directions}
space origin: ({origin[0]},{origin[1]},{origin[2]})
endian: little
encoding: raw

"""
    return splatmip.write_file(path, header.encode() + values.tobytes())


class TestMasks(splatmip.SplatmipTest):
    def setUp(self):
        """Two blocks, the brighter one at the patient's right; the labels are 3 and 7."""
        super().setUp()
        self.values = numpy.zeros((14, 16, 20), numpy.int16)
        self.values[5:9, 6:10, 2:6] = 1000
        self.values[5:9, 6:10, 13:17] = 600
        self.labels = numpy.zeros(self.values.shape, numpy.int16)
        self.labels[5:9, 6:10, 2:6] = 3
        self.labels[5:9, 6:10, 13:17] = 7
        self.file = write_nrrd(self.path("a.nrrd"), self.values)

    def show(self, *arguments):
        """The largest gray at the picture's left, the patient's right, and at its right."""
        pixels, text = self.draw(
            self.file, "--view", "anterior", "--mode", "exact", "--window", "1000", "--level",
            "500", "--size", "200x140", "--no-marks", "--output", "a.png", *arguments)
        rows = slice(40, None)  # below the label
        return (pixels[rows, :100].max(), pixels[rows, 100:].max()), text

    def assert_shown(self, left, right, *arguments):
        found, text = self.show(*arguments)
        self.assertLess(abs(numpy.array(found) - [255 * left, 255 * right]).max(), 3, arguments)
        return text

    def test_labels(self):
        mask = write_nrrd(self.path("m.nrrd"), self.labels)
        self.assert_shown(1.0, 0.6)
        text = self.assert_shown(1.0, 0.6, "--mask", mask)
        self.assertIn("the mask shows 128 of 4480 voxels\n", text)
        self.assert_shown(1.0, 0.0, "--mask", mask, "--label", "3")
        self.assert_shown(0.0, 0.6, "--mask", mask, "--label", "7")
        result = self.run_program(self.file, "--mask", mask, "--label", "5")
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertIn("its labels are 3 or 7", result.stderr)
        self.assert_refused("--label", "5", word="--label is for a --mask or a DICOM segmentation")
        self.assert_refused(self.file, "--mask", mask, "--label", "0", word="other than 0", code=2)
        self.assert_refused("--compare", "--mask", mask, word="whole volume", code=2)

    def test_turn(self):
        """Masks hold in turns and for values, too."""
        mask = write_nrrd(self.path("m.nrrd"), self.labels)
        self.run_program(self.file, "--mask", mask, "--label", "7", "--output", "v.mha")
        values, _ = splatmip.read_values(self.path("v.mha"))
        self.assertLess(abs(numpy.nanmax(values) - 600), 1)

    def test_other_order(self):
        """The same voxels, counted from other corners along other axes, in another format."""
        eye = numpy.eye(3)
        for axes, flips in (((0, 1, 2), (1, 1, 1)), ((0, 1, 2), (-1, -1, 1)),
                            ((2, 0, 1), (1, -1, 1)), ((1, 0, 2), (-1, 1, -1))):
            labels = self.labels.transpose(*(2 - axis for axis in axes[::-1]))
            origin = numpy.array(ORIGIN)
            for n, (axis, flip) in enumerate(zip(axes, flips)):
                if flip < 0:
                    labels = numpy.flip(labels, 2 - n)
                    origin[axis] += SPACING[axis] * (self.values.shape[2 - axis] - 1)
            mask = write_nrrd(
                self.path("m.nrrd"), numpy.ascontiguousarray(labels),
                [flip * eye[axis] for axis, flip in zip(axes, flips)], origin,
                [SPACING[axis] for axis in axes])
            self.assert_shown(1.0, 0.0, "--mask", mask, "--label", "3")
            self.assert_shown(0.0, 0.6, "--mask", mask, "--label", "7")

    def test_nifti(self):
        """As programs for segmentation write it for DICOM and NRRD."""
        image = vtk.vtkImageData()
        image.SetDimensions(*self.labels.shape[::-1])
        image.SetSpacing(*SPACING)
        scalars = numpy_to_vtk(self.labels[:, ::-1, ::-1].copy().ravel(), deep=True)
        scalars.SetName("labels")
        image.GetPointData().SetScalars(scalars)
        form = vtk.vtkMatrix4x4()  # RAS: the last voxel of rows and columns is the first here
        form.SetElement(0, 3, 12 - 19 * 1.5)
        form.SetElement(1, 3, -30 - 15)
        form.SetElement(2, 3, 7)
        mask = splatmip.write_nifti(self.path("m.nii.gz"), image, QFormMatrix=form)
        self.assert_shown(1.0, 0.0, "--mask", mask, "--label", "3")

    def test_other_geometry(self):
        """Voxels of the volume take the nearest label, or are hidden outside the mask."""
        c, s = numpy.cos(0.3), numpy.sin(0.3)
        volume = numpy.random.default_rng(0).integers(0, 1000, (14, 16, 20)).astype(numpy.float32)
        own = numpy.column_stack((numpy.diag(SPACING), ORIGIN))
        path = splatmip.write_file(self.path("n.mha"), splatmip.encode_meta(volume, own))
        labels = numpy.random.default_rng(1).integers(0, 3, (9, 12, 11)).astype(numpy.int16)
        for axes, origin, spacing in ((numpy.eye(3), (-10, 31, 8.2), SPACING),
                                      (numpy.eye(3), ORIGIN, (2.7, 1.3, 3.1)),
                                      ([[c, s, 0], [-s, c, 0], [0, 0, -1]], (-6, 30, 30.3), (2, 1.5, 2))):
            mask = write_nrrd(self.path("m.nrrd"), labels, axes, origin, spacing)
            steps = numpy.array(axes, float).T * spacing
            points = numpy.indices(volume.shape)[::-1].reshape(3, -1)
            places = own[:, :3] @ points + own[:, 3:]
            index = numpy.rint(numpy.linalg.solve(steps, places - numpy.c_[numpy.array(origin)]))
            index = index.astype(int)
            inside = ((index >= 0) & (index < numpy.c_[numpy.array(labels.shape[::-1])])).all(axis=0)
            found = numpy.where(inside, labels[tuple(numpy.where(inside, index, 0)[::-1])], 0)
            for words, shown in (((), found != 0), (("--label", "2"), found == 2)):
                expected = numpy.where(shown.reshape(volume.shape), volume, numpy.nan)
                text = self.assert_volume(path, expected, own, "--mask", mask, *words)
                self.assertIn("the mask has other voxels than the volume: 11 x 12 x 9 voxels", text)
        near = write_nrrd(self.path("m.nrrd"), self.labels, origin=(-12.05, 30.04, 7.05))
        text = self.assert_shown(1.0, 0.0, "--mask", near, "--label", "3")
        self.assertNotIn("other voxels", text)
        far = write_nrrd(self.path("m.nrrd"), self.labels, origin=(900, 30, 7))
        self.assert_refused(self.file, "--mask", far, word="this mask shows nothing of the volume")
        self.assert_refused(self.file, "--mask", "none.nii", word="none.nii: no such file")



class TestComponents(splatmip.SplatmipTest):
    def test_components(self):
        """Each component shows its own block."""
        values = numpy.zeros((14, 16, 20, 3), numpy.int16)
        for n in range(3):
            values[5:9, 6:10, 6 * n + 2:6 * n + 5, n] = 1000
        image = vtk.vtkImageData()
        image.SetDimensions(20, 16, 14)
        scalars = numpy_to_vtk(values.reshape(-1, 3), deep=True)
        scalars.SetName("colors")
        image.GetPointData().SetScalars(scalars)
        path = splatmip.write_with(vtk.vtkXMLImageDataWriter(), image, self.path("a.vti"))
        for number in (0, 1, 2, 3):
            words = ("--component", str(number)) if number else ()
            pixels, text = self.draw(path, "--view", "anterior", "--mode", "exact", "--size",
                                     "200x140", "--output", "a.png", *words)
            columns = numpy.nonzero(pixels[40:, :, 0].max(axis=0) > 128)[0]
            expected = 99.5 + (6 * (max(number, 1) - 1) + 3 - 9.5) * 200 / (1.1 * 19)
            self.assertLess(abs(columns.mean() - expected), 3)
            self.assertIn(f"component {max(number, 1)} of 3", text)
        self.assert_refused(path, "--component", "4", word="no component 4 here, only 3")
        self.assert_refused("--component", "1", word="of a file", code=2)


if __name__ == "__main__":
    splatmip.main()
