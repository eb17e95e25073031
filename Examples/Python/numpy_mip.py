#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Maximum intensity projections from NumPy to NumPy; needs neither a display nor OpenGL."""
import numpy
from vtksplattingmip import mip

dot = numpy.full((40, 50, 60), -1000, numpy.int16)  # air, in Hounsfield units
dot[18:23, 22:27, 27:32] = 700
spacing = (2.0, 0.7, 0.7)  # of slices, rows and columns, in millimetres

front = mip(dot, spacing, direction=1)  # the same as dot.max(axis=1)
oblique = mip(dot, spacing, direction=(0.2, -1, 0.5), shape=(256, 256))
turn = mip(dot, spacing, direction=1, mode="preview", views=36)
for pictures in front, oblique, turn:
    print("pictures:", pictures.shape, pictures.dtype, "from", pictures.min(), "to", pictures.max())
