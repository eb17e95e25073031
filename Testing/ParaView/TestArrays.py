# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""What ParaView chooses for a display, the projection shows: array, component, colours, cropping."""

import numpy
from paraview import simple

import Stage


class TestArrays(Stage.Test):
    def setUp(self):
        super().setUp()
        self.volume = Stage.noise(1)
        self.view = Stage.new_view()
        Stage.look(self.view, "from +z")

    def open(self, **arrays):
        self.source = Stage.open_images("arrays", Stage.image(**arrays))
        self.display = Stage.show(self.source, self.view, next(iter(arrays)))

    def assertShowsMaximum(self, volume, tolerance=0):
        self.assertShows(volume.max(axis=0), self.view, tolerance)

    def test_another_array(self):
        other = Stage.noise(2)
        self.open(scalars=self.volume, other=other)
        self.assertShowsMaximum(self.volume)
        simple.ColorBy(self.display, ("POINTS", "other"))
        Stage.gray("other")
        self.assertShowsMaximum(other)
        simple.ColorBy(self.display, ("POINTS", "scalars"))
        self.assertShowsMaximum(self.volume)

    def test_components_and_magnitude(self):
        vectors = numpy.stack([self.volume, Stage.noise(2), Stage.noise(3)], axis=-1)
        self.open(vectors=vectors)
        for component in range(3):
            simple.ColorBy(self.display, ("POINTS", "vectors", "XYZ"[component]))
            Stage.gray("vectors")
            self.assertShowsMaximum(vectors[:, :, :, component])
        simple.ColorBy(self.display, ("POINTS", "vectors", "Magnitude"))
        simple.GetColorTransferFunction("vectors").RGBPoints = [0, 0, 0, 0, 510, 1, 1, 1]
        magnitude = numpy.sqrt((vectors.astype(float) ** 2).sum(axis=-1))
        # The table of colours over floats has steps of 510 / 65536 in these.
        self.assertShowsMaximum(magnitude / 2, 0.505)

    def test_cell_array(self):
        # Cells are voxels: one less than points, and half a unit from them.
        cells = self.volume[:-1, :-1, :-1]
        data = Stage.image(scalars=self.volume)
        array = Stage.numpy_to_vtk(numpy.ascontiguousarray(cells).ravel(), deep=True)
        array.SetName("cells")
        data.GetCellData().AddArray(array)
        display = Stage.show(Stage.open_images("cells", data), self.view)
        simple.ColorBy(display, ("CELLS", "cells"))
        Stage.gray("cells")
        Stage.look(self.view, "from +z", [(d - 1) / 2 + 0.5 for d in Stage.DIMENSIONS])
        pixels = Stage.picture(self.view)[:, :, 0]
        # The first cell's centre is at 0.5; the window's first pixel at (d - 1 - WINDOW) / 2 + 1.
        left, bottom = ((Stage.WINDOW - d) // 2 for d in Stage.DIMENSIONS[:2])
        height, width = cells.shape[1:]
        inside = pixels[bottom : bottom + height, left : left + width]
        numpy.testing.assert_array_equal(inside[1:-1, 1:-1], cells.max(axis=0)[1:-1, 1:-1])

    def test_color_and_opacity_functions(self):
        self.open(scalars=self.volume)
        colors = simple.GetColorTransferFunction("scalars")
        colors.RGBPoints = [0, 1, 0, 0, 255, 0, 0, 1]
        opacity = simple.GetOpacityTransferFunction("scalars")
        opacity.Points = [0, 0, 0.5, 0, 255, 1, 0.5, 0]
        self.view.Background = [0, 1, 0]
        largest = self.volume.max(axis=0) / 255.0
        expected = 255 * numpy.stack(
            [largest * (1 - largest), 1 - largest, largest * largest], axis=-1
        )
        pixels, expected = Stage.shown(expected, Stage.picture(self.view))
        # The premultiplied colour is rounded before it is blended, and the blend once more.
        self.assertLessEqual(numpy.abs(pixels - expected).max(), 2)

    def test_solid_color_shows_gray(self):
        levels = self.volume // 2 + 20
        self.open(scalars=levels)
        simple.ColorBy(self.display, None)
        low, high = int(levels.min()), int(levels.max())
        gray = (levels.max(axis=0) - float(low)) * 255 / (high - low)
        self.assertShows(gray, self.view, Stage.ROUNDING)

    def test_new_display_needs_no_choice_of_array(self):
        source = Stage.open_images("new", Stage.image(scalars=self.volume))
        display = Stage.show(source, self.view, array=None)
        self.assertFalse(display.ColorArrayName[1])
        self.assertShowsMaximum(self.volume, Stage.ROUNDING)

    def test_separate_opacity_array(self):
        # Of two dependent components the last one, the opacity, wins and takes the colour along.
        opacity = numpy.random.default_rng(7).permutation(self.volume.size) % 256
        opacity = opacity.astype(numpy.uint8).reshape(self.volume.shape)
        other = Stage.noise(3)
        self.open(scalars=self.volume, opacity=opacity, other=other)
        self.display.MIPOpacityArrayName = ["POINTS", "opacity"]
        self.display.MIPUseSeparateOpacityArray = 1
        alphas = Stage.seen(opacity, "from +z")
        winner = alphas.argmax(axis=0)[None]
        alpha = numpy.take_along_axis(alphas, winner, axis=0)[0]
        for name, values in dict(scalars=self.volume, other=other).items():
            simple.ColorBy(self.display, ("POINTS", name))
            Stage.gray(name)
            simple.GetOpacityTransferFunction(name).Points = [0, 0, 0.5, 0, 255, 1, 0.5, 0]
            color = numpy.take_along_axis(Stage.seen(values, "from +z"), winner, axis=0)[0]
            # Rounded when it is multiplied, and when it is drawn.
            self.assertShows(color * (alpha / 255.0), self.view, 1)
        simple.ColorBy(self.display, ("POINTS", "scalars"))
        self.display.MIPUseSeparateOpacityArray = 0
        Stage.gray("scalars")
        self.assertShowsMaximum(self.volume)

    def test_cropping(self):
        self.open(scalars=self.volume)
        self.display.MIPUseCropping = 1
        # As for Volume: the box is origin + scale * bounds, here from 8.5 to 24.5 of 0 to 39, ...
        box = [(8.5, 24.5), (5.5, 20.5), (10.5, 30.5)]
        self.display.MIPCroppingOrigin = [low for low, _ in box]
        self.display.MIPCroppingScale = [
            (high - low) / (d - 1) for (low, high), d in zip(box, Stage.DIMENSIONS)
        ]
        inside = [slice(int(low + 0.5), int(high + 0.5)) for low, high in box]
        expected = numpy.zeros(self.volume.shape[1:])
        expected[inside[1], inside[0]] = self.volume[inside[2], inside[1], inside[0]].max(axis=0)
        self.assertShows(expected, self.view)
        self.display.MIPUseCropping = 0
        self.assertShowsMaximum(self.volume)

    def test_transform(self):
        self.open(scalars=self.volume)
        # ParaView 5.13 has renamed it.
        renamed = "Translation" in self.display.ListProperties()
        move = "Translation" if renamed else "Position"
        setattr(self.display, move, [3, -2, 0])
        pixels = Stage.picture(self.view)
        setattr(self.display, move, [0, 0, 0])
        moved = numpy.roll(Stage.picture(self.view), (-2, 3), axis=(0, 1))
        numpy.testing.assert_array_equal(pixels[5:-5, 5:-5], moved[5:-5, 5:-5])

    def test_opaque_geometry_hides(self):
        # A sheet in the middle of the volume hides its far half where it is.
        self.open(scalars=self.volume)
        sheet = simple.Plane(Origin=[-50, -50, 21.5], Point1=[19.5, -50, 21.5], Point2=[-50, 90, 21.5])
        surface = simple.Show(sheet, self.view)
        surface.AmbientColor = surface.DiffuseColor = [0, 0, 0]
        surface.Specular = 0
        pixels, _ = Stage.shown(self.volume[0], Stage.picture(self.view))
        near, everything = self.volume[22:].max(axis=0), self.volume.max(axis=0)
        numpy.testing.assert_array_equal(pixels[:, :15, 0], near[1:-1, 1:16])
        numpy.testing.assert_array_equal(pixels[:, 25:, 0], everything[1:-1, 26:-1])


Stage.main()
