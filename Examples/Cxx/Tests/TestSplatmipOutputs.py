# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Outputs are written completely or not at all, and never replace an input."""
import os
import resource
import shutil
import signal
import subprocess
import time

import DICOMFiles as dicom
import SplatmipTesting as splatmip

SMALL = ("--size", "96x96", "--mode", "preview")


class TestInputs(splatmip.SplatmipTest):
    def assert_kept(self, source, output, *arguments):
        """The program refuses to replace a file that it reads, and leaves its folder as it is."""
        output = self.path(output)
        with open(output, "rb") as file:
            data = file.read()
        names = sorted(os.listdir(self.scratch.name))
        self.assert_refused(source, "--output", output, *arguments, word="one of the files to read")
        with open(output, "rb") as file:
            self.assertEqual(file.read(), data)
        self.assertEqual(sorted(os.listdir(self.scratch.name)), names)

    def test_input(self):
        for path in (splatmip.write_nifti(self.path("a.nii.gz")),
                     splatmip.write_meta(self.path("a.mha"))):
            self.assert_kept(path, path)
        path = splatmip.write_file(self.path("text.nii"), b"This is told before it is read.")
        self.assert_kept(path, path)

    def test_links(self):
        path = splatmip.write_nifti(self.path("a.nii"))
        os.symlink("a.nii", self.path("soft.nii"))
        os.link(path, self.path("hard.nii"))
        os.mkdir(self.path("folder"))
        for output in ("soft.nii", "hard.nii", "folder/../a.nii"):
            self.assert_kept(path, output)
        self.assert_kept(self.path("soft.nii"), "a.nii")

    def test_mask(self):
        mask = splatmip.write_meta(self.path("m.mha"))
        self.assert_kept(splatmip.write_vti(self.path("a.vti")), mask, "--mask", mask)

    def test_companion(self):
        """A header and its data are two files."""
        path = splatmip.write_nrrd(self.path("a.nhdr"))
        os.rename(path + ".raw", self.path("data.nii"))
        with open(path, "r+b") as file:
            header = file.read().replace(b"a.nhdr.raw", b"data.nii")
            file.seek(0)
            file.write(header)
            file.truncate()
        self.draw_block(path)
        self.assert_kept(path, "data.nii")

    def test_dicom(self):
        """A slice, one of another series, and the file of which the others are found."""
        slices = dicom.make_slices()
        folder = dicom.write_series(self.path("series"), slices)
        other = {**slices[0], "SeriesInstanceUID": dicom.ROOT + ".5",
                 "SOPInstanceUID": dicom.ROOT + ".6"}
        dicom.write_object(self.path("series/other.dcm"), other)
        self.assert_kept(folder, "series/" + dicom.name_of(3), "--rotate", "2")
        self.assert_kept(folder, "series/other.dcm", "--rotate", "2")
        self.assert_kept(self.path("series/" + dicom.name_of(3)), "series/" + dicom.name_of(5),
                         "--rotate", "2")

    def test_numbered(self):
        """DICOM files may have any name."""
        folder = dicom.write_series(self.path("series"), dicom.make_slices())
        os.rename(os.path.join(folder, dicom.name_of(3)), self.path("series/a-00001.png"))
        names = sorted(os.listdir(folder))
        self.assert_refused(folder, "--rotate", "2", "--output", self.path("series/a.png"),
                            word="a-00001.png: this is one of the files to read")
        self.assertEqual(sorted(os.listdir(folder)), names)

    def test_no_name(self):
        self.assert_refused("--output", "", word="the name of a file is missing", code=2)


class TestComplete(splatmip.SplatmipTest):
    KINDS = (("a.png", ()), ("a.mha", ()), ("a.nii", ()), ("a.nii.gz", ()), ("a.tif", ()),
             ("a.ogv", ("--rotate", "4")), ("a.dcm", ("--rotate", "4")),
             ("a.png", ("--rotate", "4")))

    def run_with_limit(self, size, *arguments):
        """As on a disk where only so many bytes of a file fit."""
        return subprocess.run(
            [splatmip.PROGRAM, *arguments], cwd=self.scratch.name, capture_output=True, text=True,
            timeout=300, check=False, restore_signals=False,  # SIGXFSZ remains ignored
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))

    def test_full_disk(self):
        """An error, exit status 1, and the older file remains."""
        for name, words in self.KINDS:
            os.makedirs(self.path("out"), exist_ok=True)
            options = ("--output", "out/" + name, *SMALL, *words)
            result = self.run_program(*options)
            self.assertEqual((result.returncode, result.stderr), (0, ""), name)
            sizes = {file: os.path.getsize(self.path("out/" + file))
                     for file in os.listdir(self.path("out"))}
            self.assertGreater(min(sizes.values()), 0)
            for part in (0, 0.3, 0.9):
                # the program's own limit must not stop the older file from being larger
                result = self.run_with_limit(int(part * max(sizes.values())), *options)
                self.assertEqual(result.returncode, 1, (name, part, result.stdout))
                self.assertRegex(result.stderr, r"^splatmip: .*could not be written completely.*\n$")
                self.assertEqual({file: os.path.getsize(self.path("out/" + file))
                                  for file in os.listdir(self.path("out"))}, sizes)
            shutil.rmtree(self.path("out"))
            os.makedirs(self.path("out"))
            result = self.run_with_limit(int(0.5 * max(sizes.values())), *options)
            self.assertEqual((result.returncode, os.listdir(self.path("out"))), (1, []))

    def find_sizes(self, prefix):
        """The sizes above 0 of files with such names."""
        sizes = []
        for entry in os.scandir(self.scratch.name):
            try:
                sizes.append(entry.name.startswith(prefix) and entry.stat().st_size)
            except FileNotFoundError:
                pass
        return list(filter(None, sizes))

    def test_interrupt(self):
        """Nothing remains of a film that is interrupted while it is written."""
        splatmip.write_file(self.path("a.ogv"), b"older")
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with subprocess.Popen([splatmip.PROGRAM, "--rotate", "120", "--size", "400x600",
                                   "--mode", "preview", "--output", "a.ogv"],
                                  cwd=self.scratch.name, stdout=subprocess.DEVNULL) as program:
                while not self.find_sizes(".splatmip"):
                    self.assertIsNone(program.poll())
                    time.sleep(0.001)
                program.send_signal(number)
            self.assertEqual(program.returncode, -number)
            self.assertEqual(os.listdir(self.scratch.name), ["a.ogv"])
            with open(self.path("a.ogv"), "rb") as file:
                self.assertEqual(file.read(), b"older")

    def test_replaced(self):
        """A link remains a link, and a file keeps its permissions."""
        splatmip.write_file(self.path("a.png"), b"older")
        os.chmod(self.path("a.png"), 0o640)
        os.symlink("a.png", self.path("link.png"))
        self.draw("--output", "link.png", *SMALL)
        self.assertTrue(os.path.islink(self.path("link.png")))
        self.assertEqual(os.stat(self.path("a.png")).st_mode & 0o777, 0o640)
        self.assertGreater(os.path.getsize(self.path("a.png")), 100)

    def test_no_file(self):
        os.mkdir(self.path("folder.png"))
        os.symlink("/dev/null", self.path("null.png"))
        for name in ("folder.png", "null.png"):
            self.assert_refused("--output", name, word=name + ": this cannot be written")


if __name__ == "__main__":
    splatmip.main()
