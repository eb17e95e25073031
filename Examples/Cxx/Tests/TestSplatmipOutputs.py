# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Outputs are complete or not written, never replace an input, and have the values of the volume."""
import os
import resource
import shutil
import signal
import struct
import subprocess
import time

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import DICOMFiles as dicom
import SplatmipTesting as splatmip
from SplatmipTesting import SMALL


class TestInputs(splatmip.SplatmipTest):
    def assert_kept(self, source, output, *arguments, file=None):
        """The program refuses to replace a file that it reads, and leaves all files as they are."""
        def read():
            return {entry: splatmip.read_file(os.path.join(folder, entry))
                    for folder, _, names in os.walk(self.scratch.name) for entry in names
                    if os.path.isfile(os.path.join(folder, entry))}
        files = read()
        self.assertIn(os.path.basename(file or output), files)
        self.assert_refused(source, "--output", self.path(output), *arguments, words="one of the files to read")
        self.assertEqual(read(), files)

    def test_links(self):
        path = splatmip.write_meta(self.path("a.mha"))
        os.symlink("a.mha", self.path("soft.mha"))
        os.link(path, self.path("hard.mha"))
        os.mkdir(self.path("folder"))
        for output in ("a.mha", "soft.mha", "hard.mha", "folder/../a.mha"):
            self.assert_kept(path, output)
        self.assert_kept(self.path("soft.mha"), "a.mha")
        splatmip.write_file(self.path("text.nii"), b"Not a volume, which is refused later.")
        self.assert_kept(self.path("text.nii"), "text.nii")

    def test_mask(self):
        splatmip.write_meta(self.path("m.mha"))
        self.assert_kept(splatmip.write_vti(self.path("a.vti")), "m.mha", "--mask", self.path("m.mha"))

    def test_list_of_slices(self):
        header = "NDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = LIST 2\na.png\nb.png\n"
        splatmip.write_file(self.path("a.mhd"), header.encode())
        for name in ("a.png", "b.png"):
            splatmip.write_file(self.path(name), b"\1\2\3\4")
        for name in ("a.png", "b.png"):
            self.assert_kept(self.path("a.mhd"), name)

    def test_dicom(self):
        """A slice, one of another series, and the file of which the others are found."""
        if not self.has_dicom():
            self.skipTest("skipped: no vtk-dicom")
        slices = dicom.make_slices()
        folder = dicom.write_series(self.path("series"), slices)
        other = {"SeriesInstanceUID": dicom.ROOT + ".5", "SOPInstanceUID": dicom.ROOT + ".6"}
        dicom.write_object(self.path("series/other.dcm"), {**slices[0], **other})
        first, second = "series/" + dicom.name_of(3), "series/" + dicom.name_of(5)
        for source, output in ((folder, first), (folder, "series/other.dcm"), (self.path(first), second)):
            self.assert_kept(source, output, "--rotate", "2")
        os.rename(self.path(first), self.path("series/a-00001.png"))  # files may have any name
        self.assert_kept(folder, "series/a.png", "--rotate", "2", file="a-00001.png")


class TestComplete(splatmip.SplatmipTest):
    FILM = ("--rotate", "120", "--size", "400x600", "--mode", "preview", "--output", "a.ogv")

    def run_with_limit(self, size, *arguments):
        """As on a disk where only so many bytes of a file fit."""
        return subprocess.run(
            [splatmip.PROGRAM, *arguments], cwd=self.scratch.name, capture_output=True, text=True,
            timeout=300, check=False, restore_signals=False,  # SIGXFSZ remains ignored
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))

    def test_full_disk(self):
        """An error, exit status 1, and the older file remains."""
        for name, words in (("a.png", ()), ("a.mha", ()), ("a.nii", ()), ("a.nii.gz", ()), ("a.tif", ()),
                            ("a.ogv", ("--rotate", "4")), ("a.dcm", ("--rotate", "4")),
                            ("a.png", ("--rotate", "4"))):
            if name == "a.dcm" and not self.has_dicom():
                continue
            os.makedirs(self.path("out"))
            options = ("--output", "out/" + name, *SMALL, *words)
            self.run_well(*options)
            sizes = {file: os.path.getsize(self.path("out/" + file)) for file in os.listdir(self.path("out"))}
            self.assertGreater(min(sizes.values()), 0)
            for part in (0, 0.3, 0.9):
                result = self.run_with_limit(int(part * max(sizes.values())), *options)
                self.assertEqual(result.returncode, 1, (name, part, result.stdout))
                self.assertRegex(result.stderr, r"^splatmip: .*could not be written completely.*\n$")
                self.assertEqual({file: os.path.getsize(self.path("out/" + file))
                                  for file in os.listdir(self.path("out"))}, sizes)
            shutil.rmtree(self.path("out"))

    def find_sizes(self, prefix):
        """The sizes above 0 of files with such names."""
        sizes = []
        for entry in os.scandir(self.scratch.name):
            try:
                sizes.append(entry.name.startswith(prefix) and entry.stat().st_size)
            except FileNotFoundError:
                pass
        return list(filter(None, sizes))

    def interrupt(self, number, is_ignored):
        """Send a signal while a film is written, and all the time before if it is ignored. Returns the exit status."""
        handler = signal.SIG_IGN if is_ignored else signal.SIG_DFL
        with subprocess.Popen([splatmip.PROGRAM, *self.FILM], cwd=self.scratch.name, stdout=subprocess.DEVNULL,
                              preexec_fn=lambda: signal.signal(number, handler)) as program:
            while not self.find_sizes(".splatmip"):
                self.assertIsNone(program.poll())
                if is_ignored:
                    program.send_signal(number)
                time.sleep(0.001)
            program.send_signal(number)
        self.assertEqual(os.listdir(self.scratch.name), ["a.ogv"])
        return program.returncode

    def test_interrupt(self):
        """Nothing remains of a film that is interrupted; under nohup it is completed."""
        splatmip.write_file(self.path("a.ogv"), b"older")
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            self.assertEqual(self.interrupt(number, False), -number)
            self.assertEqual(splatmip.read_file(self.path("a.ogv")), b"older")
        self.assertEqual(self.interrupt(signal.SIGHUP, True), 0)
        self.assertEqual(splatmip.read_file(self.path("a.ogv"))[:4], b"OggS")

    def test_replaced(self):
        """Links remain links, also to no file yet, and a file keeps its permissions."""
        splatmip.write_file(self.path("a.png"), b"older")
        os.chmod(self.path("a.png"), 0o640)
        os.mkdir(self.path("folder"))
        os.symlink("a.png", self.path("link.png"))
        os.symlink("folder/new.png", self.path("dangling.png"))
        for link, file in (("link.png", "a.png"), ("dangling.png", "folder/new.png")):
            self.run_well("--output", link, *SMALL)
            self.assertTrue(os.path.islink(self.path(link)))
            self.assertGreater(os.path.getsize(self.path(file)), 100)
        self.assertEqual(os.stat(self.path("a.png")).st_mode & 0o777, 0o640)

    def test_no_file(self):
        """What cannot be written is refused before anything is read."""
        os.mkdir(self.path("folder.png"))
        os.symlink("/dev/null", self.path("null.png"))
        os.symlink("/dev/full", self.path("full.ogv"))
        turn = ("--rotate", "2")
        for name, words, told in (("folder.png", (), "folder.png"), ("null.png", (), "null.png"),
                                  ("no/v.nii", (), "no/v.nii"), ("no/a.png", turn, "no/a-00000.png"),
                                  ("full.ogv", turn, "full.ogv"), ("no/a.ogv", turn, "no/a.ogv")):
            self.assert_refused("missing.vti", "--output", name, *words, words=told + ": this cannot be written")
        for name, words, told in (("", (), "the name of a file is missing"), ("a.jpg", (), ".png"),
                                  ("a.ogv", (), ".png"), ("a.jpg", turn, ".ogv"), ("v.nii", turn, ".ogv")):
            self.assert_refused("--output", name, *words, words=told, code=2)
        self.assert_refused("missing.vti", "--output", "a.png", words="no such file")

    def test_part_of_series(self):
        """If one of several pictures cannot be replaced, the error names it."""
        arguments = ("--rotate", "60", "--output", "a.png", "--size", "300x300", "--mode", "preview")
        self.run_well(*arguments)
        with subprocess.Popen([splatmip.PROGRAM, *arguments], cwd=self.scratch.name, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True) as program:
            while not self.find_sizes(".splatmip"):
                self.assertIsNone(program.poll())
            os.remove(self.path("a-00001.png"))
            os.mkdir(self.path("a-00001.png"))
            message = program.stderr.read()
        self.assertEqual(program.returncode, 1)
        self.assertIn("a-00001.png: this could not be replaced, but the files before it were written;", message)
        self.assertEqual(self.find_sizes(".splatmip"), [])


class TestValueFiles(splatmip.SplatmipTest):
    def write_volume(self):
        """A cube of 5 voxels of -321 in an oblique stack of -900; its centre, and the stack's."""
        values = numpy.full((20, 15, 13), -900, numpy.int16)
        values[6:11, 2:7, 3:8] = -321
        turn = vtk.vtkTransform()
        turn.RotateWXYZ(50, 1, 2, 3)
        steps = numpy.array([turn.TransformVector(*axis) for axis in numpy.eye(3)]).T * (1.5, 1, 2)
        places = numpy.column_stack((steps, (12, -34, 56)))
        splatmip.write_meta(self.path("a.mha"), values, places)
        return places @ (5, 4, 8, 1), places @ (6, 7, 9.5, 1)

    def test_places(self):
        """Values and places are the patient's: the cube lies behind its picture."""
        cube, _ = self.write_volume()
        for name, words in (("v.nii", ()), ("v.nii.gz", ("--view", "anterior", "--mode", "high")),
                            ("v.mha", ("--azimuth", "70", "--elevation", "-25", "--roll", "40"))):
            text = self.run_well(self.path("a.mha"), "--output", name, "--size", "90x120", *words)
            self.assertEqual(text.splitlines()[-1], "values: " + self.path(name))
            values, matrix = splatmip.read_values(self.path(name))
            self.assertEqual(values.shape, (120, 90))
            self.assertLess(abs(numpy.nanmax(values) + 321), 1)
            self.assertLess(abs(numpy.nanmin(values) + 900), 1)
            self.assertTrue(numpy.isnan(values[0, 0]))
            rows, columns = numpy.nonzero(numpy.nan_to_num(values, nan=-900) > -600)
            aside = cube - (matrix @ [columns.mean(), rows.mean(), 0, 1])[:3]
            away = matrix[:3, 2] / numpy.linalg.norm(matrix[:3, 2])
            aside -= (aside @ away) * away
            self.assertLess(numpy.linalg.norm(aside), numpy.linalg.norm(matrix[:3, 0]))
        self.run_well(self.path("v.nii.gz"), "--view", "left", "--output", "a.png")

    def test_slab(self):
        """The picture of a slab lies in the slab's middle, as thick as it; bits are kept."""
        _, middle = self.write_volume()
        for offset in (0, 4, -3):
            planes = []
            for name in ("v.mha", "v.nii"):
                self.run_well(self.path("a.mha"), "--output", name, "--view", "left", "--mode", "exact", "--slab",
                              "5", "--slab-offset", offset, "--size", "64x64")
                planes.append(splatmip.read_values(self.path(name)))
                matrix = planes[-1][1]
                self.assertAlmostEqual(numpy.linalg.norm(matrix[:3, 2]), 5, 5)
                found = (matrix @ [31.5, 31.5, 0, 1])[:3]
                self.assertLess(abs(found - middle - [offset, 0, 0]).max(), 1e-4)
            self.assertTrue(numpy.array_equal(planes[0][0], planes[1][0], equal_nan=True))
            # NIfTI keeps numbers in single precision.
            self.assertLess(abs(planes[0][1] - planes[1][1]).max(), 100 * 2 ** -23)

    def test_tiff(self):
        """The values and the size of pixels; the text says that the place is lost."""
        self.write_volume()
        options = ("--view", "left", "--mode", "exact", "--size", "50x64")
        self.run_well(self.path("a.mha"), "--output", "v.mha", *options)
        expected, matrix = splatmip.read_values(self.path("v.mha"))
        for name in ("v.tif", "v.tiff"):
            text = self.run_well(self.path("a.mha"), "--output", name, *options)
            self.assertIn("TIFF holds the size of a pixel, but not where", text)
            reader = vtk.vtkTIFFReader()
            reader.SetFileName(self.path(name))
            reader.Update()
            # The first row of the file is the top one, which VTK's reader leaves first.
            values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(64, 50)[::-1]
            self.assertEqual(values.dtype, numpy.float32)
            self.assertTrue(numpy.array_equal(values, expected, equal_nan=True))
            data, tags = splatmip.read_file(self.path(name)), {}
            start = struct.unpack_from("<I", data, 4)[0]
            for n in range(struct.unpack_from("<H", data, start)[0]):
                tag, _, _, value = struct.unpack_from("<HHII", data, start + 2 + 12 * n)
                tags[tag] = value
            above, below = struct.unpack_from("<II", data, tags[282])  # pixels per cm
            self.assertEqual(tags[296] & 0xFFFF, 3)
            self.assertLess(abs(above / below * numpy.linalg.norm(matrix[:3, 0]) / 10 - 1), 1e-5)


if __name__ == "__main__":
    splatmip.main()
