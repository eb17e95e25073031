# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""The window of --interactive, as the X display shows it."""
import ctypes
import ctypes.util
import itertools
import subprocess
import time

import numpy

import SplatmipTesting as splatmip


class XImage(ctypes.Structure):
    _fields_ = [("width", ctypes.c_int), ("height", ctypes.c_int), ("xoffset", ctypes.c_int),
                ("format", ctypes.c_int), ("data", ctypes.POINTER(ctypes.c_ubyte)),
                ("byte_order", ctypes.c_int), ("bitmap_unit", ctypes.c_int),
                ("bitmap_bit_order", ctypes.c_int), ("bitmap_pad", ctypes.c_int),
                ("depth", ctypes.c_int), ("bytes_per_line", ctypes.c_int),
                ("bits_per_pixel", ctypes.c_int)]


class XKeyEvent(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("root", ctypes.c_ulong),
                ("subwindow", ctypes.c_ulong), ("time", ctypes.c_ulong), ("x", ctypes.c_int),
                ("y", ctypes.c_int), ("x_root", ctypes.c_int), ("y_root", ctypes.c_int),
                ("state", ctypes.c_uint), ("keycode", ctypes.c_uint), ("same_screen", ctypes.c_int),
                ("pad", ctypes.c_long * 24)]


class Screen:
    """What is seen on a display, by libX11."""

    def __init__(self):
        name = ctypes.util.find_library("X11")
        self.x = ctypes.CDLL(name) if name else None
        if not self.x:
            raise RuntimeError("no libX11")
        self.x.XOpenDisplay.restype = ctypes.c_void_p
        self.x.XDefaultRootWindow.restype = ctypes.c_ulong
        self.x.XGetImage.restype = ctypes.POINTER(XImage)
        self.display = ctypes.c_void_p(self.x.XOpenDisplay(None))
        if not self.display:
            raise RuntimeError("no display")
        self.root = ctypes.c_ulong(self.x.XDefaultRootWindow(self.display))

    def close(self):
        self.x.XCloseDisplay(self.display)

    def press(self, key):
        """Send a key to the newest window."""
        root, parent, count = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.c_uint()
        windows = ctypes.POINTER(ctypes.c_ulong)()
        self.x.XQueryTree(self.display, self.root, ctypes.byref(root), ctypes.byref(parent),
                          ctypes.byref(windows), ctypes.byref(count))
        window = windows[count.value - 1]
        code = self.x.XKeysymToKeycode(self.display, ctypes.c_ulong(ord(key)))
        for kind, mask in ((2, 1), (3, 2)):  # pressed, released
            event = XKeyEvent(type=kind, display=self.display, window=window, root=self.root, keycode=code,
                              same_screen=1)
            self.x.XSendEvent(self.display, ctypes.c_ulong(window), 1, ctypes.c_long(mask), ctypes.byref(event))
        self.x.XFlush(self.display)

    def look(self, width, height):
        """Rows of the top left corner from the top, in one colour of 255."""
        image = self.x.XGetImage(self.display, self.root, 0, 0, width, height,
                                 ctypes.c_ulong(~0 & 0xFFFFFFFF), 2)
        content = image.contents
        pixels = numpy.ctypeslib.as_array(content.data, (height, content.bytes_per_line)).copy()
        return pixels.reshape(height, -1, content.bits_per_pixel // 8)[:, :width, 1].astype(int)


class TestWindow(splatmip.SplatmipTest):
    def wait_for(self, screen, picture):
        """Wait until the window shows a picture below the label: a minute at most."""
        end = time.monotonic() + 60
        while self.program.poll() is None and time.monotonic() < end:
            if abs(screen.look(256, 256) - picture)[40:].mean() < 0.5:
                return
            time.sleep(0.2)
        self.fail("the window does not show it")

    def test_interactive(self):
        """The window shows what the picture shows, and keys switch the mode."""
        try:
            screen = Screen()
        except RuntimeError as error:
            self.skipTest(str(error))
        self.addCleanup(screen.close)
        oblique = numpy.array([[0.9, -0.8, 0, 0], [1.2, 0.6, 0, 0], [0, 0, 2, 0]])
        options = (splatmip.write_meta(self.path("a.mha"), places=oblique), "--size", "256x256", "--no-marks", "--mode")
        modes = ("preview", "standard", "high", "exact")
        pictures = [self.draw(*options, mode, "--output", "a.png")[0][:, :, 0] for mode in modes]
        for first, second in itertools.combinations(pictures, 2):
            self.assertGreater(abs(first - second)[40:].mean(), 1)
        with subprocess.Popen([splatmip.PROGRAM, *options, "standard", "--interactive"], cwd=self.scratch.name,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as self.program:
            try:
                self.wait_for(screen, pictures[1])
                for key in "4231":
                    screen.press(key)
                    self.wait_for(screen, pictures[int(key) - 1])
                screen.press("q")
                self.assertEqual(self.program.wait(60), 0)
            finally:
                self.program.kill()


if __name__ == "__main__":
    splatmip.main()
