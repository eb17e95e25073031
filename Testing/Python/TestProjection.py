# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Projections in a process that has no display and never loads OpenGL; from NumPy to NumPy."""

import os
import unittest

import numpy
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkCamera
import vtksplattingmip
from vtksplattingmip import vtkSplattingMIPProjection


def image_of(volume):
    image = vtkImageData()
    image.SetDimensions(volume.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(volume.ravel(), deep=True))
    return image


def array_of(filter):
    output = filter.GetOutput()
    return vtk_to_numpy(output.GetPointData().GetScalars()).reshape(output.GetDimensions()[::-1])


class TestProjection(unittest.TestCase):
    def test_front_view_is_the_maximum_along_y(self):
        volume = numpy.random.default_rng(2).integers(-1000, 3000, (9, 8, 7), numpy.int16)
        filter = vtkSplattingMIPProjection()
        filter.SetInputData(image_of(volume))
        filter.SetQualityModeToPreview()
        filter.SetOutputSize(7, 9)
        filter.SetOutputSpacing(1.0, 1.0)
        filter.Update()
        self.assertEqual(array_of(filter).dtype, numpy.float32)
        numpy.testing.assert_array_equal(array_of(filter)[0], volume.max(axis=1))
        filter.SetBlendModeToMinimumIntensity()
        filter.Update()
        numpy.testing.assert_array_equal(array_of(filter)[0], volume.min(axis=1))
        filter.SetBlendModeToAverageIntensity()
        filter.Update()
        numpy.testing.assert_allclose(array_of(filter)[0], volume.mean(axis=1), rtol=1e-5, atol=1e-3)

    def test_signed_maximum_is_farthest_from_the_origin(self):
        # Few values: the maximum and the minimum of many rays are equally far from the first origins.
        volume = numpy.random.default_rng(3).integers(-4, 5, (9, 8, 7)).astype(numpy.float32)
        filter = vtkSplattingMIPProjection()
        filter.SetInputData(image_of(volume))
        filter.SetMaximumTypeToSigned()
        filter.SetOutputSize(7, 9)
        filter.SetOutputSpacing(1.0, 1.0)
        high, low = volume.max(axis=1), volume.min(axis=1)
        for mode, origin, error in ((filter.PREVIEW, 0.0, 0.0), (filter.PREVIEW, 0.5, 0.0),
                                    (filter.PREVIEW, 0.25, 0.0), (filter.EXACT, 0.25, 1e-5)):
            filter.SetQualityMode(mode)
            filter.SetSignedOrigin(origin)
            filter.Update()
            expected = numpy.where(abs(low - origin) > abs(high - origin), low, high)
            numpy.testing.assert_allclose(array_of(filter)[0], expected, rtol=0.0, atol=error)
            self.assertTrue((expected == low).any() and (expected == high).any())

    def test_turn_through_a_camera(self):
        volume = numpy.zeros((11, 11, 11))
        volume[5, 5, 9] = 4.0
        camera = vtkCamera()
        camera.SetFocalPoint(5, 5, 5)
        camera.SetPosition(5, -20, 5)
        camera.SetViewUp(0, 0, 1)
        camera.ParallelProjectionOn()
        camera.SetParallelScale(5.5)
        filter = vtkSplattingMIPProjection()
        filter.SetInputData(image_of(volume))
        filter.SetCamera(camera)
        filter.SetOutputSize(11, 11)
        filter.SetQualityModeToPreview()
        filter.SetNumberOfViews(4)
        filter.Update()
        found = array_of(filter)
        self.assertEqual(found.dtype, numpy.float64)
        columns = [int(view[5].argmax()) for view in found]
        self.assertEqual(columns, [9, 5, 1, 5])

    def test_package(self):
        self.assertIn("vtkSplattingMIPVolumeMapper", dir(vtksplattingmip))
        with self.assertRaises(AttributeError):
            vtksplattingmip.vtkNothing  # noqa: B018

    def tearDown(self):
        self.assertNotIn("DISPLAY", os.environ)
        with open("/proc/self/maps", encoding="utf-8") as maps:
            loaded = maps.read()
        self.assertIn("libvtkImagingSplattingMIP", loaded)
        for library in ("libGL", "libOpenGL", "libEGL", "libX11", "libvtkRenderingOpenGL2",
                        "libvtkRenderingSplattingMIP"):
            self.assertNotIn(library, loaded)


if __name__ == "__main__":
    unittest.main()
