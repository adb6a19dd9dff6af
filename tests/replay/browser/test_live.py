# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""Tests live pages in a headless Chromium.

The engine computes what the program computes with its baseline kernels; sliders, text, links and controllers work; no
text runs as code. scripts/test-browser calls it.
"""

import json
import math
import os
import platform
import sys
import unittest
import urllib.parse

from in_browser import SOURCE, InBrowser, bbsim, content_of, files, rows_of
from webdriver import Browser

# Scenarios of configs/ whose motion is smooth: their error falls with the tolerance.
SMOOTH = ["fig2a", "fig2b", "incline", "beam", "lissajous", "waypoints", "torque-lqr"]
BASELINE = "sse2" if platform.machine() in ("x86_64", "AMD64") else "baseline"
# These read files.
WITH_FILES = ["recorded", "traced"]
GRAVITY = "await bbsim.live.set('gravity', args[0])"


def native(scenario, *options):
    """The columns of the program's own run."""
    file = files("native.csv")
    bbsim("run", scenario, "-o", file, *options, ends=(0, 1), env={**os.environ, "BBSIM_SIMD": BASELINE})
    rows = rows_of(file)
    return {name: [row[name] for row in rows] for name in rows[0]}


class Live(InBrowser):
    def open(self, name, *options, end=""):
        """The live page of configs/NAME.yaml or of a file."""
        scenario = name if name.endswith(".yaml") else f"configs/{name}.yaml"
        super().open(files.page(f"live-{name}{len(options)}", scenario, "--live", *options) + end)
        self.js("bbsim.screen.setFlat(true)")

    def slide(self, key, value):
        """Moves a key's slider; its range."""
        return self.ask("const slider = document.querySelector(`[data-key='${args[0]}']`); slider.value = args[1];"
                        "for (const type of ['input', 'change']) slider.dispatchEvent(new Event(type));"
                        "return [slider.min, slider.max].map(Number)", key, value)

    def columns_of(self, text, **keys):
        found = self.ask("await bbsim.live.edit(args[0]);"
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
        self.open("fig2b")
        for file in sorted(os.listdir(os.path.join(SOURCE, "configs"))):
            name, ending = os.path.splitext(file)
            if ending != ".yaml" or name in WITH_FILES:
                continue
            with self.subTest(name):
                text = content_of(f"configs/{file}")
                # The positions' rounding differs with the machine's sine and root; a motion that is not smooth
                # multiplies it.
                self.compare(self.columns_of(text), native(f"configs/{file}"), 1e-6)
                if name in SMOOTH:
                    self.compare(self.columns_of(text, **{"solver.rtol": "1e-12", "solver.atol": "1e-14"}),
                                 native(f"configs/{file}", "--set", "solver.rtol=1e-12", "--set", "solver.atol=1e-14"),
                                 1e-12)

    def test_says_what_it_cannot_run(self):
        self.open("recorded")
        fault = self.ask("await bbsim.live.set('ball.radius', '2 cm')")["fault"]
        self.assertIn("recorded-angles.csv", fault)
        self.open("fig2b")
        self.assertIn("solver.method", self.ask("await bbsim.live.set('solver.method', 'bdf')")["fault"])

    def test_starts_at_the_first_touch(self):
        self.open("fig2b")
        self.assertEqual(self.js("document.querySelector('.live-status').textContent"), "")
        self.assertEqual(len(self.js("[...bbsim.live.columns.x]")), 1051)


class Page(Live):
    def test_sliders_follow_the_exercise(self):
        self.open("examples/exercise/circle.yaml")
        free = self.js("bbsim.data.scene.live.free")
        self.assertEqual(self.js("[...document.querySelectorAll('.slider input[type=range]')].map((one) => one.dataset.key)"),
                         [key for key in sorted(free) if key in self.js("bbsim.data.scene.live.keys.map(({key}) => key)")])
        # A learner opens it unsolved, and can solve it within the sliders' ranges.
        self.assertEqual(self.js("bbsim.live.tasks"), [False, False])
        for key in free:
            self.slide(key, 3)
        self.ask(GRAVITY, "9.81")
        self.assertEqual(self.js("bbsim.live.tasks"), [True, True])
        self.assertEqual(self.count(".tasks .holds"), 2)

    def test_a_slider_changes_the_run(self):
        self.open("fig2b")
        before = self.js("bbsim.data.runs[0].at(0, 'x')")
        self.slide("controller.reference.circle.radius", 8)
        self.ask(GRAVITY, "9.8")
        self.assertIn("radius: 8 cm", self.js("bbsim.live.yaml"))
        self.assertIn("# Fig. 2(b)", self.js("bbsim.live.yaml"))  # comments stay
        after = self.js("bbsim.data.runs[0].at(0, 'x')")
        self.assertNotEqual(before, after)
        # The picture has the new path, and the plots the former run beside it.
        self.assertAlmostEqual(max(self.js("[...bbsim.data.runs[0].path]")), 0.08, 3)
        self.assertIn("x before", self.js("document.getElementById('plots').textContent"))

    def test_a_slider_at_zero_has_its_neighbors_range(self):
        self.open("rig")
        self.assertEqual(self.slide("ball.position.1", 3), [-12.5, 12.5])  # that of 5 cm
        low, high = self.slide("controller.sensor.seed", 99)
        self.assertEqual(high, int(high))
        self.assertIsNone(self.ask(GRAVITY, "9.8"))
        self.assertIn("3 cm]", self.js("bbsim.live.yaml"))
        self.assertIn(f"seed: {high}", self.js("bbsim.live.yaml"))
        self.slide("ball.position.1", 0)
        self.ask("bbsim.live.undo(); await bbsim.live.set('gravity', '9.7')")
        self.assertEqual(float(self.js("document.querySelector('[data-key=\"ball.position.1\"]').value")), 3)

    def test_a_slider_tells_what_its_key_means(self):
        """when the page opens, and from the engine when keys come"""
        schema = json.loads(bbsim("--schema"))["properties"]["ball"]["properties"]
        self.open("rig")
        for change in ["", "await bbsim.live.edit(bbsim.live.yaml.replace('mass:', 'inertia_factor: 0.4, mass:'))"]:
            self.ask(change)
            # A finger sees no title.
            self.js("document.querySelector('[data-key=\"ball.mass\"]').dispatchEvent(new Event('pointerdown', {bubbles: true}))")
            said = self.browser.text(".meaning").removeprefix("ball.mass: ")
            self.assertTrue(said and schema["mass"]["description"].startswith(said), said)

    def test_a_poke_moves_the_ball(self):
        """towards the point, by the speed that would take it there in half a second"""
        self.open("rig", "--set", "controller.sensor.noise=0")
        self.js("bbsim.seek(20)")
        at = self.js("bbsim.data.runs[0].placeAt(20)")
        self.ask("await bbsim.live.poke([args[0][0], args[0][1] + 0.05])", at)
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
            self.js("bbsim.picture.eyes.go('above', true)")
            place = self.js("bbsim.ballOnScreen()")
            found = self.js("bbsim.screen.shown.plateAt(arguments[0], arguments[1])", *place)
            wanted = self.js("bbsim.data.runs[0].placeAt(bbsim.clock.now)")
            for a, b in zip(found, wanted):
                self.assertAlmostEqual(a, b, 2)  # the ball's center is above the plate

    def test_the_newest_of_many_changes_wins(self):
        self.open("fig2b")
        self.ask("await Promise.all(Array.from({length: 30}, (_, i) => bbsim.live.set('gravity', 5 + i / 10)))")
        self.assertIn("gravity: 7.9", self.js("bbsim.live.yaml"))
        self.assertEqual(self.js("bbsim.data.runs[0].scenario.overrides"), ["gravity=7.9"])

    def test_undo_and_back_to_the_file(self):
        self.open("fig2b", "--set", "gravity=9.7")
        x = self.js("bbsim.data.runs[0].values('x')[500]")
        self.ask("await bbsim.live.set('gravity', 3); await bbsim.live.set('gravity', 4)")
        self.assertNotEqual(self.js("bbsim.data.runs[0].values('x')[500]"), x)
        for act in ["bbsim.live.undo(); bbsim.live.undo()", "bbsim.live.set('gravity', 5).catch(() => {}); bbsim.live.reset()"]:
            self.ask(act)
            self.wait(f"Math.abs(bbsim.data.runs[0].values('x')[500] - {x!r}) < 5e-7")

    def test_metrics_of_a_step_come_at_rest(self):
        self.open("step")
        for change in [(), ("controller.pid.kp.0.0", "0.6")]:
            if change:
                self.ask("await bbsim.live.set(...args)", *change)
            self.wait("Number.isFinite(bbsim.live.measures['x.Overshoot'])")
            table = bbsim("run", "configs/step.yaml", "-o", files("step.csv"), "--measure", "x.Overshoot",
                          *(f"--set={change[0]}={change[1]}" for _ in change[:1]))
            self.near(self.js("bbsim.live.measures['x.Overshoot']"), float(table.split(",")[-1]), 0.01)

    def test_faults_are_told_at_their_line(self):
        self.open("fig2b")
        said = self.ask("await bbsim.live.edit(bbsim.live.yaml.replace('radius', 'radios'))")
        self.assertIn("did you mean ball.radius?", said["fault"])
        self.js("[...document.querySelectorAll('.faults li')].find((one) => one.textContent.includes('did you mean ball.radius'))"
                ".querySelector('button').click()")
        self.assertIn("radios", self.js("document.activeElement.value.slice(document.activeElement.selectionStart, "
                                        "document.activeElement.selectionEnd)"))
        # The run before stays.
        self.assertEqual(self.js("bbsim.data.runs[0].t.length"), 1051)
        # A key that does not run leaves no trace in the next call.
        self.ask("await bbsim.live.edit(bbsim.live.yaml)")
        for key, value in (("ball.radius", "-1"), ("ball.radios", "1")):
            self.assertIn(key, self.ask("await bbsim.live.set(...args)", key, value)["fault"])
            self.assertIsNone(self.ask(GRAVITY, "5"))

    def test_offers_the_keys_that_fit(self):
        self.open("fig2b")
        self.ask("const area = document.querySelector('.editor[aria-label*=YAML]'), at = area.value.length;"
                 "area.closest('details').open = true; area.focus();"
                 "area.setRangeText('\\nplate:\\n  si', at, at, 'end'); area.dispatchEvent(new Event('input'));"
                 "while (!document.querySelector('.offers button')) await new Promise(requestAnimationFrame)")
        self.assertEqual(self.texts(".offers button"), ["size"])
        self.js("document.querySelector('.offers button').click()")
        self.assertTrue(self.js("document.activeElement.value").endswith("plate:\n  size: "))
        names = self.js("bbsim.completions('ball:\\n  radius: 1 cm\\n  ', 23, ['ball.mass', 'ball.radius', 'plate.size']).names")
        self.assertEqual(names, ["mass", "radius"])

    def test_a_name_hides_its_curve(self):
        """also while the run changes"""
        self.open("fig2b")
        self.ask("bbsim.plots.plots[0].build(); document.querySelector('.plot .legend .label').click();"
                 "await bbsim.live.set('gravity', 9)")
        self.assertEqual(self.js("bbsim.plots.plots[0].visibility().filter((on) => !on).length"), 1)
        self.assertEqual(self.js("document.querySelector('.plot .legend .label').getAttribute('aria-pressed')"), "false")
        self.js("bbsim.plots.plots[0].build()")
        self.assertEqual(self.js("bbsim.plots.plots[0].graph.visibility().filter((on) => !on).length"), 1)

    def test_an_event_and_another_plate(self):
        self.open("fig2b")
        self.ask("await bbsim.live.edit(bbsim.live.yaml + '\\nplate: {size: [\"6 cm\", \"6 cm\"]}\\nevents: {edge: stop}\\n')")
        self.assertEqual(self.js("bbsim.data.runs[0].status"), "stopped")
        self.assertEqual(self.js("bbsim.data.scene.stage.width"), 0.06)
        self.js("bbsim.screen.setFlat(false)")
        self.js("bbsim.picture.draw()")
        self.assertEqual(self.count(".tick.stop"), 1)
        self.assertEqual(self.browser.console(), [])

    def test_a_link_asks_before_it_changes_anything(self):
        self.open("fig2b")
        self.ask(GRAVITY, "5")
        hash_ = self.wait("location.hash.includes('set=') && location.hash")
        self.open("fig2b", end=hash_)
        self.assertIn("gravity = 5", self.browser.text(".offer"))
        self.assertIn("gravity: 9.81", self.js("bbsim.live.yaml"))
        self.js("document.querySelector('.offer button').click()")
        self.wait("bbsim.live.yaml.includes('gravity: 5')")


class Sight(unittest.TestCase):
    def test_sliders_and_curves_are_on_one_screen(self):
        """and the sliders stay in sight down to the Bode plot"""
        for width, height in [(1280, 800), (390, 844)]:
            with self.subTest(width), Browser(width, height, phone=width < 500) as browser:
                browser.open(files.page("sight", "configs/rig.yaml", "--live"))
                for begin, place in [(".tuning" if width < 500 else "body", "#plots .frame"), (".live-bode", ".live-bode")]:
                    (top, bottom), (first, last) = browser.run("""
                        document.querySelector(arguments[0]).scrollIntoView({block: arguments[0] === '.live-bode' ? 'end' : 'start'});
                        return ['.tuning', arguments[1]].map((one) => document.querySelector(one).getBoundingClientRect())
                            .map(({top, bottom}) => [top, bottom])""", begin, place)
                    self.assertGreaterEqual(top, 0)
                    self.assertLess(bottom, first)
                    self.assertLessEqual(last, height + 1)
                self.assertEqual(browser.run("return document.documentElement.scrollWidth"), width)


class Loops(Live):
    def test_margins_follow_a_slider(self):
        """those of `bbsim linearize` and `bbsim check`; the curves cross 0 dB and -180 degrees there"""
        for name, key, value in [("fig2b", "gravity", "8"), ("rig", "controller.sampling.delay", "0.02")]:
            with self.subTest(name):
                self.open(name)
                wanted = self.margins(name)
                self.assertEqual(wanted, self.ask("return bbsim.live.margins()"))
                wanted = self.margins(name, "--set", f"{key}={value}")
                found = self.ask("await bbsim.live.set(args[0], args[1]); return bbsim.live.margins()", key, value)
                self.assertEqual(sorted(found), sorted(wanted))
                for command, its in wanted.items():
                    for part, number in its.items():
                        self.assertEqual(found[command][part] is None, number is None, part)
                        if number is not None:
                            self.assertAlmostEqual(found[command][part], number, delta=1e-6 * abs(number))
                shown = self.js("document.querySelector('.live-bode .measures').textContent")
                decibels = 20 * math.log10(wanted["phi_command"]["gain"])
                self.assertIn(f"{decibels:.3g} dB", shown)
                said = bbsim("check", f"configs/{name}.yaml", "--set", f"{key}={value}")
                self.assertIn(f"({decibels:.3g} dB)", said)
                self.assertGreater(self.count(".bode .curve"), 1)
                # No label covers another one.
                self.assertEqual(self.ask("const boxes = [...document.querySelectorAll('.bode text')].map((one) => one.getBBox());"
                                          "return boxes.filter((a, i) => boxes.slice(0, i).some((b) => a.x < b.x + b.width && "
                                          "b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height)).length"), 0)

    def margins(self, name, *options):
        bbsim("linearize", f"configs/{name}.yaml", "-o", files("linear.json"), *options)
        return json.loads(content_of(files("linear.json")))["margins"]

    def test_a_printed_page_has_the_bode_plot(self):
        self.open("rig")
        for step, sliders in [("begin", False), ("end", True)]:
            self.js(f"bbsim.print.{step}()")
            seen = "['.bode', '.plot canvas', '.sliders', '.live .buttons'].map((one) => document.querySelector(one).checkVisibility())"
            self.assertEqual(self.js(seen), [True, True, sliders, sliders])

    def test_no_loop_has_no_plot(self):
        self.open("fig2a")
        self.assertEqual(self.ask("return bbsim.live.margins()"), {})
        self.assertEqual(self.count(".bode"), 0)


class ManyRuns(Live):
    def test_rigs_are_runs_of_the_program(self):
        """one rig, run by the program, and the band holds it"""
        for name in ["fig2b", "step"]:
            with self.subTest(name):
                self.open(name)
                keys = self.ask("const {keys, status} = await bbsim.live.rigs();"
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
        self.open("examples/exercise/circle.yaml")
        keys = self.ask("await bbsim.live.rigs(); return Object.keys(bbsim.data.fan.keys)")
        self.assertEqual(keys, ["controller.gravity_compensation.kp", "controller.gravity_compensation.kv"])

    def test_a_slider_draws_the_rigs_anew(self):
        self.open("fig2b")
        self.ask("await bbsim.live.rigs(); await bbsim.live.set('gravity', '5')")
        self.wait("bbsim.data.fan.keys.gravity[3] < 6 && bbsim.data.fan.status.length === 100")
        self.assertLess(max(self.js("[...bbsim.data.fan.keys.gravity]")), 5.5 + 1e-9)

    def test_a_map_has_the_measures_of_runs(self):
        """and a click on a cell shows its case"""
        self.open("fig2b")
        keys = ["controller.pd.kp.0.0", "controller.pd.kv.0.0"]
        found = self.ask("const {keys, status, values} = await bbsim.live.map(args[0], args[1], 'max_tracking_error', 10);"
                         "return {keys, status, values: [...values], x: [...keys[args[0]]], y: [...keys[args[1]]]}", *keys)
        self.assertEqual(len(found["values"]), 100)
        cell = found["status"].index("done", 40)
        values = [found["x"][cell], found["y"][cell]]
        bbsim("run", "configs/fig2b.yaml", "-o", files("cell.csv"), "--summary", files("cell.json"), "--measure",
              "max_tracking_error", *(f"--set={key}={value!r}" for key, value in zip(keys, values)))
        wanted = json.loads(content_of(files("cell.json")))["measures"]["max_tracking_error"]
        self.assertAlmostEqual(found["values"][cell], wanted, delta=1e-4 * wanted)
        self.js("document.querySelector('.map canvas').scrollIntoView()")
        place = self.js("bbsim.map.placeOf(arguments[0])", cell)
        self.browser.frame()
        self.ask("const target = document.querySelector('.map canvas');"
                 "target.dispatchEvent(new MouseEvent('click', {clientX: args[0], clientY: args[1], bubbles: true}))", *place)
        self.wait(f"Math.abs(bbsim.live.measures.max_tracking_error - {wanted}) < 1e-4 * {wanted}")


class Hand(Live):
    def test_a_piece_is_a_run_of_the_program(self):
        self.open("incline")
        tilt = math.radians(5)
        found = self.ask("return bbsim.live.hand.step({from: [0, 0, 0, 0, args[0], 0], to: [args[0], 0], seconds: 2})", tilt)
        wanted = native("configs/incline.yaml")
        for name in ["x", "vx"]:
            self.assertAlmostEqual(found[name], wanted[name][-1], delta=1e-6)

    def test_leaning_rolls_the_ball_in_real_time(self):
        self.open("fig2b")
        at = self.js("bbsim.data.runs[0].placeAt(0)")
        state = self.ask("window.tilted = bbsim.live.hand.start(); bbsim.live.hand.lean(-1, 0);"
                         "while (!(bbsim.live.hand.state && bbsim.live.hand.state.vx < -0.05)) await new Promise(requestAnimationFrame);"
                         "return bbsim.live.hand.state")
        self.assertLess(state["phi"], 0)
        self.assertGreaterEqual(state["phi"], -math.pi / 15 - 1e-9)
        self.assertEqual(state["theta"], 0)
        self.assertEqual(self.js("bbsim.data.runs[0].placeAt(0)[1]"), at[1])
        # The arrow keys lean, too, and the end shows the scenario's run again.
        self.ask("bbsim.live.hand.lean(0, 0);"
                 "dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowUp'}));"
                 "while (!(bbsim.live.hand.state.theta < 0)) await new Promise(requestAnimationFrame);"
                 "dispatchEvent(new KeyboardEvent('keyup', {key: 'ArrowUp'}))")
        self.ask("bbsim.live.hand.stop(); await window.tilted")
        self.assertEqual(self.js("bbsim.data.runs[0].placeAt(0)"), at)
        self.assertEqual(self.browser.console(), [])


class Controllers(Live):
    def test_the_examples_follow_the_circle(self):
        self.open("rig")
        for name in self.js("Object.keys(bbsim.examples)"):
            with self.subTest(name):
                self.assertIsNone(self.ask("await bbsim.live.control(bbsim.examples[args[0]])", name))
                self.assertEqual(self.js("bbsim.data.runs[0].status"), "done")
                self.assertLess(self.js("bbsim.live.measures.max_tracking_error"), 0.02)

    def test_errors_are_told_at_their_line(self):
        self.open("rig")
        for script, said in [("function step() {\n  return [1 2];\n}", "line 2: SyntaxError"),
                             ("function step(s) {\n\n  return s.no.where;\n}", "line 3: Cannot read"),
                             ("function step() { return [0]; }", "returned [0]; allowed: [phi, theta]"),
                             ("let a = 1;", "step is not defined")]:
            with self.subTest(script):
                self.assertIn(said, self.ask("await bbsim.live.control(args[0])", script)["fault"])

    def test_undo_leaves_out_what_an_error_stopped(self):
        self.open("rig")
        self.ask(GRAVITY, "9.7")
        for script in ["let a = 1;", "function step({t}) { if (t > 3) throw new Error('late'); return [0, 0]; }"]:
            with self.subTest(script):
                self.ask("await bbsim.live.control(args[0]).catch(() => {}); await bbsim.live.control('');"
                         "await bbsim.live.set('gravity', 9.6); await bbsim.live.control(args[0]).catch(() => {});"
                         "await bbsim.live.set('gravity', 9.5).catch(() => {})", script)
                self.js("bbsim.live.undo()")
                self.wait("document.querySelector('.faults').textContent === '' && bbsim.data.runs[0].status === 'done'")
                self.assertIn("gravity: 9.6", self.js("bbsim.live.yaml"))

    def test_a_link_brings_it_and_the_reader_runs_it(self):
        self.open("rig")
        script = "// 5 % & <b>\nfunction step({ball}) { return ball ? [-0.3 * ball[0], 0.3 * ball[1]] : [0, 0]; }"
        for key in ["", "gravity"]:
            with self.subTest(key):
                self.ask("bbsim.live.reset(); if (args[1]) await bbsim.live.set(args[1], '9.5');"
                         "await bbsim.live.control(args[0])", script, key)
                hash_ = self.wait(f"location.hash.includes('controller=') && location.hash.includes('{key}') && location.hash")
                error = self.js("bbsim.live.measures.max_tracking_error")
                self.open("rig", end=hash_)
                self.assertIn(script, self.browser.text(".offer"))
                ours = self.js("bbsim.live.measures.max_tracking_error")
                self.js("document.querySelector('.offer button').click()")
                self.ask("await bbsim.live.set('ball.radius', '2 cm')")
                # It stands there as text, and the scenario's law goes on.
                self.assertEqual(self.js("document.querySelector('.editor[aria-label*=JavaScript]').value"), script)
                self.assertLess(self.js("bbsim.live.measures.max_tracking_error"), 2 * ours)
                self.press("Use this controller")
                self.wait(f"Math.abs(bbsim.live.measures.max_tracking_error / {error} - 1) < 1e-9")

    def test_the_saved_scenario_has_it_as_comments(self):
        self.open("rig")
        self.js("bbsim.save.offer = (blob) => { window.saved = blob.text(); }")
        script = "/* one\rtitle: two\u2028title: three\x85title: four */\n\n  function step() { return [0, 0]; }\n"
        self.assertIsNone(self.ask("await bbsim.live.control(args[0])", script))
        self.press("YAML")
        saved = self.ask("return window.saved")
        self.assertIn("\n#\n#   function step() { return [0, 0]; }\n", saved)
        file = files.write("saved.yaml", saved)
        self.assertEqual(native(file), native("configs/rig.yaml"))

    def test_an_endless_one_can_be_stopped(self):
        self.open("rig")
        said = self.ask("const run = bbsim.live.control('function step() { for (;;); }').catch((error) => error.message);"
                        "await new Promise((resolve) => setTimeout(resolve, 2500));"
                        "const button = document.querySelector('.live-head button');"
                        "if (button.hidden) return 'no button'; button.click(); return run")
        self.assertEqual(said, "stopped")
        self.assertIsNone(self.ask("await bbsim.live.control('')"))

    def test_has_no_network(self):
        self.open("rig")
        self.browser.requests()
        self.ask("await bbsim.live.control('function step() { fetch(\"http://127.0.0.1:9/\").catch(() => {}); return [0, 0]; }')")
        self.assertEqual([url for url in self.browser.requests() if url.startswith("http")], [])
        self.browser.console()


class Hostile(Live):
    SCRIPTS = ["</script><script>window.broken = 1</script>", "<img src=x onerror='window.broken = 1'>",
               "\"><svg onload=window.broken=1>", "javascript:window.broken=1", "${window.broken=1}",
               "<!--<script>window.broken=1//-->", "'; window.broken = 1; '", "{{constructor.constructor('window.broken=1')()}}",
               "\u2028window.broken=1\u202e", "</textarea><script>window.broken=1</script>"]

    def test_no_text_runs_as_code(self):
        text = "\n".join(line for line in content_of("configs/fig2b.yaml").split("\n") if not line.startswith("title:"))
        for i, words in enumerate(self.SCRIPTS):
            quoted = "'" + words.replace("'", "''").replace("\u2028", " ") + "'"
            tasks = f"exercise: {{tasks: [{{text: {quoted}, expect: max_tilt < 5 deg}}]}}"
            file = files.write(f"hostile{i}.yaml", f"{text}\ntitle: {quoted}\n{tasks}\n# {words.splitlines()[0]}\n")
            link = {"set": json.dumps([["gravity", words]], ensure_ascii=False), "controller": words + "; window.broken = 1"}
            with self.subTest(words):
                self.open(file, end="#" + urllib.parse.urlencode(link, quote_via=urllib.parse.quote))
                self.ask("for (const key of ['title', 'gravity', args[0]]) await bbsim.live.set(key, args[0]).catch(() => {});"
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
        self.open("fig2a")
        self.js("bbsim.plots.end()")  # they show no title, and take long to draw
        shown = []
        for first in range(0, 200, 10):
            shown += self.ask("const text = bbsim.live.yaml.replace(/^title:.*$/m, ''), shown = [];"
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
