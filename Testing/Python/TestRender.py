# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""The wrapped mapper renders, and its picture is the one that VTK's ray caster gives."""

import unittest

from vtkmodules.vtkCommonDataModel import vtkPiecewiseFunction
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkRenderingCore import (
    vtkColorTransferFunction,
    vtkRenderer,
    vtkRenderWindow,
    vtkVolume,
)
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkRenderingVolume import vtkFixedPointVolumeRayCastMapper
from vtksplattingmip import vtkSplattingMIPProjection, vtkSplattingMIPVolumeMapper

SIZE = 200


def picture(mapper):
    """The red channel of a MIP of VTK's wavelet, as a list of SIZE * SIZE numbers."""
    source = vtkRTAnalyticSource()
    source.SetWholeExtent(-15, 15, -15, 15, -15, 15)
    mapper.SetInputConnection(source.GetOutputPort())
    mapper.SetBlendModeToMaximumIntensity()
    gray = vtkColorTransferFunction()
    gray.AddRGBPoint(37, 0, 0, 0)
    gray.AddRGBPoint(277, 1, 1, 1)
    opaque = vtkPiecewiseFunction()
    opaque.AddPoint(0, 1)
    volume = vtkVolume()
    volume.SetMapper(mapper)
    volume.GetProperty().SetColor(gray)
    volume.GetProperty().SetScalarOpacity(opaque)
    volume.GetProperty().SetInterpolationTypeToLinear()
    renderer = vtkRenderer()
    renderer.AddVolume(volume)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.Azimuth(25)
    camera.Elevation(20)
    renderer.ResetCamera()
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SIZE, SIZE)
    window.AddRenderer(renderer)
    window.Render()
    pixels = vtkUnsignedCharArray()
    window.GetRGBACharPixelData(0, 0, SIZE - 1, SIZE - 1, 0, pixels)
    return [pixels.GetComponent(p, 0) for p in range(SIZE * SIZE)]


class TestRender(unittest.TestCase):
    def test_pictures_agree_with_the_ray_caster(self):
        caster = vtkFixedPointVolumeRayCastMapper()
        caster.AutoAdjustSampleDistancesOff()
        caster.SetSampleDistance(0.25)
        expected = picture(caster)
        # The wavelet varies by up to 10 grey levels from voxel to voxel. The averages of standard
        # and high differ from point samples by a part of that; preview shows whole voxels, half a
        # voxel's difference brighter on average. A picture shifted by one voxel differs by more,
        # an empty one by about 90.
        for mode, bound in (("Preview", 5.0), ("Standard", 3.0), ("High", 3.0),
                            ("Exact", 1.0)):
            mapper = vtkSplattingMIPVolumeMapper()
            getattr(mapper, f"SetQualityModeTo{mode}")()
            found = picture(mapper)
            error = sum(abs(a - b) for a, b in zip(found, expected)) / len(found)
            print(f"{mode}: mean difference {error:.2f} of 255")
            self.assertLess(error, bound)

    def test_shear_image_and_state(self):
        mapper = vtkSplattingMIPVolumeMapper()
        self.assertIsNone(mapper.GetShearImage())
        picture(mapper)
        self.assertIsNone(mapper.GetShearImage())
        self.assertEqual(mapper.GetPrincipalAxis(), -1)
        self.assertIn("QualityMode: exact", str(mapper))
        mapper.SetQualityModeToHigh()
        picture(mapper)
        self.assertEqual(mapper.GetShearImage().GetScalarTypeAsString(), "float")
        self.assertIn(mapper.GetPrincipalAxis(), (0, 1, 2))
        self.assertLessEqual(max(abs(s) for s in mapper.GetShear()), 1.0)
        self.assertFalse(mapper.GetLastRenderUsedRayCasting())


class TestProperties(unittest.TestCase):
    def test_every_property_is_printed(self):
        for printed in (vtkSplattingMIPVolumeMapper(), vtkSplattingMIPProjection()):
            methods = {name for kind in type(printed).mro() if "SplattingMIP" in kind.__name__
                       for name in vars(kind)}
            properties = [name[3:] for name in methods
                          if name.startswith("Set") and "Get" + name[3:] in methods]
            self.assertGreater(len(properties), 20)
            for name in properties:
                self.assertIn(f"{name}: ", str(printed))


if __name__ == "__main__":
    unittest.main()
