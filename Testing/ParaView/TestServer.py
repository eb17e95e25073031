# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""A client sees what a pvserver renders, and an outline of it if the server cannot render."""

import os
import socket
import subprocess
import unittest

import numpy
from paraview import servermanager, simple

import Stage


HOST = "127.0.0.1" # a bare root may not know localhost


def free_port():
    with socket.socket() as probe:
        probe.bind((HOST, 0))
        return probe.getsockname()[1]


class TestServer(unittest.TestCase):
    assertShows = Stage.Test.assertShows
    expected_errors = []

    def connect(self, **environment):
        port = free_port()
        variables = {**os.environ, **environment}
        variables = {name: value for name, value in variables.items() if value is not None}
        self.server = subprocess.Popen(
            ["pvserver", f"--server-port={port}"],
            env=variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        for line in self.server.stdout:
            if "Accepting connection" in line:
                break
        simple.Connect(HOST, port)
        self.addCleanup(self.stop)
        self.addCleanup(simple.Disconnect)
        Stage.load_plugin()
        Stage.load_plugin(remote=True)

    def tearDown(self):
        self.assertIsNone(self.server.poll(), "the server has ended")

    def stop(self):
        self.server.terminate()
        said, _ = self.server.communicate(timeout=60)
        errors = [line for line in said.splitlines() if "ERR|" in line]
        for expected in self.expected_errors:
            self.assertIn(expected, errors.pop(0))
        self.assertEqual(errors, [])

    def show(self):
        self.volume = Stage.noise(1)
        view = Stage.new_view()
        Stage.look(view, "from +z")
        source = Stage.open_images("noise", Stage.image(scalars=self.volume))
        return view, Stage.show(source, view)

    def test_picture_of_the_server(self):
        self.connect()
        self.assertTrue(servermanager.ActiveConnection.IsRemote())
        view, display = self.show()
        settings = simple.GetSettingsProxy("RenderViewSettings")
        # Megabytes of geometry from which on the server renders. Volumes it renders always.
        for threshold in (0, 1e9):
            settings.RemoteRenderThreshold = threshold
            display.MIPProjection = "Maximum"
            self.assertShows(self.volume.max(axis=0), view)
            display.MIPProjection = "Minimum"
            self.assertShows(self.volume.min(axis=0), view)
        display.MIPProjection = "Maximum"
        simple.ColorBy(display, None)
        low, high = float(self.volume.min()), float(self.volume.max())
        gray = (self.volume.max(axis=0) - low) * 255 / (high - low)
        self.assertShows(gray, view, Stage.ROUNDING)

    def test_interaction(self):
        self.connect()
        view, display = self.show()
        view.UseInteractiveRenderingForScreenshots = 1
        display.MIPQuality = "High"
        display.MIPInteractiveQuality = "Preview"
        preview = Stage.picture(view).mean()
        display.MIPInteractiveQuality = "High"
        high = Stage.picture(view).mean()
        view.UseInteractiveRenderingForScreenshots = 0
        still = Stage.picture(view).mean()
        # High averages noise. ParaView compresses interactive pictures, which changes colours little.
        self.assertGreater(preview, high + 10)
        self.assertLess(abs(still - high), 3)

    def test_server_without_display(self):
        self.connect(DISPLAY=None)
        # What ParaView says of all volumes then.
        self.expected_errors = ["require remote rendering which, however, is not available"]
        view, display = self.show()
        pixels = Stage.picture(view)
        # The outline's box is drawn where the volume would be.
        rows, columns = numpy.nonzero(pixels.max(axis=2))
        self.assertGreater(len(rows), 0)
        width, height, _ = Stage.DIMENSIONS
        self.assertLessEqual(columns.max() - columns.min(), width + 1)
        self.assertLessEqual(rows.max() - rows.min(), height + 1)


Stage.main()
