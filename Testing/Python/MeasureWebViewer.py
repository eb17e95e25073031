# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""How many pictures per second Chromium shows while the volume of a file is turned in web_viewer.py.

    taskset -c 0,1 python3 MeasureWebViewer.py FILE [--mode preview] [--seconds 10]

Viewer, browser and this script share the processors. Pictures have 512 x 512 pixels. Ends with 77
where there is no Chromium or Selenium.
"""
import argparse
import math
import pathlib
import sys

import BrowserTesting
import WebViewerTesting as testing

SIDE = 512
RECORDER = """
  window.times = [];
  const draw = CanvasRenderingContext2D.prototype.drawImage;
  CanvasRenderingContext2D.prototype.drawImage = function (...what) {
    draw.apply(this, what);
    times.push(performance.now());
  };
  performance.setResourceTimingBufferSize(100000);
"""
REQUESTS = """performance.getEntriesByType("resource").filter(entry => entry.name.includes("/picture?")).map(
  entry => [entry.responseStart - entry.requestStart, entry.responseEnd - entry.responseStart])"""


def median(numbers):
    return sorted(numbers)[len(numbers) // 2]


def measure(page, seconds):
    """Times of pictures shown, and of requests what the server took and the transfer."""
    centre = (SIDE // 2, SIDE // 2)
    page.drag(centre, [], releases=False)
    page.evaluate("void (times.splice(0), performance.clearResourceTimings())")
    places = [(round(SIDE * (0.5 + 0.4 * math.sin(0.03 * n))), round(SIDE * (0.5 + 0.2 * math.sin(0.05 * n))))
              for n in range(round(60 * seconds))]
    page.drag(centre, places, pause=1 / 60, releases=False)
    found = page.evaluate("times"), page.evaluate(REQUESTS)
    page.click(*centre)
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("file")
    parser.add_argument("--mode", default="preview")
    parser.add_argument("--seconds", type=float, default=10.0)
    arguments = parser.parse_args()
    if BrowserTesting.what_is_missing():
        print("skipped:", BrowserTesting.what_is_missing())
        sys.exit(77)
    with testing.running_viewer(arguments.file) as viewer, BrowserTesting.browser_page() as page:
        page.run_first(RECORDER)
        width = 2 * SIDE
        page.open(viewer.address, width, SIDE)
        while page.evaluate("canvas.clientWidth") != SIDE:
            width += SIDE - page.evaluate("canvas.clientWidth")
            page.set_size(width, SIDE)
        page.evaluate(f"element('moving').value = '{arguments.mode}'")
        page.wait_for(f"shown === version && !isMoving && canvas.width === {SIDE} && canvas.height === {SIDE}")
        times, requests = measure(page, arguments.seconds)
        has_opengl = "libGL" in pathlib.Path(f"/proc/{viewer.process.pid}/maps").read_text()
    gaps = [later - time for time, later in zip(times, times[1:])]
    print(f"{arguments.mode}: {1000.0 * len(gaps) / sum(gaps):.1f} pictures per second; of one (median) "
          f"the server takes {median([server for server, _ in requests]):.1f} ms, the transfer "
          f"{median([transfer for _, transfer in requests]):.1f} ms, all {median(gaps):.1f} ms; "
          f"the viewer has {'' if has_opengl else 'not '}loaded libGL")


if __name__ == "__main__":
    main()
