# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""Tests live pages in a headless Chromium: test_live.py BBSIM SOURCE [TEST...]

The engine computes what the program computes with its baseline kernels; sliders, text, links and controllers work; no
text runs as code. scripts/test-browser calls it.
"""

import atexit
import csv
import json
import math
import os
import platform
import shutil
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

from webdriver import Browser

BBSIM, SOURCE = (os.path.abspath(name) for name in sys.argv[1:3])
FOLDER = tempfile.mkdtemp(prefix="bbsim-live-")
atexit.register(shutil.rmtree, FOLDER, True)

# Scenarios of configs/ whose motion is smooth: their error falls with the tolerance.
SMOOTH = ["fig2a", "fig2b", "incline", "beam", "lissajous", "waypoints", "torque-lqr"]
BASELINE = "sse2" if platform.machine() in ("x86_64", "AMD64") else "baseline"
# These read files.
WITH_FILES = ["recorded", "traced"]


def page(scenario, *options):
    file = os.path.join(FOLDER, os.path.basename(scenario) + f"{len(os.listdir(FOLDER))}.html")
    subprocess.run([BBSIM, "replay", scenario, "--live", "-o", file, "-q", *options], cwd=SOURCE, check=False)
    return "file://" + file


def native(scenario, *options):
    """The columns of the program's own run."""
    file = os.path.join(FOLDER, "native.csv")
    subprocess.run([BBSIM, "run", scenario, "-o", file, "-q", *options], cwd=SOURCE, check=False,
                   env={**os.environ, "BBSIM_SIMD": BASELINE}, stderr=subprocess.DEVNULL)
    with open(file, newline="") as stream:
        rows = list(csv.reader(stream))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


class Live(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = Browser(1280, 900).__enter__()
        cls.addClassCleanup(cls.browser.__exit__, None, None, None)

    def open(self, url):
        self.browser.call("POST", "/url", {"url": "about:blank"})
        self.browser.console()
        self.browser.open(url)
        self.assertEqual(self.browser.console(), [])
        self.js("bbsim.screen.setFlat(true)")

    def js(self, script, *arguments):
        return self.browser.run("return " + script, *arguments)

    def run_js(self, script, *arguments):
        """The value of an async function's body; a rejection becomes {fault: its message}."""
        return self.browser.call("POST", "/execute/async", {
            "script": "const done = arguments[arguments.length - 1], args = [...arguments];"
                      f"(async () => {{ {script} }})().then(done, (error) => done({{fault: error.message}}));",
            "args": list(arguments)})

    def until(self, condition):
        found = self.run_js(f"const begun = performance.now(); while (!({condition})) {{"
                            "  if (performance.now() - begun > 20000) throw new Error('it never came');"
                            "  await new Promise((resolve) => setTimeout(resolve, 50));"
                            "}")
        self.assertIsNone(found, condition)

    def columns_of(self, text, **keys):
        found = self.run_js("await bbsim.live.edit(args[0]);"
                            "for (const [key, value] of Object.entries(args[1])) await bbsim.live.set(key, value);"
                            "return Object.fromEntries(Object.entries(bbsim.live.columns).map(([key, values]) => "
                            "[key, [...values].map(String)]))", text, keys)
        self.assertNotIn("fault", found)
        return {name: [float(value.replace("Infinity", "inf")) for value in values] for name, values in found.items()}

    def compare(self, found, wanted, within):
        self.assertEqual(sorted(found), sorted(wanted))
        for name, values in wanted.items():
            self.assertEqual(len(found[name]), len(values), name)
            size = max((abs(value) for value in values if value == value), default=0)
            apart = [0 if a != a and b != b else abs(a - b) for a, b in zip(found[name], values)]
            row = max(range(len(apart)), key=lambda i: apart[i])
            self.assertLessEqual(apart[row], within * size, f"{name}, row {row}: {found[name][row]} and {values[row]}")


class Engine(Live):
    def test_computes_what_the_program_computes(self):
        self.open(page("configs/fig2b.yaml"))
        for file in sorted(os.listdir(os.path.join(SOURCE, "configs"))):
            name, ending = os.path.splitext(file)
            if ending != ".yaml" or name in WITH_FILES:
                continue
            with self.subTest(name), open(os.path.join(SOURCE, "configs", file), encoding="utf-8") as stream:
                text = stream.read()
                # The positions' rounding differs with the machine's sine and root; a motion that is not smooth
                # multiplies it.
                self.compare(self.columns_of(text), native(f"configs/{file}"), 1e-6)
                if name in SMOOTH:
                    self.compare(self.columns_of(text, **{"solver.rtol": "1e-12", "solver.atol": "1e-14"}),
                                 native(f"configs/{file}", "--set", "solver.rtol=1e-12", "--set", "solver.atol=1e-14"),
                                 1e-12)

    def test_says_what_it_cannot_run(self):
        self.open(page("configs/recorded.yaml"))
        fault = self.run_js("await bbsim.live.set('ball.radius', '2 cm')")["fault"]
        self.assertIn("recorded-angles.csv", fault)
        self.open(page("configs/fig2b.yaml"))
        self.assertIn("solver.method", self.run_js("await bbsim.live.set('solver.method', 'bdf')")["fault"])

    def test_starts_at_the_first_touch(self):
        self.open(page("configs/fig2b.yaml"))
        self.assertEqual(self.js("document.querySelector('.live-status').textContent"), "")
        self.assertEqual(len(self.js("[...bbsim.live.columns.x]")), 1051)


class Page(Live):
    def test_sliders_follow_the_exercise(self):
        self.open(page("examples/exercise/circle.yaml"))
        free = self.js("bbsim.data.scene.live.free")
        self.assertEqual(self.js("[...document.querySelectorAll('.slider input[type=range]')].map((one) => one.dataset.key)"),
                         [key for key in sorted(free) if key in self.js("bbsim.data.scene.live.keys.map(({key}) => key)")])
        # A learner opens it unsolved, and can solve it within the sliders' ranges.
        self.assertEqual(self.js("bbsim.live.tasks"), [False, False])
        for key in free:
            self.run_js("const slider = document.querySelector(`[data-key='${args[0]}']`);"
                        "slider.value = 3; slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change'))", key)
        self.run_js("await bbsim.live.set('gravity', 9.81)")
        self.assertEqual(self.js("bbsim.live.tasks"), [True, True])
        self.assertEqual(self.js("document.querySelectorAll('.tasks .holds').length"), 2)

    def test_a_slider_changes_the_run(self):
        self.open(page("configs/fig2b.yaml"))
        before = self.js("bbsim.data.runs[0].at(0, 'x')")
        self.run_js("const slider = document.querySelector('[data-key=\"controller.reference.circle.radius\"]');"
                    "slider.value = 8; slider.dispatchEvent(new Event('input'));"
                    "await new Promise((resolve) => setTimeout(resolve, 50)); await bbsim.live.set('gravity', '9.8')")
        self.assertIn("radius: 8 cm", self.js("bbsim.live.yaml"))
        self.assertIn("# Fig. 2(b)", self.js("bbsim.live.yaml"))  # comments stay
        after = self.js("bbsim.data.runs[0].at(0, 'x')")
        self.assertNotEqual(before, after)
        # The picture has the new path, and the plots the former run beside it.
        self.assertAlmostEqual(max(self.js("[...bbsim.data.runs[0].path]")), 0.08, 3)
        self.assertIn("x before", self.js("document.getElementById('plots').textContent"))

    def test_a_slider_at_zero_has_its_neighbors_range(self):
        self.open(page("configs/rig.yaml"))
        slide = ("const slider = document.querySelector(`[data-key='${args[0]}']`); slider.value = args[1];"
                 "slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change'));"
                 "return [slider.min, slider.max].map(Number)")
        self.assertEqual(self.run_js(slide, "ball.position.1", 3), [-12.5, 12.5])  # that of 5 cm
        low, high = self.run_js(slide, "controller.sensor.seed", 99)
        self.assertEqual(high, int(high))
        self.assertIsNone(self.run_js("await bbsim.live.set('gravity', '9.8')"))
        self.assertIn("3 cm]", self.js("bbsim.live.yaml"))
        self.assertIn(f"seed: {high}", self.js("bbsim.live.yaml"))
        self.run_js(slide, "ball.position.1", 0)
        self.run_js("bbsim.live.undo(); await bbsim.live.set('gravity', '9.7')")
        self.assertEqual(float(self.js("document.querySelector('[data-key=\"ball.position.1\"]').value")), 3)

    def test_a_slider_tells_what_its_key_means(self):
        """in the words of the JSON Schema: when the page opens, and from the engine when keys come"""
        schema = json.loads(subprocess.run([BBSIM, "--schema"], check=True, capture_output=True, text=True).stdout)
        keys = schema["properties"]["ball"]["properties"]
        self.open(page("configs/rig.yaml"))
        for keys_of_the_engine in [False, True]:
            if keys_of_the_engine:
                self.run_js("await bbsim.live.edit(bbsim.live.yaml.replace('mass:', 'inertia_factor: 0.4, mass:'))")
            for key, name in [("ball.mass", "mass"), ("ball.position.1", "position")]:
                # A finger sees no title.
                self.run_js("document.querySelector(`[data-key='${args[0]}']`).dispatchEvent(new Event('pointerdown', {bubbles: true}))", key)
                said = self.js("document.querySelector('.meaning').textContent")
                self.assertEqual(said, self.js("document.querySelector(`[data-key='${arguments[0]}']`).title", key))
                self.assertEqual(said[:len(key) + 2], key + ": ")
                self.assertTrue(keys[name]["description"].startswith(said[len(key) + 2:]), said)

    def test_a_poke_moves_the_ball(self):
        """towards the point, by the speed that would take it there in half a second"""
        self.open(page("configs/rig.yaml", "--set", "controller.sensor.noise=0"))
        self.js("bbsim.seek(20)")
        at = self.js("bbsim.data.runs[0].placeAt(20)")
        self.run_js("await bbsim.live.poke([args[0][0], args[0][1] + 0.05])", at)
        runs = "[20.1, 20].map((t) => ['x', 'y'].map((name) => bbsim.data.%s.at(t, name)))"
        poked, free = (self.js(runs % which) for which in ["runs[0]", "before"])
        for a, b in zip(poked[1], free[1]):
            self.assertAlmostEqual(a, b, 7)  # the page's first run has floats
        # Half of the impulse's way: the force is symmetric in its 0.1 s.
        self.assertAlmostEqual(poked[0][1] - free[0][1], 0.05 / 0.5 * 0.1 / 2, delta=1e-3)
        self.assertAlmostEqual(poked[0][0], free[0][0], delta=1e-4)
        # A click on the plate pokes it, too.
        for flat in ["true", "false"]:
            self.js("bbsim.screen.setFlat(arguments[0] === 'true')", flat)
            self.js("[...document.querySelectorAll('.live button')].find((one) => one.textContent === 'Poke').setAttribute('aria-pressed', 'true')")
            self.js("bbsim.picture.eyes.go('above', true)")
            place = self.js("bbsim.ballOnScreen()")
            found = self.js("bbsim.screen.shown.plateAt(arguments[0], arguments[1])", *place)
            wanted = self.js("bbsim.data.runs[0].placeAt(bbsim.clock.now)")
            for a, b in zip(found, wanted):
                self.assertAlmostEqual(a, b, 2)  # the ball's center is above the plate

    def test_the_newest_of_many_changes_wins(self):
        self.open(page("configs/fig2b.yaml"))
        self.run_js("await Promise.all(Array.from({length: 30}, (_, i) => bbsim.live.set('gravity', 5 + i / 10)))")
        self.assertIn("gravity: 7.9", self.js("bbsim.live.yaml"))
        self.assertEqual(self.js("bbsim.data.runs[0].scenario.overrides"), ["gravity=7.9"])

    def test_undo_and_back_to_the_file(self):
        self.open(page("configs/fig2b.yaml", "--set", "gravity=9.7"))
        x = self.js("bbsim.data.runs[0].values('x')[500]")
        self.run_js("await bbsim.live.set('gravity', 3); await bbsim.live.set('gravity', 4)")
        self.assertNotEqual(self.js("bbsim.data.runs[0].values('x')[500]"), x)
        for act in ["bbsim.live.undo(); bbsim.live.undo()", "bbsim.live.set('gravity', 5).catch(() => {}); bbsim.live.reset()"]:
            self.run_js(act + "; await new Promise((resolve) => setTimeout(resolve, 1500))")
            self.assertAlmostEqual(self.js("bbsim.data.runs[0].values('x')[500]"), x, 6)

    def test_metrics_of_a_step_come_at_rest(self):
        self.open(page("configs/step.yaml"))
        self.assertAlmostEqual(self.js("bbsim.live.measures['x.Overshoot']"), self.overshoot(), delta=0.01)
        self.run_js("await bbsim.live.set('controller.pid.kp.0.0', '0.6')")
        found = self.run_js("const begun = performance.now();"
                            "while (!Number.isFinite(bbsim.live.measures['x.Overshoot'])) {"
                            "  if (performance.now() - begun > 20000) throw new Error('no overshoot');"
                            "  await new Promise((resolve) => setTimeout(resolve, 50));"
                            "}"
                            "return bbsim.live.measures['x.Overshoot']")
        self.assertAlmostEqual(found, self.overshoot("--set", "controller.pid.kp.0.0=0.6"), delta=0.01)

    def overshoot(self, *options):
        table = subprocess.run([BBSIM, "run", "configs/step.yaml", "-q", "-o", os.path.join(FOLDER, "step.csv"),
                                "--measure", "x.Overshoot", *options], cwd=SOURCE, check=True, capture_output=True, text=True).stdout
        return float(table.split(",")[-1])

    def test_faults_are_told_at_their_line(self):
        self.open(page("configs/fig2b.yaml"))
        said = self.run_js("await bbsim.live.edit(bbsim.live.yaml.replace('radius', 'radios'))")
        self.assertIn("did you mean ball.radius?", said["fault"])
        self.js("[...document.querySelectorAll('.faults li')].find((one) => one.textContent.includes('did you mean ball.radius'))"
                ".querySelector('button').click()")
        self.assertIn("radios", self.js("document.activeElement.value.slice(document.activeElement.selectionStart, "
                                        "document.activeElement.selectionEnd)"))
        # The run before stays.
        self.assertEqual(self.js("bbsim.data.runs[0].t.length"), 1051)
        # A key that does not run leaves no trace in the next call.
        self.run_js("await bbsim.live.edit(bbsim.live.yaml)")
        for key, value in (("ball.radius", "-1"), ("ball.radios", "1")):
            self.assertIn(key, self.run_js("await bbsim.live.set(...args)", key, value)["fault"])
            self.assertIsNone(self.run_js("await bbsim.live.set('gravity', 5)"))

    def test_an_event_and_another_plate(self):
        self.open(page("configs/fig2b.yaml"))
        self.run_js("await bbsim.live.edit(bbsim.live.yaml + '\\nplate: {size: [\"6 cm\", \"6 cm\"]}\\nevents: {edge: stop}\\n')")
        self.assertEqual(self.js("bbsim.data.runs[0].status"), "stopped")
        self.assertEqual(self.js("bbsim.data.scene.stage.width"), 0.06)
        self.js("bbsim.screen.setFlat(false)")
        self.js("bbsim.picture.draw()")
        self.assertEqual(self.js("document.querySelectorAll('.tick.stop').length"), 1)
        self.assertEqual(self.browser.console(), [])

    def test_a_link_asks_before_it_changes_anything(self):
        url = page("configs/fig2b.yaml")
        self.open(url)
        self.run_js("await bbsim.live.set('gravity', '5'); await new Promise((resolve) => setTimeout(resolve, 400))")
        link = self.js("location.href")
        self.assertIn("set=", link)
        self.open(link)
        self.assertIn("gravity = 5", self.js("document.querySelector('.offer').textContent"))
        self.assertIn("gravity: 9.81", self.js("bbsim.live.yaml"))
        self.js("document.querySelector('.offer button').click()")
        self.run_js("await new Promise((resolve) => setTimeout(resolve, 2000))")
        self.assertIn("gravity: 5", self.js("bbsim.live.yaml"))


class Sight(unittest.TestCase):
    def test_sliders_and_curves_are_on_one_screen(self):
        """and the sliders stay in sight down to the Bode plot"""
        url = page("configs/rig.yaml")
        for width, height in [(1280, 800), (390, 844)]:
            with self.subTest(width), Browser(width, height, phone=width < 500) as browser:
                browser.open(url)
                box = ("return ['.tuning', arguments[0]].map((one) => document.querySelector(one).getBoundingClientRect())"
                       ".map(({top, bottom}) => [top, bottom])")
                if width < 500:
                    browser.run("document.querySelector('.tuning').scrollIntoView()")
                (top, bottom), (first, last) = browser.run(box, "#plots .frame")
                self.assertGreaterEqual(top, 0)
                self.assertLess(bottom, first)
                self.assertLessEqual(last, height)
                browser.run("document.querySelector('.live-bode').scrollIntoView({block: 'end'})")
                (top, bottom), (first, last) = browser.run(box, ".live-bode")
                self.assertGreaterEqual(top, 0)
                self.assertLess(bottom, first)
                self.assertLessEqual(last, height + 1)
                self.assertEqual(browser.run("return document.documentElement.scrollWidth"), width)

    def test_hints_for_fingers_name_no_mouse(self):
        url = page("configs/rig.yaml")
        for phone, width in [(True, 390), (False, 1280)]:
            with self.subTest(phone), Browser(width, 844, phone=phone) as browser:
                browser.devtools("Emulation.setTouchEmulationEnabled", {"enabled": phone})
                browser.open(url)
                for name in ["Poke", "Tilt by hand"]:
                    browser.run("document.querySelector('.live').scrollIntoView();"
                                "[...document.querySelectorAll('.live button')].find((one) => one.textContent === arguments[0]).click()", name)
                    said = browser.run("const hint = document.getElementById('hint'); return hint.checkVisibility() && hint.textContent")
                    self.assertEqual([word in said.lower() for word in ["click", "arrow keys"]],
                                     [not phone and name == "Poke", not phone and name != "Poke"])
                    self.assertEqual(said, browser.run("return [...document.querySelectorAll('.live button')]"
                                                       ".find((one) => one.textContent === arguments[0]).title", name))
                    top, bottom = browser.run("const {top, bottom} = document.getElementById('screen').getBoundingClientRect(); return [top, bottom]")
                    self.assertGreaterEqual(top, -1)
                    self.assertLessEqual(bottom, 845)
                # A finger that tilts does not scroll.
                self.assertEqual(browser.run("return getComputedStyle(document.getElementById('canvas')).touchAction"), "none")

    def test_a_printed_page_has_the_bode_plot(self):
        with Browser(1280, 800) as browser:
            seen = ("return arguments[0].map((one) => document.querySelector(one).checkVisibility())", [".bode", ".plot canvas", ".sliders", ".live .buttons"])
            browser.open(page("configs/rig.yaml"))
            browser.run("bbsim.print.begin()")
            self.assertEqual(browser.run(*seen), [True, True, False, False])
            browser.run("bbsim.print.end()")
            self.assertEqual(browser.run(*seen), [True, True, True, True])


class Loops(Live):
    def test_margins_follow_a_slider(self):
        """those of `bbsim linearize` and `bbsim check`; the curves cross 0 dB and -180 degrees there"""
        for name, key, value in [("fig2b", "gravity", "8"), ("rig", "controller.sampling.delay", "0.02")]:
            with self.subTest(name):
                self.open(page(f"configs/{name}.yaml"))
                wanted = self.margins(name)
                self.assertEqual(wanted, self.run_js("return bbsim.live.margins()"))
                wanted = self.margins(name, "--set", f"{key}={value}")
                found = self.run_js("await bbsim.live.set(args[0], args[1]); return bbsim.live.margins()", key, value)
                self.assertEqual(sorted(found), sorted(wanted))
                for command, its in wanted.items():
                    for part, number in its.items():
                        self.assertEqual(found[command][part] is None, number is None, part)
                        if number is not None:
                            self.assertAlmostEqual(found[command][part], number, delta=1e-6 * abs(number))
                shown = self.js("document.querySelector('.live-bode .measures').textContent")
                decibels = 20 * math.log10(wanted["phi_command"]["gain"])
                self.assertIn(f"{decibels:.3g} dB", shown)
                said = subprocess.run([BBSIM, "check", f"configs/{name}.yaml", "--set", f"{key}={value}"], cwd=SOURCE,
                                      stdout=subprocess.PIPE, check=True, text=True).stdout
                self.assertIn(f"({decibels:.3g} dB)", said)
                self.assertGreater(self.js("document.querySelectorAll('.bode .curve').length"), 1)
                # No label covers another one.
                self.assertEqual(self.run_js("const boxes = [...document.querySelectorAll('.bode text')].map((one) => one.getBBox());"
                                             "return boxes.filter((a, i) => boxes.slice(0, i).some((b) => a.x < b.x + b.width && "
                                             "b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height)).length"), 0)

    def margins(self, name, *options):
        file = os.path.join(FOLDER, "linear.json")
        subprocess.run([BBSIM, "linearize", f"configs/{name}.yaml", "-o", file, "-q", *options],
                       cwd=SOURCE, check=True)
        with open(file, encoding="utf-8") as stream:
            return json.load(stream)["margins"]

    def test_no_loop_has_no_plot(self):
        self.open(page("configs/fig2a.yaml"))
        self.assertEqual(self.run_js("return bbsim.live.margins()"), {})
        self.assertEqual(self.js("document.querySelectorAll('.bode').length"), 0)


class ManyRuns(Live):
    def test_rigs_are_runs_of_the_program(self):
        """one rig, run by the program, and the band holds it"""
        for name in ["fig2b", "step"]:
            with self.subTest(name):
                self.open(page(f"configs/{name}.yaml"))
                keys = self.run_js("const {keys, status} = await bbsim.live.rigs();"
                                   "if (status.some((word) => word !== 'done')) throw new Error(status);"
                                   "return Object.fromEntries(Object.entries(keys).map(([key, values]) => [key, values[7]]))")
                self.assertNotIn("fault", keys)
                self.assertEqual(self.js("bbsim.data.fan.status.length"), 100)
                wanted = native(f"configs/{name}.yaml", *(f"--set={key}={value!r}" for key, value in keys.items()))
                for column in ["x", "y"]:
                    found = self.js(f"[...bbsim.data.fan.columns.{column}[7]]")
                    size = max(map(abs, wanted[column]))
                    self.assertEqual(len(found), len(wanted[column]))
                    self.assertLessEqual(max(abs(a - b) for a, b in zip(found, wanted[column])), 1e-4 * size)
                least, greatest = self.js("bbsim.data.fan.reach([{role: 'main', name: 'x'}])")
                self.assertLessEqual(least, min(wanted["x"]))
                self.assertGreaterEqual(greatest, max(wanted["x"]))

    def test_rigs_of_an_exercise_differ_in_its_free_keys(self):
        self.open(page("examples/exercise/circle.yaml"))
        keys = self.run_js("await bbsim.live.rigs(); return Object.keys(bbsim.data.fan.keys)")
        self.assertEqual(keys, ["controller.gravity_compensation.kp", "controller.gravity_compensation.kv"])

    def test_a_slider_draws_the_rigs_anew(self):
        self.open(page("configs/fig2b.yaml"))
        self.run_js("await bbsim.live.rigs(); await bbsim.live.set('gravity', '5')")
        self.run_js("const old = bbsim.data.fan.keys.gravity[3], begun = performance.now();"
                    "while (bbsim.data.fan.keys.gravity[3] > 6 || bbsim.data.fan.status.length < 100) {"
                    "  if (performance.now() - begun > 20000) throw new Error(`still ${old}`);"
                    "  await new Promise((resolve) => setTimeout(resolve, 50));"
                    "}")
        self.assertLess(max(self.js("[...bbsim.data.fan.keys.gravity]")), 5.5 + 1e-9)

    def test_a_map_has_the_measures_of_runs(self):
        """and a click on a cell shows its case"""
        self.open(page("configs/fig2b.yaml"))
        keys = ["controller.pd.kp.0.0", "controller.pd.kv.0.0"]
        found = self.run_js("const {keys, status, values} = await bbsim.live.map(args[0], args[1], 'max_tracking_error', 10);"
                            "return {keys, status, values: [...values], x: [...keys[args[0]]], y: [...keys[args[1]]]}", *keys)
        self.assertEqual(len(found["values"]), 100)
        cell = found["status"].index("done", 40)
        values = [found["x"][cell], found["y"][cell]]
        summary = os.path.join(FOLDER, "summary.json")
        subprocess.run([BBSIM, "run", "configs/fig2b.yaml", "-o", os.path.join(FOLDER, "cell.csv"), "-q", "--summary", summary,
                        "--measure", "max_tracking_error", *(f"--set={key}={value!r}" for key, value in zip(keys, values))],
                       cwd=SOURCE, check=True, stdout=subprocess.DEVNULL)
        with open(summary, encoding="utf-8") as stream:
            wanted = json.load(stream)["measures"]["max_tracking_error"]
        self.assertAlmostEqual(found["values"][cell], wanted, delta=1e-4 * wanted)
        self.js("document.querySelector('.map canvas').scrollIntoView()")
        place = self.js("bbsim.map.placeOf(arguments[0])", cell)
        self.browser.frame()
        self.run_js("const target = document.querySelector('.map canvas');"
                    "target.dispatchEvent(new MouseEvent('click', {clientX: args[0], clientY: args[1], bubbles: true}));"
                    "await new Promise((resolve) => setTimeout(resolve, 1500))", *place)
        self.assertAlmostEqual(self.js("bbsim.live.measures.max_tracking_error"), wanted, delta=1e-4 * wanted)


class Hand(Live):
    def test_a_piece_is_a_run_of_the_program(self):
        self.open(page("configs/incline.yaml"))
        tilt = math.radians(5)
        found = self.run_js("return bbsim.live.hand.step({from: [0, 0, 0, 0, args[0], 0], to: [args[0], 0], seconds: 2})", tilt)
        wanted = native("configs/incline.yaml")
        for name in ["x", "vx"]:
            self.assertAlmostEqual(found[name], wanted[name][-1], delta=1e-6)

    def test_leaning_rolls_the_ball_in_real_time(self):
        self.open(page("configs/fig2b.yaml"))
        at = self.js("bbsim.data.runs[0].placeAt(0)")
        state = self.run_js("window.tilted = bbsim.live.hand.start(); bbsim.live.hand.lean(-1, 0);"
                            "while (!(bbsim.live.hand.state && bbsim.live.hand.state.vx < -0.05)) await new Promise(requestAnimationFrame);"
                            "return bbsim.live.hand.state")
        self.assertLess(state["phi"], 0)
        self.assertGreaterEqual(state["phi"], -math.pi / 15 - 1e-9)
        self.assertEqual(state["theta"], 0)
        self.assertEqual(self.js("bbsim.data.runs[0].placeAt(0)[1]"), at[1])
        # The arrow keys lean, too, and the end shows the scenario's run again.
        self.run_js("bbsim.live.hand.lean(0, 0);"
                    "dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp'}));"
                    "while (!(bbsim.live.hand.state.theta < 0)) await new Promise(requestAnimationFrame);"
                    "dispatchEvent(new KeyboardEvent('keyup', {key: 'ArrowUp'}))")
        self.run_js("bbsim.live.hand.stop(); await window.tilted")
        self.assertEqual(self.js("bbsim.data.runs[0].placeAt(0)"), at)
        self.assertEqual(self.browser.console(), [])


class Editor(Live):
    def test_offers_the_keys_that_fit(self):
        self.open(page("configs/fig2b.yaml"))
        self.run_js("const area = document.querySelector('.editor[aria-label*=YAML]'), at = area.value.length;"
                    "area.closest('details').open = true; area.focus();"
                    "area.setRangeText('\\nplate:\\n  si', at, at, 'end'); area.dispatchEvent(new Event('input'));"
                    "while (!document.querySelector('.offers button')) await new Promise(requestAnimationFrame)")
        self.assertEqual(self.js("[...document.querySelectorAll('.offers button')].map((one) => one.textContent)"), ["size"])
        self.js("document.querySelector('.offers button').click()")
        self.assertTrue(self.js("document.activeElement.value").endswith("plate:\n  size: "))
        names = self.js("bbsim.completions('ball:\\n  radius: 1 cm\\n  ', 23, ['ball.mass', 'ball.radius', 'plate.size']).names")
        self.assertEqual(names, ["mass", "radius"])


class Legend(Live):
    def test_a_name_hides_its_curve(self):
        """also while the run changes"""
        self.open(page("configs/fig2b.yaml"))
        self.run_js("bbsim.plots.plots[0].build(); document.querySelector('.plot .legend .label').click();"
                    "await bbsim.live.set('gravity', 9)")
        self.assertEqual(self.js("bbsim.plots.plots[0].visibility().filter((on) => !on).length"), 1)
        self.assertEqual(self.js("document.querySelector('.plot .legend .label').getAttribute('aria-pressed')"), "false")
        self.js("bbsim.plots.plots[0].build()")
        self.assertEqual(self.js("bbsim.plots.plots[0].graph.visibility().filter((on) => !on).length"), 1)


class Controllers(Live):
    def test_the_examples_follow_the_circle(self):
        self.open(page("configs/rig.yaml"))
        for name in self.js("Object.keys(bbsim.examples)"):
            with self.subTest(name):
                self.assertIsNone(self.run_js("await bbsim.live.control(bbsim.examples[args[0]])", name))
                self.assertEqual(self.js("bbsim.data.runs[0].status"), "done")
                self.assertLess(self.js("bbsim.live.measures.max_tracking_error"), 0.02)

    def test_errors_are_told_at_their_line(self):
        self.open(page("configs/rig.yaml"))
        for script, said in [("function step() {\n  return [1 2];\n}", "line 2: SyntaxError"),
                             ("function step(s) {\n\n  return s.no.where;\n}", "line 3: Cannot read"),
                             ("function step() { return [0]; }", "returned [0]; allowed: [phi, theta]"),
                             ("let a = 1;", "step is not defined")]:
            with self.subTest(script):
                self.assertIn(said, self.run_js("await bbsim.live.control(args[0])", script)["fault"])

    def test_undo_leaves_out_what_an_error_stopped(self):
        self.open(page("configs/rig.yaml"))
        self.run_js("await bbsim.live.set('gravity', 9.7)")
        for script in ["let a = 1;", "function step({t}) { if (t > 3) throw new Error('late'); return [0, 0]; }"]:
            with self.subTest(script):
                self.run_js("await bbsim.live.control(args[0]).catch(() => {}); await bbsim.live.control('');"
                            "await bbsim.live.set('gravity', 9.6); await bbsim.live.control(args[0]).catch(() => {});"
                            "await bbsim.live.set('gravity', 9.5).catch(() => {})", script)
                self.js("bbsim.live.undo()")
                self.until("document.querySelector('.faults').textContent === '' && bbsim.data.runs[0].status === 'done'")
                self.assertIn("gravity: 9.6", self.js("bbsim.live.yaml"))

    def test_a_link_brings_it_and_the_reader_runs_it(self):
        url = page("configs/rig.yaml")
        self.open(url)
        script = "// 5 % & <b>\nfunction step({ball}) { return ball ? [-0.3 * ball[0], 0.3 * ball[1]] : [0, 0]; }"
        for key in ["", "gravity"]:
            with self.subTest(key):
                self.run_js("bbsim.live.reset(); if (args[1]) await bbsim.live.set(args[1], '9.5');"
                            "await bbsim.live.control(args[0]); await new Promise((resolve) => setTimeout(resolve, 400))", script, key)
                self.assertIn("controller=", self.js("location.href"))
                error = self.js("bbsim.live.measures.max_tracking_error")
                self.open(self.js("location.href"))
                self.assertIn(script, self.js("document.querySelector('.offer').textContent"))
                ours = self.js("bbsim.live.measures.max_tracking_error")
                self.js("document.querySelector('.offer button').click()")
                self.run_js("await bbsim.live.set('ball.radius', '2 cm')")
                # It stands there as text, and the scenario's law goes on.
                self.assertEqual(self.js("document.querySelector('.editor[aria-label*=JavaScript]').value"), script)
                self.assertLess(self.js("bbsim.live.measures.max_tracking_error"), 2 * ours)
                self.js("[...document.querySelectorAll('.live button')].find((one) => one.textContent === 'Use this controller').click()")
                self.until(f"Math.abs(bbsim.live.measures.max_tracking_error / {error} - 1) < 1e-9")

    def test_the_saved_scenario_has_it_as_comments(self):
        self.open(page("configs/rig.yaml"))
        self.js("bbsim.save.offer = (blob) => { window.saved = blob.text(); }")
        script = "/* one\rtitle: two\u2028title: three\x85title: four */\n\n  function step() { return [0, 0]; }\n"
        self.assertIsNone(self.run_js("await bbsim.live.control(args[0])", script))
        self.js("[...document.querySelectorAll('.live button')].find((one) => one.textContent === 'YAML').click()")
        saved = self.run_js("return window.saved")
        self.assertIn("\n#\n#   function step() { return [0, 0]; }\n", saved)
        file = os.path.join(FOLDER, "saved.yaml")
        with open(file, "w", encoding="utf-8") as stream:
            stream.write(saved)
        self.assertEqual(native(file), native("configs/rig.yaml"))

    def test_an_endless_one_can_be_stopped(self):
        self.open(page("configs/rig.yaml"))
        said = self.run_js("const run = bbsim.live.control('function step() { for (;;); }').catch((error) => error.message);"
                           "await new Promise((resolve) => setTimeout(resolve, 2500));"
                           "const button = document.querySelector('.live-head button');"
                           "if (button.hidden) return 'no button'; button.click(); return run")
        self.assertEqual(said, "stopped")
        self.assertIsNone(self.run_js("await bbsim.live.control('')"))

    def test_has_no_network(self):
        self.open(page("configs/rig.yaml"))
        self.browser.requests()
        self.run_js("await bbsim.live.control('function step() { fetch(\"http://127.0.0.1:9/\").catch(() => {}); return [0, 0]; }')")
        self.assertEqual([url for url in self.browser.requests() if url.startswith("http")], [])
        self.browser.console()


class Hostile(Live):
    SCRIPTS = ["</script><script>window.broken = 1</script>", "<img src=x onerror='window.broken = 1'>",
               "\"><svg onload=window.broken=1>", "javascript:window.broken=1", "${window.broken=1}",
               "<!--<script>window.broken=1//-->", "'; window.broken = 1; '", "{{constructor.constructor('window.broken=1')()}}",
               "\u2028window.broken=1\u202e", "</textarea><script>window.broken=1</script>"]

    def test_no_text_runs_as_code(self):
        for i, words in enumerate(self.SCRIPTS):
            quoted = "'" + words.replace("'", "''").replace("\u2028", " ") + "'"
            file = os.path.join(FOLDER, f"hostile{i}.yaml")
            with open(os.path.join(SOURCE, "configs/fig2b.yaml"), encoding="utf-8") as stream:
                text = stream.read()
            lines = [line for line in text.split("\n") if not line.startswith("title:")]
            tasks = f"exercise: {{tasks: [{{text: {quoted}, expect: max_tilt < 5 deg}}]}}"
            with open(file, "w", encoding="utf-8") as stream:
                stream.write("\n".join(lines) + f"\ntitle: {quoted}\n{tasks}\n# {words.splitlines()[0]}\n")
            with self.subTest(words):
                self.open(page(file) + "#set=" + "%5B%5B%22gravity%22%2C" + "".join(
                    f"%{byte:02X}" for byte in ('"' + words.replace("\\", "\\\\").replace('"', '\\"') + '"').encode()) + "%5D%5D&controller=" + urllib.parse.quote(words + "; window.broken = 1"))
                self.run_js("for (const key of ['title', 'gravity', args[0]]) await bbsim.live.set(key, args[0]).catch(() => {});"
                            "await bbsim.live.edit(args[0]).catch(() => {});"
                            "for (const button of document.querySelectorAll('.offer button')) button.click();"
                            "await new Promise((resolve) => setTimeout(resolve, 300))", words)
                self.assertIsNone(self.js("window.broken || null"))
                # A link's controller is text until the reader uses it.
                self.assertIn(words, self.js("document.querySelector('.editor[aria-label*=JavaScript]').value"))
                self.assertEqual(self.js("[...document.querySelectorAll('.live button')].find((one) => one.textContent.includes('law')).ariaDisabled"), "true")

    def test_no_title_of_two_hundred_runs_as_code(self):
        ends = ["", "\">", "'>", "-->", "</style>", "</title>", "]]>", "*/", "`", "\\"]
        texts = [end + words + more for words in self.SCRIPTS for end in ends for more in ["", "<!--"]]
        self.assertEqual(len(texts), 200)
        self.open(page("configs/fig2a.yaml"))
        self.js("bbsim.plots.end()")  # they show no title, and take long to draw
        shown = []
        for first in range(0, 200, 10):
            shown += self.run_js("const text = bbsim.live.yaml.replace(/^title:.*$/m, ''), shown = [];"
                                 "for (const words of args[0]) {"
                                 "  const quoted = words.replaceAll(\"'\", \"''\").replaceAll('\\u2028', ' ');"
                                 "  await bbsim.live.edit(`title: '${quoted}'\\n${text}`);"
                                 "  shown.push(document.getElementById('title').textContent);"
                                 "}"
                                 "return shown", texts[first:first + 10])
        self.assertEqual(len(shown), 200)
        self.assertIn("<script>window.broken = 1</script>", shown[0])
        self.assertIsNone(self.js("window.broken || null"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
