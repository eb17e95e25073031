# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Still and interactive renders have their own quality; ParaView picks the display by its picture."""

import numpy
from paraview import simple

import Stage

MODES = ["Preview", "Standard", "High"]


class TestInteraction(Stage.Test):
    def setUp(self):
        super().setUp()
        self.view = Stage.new_view()
        self.source = Stage.open_images("noise", Stage.image(scalars=Stage.noise(1)))
        self.display = Stage.show(self.source, self.view)
        Stage.look(self.view, "from +z")
        camera = self.view.GetActiveCamera()
        camera.Azimuth(25)
        camera.Elevation(20)

    def still(self):
        self.view.UseInteractiveRenderingForScreenshots = 0
        return Stage.picture(self.view)

    def interactive(self):
        self.view.UseInteractiveRenderingForScreenshots = 1
        return Stage.picture(self.view)

    def test_qualities_differ(self):
        pictures = []
        for mode in MODES:
            self.display.MIPQuality = mode
            pictures.append(self.still())
        # Averaging noise dims it, the more the larger the footprint.
        means = [picture[32, 16:48].mean() for picture in pictures]
        self.assertGreater(means[0], means[1] + 10)
        self.assertGreater(means[1], means[2] + 10)

    def test_kernels_differ(self):
        self.display.MIPQuality = "High"
        trilinear = self.still()
        self.display.MIPKernel = "Cosine Bell"
        self.display.MIPKernelRadius = 0.5
        sharp = self.still()
        self.display.MIPKernelRadius = 1.5
        wide = self.still()
        self.assertGreater(sharp.mean(), trilinear.mean() + 1)
        self.assertGreater(trilinear.mean(), wide.mean() + 1)

    def test_interactive_quality_is_automatic(self):
        # A volume as small as this one is in time in any quality.
        for mode in MODES:
            self.display.MIPQuality = mode
            still = self.still()
            numpy.testing.assert_array_equal(self.interactive(), still)

    def test_interactive_quality_of_its_own(self):
        pictures = {}
        for mode in MODES:
            self.display.MIPQuality = mode
            pictures[mode] = self.still()
        for still in MODES:
            self.display.MIPQuality = still
            for interactive in MODES:
                self.display.MIPInteractiveQuality = interactive
                numpy.testing.assert_array_equal(self.interactive(), pictures[interactive])
                numpy.testing.assert_array_equal(self.still(), pictures[still])

    def test_picking(self):
        self.still()
        picked = self.view.Pick(32, 32)
        self.assertEqual(picked, self.display.SMProxy)
        self.assertIsNone(self.view.Pick(1, 1))

    def test_hide_and_show(self):
        before = self.still()
        simple.Hide(self.source, self.view)
        self.assertEqual(self.still().max(), 0)
        simple.Show(self.source, self.view)
        numpy.testing.assert_array_equal(self.still(), before)

    def test_other_representations_and_back(self):
        before = self.still()
        for type in ["Outline", "Surface", "Volume", "Slice"]:
            self.assertTrue(self.display.SetRepresentationType(type))
            self.assertTrue((self.still() != before).any())
        # What has been set for Volume stays there.
        self.display.BlendMode = "Isosurface"
        self.display.UseTransfer2D = 1
        self.display.UseSeparateOpacityArray = 1
        self.display.UseCropping = 1
        self.display.CroppingScale = [0.5, 0.5, 0.5]
        self.assertTrue(self.display.SetRepresentationType("Splatting MIP"))
        numpy.testing.assert_array_equal(self.still(), before)

    def test_two_views(self):
        other = Stage.new_view(96)
        Stage.show(self.source, other)
        Stage.look(other, "from +x", scale=32)
        before = self.still()
        turned = Stage.picture(other)
        numpy.testing.assert_array_equal(self.still(), before)
        numpy.testing.assert_array_equal(Stage.picture(other), turned)


Stage.main()
