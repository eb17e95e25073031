# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Masks: which voxels are shown."""
import numpy

import SplatmipTesting as splatmip

PLACES = numpy.array([[1.5, 0, 0, -12], [0, 1, 0, 30], [0, 0, 2, 7.0]])


class TestMasks(splatmip.SplatmipTest):
    def setUp(self):
        super().setUp()
        random = numpy.random.default_rng(0)
        self.values = random.integers(0, 1000, (14, 16, 20)).astype(numpy.float32)
        self.labels = random.choice([0, 3, 7], self.values.shape).astype(numpy.int16)
        self.file = splatmip.write_meta(self.path("a.mha"), self.values, PLACES)

    def assert_shown(self, labels, places, shown, *arguments, words=""):
        """A mask of such a file shows the voxels shown. Returns the text."""
        mask = splatmip.write_meta(self.path("m.mha"), labels, places)
        wanted = numpy.where(shown, self.values, numpy.nan)
        return self.assert_volume(self.file, wanted, PLACES, "--mask", mask, *arguments, words=words)

    def test_labels(self):
        for arguments, shown in (((), self.labels != 0), (("--label", "7"), self.labels == 7)):
            text = self.assert_shown(self.labels, PLACES, shown, *arguments,
                                     words=f"the mask shows {shown.sum()} of 4480 voxels\n")
            self.assertNotIn("other voxels", text)
        mask = self.path("m.mha")
        for arguments, words, code in (
                ((self.file, "--mask", mask, "--label", "5"), "this mask shows nothing of the volume; give", 1),
                ((self.file, "--label", "5"), "--label is for a --mask or a DICOM segmentation", 1),
                ((self.file, "--mask", mask, "--label", "0"), "not a number from 1 to", 2),
                ((self.file, "--mask", "none.nii"), "none.nii: no such file", 1)):
            self.assert_refused(*arguments, words=words, code=code)

    def test_orders(self):
        """The same voxels, counted from other corners along other axes, or slightly off."""
        for axes, flips in (((0, 1, 2), (-1, -1, 1)), ((2, 0, 1), (1, -1, 1)), ((1, 0, 2), (-1, 1, -1))):
            labels = self.labels.transpose(*(2 - axis for axis in axes[::-1]))
            places = numpy.column_stack((PLACES[:, list(axes)], PLACES[:, 3]))
            for n, flip in enumerate(flips):
                if flip < 0:
                    labels = numpy.flip(labels, 2 - n)
                    places[:, 3] += places[:, n] * (labels.shape[2 - n] - 1)
                    places[:, n] *= -1
            text = self.assert_shown(labels, places, self.labels == 3, "--label", "3")
            self.assertNotIn("other voxels", text)
        near = PLACES + [[0, 0, 0, -0.05], [0, 0, 0, 0.04], [0, 0, 0, 0.05]]
        self.assertNotIn("other voxels", self.assert_shown(self.labels, near, self.labels != 0))

    def test_other_voxels(self):
        """Voxels of the volume take the nearest label, or are hidden outside the mask."""
        c, s = numpy.cos(0.3), numpy.sin(0.3)
        turn = numpy.array([[c, -s, 0], [s, c, 0], [0, 0, -1]])
        labels = self.labels[:9, :12, :11]
        points = numpy.indices(self.values.shape)[::-1].reshape(3, -1)
        for steps, origin in ((PLACES[:, :3], (-10, 31, 8.2)), (numpy.diag((2.7, 1.3, 3.1)), PLACES[:, 3]),
                              (turn * (2, 1.5, 2), (-6, 30, 30.3))):
            index = numpy.rint(numpy.linalg.solve(
                steps, PLACES[:, :3] @ points + (PLACES[:, 3] - origin)[:, None])).astype(int)
            inside = ((index >= 0) & (index < numpy.c_[list(labels.shape[::-1])])).all(axis=0)
            found = numpy.where(inside, labels[tuple(numpy.where(inside, index, 0)[::-1])], 0)
            found = found.reshape(self.values.shape)
            places = numpy.column_stack((steps, origin))
            for arguments, shown in (((), found != 0), (("--label", "7"), found == 7)):
                self.assert_shown(labels, places, shown, *arguments,
                                  words="the mask has other voxels than the volume: the nearest")
        far = splatmip.write_meta(self.path("m.mha"), labels, PLACES + [[0, 0, 0, 900]] * 3)
        self.assert_refused(self.file, "--mask", far, words="this mask shows nothing of the volume")


if __name__ == "__main__":
    splatmip.main()
