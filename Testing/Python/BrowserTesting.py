# SPDX-FileCopyrightText: Copyright (c) the SplattingMIP authors
# SPDX-License-Identifier: BSD-3-Clause
"""A page in Chromium without a display, driven by Selenium.

Needs Debian's packages chromium-driver and python3-selenium, or the same of others.
"""
import contextlib
import json
import os
import shutil
import time

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.actions.action_builder import ActionBuilder
    from selenium.webdriver.common.actions.mouse_button import MouseButton
    from selenium.webdriver.common.keys import Keys
except ImportError:
    webdriver = Keys = None

DRIVER = shutil.which("chromedriver")
ARGUMENTS = ("--headless=new", "--disable-gpu", "--no-first-run", "--disable-background-networking",
             "--disable-dev-shm-usage", "--hide-scrollbars")


def what_is_missing():
    """A sentence, or nothing if there is a browser."""
    if not webdriver:
        return "there is no Selenium: install python3-selenium"
    return "" if DRIVER else "there is no chromedriver: install chromium-driver"


class Page:
    """What a user would do with a page, and what the page has."""

    def __init__(self, driver):
        self.driver = driver

    def errors(self):
        """What the page has complained about since the last call."""
        return [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def evaluate(self, expression):
        """The value of a JavaScript expression in the page, when it is there."""
        return self.driver.execute_script(f"return {expression}")

    def wait_for(self, expression, seconds=20.0):
        """Until an expression is true."""
        end = time.monotonic() + seconds
        while not self.evaluate(expression):
            if time.monotonic() > end:
                raise TimeoutError(f"never true: {expression}")
            time.sleep(0.02)

    def run_first(self, script):
        """In each page before its own scripts."""
        self.driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": script})

    def open(self, address, width, height, pixel_ratio=1.0):
        self.set_size(width, height, pixel_ratio)
        self.driver.get(address)
        self.wait_for(f"location.href === {json.dumps(address)}")

    def set_size(self, width, height, pixel_ratio=1.0):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": pixel_ratio, "mobile": False})

    def drag(self, start, path, button="left", key=None, pause=0.0, releases=True):
        """Down at the start, with a key or none, then from place to place, then up."""
        actions = ActionBuilder(self.driver, duration=0)
        pointer, keys = actions.pointer_action, actions.key_action
        if key:
            keys.key_down(key)
            pointer.pause(0)
        pointer.move_to_location(*start)
        pointer.pointer_down(getattr(MouseButton, button.upper()))
        for place in path:
            pointer.move_to_location(*place)
            pointer.pause(pause)
        if releases:
            pointer.pointer_up(getattr(MouseButton, button.upper()))
        actions.perform()
        if releases:
            actions.clear_actions()  # the key

    def click(self, x, y):
        self.drag((x, y), [])

    def wheel(self, x, y, delta):
        actions = ActionBuilder(self.driver, duration=0)
        actions.wheel_action.scroll(x, y, 0, delta)
        actions.perform()

    def press(self, *keys):
        webdriver.ActionChains(self.driver, duration=0).send_keys(*keys).perform()


@contextlib.contextmanager
def browser_page():
    """A Page, whose Chromium ends with it."""
    options = webdriver.ChromeOptions()
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    for argument in ARGUMENTS + (("--no-sandbox",) if os.geteuid() == 0 else ()):  # which Chromium wants of root
        options.add_argument(argument)
    driver = webdriver.Chrome(service=Service(DRIVER), options=options)
    try:
        yield Page(driver)
    finally:
        driver.quit()
