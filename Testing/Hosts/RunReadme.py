# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""The README's lines for Python do what it says. Each program runs in a process of its own.

    RunReadme.py README [PROGRAM ...]

Prints a line for each check; fails if one does.
"""

import pathlib
import re
import subprocess
import sys

ARRAY = "import numpy; array = numpy.random.default_rng(3).integers(0, 255, (20, 24, 28), numpy.uint8)"
LOG = """
import sys, vtksplattingmip
logger = vtksplattingmip._vtk_module("vtkCommonCore").vtkLogger
logger.SetStderrVerbosity(logger.VERBOSITY_1)
"""
# Of each program: what precedes its lines, and what follows them. "splats" expects VTK's log to say so.
PROGRAMS = {
    "mip": (ARRAY, "assert (picture == array.max(axis=1)).all() and oblique.ndim == 2", False),
    "PyVista": (
        ARRAY + LOG + """
import pyvista
plotter = pyvista.Plotter(off_screen=True)
volume = pyvista.wrap(array)
""",
        "plotter.show(); vtksplattingmip.use_for(actor); vtksplattingmip.disable()",
        True,
    ),
    "vedo": (
        ARRAY + LOG + """
import vedo
plotter = vedo.Plotter(offscreen=True)
""",
        "",
        True,
    ),
    "trame": (
        ARRAY + LOG + """
from trame.app import get_server
from trame.ui.html import DivLayout
from trame.widgets import vtk
import pyvista
plotter = pyvista.Plotter(off_screen=True)
render_window = plotter.render_window
server = get_server()
layout = DivLayout(server)
layout.__enter__()
""",
        """
plotter.add_volume(pyvista.wrap(array), blending="maximum", mapper="smart")
view.update()
render_window.Render()
""",
        True,
    ),
    "napari": (
        ARRAY + """
from napari.components import ViewerModel
viewer = ViewerModel()
viewer.add_image(array, name="volume", scale=(3, 1, 1))
""",
        "assert (viewer.layers[-1].data == array.max(axis=0)).all()",
        False,
    ),
}


def blocks(readme):
    """The lines of each program, which follow a paragraph that begins with its name."""
    section = readme.split("**In Python.**")[1].split("**Without OpenGL.**")[0]
    found = dict(re.findall(r"\n\n[^\n]*?(mip|PyVista|vedo|trame|napari)[^\n]*\n\n```python\n(.*?)```", section, re.S))
    assert set(found) == set(PROGRAMS), found
    return found


failures = 0
lines = blocks(pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"))
for program in sys.argv[2:] or PROGRAMS:
    before, after, splats = PROGRAMS[program]
    run = subprocess.run(
        [sys.executable, "-c", f"{before}\n{lines[program]}\n{after}"], capture_output=True, text=True
    )
    passed = run.returncode == 0 and (
        not splats or "renders by vtkSplattingMIPVolumeMapper" in run.stdout + run.stderr
    )
    print("ok:" if passed else "FAILED:", f"the README's lines for {program}")
    if not passed:
        print(run.stdout[-2000:], run.stderr[-3000:])
        failures += 1
sys.exit(failures)
