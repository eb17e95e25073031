# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Turns: films and numbered pictures."""
import itertools
import os
import struct

import numpy
import vtk

import SplatmipTesting as splatmip


def read_chunks(data):
    """All chunks of a RIFF file as pairs of name and content; lists are entered."""
    place = 0
    while place < len(data):
        name, size = struct.unpack_from("<4sI", data, place)
        content = data[place + 8:place + 8 + size]
        if name in (b"RIFF", b"LIST"):
            yield from read_chunks(content[4:])
        else:
            yield name, content
        place += 8 + size + size % 2


def double_length(plane, axis):
    """libjpeg's interpolation: three parts of the nearest sample and one of the next."""
    plane = numpy.moveaxis(plane, axis, 0)
    before = numpy.concatenate((plane[:1], plane[:-1]))
    after = numpy.concatenate((plane[1:], plane[-1:]))
    both = numpy.stack((3 * plane + before, 3 * plane + after), axis=1) / 4
    return numpy.moveaxis(both.reshape(-1, *plane.shape[1:]), 0, axis)


def halve_chroma(picture):
    """What JPEG with 4:2:0 keeps of a picture before anything is rounded."""
    to_ycbcr = numpy.array([[0.299, 0.587, 0.114], [-0.299 / 1.772, -0.587 / 1.772, 0.5],
                            [0.5, -0.587 / 1.402, -0.114 / 1.402]])
    planes = picture @ to_ycbcr.T
    height, width, _ = planes.shape
    even = numpy.pad(planes[..., 1:], ((0, height % 2), (0, width % 2), (0, 0)), "edge")
    chroma = even.reshape(len(even) // 2, 2, -1, 2, 2).mean(axis=(1, 3))
    planes[..., 1:] = double_length(double_length(chroma, 0), 1)[:height, :width]
    return numpy.clip(planes @ numpy.linalg.inv(to_ycbcr).T, 0, 255)


def bound_jpeg_errors(steps, size, has_colors):
    """The most that red, green and blue can be off, as root mean squares over a picture.

    A coefficient is off by at most 5/8 of its step (libavcodec rounds up from there on), and the
    transform keeps sums of squares. Blocks reach beyond the picture, so that all their error may
    lie in what is seen. Y is rounded before and after that, Cb and Cr also when halved and doubled,
    and the colours in the end.
    """
    seen = numpy.prod(size) / numpy.prod([(length + 15) // 16 * 16 for length in size])
    transformed = numpy.sqrt(numpy.mean((0.625 * steps) ** 2) / seen)
    chroma = has_colors * (transformed + 2.0)
    shares = numpy.array([1.402, (0.299 * 1.402 + 0.114 * 1.772) / 0.587, 1.772])
    return transformed + 1.5 + chroma * shares


class TestTurns(splatmip.SplatmipTest):
    def turn(self, *arguments):
        """Returns what was printed."""
        result = self.run_program(*arguments)
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        self.assertTrue(result.stdout.splitlines()[-1].startswith("turn: "), result.stdout)
        return result.stdout

    def read(self, name):
        reader = vtk.vtkPNGReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        return splatmip.get_bytes(reader.GetOutput())

    def test_pictures(self):
        options = ("--size", "60x90", "--mode", "standard", "--azimuth", "0", "--elevation", "0")
        text = self.turn("--rotate", "8", "--out", "turn.png", *options)
        self.assertRegex(text, r"8 views of 60 x 90 in .* per second")
        names = sorted(os.listdir(self.scratch.name))
        self.assertEqual(names, [f"turn-{n:05}.png" for n in range(8)])
        pictures = [self.read(name) for name in names]
        self.assertEqual(len(set(pictures)), 8)
        # The view from behind is the mirror image of the front.
        width = 3 * 60
        rows = [pictures[0][n:n + width] for n in range(0, len(pictures[0]), width)]
        mirrored = b"".join(row[::-1] for row in rows)  # gray
        differences = [abs(a - b) for a, b in zip(mirrored, pictures[4])]
        self.assertLessEqual(max(differences), 1)
        # The first view is what the mapper shows; the turn is as large as fits from all sides.
        self.assertGreater(max(pictures[0]), 250)

    def test_gif(self):
        text = self.turn("--rotate", "4", "--size", "50x40", "--rate", "10", "--out", "turn.gif",
                         "--mode", "preview", "--colormap", "hot")
        self.assertIn("per second", text)
        with open(self.path("turn.gif"), "rb") as file:
            data = file.read()
        self.assertTrue(data.startswith(b"GIF89a" + bytes([50, 0, 40, 0])))
        self.assertTrue(data.endswith(b";"))
        self.assertIn(b"NETSCAPE2.0", data)
        self.assertEqual(data.count(bytes([0x21, 0xF9, 4, 4, 10, 0])), 4)

    def test_film(self):
        self.turn("--rotate", "4", "--size", "64x48", "--output", "turn.ogv", "--mode", "preview")
        with open(self.path("turn.ogv"), "rb") as file:
            data = file.read()
        self.assertTrue(data.startswith(b"OggS"))
        self.assertIn(b"theora", data[:200])

    def read_avi(self, name, size, rate, views):
        """The pictures as JPEG, after a look at what players go by."""
        with open(self.path(name), "rb") as file:
            data = file.read()
        self.assertEqual(data[:12], struct.pack("<4sI4s", b"RIFF", len(data) - 8, b"AVI "))
        chunks = list(read_chunks(data))
        frames = [content for name, content in chunks if name == b"00dc"]
        self.assertEqual(len(frames), views)
        headers = dict(chunks)
        main = struct.unpack_from("<10I", headers[b"avih"])
        self.assertEqual((main[4], main[6], main[8:]), (views, 1, size))
        self.assertEqual(headers[b"strh"][:8], b"vidsMJPG")
        self.assertEqual(struct.unpack_from("<4I", headers[b"strh"], 20), (1, rate, 0, views))
        movie = data.index(b"movi")  # where the index, by which players jump, counts from
        for (_, _, place, length), frame in itertools.zip_longest(
                struct.iter_unpack("<4s3I", headers[b"idx1"]), frames):
            self.assertEqual(data[movie + place + 8:movie + place + 8 + length], frame)
        return frames

    def check_avi(self, colormap):
        size, views = (61, 47), 4
        options = ("--rotate", str(views), "--size", "61x47", "--rate", "10", "--mode", "standard",
                   "--colormap", colormap)
        self.turn("--out", "turn.avi", *options)
        self.turn("--out", "turn.png", *options)
        for n, frame in enumerate(self.read_avi("turn.avi", size, 10, views)):
            steps = numpy.frombuffer(frame, numpy.uint8, 64, frame.index(b"\xFF\xDB") + 5)
            self.assertLessEqual(max(steps), 83 // 8)  # libavcodec's finest
            found = splatmip.read_picture(vtk.vtkJPEGReader(), splatmip.write_file(self.path("frame.jpg"), frame))
            expected = splatmip.read_picture(vtk.vtkPNGReader(), self.path(f"turn-{n:05}.png"))
            errors = numpy.sqrt(numpy.mean((found - halve_chroma(expected)) ** 2, axis=(0, 1)))
            bound = bound_jpeg_errors(steps, size, colormap != "gray")
            self.assertTrue((errors <= bound).all(), (colormap, n, errors, bound))

    def test_avi(self):
        self.check_avi("gray")
        self.check_avi("hot")

    def test_refusals(self):
        self.assert_refused("--rotate", "4", "--out", "turn.jpg", word=".gif", code=2)
        self.assert_refused("--rotate", "1", "--out", "turn.gif", code=2)
        self.assert_refused("--rotate", "4", "--interactive", word="choose one", code=2)
        self.assert_refused("--out", "turn.gif", word=".png", code=2)
        os.symlink("/dev/full", self.path("full.avi"))
        for name in ("no/turn.gif", "no/turn.ogv", "no/turn.avi", "full.avi"):
            result = self.run_program("--rotate", "2", "--size", "16x16", "--out", name)
            self.assertEqual(result.returncode, 1)
            self.assertRegex(result.stderr, rf"^splatmip: .*{name}: .* folder .*\.\n$")


if __name__ == "__main__":
    splatmip.main()
