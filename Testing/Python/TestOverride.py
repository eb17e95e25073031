# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""One call from Python, and VTK's smart mapper shows what the splatting mapper shows."""

import unittest

from vtkmodules.vtkRenderingVolume import vtkGPUVolumeRayCastMapper
from vtkmodules.vtkRenderingVolumeOpenGL2 import vtkSmartVolumeMapper
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


if __name__ == "__main__":
    unittest.main()
