#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""The rotating MIP that nuclear medicine reads PET scans by, of a phantom: uptake is black.

    python3 rotating_mip.py [--views 24] [--output FOLDER]

Writes one PNG picture per angle; needs neither a display nor OpenGL.
"""
import argparse
import pathlib
import time

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtksplattingmip import mip

SPACING = (4.0, 4.0, 4.0)  # mm, as PET scanners have it
# Standardised uptake value, middle and half axes in voxels (x to the patient's left, y to the back,
# z to the head).
ORGANS = [
    (1.0, (72, 50, 110), (46, 26, 112)),  # body
    (0.4, (52, 50, 140), (14, 16, 34)),  # lungs
    (0.4, (92, 50, 140), (14, 16, 34)),
    (2.2, (56, 48, 98), (22, 18, 15)),  # liver
    (4.0, (80, 44, 128), (10, 9, 10)),  # heart
    (7.0, (72, 50, 208), (17, 20, 13)),  # brain
    (5.0, (50, 62, 78), (6, 6, 10)),  # kidneys
    (5.0, (94, 62, 78), (6, 6, 10)),
    (20.0, (72, 42, 24), (9, 9, 8)),  # bladder
    (9.0, (97, 56, 150), (3, 3, 3)),  # a lesion
]


def phantom():
    """Uptake[z, y, x], with the noise that makes maxima grow with depth."""
    z, y, x = numpy.ogrid[:220, :100, :144]
    uptake = numpy.zeros((220, 100, 144), numpy.float32)
    for value, (cx, cy, cz), (rx, ry, rz) in ORGANS:
        inside = ((x - cx) / rx) ** 2 + ((y - cy) / ry) ** 2 + ((z - cz) / rz) ** 2 <= 1.0
        uptake[inside] = value
    noise = numpy.random.default_rng(1).standard_normal(uptake.shape, numpy.float32)
    return uptake * (1.0 + 0.1 * noise)


def write_png(picture, path):
    """Bytes[row, column], the top row first."""
    image = vtkImageData()
    image.SetDimensions(picture.shape[1], picture.shape[0], 1)
    flipped = numpy.ascontiguousarray(picture[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(flipped.ravel()))
    writer = vtkPNGWriter()
    writer.SetInputData(image)
    writer.SetFileName(str(path))
    writer.Write()


parser = argparse.ArgumentParser(description="Rotating maximum intensity projection of a PET phantom")
parser.add_argument("--views", type=int, default=24)
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("rotating-mip"))
arguments = parser.parse_args()
arguments.output.mkdir(parents=True, exist_ok=True)

volume = phantom()
start = time.perf_counter()
pictures = mip(volume, SPACING, (0, 1, 0), up=(1, 0, 0), views=arguments.views)
seconds = time.perf_counter() - start
print(f"{arguments.views} views of {volume.shape} in {seconds:.2f} s, SUV up to {pictures.max():.1f}")
gray = (255.0 - numpy.clip(pictures / 8.0, 0.0, 1.0) * 255.0).astype(numpy.uint8)
for n, one in enumerate(gray):
    write_png(one, arguments.output / f"{n:03}.png")
print("pictures:", (arguments.output / "*.png").resolve())
