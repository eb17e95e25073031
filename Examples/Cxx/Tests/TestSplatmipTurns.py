# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Turns: films and numbered pictures."""
import os
import pty
import re
import shutil
import subprocess

import numpy

import DICOMFiles as dicom
import FilmFiles as films
import SplatmipTesting as splatmip
from DICOMFiles import pydicom

SIZE = ("--size", "61x47", "--mode", "standard")


class TestProgress(splatmip.SplatmipTest):
    def watch(self, *arguments, until):
        """What the program prints to a terminal, up to where a pattern is found, or all of it."""
        terminal, other = pty.openpty()
        self.addCleanup(os.close, terminal)
        with subprocess.Popen([splatmip.PROGRAM, *arguments], cwd=self.scratch.name, stderr=other,
                              stdout=subprocess.DEVNULL) as program:
            os.close(other)
            text = b""
            try:
                while not re.search(until, text):
                    text += os.read(terminal, 1000)
            except OSError:  # the program has ended
                pass
            program.kill()
        return text

    def test_terminal(self):
        """What takes longer than a second prints how much is done, in one line; short steps do not."""
        text = self.watch("--rotate", "3600", "--size", "400x600", "--mode", "high", "--out", "turn.ogv",
                          until=rb"%.+%.+%")
        self.assertRegex(text, rb"^(\rprojecting +\d+ %){3}")
        parts = [int(n) for n in re.findall(rb"(\d+) %", text)]
        self.assertEqual(parts, sorted(set(parts)))
        text = self.watch("--rotate", "2", "--size", "16x16", "--mode", "preview", "--out", "turn.ogv", until=rb"never")
        self.assertEqual(text, b"")

    def test_no_terminal(self):
        """A log has no progress lines, however long it takes."""
        self.run_well("--rotate", "800", "--size", "200x300", "--mode", "high", "--out", "turn.ogv")


class TestTurns(splatmip.SplatmipTest):
    def turn(self, views, *options):
        """The turn as numbered pictures."""
        text = self.run_well("--rotate", views, "--out", "turn.png", *options)
        self.assertEqual(text.splitlines()[-1], "turn: " + self.path("turn.png"))
        self.assertRegex(text, rf"{views} views of \d+ x \d+ in .* per second")
        names = sorted(name for name in os.listdir(self.scratch.name) if name.endswith(".png"))
        self.assertEqual(names, [f"turn-{n:05}.png" for n in range(views)])
        return [splatmip.read_picture(self.path(name)) for name in names]

    def test_pictures(self):
        """All differ, and the view from behind is the mirror image of the front."""
        pictures = self.turn(8, "--azimuth", "0", "--elevation", "0", *SIZE)
        self.assertEqual(len({picture.tobytes() for picture in pictures}), 8)
        self.assertLessEqual(abs(pictures[0][:, ::-1] - pictures[4]).max(), 1)
        self.assertGreater(pictures[0].max(), 250)

    def test_film(self):
        """Each picture of the film is nearer to its view than to the others, or mirrored ones."""
        for colors in (("--colormap", "hot"), ("--depth-coding",)):
            self.run_well("--rotate", "5", "--output", "turn.ogv", *SIZE, *colors)
            found = films.read_theora(self.path("turn.ogv"), (61, 47))
            if found is None:
                self.skipTest("skipped: no libtheoradec")
            expected = self.turn(5, *SIZE, *colors)
            self.assertEqual(len(found), 5)
            for n, picture in enumerate(found):
                own = abs(picture - expected[n]).mean()
                others = [abs(picture - other).mean() for m, other in enumerate(expected) if m != n]
                mirrored = abs(picture - expected[n][::-1]).mean()
                self.assertLess(2 * own, min(*others, mirrored))

    def read_dicom(self):
        """By pydicom; dciodvfy finds no error."""
        if shutil.which("dciodvfy"):
            result = subprocess.run(["dciodvfy", self.path("turn.dcm")], capture_output=True, text=True, check=False)
            self.assertNotIn("Error", result.stderr + result.stdout)
            self.assertRegex(result.stderr + result.stdout, "Multiframe(GrayscaleByte|TrueColor)SC")
        return pydicom.dcmread(self.path("turn.dcm"))

    def test_dicom(self):
        """Gray bytes where the colours are gray, else true colours."""
        if not self.has_dicom():
            self.skipTest("skipped: no vtk-dicom")
        for colors, samples in ((("--colormap", "gray"), 1), (("--colormap", "inverted"), 1),
                                (("--colormap", "hot"), 3), (("--depth-coding",), 3)):
            self.run_well("--rotate", "5", "--rate", "10", "--output", "turn.dcm", *SIZE, *colors)
            file = self.read_dicom()
            self.assertEqual((file.SamplesPerPixel, file.NumberOfFrames), (samples, 5))
            # A column more makes the number of bytes even.
            pixels = file.pixel_array.reshape(5, 47, 62, samples)[:, :, :61]
            self.assertTrue((pixels == self.turn(5, *SIZE, *colors)).all())
            self.assertEqual(list(file.FrameTimeVector), [0, 100, 100, 100, 100])
            self.assertNotIn("PixelSpacing", file)  # mm are unknown

    def test_dicom_study(self):
        """What comes from a study stays in it, as a series of its own."""
        if not self.has_dicom():
            self.skipTest("skipped: no vtk-dicom")
        slices = dicom.make_slices()
        folder = dicom.write_series(self.path("series"), slices)
        self.run_well(folder, "--rotate", "4", "--view", "anterior", "--out", "turn.dcm", *SIZE)
        file = self.read_dicom()
        for name in ("PatientName", "PatientID", "StudyInstanceUID", "StudyDate"):
            self.assertEqual(file[name].value, slices[0][name])
        self.assertNotEqual(file.SeriesInstanceUID, slices[0]["SeriesInstanceUID"])
        for size in file.PixelSpacing:
            self.assertAlmostEqual(size, 1.1 * 16 / 47, 6)  # the volume's height fits


if __name__ == "__main__":
    splatmip.main()
