# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Stills: modes, options, what is said, and when."""
import os

import SplatmipTesting as splatmip


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
        self.assertEqual(pixels.shape, (600, 1200, 3))
        self.assertEqual(os.listdir(self.scratch.name), ["splatmip.png"])
        self.assertIn("128 x 128 x 256", text)
        self.assertNotIn(" ms", text)
        for third in (pixels[:, :400], pixels[:, 400:800], pixels[:, 800:]):
            self.assertEqual(third.max(), 255)
            self.assertEqual(third[:20, :100].max(), 255)  # the label
            self.assertEqual(third[-12:].max(), 0)

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
        trilinear, narrow = show(), show("--kernel", "cosine-bell", "--kernel-radius", "0.6")
        wide = show("--kernel", "cosine-bell", "--kernel-radius", "1.5")
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


if __name__ == "__main__":
    splatmip.main()
