# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a procedural angiogram: baselines, and beside VTK's ray caster."""

import math

import numpy
from paraview import simple
from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkRenderingCore import vtkColorTransferFunction, vtkVolume
from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper

import Stage

SIZE = 200


def vessels():
    """A tree of bright tubes in a noisy ball, as 16-bit integers with a negative background."""
    z, y, x = numpy.meshgrid(*[numpy.linspace(-1, 1, n) for n in (60, 70, 80)], indexing="ij")
    volume = numpy.where(x * x + y * y + z * z < 0.8, 40.0, -1000.0)
    volume += numpy.random.default_rng(5).normal(0, 20, volume.shape)
    for branch in range(6):
        angle = branch * math.pi / 3
        for t in numpy.linspace(0, 1, 120):
            center = (
                0.7 * t * math.cos(angle + 2 * t),
                0.7 * t * math.sin(angle + 2 * t),
                1.4 * t - 0.7,
            )
            distance = (x - center[0]) ** 2 + (y - center[1]) ** 2 + (z - center[2]) ** 2
            volume[distance < (0.09 - 0.06 * t) ** 2] = 400 + 60 * branch
    return volume.astype(numpy.int16)


class TestImages(Stage.Test):
    def setUp(self):
        super().setUp()
        self.data = Stage.image((-30, -20, 10), (0.75, 1, 1.25), hounsfield=vessels())
        self.view = Stage.new_view(SIZE)
        self.display = Stage.show(
            Stage.open_images("angiogram", self.data), self.view, "hounsfield"
        )
        self.colors = simple.GetColorTransferFunction("hounsfield")
        self.colors.RGBPoints = [-200, 0, 0, 0, 300, 0.8, 0.3, 0.1, 800, 1, 1, 0.9]
        opacity = simple.GetOpacityTransferFunction("hounsfield")
        opacity.Points = [-200, 0, 0.5, 0, 100, 1, 0.5, 0]
        self.view.Background = [0.1, 0.2, 0.3]
        self.look()

    def look(self):
        self.view.ResetCamera()
        camera = self.view.GetActiveCamera()
        camera.Azimuth(30)
        camera.Elevation(20)
        self.view.CameraPosition = camera.GetPosition()
        self.view.CameraViewUp = camera.GetViewUp()
        self.view.ResetCamera()
        self.view.CameraParallelScale = 40
        self.view.CameraViewAngle = 20

    def assertLooksLikeBaseline(self, name):
        # The CPU makes the picture; what draws it may round a blended colour the other way.
        error = Stage.baseline_error(Stage.picture(self.view, name), name)
        self.assertIn(error, (0, 1), f"{Stage.path(name)}.png differs from the baseline")

    def test_preview(self):
        self.assertLooksLikeBaseline("ParaViewPreview")

    def test_standard(self):
        self.display.MIPQuality = "Standard"
        self.assertLooksLikeBaseline("ParaViewStandard")

    def test_high(self):
        self.display.MIPQuality = "High"
        self.assertLooksLikeBaseline("ParaViewHigh")

    def test_depth_shaded_slab(self):
        self.display.MIPProjection = "Depth-Shaded Maximum"
        self.display.MIPSlab = 1
        self.display.MIPSlabThickness = 30
        self.display.MIPSlabCenter = [0, 15, 47]
        self.assertLooksLikeBaseline("ParaViewSlab")

    def ray_cast(self):
        """The volume by VTK's ray caster, in ParaView's own view and with ParaView's functions."""
        colors, opacity = vtkColorTransferFunction(), vtkPiecewiseFunction()
        points = self.colors.RGBPoints
        for i in range(0, len(points), 4):
            colors.AddRGBPoint(*points[i : i + 4])
        points = simple.GetOpacityTransferFunction("hounsfield").Points
        for i in range(0, len(points), 4):
            opacity.AddPoint(points[i], points[i + 1])
        mapper = vtkFixedPointVolumeRayCastMapper()
        self.data.GetPointData().SetActiveScalars("hounsfield")
        mapper.SetInputData(self.data)
        mapper.SetBlendModeToMaximumIntensity()
        mapper.AutoAdjustSampleDistancesOff()
        mapper.SetSampleDistance(0.1)
        volume = vtkVolume()
        volume.SetMapper(mapper)
        volume.GetProperty().SetColor(colors)
        volume.GetProperty().SetScalarOpacity(opacity)
        volume.GetProperty().SetInterpolationTypeToLinear()
        self.display.Visibility = 0
        renderer = self.view.GetRenderer()
        renderer.AddVolume(volume)
        try:
            return Stage.picture(self.view, "RayCast").astype(int)
        finally:
            renderer.RemoveVolume(volume)
            self.display.Visibility = 1

    def assertAgreesWithRayCaster(self):
        """The picture is like the ray caster's, and no shift by pixels makes it more like it."""
        expected = self.ray_cast()[2:-2, 2:-2]
        self.assertGreater(numpy.ptp(expected), 200)
        self.display.MIPQuality = "High"
        pixels = Stage.picture(self.view)
        likeness = {}
        for down in range(5):
            for right in range(5):
                shifted = pixels[down : SIZE - 4 + down, right : SIZE - 4 + right]
                likeness[down - 2, right - 2] = numpy.corrcoef(
                    shifted.ravel(), expected.ravel()
                )[0, 1]
        self.assertEqual(max(likeness, key=likeness.get), (0, 0))
        # Averages are below the ray caster's peaks: a few hundredths for one-voxel noise and edges.
        self.assertGreater(likeness[0, 0], 0.95)

    def test_agrees_with_ray_caster(self):
        self.assertAgreesWithRayCaster()

    def test_agrees_with_ray_caster_in_perspective(self):
        self.view.CameraParallelProjection = 0
        self.look()
        self.assertAgreesWithRayCaster()

    def test_default_view(self):
        # What one has after two clicks: perspective, colours over the data's range.
        simple.ResetSession()
        source = Stage.open_images("angiogram", self.data)
        view = simple.CreateView("RenderView")
        view.ViewSize = [SIZE, SIZE]
        view.OrientationAxesVisibility = 0
        display = simple.Show(source, view)
        empty = Stage.picture(view)
        self.assertTrue(display.SetRepresentationType("Splatting MIP"))
        view.ResetCamera()
        self.assertGreater((Stage.picture(view) != empty).any(axis=2).sum(), SIZE * SIZE / 8)


Stage.main()
