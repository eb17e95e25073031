#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""
What magnification does to pictures, in all quality modes and by VTK's two ray casters.

    PYTHONPATH=BUILD/lib/python3/dist-packages xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" \
        python3 zoom.py [table ...]

Tables: crest, decibels, voxels, sparkle; all if none is named. Needs NumPy. The modes'
pictures are vtkSplattingMIPProjection's, in float; the ray casters' are a window's, in 255 grays.
"""
import argparse
import time
from pathlib import Path

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtksplattingmip import vtkSplattingMIPProjection

ROOT = Path(__file__).parents[2]
MODES = ("preview", "standard", "high", "exact")
RAY_CASTERS = ("fixed point", "fixed point, 10 per voxel", "GPU")


def image_of(voxels):
    image = vtk.vtkImageData()
    image.SetDimensions(voxels.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(voxels.ravel(), deep=True))
    return image


def voxels_of(path):
    """With cubic voxels: the spacing is left out."""
    reader = {".vti": vtk.vtkXMLImageDataReader, ".vtk": vtk.vtkStructuredPointsReader}[path.suffix]()
    reader.SetFileName(str(path))
    reader.Update()
    output = reader.GetOutput()
    return vtk_to_numpy(output.GetPointData().GetScalars()).reshape(output.GetDimensions()[::-1])


class View:
    """A camera that looks at the middle of a volume with so many screen pixels per voxel."""

    def __init__(self, voxels, direction, size, pixels_per_voxel, view_angle=0.0):
        self.size = size
        self.focus = (numpy.array(voxels.shape[::-1]) - 1) / 2.0
        self.forward = numpy.array(direction) / numpy.linalg.norm(direction)
        self.camera = vtk.vtkCamera()
        height = size / pixels_per_voxel
        self.distance = (0.5 * height / numpy.tan(numpy.radians(0.5 * view_angle))
                         if view_angle else 4.0 * max(voxels.shape))
        self.eye = self.focus - self.distance * self.forward
        self.camera.SetFocalPoint(self.focus)
        self.camera.SetPosition(self.eye)
        self.camera.SetViewUp(0.1, 0.2, 1.0)
        self.camera.OrthogonalizeViewUp()
        self.camera.SetParallelProjection(not view_angle)
        self.camera.SetParallelScale(0.5 * height)
        self.camera.SetViewAngle(view_angle or 30.0)
        self.up = numpy.array(self.camera.GetViewUp())
        self.right = numpy.cross(self.forward, self.up)
        self.pixel = 1.0 / pixels_per_voxel
        self.perspective = bool(view_angle)

    def rays(self, x, y):
        """Points on the rays of pixels, and their directions."""
        x, y = (numpy.asarray(c, float) - (self.size - 1) / 2.0 for c in (x, y))
        points = self.focus + self.pixel * (x[:, None] * self.right + y[:, None] * self.up)
        ways = points - self.eye if self.perspective else numpy.tile(self.forward, (len(x), 1))
        return points, ways / numpy.linalg.norm(ways, axis=1)[:, None]

    def project(self, points):
        """Where points of the volume lie, in pixels."""
        off = points - (self.eye if self.perspective else self.focus)
        scale = self.distance / (off @ self.forward) if self.perspective else 1.0
        middle = (self.size - 1) / 2.0
        return (off @ self.right * scale / self.pixel + middle,
                off @ self.up * scale / self.pixel + middle)


def splat(image, view, mode):
    projection = vtkSplattingMIPProjection()
    projection.SetInputData(image)
    projection.SetCamera(view.camera)
    projection.SetOutputSize(view.size, view.size)
    projection.SetQualityMode(MODES.index(mode))
    projection.SetBackgroundValue(image.GetScalarRange()[0])
    projection.Update()
    return vtk_to_numpy(projection.GetOutput().GetPointData().GetScalars()).reshape(
        view.size, view.size).astype(float)


def ray_cast(image, view, kind):
    """By a window, from grays back to values."""
    low, high = image.GetScalarRange()
    if kind == "GPU":
        mapper = vtk.vtkOpenGLGPUVolumeRayCastMapper()
    else:
        mapper = vtk.vtkFixedPointVolumeRayCastMapper()
        mapper.LockSampleDistanceToInputSpacingOff()
    mapper.AutoAdjustSampleDistancesOff()
    mapper.SetSampleDistance(0.1 if "10" in kind else 1.0)
    mapper.SetInputData(image)
    mapper.SetBlendModeToMaximumIntensity()
    ramp, opaque = vtk.vtkColorTransferFunction(), vtk.vtkPiecewiseFunction()
    ramp.AddRGBPoint(low, 0, 0, 0)
    ramp.AddRGBPoint(high, 1, 1, 1)
    opaque.AddPoint(low, 1)
    opaque.AddPoint(high, 1)
    volume = vtk.vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(ramp)
    volume.GetProperty().SetScalarOpacity(opaque)
    volume.GetProperty().SetInterpolationTypeToLinear()
    renderer, window = vtk.vtkRenderer(), vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(view.size, view.size)
    window.AddRenderer(renderer)
    renderer.AddVolume(volume)
    renderer.SetActiveCamera(view.camera)
    renderer.ResetCameraClippingRange()
    window.Render()
    pixels = vtk.vtkUnsignedCharArray()
    window.GetRGBACharPixelData(0, 0, view.size - 1, view.size - 1, 0, pixels)
    gray = vtk_to_numpy(pixels).reshape(view.size, view.size, 4)[..., 0].astype(float)
    window.Finalize()
    return low + gray / 255.0 * (high - low)


def picture(image, view, kind):
    return splat(image, view, kind) if kind in MODES else ray_cast(image, view, kind)


def interpolate(array, places):
    """Linearly along each axis; places in the order of the array's axes, the last axis of all."""
    last = numpy.array(array.shape) - 2
    low = numpy.clip(numpy.floor(places).astype(int), 0, numpy.maximum(last, 0))
    share = numpy.clip(places - low, 0.0, 1.0)
    total = 0.0
    for corner in numpy.ndindex(*(2,) * array.ndim):
        at = numpy.minimum(low + corner, numpy.array(array.shape) - 1)
        weight = numpy.where(corner, share, 1.0 - share).prod(-1)
        total = total + weight * array[tuple(numpy.moveaxis(at, -1, 0))]
    return total


def field_maxima(voxels, points, ways):
    """By brute force: 25 samples per voxel of the trilinear field between the outermost centres."""
    last = numpy.array(voxels.shape[::-1]) - 1.0
    with numpy.errstate(divide="ignore", invalid="ignore"):
        first, second = -points / ways, (last - points) / ways
    near, far = numpy.minimum(first, second).max(1), numpy.maximum(first, second).min(1)
    result = numpy.full(len(points), numpy.nan)
    hit = numpy.flatnonzero(far > near)
    for part in numpy.array_split(hit, max(len(hit) // 100, 1)):
        if len(part) == 0:
            continue
        steps = numpy.linspace(0.0, 1.0, int(25 * (far - near)[part].max()) + 2)
        depths = near[part, None] + (far - near)[part, None] * steps
        places = points[part, None] + depths[..., None] * ways[part, None]
        result[part] = interpolate(voxels, places[..., ::-1]).max(1)
    return result


def area_maxima(voxels, view, x, y):
    """The same over whole pixels: rays an eighth of a voxel apart, edges included."""
    count = int(numpy.ceil(8 * view.pixel)) + 1
    offsets = numpy.linspace(-0.5, 0.5, count)
    dx, dy = (grid.ravel() for grid in numpy.meshgrid(offsets, offsets))
    return numpy.array([
        numpy.nanmax(numpy.append(field_maxima(voxels, *view.rays(a + dx, b + dy)), -numpy.inf))
        for a, b in zip(x, y)])


def print_table(title, columns, rows):
    print(f"\n{title}\n\n| | " + " | ".join(map(str, columns)) + " |\n|" + "---|" * (len(columns) + 1))
    for name, values in rows:
        print(f"| {name} | " + " | ".join(map(str, values)) + " |")


def table_of_crests():
    """Along four lines, a voxel thick, the largest value across each: in the mean, of 100."""
    directions = ((1.0, 0.0, 0.0), (1.0, 0.37, 0.21), (0.45, 1.0, -0.3), (0.8, -0.7, 1.0))
    rows = []
    for kind in MODES + RAY_CASTERS:
        values = []
        for direction in directions:
            voxels = numpy.zeros((64, 64, 64), numpy.uint8)
            way = numpy.array(direction) / numpy.abs(direction).max()
            steps = numpy.arange(-24, 25)
            points = 31.5 + steps[:, None] * way
            i, j, k = numpy.round(points).astype(int).T
            voxels[k, j, i] = 100
            view = View(voxels, (0.3, 0.8, -0.25), 256, 3.3)
            found = picture(image_of(voxels), view, kind)
            along = 31.5 + numpy.linspace(-20, 20, 400)[:, None] * way
            x, y = view.project(along)
            side = numpy.array([y[0] - y[-1], x[-1] - x[0]])
            side = side / numpy.linalg.norm(side) * 1.5 / view.pixel
            shares = numpy.linspace(-1, 1, 31)
            across = interpolate(found, numpy.stack(
                [y[:, None] + shares * side[1], x[:, None] + shares * side[0]], -1))
            values.append(across.max(1).mean())
        rows.append((kind, [f"{numpy.mean(values):.0f}"]))
    print_table("Crest of a line that is one voxel thick, of 100; mean of four lines, 3.3 pixels "
                "per voxel", ["crest"], rows)


def volumes():
    named = [("aorta", ROOT / "Examples/Data/aorta-stent.vti"),
             ("head CT", ROOT / "Testing/Data/headsq.vti"),
             ("protein", ROOT / "Testing/Data/ironProt.vtk")]
    for name, path in named:
        voxels = voxels_of(path)
        middle = [slice(max(n // 2 - 60, 0), n // 2 + 60) for n in voxels.shape]
        yield name, numpy.ascontiguousarray(voxels[tuple(middle)])


def decibels(found, truth, voxels):
    known = numpy.isfinite(truth)
    error = numpy.sqrt(numpy.mean((found[known] - truth[known]) ** 2))
    return 20.0 * numpy.log10((float(voxels.max()) - float(voxels.min())) / max(error, 1e-9))


def table_of_decibels():
    random = numpy.random.default_rng(1)
    magnifications = (0.25, 0.5, 0.77, 1.0, 1.3, 2.0, 3.0, 4.0)
    for name, voxels in volumes():
        image = image_of(voxels)
        for angle in (0.0, 30.0):
            rows = {kind: [] for kind in MODES + ("fixed point", "GPU", "exact rays at centres")}
            for magnification in magnifications:
                size = int(1.2 * max(voxels.shape) * magnification)
                view = View(voxels, (0.35, 0.8, -0.45), size, magnification, angle)
                count = 60 if magnification < 1.0 else 600
                x, y = random.integers(int(0.25 * size), int(0.75 * size) + 1, (2, count))
                centres = field_maxima(voxels, *view.rays(x, y))
                truth = area_maxima(voxels, view, x, y) if magnification < 1.0 else centres
                for kind in rows:
                    found = centres if "rays" in kind else picture(image, view, kind)[y, x]
                    rows[kind].append(f"{decibels(found, truth, voxels):.1f}")
            shown = [(kind, [v if v != "inf" and float(v) < 150 else "-" for v in values])
                     for kind, values in rows.items()]
            print_table(f"{name}, {'perspective' if angle else 'parallel'}: dB to the field's "
                        "maxima, over pixels wider than voxels, on the rays of others; by screen "
                        "pixels per voxel", magnifications, shown)


def table_of_voxels():
    """200 single bright voxels: how many shine in the pixel that has their place, or beside it."""
    random = numpy.random.default_rng(1)
    voxels = numpy.zeros((240, 240, 240), numpy.uint8)
    places = random.integers(0, 240, (200, 3))
    voxels[places[:, 2], places[:, 1], places[:, 0]] = 100
    image = image_of(voxels)
    sizes = (512, 256, 120, 64)
    rows, times = [], []
    for kind in MODES + ("fixed point", "GPU"):
        seen, largest, took = [], [], []
        for size in sizes:
            view = View(voxels, (0.3, 0.9, 0.2), size, size / (240 * 3 ** 0.5))
            start = time.time()
            found = picture(image, view, kind)
            took.append(f"{1000 * (time.time() - start):.0f}")
            x, y = (numpy.clip(numpy.round(c).astype(int), 1, size - 2)
                    for c in view.project(places))
            near = numpy.array([found[b - 1:b + 2, a - 1:a + 2].max() for a, b in zip(x, y)])
            seen.append(f"{(near >= 50).sum()} ({near.min():.0f})")
            largest.append(f"{found.max():.0f}")
        rows.append((kind, seen + largest))
        times.append((kind, took))
    print_table("Of 200 bright voxels in 240³ those shown at half of their brightness or more (and "
                "the dimmest), and the picture's largest value of 100, by size",
                [f"{s}²" for s in sizes] * 2, rows)
    print_table("Milliseconds with the index", [f"{s}²" for s in sizes], times)


def table_of_sparkle():
    """How much pixels change from one view to the next, a tenth of a degree on."""
    rows = {kind: [] for kind in MODES + ("fixed point", "GPU")}
    scenes = [(name, voxels) for name, voxels in volumes()]
    random = numpy.random.default_rng(2)
    places = random.integers(0, 120, (200, 3))
    lone = numpy.zeros((120, 120, 120), numpy.uint8)
    lone[places[:, 2], places[:, 1], places[:, 0]] = 100
    scenes.append(("200 voxels", lone))
    twinkle = {kind: [] for kind in rows}
    for _, voxels in scenes:
        image = image_of(voxels)
        for kind in rows:
            before, changes, shining = None, [], []
            for n in range(21):
                angle = numpy.radians(30.0 + 0.1 * n)
                direction = (numpy.sin(angle), numpy.cos(angle), 0.3)
                size = 64
                view = View(voxels, direction, size, 1.0 / 3.0)
                found = picture(image, view, kind)
                if voxels is lone:
                    x, y = (numpy.round(c).astype(int) for c in view.project(places))
                    shining.append(numpy.max([found[y + j, x + i] for i in (-1, 0, 1)
                                              for j in (-1, 0, 1)], axis=0))
                if before is not None:
                    changes.append(found - before)
                before = found
            changes = numpy.array(changes) / (float(voxels.max()) - float(voxels.min())) * 100.0
            inside = changes[:, 20:44, 20:44]
            rows[kind].append(f"{numpy.sqrt((inside ** 2).mean()):.2f} / {abs(inside).max():.0f}")
            if voxels is lone:
                differences = numpy.diff(shining, axis=0)
                twinkle[kind] = [f"{numpy.mean(shining):.0f}",
                                 f"{numpy.sqrt((differences ** 2).mean()):.1f}",
                                 f"{numpy.abs(differences).max():.0f}"]
    print_table("Change of pixels between views 0.1 degree apart, a third of a pixel per voxel: RMS "
                "and largest, in % of the range", [name for name, _ in scenes], list(rows.items()))
    print_table("The largest pixel at and around the place of a bright voxel, of 100, in the same "
                "views: mean, and change between views, RMS and largest",
                ["mean", "RMS", "largest"], list(twinkle.items()))


TABLES = {"crest": table_of_crests, "decibels": table_of_decibels, "voxels": table_of_voxels,
          "sparkle": table_of_sparkle}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument("tables", nargs="*", metavar="table", help=", ".join(TABLES))
    arguments = parser.parse_args()
    for name in arguments.tables or TABLES:
        if name not in TABLES:
            parser.error(f"there is no table {name}: choose of {', '.join(TABLES)}")
        TABLES[name]()


if __name__ == "__main__":
    main()
