# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Beside another VTK than the one that it was built for, the package refuses to be imported."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import vtkmodules
from vtkmodules.vtkCommonCore import vtkVersion

# Importing the package here would already be what is tested.
PACKAGE = next(
    folder for entry in sys.path if (folder := pathlib.Path(entry, "vtksplattingmip")).is_dir()
)
VTK_FOLDER = os.path.dirname(vtkmodules.__file__)
VTK_VERSION = vtkVersion.GetVTKVersion()

PROGRAM = """
import sys
try:
    {statement}
except ImportError as error:
    print(error)
else:
    print("imported")
print("SplattingMIP" in open("/proc/self/maps", encoding="utf-8").read())
"""


def outcome(folder, statement):
    """What a new process prints that has the folder on its path: the error, whether a library is loaded."""
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(statement=statement)],
        env={**os.environ, "PYTHONPATH": str(folder)},
        capture_output=True,
        text=True,
        check=True,
    )
    return run.stdout.splitlines()


class TestOtherVTK(unittest.TestCase):
    def outcome_if_built_for(self, name, value, statement):
        """What a copy of the package does that has another value in one variable."""
        with tempfile.TemporaryDirectory() as folder:
            copy = shutil.copytree(PACKAGE, pathlib.Path(folder, "vtksplattingmip"))
            text = (copy / "__init__.py").read_text()
            text, count = re.subn(rf'^{name} = ".+"', f'{name} = "{value}"', text, flags=re.M)
            self.assertEqual(count, 1)
            (copy / "__init__.py").write_text(text)
            return outcome(folder, statement)

    def test_other_version(self):
        sentence = (
            f"vtksplattingmip is built for VTK 9.1.99, but {VTK_FOLDER} is VTK {VTK_VERSION}: install "
            f"VTK 9.1.99 there, or a vtksplattingmip that is built for VTK {VTK_VERSION}."
        )
        for statement in (
            "import vtksplattingmip",
            "from vtksplattingmip import vtkSplattingMIPProjection",
            "import vtksplattingmip.vtkImagingSplattingMIP",
        ):
            self.assertEqual(
                self.outcome_if_built_for("_VTK_VERSION", "9.1.99", statement), [sentence, "False"]
            )

    @unittest.skipUnless(sys.platform == "linux", "libraries are looked for on Linux only")
    def test_other_build_of_the_version(self):
        # It exists, but looking for it must not load it.
        library = next(PACKAGE.glob("vtkImagingSplattingMIP*.so"))
        sentence = (
            f"vtksplattingmip is built for the VTK {VTK_VERSION} that has {library}, but {VTK_FOLDER} is "
            f"another build of VTK {VTK_VERSION}: use that VTK, or build vtksplattingmip for this one."
        )
        self.assertEqual(
            self.outcome_if_built_for("_VTK_LIBRARY", library, "import vtksplattingmip"),
            [sentence, "False"],
        )

    def test_this_vtk(self):
        self.assertEqual(outcome(PACKAGE.parent, "import vtksplattingmip"), ["imported", "False"])
        self.assertEqual(
            outcome(PACKAGE.parent, "from vtksplattingmip import vtkSplattingMIPProjection"),
            ["imported", "True"],
        )


if __name__ == "__main__":
    unittest.main()
