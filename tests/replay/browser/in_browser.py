# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""What both files of tests in a browser share: pages of the program, and looks at them.

A test is called with the program and the repository: TEST.py BBSIM SOURCE [unittest's arguments]
"""

import atexit
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

from webdriver import Browser

BBSIM, SOURCE = (os.path.abspath(name) for name in sys.argv[1:3])


def bbsim(*words, ends=(0,), **options):
    """What the program prints. It runs in SOURCE, quietly."""
    made = subprocess.run([BBSIM, *words, "-q"], cwd=SOURCE, capture_output=True, text=True, check=False, **options)
    assert made.returncode in ends, (words, made.returncode, made.stderr)
    return made.stdout


def cases_of(file):
    with open(file, newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def rows_of(file):
    return [{name: float(value or "nan") for name, value in row.items()} for row in cases_of(file)]


def content_of(file):
    with open(os.path.join(SOURCE, file), encoding="utf-8") as stream:
        return stream.read()


class Files:
    """Results and pages, each made once for all tests."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="bbsim-pages-")
        atexit.register(shutil.rmtree, self.folder, True)

    def __call__(self, name):
        return os.path.join(self.folder, name.replace("/", "-"))

    def write(self, name, text):
        with open(self(name), "w", encoding="utf-8") as stream:
            stream.write(text)
        return self(name)

    def change(self, name, **values):
        """Changes a JSON."""
        return self.write(name, json.dumps({**json.loads(content_of(self(name))), **values}))

    def run(self, name, config, *options):
        """The result NAME.csv, with its summary NAME.json beside it."""
        file = self(name + ".csv")
        if not os.path.exists(file):
            bbsim("run", f"configs/{config}.yaml", "-o", file, "--summary", self(name + ".json"), *options, ends=(0, 1))
        return file

    def page(self, name, *arguments):
        """The page of `bbsim replay ARGUMENTS`."""
        file = self(name + ".html")
        if not os.path.exists(file):
            bbsim("replay", *arguments, "-o", file, ends=(0, 1))
        return "file://" + file

    def scene(self, name, *options):
        """The page of configs/NAME.yaml."""
        return self.page(name + "".join(options).replace("=", "-"), f"configs/{name}.yaml", *options)

    def replay(self, config, *more):
        """The page of a stored run; its rows are those of CONFIG.csv."""
        return self.page(config + "-stored", self.run(config, config), *more, "--scenario", f"configs/{config}.yaml")

    def sweep(self, name, config, *options):
        table = self(name + ".csv")
        if not os.path.exists(table):
            bbsim("sweep", f"configs/{config}.yaml", *options, "-o", table)
        return self.page(name, table, "--scenario", f"configs/{config}.yaml"), table


files = Files()


class InBrowser(unittest.TestCase):
    options = {}  # browser options of a test class; classes without any share one browser
    shared = None

    @classmethod
    def setUpClass(cls):
        if cls.options or InBrowser.shared is None:
            cls.browser = Browser(**cls.options).__enter__()
            if cls.options:
                cls.addClassCleanup(cls.browser.__exit__, None, None, None)
                return
            InBrowser.shared = cls.browser
            unittest.addModuleCleanup(cls.browser.__exit__, None, None, None)
        cls.browser = InBrowser.shared

    def open(self, page):
        """Opens a fresh page, and asserts that it needs no network and reports no errors."""
        self.browser.call("POST", "/url", {"url": "about:blank"})
        self.browser.console()
        self.browser.requests()
        self.browser.open(page)
        self.assertEqual(self.browser.console(), [])
        asked = [url for url in self.browser.requests() if not url.startswith(("data:", "blob:", "about:"))]
        self.assertEqual(asked, [page.split("#")[0]])

    def js(self, script, *arguments):
        """The value of an expression."""
        return self.browser.run("return " + script, *arguments)

    def ask(self, script, *arguments):
        """The value of an async function's body about `args`; a rejection becomes {fault: its message}."""
        return self.browser.ask(script, *arguments)

    def wait(self, condition):
        """Waits until the expression is true in the page, and returns its value."""
        found = self.ask(f"const begun = performance.now(); let is; while (!(is = {condition})) {{"
                         "  if (performance.now() - begun > 20000) throw new Error('it never came');"
                         "  await new Promise((resolve) => setTimeout(resolve, 20));"
                         "} return is")
        self.assertFalse(isinstance(found, dict) and "fault" in found, condition)
        return found

    def box(self, selector):
        """Left, top, width and height of an element."""
        return self.js("(({left, top, width, height}) => [left, top, width, height])"
                       "(document.querySelector(arguments[0]).getBoundingClientRect())", selector)

    def hidden(self, name):
        return self.js("document.getElementById(arguments[0]).hidden", name)

    def texts(self, selector):
        return self.js("[...document.querySelectorAll(arguments[0])].map((one) => one.textContent)", selector)

    def count(self, selector):
        return len(self.texts(selector))

    def press(self, words):
        """Presses the button of a live page that has these words."""
        self.js("[...document.querySelectorAll('.live button')].find((one) => one.textContent === arguments[0]).click()", words)

    def near(self, found, wanted, within):
        self.assertLessEqual(abs(found - wanted), within, f"{found} is not {wanted} within {within}")

    def all_near(self, found, wanted, within):
        for one, its in zip(found, wanted, strict=True):
            self.near(one, its, within)
