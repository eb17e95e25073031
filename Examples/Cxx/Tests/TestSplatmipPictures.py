# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stills: modes, options, and what is printed."""
import math
import os

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import SplatmipTesting as splatmip

MODES = ("preview", "standard", "high", "exact")
# Colour maps as --colormap has them: place from black to white, red, green, blue.
COLORMAPS = {
    "gray": [(0, 0, 0, 0), (1, 1, 1, 1)],
    "inverted": [(0, 1, 1, 1), (1, 0, 0, 0)],
    "hot": [(0, 0, 0, 0), (0.375, 1, 0, 0), (0.75, 1, 1, 0), (1, 1, 1, 1)],
    "bone": [(0, 0, 0, 0), (0.375, 0.33, 0.33, 0.45), (0.75, 0.66, 0.78, 0.78), (1, 1, 1, 1)]}


def find_depths(colors):
    """The share of the way from red, 0, over green to blue, 1; one of the three is 0."""
    red, green, blue = colors.T
    largest = colors.max(axis=1)
    return numpy.where(blue == 0, numpy.where(red >= green, green / largest, 2 - red / largest),
                       numpy.where(green >= blue, 2 + blue / largest, 4 - green / largest)) / 4


class TestProgram(splatmip.SplatmipTest):
    def test_modes(self):
        """Each differs; all are side by side as they are by themselves; exact is the default."""
        row, _ = self.draw("--mode", "all")
        self.assertEqual(row.shape, (600, 1600, 3))
        parts = {mode: row[:, 400 * n : 400 * (n + 1)] for n, mode in enumerate(MODES)}
        self.assertEqual(len({part.tobytes() for part in parts.values()}), 4)
        for mode, part in parts.items():
            self.assertEqual(part[:20, :100].max(), 255)  # the label
            self.assertEqual(part[20:].max(), 255)
            self.assertEqual(part[-12:].max(), 0)
            self.assertTrue((part == self.draw("--mode", mode)[0]).all())
        pixels, text = self.draw()
        self.assertTrue((parts["exact"] == pixels).all())
        self.assertEqual(os.listdir(self.scratch.name), ["splatmip.png"])
        self.assertIn("128 x 128 x 256", text)
        self.assertNotIn(" ms", text)

    def test_compare(self):
        """Times are taken, and written into the picture, only where they are asked for."""
        path = splatmip.write_vti(self.path("a.vti"))
        options = ("--size", "128x128", "--output", "a.png")
        plain, _ = self.draw(path, *options)
        for mode in MODES:
            compared, text = self.draw(path, *options, "--mode", mode, "--compare", has_display=True)
            self.assertRegex(text, rf"(?m)^{mode} .* ms .* ms \((nearest|linear)\)")
        self.assertTrue((compared == plain)[28:].all())
        self.assertFalse((compared == plain)[:28].all())
        self.draw(path, "--perspective", "30", "--compare", *options, has_display=True)

    def test_refusals(self):
        """Options that do not go together, or are no numbers in their range, before anything is read."""
        for words in (("--mode", "best"), ("--size", "12"), ("--window", "-1"), ("--unknown",), ("--rotate", "1"),
                      ("--crop", "0,40,0,40"), ("--crop", "0,40,0,40,9,9"), ("--perspective", "150"),
                      ("--view", "left", "--azimuth", "7"), ("--slab-offset", "5"), ("--level", "nan"),
                      ("--slab", "3", "--slab-offset", "5", "--rotate", "9"),
                      *(("--mode", "all", *other) for other in (("--rotate", "4"), ("--output", "a.mha"),
                                                                ("--interactive",))),
                      *(("--compare", *other) for other in (
                          ("--interactive",), ("--rotate", "4"), ("--slab", "5"), ("--blend", "mean"),
                          ("--crop", "0,1,0,1,0,1"), ("--depth-shading",), ("--depth-coding",),
                          ("--mask", "m.mha"))),
                      ("--rotate", "4", "--interactive"), ("--depth-shading", "--blend", "min"),
                      ("--depth-coding", "--blend", "mean"), ("--depth-coding", "--colormap", "hot"),
                      ("--depth-coding", "--output", "v.nii"), ("--depth-coding", "--blend", "signed"),
                      ("--depth-shading", "--blend", "signed"), ("--origin", "7"),
                      ("--color", "red", "--colormap", "hot"), ("--color", "red", "--blend", "signed"),
                      ("--color", "red,lime"), ("--color", "reddish"), ("--color", ",red"), ("--blending", "mean")):
            self.assert_refused("missing.vti", *words, words=words[0], code=2)
        for words in (("--series", 1), ("--frame", 1), ("--channel", 1), ("--array", "a"), ("--component", 1),
                      ("--crop", "0,9,0,9,0,9"), ("--mask", "m.mha"), ("--label", 1), ("--window", 9), ("--level", 9),
                      ("--depth-coding",), ("--compare",), ("--interactive",), ("--color", "red"),
                      ("--blend", "signed"), ("--output", "a.mha"), ("--output", "a.dcm", "--rotate", 4)):
            self.assert_refused("a.vti", "b.vti", "--blending", "add", *words, words=words[0], code=2)
        for words in ((), ("--color", "red,lime")):
            self.assert_refused("a.vti", "b.vti", *words, words="need --blending", code=2)
        self.assert_refused("--component", "1", words="--component requires file", code=2)
        for words in ("--compare", "--interactive"):
            self.assert_refused("missing.vti", words, words="no display")
        self.assertEqual(os.listdir(self.scratch.name), [])

    def test_help(self):
        """Options in groups, and four commands, of which each option is one that there is."""
        self.assertRegex(self.run_well("--version"), r"^splatmip \d+\.\d+\.\d+, VTK \d+\.\d+\.\d+\n$")
        options, examples = self.run_well("--help").split("Examples:")
        for group in ("Input", "Projection", "Colours", "View", "Output"):
            self.assertIn(f"\n{group}:\n", options)
        commands = [line.split() for line in examples.splitlines() if line.startswith("  splatmip")]
        self.assertEqual(len(commands), 4)
        for option in (word for command in commands for word in command if word.startswith("--")):
            self.assertRegex(options, rf"(?m)^  {option}\b")


class TestOptions(splatmip.SplatmipTest):
    SIDE = 200

    def setUp(self):
        """A small block to the left, the back and the feet of the middle."""
        super().setUp()
        self.block = numpy.array([8, 5, -11])  # from the middle, mm: left, back, head
        self.values = numpy.zeros((41, 41, 41), numpy.int16)
        x, y, z = 19 + self.block
        self.values[z:z + 3, y:y + 3, x:x + 3] = 1000
        self.write(self.values)

    def write(self, values):
        self.file = splatmip.write_meta(self.path("a.mha"), values, numpy.eye(3, 4))

    def show(self, *arguments):
        options = {"--azimuth": 0, "--elevation": 0, "--window": 1000, "--level": 500,
                   "--mode": "high", "--size": f"{self.SIDE}x{self.SIDE}", "--output": "a.png"}
        for name in {"--azimuth", "--elevation"} if "--view" in arguments else arguments:
            options.pop(name, None)
        words = [word for item in options.items() for word in item]
        return self.draw(self.file, "--no-marks", *words, *arguments)[0]

    def find(self, *arguments):
        """Where the block is, in pixels to the right of and above the middle."""
        pixels = self.show(*arguments)[20:, :, 0]
        rows, columns = numpy.nonzero(pixels > 100)
        self.assertGreater(len(rows), 5)
        middle = 0.5 * (self.SIDE - 1)
        return numpy.array([columns.mean() - middle, middle - 20 - rows.mean()])

    def assert_seen(self, right, up, *arguments):
        """The block is where a camera with these axes sees it: 1.1 / 20 of half the side fits."""
        found, wanted = self.find(*arguments), numpy.array([self.block @ right, self.block @ up])
        # At most the diagonal of the box fits into the half; a block's middle is known to a pixel.
        scale = numpy.linalg.norm(found) / numpy.linalg.norm(wanted)
        self.assertGreater(scale, 0.5 * self.SIDE / (1.1 * math.sqrt(3) * 20) - 0.1)
        self.assertLess(scale, 0.5 * self.SIDE / (1.1 * 20) + 0.1)
        self.assertLess(abs(found - scale * wanted).max(), 1.5, (arguments, found, wanted))

    def test_view(self):
        for degrees in (-120, -30, 45, 90, 180):
            c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            self.assert_seen([c, s, 0], [0, 0, 1], "--azimuth", degrees)
            self.assert_seen([1, 0, 0], [0, s, c], "--elevation", degrees)
            self.assert_seen([c, 0, -s], [s, 0, c], "--roll", degrees)
        head, back = [0, 0, 1], [0, 1, 0]
        for side, right, up in (("anterior", [1, 0, 0], head), ("posterior", [-1, 0, 0], head),
                                ("left", back, head), ("right", [0, -1, 0], head),
                                ("superior", [1, 0, 0], back), ("inferior", [1, 0, 0], [0, -1, 0])):
            self.assert_seen(right, up, "--view", side)
        for mode in MODES:
            self.assert_seen([1, 0, 0], head, "--mode", mode)

    def test_zoom_and_perspective(self):
        """The eye is where it sees the volume's sphere in the angle, the block 5 mm behind it."""
        for words in ((), ("--perspective", 60)):
            once, half = self.find(*words), self.find(*words, "--zoom", 0.5)
            self.assertLess(abs(0.5 * once - half).max(), 1)
        for angle in (60, 110):
            eye = math.sqrt(3) * 20 / math.sin(math.radians(angle / 2))
            scale = 0.5 * self.SIDE / math.tan(math.radians(angle / 2))
            for azimuth, right, depth in ((0, 8, 5), (180, -8, -5)):
                found = self.find("--perspective", angle, "--azimuth", azimuth)
                wanted = numpy.array([right, -11]) * scale / (eye + depth)
                self.assertLess(abs(found - wanted).max(), 0.7, (angle, azimuth, found, wanted))

    def test_parts(self):
        """The block's centre lies 5 mm behind the middle; it is voxel (28, 25, 9)."""
        boxes = []
        for axis, place in enumerate((28, 25, 9)):
            for low, high in ((place - 3, place + 3), (place + 3, 40), (0, place - 3)):
                box = [0, 40, 0, 40, 0, 40]
                box[2 * axis:2 * axis + 2] = low, high
                boxes.append((low < place < high, "--crop", ",".join(map(str, box))))
        for is_shown, *words in (
                (False, "--slab", 5), (True, "--slab", 11), (True, "--slab", 3, "--slab-offset", -5),
                (False, "--slab", 3, "--slab-offset", 5),
                (True, "--slab", 3, "--slab-offset", 5, "--azimuth", 180), *boxes):
            self.assertEqual(self.show(*words)[20:].max() > 100, is_shown, words)
        result = self.run_program(self.file, "--crop", "100,140,0,40,0,40")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"^splatmip: no part of the volume.*\.\n$")

    def test_kernel(self):
        """The kernel changes the picture of high, and a wider one is smoother."""
        trilinear, narrow, wide = (
            self.show("--kernel", *words) for words in (
                ("trilinear",), ("cosine-bell", "--kernel-radius", 0.6), ("cosine-bell", "--kernel-radius", 1.5)))
        self.assertTrue((trilinear == self.show()).all())
        self.assertFalse((trilinear == narrow).all())
        self.assertGreater((wide[20:] > 0).sum(), (narrow[20:] > 0).sum())

    def test_blends(self):
        """The block is 3 of 41 voxels deep; minima do not show it, until all else is brighter."""
        self.assertGreater(self.show("--blend", "max")[20:].max(), 250)
        self.assertEqual(self.show("--blend", "min")[20:].max(), 0)
        self.assertLess(abs(self.show("--blend", "mean")[20:].max() - 255 * 3 / 41), 2)
        front, back = (self.show("--depth-shading", "--azimuth", angle)[20:].max() for angle in (0, 180))
        self.assertGreater(front, 20)
        self.assertGreater(back, front + 10)  # nearer, and brighter
        self.write(1000 - self.values)
        pixels = self.show("--blend", "min")[20:, :, 0]
        self.assertEqual(pixels[80, 100], 255)
        rows, columns = numpy.nonzero((pixels < 10) & (abs(numpy.arange(200) - 100) < 60))
        inside = (rows > 15) & (rows < 160)
        self.assertLess(abs(columns[inside].mean() - 100 - 8 * 4.5), 4)

    def test_signed(self):
        """Blocks of 1000 above and below the origin are yellow and cyan; elsewhere it is black."""
        for origin in (0, 300):
            self.values[:] = origin
            self.values[10:14, 20:23, 24:27] = origin + 1000
            self.values[30:34, 20:23, 24:27] = origin - 1000
            self.write(self.values)
            pixels = self.draw(self.file, "--no-marks", "--size", "200x200", "--blend", "signed", "--origin",
                               origin, "--output", "a.png")[0][20:]
            yellow, cyan = ((abs(pixels - colour) < 8).all(axis=2)
                            for colour in ((255, 255, 153), (153, 255, 255)))
            self.assertLess(abs(int(yellow.sum()) - int(cyan.sum())), 40)
            self.assertGreater(yellow.sum(), 40)  # 2 x 3 voxels of at least 2.6 x 2.6 pixels
            self.assertGreater(numpy.nonzero(yellow)[0].mean(), numpy.nonzero(cyan)[0].mean())
            self.assertGreater((pixels < 8).all(axis=2).mean(), 0.8)  # 0 is between two of 256 colours

    def test_default_window(self):
        """Of maxima, minima and means something is seen where neither user nor file give a window."""
        wavelet = vtk.vtkRTAnalyticSource()
        wavelet.Update()
        path = splatmip.write_with(vtk.vtkXMLImageDataWriter(), wavelet.GetOutput(), self.path("w.vti"))
        for blend in ("max", "min", "mean"):
            pixels, _ = self.draw(path, "--blend", blend, "--mode", "standard", "--output", "a.png")
            self.assertGreater(pixels[60:].std(), 20, blend)

    def test_depth_coding(self):
        """The hue shows how far the block is behind the middle, the brightness what it was."""
        for words, low, high in (  # the volume is 40 deep
                (("--azimuth", 0), 24 / 40, 26 / 40), (("--azimuth", 180), 14 / 40, 16 / 40),
                (("--azimuth", 90), 11 / 40, 13 / 40), (("--perspective", 60), 24 / 40, 26 / 40),
                (("--slab", 4, "--slab-offset", -6), 0, 0.5)):  # from 4 to 8 mm
            colors = self.show("--depth-coding", "--mode", "exact", *words)[60:]
            grays = self.show("--mode", "exact", *words)[60:, :, 0]
            self.assertLessEqual(abs(colors.max(axis=2) - grays).max(), 1)
            # From red over green to blue there is none of the third colour.
            self.assertEqual(colors.min(axis=2).max(), 0)
            rows, columns = numpy.nonzero(grays > 200)
            self.assertGreater(len(rows), 5)
            depths = find_depths(colors[rows, columns])
            self.assertGreater(depths.min(), low - 0.03)
            self.assertLess(depths.max(), high + 0.03)
        # The legend has lengths where the file has.
        legends = [self.draw(path, "--depth-coding", "--mode", "exact", "--no-marks", "--output", "a.png")[0][:60, :300]
                   for path in (self.file, splatmip.write_vti(self.path("a.vti")))]
        for legend in legends:
            self.assertGreater((legend[20:, :150] == 255).all(axis=2).sum(), 100)
        self.assertFalse((legends[0] == legends[1]).all())

    def test_window_and_colormap(self):
        gray = self.show()
        self.assertGreater(len(numpy.unique(gray)), 20)
        for words, scale, offset in ((("--window", 500, "--level", 250), 2, 0), (("--window", 500, "--level", 750), 2, 255)):
            expected = numpy.clip(scale * gray - offset, 0, 255)
            self.assertLessEqual(abs(expected - self.show(*words))[20:].max(), 1.5)
        for name, points in COLORMAPS.items():
            places, *colors = numpy.array(points).T
            expected = numpy.stack([numpy.interp(gray[:, :, 0] / 255, places, color) for color in colors], axis=2)
            self.assertLessEqual(abs(self.show("--colormap", name) - 255 * expected).max(), 1, name)
        expected = gray * numpy.array([255, 165, 0]) / 255
        self.assertLessEqual(abs(self.show("--color", "orange") - expected).max(), 1)


def blend(below, above, opacity, blending):
    """A picture on top of another one, as bytes."""
    if blending == "over":
        return (opacity * above + (255 - opacity) * below + 127) // 255
    return numpy.minimum(below + above, 255) if blending == "add" else numpy.maximum(below, above)


class TestSeveral(splatmip.SplatmipTest):
    """Several volumes in one picture."""
    COSINE, SINE = math.cos(0.3), math.sin(0.3)
    PLACES = numpy.array([[1.5 * COSINE, -SINE, 0, 30], [1.5 * SINE, COSINE, 0, -20], [0, 0, 2, 10.0]])

    def turn(self, *arguments):
        """All pixels of two views, without label and marks."""
        self.run_well("--size", "50x60", "--rotate", 2, "--output", "a.png", "--no-marks", *arguments)
        return numpy.stack([splatmip.read_picture(self.path(f"a-0000{n}.png")) for n in range(2)])

    def test_blending(self):
        """The picture is what NumPy makes of those of single volumes; the order matters to over only."""
        places, random = self.PLACES, numpy.random.default_rng()
        files = [splatmip.write_meta(self.path(f"{n}.mha"), random.integers(0, top, (9, 10, 11), numpy.int16), places)
                 for n, top in enumerate((200, 1000, 30000))]
        grays = [self.turn(file) for file in files]
        for names, looks in ((("red", "lime", "orange"), [("--color", name) for name in ("red", "lime", "orange")]),
                             ((), (("--colormap", "gray"), ("--colormap", "hot"), ("--colormap", "hot")))):
            singles = [self.turn(file, *look) for file, look in zip(files, looks)]
            for blending in ("over", "add", "maximum"):
                order = [0, *random.permutation([1, 2])] if not names else random.permutation(3)
                expected = singles[order[0]]
                for n in order[1:]:
                    expected = blend(expected, singles[n], grays[n], blending)
                for each, is_equal in ((order, True), (order[::-1], blending != "over"))[:2 if names else 1]:
                    colors = ("--color", ",".join(names[n] for n in each)) if names else ()
                    picture = self.turn(*(files[n] for n in each), "--blending", blending, *colors)
                    self.assertEqual((picture == expected).all(), is_equal, (blending, names, each))
                self.assertFalse(any((expected == single).all() for single in singles))

    def test_grids(self):
        """A part of a grid, with its axes in another order, is where the whole has the same values."""
        places, random = self.PLACES, numpy.random.default_rng()
        inside = numpy.zeros((11, 10, 9), numpy.int16)  # for any seed black is 0 and white is 1000
        inside[5:8, 4:7, 5:7] = 1000 * random.integers(0, 2, (3, 3, 2))
        inside[6, 5, 5] = 1000
        whole = splatmip.write_meta(self.path("whole.mha"), inside, places)
        other = numpy.zeros_like(inside)
        other[1:4, 1:9, 1:8] = 1000
        other = splatmip.write_meta(self.path("other.mha"), other, places)
        turned = numpy.column_stack([places[:, 2], places[:, 0], places[:, 1], places @ [3, 2, 4, 1]])
        part = splatmip.write_meta(self.path("part.mha"), inside[4:9, 2:8, 3:8].transpose(1, 2, 0).copy(), turned)
        for words in ((), ("--perspective", 40), ("--slab", 12)):
            words = ("--color", "red,lime", "--blending", "add", "--mode", "exact", *words)
            wanted = self.turn(other, whole, *words)
            self.assertGreater(wanted[..., 1].max(), 100)
            found = self.turn(other, part, *words), self.turn(part, other, *words)[..., [1, 0, 2]]
            for picture in found:  # rounding
                self.assertLessEqual(abs(picture - wanted).max(), 1, words)
        far = splatmip.write_meta(self.path("far.mha"), None, places + [0, 0, 0, 1e8])
        self.assert_several_refused(far, "far apart")
        self.assert_several_refused(splatmip.write_vti(self.path("a.vti")), "orientation")

    def assert_several_refused(self, path, words):
        result = self.run_program(self.path("whole.mha"), path, "--blending", "add")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"\Asplatmip: [^\n]*" + words + r"[^\n]*\.\n\Z")


def draw_letter(letter):
    """A letter as VTK draws it, less the room around."""
    style, image, size = vtk.vtkTextProperty(), vtk.vtkImageData(), [0, 0]
    style.SetFontSize(8)
    vtk.vtkTextRenderer.GetInstance().RenderString(style, letter, image, size, 72)
    columns, rows, _ = image.GetDimensions()
    return crop(vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, 4)[::-1, :, 3])


def crop(ink):
    rows, columns = ink.any(axis=1).nonzero()[0], ink.any(axis=0).nonzero()[0]
    return ink[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]


class TestMarks(splatmip.SplatmipTest):
    SIZE = 240

    def show(self, path, *arguments):
        """What the marks have added, the label left out."""
        with_marks, without = (
            self.draw(path, "--mode", "preview", "--size", f"{self.SIZE}x{self.SIZE}", "--output", "a.png",
                      *arguments, *more)[0][:, :, 0] for more in ((), ("--no-marks",)))
        return with_marks - without

    def cut(self, marks):
        """The letters at the left, the right, the top and the bottom, less the room around."""
        half = slice(self.SIZE // 2 - 20, self.SIZE // 2 + 20)
        return [crop(part) for part in (marks[half, :40], marks[half, -40:], marks[:20, half], marks[-20:, half])]

    def test_sides(self):
        """Each of the six letters is where it belongs."""
        path = splatmip.write_meta(self.path("a.mha"))
        for view, names in {"anterior": "RLHF", "posterior": "LRHF", "left": "APHF", "right": "PAHF",
                            "superior": "RLPA", "inferior": "RLAP"}.items():
            for name, pixels in zip(names, self.cut(self.show(path, "--view", view))):
                self.assertTrue(numpy.array_equal(pixels, draw_letter(name)), (view, name))
        straight, near, aslant = (self.cut(self.show(path, "--azimuth", degrees, "--elevation", 0))[0]
                                  for degrees in (0, 14, 20))
        self.assertTrue((near == straight).all())
        self.assertGreater(aslant.shape[1], 1.5 * straight.shape[1])  # RA

    def test_scale_bar(self):
        """The 26 mm of 14 voxels fit into the height with a rim of a tenth; a bar of 5 mm."""
        path = splatmip.write_meta(self.path("a.mha"))
        for zoom, length in ((1, 5), (4, 1)):
            row = self.show(path, "--view", "anterior", "--zoom", zoom)[-4, self.SIZE // 2 + 20:]
            self.assertLess(abs((row > 0).sum() - zoom * length * self.SIZE / (1.1 * 26)), 1.5)

    def test_unknown(self):
        """There are no marks if the file has neither orientation nor unit."""
        self.assertFalse(self.show(splatmip.write_vti(self.path("a.vti"))).any())


if __name__ == "__main__":
    splatmip.main()
