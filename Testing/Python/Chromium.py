# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""A page in Chromium without a display, driven by Chrome's DevTools protocol through a pipe.

Needs Python's own modules alone. The protocol: https://chromedevtools.github.io/devtools-protocol/
"""
import base64
import contextlib
import fcntl
import json
import os
import select
import shutil
import subprocess
import tempfile
import time


def find_chromium():
    """Its path, or None."""
    return shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


class Page:
    """What a user would do with a page, and what the page has."""

    def __init__(self, commands, answers):
        self.commands, self.answers = commands, answers
        self.rest = b""
        self.count = 0
        self.errors = []
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        self.session = {}
        self.session = {
            "sessionId": self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]}
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.send(domain + ".enable")

    def receive(self):
        while b"\0" not in self.rest:
            if not select.select([self.answers], [], [], 60)[0]:
                raise TimeoutError("Chromium does not answer")
            data = os.read(self.answers, 1 << 20)
            if not data:
                raise EOFError("Chromium has ended")
            self.rest += data
        message, _, self.rest = self.rest.partition(b"\0")
        return json.loads(message)

    def send(self, method, **parameters):
        """The result of a command; what a page complains about meanwhile is kept."""
        self.count += 1
        session = getattr(self, "session", {})
        message = {"id": self.count, "method": method, "params": parameters, **session}
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.receive()
            if answer.get("id") == self.count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return answer["result"]
            if answer.get("method") == "Runtime.exceptionThrown":
                self.errors.append(answer["params"]["exceptionDetails"])
            if answer.get("method") == "Log.entryAdded" and answer["params"]["entry"]["level"] == "error":
                self.errors.append(answer["params"]["entry"])

    def evaluate(self, expression):
        """The value of a JavaScript expression in the page, when it is there."""
        answer = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(f"{expression}: {answer['exceptionDetails']}")
        return answer["result"].get("value")

    def wait_for(self, expression, seconds=20.0):
        """Until an expression is true."""
        end = time.monotonic() + seconds
        while not self.evaluate(expression):
            if time.monotonic() > end:
                raise TimeoutError(f"never true: {expression}")
            time.sleep(0.02)

    def open(self, address, width, height, pixel_ratio=1.0):
        self.set_size(width, height, pixel_ratio)
        self.send("Page.navigate", url=address)
        self.wait_for(f"location.href === {json.dumps(address)} && document.readyState === 'complete'")

    def set_size(self, width, height, pixel_ratio=1.0):
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=pixel_ratio, mobile=False)

    def screenshot(self):
        """A PNG file."""
        return base64.b64decode(self.send("Page.captureScreenshot")["data"])

    def mouse(self, kind, x, y, **parameters):
        self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, **parameters)

    def drag(self, start, path, button="left", modifiers=0, pause=0.0):
        """Down at the start, then from place to place, then up."""
        buttons = {"left": 1, "right": 2, "middle": 4}[button]
        self.mouse("mouseMoved", *start)
        self.mouse("mousePressed", *start, button=button, buttons=buttons, clickCount=1, modifiers=modifiers)
        for place in path:
            self.mouse("mouseMoved", *place, button=button, buttons=buttons, modifiers=modifiers)
            time.sleep(pause)
        end = path[-1] if path else start
        self.mouse("mouseReleased", *end, button=button, clickCount=1, modifiers=modifiers)

    def click(self, x, y):
        self.drag((x, y), [])

    def wheel(self, x, y, delta):
        self.mouse("mouseWheel", x, y, deltaX=0, deltaY=delta)

    def press(self, key, text=""):
        parameters = {"key": key, "code": key, **({"text": text} if text else {})}
        codes = {"Enter": 13, "Tab": 9, "Home": 36, "ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40}
        parameters["windowsVirtualKeyCode"] = codes.get(key, ord(key[0]))
        self.send("Input.dispatchKeyEvent", type="keyDown", **parameters)
        self.send("Input.dispatchKeyEvent", type="keyUp", **parameters)


@contextlib.contextmanager
def chromium_page():
    """A Page, whose Chromium ends with it."""
    commands_in, commands = os.pipe()
    answers, answers_out = os.pipe()
    # Chromium reads commands from 3 and writes answers to 4.
    inner = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (commands_in, answers_out)]
    arguments = [find_chromium(), "--headless=new", "--remote-debugging-pipe", "--disable-gpu", "--no-first-run",
                 "--disable-background-networking", "--disable-dev-shm-usage", "--hide-scrollbars"]
    arguments += ["--no-sandbox"] if os.geteuid() == 0 else []  # which Chromium wants of root

    def place_pipes():
        os.dup2(inner[0], 3)
        os.dup2(inner[1], 4)

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        process = subprocess.Popen([*arguments, "--user-data-dir=" + folder, "about:blank"], preexec_fn=place_pipes,
                                   close_fds=True, pass_fds=(3, 4), stdin=subprocess.DEVNULL,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for end in (commands_in, answers_out, *inner):
            os.close(end)
        try:
            yield Page(commands, answers)
        finally:
            os.close(commands)
            os.close(answers)
            process.terminate()
            process.wait(20)
