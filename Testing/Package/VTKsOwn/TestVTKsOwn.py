# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""VTK's own tests of its projections pass with these splatted, by VTK's measure, against the pictures
that VTK draws without.

    TestVTKsOwn.py AUTOLOAD_FOLDER PROGRAM
"""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SPLATTED = "renders by vtkSplattingMIPVolumeMapper."
WHO_RENDERS = {
    "TestGPURayCastBlendModes": SPLATTED,
    "TestGPURayCastCompositeToMIP": SPLATTED,
    "TestGPURayCastMIPToComposite": SPLATTED,
    "TestGPURayCastDepthPeelingBlendModes": "because a render pass brings shader code.",
}


def run(name, picture, folder, **environment):
    """Compares with the picture, or, where there is none, writes one of that name to the folder."""
    return subprocess.run(
        [str(PROGRAM), name, "-D", folder, "-T", folder, "-V", str(picture)],
        env=dict(os.environ, VTK_TESTING="1", **environment),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
    )


class TestVTKsOwn(unittest.TestCase):
    def test_pictures(self):
        for name, who in WHO_RENDERS.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                picture, log = Path(folder, name + ".png"), Path(folder, "log")
                run(name, Path(folder, "none", name + ".png"), folder)
                self.assertTrue(picture.exists(), "VTK's own picture.")
                done = run(
                    name,
                    picture,
                    folder,
                    VTK_AUTOLOAD_PATH=str(FOLDER),
                    SPLATTINGMIP_LOG=str(log),
                )
                self.assertEqual(done.returncode, 0, done.stdout)
                self.assertIn(who, log.read_text())


if __name__ == "__main__":
    FOLDER, PROGRAM = map(Path, sys.argv[1:3])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
