# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/web_viewer.py in Chromium: what a user does, and what the picture must be then.

Ends with 77 where there is no Chromium or Selenium.
"""
import base64
import re
import sys
import unittest

import numpy

import BrowserTesting
import WebViewerTesting as testing
from BrowserTesting import Keys
from WebViewerTesting import View

SKIPPED = 77
STILL = "typeof volume === 'object' && shown > 0 && shown === version && !isMoving"
GRAY = """(() => {
  const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  let gray = "";
  for (let i = 0; i < data.length; i += 4) {
    gray += String.fromCharCode(data[i], data[i + 1], data[i + 2]);
  }
  return [canvas.width, canvas.height, btoa(gray)];
})()"""
# Keeps each picture of the type JPEG that the page shows, and counts requests that it gives up.
RECORDER = """
  window.givenUp = 0;
  const pageFetch = window.fetch;
  window.fetch = async (...what) => {
    try {
      return await pageFetch(...what);
    } catch (error) {
      window.givenUp += error.name === "AbortError" ? 1 : 0;
      throw error;
    }
  };
  window.moved = [];
  const decode = window.createImageBitmap;
  window.createImageBitmap = async blob => {
    if (blob.type === "image/jpeg") {
      window.moved.push(blob);
    }
    return await decode(blob);
  };
"""
MOVED = """Promise.all(moved.map(async blob => {
  const bytes = new Uint8Array(await blob.arrayBuffer());
  return btoa(Array.from(bytes, byte => String.fromCharCode(byte)).join(""));
}))"""


class TestWebViewerInBrowser(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.viewer_context, cls.page_context = testing.running_viewer(), BrowserTesting.browser_page()
        cls.viewer, cls.page = cls.viewer_context.__enter__(), cls.page_context.__enter__()
        cls.info = cls.viewer.get_json("volume")
        cls.page.run_first(RECORDER)

    @classmethod
    def tearDownClass(cls):
        cls.page_context.__exit__(None, None, None)
        cls.viewer_context.__exit__(None, None, None)

    def setUp(self):
        self.page.errors()
        self.page.open("about:blank", 700, 400)
        self.page.open(self.viewer.address, 700, 400)
        self.page.wait_for(STILL)
        self.page.evaluate("void moved.splice(0)")
        self.view = View(self.info, self.size())

    def tearDown(self):
        self.assertEqual(self.page.errors(), [])

    def size(self):
        return tuple(self.page.evaluate("[canvas.clientWidth, canvas.clientHeight]"))

    def shown(self):
        """Gray[row, column] of the canvas."""
        width, height, gray = self.page.evaluate(GRAY)
        pixels = numpy.frombuffer(base64.b64decode(gray), numpy.uint8).reshape(height, width, 3)
        self.assertTrue((pixels == pixels[:, :, :1]).all())
        return pixels[:, :, 0]

    def check_still(self):
        """A still picture is PNG, which loses nothing: half a step of gray is what rounding may change."""
        self.page.wait_for(STILL)
        found, expected = self.shown(), self.view.picture()
        self.assertEqual(found.shape, expected.shape)
        self.assertGreater(expected.std(), 10.0)
        self.assertLessEqual(abs(found - expected).max(), 0.51)
        self.assertEqual(self.text("mode"), self.view.mode)

    def check_other(self, before):
        """What was done is to be seen: else a test could pass that does nothing."""
        self.assertGreater(abs(self.view.picture() - before).mean(), 1.0)
        self.check_still()

    def degrees(self, pixels):
        return 180.0 * pixels / min(self.view.size)

    def text(self, name):
        return self.page.evaluate(f"document.getElementById('{name}').textContent")

    def click_button(self, name):
        x, y = self.page.evaluate(
            f"(() => {{ const box = [...document.querySelectorAll('button')].find(b => b.textContent === '{name}')"
            ".getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()")
        self.page.click(x, y)

    def set_slider(self, name, steps):
        """By keys, from the least value on."""
        self.page.evaluate(f"document.getElementById('{name}').focus()")
        self.page.press(Keys.HOME)
        for _ in range(steps):
            self.page.press(Keys.ARROW_RIGHT)

    def test_a_drag_turns_the_volume(self):
        before = self.view.picture()
        self.page.drag((150, 200), [(150 + 10 * n, 200) for n in range(1, 7)])
        self.view.turn((0, 1, 0), self.degrees(60))
        self.check_other(before)
        before = self.view.picture()
        self.page.drag((150, 100), [(150, 100 + 10 * n) for n in range(1, 6)])
        self.view.turn((1, 0, 0), self.degrees(50))
        self.check_other(before)
        before = self.view.picture()
        self.page.drag((250, 100), [(250 - 8 * n, 100 + 6 * n) for n in range(1, 8)])
        self.view.turn((6, -8, 0), self.degrees(70))
        self.check_other(before)

    def test_while_moving_pictures_are_jpeg_in_the_quick_mode(self):
        """Each is the preview of a place that the pointer has passed, in this order."""
        self.view.mode = "preview"
        candidates = []
        for _ in range(12):
            self.view.turn((0, 1, 0), self.degrees(10))
            candidates.append(self.view.picture())
        self.page.drag((100, 200), [(100 + 10 * n, 200) for n in range(1, 13)], pause=0.03)
        self.view.mode = "exact"
        self.check_still()
        pictures = [testing.decode(base64.b64decode(text)) for text in self.page.evaluate(MOVED)]
        self.assertGreaterEqual(len(pictures), 2)
        places = []
        for picture in pictures:
            differences = [abs(picture - candidate).mean() for candidate in candidates]
            places.append(int(numpy.argmin(differences)))
            self.assertLess(min(differences), 1.5)
        self.assertEqual(places, sorted(places))
        self.assertGreater(len(set(places)), 1)

    def test_a_drag_gives_up_the_still_picture_that_is_on_its_way(self):
        self.page.set_size(690, 400, 7.0)  # so that it takes a while
        self.page.wait_for(f"canvas.width > 5 * {self.view.size[0]} && {STILL}")
        self.page.evaluate("void (givenUp = 0)")
        self.page.drag((150, 200), [(190, 200)])
        self.page.wait_for("!isMoving && request !== null")
        self.page.drag((150, 200), [(190, 200)])
        self.page.wait_for("givenUp > 0")
        self.page.wait_for(STILL)

    def test_modes_can_be_chosen(self):
        for name, mode in (("moving", "standard"), ("still", "high")):
            self.page.evaluate(f"(() => {{ const e = document.getElementById('{name}'); e.value = '{mode}';"
                               "e.dispatchEvent(new Event('input')); })()")
        self.page.wait_for(STILL)
        self.page.evaluate("void moved.splice(0)")
        before = self.view.picture()
        self.view.mode = "high"
        self.assertGreater(abs(self.view.picture() - before).max(), 5.0)
        self.check_still()
        self.page.drag((100, 200), [(130, 200)])
        self.view.turn((0, 1, 0), self.degrees(30))
        self.check_still()
        last = testing.decode(base64.b64decode(self.page.evaluate(MOVED)[-1]))
        differences = {}
        for self.view.mode in ("preview", "standard", "high", "exact"):
            differences[self.view.mode] = abs(last - self.view.picture()).mean()
        self.assertEqual(min(differences, key=differences.get), "standard", differences)

    def test_the_wheel_zooms(self):
        for delta in (-240, 100):
            before = self.view.picture()
            self.page.wheel(100, 100, delta)
            self.page.wait_for(f"view.extent !== {self.view.extent}")
            self.view.extent *= 1.1 ** (delta / 100)
            self.check_other(before)

    def test_the_right_button_changes_window_and_level(self):
        before = self.view.picture()
        self.page.drag((200, 200), [(180, 190), (136, 230)], button="right")
        self.view.level += self.view.window * 30 / 256
        self.view.window *= 2 ** (-64 / 128)
        self.check_other(before)
        shown = self.page.evaluate("[document.getElementById('window').value, document.getElementById('level').value]")
        numpy.testing.assert_allclose([float(text) for text in shown], (self.view.window, self.view.level), 1e-5)

    def test_window_and_level_can_be_typed(self):
        before = self.view.picture()
        for name, number in (("window", "900"), ("level", "450")):
            self.page.evaluate(f"document.getElementById('{name}').select()")
            self.page.press(number)
        self.view.window, self.view.level = 900.0, 450.0
        self.check_other(before)

    def test_shift_and_the_middle_button_move_the_volume(self):
        for button, key in (("left", Keys.SHIFT), ("middle", None)):
            before = self.view.picture()
            self.page.drag((200, 200), [(230, 190)], button=button, key=key)
            right = numpy.cross(self.view.direction, self.view.up)
            self.view.focal_point = self.view.focal_point - self.view.spacing() * (30 * right + 10 * self.view.up)
            self.check_other(before)

    def test_a_slab_of_a_thickness_at_a_place(self):
        diagonal = numpy.linalg.norm((numpy.array(testing.SIZE) - 1) * testing.SPACING)
        before = self.view.picture()
        self.set_slider("thickness", 29)  # 30 of 200
        self.view.slab = (diagonal * 30 / 200, 0.0)
        self.check_other(before)
        self.assertEqual(self.text("thicknessText"), f"{self.view.slab[0]:.3g} mm")
        before = self.view.picture()
        self.set_slider("offset", 75)  # -25 of 100
        self.view.slab = (diagonal * 30 / 200, -25 / 100 * diagonal / 2)
        self.check_other(before)
        self.assertEqual(self.text("offsetText"), f"{-self.view.slab[1]:.3g} mm before")

    def test_sides_and_their_letters(self):
        sides = {"Posterior": ((0, -1, 0), (0, 0, 1), "HFRL"), "Left": ((-1, 0, 0), (0, 0, 1), "HFPA"),
                 "Right": ((1, 0, 0), (0, 0, 1), "HFAP"), "Superior": ((0, 0, -1), (0, 1, 0), "PALR"),
                 "Inferior": ((0, 0, 1), (0, -1, 0), "APLR"), "Anterior": ((0, 1, 0), (0, 0, 1), "HFLR")}
        for name, (direction, up, letters) in sides.items():
            with self.subTest(name):
                before = self.view.picture()
                self.click_button(name)
                self.view.direction, self.view.up = numpy.array(direction, float), numpy.array(up, float)
                self.check_other(before)
                self.assertEqual("".join(self.text(side) for side in ("up", "down", "right", "left")), letters)
        self.page.drag((150, 200), [(150 + round(min(self.view.size) / 6), 200)])  # 30 degrees
        self.assertEqual([self.text(side) for side in ("up", "down", "right", "left")], ["H", "F", "LA", "RP"])

    def check_pick(self, column, row):
        """What is told of a pixel of the picture in which the bright voxel is seen."""
        self.page.wait_for("document.getElementById('told').textContent.includes(' at ')")
        found = re.fullmatch(r"(\S+) at ([LR]) (\S+), ([AP]) (\S+), ([HF]) (\S+) mm, voxel (\d+) (\d+) (\d+)",
                             self.text("told"))
        self.assertTrue(found, self.text("told"))
        signs = [1.0 if found.group(n) in "LPH" else -1.0 for n in (2, 4, 6)]
        told = numpy.array([float(found.group(n)) for n in (3, 5, 7)]) * signs
        self.assertEqual([int(found.group(n)) for n in (8, 9, 10)], list(testing.BRIGHT))
        place = numpy.array(testing.ORIGIN) + numpy.array(testing.BRIGHT) * testing.SPACING
        x, y = self.view.pixel_of(place)
        self.assertLessEqual(abs(told - place).max(), numpy.hypot(x - column, y - row) * self.view.spacing() + 0.051)
        # The picture is of the whole window: its gray at the pixel tells the value.
        self.view.window, self.view.level = 8000.0, 2000.0
        gray = self.view.picture()[row, column]
        self.assertAlmostEqual(float(found.group(1)), (gray - 127.5) / 255.0 * 8000.0 + 2000.0, delta=0.02)

    def test_a_click_tells_value_and_place(self):
        self.page.drag((150, 200), [(190, 200)])
        self.view.turn((0, 1, 0), self.degrees(40))
        place = numpy.array(testing.ORIGIN) + numpy.array(testing.BRIGHT) * testing.SPACING
        x, y = self.view.pixel_of(place)
        self.page.wait_for(STILL)
        self.page.click(round(x), round(y))
        self.check_pick(round(x), round(y))
        box = self.page.evaluate("(() => { const box = element('mark').getBoundingClientRect();"
                                 "return [box.x + box.width / 2, box.y + box.height / 2]; })()")
        self.assertLess(numpy.hypot(box[0] - x, box[1] - y), 1.5)
        self.page.click(3, 3)
        self.page.wait_for("document.getElementById('told').textContent === 'Nothing is here.'")

    def test_keys_do_all_that_the_pointer_does(self):
        before = self.view.picture()
        for key, axis, degrees in ((Keys.ARROW_RIGHT, (0, 1, 0), 5), (Keys.ARROW_DOWN, (1, 0, 0), 5),
                                   (Keys.ARROW_LEFT, (0, 1, 0), -5), (Keys.ARROW_LEFT, (0, 1, 0), -5)):
            self.page.press(key)
            self.view.turn(axis, degrees)
        self.page.press("+")
        self.view.extent /= 1.1
        self.check_other(before)
        self.page.press(Keys.ENTER)
        self.page.wait_for("document.getElementById('told').textContent.includes(' at ')")
        self.page.press("-")
        self.view.extent *= 1.1
        self.check_other(before)
        self.page.press(Keys.HOME)
        self.view = View(self.info, self.size())
        self.check_still()

    def test_reset_takes_all_back(self):
        self.page.drag((150, 200), [(190, 220)])
        self.page.drag((150, 200), [(190, 220)], button="right")
        self.page.drag((150, 200), [(190, 220)], button="middle")
        self.page.wheel(150, 200, 300)
        self.set_slider("thickness", 10)
        self.set_slider("offset", 10)
        self.click_button("Reset")
        self.check_still()

    def test_fine_screens_get_fine_pictures(self):
        self.page.set_size(690, 400, 2.0)
        self.page.wait_for(f"canvas.width > {self.view.size[0]}")
        self.view.size = self.size()
        self.assertLess(self.view.size[0], 500)
        self.view.size = tuple(2 * side for side in self.view.size)
        self.check_still()
        place = numpy.array(testing.ORIGIN) + numpy.array(testing.BRIGHT) * testing.SPACING
        x, y = self.view.pixel_of(place)
        self.page.click(round(x / 2), round(y / 2))
        self.check_pick(2 * round(x / 2), 2 * round(y / 2))

    def test_the_picture_follows_the_window(self):
        width = self.view.size[0]
        self.page.set_size(650, 300)
        self.page.wait_for(f"canvas.width < {width} && canvas.height === 300")
        self.view.size = self.size()
        self.check_still()

    def test_the_picture_is_to_be_seen(self):
        """A screenshot has it where the canvas is, but for letters and rims."""
        seen = testing.decode(self.page.driver.get_screenshot_as_png())[30:-30, 30:self.view.size[0] - 30]
        expected = self.view.picture()[30:-30, 30:-30]
        self.assertLessEqual(abs(seen[:, :, :3] - expected[:, :, None]).max(), 1.51)

    def test_a_file_that_does_not_say_how_the_patient_lies_gets_no_letters(self):
        with testing.running_viewer(testing.EXAMPLES.parent / "Data" / "aorta-stent.vti") as other:
            self.page.open(other.address, 700, 400)
            self.page.wait_for(STILL)
            self.assertEqual([self.text(side) for side in ("up", "down", "right", "left")], [""] * 4)
            self.click_button("+z")
            self.page.wait_for(STILL)
            self.page.evaluate("canvas.focus()")
            self.page.press(Keys.ENTER)
            self.page.wait_for("document.getElementById('told').textContent.includes(' at ')")
            self.assertRegex(self.text("told"), r"^\S+ at x \S+, y \S+, z \S+, voxel \d+ \d+ \d+$")
            self.assertGreater(self.shown().std(), 10.0)

    def test_nothing_comes_from_elsewhere(self):
        self.page.drag((150, 200), [(190, 220)])
        self.page.wait_for(STILL)
        names = self.page.evaluate("performance.getEntriesByType('resource').map(entry => entry.name)")
        self.assertGreater(len(names), 2)
        for name in names:
            self.assertTrue(name.startswith(self.viewer.address), name)

    def test_a_viewer_that_has_ended_is_told_of(self):
        with testing.running_viewer() as other:
            self.page.open(other.address, 700, 400)
            self.page.wait_for(STILL)
        self.page.drag((150, 200), [(190, 220)])
        is_told = "document.getElementById('told').textContent.includes('Does it still run?')"
        self.page.wait_for(f"{STILL} && {is_told}")
        self.page.evaluate("tell('')")
        self.page.click(100, 100)
        self.page.wait_for(is_told)
        self.page.errors()  # Chromium logs requests that fail


if __name__ == "__main__":
    if BrowserTesting.what_is_missing():
        print("skipped:", BrowserTesting.what_is_missing())
        sys.exit(SKIPPED)
    unittest.main()
