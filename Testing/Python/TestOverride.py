# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""One call from Python, and VTK's smart mapper shows what the splatting mapper shows."""

import unittest

from vtkmodules.vtkCommonDataModel import vtkPlane
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkRenderingVolume import vtkGPUVolumeRayCastMapper
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkSmartVolumeMapper
from vtkmodules.vtkRenderingCore import vtkVolume
import vtksplattingmip
from vtksplattingmip import (
    vtkSplattingMIPGPUVolumeRayCastMapper,
    vtkSplattingMIPVolumeMapper,
)

from TestRender import picture


class TestOverride(unittest.TestCase):
    def test_smart_mapper(self):
        splatted = picture(vtkSplattingMIPVolumeMapper())
        self.assertFalse(vtkSplattingMIPGPUVolumeRayCastMapper.GetGlobalOverride())
        before = picture(vtkSmartVolumeMapper())
        vtkSplattingMIPGPUVolumeRayCastMapper.GlobalOverrideOn()
        self.assertTrue(vtkSplattingMIPGPUVolumeRayCastMapper.GetGlobalOverride())
        self.assertEqual(picture(vtkSmartVolumeMapper()), splatted)
        self.assertIsInstance(vtkGPUVolumeRayCastMapper(), vtkSplattingMIPGPUVolumeRayCastMapper)
        vtkSplattingMIPGPUVolumeRayCastMapper.GlobalOverrideOff()
        self.assertEqual(picture(vtkSmartVolumeMapper()), before)
        self.assertNotEqual(before, splatted)

    def test_quality_of_what_the_factory_gives(self):
        vtkSplattingMIPGPUVolumeRayCastMapper.GlobalOverrideOn()
        mapper = vtkGPUVolumeRayCastMapper()
        vtkSplattingMIPGPUVolumeRayCastMapper.GlobalOverrideOff()
        mapper.GetSplattingMapper().SetQualityModeToPreview()
        preview = vtkSplattingMIPVolumeMapper()
        preview.SetQualityModeToPreview()
        self.assertEqual(picture(mapper), picture(preview))
        self.assertTrue(mapper.GetLastRenderUsedSplatting())

    def test_functions(self):
        preview = vtkSplattingMIPVolumeMapper()
        preview.SetQualityModeToPreview()
        expected = picture(preview)
        vtksplattingmip.enable("preview")
        self.assertEqual(picture(vtkSmartVolumeMapper()), expected)
        vtksplattingmip.disable()
        self.assertNotEqual(picture(vtkSmartVolumeMapper()), expected)
        self.assertRaises(ValueError, vtksplattingmip.enable, "best")

    def test_one_volume(self):
        """use_for() keeps what the mapper before had."""
        old = vtkSmartVolumeMapper()
        source = vtkRTAnalyticSource()
        old.SetInputConnection(source.GetOutputPort())
        old.SetBlendModeToMinimumIntensity()
        old.SelectScalarArray("RTData")
        old.SetScalarModeToUsePointFieldData()
        old.CroppingOn()
        old.SetCroppingRegionPlanes(1, 2, 3, 4, 5, 6)
        old.SetCroppingRegionFlagsToFence()
        old.SetAverageIPScalarRange(7, 8)
        old.SetVectorMode(1)
        old.SetVectorComponent(2)
        old.SetFinalColorWindow(0.5)
        old.SetFinalColorLevel(0.4)
        volume = vtkVolume()
        self.assertRaises(ValueError, vtksplattingmip.use_for, volume)
        volume.SetMapper(old)
        self.assertIsNone(vtksplattingmip.use_for(volume).GetClippingPlanes())
        old.AddClippingPlane(vtkPlane())
        volume.SetMapper(old)
        new = vtksplattingmip.use_for(volume, "high")
        self.assertIs(volume.GetMapper(), new)
        self.assertEqual(new.GetQualityMode(), new.HIGH)
        for name in (
            "InputConnection", "BlendMode", "ArrayName", "ScalarMode", "Cropping", "CroppingRegionPlanes",
            "CroppingRegionFlags", "ClippingPlanes", "AverageIPScalarRange", "VectorMode",
            "VectorComponent", "FinalColorWindow", "FinalColorLevel",
        ):
            arguments = (0, 0) if name == "InputConnection" else ()
            self.assertEqual(
                getattr(new, f"Get{name}")(*arguments), getattr(old, f"Get{name}")(*arguments), name
            )


if __name__ == "__main__":
    unittest.main()
