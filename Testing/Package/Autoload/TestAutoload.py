# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Programs that know nothing of this project render projections through it, and nothing else.

    TestAutoload.py INSTALLED_FOLDER PROGRAM GATES

The installed folder for VTK_AUTOLOAD_PATH, the built program.cxx, and a folder that has folders with
gates that were built for other VTKs.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

HERE = Path(__file__).parent
VEDO_EXAMPLE = Path(
    "/usr/share/doc/python3-vedo-examples/examples/volumetric/volume_sharemap.py"
)
COMPOSITE, MAXIMUM, MINIMUM, AVERAGE = range(4)

sys.path.insert(0, str(HERE))
from script import picture  # noqa: E402
from vtkmodules.vtkCommonCore import vtkVersion  # noqa: E402
from vtksplattingmip import vtkSplattingMIPVolumeMapper  # noqa: E402

SPLATTED = "renders by vtkSplattingMIPVolumeMapper."
LEFT_TO_VTK = "renders by vtkOpenGLGPUVolumeRayCastMapper, because the blend mode"


def splatted(mode, quality="Exact"):
    """What the splatting mapper itself shows."""
    mapper = vtkSplattingMIPVolumeMapper()
    getattr(mapper, f"SetQualityModeTo{quality}")()
    return picture(mapper, mode)


class Run:
    """A finished program: its pixels, log and messages."""

    def __init__(self, command, folder=None, **environment):
        with tempfile.TemporaryDirectory() as scratch:
            pixels, log = Path(scratch, "pixels"), Path(scratch, "log")
            surroundings = dict(os.environ, **environment)
            if folder:
                surroundings["VTK_AUTOLOAD_PATH"] = str(folder)
                surroundings["SPLATTINGMIP_LOG"] = str(log)
            # Nothing of the project but the folder is in sight.
            surroundings.pop("PYTHONPATH", None)
            done = subprocess.run(
                [*command, str(pixels)],
                env=surroundings,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=120,
            )
            self.code, self.messages = done.returncode, done.stdout
            self.pixels = pixels.read_bytes() if pixels.exists() else b""
            self.log = log.read_text() if log.exists() else ""


class TestAutoload(unittest.TestCase):
    def programs(self, mode):
        yield [str(PROGRAM), str(mode)]
        yield [sys.executable, str(HERE / "script.py"), str(mode)]

    def run_silently(self, *arguments, **environment):
        run = Run(*arguments, **environment)
        self.assertEqual((run.code, run.messages), (0, ""))
        self.assertGreater(max(run.pixels), 100)
        return run

    def test_projections_are_splatted(self):
        for mode in (MAXIMUM, MINIMUM):
            expected = splatted(mode)
            for command in self.programs(mode):
                self.assertNotEqual(self.run_silently(command).pixels, expected)
                run = self.run_silently(command, FOLDER)
                self.assertEqual(run.pixels, expected, f"{command}")
                self.assertIn(SPLATTED, run.log)

    def test_the_rest_is_left_to_vtk(self):
        for mode in (COMPOSITE, AVERAGE):
            for command in self.programs(mode):
                run = self.run_silently(command, FOLDER)
                self.assertEqual(run.pixels, self.run_silently(command).pixels, f"{command}")
                self.assertIn(LEFT_TO_VTK, run.log)

    def test_quality(self):
        command = [str(PROGRAM), str(MAXIMUM)]
        for quality in ("Preview", "Standard", "High", "Exact"):
            run = self.run_silently(command, FOLDER, SPLATTINGMIP_QUALITY=quality.lower())
            self.assertEqual(run.pixels, splatted(MAXIMUM, quality), quality)
        self.assertEqual(
            self.run_silently(command, FOLDER, SPLATTINGMIP_QUALITY="").pixels, run.pixels
        )
        run = Run(command, FOLDER, SPLATTINGMIP_QUALITY="best")
        self.assertEqual(run.pixels, splatted(MAXIMUM))
        self.assertIn('SPLATTINGMIP_QUALITY is "best", which is taken as exact', run.messages)

    def test_log_that_cannot_be_written(self):
        """No folder is made for it, the program is told, and is splatted for all the same."""
        with tempfile.TemporaryDirectory() as scratch:
            log = Path(scratch, "missing", "log")
            pixels = Path(scratch, "pixels")
            done = subprocess.run(
                [str(PROGRAM), str(MAXIMUM), str(pixels)],
                env=dict(os.environ, VTK_AUTOLOAD_PATH=str(FOLDER), SPLATTINGMIP_LOG=str(log)),
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=120,
            )
            self.assertEqual(done.returncode, 0, done.stdout)
            self.assertFalse(log.parent.exists())
            self.assertEqual(done.stdout.count("SPLATTINGMIP_LOG"), 1, done.stdout)
            self.assertIn("name a file in a folder that is there", done.stdout)
            self.assertEqual(pixels.read_bytes(), splatted(MAXIMUM))

    def refused(self, folder):
        """Returns what VTK says; the program goes on as without the folder."""
        for command in self.programs(MAXIMUM):
            run = Run(command, folder)
            self.assertEqual(run.code, 0, run.messages)
            self.assertIn("Incompatible factory rejected", run.messages)
            self.assertIn(f"Running VTK version: {vtkVersion.GetVTKSourceVersion()}\n", run.messages)
            self.assertEqual(run.pixels, Run(command).pixels)
            self.assertEqual(run.log, "")
        return run.messages

    def test_another_version(self):
        self.assertIn(
            "Factory version: vtk version 9.99.0 in libvtkCommonCore-9.99.so.1\n",
            self.refused(GATES / "AnotherVersion"),
        )

    def test_another_library_of_the_same_version(self):
        self.assertIn(
            f"Factory version: {vtkVersion.GetVTKSourceVersion()} in libvtkCommonCore-mine.so\n",
            self.refused(GATES / "AnotherLibrary"),
        )

    def test_gate_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            for library in Path(FOLDER).iterdir():
                shutil.copy(library, folder)
            self.assertIn("libSplattingMIPFactory.so: cannot open", self.refused(folder))

    def test_gate_is_alone_in_its_folder(self):
        self.assertEqual([file.suffix for file in FOLDER.iterdir()], [".so"])

    def test_switched_off_by_a_program_that_knows_the_module(self):
        code = (
            "from vtksplattingmip import vtkSplattingMIPGPUVolumeRayCastMapper as Override\n"
            "from vtkmodules.vtkRenderingVolume import vtkGPUVolumeRayCastMapper\n"
            "names = [vtkGPUVolumeRayCastMapper().GetClassName()]\n"
            "Override.GlobalOverrideOff()\n"
            "names.append(vtkGPUVolumeRayCastMapper().GetClassName())\n"
            "print(*names)\n"
        )
        done = subprocess.run(
            [sys.executable, "-c", code],
            env=dict(os.environ, VTK_AUTOLOAD_PATH=str(FOLDER)),
            stdout=subprocess.PIPE,
            text=True,
            check=True,
        )
        self.assertEqual(
            done.stdout.split(),
            ["vtkSplattingMIPGPUVolumeRayCastMapper", "vtkOpenGLGPUVolumeRayCastMapper"],
        )


@unittest.skipUnless(
    importlib.util.find_spec("vedo"), "There is no vedo: install python3-vedo."
)
class TestAutoloadVedo(unittest.TestCase):
    def test_vedo(self):
        command = [sys.executable, str(HERE / "vedo_script.py")]
        plain = Run(command)
        self.assertEqual(plain.code, 0, plain.messages)
        run = Run(command, FOLDER)
        self.assertEqual(run.code, 0, run.messages)
        self.assertIn(SPLATTED, run.log)
        # They differ by what averages differ from samples, about a twentieth of the contrast; an
        # empty picture would differ by all of it.
        self.assertNotEqual(run.pixels, plain.pixels)
        difference = sum(abs(a - b) for a, b in zip(run.pixels, plain.pixels)) / len(plain.pixels)
        contrast = sum(abs(a - plain.pixels[0]) for a in plain.pixels) / len(plain.pixels)
        self.assertLess(difference, 0.1 * contrast)


@unittest.skipUnless(
    VEDO_EXAMPLE.exists(),
    f"There is no {VEDO_EXAMPLE}: install python3-vedo-examples, documentation included.",
)
class TestAutoloadVedoExample(unittest.TestCase):
    def test_example(self):
        """It opens a window with two volumes and stays there."""
        with tempfile.TemporaryDirectory() as scratch:
            log = Path(scratch, "log")
            environment = dict(
                os.environ, VTK_AUTOLOAD_PATH=str(FOLDER), SPLATTINGMIP_LOG=str(log)
            )
            environment.pop("PYTHONPATH", None)
            with subprocess.Popen([sys.executable, str(VEDO_EXAMPLE)], env=environment) as example:
                end = time.monotonic() + 60
                lines = []
                while len(lines) < 2 and example.poll() is None and time.monotonic() < end:
                    time.sleep(0.1)
                    text = log.read_text() if log.exists() else ""
                    lines = [line for line in text.splitlines() if SPLATTED in line]
                example.kill()
            self.assertEqual(len(lines), 2)


if __name__ == "__main__":
    FOLDER, PROGRAM, GATES = map(Path, sys.argv[1:4])
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
