# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Each time step of a series is shown, forth and back, also from ParaView's cache of geometry."""

from paraview import simple

import Stage


class TestTime(Stage.Test):
    def setUp(self):
        super().setUp()
        self.volumes = [Stage.noise(seed) // (seed + 1) for seed in range(3)]
        images = [Stage.image(scalars=volume) for volume in self.volumes]
        self.view = Stage.new_view()
        Stage.look(self.view, "from +z")
        self.display = Stage.show(Stage.open_images("series", *images), self.view)
        self.scene = simple.GetAnimationScene()
        self.scene.UpdateAnimationUsingDataTimeSteps()
        self.assertEqual(list(self.scene.TimeKeeper.TimestepValues), [0, 1, 2])

    def assertShowsSteps(self):
        # Time 0 comes later: to set what the scene has already, or thinks that it has, moves nothing.
        for step in (1, 0, 2, 1, 2, 0):
            self.scene.AnimationTime = step
            self.assertShows(self.volumes[step].max(axis=0), self.view)

    def test_steps(self):
        self.assertShowsSteps()

    def test_steps_from_the_cache(self):
        settings = simple.GetSettingsProxy("GeneralSettings")
        before = settings.CacheGeometryForAnimation
        settings.CacheGeometryForAnimation = 1
        try:
            self.scene.Play()
            self.assertShowsSteps()
        finally:
            settings.CacheGeometryForAnimation = before

    def test_gray_follows_the_steps(self):
        simple.ColorBy(self.display, None)
        for step in (1, 0, 2):
            self.scene.AnimationTime = step
            volume = self.volumes[step]
            low, high = float(volume.min()), float(volume.max())
            gray = (volume.max(axis=0) - low) * 255 / (high - low)
            self.assertShows(gray, self.view, Stage.ROUNDING)

    def test_animated_slab(self):
        volume = self.volumes[0]
        self.display.MIPSlab = 1
        self.display.MIPSlabThickness = 4
        track = simple.GetAnimationTrack("MIPSlabCenter", index=2, proxy=self.display)
        start, end = simple.CompositeKeyFrame(), simple.CompositeKeyFrame()
        start.KeyTime, start.KeyValues = 0.0, [5.5]
        end.KeyTime, end.KeyValues = 1.0, [25.5]
        track.KeyFrames = [start, end]
        for step in (1, 2, 0):
            self.scene.AnimationTime = step
            first = 4 + 10 * step
            slab = self.volumes[step][first : first + 4]
            self.assertShows(slab.max(axis=0), self.view)


Stage.main()
