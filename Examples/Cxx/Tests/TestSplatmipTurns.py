# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Turns: films and numbered pictures."""
import os
import pty
import re
import shutil
import struct
import subprocess

import numpy
import vtk

import DICOMFiles as dicom
import FilmFiles as films
import SplatmipTesting as splatmip


class TestProgress(splatmip.SplatmipTest):
    def watch(self, *arguments, until):
        """What the program says to a terminal, up to where a pattern is found, or all of it."""
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

    def test_long(self):
        """What takes longer than a second tells how much is done, in one line."""
        text = self.watch("--rotate", "3600", "--size", "400x600", "--mode", "high", "--out",
                          "turn.ogv", until=rb"%.+%.+%")
        self.assertRegex(text, rb"^(\rprojecting +\d+ %){3}")
        parts = [int(n) for n in re.findall(rb"(\d+) %", text)]
        self.assertEqual(parts, sorted(set(parts)))

    def test_short(self):
        """What is done at once says nothing."""
        self.assertEqual(
            self.watch("--rotate", "2", "--size", "16x16", "--mode", "preview", "--out", "turn.ogv",
                       until=rb"never"), b"")
        self.assertIn("turn.ogv", os.listdir(self.scratch.name))

    def test_no_terminal(self):
        """A log has no progress lines, however long it takes."""
        result = self.run_program("--rotate", "800", "--size", "200x300", "--mode", "high", "--out",
                                  "turn.ogv")
        self.assertEqual((result.returncode, result.stderr), (0, ""))


class TestTurns(splatmip.SplatmipTest):
    def turn(self, *arguments):
        """Returns what was printed."""
        result = self.run_program(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        self.assertTrue(result.stdout.splitlines()[-1].startswith("turn: "), result.stdout)
        return result.stdout

    def read(self, name):
        reader = vtk.vtkPNGReader()
        reader.SetFileName(splatmip.look_at(self.path(name)))
        reader.Update()
        return splatmip.get_bytes(reader.GetOutput())

    def test_pictures(self):
        options = ("--size", "60x90", "--mode", "standard", "--azimuth", "0", "--elevation", "0")
        text = self.turn("--rotate", "8", "--out", "turn.png", *options)
        self.assertRegex(text, r"8 views of 60 x 90 in .* per second")
        names = sorted(os.listdir(self.scratch.name))
        self.assertEqual(names, [f"turn-{n:05}.png" for n in range(8)])
        pictures = [self.read(name) for name in names]
        self.assertEqual(len(set(pictures)), 8)
        # The view from behind is the mirror image of the front.
        width = 3 * 60
        rows = [pictures[0][n:n + width] for n in range(0, len(pictures[0]), width)]
        mirrored = b"".join(row[::-1] for row in rows)  # gray
        differences = [abs(a - b) for a, b in zip(mirrored, pictures[4])]
        self.assertLessEqual(max(differences), 1)
        # The first view is what the mapper shows; the turn is as large as fits from all sides.
        self.assertGreater(max(pictures[0]), 250)

    def read_turn(self, views, *options):
        """The same turn as numbered pictures."""
        self.turn("--rotate", str(views), "--out", "same.png", *options)
        return [splatmip.read_picture(vtk.vtkPNGReader(), self.path(f"same-{n:05}.png"))
                for n in range(views)]

    def test_film(self):
        """Each picture of the film is nearer to its view than to the others, or mirrored ones."""
        for colors in (("--colormap", "hot"), ("--depth-coding",)):
            options = ("--size", "61x47", "--mode", "standard", *colors)
            self.turn("--rotate", "5", "--output", "turn.ogv", *options)
            with open(self.path("turn.ogv"), "rb") as file:
                data = file.read()
            self.assertTrue(data.startswith(b"OggS"))
            self.assertIn(b"theora", data[:200])
            found = films.read_theora(splatmip.look_at(self.path("turn.ogv")), (61, 47))
            if found is None:
                self.skipTest("no libtheoradec")
            expected = self.read_turn(5, *options)
            self.assertEqual(len(found), 5)
            for n, picture in enumerate(found):
                own = abs(picture - expected[n]).mean()
                others = [abs(picture - other).mean() for m, other in enumerate(expected) if m != n]
                mirrored = abs(picture - expected[n][::-1]).mean()
                self.assertLess(2 * own, min(*others, mirrored))

    def read_dicom(self, name, frames, size):
        """The frames behind the header of an uncompressed file; dciodvfy finds no error."""
        with open(splatmip.look_at(self.path(name)), "rb") as file:
            data = file.read()
        self.assertEqual(data[128:132], b"DICM")
        tool = shutil.which("dciodvfy")
        if tool:
            result = subprocess.run([tool, self.path(name)], capture_output=True, text=True,
                                    check=False)
            self.assertNotIn("Error", result.stderr + result.stdout)
            self.assertRegex(result.stderr + result.stdout, "Multiframe(GrayscaleByte|TrueColor)SC")
        length = len(data) - data.rindex(struct.pack("<HH2sxx", 0x7FE0, 0x0010, b"OB")) - 12
        samples = length // (frames * size[0] * size[1])
        self.assertEqual(length, samples * frames * size[0] * size[1])
        pixels = numpy.frombuffer(data[-length:], numpy.uint8)
        shape = (frames, size[1], size[0], samples)
        return numpy.broadcast_to(pixels.reshape(shape), (*shape[:3], 3)), samples, data

    def find_text(self, data, tag, vr):
        """The text of an element that occurs once."""
        place = data.index(struct.pack("<HH", *tag) + vr)
        length, = struct.unpack_from("<H", data, place + 6)
        return data[place + 8:place + 8 + length].decode().rstrip(" \0")

    def test_dicom(self):
        """Gray bytes where the colours are gray, else true colours; a missing dciodvfy is told."""
        for colors, samples in ((("--colormap", "gray"), 1), (("--colormap", "inverted"), 1),
                                (("--colormap", "hot"), 3), (("--depth-coding",), 3)):
            options = ("--size", "61x47", "--mode", "standard", *colors)
            result = self.run_program("--rotate", "5", "--rate", "10", "--output", "turn.dcm", *options)
            if "no vtk-dicom" in result.stderr:
                self.skipTest("no vtk-dicom")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            # A column more makes the number of bytes even.
            found, found_samples, data = self.read_dicom("turn.dcm", 5, (62, 47))
            self.assertEqual(found_samples, samples)
            self.assertTrue((found[:, :, :61] == self.read_turn(5, *options)).all())
            self.assertEqual(self.find_text(data, (0x0018, 0x1065), b"DS"), "0\\100\\100\\100\\100")
            self.assertNotIn(struct.pack("<HH", 0x0028, 0x0030) + b"DS", data)  # mm are unknown
        if not shutil.which("dciodvfy"):
            self.skipTest("no dciodvfy: whether the files are valid is not known")

    def test_dicom_study(self):
        """What comes from a study stays in it, as a series of its own."""
        slices = dicom.make_slices()
        folder = dicom.write_series(self.path("series"), slices)
        result = self.run_program(folder, "--rotate", "4", "--view", "anterior", "--size", "61x47",
                                  "--out", "turn.dcm")
        if "no vtk-dicom" in result.stderr:
            self.skipTest("no vtk-dicom")
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        _, _, data = self.read_dicom("turn.dcm", 4, (61, 47))
        for tag, vr, name in (((0x0010, 0x0010), b"PN", "PatientName"),
                              ((0x0010, 0x0020), b"LO", "PatientID"),
                              ((0x0020, 0x000D), b"UI", "StudyInstanceUID"),
                              ((0x0008, 0x0020), b"DA", "StudyDate")):
            self.assertEqual(self.find_text(data, tag, vr), slices[0][name])
        series = self.find_text(data, (0x0020, 0x000E), b"UI")
        self.assertNotEqual(series, slices[0]["SeriesInstanceUID"])
        size = [float(n) for n in self.find_text(data, (0x0028, 0x0030), b"DS").split("\\")]
        self.assertEqual(size[0], size[1])
        self.assertAlmostEqual(size[0], 1.1 * 26 / 47, 6)  # the volume's height fits

    def test_refusals(self):
        self.assert_refused("--rotate", "4", "--out", "turn.jpg", word=".ogv", code=2)
        self.assert_refused("--rotate", "1", "--out", "turn.ogv", code=2)
        self.assert_refused("--rotate", "4", "--interactive", word="choose one", code=2)
        self.assert_refused("--out", "turn.ogv", word=".png", code=2)
        os.symlink("/dev/full", self.path("full.dcm"))
        for name in ("no/turn.ogv", "no/turn.dcm", "full.dcm"):
            result = self.run_program("--rotate", "2", "--size", "16x16", "--out", name)
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, rf"^splatmip: .*{name}: .* folder .*\.\n$")


if __name__ == "__main__":
    splatmip.main()
