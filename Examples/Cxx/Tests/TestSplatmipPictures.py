# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stills: modes, options, what is said, and when."""
import math
import os

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import SplatmipTesting as splatmip


# Colour maps as --colormap has them: place from black to white, red, green, blue.
COLORMAPS = {
    "inverted": [(0, 1, 1, 1), (1, 0, 0, 0)],
    "hot": [(0, 0, 0, 0), (0.375, 1, 0, 0), (0.75, 1, 1, 0), (1, 1, 1, 1)],
    "bone": [(0, 0, 0, 0), (0.375, 0.33, 0.33, 0.45), (0.75, 0.66, 0.78, 0.78), (1, 1, 1, 1)]}


def find_depths(colors):
    """The share of the way from red, 0, over green to blue, 1; one of the three is 0."""
    red, green, blue = colors.T
    largest = colors.max(axis=1)
    return numpy.where(blue == 0, numpy.where(red >= green, green / largest, 2 - red / largest),
                       numpy.where(green >= blue, 2 + blue / largest, 4 - green / largest)) / 4


class TestPictures(splatmip.SplatmipTest):
    def show(self, *arguments, **options):
        """The block from the front, without the label, and the text."""
        path = splatmip.write_vti(self.path("a.vti"))
        pixels, text = self.draw(path, "--size", "128x128", "--window", "1000", "--level", "500",
                                 "--output", "a.png", *arguments, **options)
        return pixels[28:, :, 0], text

    def assert_shows_block(self, pixels):
        """The bright block is at the left and the feet, which is right and below in the picture."""
        self.assertGreater(pixels[50:, 66:].max(), 250)
        # A footprint and the warp reach 2.5 voxels beyond the block.
        self.assertEqual(pixels[:, :56].max(), 0)
        self.assertEqual(pixels[:34, :].max(), 0)

    def test_default(self):
        pixels, text = self.draw()
        self.assertEqual(pixels.shape, (600, 400, 3))
        self.assertEqual(os.listdir(self.scratch.name), ["splatmip.png"])
        self.assertIn("128 x 128 x 256", text)
        self.assertNotIn(" ms", text)
        self.assert_shows_something(pixels)
        exact, _ = self.draw("--mode", "exact")
        self.assertTrue((pixels == exact).all())

    def test_all_modes(self):
        """Side by side, each as it is by itself."""
        pixels, _ = self.draw("--mode", "all")
        self.assertEqual(pixels.shape, (600, 1600, 3))
        for n, mode in enumerate(("preview", "standard", "high", "exact")):
            part = pixels[:, 400 * n : 400 * (n + 1)]
            self.assert_shows_something(part)
            alone, _ = self.draw("--mode", mode)
            self.assertTrue((part == alone).all())
        for other in (("--rotate", "4"), ("--output", "a.mha"), ("--interactive",)):
            self.assert_refused("--mode", "all", *other, word="all is for stills", code=2)

    def assert_shows_something(self, pixels):
        self.assertEqual(pixels.max(), 255)
        self.assertEqual(pixels[:20, :100].max(), 255)  # the label
        self.assertEqual(pixels[-12:].max(), 0)

    def test_options(self):
        pixels, text = self.draw(
            "--mode", "high", "--kernel", "cosine-bell", "--kernel-radius", "1.25",
            "--azimuth", "-30", "--elevation", "90", "--roll", "15", "--window", "400", "--level",
            "-50", "--colormap", "inverted", "--size", "120x80", "--zoom", "2", "--output", "a.png")
        self.assertEqual(pixels.shape, (80, 120, 3))
        self.assertIn("window 400, level -50", text)

    def test_modes(self):
        """Each mode shows the bright block where it is, and from aslant a picture of its own."""
        pictures = set()
        for mode in ("preview", "standard", "high", "exact"):
            pixels, _ = self.show("--mode", mode, "--azimuth", "0", "--elevation", "0")
            self.assert_shows_block(pixels)
            pixels, _ = self.show("--mode", mode, "--azimuth", "20", "--elevation", "10")
            self.assertGreater(pixels.max(), 250, mode)
            pictures.add(pixels.tobytes())
        self.assertEqual(len(pictures), 4)

    def test_kernel(self):
        """The kernel changes the picture of high, and a wider one is smoother."""
        def show(*arguments):
            pixels, _ = self.show("--mode", "high", *arguments)
            return pixels
        trilinear, narrow = show("--kernel", "trilinear"), show("--kernel", "cosine-bell", "--kernel-radius", "0.6")
        wide = show("--kernel", "cosine-bell", "--kernel-radius", "1.5")
        self.assertTrue((trilinear == show()).all())
        self.assertFalse((trilinear == narrow).all())
        self.assertGreater((wide > 0).sum(), (narrow > 0).sum())

    def test_compare(self):
        """Times are taken, and written into the picture, only where they are asked for."""
        plain, _ = self.show("--mode", "preview")
        for mode in ("preview", "standard", "high", "exact"):
            _, text = self.show("--mode", mode, "--compare", has_display=True)
            self.assertRegex(text, rf"(?m)^{mode} .* ms .* ms \((nearest|linear)\)")
        compared, _ = self.show("--mode", "preview", "--compare", has_display=True)
        self.assertTrue((compared == plain).all())

    def test_beforehand(self):
        """What would be in vain is told before the volume is looked at."""
        self.assert_refused("missing.vti", "--compare", word="no display")
        self.assert_refused("missing.vti", "--interactive", word="no display")
        self.assert_refused("missing.vti", "--output", "no/a.png", word="no/a.png: this cannot")
        self.assert_refused("missing.vti", "--rotate", "2", "--out", "no/a.png",
                            word="no/a-00000.png: this cannot")
        self.assert_refused("missing.vti", "--output", "a.png", word="no such file")
        self.assertEqual(os.listdir(self.scratch.name), [])
        for both in (("--compare", "--interactive"), ("--compare", "--rotate", "4")):
            self.assert_refused(*both, word="choose one", code=2)

    def test_version(self):
        result = self.run_program("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"^splatmip \d+\.\d+\.\d+, VTK \d+\.\d+\.\d+\n$")

    def test_help(self):
        """Options in groups, and three commands, of which each option is one that there is."""
        text = self.run_program("--help").stdout
        for group in ("What is projected", "How values are shown", "From where", "What comes out"):
            self.assertIn(f"\n{group}:\n", text)
        options, examples = text.split("Examples:")
        commands = [line.split() for line in examples.splitlines() if line.startswith("  splatmip")]
        self.assertEqual(len(commands), 3)
        for command in commands:
            for option in filter(lambda word: word.startswith("--"), command):
                self.assertRegex(options, rf"(?m)^  {option}\b")


class TestOptions(splatmip.SplatmipTest):
    SIDE = 200

    def setUp(self):
        """A small block to the left, the back and the feet of the middle."""
        super().setUp()
        image = vtk.vtkImageData()
        image.SetDimensions(41, 41, 41)
        image.AllocateScalars(vtk.VTK_SHORT, 1)
        scalars = image.GetPointData().GetScalars()
        scalars.SetName("intensity")
        scalars.Fill(0)
        self.block = numpy.array([8, 5, -11])  # from the middle, mm: left, back, head
        for offset in numpy.ndindex(3, 3, 3):
            image.SetScalarComponentFromDouble(*(int(n) for n in 19 + self.block + offset), 0, 1000)
        self.file = splatmip.write_with(vtk.vtkXMLImageDataWriter(), image, self.path("b.vti"))

    def show(self, *arguments):
        options = {"--azimuth": 0, "--elevation": 0, "--window": 1000, "--level": 500,
                   "--mode": "high", "--size": f"{self.SIDE}x{self.SIDE}", "--output": "a.png"}
        for name in {"--azimuth", "--elevation"} if "--view" in arguments else arguments:
            options.pop(name, None)
        words = [*(word for item in options.items() for word in item), *arguments]
        return self.draw(self.file, *(str(word) for word in words))[0]

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
        for degrees in (-120, -30, 0, 45, 90, 180):
            c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            self.assert_seen([c, s, 0], [0, 0, 1], "--azimuth", degrees)
            self.assert_seen([1, 0, 0], [0, s, c], "--elevation", degrees)
            self.assert_seen([c, 0, -s], [s, 0, c], "--roll", degrees)

    def test_sides(self):
        head, back = [0, 0, 1], [0, 1, 0]
        for side, right, up in (("anterior", [1, 0, 0], head), ("posterior", [-1, 0, 0], head),
                                ("left", back, head), ("right", [0, -1, 0], head),
                                ("superior", [1, 0, 0], back), ("inferior", [1, 0, 0], [0, -1, 0])):
            self.assert_seen(right, up, "--view", side)
        self.assert_refused("--view", "left", "--azimuth", "7", word="--view", code=2)

    def assert_shown(self, is_shown, *arguments):
        brightest = self.show(*arguments)[20:].max()
        self.assertEqual(brightest > 100, is_shown, (arguments, brightest))

    def test_slab(self):
        """The block lies 4 to 6 mm behind the middle."""
        self.assert_shown(False, "--slab", 5)
        self.assert_shown(True, "--slab", 11)
        self.assert_shown(True, "--slab", 3, "--slab-offset", -5)
        self.assert_shown(False, "--slab", 3, "--slab-offset", 5)
        self.assert_shown(True, "--slab", 3, "--slab-offset", 5, "--azimuth", 180)
        self.assert_refused("--slab-offset", "5", word="--slab", code=2)
        self.assert_refused("--slab", "3", "--slab-offset", "5", "--rotate", "9",
                            word="stills", code=2)

    def test_crop(self):
        """The block's middle is voxel (28, 25, 9) of 41 in each direction."""
        for axis, place in enumerate((28, 25, 9)):
            whole = [0, 40, 0, 40, 0, 40]
            for low, high in ((place - 3, place + 3), (place + 3, 40), (0, place - 3)):
                whole[2 * axis:2 * axis + 2] = low, high
                self.assert_shown(low < place < high, "--crop", ",".join(map(str, whole)))
        self.assert_refused("--crop", "0,40,0,40,9,9", word="must rise", code=2)
        self.assert_refused("--crop", "0,40,0,40", code=2)
        self.assert_fails("--crop", "100,140,0,40,0,40", word="nothing of the volume")

    def assert_fails(self, *arguments, word):
        """After the volume is told of."""
        result = self.run_program(self.file, *arguments)
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, rf"^splatmip: .*{word}.*\.\n$")

    def test_blends(self):
        """The block is 3 of 41 voxels deep; minima do not see it, until all else is brighter."""
        self.assertGreater(self.show("--blend", "max")[20:].max(), 250)
        self.assertEqual(self.show("--blend", "min")[20:].max(), 0)
        self.assertLess(abs(self.show("--blend", "mean")[20:].max() - 255 * 3 / 41), 2)
        shift = vtk.vtkImageShiftScale()
        reader = vtk.vtkXMLImageDataReader()
        reader.SetFileName(self.file)
        shift.SetInputConnection(reader.GetOutputPort())
        shift.SetScale(-1)
        shift.SetShift(-1000)
        shift.Update()
        splatmip.write_with(vtk.vtkXMLImageDataWriter(), shift.GetOutput(), self.file)
        pixels = self.show("--blend", "min")[20:, :, 0]
        self.assertEqual(pixels[80, 100], 255)
        rows, columns = numpy.nonzero((pixels < 10) & (abs(numpy.arange(200) - 100) < 60))
        inside = (rows > 15) & (rows < 160)
        self.assertLess(abs(columns[inside].mean() - 100 - 8 * 4.5), 4)

    def test_depth_shading(self):
        """From the back the block is nearer, and brighter."""
        front, back = (self.show("--depth-shading", "--azimuth", angle)[20:].max()
                       for angle in (0, 180))
        self.assertGreater(front, 20)
        self.assertGreater(back, front + 10)
        self.assert_refused("--depth-shading", "--blend", "min", word="for maxima", code=2)

    def test_depth_coding(self):
        """The hue says how far the block is behind the middle, the brightness what it was."""
        def find(*arguments):
            colors = self.show("--depth-coding", "--mode", "exact", *arguments)[60:]
            grays = self.show("--mode", "exact", *arguments)[60:, :, 0]
            self.assertLessEqual(abs(colors.max(axis=2) - grays).max(), 1)
            # From red over green to blue there is none of the third colour.
            self.assertEqual(colors.min(axis=2).max(), 0)
            rows, columns = numpy.nonzero(grays > 200)
            self.assertGreater(len(rows), 5)
            return find_depths(colors[rows, columns])
        for azimuth, places in ((0, (4, 6)), (180, (-6, -4)), (90, (-9, -7))):
            depths = find("--azimuth", azimuth)
            low, high = ((place + 20) / 40 for place in places)  # the volume is 40 deep
            self.assertGreater(depths.min(), low - 0.03)
            self.assertLess(depths.max(), high + 0.03)
        depths = find("--slab", 4, "--slab-offset", -6)  # from 4 to 8 mm
        self.assertLess(depths.max(), 0.53)
        depths = find("--perspective", 60)
        self.assertGreater(depths.min(), 24 / 40 - 0.03)
        self.assertLess(depths.max(), 26 / 40 + 0.03)
        for words in (("--blend", "mean"), ("--colormap", "hot"), ("--output", "v.nii"), ("--compare",)):
            self.assert_refused("--depth-coding", *words, code=2)

    def test_depth_legend(self):
        """The text in the picture says how far red and blue are, where the file knows."""
        told, silent = (self.draw(path, "--depth-coding", "--mode", "exact", "--no-marks",
                                  "--output", "a.png")[0]
                        for path in (splatmip.write_nrrd(self.path("a.nrrd")), self.file))
        for picture in (told, silent):
            self.assertGreater((picture[20:60, :150] == 255).all(axis=2).sum(), 100)
        self.assertFalse((told[:60, :300] == silent[:60, :300]).all())

    def test_looks_of_blends(self):
        """Where nothing is said, of minima and means something is seen, too."""
        wavelet = vtk.vtkRTAnalyticSource()
        wavelet.Update()
        path = splatmip.write_with(
            vtk.vtkXMLImageDataWriter(), wavelet.GetOutput(), self.path("w.vti"))
        for blend in ("max", "min", "mean"):
            pixels, _ = self.draw(path, "--blend", blend, "--mode", "standard", "--output", "a.png")
            self.assertGreater(pixels[60:].std(), 20, blend)

    def test_compare_refuses(self):
        for words in (("--slab", "5"), ("--blend", "mean"), ("--crop", "0,1,0,1,0,1"),
                      ("--depth-shading",)):
            self.assert_refused("--compare", *words, word="whole volume", code=2)

    def test_perspective(self):
        """The eye is where it sees the volume's sphere in the angle, the block 5 mm behind it."""
        for angle in (60, 110):
            eye = math.sqrt(3) * 20 / math.sin(math.radians(angle / 2))
            scale = 0.5 * self.SIDE / math.tan(math.radians(angle / 2))
            for azimuth, right, depth in ((0, 8, 5), (180, -8, -5)):
                found = self.find("--perspective", angle, "--azimuth", azimuth)
                wanted = numpy.array([right, -11]) * scale / (eye + depth)
                self.assertLess(abs(found - wanted).max(), 0.7, (angle, azimuth, found, wanted))
        once, half = self.find("--perspective", 60), self.find("--perspective", 60, "--zoom", 0.5)
        self.assertLess(abs(0.5 * once - half).max(), 1)
        self.assert_refused("--perspective", "150", word="from 1 to 120", code=2)
        self.draw(self.file, "--perspective", "30", "--mode", "preview", "--compare", "--output",
                  "a.png", has_display=True)

    def test_zoom(self):
        once, half = self.find(), self.find("--zoom", 0.5)
        self.assertLess(abs(0.5 * once - half).max(), 1)

    def test_window(self):
        pixels, brighter = self.show(), self.show("--window", 500, "--level", 250)
        clipped = self.show("--window", 500, "--level", 750)
        rows = slice(20, None)  # below the label
        self.assertLessEqual(abs(numpy.clip(2 * pixels, 0, 255) - brighter)[rows].max(), 1.5)
        self.assertLessEqual(abs(numpy.clip(2 * pixels - 255, 0, 255) - clipped)[rows].max(), 1.5)

    def test_colormap(self):
        gray = self.show()
        self.assertGreater(len(numpy.unique(gray)), 20)
        self.assertEqual(numpy.ptp(gray, axis=2).max(), 0)
        for name, points in COLORMAPS.items():
            places, *colors = numpy.array(points).T
            expected = numpy.stack([numpy.interp(gray[:, :, 0] / 255, places, color)
                                    for color in colors], axis=2)
            found = self.show("--colormap", name)
            self.assertLessEqual(abs(found - 255 * expected).max(), 1, name)


def draw_letter(letter):
    """A letter as VTK draws it, less the room around."""
    style, image, size = vtk.vtkTextProperty(), vtk.vtkImageData(), [0, 0]
    style.SetFontSize(8)
    vtk.vtkTextRenderer.GetInstance().RenderString(style, letter, image, size, 72)
    columns, rows, _ = image.GetDimensions()
    ink = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, 4)[::-1, :, 3]
    rows, columns = ink.any(axis=1).nonzero()[0], ink.any(axis=0).nonzero()[0]
    return ink[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1]


class TestMarks(splatmip.SplatmipTest):
    SIZE = 240

    def show(self, *arguments, name="a.nrrd"):
        """What the marks have added, the label left out."""
        with_marks, without = (
            self.draw(self.path(name), "--mode", "preview", "--size", f"{self.SIZE}x{self.SIZE}",
                      "--output", "a.png", *arguments, *more)[0][:, :, 0]
            for more in ((), ("--no-marks",)))
        return with_marks - without

    def cut(self, marks):
        """The letters at the left, the right, the top and the bottom, less the room around."""
        half = slice(self.SIZE // 2 - 20, self.SIZE // 2 + 20)
        parts = [marks[half, :40], marks[half, -40:], marks[:20, half], marks[-20:, half]]
        cut = []
        for part in parts:
            rows, columns = part.any(axis=1).nonzero()[0], part.any(axis=0).nonzero()[0]
            self.assertGreater(len(rows), 3)
            cut.append(part[rows[0]:rows[-1] + 1, columns[0]:columns[-1] + 1])
        return cut

    def test_sides(self):
        """Each of the six letters is where it belongs."""
        splatmip.write_nrrd(self.path("a.nrrd"))
        views = {"anterior": "RLHF", "posterior": "LRHF", "left": "APHF", "right": "PAHF",
                 "superior": "RLPA", "inferior": "RLAP"}
        for view, names in views.items():
            for name, pixels in zip(names, self.cut(self.show("--view", view))):
                self.assertTrue(numpy.array_equal(pixels, draw_letter(name)), (view, name))
        straight = self.cut(self.show("--view", "anterior"))
        near = self.cut(self.show("--azimuth", "14", "--elevation", "0"))
        aslant = self.cut(self.show("--azimuth", "20", "--elevation", "0"))
        self.assertTrue((near[0] == straight[0]).all())
        self.assertGreater(aslant[0].shape[1], 1.5 * straight[0].shape[1])  # RA

    def test_scale_bar(self):
        """The 26 mm of 14 voxels fit into the height with a rim of a tenth; a bar of 5 mm."""
        splatmip.write_nrrd(self.path("a.nrrd"))
        marks = self.show("--view", "anterior")
        row = marks[-4, self.SIZE // 2 + 20:]
        pixels = self.SIZE / (1.1 * 26)  # of a mm
        self.assertLess(abs((row > 0).sum() - 5 * pixels), 1.5)
        row = self.show("--view", "anterior", "--zoom", "4")[-4, self.SIZE // 2 + 20:]
        self.assertLess(abs((row > 0).sum() - 4 * 1 * pixels), 1.5)

    def test_unknown(self):
        """Nothing is claimed that the file does not say."""
        splatmip.write_vti(self.path("a.vti"))
        self.assertFalse(self.show(name="a.vti").any())


if __name__ == "__main__":
    splatmip.main()
