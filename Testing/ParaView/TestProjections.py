# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Along the axes each pixel is what NumPy computes of one line of voxels."""

import numpy
from paraview import simple

import Stage


def depth_shaded(lines, ambient, rate):
    """The largest sample, each dimmed by its depth and counted from the lowest scalar."""
    low = int(lines.min())
    count = lines.shape[0]
    shades = [ambient + (1 - n / count) * rate for n in range(count)]
    return low + numpy.max([(line - low) * shade for line, shade in zip(lines, shades)], axis=0)


def local_maximum(lines, threshold):
    """The first local maximum that is no less than the threshold, else the largest sample."""
    best = numpy.full(lines.shape[1:], -1)
    done = numpy.zeros(lines.shape[1:], bool)
    for line in lines.astype(int):
        done |= (best >= threshold) & (line < best)
        best = numpy.where(done, best, numpy.maximum(best, line))
    return best


def signed_maximum(lines, origin):
    """The largest or the smallest sample, whichever is farther from the origin."""
    high, low = lines.max(axis=0), lines.min(axis=0)
    return numpy.where(abs(low - origin) > abs(high - origin), low, high)


class TestProjections(Stage.Test):
    def setUp(self):
        super().setUp()
        self.volume = Stage.noise(1)
        self.view = Stage.new_view()
        source = Stage.open_images("noise", Stage.image(scalars=self.volume))
        self.display = Stage.show(source, self.view)

    def expect(self, projection, tolerance=0):
        for direction in Stage.VIEWS:
            with self.subTest(direction):
                Stage.look(self.view, direction)
                lines = Stage.seen(self.volume, direction)
                self.assertShows(projection(lines), self.view, tolerance)

    def test_maximum_is_the_default(self):
        self.expect(lambda lines: lines.max(axis=0))

    def test_minimum(self):
        self.display.MIPProjection = "Minimum"
        self.expect(lambda lines: lines.min(axis=0))

    def test_average(self):
        self.display.MIPProjection = "Average"
        self.expect(lambda lines: lines.mean(axis=0), Stage.ROUNDING)

    def test_depth_shaded_maximum(self):
        self.display.MIPProjection = "Depth-Shaded Maximum"
        self.expect(lambda lines: depth_shaded(lines, 0.3, 0.7), Stage.ROUNDING)
        self.display.MIPDepthShadingAmbient = 0.1
        self.display.MIPDepthShadingChangeRate = 0.5
        self.expect(lambda lines: depth_shaded(lines, 0.1, 0.5), Stage.ROUNDING)

    def test_local_maximum(self):
        self.display.MIPProjection = "Local Maximum"
        self.display.MIPLocalMaximumThreshold = 200
        self.expect(lambda lines: local_maximum(lines, 200))
        self.display.MIPLocalMaximumThreshold = 254
        self.expect(lambda lines: local_maximum(lines, 254))

    def test_signed_maximum(self):
        self.display.MIPProjection = "Signed Maximum"
        self.expect(lambda lines: lines.max(axis=0))
        self.display.MIPSignedOrigin = 128
        self.expect(lambda lines: signed_maximum(lines.astype(int), 128))

    def test_slab(self):
        # Six voxels along the view have their centres in the slab.
        self.display.MIPSlab = 1
        self.display.MIPSlabThickness = 6
        center = [12.5, 20.5, 15.5]
        self.display.MIPSlabCenter = center
        for direction, (_, _, forward) in Stage.VIEWS.items():
            with self.subTest(direction):
                Stage.look(self.view, direction)
                lines = Stage.seen(self.volume, direction)
                first = int(abs(numpy.dot(center, forward)) - 2.5)
                part = (lines if sum(forward) > 0 else lines[::-1])[first : first + 6]
                self.assertShows(part.max(axis=0), self.view)

    def test_accelerations_and_memory_leave_the_picture(self):
        self.display.MIPIndexMemoryBudget = 0
        self.expect(lambda lines: lines.max(axis=0))
        self.display.MIPIndexMemoryBudget = 4096
        for acceleration in ["Dense", "Bricks", "Lines", "Sorted Lines", "Sorted Volume"]:
            self.display.MIPAcceleration = acceleration
            self.expect(lambda lines: lines.max(axis=0))

    def test_line_tolerance(self):
        # Grey levels far below the largest one may differ by nearly the tolerance, and some do.
        self.volume //= 8
        self.volume[0, 0, 0] = 255
        self.display.Input = Stage.open_images("dark", Stage.image(scalars=self.volume))
        self.display.MIPAcceleration = "Lines"
        self.display.MIPLineTolerance = 20
        self.expect(lambda lines: lines.max(axis=0), 20)
        Stage.look(self.view, "from +z")
        projection = Stage.seen(self.volume, "from +z").max(axis=0)
        pixels, expected = Stage.shown(projection, Stage.picture(self.view))
        self.assertGreater(numpy.abs(pixels[:, :, 0] - expected).max(), 1)

    def test_cull_below_window(self):
        # Scalars up to 240 are all black.
        colors = simple.GetColorTransferFunction("scalars")
        colors.RGBPoints = [240, 0, 0, 0, 255, 1, 1, 1]
        projection = lambda lines: numpy.maximum(0, (lines.max(axis=0) - 240.0) * 17)
        self.expect(projection, Stage.ROUNDING)
        self.display.MIPCullBelowWindow = 1
        self.expect(projection, Stage.ROUNDING)


Stage.main()
