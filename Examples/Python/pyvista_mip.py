#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""PyVista's maximum intensity projections by VTK's GPU mapper, then by the splatting mapper.

    python3 pyvista_mip.py [VOLUME] [--frames 10] [--size 512] [--mode exact] [--output FOLDER]

Reads what pyvista.read() reads; without a file it shows a CT angiogram. Prints the time of a frame.
"""
import argparse
import pathlib
import time

import pyvista
import vtksplattingmip

AORTA = pathlib.Path(__file__).parent.parent / "Data" / "aorta-stent.vti"

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("volume", nargs="?", default=AORTA)
parser.add_argument("--frames", type=int, default=10)
parser.add_argument("--size", type=int, default=512)
parser.add_argument("--mode", default="exact")
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("."))
arguments = parser.parse_args()
volume = pyvista.read(arguments.volume)


def show(name, one_volume=False):
    """Renders a turn, prints the time of a frame, and writes the last frame."""
    plotter = pyvista.Plotter(off_screen=True, window_size=(arguments.size, arguments.size))
    actor = plotter.add_volume(
        volume, blending="maximum", mapper="smart", cmap="gray", opacity="linear", show_scalar_bar=False
    )
    if one_volume:
        vtksplattingmip.use_for(actor, arguments.mode)
    plotter.view_xz()
    plotter.show(auto_close=False)
    start = time.perf_counter()
    for _ in range(arguments.frames):
        plotter.camera.Azimuth(5)
        plotter.render()
        plotter.screenshot()
    milliseconds = 1000 * (time.perf_counter() - start) / arguments.frames
    plotter.screenshot(arguments.output / f"{name}.png")
    plotter.close()
    print(f"{name}: {milliseconds:.1f} ms per frame")


show("before")
vtksplattingmip.enable(arguments.mode)  # all volumes of this process
show("enabled")
vtksplattingmip.disable()
show("one-volume", one_volume=True)
