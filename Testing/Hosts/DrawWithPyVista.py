# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""PyVista draws maxima along the three axes, and they are NumPy's.

    DrawWithPyVista.py FOLDER

Writes pictures and VTK's log into the folder. Prints a line for each check; fails if one does.
"""

import pathlib
import re
import sys

import numpy
import pyvista
import vtksplattingmip

SIZE = (28, 24, 20)  # of the volume in x, y and z
PIXELS = 9  # along a voxel's side: an odd number, so that a pixel's ray meets the voxel's centre
SPLATTED = "renders by vtkSplattingMIPVolumeMapper."
FOLDER = pathlib.Path(sys.argv[1])

failures = []


def check(what, passed):
    print("ok:" if passed else "FAILED:", what)
    if not passed:
        failures.append(what)


def picture(volume, view, right, up, one_volume):
    """The gray picture of the maximum in a view of which axes of the volume lie to the right and upward."""
    image = pyvista.ImageData(dimensions=SIZE)
    image.point_data["scalars"] = volume.ravel()  # x runs fastest
    plotter = pyvista.Plotter(
        off_screen=True, window_size=(PIXELS * SIZE[right], PIXELS * SIZE[up])
    )
    plotter.background_color = "black"
    actor = plotter.add_volume(
        image,
        blending="maximum",
        mapper="smart",
        cmap="gray",
        clim=(0, 255),
        opacity=[1.0, 1.0],
        show_scalar_bar=False,
    )
    if one_volume:
        vtksplattingmip.use_for(actor, "preview")
    getattr(plotter, view)()
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = SIZE[up] / 2
    pixels = plotter.screenshot(FOLDER / f"{view}.png")
    plotter.close()
    return pixels[::-1, :, 0].astype(int)  # the lowest row first


def check_pictures(what, one_volume=False):
    # Most values are small, so that the maxima of 20 and more differ much.
    volume = (256 * numpy.random.default_rng().random(SIZE[::-1]) ** 20).astype(numpy.uint8)
    for view, right, up, along in (("view_xy", 0, 1, 2), ("view_xz", 0, 2, 1), ("view_yz", 1, 2, 0)):
        found = picture(volume, view, right, up, one_volume)[PIXELS // 2 :: PIXELS, PIXELS // 2 :: PIXELS]
        expected = volume.max(axis=2 - along)  # NumPy's axes are z, y, x
        # A colour is looked up in a table and rounded to a byte, each by half a level at most.
        error = abs(found - expected)[1:-1, 1:-1].max()
        check(f"{what}, along axis {along}, draws NumPy's maximum (largest difference {error})", error <= 1)


vtkLogger = vtksplattingmip._vtk_module("vtkCommonCore").vtkLogger
log = FOLDER / "log.txt"
vtkLogger.SetInternalVerbosityLevel(vtkLogger.VERBOSITY_1)
vtkLogger.LogToFile(str(log), vtkLogger.TRUNCATE, vtkLogger.VERBOSITY_1)
vtksplattingmip.enable("preview")
check_pictures("enable()")
vtksplattingmip.disable()
vtkLogger.EndLogToFile(str(log))
renderers = re.findall(r"renders by .*", log.read_text())
check(
    f"the log says that {len(renderers)} renders were by the splatting mapper",
    len(renderers) >= 3 and set(renderers) == {SPLATTED},
)
check_pictures("use_for()", one_volume=True)
maps = pathlib.Path("/proc/self/maps").read_text()
foreign = {line for line in re.findall(r"/\S*libvtk\S*", maps) if not line.startswith(sys.prefix)}
check(f"all of VTK comes from the environment ({sorted(foreign)} does not)", not foreign)
packages = set(re.findall(r"/(cvista|vtkmodules)/libvtk", maps))
check(f"there is one VTK ({', '.join(sorted(packages))})", len(packages) == 1)
sys.exit(len(failures))
