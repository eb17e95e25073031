# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""The window of --interactive, as the X display shows it."""
import ctypes
import ctypes.util
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

    def look(self, width, height):
        """Rows of the top left corner from the top, in one colour of 255."""
        image = self.x.XGetImage(self.display, self.root, 0, 0, width, height,
                                 ctypes.c_ulong(~0 & 0xFFFFFFFF), 2)
        content = image.contents
        pixels = numpy.ctypeslib.as_array(content.data, (height, content.bytes_per_line)).copy()
        return pixels.reshape(height, -1, content.bits_per_pixel // 8)[:, :width, 1].astype(int)


def find_block(pixels):
    """Where gray of half the brightness is: rows and columns that have much of it."""
    gray = abs(pixels - 127) < 8
    rows = numpy.nonzero(gray.sum(axis=1) > 10)[0]
    columns = numpy.nonzero(gray.sum(axis=0) > 10)[0]
    return gray.sum(), (len(rows) and numpy.ptp(rows), len(columns) and numpy.ptp(columns))


class TestWindow(splatmip.SplatmipTest):
    def wait_for(self, screen, arguments, is_shown):
        """What is on the screen when it is, after a minute at most."""
        with subprocess.Popen([splatmip.PROGRAM, *arguments, "--interactive"],
                              cwd=self.scratch.name, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as program:
            try:
                end = time.monotonic() + 60
                while program.poll() is None and time.monotonic() < end:
                    pixels = screen.look(400, 400)
                    if is_shown(pixels):
                        return pixels
                    time.sleep(0.2)
            finally:
                program.kill()
        self.fail("the window has not shown it")

    def test_interactive(self):
        """The window shows what the picture shows, wherever it opens."""
        try:
            screen = Screen()
        except RuntimeError as error:
            self.skipTest(str(error))
        self.addCleanup(screen.close)
        path = splatmip.write_vti(self.path("a.vti"))
        for mode in ("preview", "exact"):
            arguments = (path, "--mode", mode, "--view", "anterior", "--size", "256x256",
                         "--window", "2000", "--level", "1000")
            picture, _ = self.draw(*arguments, "--output", "a.png")
            count, size = find_block(picture[:, :, 0])
            self.assertGreater(count, 300)
            # The warp's rim and the window's own sampling change the outermost pixels.
            pixels = self.wait_for(screen, arguments,
                                   lambda found, n=count: find_block(found)[0] > 0.8 * n)
            found, found_size = find_block(pixels)
            self.assertLess(abs(found / count - 1), 0.2)
            self.assertLessEqual(abs(numpy.subtract(found_size, size)).max(), 4)
            # It is at the patient's left and the feet: the label is above it, and nothing else.
            rows, columns = numpy.nonzero(abs(pixels - 127) < 8)
            self.assertGreater(numpy.median(columns), 128)
            self.assertGreater(numpy.median(rows), 128)


if __name__ == "__main__":
    splatmip.main()
