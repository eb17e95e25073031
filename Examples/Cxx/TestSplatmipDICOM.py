# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM series, sound ones and others."""
import os

import DICOMFiles as dicom
import SplatmipTesting as splatmip


class TestSeries(splatmip.SplatmipTest):
    def test_sound(self):
        folder = dicom.write_series(self.path("series"), dicom.make_slices())
        self.draw_block(folder)
        splatmip.write_file(os.path.join(folder, "README.txt"), b"Not an image.")
        self.draw_block(folder)

    def test_truncated(self):
        folder = dicom.write_series(self.path("series"), dicom.make_slices())
        for name in os.listdir(folder):
            path = os.path.join(folder, name)
            os.truncate(path, os.path.getsize(path) - 100)
        self.assert_refused(folder)

    def test_damaged(self):
        """Bytes behind the pixels that vtk-dicom does not return from."""
        folder = dicom.write_series(self.path("series"), dicom.make_slices())
        with open(os.path.join(folder, dicom.name_of(4)), "ab") as file:
            file.write(b"\0" * 8)
        self.assert_refused(folder)


if __name__ == "__main__":
    splatmip.main()
