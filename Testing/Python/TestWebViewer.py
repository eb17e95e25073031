# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""The server of Examples/Python/web_viewer.py, without a browser."""
import concurrent.futures
import contextlib
import http.client
import itertools
import os
import pathlib
import socket
import sys
import tempfile
import threading
import time
import types
import unittest
import urllib.parse

import numpy

import WebViewerTesting as testing
from WebViewerTesting import View

sys.path.insert(0, str(testing.EXAMPLES))
import volume_files  # noqa: E402
import web_viewer  # noqa: E402


class TestWebViewer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.context = testing.running_viewer()
        cls.viewer = cls.context.__enter__()
        cls.info = cls.viewer.get_json("volume")

    @classmethod
    def tearDownClass(cls):
        cls.context.__exit__(None, None, None)

    def make_view(self, size=(120, 90)):
        return View(self.info, size)

    def check_picture(self, view):
        """PNG loses nothing: half a step of gray is what rounding may change."""
        status, kind, body = self.viewer.get("picture", **view.fields())
        self.assertEqual((status, kind), (200, "image/png"), body)
        expected = view.picture()
        self.assertGreater(expected.std(), 10.0)
        self.assertLessEqual(abs(testing.decode(body) - expected).max(), 0.501)

    def test_pictures_of_all_modes_are_the_filters(self):
        for mode in ("preview", "standard", "high", "exact"):
            view = self.make_view()
            view.mode = mode
            view.turn((1, 2, 0), 33)
            with self.subTest(mode):
                self.check_picture(view)

    def test_all_that_a_picture_depends_on(self):
        view = self.make_view((64, 100))
        view.window, view.level = 500.0, 900.0
        self.check_picture(view)
        view.slab = (10.0, -7.0)
        self.check_picture(view)
        view.focal_point = view.focal_point + (4.0, 0.0, -9.0)
        view.extent /= 2.0
        self.check_picture(view)

    def test_several_who_look_at_once(self):
        """Each gets the picture that was asked for."""
        views = []
        for n in range(24):
            view = self.make_view((40 + n, 60))
            view.turn((1, 2, 3), 15 * n)
            view.mode = ("preview", "exact")[n % 2]
            view.slab = (20.0 * (n % 3), 0.0)
            views.append(view)
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            answers = list(pool.map(lambda view: self.viewer.get("picture", **view.fields())[2], views))
        for view, body in zip(views, answers):
            found, expected = testing.decode(body), view.picture()
            self.assertEqual(found.shape, expected.shape)
            self.assertLessEqual(abs(found - expected).max(), 0.501)

    def test_jpeg_is_the_picture_roughly(self):
        view = self.make_view()
        status, kind, body = self.viewer.get("picture", **view.fields("jpeg"))
        self.assertEqual((status, kind), (200, "image/jpeg"))
        found, expected = testing.decode(body), view.picture()
        self.assertLess(abs(found - expected).mean(), 1.0)
        self.assertGreater(abs(found[::-1] - expected).mean(), 5.0)

    def test_without_a_file_it_shows_the_aorta(self):
        with testing.running_viewer("--port", "0") as other:
            info = other.get_json("volume")
        self.assertEqual((info["name"], info["size"]), ("aorta-stent.vti", [128, 128, 256]))
        self.assertIn(f"Window {info['window']:g}, level {info['level']:g}: from the median", other.words)

    def test_windows_without_end(self):
        for window, level, gray in ((1e-30, 0.0, 255), (1e-30, 5000.0, 0), (1e300, 1e300, 0), (1e-30, -1e300, 255)):
            view = self.make_view((60, 60))
            view.window, view.level = window, level
            found = testing.decode(self.viewer.get("picture", **view.fields())[2])
            self.assertEqual(found[30, 30], gray)

    def test_where_nothing_is_seen_is_black(self):
        view = self.make_view()
        view.level = -5000.0  # so that 0 would be white
        gray = testing.decode(self.viewer.get("picture", **view.fields())[2])
        self.assertEqual(gray[0, 0], 0)
        self.assertEqual(gray[45, 60], 255)

    def test_pick_tells_place_and_value(self):
        place = numpy.array(testing.ORIGIN) + numpy.array(testing.BRIGHT) * testing.SPACING
        for axis, degrees in (((0, 1, 0), 0), ((2, 1, 0), 50), ((1, -3, 1), 160)):
            view = self.make_view((400, 300))
            view.turn(axis, degrees)
            x, y = view.pixel_of(place)
            found = self.viewer.get_json("pick", **view.fields(), pixel=f"{round(x)},{round(y)}")
            # The ray passes up to half a pixel's diagonal beside the voxel.
            away = view.spacing() * 0.71
            self.assertLessEqual(abs(numpy.array(found["position"]) - place).max(), 2.0 * away)
            self.assertEqual(found["voxel"], list(testing.BRIGHT))
            step = away * sum(1.0 / s for s in testing.SPACING)
            self.assertGreater(found["value"], testing.BRIGHT_VALUE * (1.0 - step))
            self.assertLessEqual(found["value"], testing.BRIGHT_VALUE)
            self.assertEqual(self.viewer.get_json("pick", **view.fields(), pixel="0,0"), {})
            # The same as the picture at the pixel, in a window in which nothing is black or white.
            view.window, view.level = 8000.0, 2000.0
            gray = view.picture()[round(y), round(x)]
            self.assertAlmostEqual((found["value"] - 2000.0) / 8000.0 * 255.0 + 127.5, gray, places=3)

    def test_the_page_loads_nothing_from_elsewhere(self):
        status, kind, body = self.viewer.get("")
        self.assertEqual((status, kind), (200, "text/html; charset=utf-8"))
        self.assertNotIn(b"://", body)

    def test_bad_requests_get_a_sentence(self):
        good = self.make_view().fields()
        bad = {"direction": ["", "1,2", "0,0,nan", "0,0.5,0", "0,0,1"], "up": ["0,1,0", "x,y,z"],
               "focalPoint": ["inf,0,0", "1e300,0,0"], "size": ["0,5", "5000,5", "4096,4096", "1.5,2", "5"],
               "spacing": ["0", "-1", "nan"], "window": ["0", "nan", "1e999"], "level": ["nan", "a"],
               "thickness": ["-1", "nan"], "offset": ["nan", "1,2"], "mode": ["", "best"], "kind": ["gif"]}
        for name, texts in bad.items():
            for text in texts:
                with self.subTest(name, text=text):
                    status, kind, body = self.viewer.get("picture", **{**good, name: text})
                    self.assertEqual((status, kind), (400, "text/plain"))
                    self.assertRegex(body.decode(), r"^\w+( and \w+)? must .*\n$")
            without = {key: value for key, value in good.items() if key != name}
            self.assertEqual(self.viewer.get("picture", **without)[0], 400)
        for pixel in ("", "1", "-1,0", "nan,1"):
            self.assertEqual(self.viewer.get("pick", **good, pixel=pixel)[0], 400)
        self.assertEqual(self.viewer.get("pick", **good)[0], 400)
        self.assertEqual(self.viewer.get("../../etc/passwd")[0], 404)
        self.check_picture(self.make_view())

    def test_bytes_that_are_no_request_do_not_end_it(self):
        for data in (b"\0\1\2\3\r\n\r\n", b"GET\r\n\r\n", b"GET /" + b"x" * 70000, b"POST / HTTP/1.1\r\n\r\n", b""):
            with socket.create_connection(("127.0.0.1", self.viewer.port), 10) as connection:
                connection.sendall(data)
        self.check_picture(self.make_view())

    def test_without_the_token_nothing_is_told(self):
        token = self.viewer.address.split("/")[3]
        self.assertGreaterEqual(len(token), 20)
        with testing.running_viewer() as other:
            self.assertNotIn(token, other.address)
        for path in ("/", "/volume", "/picture?" + self.make_view().query(), "/wrong/volume",
                     f"/{token[:-1]}/volume", f"/{token}x/volume", f"/{token}", f"/{token}?volume",
                     "//volume", f"/x/{token}/volume", "/%C3%A9/volume", "http://elsewhere/volume"):
            connection = http.client.HTTPConnection("127.0.0.1", self.viewer.port, timeout=10)
            connection.putrequest("GET", path)
            connection.endheaders()
            answer = connection.getresponse()
            self.assertEqual(answer.status, 403, path)
            self.assertNotIn(b"phantom", answer.read())
            connection.close()

    def test_a_picture_that_nobody_wants_is_given_up(self):
        with tempfile.TemporaryDirectory() as folder:
            volume = volume_files.read_volume(testing.write_nrrd(pathlib.Path(folder) / "phantom.nrrd"))
        viewer = web_viewer.Viewer(volume, "phantom")
        view = self.make_view()
        for answers in ([False], [True], [True]):  # at once, and in the midst of the projection
            connected = itertools.chain(answers, itertools.repeat(False))
            with self.assertRaises(web_viewer.Abandoned):
                viewer.picture(web_viewer.parse_view(view.query()), lambda: next(connected))
        kind, body = viewer.picture(web_viewer.parse_view(view.query()), lambda: True)
        self.assertEqual(kind, "image/png")
        self.assertLessEqual(abs(testing.decode(body) - view.picture()).max(), 0.501)

    def test_a_newer_request_of_a_page_replaces_the_one_before(self):
        queue = web_viewer.Queue()
        outcomes = {}

        def ask(number, name, is_connected=lambda: True):
            try:
                with queue.turn(name, is_connected):
                    outcomes[number] = "turn"
            except (web_viewer.Abandoned, web_viewer.Busy) as error:
                outcomes[number] = type(error).__name__

        def wait_for(condition):
            end = time.monotonic() + 20
            while not condition():
                self.assertLess(time.monotonic(), end, outcomes)
                time.sleep(0.01)

        def start(numbers, name, waiting, is_connected=lambda: True):
            for number in numbers:
                threading.Thread(target=ask, args=(number, name, is_connected), daemon=True).start()
            wait_for(lambda: len(queue.requests) == waiting)

        with queue.turn("first", lambda: True) as first:
            start([0], "second", 2)
            start([1], "second", 2)
            wait_for(lambda: outcomes == {0: "Abandoned"})
            start([2], "third", 3)
            start([3, 4], "", 5)
            start([5], "", 5, lambda: False)
            wait_for(lambda: outcomes == {0: "Abandoned", 5: "Abandoned"})
            self.assertTrue(first.is_wanted())
            start([6], "first", 6)
            self.assertFalse(first.is_wanted())
            start(range(7, 13), "", web_viewer.MOST_REQUESTS + 1)  # the superseded one is about to leave
            wait_for(lambda: len(outcomes) == 5)
            start([13], "third", web_viewer.MOST_REQUESTS + 1)  # takes the place of the one before
            wait_for(lambda: outcomes.get(2) == "Abandoned")
        wait_for(lambda: len(outcomes) == 14)
        self.assertEqual(sorted(outcomes.values()), ["Abandoned"] * 3 + ["Busy"] * 3 + ["turn"] * 8)
        self.assertEqual(queue.requests, [])

    def status(self, name):
        """A number of the viewer's process, as Linux tells it."""
        lines = pathlib.Path(f"/proc/{self.viewer.process.pid}/status").read_text().splitlines()
        return next(int(line.split()[1]) for line in lines if line.startswith(name + ":"))

    def processor_time(self):
        fields = pathlib.Path(f"/proc/{self.viewer.process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    @unittest.skipUnless(pathlib.Path("/proc/self/status").exists(), "no /proc here")
    def test_idle_connections_keep_nobody_out(self):
        threads = self.status("Threads")
        with contextlib.ExitStack() as stack:
            for _ in range(8 * web_viewer.MOST_CONNECTIONS):
                stack.enter_context(socket.create_connection(("127.0.0.1", self.viewer.port), 10))
            self.check_picture(self.make_view())
            start, used = time.monotonic(), self.processor_time()
            time.sleep(1.0)
            self.assertLess(self.processor_time() - used, 0.2 * (time.monotonic() - start))
            self.assertLess(self.status("Threads"), threads + web_viewer.MOST_CONNECTIONS + 10)
            descriptors = len(list(pathlib.Path(f"/proc/{self.viewer.process.pid}/fd").iterdir()))
            self.assertLess(descriptors, web_viewer.MOST_CONNECTIONS + 50)
            self.check_picture(self.make_view())

    @unittest.skipUnless(pathlib.Path("/proc/self/status").exists(), "no /proc here")
    def test_many_large_pictures_at_once_do_not_pile_up(self):
        fields = {**self.make_view((2896, 2896)).fields(), "mode": "preview", "kind": "jpeg"}
        self.assertEqual(self.viewer.get("picture", **fields)[0], 200)
        before = self.status("VmHWM")
        with concurrent.futures.ThreadPoolExecutor(30) as pool:
            answers = list(pool.map(lambda _: self.viewer.get("picture", **fields), range(30)))
        self.assertLess(self.status("VmHWM") - before, 400000)  # kB
        refused = [body for status, _, body in answers if status == 503]
        self.assertEqual(len(refused), sum(status != 200 for status, _, _ in answers))
        self.assertGreater(len(refused), 0)
        self.assertLess(len(refused), 30)
        self.assertEqual(set(refused), {b"8 pictures wait to be made: try again later\n"})
        self.check_picture(self.make_view())

    def test_a_browser_that_hangs_up_is_noticed(self):
        ours, theirs = socket.socketpair()
        with ours, theirs:
            handler = types.SimpleNamespace(connection=ours)
            self.assertTrue(web_viewer.Handler.is_connected(handler))
            theirs.sendall(b"GET")  # the next request is on its way
            self.assertTrue(web_viewer.Handler.is_connected(handler))
            self.assertEqual(ours.recv(3), b"GET")
            theirs.close()
            self.assertFalse(web_viewer.Handler.is_connected(handler))

    def test_who_hangs_up_does_no_harm(self):
        path = urllib.parse.urlsplit(self.viewer.address).path
        query = self.make_view((2000, 2000)).query()
        request = f"GET {path}picture?{query} HTTP/1.1\r\n\r\n"
        for seconds in (0.0, 0.05, 0.2):
            with socket.create_connection(("127.0.0.1", self.viewer.port), 10) as connection:
                connection.sendall(request.encode())
                time.sleep(seconds)
        self.check_picture(self.make_view())

    @unittest.skipUnless(pathlib.Path("/proc/self/maps").exists(), "no /proc here")
    def test_it_never_loads_opengl(self):
        self.check_picture(self.make_view())
        maps = pathlib.Path(f"/proc/{self.viewer.process.pid}/maps").read_text()
        self.assertIn("ImagingSplattingMIP", maps)
        self.assertNotRegex(maps, "libGL|libEGL|libOSMesa|RenderingOpenGL|libX11")

    @unittest.skipUnless(pathlib.Path("/proc/net/tcp").exists(), "no /proc here")
    def test_it_listens_on_the_loopback_address_only(self):
        def listeners(port):
            found = []
            for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]:
                place, state = line.split()[1], line.split()[3]
                if state == "0A" and int(place.split(":")[1], 16) == port:
                    found.append(place.split(":")[0])
            return found
        self.assertEqual(listeners(self.viewer.port), ["0100007F"])
        self.assertIn("Only this machine can connect", self.viewer.words)
        with testing.running_viewer("--host", "0.0.0.0") as other:
            self.assertEqual(listeners(other.port), ["00000000"])
            self.assertIn("nothing on the way is encrypted", other.words)
            self.assertNotIn("0.0.0.0", other.address)
        status, words = testing.run_to_end("--help")
        self.assertEqual(status, 0)
        self.assertIn("nothing on the way is encrypted", " ".join(words.split()))

    def test_where_it_cannot_listen_it_says_so(self):
        for host, port in (("127.0.0.1", self.viewer.port), ("127.0.0.1", 70000), ("192.0.2.1", 0)):
            status, words = testing.run_to_end("--host", host, "--port", port)
            self.assertEqual((status, words.count("\n")), (1, 1), words)
            self.assertIn(f"cannot listen on {host}, port {port}: ", words)


if __name__ == "__main__":
    unittest.main()
