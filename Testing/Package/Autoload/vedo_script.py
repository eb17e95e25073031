# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""vedo_script.py FILE

Renders a maximum intensity projection with vedo and writes the pixels.
"""

import sys

import numpy
from vedo import Plotter, Volume

axis = numpy.linspace(-1, 1, 40)
x, y, z = numpy.meshgrid(axis, axis, axis, indexing="ij")
volume = Volume(numpy.exp(-20 * (x * x + (y - z / 2) ** 2))).mode(1).cmap("bone").alpha([0, 1])
plotter = Plotter(offscreen=True, size=(150, 150))
plotter.show(volume, azimuth=30)
with open(sys.argv[1], "wb") as file:
    file.write(plotter.screenshot(asarray=True).tobytes())
