# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""
Pictures at all magnifications, by brute force: exact pictures are the field's maxima, and overviews
show every voxel.
"""
import sys
import unittest
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).parents[1] / "Benchmark"))
import zoom  # noqa: E402
from vtk.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtksplattingmip import vtkSplattingMIPProjection as Filter  # noqa: E402

DATA = Path(__file__).parents[1] / "Data"
DIRECTIONS = ((0.0, 1.0, 0.0), (0.35, 0.8, -0.45), (0.6, -0.7, 0.5), (-0.9, 0.1, 0.3))


def projection_of(image, view, mode):
    projection = Filter()
    projection.SetInputData(image)
    projection.SetCamera(view.camera)
    projection.SetOutputSize(view.size, view.size)
    projection.SetQualityMode(zoom.MODES.index(mode))
    return projection


def array_of(projection, name=None):
    projection.Update()
    data = projection.GetOutput().GetPointData()
    array = vtk_to_numpy(data.GetArray(name) if name else data.GetScalars())
    width, height = projection.GetOutput().GetDimensions()[:2]
    return array.reshape(height, width, -1).squeeze()


class TestZoom(unittest.TestCase):
    def test_exact_is_the_field(self):
        """The largest value of the field on the ray of each pixel: never less than its samples, which
        are a 25th of a voxel apart, nor more than the field changes from there."""
        random = numpy.random.default_rng(4)
        for name in ("headsq.vti", "ironProt.vtk"):
            voxels = zoom.voxels_of(DATA / name)
            voxels = numpy.ascontiguousarray(
                voxels[tuple(slice(n // 2 - 24, n // 2 + 24) for n in voxels.shape)])
            image = zoom.image_of(voxels)
            for angle in (0.0, 30.0):
                for magnification in (1.0, 1.3, 2.0, 4.0):
                    size = int(1.2 * 48 * magnification)
                    view = zoom.View(voxels, DIRECTIONS[1], size, magnification, angle)
                    projection = projection_of(image, view, "exact")
                    found = array_of(projection)
                    x, y = random.integers(int(0.25 * size), int(0.75 * size), (2, 400))
                    truth = zoom.field_maxima(voxels, *view.rays(x, y))
                    more = (found[y, x] - truth)[numpy.isfinite(truth)] / numpy.ptp(voxels)
                    self.assertGreater(len(more), 100)
                    where = (name, angle, magnification)
                    self.assertGreater(more.min(), -2e-6, where)
                    # In a cell the field changes by the range per voxel and axis at most.
                    self.assertLess(more.max(), 3 ** 0.5 / 50, where)
                    self.assertLess(more.mean(), 1e-3, where)

    def test_overviews_show_every_voxel(self):
        """Each at its full value in the pixel of its place or beside it, and none is larger."""
        random = numpy.random.default_rng(5)
        voxels = numpy.zeros((90, 100, 80), numpy.int16)
        places = numpy.column_stack([random.integers(0, n, 200) for n in voxels.shape[::-1]])
        values = random.permutation(numpy.arange(100, 300))
        voxels[places[:, 2], places[:, 1], places[:, 0]] = values
        values = voxels[places[:, 2], places[:, 1], places[:, 0]]
        image = zoom.image_of(voxels)
        for direction in DIRECTIONS:
            for size, angle in ((150, 0.0), (100, 0.0), (40, 0.0), (17, 0.0), (60, 20.0)):
                view = zoom.View(voxels, direction, size, size / 160.0, angle)
                for mode in ("preview", "exact"):
                    projection = projection_of(image, view, mode)
                    projection.RecordLocationsOn()
                    found = array_of(projection)
                    self.assertEqual(found.max(), values.max())
                    x, y = (numpy.clip(numpy.round(c).astype(int), 1, size - 2)
                            for c in view.project(places))
                    near = numpy.max([found[y + j, x + i] for i in (-1, 0, 1)
                                      for j in (-1, 0, 1)], axis=0)
                    self.assertTrue((near >= values).all(), (direction, size, angle, mode))
                    self.check_locations(projection, found, voxels, view)

    def check_locations(self, projection, found, voxels, view):
        """Pixels that show a voxel's value tell of such a voxel, near its place."""
        told = array_of(projection, "Voxel")
        position = array_of(projection, "Position")
        y, x = numpy.nonzero((found >= 100) & (found == numpy.round(found)))
        i, j, k = told[y, x].T
        same = voxels[k, j, i] == found[y, x]
        self.assertGreater(same.mean(), 0.9)
        across, up = view.project(position[y, x][same])
        off = numpy.maximum(abs(across - x[same]), abs(up - y[same]))
        # A sample in the area or, where a row or the area has none, the nearest one: at most half
        # a sample away along each axis of the shear image. Samples are no wider than voxels.
        self.assertLess(off.max(), 0.5 + 1.0 / view.pixel + 1e-3)

    def test_largest_of_areas(self):
        """Front views of pixels three and a half voxels wide, against the definition."""
        random = numpy.random.default_rng(6)
        voxels = random.integers(-500, 500, (31, 9, 34)).astype(numpy.int16)
        image = zoom.image_of(voxels)
        for mode in ("preview", "exact", "standard"):
            for minimum in (False, True):
                projection = projection_of(image, zoom.View(voxels, (0, 1, 0), 9, 1 / 3.5), mode)
                projection.SetCamera(None)
                projection.SetViewDirection(0.0, 1.0, 0.0)
                projection.SetViewUp(0.0, 0.0, 1.0)
                projection.SetOutputSpacing(3.5, 3.5)
                sign = 1.0
                if minimum:
                    projection.SetBlendModeToMinimumIntensity()
                    sign = -1.0
                found = sign * array_of(projection)
                plane = (sign * voxels).max(axis=1)
                for b in range(1, 8):
                    for a in range(1, 8):
                        ends = [(c - 4) * 3.5 + 0.5 * (n - 1) + numpy.array((-1.75, 1.75))
                                for c, n in ((b, 31), (a, 34))]
                        if numpy.min(ends) >= 0 and ends[0][1] <= 30 and ends[1][1] <= 33:
                            rows, columns = (slice(int(numpy.ceil(e[0])), int(e[1]) + 1)
                                             for e in ends)
                            expected = plane[rows, columns].max()
                            self.assertAlmostEqual(found[b, a], expected, places=2)


if __name__ == "__main__":
    unittest.main()
