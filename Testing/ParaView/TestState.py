# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""A state file and a Python trace bring the picture back, with every property."""

import subprocess


import numpy
from paraview import simple, smtrace

import Stage

# Not the defaults.
SETTINGS = {
    "MIPProjection": "Depth-Shaded Maximum",
    "MIPDepthShadingAmbient": 0.25,
    "MIPDepthShadingChangeRate": 0.5,
    "MIPLocalMaximumThreshold": 77.0,
    "MIPSignedOrigin": 55.0,
    "MIPQuality": "Standard",
    "MIPInteractiveQuality": "Preview",
    "MIPKernel": "Cosine Bell",
    "MIPKernelRadius": 0.75,
    "MIPSlab": 1,
    "MIPSlabThickness": 12.0,
    "MIPSlabCenter": [19.0, 18.0, 20.0],
    "MIPAcceleration": "Lines",
    "MIPLineTolerance": 3.0,
    "MIPCullBelowWindow": 1,
    "MIPIndexMemoryBudget": 512,
    "MIPUseCropping": 1,
    "MIPCroppingOrigin": [2.5, 2.5, 0.0],
    "MIPCroppingScale": [0.75, 0.75, 1.0],
    "MIPUseSeparateOpacityArray": 1,
    "MIPOpacityArrayName": ["POINTS", "scalars"],
}


class TestState(Stage.Test):
    def scene(self):
        source = Stage.open_images(
            "volume", Stage.image(scalars=Stage.noise(1), opacity=Stage.noise(2))
        )
        view = Stage.new_view()
        display = Stage.show(source, view)
        return view, display

    def change(self, view, display):
        for name, value in SETTINGS.items():
            setattr(display, name, value)
        Stage.look(view, "from -y")
        view.GetActiveCamera().Azimuth(30)
        view.CameraPosition = view.GetActiveCamera().GetPosition()

    def settings(self, display):
        values = {name: getattr(display, name) for name in SETTINGS}
        return {
            name: value if isinstance(value, (str, int, float)) else list(value)
            for name, value in values.items()
        }

    def test_state_file(self):
        view, display = self.scene()
        defaults = self.settings(display)
        self.change(view, display)
        settings = self.settings(display)
        for name in SETTINGS:
            self.assertNotEqual(settings[name], defaults[name], name)
        before = Stage.picture(view)
        self.assertGreater(before.max(), 0)
        simple.SaveState(Stage.path("state.pvsm"))
        simple.ResetSession()
        simple.LoadState(Stage.path("state.pvsm"))
        view = simple.GetActiveViewOrCreate("RenderView")
        view.ViewSize = [Stage.WINDOW, Stage.WINDOW]
        numpy.testing.assert_array_equal(Stage.picture(view), before)
        display = simple.GetDisplayProperties(simple.FindSource("volume"), view)
        self.assertEqual(self.settings(display), settings)

    def run_elsewhere(self, script):
        """The picture that the script leaves in a ParaView of its own."""
        file = Stage.path("elsewhere.py")
        picture = Stage.path("elsewhere.png")
        with open(file, "w") as program:
            program.write("from paraview import simple\n")
            program.write("simple._DisableFirstRenderCameraReset()\n")
            program.write(f"simple.LoadPlugin({Stage.PLUGIN!r}, remote=False, ns=globals())\n")
            program.write(script)
            program.write("\nview = simple.GetActiveView()\n")
            # What traces leave to the reader.
            program.write("view.OrientationAxesVisibility = 0\n")
            program.write("view.UseColorPaletteForBackground = 0\n")
            program.write("view.Background = [0, 0, 0]\n")
            program.write(f"size = [{Stage.WINDOW}, {Stage.WINDOW}]\n")
            program.write(f"simple.SaveScreenshot({picture!r}, view, ImageResolution=size)\n")
        subprocess.run(["pvbatch", file], check=True, timeout=100)
        return Stage.read_picture(picture)

    def test_trace(self):
        smtrace.start_trace()
        view, display = self.scene()
        colors = simple.GetColorTransferFunction("scalars")
        opacity = simple.GetOpacityTransferFunction("scalars")
        # What the panel of a display's properties and the editor of its colours record.
        modified = [
            smtrace.PropertiesModified(proxy.SMProxy) for proxy in (display, colors, opacity)
        ]
        self.change(view, display)
        colors.ColorSpace = "HSV"
        colors.RGBPoints = [0, 0, 0, 0.25, 200, 1, 1, 0]
        opacity.Points = [0, 0.5, 0.5, 0, 200, 1, 0.5, 0]
        for item in modified:
            item.finalize()
        text = smtrace.stop_trace()
        before = Stage.picture(view)
        for name in SETTINGS:
            self.assertIn(name, text)
        numpy.testing.assert_array_equal(self.run_elsewhere(text), before)

    def test_python_state(self):
        view, display = self.scene()
        self.change(view, display)
        before = Stage.picture(view)
        from paraview import smstate

        numpy.testing.assert_array_equal(self.run_elsewhere(smstate.get_state()), before)


Stage.main()
