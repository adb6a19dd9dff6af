# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""Replays in a real browser: what is drawn is what the files say, and what is pressed does what it says.

    test_replay.py BBSIM MAKE_PAGE TEMPLATE SOURCE [unittest's arguments]

with the program, tests/replay/make_page, share/bbsim/replay.html and the repository.
"""

import atexit
import base64
import csv
import json
import math
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

from webdriver import Browser, pixels

BBSIM, MAKE_PAGE, TEMPLATE, SOURCE = (os.path.abspath(name) for name in sys.argv[1:5])
HOSTILE = "</script><script>window.broken = 1</script><img src=x onerror='window.broken = 2'> \"q\" 'q' \x1b[31m \u2028 \u202e &lt;"


def bbsim(*words, ends=(0,)):
    """Runs the program in SOURCE, quietly."""
    made = subprocess.run([BBSIM, *words, "-q"], cwd=SOURCE, capture_output=True, text=True)
    assert made.returncode in ends, (words, made.returncode, made.stderr)
    return made.returncode


def cases_of(file):
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


def rows_of(file):
    return [{name: float(value or "nan") for name, value in row.items()} for row in cases_of(file)]


def number(text):
    return float(text.replace("\u2212", "-"))


class Files:
    """Runs of configs/ and their pages, made once for all tests."""

    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="bbsim-replay-")
        atexit.register(shutil.rmtree, self.folder, True)
        self.made = set()

    def __call__(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self(name), "w") as stream:
            stream.write(text)
        return self(name)

    def change(self, name, **values):
        """Changes a JSON."""
        with open(self(name)) as stream:
            its = json.load(stream)
        its.update(values)
        self.write(name, json.dumps(its))

    def config(self, name):
        return f"configs/{name}.yaml"  # relative to SOURCE, where everything runs

    def run(self, name, config, *options):
        """The result NAME.csv with NAME.json and NAME.txt, as make_page expects it."""
        if name not in self.made:
            self.made.add(name)
            self.result(name, config, *options)
            with open(self(name + ".txt"), "w") as text:
                subprocess.run([BBSIM, "check", self.config(config)], cwd=SOURCE, stdout=text, check=True)
        return ",".join([self(name + ".csv"), self.config(config), self(name + ".json"), self(name + ".txt")])

    def result(self, name, config, *options):
        bbsim("run", self.config(config), "-o", self(name + ".csv"), "--summary", self(name + ".json"), *options, ends=(0, 1))
        return self(name + ".csv")

    def page(self, name, *arguments):
        file = self(name + ".html")
        if not os.path.exists(file):
            subprocess.run([MAKE_PAGE, "--template", TEMPLATE, "-o", file, *arguments], cwd=SOURCE, check=True)
        return "file://" + file

    def replay(self, config, *options):
        return self.page(config, self.run(config, config, *options))

    def sweep(self, name, config, *options):
        table = self(name + ".csv")
        if not os.path.exists(table):
            bbsim("sweep", self.config(config), *options, "-o", table)
        return self.page(name, "--sweep", table, self.config(config)), table


files = Files()


def multiply(matrix, vector):
    """Applies a column-major matrix, as WebGL stores it."""
    return [sum(matrix[4 * column + row] * vector[column] for column in range(4)) for row in range(4)]


def on_screen(view, row, radius, factor=1):
    """Where a row's ball is in the window: (6) of docs/explanation/model.md, then the page's camera."""
    phi, theta = factor * row["phi"], factor * row["theta"]
    x, y, z = row["x"], row["y"], radius
    # R_x(theta), then R_y(phi).
    y, z = y * math.cos(theta) - z * math.sin(theta), y * math.sin(theta) + z * math.cos(theta)
    x, z = x * math.cos(phi) + z * math.sin(phi), -x * math.sin(phi) + z * math.cos(phi)
    clip = multiply(view["projection"], multiply(view["view"], [x, y, z, 1]))
    left, top, width, height = view["canvas"]
    return (left + (clip[0] / clip[3] + 1) / 2 * width, top + (1 - clip[1] / clip[3]) / 2 * height)


class InBrowser(unittest.TestCase):
    options = {}  # browser options of a test class; classes without any share one browser
    shared = None

    @classmethod
    def setUpClass(cls):
        if not cls.options and InBrowser.shared is not None:
            cls.browser = InBrowser.shared
            return
        cls.browser = Browser(**cls.options).__enter__()
        if cls.options:
            cls.addClassCleanup(cls.browser.__exit__, None, None, None)
        else:
            InBrowser.shared = cls.browser
            unittest.addModuleCleanup(cls.browser.__exit__, None, None, None)

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
        return self.browser.run("return " + script, *arguments)

    def seek(self, t):
        self.js("[bbsim.seek(arguments[0]), bbsim.picture && bbsim.picture.draw()]", t)

    def ask(self, script, *arguments):
        """Runs a script until it calls `done`."""
        return self.browser.call("POST", "/execute/async", {
            "script": f"const done = arguments[{len(arguments)}];" + script, "args": list(arguments)})

    def wait(self, condition, seconds=20):
        """Waits until the expression is true in the page, and returns its last value."""
        return self.ask(f"""const until = Date.now() + {seconds} * 1000;
            const look = () => {{ const is = {condition}; if (is || Date.now() > until) done(is); else setTimeout(look, 20); }};
            look();""")

    def box(self, selector):
        """Left, top, width and height of an element."""
        return self.js("(({left, top, width, height}) => [left, top, width, height])"
                       "(document.querySelector(arguments[0]).getBoundingClientRect())", selector)

    def ranges(self):
        """Those of time in all drawn plots."""
        return self.js("bbsim.plots.plots.filter((p) => p.graph).map((p) => p.graph.xAxisRange())")

    def in_plot(self, t):
        """The place of a time in the first plot, halfway up."""
        return self.js("""(() => { const {graph, canvas} = bbsim.plots.plots[0], box = canvas.getBoundingClientRect();
            return [box.left + graph.toDomXCoord(arguments[0]), box.top + box.height / 2]; })()""", t)

    def hidden(self, name):
        return self.js("document.getElementById(arguments[0]).hidden", name)

    def near(self, found, wanted, within):
        self.assertLessEqual(abs(found - wanted), within, f"{found} is not {wanted} within {within}")

    def all_near(self, found, wanted, within):
        for one, its in zip(found, wanted, strict=True):
            self.near(one, its, within)

    def ball_is_at(self, row, radius, within, factor=1):
        self.all_near(self.js("bbsim.ballOnScreen()"), on_screen(self.js("bbsim.view()"), row, radius, factor), within)

    def named(self):
        """Everything that can be used has a name."""
        self.assertEqual(self.js("""[...document.querySelectorAll('button, input, select, canvas, [role=img]')].filter((e) =>
            !(e.getAttribute('aria-label') || e.textContent.trim() || (e.labels && e.labels.length) ||
              e.querySelector('title') || e.closest('.plot'))).map((e) => e.outerHTML)"""), [])


class TheBall(InBrowser):
    def check(self, name, radius, factor=1, view="free"):
        rows = rows_of(files(name + ".csv"))
        self.js("bbsim.picture.eyes.go(arguments[0])", view)
        for k in range(10):
            row = rows[round(k * (len(rows) - 1) / 9)]
            self.js("bbsim.seek(arguments[0])", row["t"])
            self.ball_is_at(row, radius, 0.05, factor)  # floats, over a few hundred pixels

    def test_is_where_the_csv_says_in_every_view(self):
        self.open(files.replay("rig"))
        for view in ["free", "above", "front", "axis", "plate"]:
            with self.subTest(view):
                self.check("rig", 0.02, view=view)

    def test_and_where_the_tilt_is_drawn_larger(self):
        self.open(files.replay("fig2b"))
        self.browser.keys("e", "e")
        self.assertEqual(self.js("bbsim.picture.factor"), 5)
        self.check("fig2b", 0.01, factor=5)
        self.assertEqual(self.browser.text("#exaggerated"), "Tilt drawn ×5")

    def test_is_drawn_there(self):
        """Checks that removing the ball changes pixels only near the ball's computed place."""
        self.open(files.replay("rig"))
        rows = rows_of(files("rig.csv"))
        self.js("bbsim.picture.eyes.go('above')")
        for name in ["trail", "reference", "sensor", "events", "axes"]:
            self.js("bbsim.screen.show(arguments[0], false)", name)
        self.js("bbsim.picture.actors[0].shadow.material.uniforms.opacity.value = 0")
        for index in [0, 700, 1400]:
            self.js("bbsim.seek(arguments[0])", rows[index]["t"])
            x, y = on_screen(self.js("bbsim.view()"), rows[index], 0.02)
            clip = (math.floor(x) - 60, math.floor(y) - 60, 120, 120)
            shots = []
            for shown in [True, False]:
                self.js("[bbsim.data.runs[0].shown = arguments[0], bbsim.picture.draw()]", shown)
                self.browser.frame()
                shots.append(pixels(self.browser.picture(clip=clip))[2])
            self.js("bbsim.data.runs[0].shown = true")
            changed = [(i, j) for j in range(120) for i in range(120)
                       if max(abs(a - b) for a, b in zip(shots[0][j][i], shots[1][j][i])) > 24]
            columns, lines = [i for i, _ in changed], [j for _, j in changed]
            self.assertGreater(len(changed), 200)
            # Seen from above, away from the middle, perspective shifts the ball's outline by less than a pixel.
            self.near(clip[0] + (min(columns) + max(columns) + 1) / 2, x, 1.5)
            self.near(clip[1] + (min(lines) + max(lines) + 1) / 2, y, 1.5)

    def test_turns_as_it_rolls(self):
        self.open(files.replay("fig2a"))
        rows = rows_of(files("fig2a.csv"))
        self.seek(rows[-1]["t"])
        # The orientation is computed from row to row, as the page says if none was recorded; it includes gamma.
        self.assertIn("rolls straight from row to row", self.browser.text("#details"))
        q = self.js("bbsim.picture.actors[0].ball.mesh.quaternion.toArray()")
        self.near(math.sqrt(sum(c * c for c in q)), 1, 1e-6)
        self.assertLess(abs(q[3]), 0.9999)


class TheAxes(InBrowser):
    def test_have_three_round_numbers_or_more(self):
        for name in ["slips", "rig", "fig2b", "three-servos", "sags"]:
            with self.subTest(name):
                self.open(files.replay(name))
                self.js("bbsim.plots.plots.forEach((plot) => plot.build())")
                for labels in self.js("""bbsim.plots.plots.map((plot) =>
                    [...plot.canvas.querySelectorAll('.dygraph-axis-label-y')].map((label) => label.textContent))"""):
                    self.assertGreaterEqual(len(labels), 3)
                    steps = [number(label) for label in labels]
                    step = abs(steps[1] - steps[0])
                    self.near(step / 10 ** math.floor(math.log10(step) + 1e-9) % 1, 0, 1e-6)

    def test_are_those_of_the_many_where_a_few_values_are_far_beyond(self):
        rows = "".join(f"{i / 100},{i / 1000},0,{-1.7e14 if i == 80 else 0.3 + i / 1000}\n" for i in range(81))
        bbsim("replay", files.write("beyond.csv", "t,x,y,normal_force\n" + rows), "-o", files("beyond.html"))
        self.open("file://" + files("beyond.html"))
        low, high = self.js("bbsim.plots.plots.find((plot) => plot.group.title === 'Forces').graph.yAxisRange()")
        self.assertGreater(low, 0.2)
        self.assertLess(high, 0.5)
        self.assertIn("a few values are far beyond", self.browser.text("#plots"))

    def test_read_between_rows(self):
        self.open(files.replay("fig2b"))
        rows = rows_of(files("fig2b.csv"))
        self.js("bbsim.seek(arguments[0])", (rows[100]["t"] + rows[101]["t"]) / 2)
        self.browser.frame()
        self.browser.frame()
        shown = self.js("bbsim.plots.plots[0].readings[0].title").split()[0]
        self.near(float(shown), (rows[100]["x"] + rows[101]["x"]) / 2, 1e-8)


class TheProgram(InBrowser):
    """Pages that bbsim itself writes."""

    def made(self, name, *command, code=0):
        file = files(name + ".html")
        bbsim(*[word.replace("PAGE", file) for word in command], ends=(code,))
        self.open("file://" + file)

    def test_replay_of_a_scenario(self):
        self.made("own", "replay", "configs/fig2a.yaml", "-o", "PAGE")
        files.run("oriented", "fig2a", "--set", "output.columns=[t,x,y,ball_qw,ball_qx,ball_qy,ball_qz]")
        for row in rows_of(files("oriented.csv"))[::200]:
            self.seek(row["t"])
            drawn = self.js("bbsim.picture.actors[0].ball.mesh.quaternion.toArray()")
            wanted = [row[f"ball_q{part}"] for part in "xyzw"]
            # Quantized in steps of 1/32767; the sign is arbitrary.
            self.near(abs(sum(a * b for a, b in zip(drawn, wanted))), 1, 1e-4)
        self.assertNotIn("rolls straight from row to row", self.browser.text("#details"))
        self.assertIn("equation (27)", self.browser.text("#details"))

    def test_run_that_stops_says_why(self):
        self.made("stopped", "run", "configs/falls.yaml", "-o", files("stopped.h5"), "--replay", "PAGE", code=1)
        self.assertIn("the contact point left the plate", self.browser.text("#details"))
        self.made("again", "replay", files("stopped.h5"), "-o", "PAGE")
        self.assertIn("the contact point left the plate", self.browser.text("#details"))

    def test_sweep(self):
        table = files("own-sweep.csv")
        bbsim("sweep", "configs/fig2b.yaml", "--vary", "ball.radius=linear:0.01:0.02:4", "-o", table)
        self.made("own-sweep", "replay", table, "--scenario", "configs/fig2b.yaml", "-o", "PAGE")


class Time(InBrowser):
    def test_plays_at_the_speed_that_is_set(self):
        self.open(files.replay("rig"))
        for speed in [0.5, 4]:
            self.js("[bbsim.clock.seek(1), bbsim.clock.setSpeed(arguments[0])]", speed)
            (wall_a, a), (wall_b, b) = self.ask("""
                const seen = [];
                bbsim.clock.onTime((t) => seen.push([document.timeline.currentTime / 1000, t]));
                bbsim.clock.play();
                const look = setInterval(() => {
                  if (seen.length < 6 || seen[seen.length - 1][0] - seen[1][0] < 0.5) return;
                  clearInterval(look);
                  bbsim.clock.pause();
                  done([seen[1], seen[seen.length - 1]]);
                }, 100);""")
            self.assertGreater(wall_b - wall_a, 0.3)
            # Both clocks are those of the browser's frames.
            self.near((b - a) / (wall_b - wall_a), speed, 0.001 * speed)

    def test_ends_or_begins_again(self):
        self.open(files.replay("falls"))
        last = rows_of(files("falls.csv"))[-1]["t"]
        # Waits until playback ends or restarts, and returns the clock.
        play = """const from = arguments[0], began = performance.now();
            bbsim.clock.seek(from); bbsim.clock.setSpeed(1); bbsim.clock.play();
            const look = setInterval(() => {
              const {playing, now} = bbsim.clock;
              if (playing && now >= from && performance.now() - began < 30000) return;
              clearInterval(look);
              bbsim.clock.pause();
              done([playing, now]);
            }, 5);"""
        self.browser.keys("l")
        playing, now = self.ask(play, last - 0.05)
        self.assertTrue(playing)
        self.assertLess(now, last - 0.05)
        self.browser.keys("l")
        self.assertEqual(self.ask(play, last - 0.05), [False, last])

    def test_keys(self):
        self.open(files.replay("rig"))
        rows = rows_of(files("rig.csv"))
        now = lambda: self.js("bbsim.clock.now")
        right, left, home, end, shift = "\ue014", "\ue012", "\ue011", "\ue010", "\ue008"
        for keys, row in (([right] * 3, 3), ([left], 2), ([end], -1), ([home], 0)):
            self.browser.keys(*keys)
            self.assertEqual(now(), rows[row]["t"])
        self.browser.call("POST", "/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": [
            {"type": "keyDown", "value": shift}, {"type": "keyDown", "value": right}, {"type": "keyUp", "value": right},
            {"type": "keyUp", "value": shift}]}]})
        self.near(now(), 1, 1e-12)
        dialog, view = "document.getElementById('keys').open", "bbsim.picture.eyes.view"
        for key, place, value in [
            (" ", "bbsim.clock.playing", True), (" ", "bbsim.clock.playing", False), ("]", "bbsim.clock.speed", 2),
            ("]", "bbsim.clock.speed", 4), ("[", "bbsim.clock.speed", 2), ("1", view, "free"), ("2", view, "above"),
            ("3", view, "front"), ("4", view, "axis"), ("5", view, "plate"), ("?", dialog, True),
            (" ", "bbsim.clock.playing", False),  # a dialog handles its own keys
        ]:
            self.browser.keys(key)
            self.assertEqual(self.js(place), value, (key, place))
        self.js("document.getElementById('keys').close()")
        self.browser.keys("t")
        self.assertEqual(self.js("document.documentElement.dataset.theme"), "dark")
        self.browser.keys("t")

    def test_scrubber(self):
        self.open(files.replay("rig"))
        left, top, width, height = self.box("#scrub")
        y = top + height / 2
        self.browser.drag((left + 9, y), (left + width / 4, y), (left + width / 2, y))
        self.near(self.js("bbsim.clock.now"), 20, 0.3)
        self.browser.click("#back")
        before = self.js("bbsim.clock.now")
        self.browser.click("#forward")
        self.near(self.js("bbsim.clock.now") - before, 0.02, 1e-9)
        said = self.js("document.getElementById('scrub').getAttribute('aria-valuetext')")
        self.near(float(said.split()[0]), self.js("bbsim.clock.now"), 0.006)

    def test_address_keeps_time_and_view(self):
        self.open(files.replay("rig"))
        self.browser.keys("2", "e")
        self.js("bbsim.seek(12.34)")
        self.ask("setTimeout(done, 500)")
        hash_ = self.js("location.hash")
        for part in ["t=12.34", "view=above", "tilt=2"]:
            self.assertIn(part, hash_)
        self.open(files.replay("rig") + hash_)
        self.assertEqual(self.js("bbsim.clock.now"), 12.34)
        self.assertEqual(self.js("bbsim.picture.eyes.view"), "above")
        self.assertEqual(self.js("bbsim.picture.factor"), 2)
        # Turning by hand keeps the eye itself.
        left, top, *_ = self.box("#canvas")
        self.browser.drag((left + 200, top + 300), (left + 260, top + 330))
        eye = self.js("bbsim.picture.eyes.state()")
        self.ask("setTimeout(done, 500)")
        self.open(files.replay("rig") + self.js("location.hash"))
        self.all_near(self.js("bbsim.picture.eyes.state()"), eye, 1e-3)
        # Invalid values are ignored.
        self.open(files.replay("rig") + "#t=abc&view=nowhere&eye=1,2&tilt=-3&x")
        self.assertEqual(self.js("bbsim.clock.now"), 0)
        self.assertEqual(self.js("bbsim.picture.eyes.view"), "free")


class Plots(InBrowser):
    def test_click_goes_to_a_time_and_hover_reads_values(self):
        self.open(files.replay("rig"))
        rows = rows_of(files("rig.csv"))
        self.browser.click_at(*self.in_plot(10))
        t = self.js("bbsim.clock.now")
        self.near(t, 10, 0.15)
        self.assertIn(t, [row["t"] for row in rows])
        self.browser.hover(*self.in_plot(30))
        self.browser.frame()
        read = float(self.browser.text(".read-at").split()[1])
        row = min(rows, key=lambda row: abs(row["t"] - read))
        self.near(number(self.browser.text(".plot .legend li:first-child output")), row["x"] * 1e3, 0.006)
        self.assertEqual(self.browser.text(".plot h3 small").strip(), "mm")
        # The other plots show readings of the same time.
        phi = self.js("bbsim.plots.plots[1].readings[0].textContent")
        self.near(number(phi), math.degrees(row["phi"]), 0.0006)
        self.assertEqual(self.js("bbsim.clock.now"), t)

    def test_zoom_is_shared_and_undone(self):
        self.open(files.replay("rig"))
        self.browser.drag(*(self.in_plot(t) for t in (10, 15, 20)))
        ranges = self.ranges()
        self.assertGreater(len(ranges), 1)
        for its in ranges:
            self.all_near(its, [10, 20], 0.2)
        self.browser.click("#unzoom")
        for low, high in self.ranges():
            self.assertLess(low, 0.5)
            self.assertGreater(high, 39.5)

    def test_every_column_has_its_plot(self):
        self.open(files.replay("rig"))
        shown = set(self.js("bbsim.plots.plots.flatMap((p) => p.curves.map((c) => c.name))"))
        with open(files("rig.csv")) as stream:
            columns = set(stream.readline().strip().split(",")) - {"t"}
        self.assertLessEqual(columns, shown)
        self.assertIn("tracking_error", shown)
        self.assertIn("friction", shown)


class Comparison(InBrowser):
    def page(self):
        softer = files.run("softer", "fig2b", "--set", "controller.pd.kp.0.0=2", "--set", "controller.pd.kp.1.1=-2")
        lead = files.run("fig2b", "fig2b")
        rows = [f"{row['t'] + 0.001},{row['x'] - 0.002},{row['y'] + 0.003}\n" for row in rows_of(files("fig2b.csv"))[::3]]
        log = files.write("log.csv", "t,x,y\n" + "".join(rows))
        return files.page("compared", "--title", "Three", lead, softer, log)

    def test_distance_between_runs_is_that_of_their_files(self):
        self.open(self.page())
        lead, softer = rows_of(files("fig2b.csv")), rows_of(files("softer.csv"))
        apart = self.js("Array.from(bbsim.plots.plots.find((p) => p.curves[0].name === 'apart').curves[0].values)")
        self.assertEqual(len(apart), len(lead))
        for a, b, shown in zip(lead, softer, apart):
            self.near(shown, math.hypot(a["x"] - b["x"], a["y"] - b["y"]), 2e-8)  # floats of 5 cm
        log = self.js("Array.from(bbsim.plots.plots.find((p) => p.curves[0].name === 'apart').curves[1].values)")
        self.assertTrue(math.isnan(log[0]) if log[0] is not None else True)  # before the log begins
        self.near(log[600], math.hypot(0.002, 0.003), 2e-4)

    def test_ghosts_are_where_their_files_say(self):
        self.open(self.page())
        row = rows_of(files("softer.csv"))[400]
        self.seek(row["t"])
        seen = self.js("""(() => { const v = new THREE.Vector3();
            bbsim.picture.actors[1].ball.mesh.getWorldPosition(v).project(bbsim.picture.eyes.camera);
            const [l, t, w, h] = bbsim.view().canvas; return [l + (v.x + 1) / 2 * w, t + (1 - v.y) / 2 * h]; })()""")
        self.all_near(seen, on_screen(self.js("bbsim.view()"), row, 0.01), 0.05)

    def test_runs_are_switched_off(self):
        self.open(self.page())
        self.assertEqual(self.js("document.querySelectorAll('.runs li').length"), 3)
        self.browser.click("input[data-run='1']")
        self.browser.frame()
        self.assertEqual(self.js("bbsim.picture.actors.map((a) => a.ball.mesh.visible)"), [True, False, True])


class Sweeps(InBrowser):
    def test_map_lines_and_the_command_of_a_case(self):
        page, table = files.sweep("gains", "fig2b", "--vary", "controller.pd.kv.0.0=linear:0.5:3.5:7", "--vary",
                                  "controller.pd.kp.0.0=linear:0:6:5", "--set", "time.end=3")
        self.open(page)
        cases = cases_of(table)
        self.assertIn("35 cases", self.browser.text("#sweeps"))
        done = sum(case["status"] == "done" for case in cases)
        self.assertIn(f"{done} done", self.browser.text(".statuses"))
        self.js("[bbsim.sweeps[0].state.measure = 0, bbsim.sweeps[0].refresh()]")
        case = next(case for case in cases if case["case"] == "8")
        x, y = self.js("bbsim.sweeps[0].placeOf(8)")
        self.browser.click_at(x, y)
        self.assertEqual(self.browser.text(".case h3"), "Case 8")
        command = self.browser.text("#rerun")
        self.assertIn(f"controller.pd.kv.0.0={float(case['controller.pd.kv.0.0'])!r}".removesuffix(".0"), command)
        # The command repeats that case.
        words = shlex.split(command.replace("\\\n", " "))
        self.assertEqual(words[:2], ["bbsim", "run"])
        output = files("again.csv")
        words[words.index("-o") + 1] = output
        bbsim(*words[1:], "--set", "time.end=3")
        self.near(rows_of(output)[-1]["x"], float(case["end_x"]), 1e-6)
        # Keys move between cases along the axes; as in a plot, the first key is horizontal.
        self.js("document.querySelector('.drawing canvas').focus()")
        self.browser.keys("\ue014")
        self.assertEqual(self.browser.text(".case h3"), "Case 13")
        self.browser.keys("\ue013")
        self.assertEqual(self.browser.text(".case h3"), "Case 14")
        for kind in ["lines", "histogram", "map"]:
            self.browser.click(f"[data-kind={kind}]")
            self.assertEqual(self.js("bbsim.sweeps[0].state.kind"), kind)
        self.assertEqual(self.browser.console(), [])

    def test_one_key_and_drawn_ones(self):
        self.open(self_sweep())
        self.assertEqual(self.js("bbsim.sweeps[0].state.kind"), "lines")
        self.assertIn("stopped", self.browser.text(".statuses"))
        page, _ = files.sweep("drawn", "fig2b", "--vary", "ball.position.0=normal:5 cm:3 mm", "--samples", "60", "--set",
                              "time.end=2")
        self.open(page)
        self.browser.click("[data-kind=histogram]")
        self.assertIn("median", self.browser.text(".over"))

    def test_tied_keys_are_one_and_all_others_have_sliders(self):
        page, table = files.sweep("tied", "hold", "--vary", "controller.pd.kp.0.0,-controller.pd.kp.1.1=linear:0.5:1.5:3",
                                  "--vary", "controller.pd.kv.0.0,-controller.pd.kv.1.1=linear:0.4:1.2:4", "--vary",
                                  "ball.position.0=linear:0.01:0.03:2", "--set", "time.end=2")
        self.open(page)
        state = "bbsim.sweeps[0].state"
        self.assertEqual(self.js(state + ".kind"), "map")
        shown = "Array.from({length: 24}, (_, i) => bbsim.sweeps[0].placeOf(i)).map((at, i) => at ? i : -1).filter((i) => i >= 0)"
        cases = cases_of(table)
        # The two keys with the most values are the axes, as in a plot; the third one has a slider.
        self.assertEqual(self.js(f"[{state}.x, {state}.y]"), [0, 1])
        for level, place in [(0, "0.01"), (1, "0.03")]:
            self.js(f"[{state}.fixed.set('ball.position.0', {level}), bbsim.sweeps[0].refresh()]")
            self.assertEqual(self.js(shown), [i for i in range(24) if cases[i]["ball.position.0"] == place])
        self.assertIn("controller.pd.kp.0.0, controller.pd.kp.1.1", self.browser.text(".controls"))
        page, _ = files.sweep("one-tied", "hold", "--vary", "controller.pd.kp.0.0,-controller.pd.kp.1.1=linear:0.5:1.5:5",
                              "--set", "time.end=2")
        self.open(page)
        self.assertEqual(self.js(state + ".kind"), "lines")

    def test_medians_over_draws(self):
        page, table = files.sweep("draws", "fig2b", "--vary", "controller.pd.kv.0.0=linear:1:2:3", "--vary",
                                  "controller.pd.kp.0.0=list:1,2", "--vary", "ball.position.0=normal:5 cm:3 mm",
                                  "--samples", "7", "--set", "time.end=2")
        self.open(page)
        self.assertIn("the median of its 7 cases, over draws of ball.position.0", self.browser.text(".remark"))
        # The middle one of the cases in a cell is selected.
        cases = cases_of(table)
        cell = [case for case in cases if case["controller.pd.kv.0.0"] == cases[9]["controller.pd.kv.0.0"]
                and case["controller.pd.kp.0.0"] == cases[9]["controller.pd.kp.0.0"]]
        self.assertEqual(len(cell), 7)
        middle = sorted(cell, key=lambda case: float(case["rms_tracking_error"]))[3]
        x, y = self.js(f"bbsim.sweeps[0].placeOf({cell[0]['case']})")
        self.browser.click_at(x, y)
        self.assertEqual(self.browser.text(".case h3"), f"Case {middle['case']}")


class Texts(InBrowser):
    def hostile(self):
        files.run("hostile", "falls")
        with open(files("hostile.json")) as stream:
            events = json.load(stream)["events"]
        events[0]["event"] = HOSTILE
        files.change("hostile.json", status="stopped", reason=HOSTILE, title=HOSTILE, events=events)
        files.write("hostile.txt", HOSTILE)
        name = files("a'b\"c<i>d.csv")
        os.replace(files("hostile.csv"), name)
        return files.page("hostile", "--title", HOSTILE, ",".join([name, files.config("falls"), files("hostile.json"),
                                                                   files("hostile.txt")]))

    def test_hostile_ones_are_shown(self):
        self.open(self.hostile())
        title = self.browser.text("#title")
        self.assertIn("</script><script>window.broken = 1</script>", title)
        self.assertIn("␛[31m", title)
        self.assertIn("⟨U+202E⟩", title)
        self.assertIsNone(self.js("window.broken || null"))
        self.assertEqual(self.js("document.querySelectorAll('img').length"), 0)
        self.assertIn("a'b\"c<i>d.csv", self.browser.text("#subtitle"))
        self.assertIn("</script>", self.browser.text("#details"))
        self.assertEqual(self.js("document.querySelectorAll('#details i, #subtitle i').length"), 0)

    def test_what_was_run(self):
        self.open(files.replay("fig2b"))
        with open(os.path.join(SOURCE, files.config("fig2b"))) as stream:
            self.assertEqual(self.browser.text("#details pre code"), stream.read())
        details = self.browser.text("#details")
        for words in ["closed loop", "Poles about home", "rhs evaluations", "All 1051 rows"]:
            self.assertIn(words, details)
        self.assertEqual(self.js("document.querySelectorAll('.poles .pole').length"), 8)
        self.assertIn("damping", self.browser.text(".poles"))
        self.browser.click("#licences")
        self.assertIn("Permission is hereby granted", self.browser.text("dialog[open]"))
        self.js("document.querySelector('dialog[open]').close()")

    def test_a_run_that_ended_early_says_why(self):
        self.open(files.replay("falls"))
        self.assertIn("stopped at 0.54 s of 8 s", self.browser.text("#subtitle"))
        self.assertTrue(self.hidden("ended"))
        self.browser.keys("\ue010")
        self.assertFalse(self.hidden("ended"))
        self.assertIn("the contact point left the plate", self.browser.text("#ended"))
        self.open(files.replay("fig2b-literal"))
        self.assertIn("failed at", self.browser.text("#subtitle"))
        self.browser.keys("\ue010")
        self.assertIn("grows without bound", self.browser.text("#ended"))
        # Like a run ended by Ctrl-C.
        arguments = files.run("interrupted", "fig2a")
        files.change("interrupted.json", status="interrupted", reason="interrupted at t = 10 s of 99 s.")
        self.open(files.page("interrupted", arguments))
        self.assertIn("interrupted at 10 s", self.browser.text("#subtitle"))
        self.browser.keys("\ue010")
        self.assertIn("Interrupted at t = 10 s of 99 s.", self.browser.text("#ended"))
        self.assertEqual(self.browser.console(), [])

    def test_csv_is_that_of_the_page(self):
        self.open(files.replay("fig2b"))
        saved = self.js("bbsim.save.csvOf(bbsim.data.runs[0])").splitlines()
        with open(files("fig2b.csv")) as stream:
            lines = stream.read().splitlines()
        self.assertEqual(saved[0], lines[0])
        self.assertEqual(len(saved), len(lines))
        for a, b in zip(saved[1:], lines[1:]):
            a, b = [float(v) for v in a.split(",")], [float(v) for v in b.split(",")]
            self.assertEqual(a[0], b[0])
            for found, wanted in zip(a, b):
                self.near(found, wanted, 1.2e-7 * abs(wanted) + 1e-37)  # rounded to a float and to its digits
        png = self.ask("""const make = URL.createObjectURL;
            URL.createObjectURL = (blob) => { blob.arrayBuffer().then((b) => done(
                [blob.type, b.byteLength, ...new Uint8Array(b, 0, 4)])); return make.call(URL, blob); };
            document.getElementById('save-png').click();""")
        self.assertEqual(png[0], "image/png")
        self.assertGreater(png[1], 10000)
        self.assertEqual(png[2:], [0x89, 0x50, 0x4E, 0x47])

    def test_everything_has_a_name(self):
        for page in [files.replay("rig"), self_sweep(), fit_page()]:
            self.open(page)
            self.named()

    def test_sizes(self):
        files.replay("fig2b")
        self.assertLess(os.path.getsize(files("fig2b.html")), 1_200_000)


def self_sweep():
    return files.sweep("delay", "falls", "--vary", "controller.sensor.delay=linear:0:0.2:11")[0]


class Made(InBrowser):
    """Pages that bbsim itself makes, from any valid input."""

    def page_of(self, name, *arguments):
        """Makes a page of these files; expects exit code 0 or 1 and these words."""
        file = files("made-" + name + ".html")
        if not os.path.exists(file):
            bbsim("replay", *arguments, "-o", file, ends=(0, 1))
        return "file://" + file

    def show(self, name, *arguments):
        self.open(self.page_of(name, *arguments))

    def quaternion(self):
        return self.js("[bbsim.picture.draw(), ...bbsim.picture.actors[0].ball.mesh.quaternion.toArray()].slice(1)")


class Turns(Made):
    def test_of_a_ball_that_slides_are_its_own(self):
        """20 rad/s about x and -110 about y at the start, from the scene; rolling would be 34.6 about y."""
        self.show("slides", "configs/slides.yaml")
        self.js("bbsim.seek(0.02)")
        x, y, z, w = self.quaternion()
        turned = 2 * math.acos(min(1, abs(w)))
        # In 20 ms friction changes it by 6.9 m/s^2 / 0.026 m * 20 ms = 5 rad/s.
        self.near(turned, 0.02 * math.sqrt(20**2 + 110**2 + 15**2), 0.06)
        size = math.copysign(math.sqrt(1 - w * w), w)
        self.near(y / size, -110 / math.sqrt(20**2 + 110**2 + 15**2), 0.05)
        self.assertTrue(self.js("bbsim.data.runs[0].orientationGiven"))

    def test_that_nobody_knows_are_not_drawn(self):
        self.show("sl", files.result("sl", "slides", "--set", "output.columns=[t,x,y,vx,vy]"))
        self.assertFalse(self.js("bbsim.data.runs[0].turns"))
        self.js("bbsim.seek(1)")
        self.assertEqual(self.quaternion(), [0, 0, 0, 1])
        self.assertIn("How the ball turns is not known", self.browser.text("#details"))
        self.assertIn("how the ball turns is not known", self.browser.text(".scale"))
        # A log contains nothing else.
        self.show("xy", files.write("xy.csv", "t,x,y\n0,0,0\n1,0.01,0\n2,0.02,0.01\n"))
        self.assertFalse(self.js("bbsim.data.runs[0].turns"))

    def test_follow_from_columns_that_tell(self):
        """Slip, velocity and spin are enough."""
        self.show("told", files.result("told", "slides"))
        self.assertTrue(self.js("bbsim.data.runs[0].turns"))
        self.js("bbsim.seek(0.02)")
        self.near(2 * math.acos(min(1, abs(self.quaternion()[3]))), 0.02 * math.sqrt(20**2 + 110**2 + 15**2), 0.06)


class ManyRuns(Made):
    def test_seven_have_their_picture_and_are_told_apart(self):
        gains = [f"controller.pd.kp.0.0={0.5 + 0.1 * n}" for n in range(7)]
        self.show("many", *(files.result(f"many{n}", "hold", "--set", gain) for n, gain in enumerate(gains)))
        self.assertTrue(self.hidden("trouble"))
        self.assertFalse(self.hidden("picture"))
        self.assertEqual(self.js("bbsim.picture.actors.length"), 7)
        looks = self.js("bbsim.data.runs.map((run) => bbsim.palette.run(run.index) + bbsim.palette.dash(run.index))")
        self.assertEqual(len(set(looks)), 7)
        # All plots share one time range, which is stated.
        self.assertEqual(len({tuple(one) for one in self.ranges()}), 1)
        self.assertEqual(self.js("document.querySelector('.dygraph-xlabel').textContent"), "t (s)")

    def test_at_the_same_place_do_not_flicker(self):
        """Regression: the ghost of an equal run shone through the leading ball here and there."""
        self.show("equal", *(files.result(name, "rig") for name in ("equal0", "equal1")))
        for view in ["free", "above", "ball"]:
            self.js("bbsim.picture.eyes.go(arguments[0])", view)
            for t in [1.3, 7.9, 23.1]:
                self.js("bbsim.seek(arguments[0])", t)
                x, y = self.js("bbsim.ballOnScreen()")
                shots = []
                for shown in [True, False]:
                    self.js("[bbsim.data.runs[1].shown = arguments[0], bbsim.picture.draw()]", shown)
                    self.browser.frame()
                    shots.append(pixels(self.browser.picture(clip=(math.floor(x) - 6, math.floor(y) - 6, 12, 12)))[2])
                self.assertEqual(shots[0], shots[1], (view, t))

    def test_that_end_early_and_late_have_one_span(self):
        self.show("spans", "configs/falls.yaml", "configs/fig2a.yaml")
        ranges = self.ranges()
        self.assertGreater(len(ranges), 2)
        for its in ranges:
            self.all_near(its, [0, 10], 1e-3)
        self.assertEqual(self.js("document.querySelector('.dygraph-xlabel').textContent"), "t (s)")

    def test_of_units_that_nobody_tells_have_none(self):
        rows = "".join(f"{0.1 * i:.1f},{-12 + i},{3 - 0.1 * i:.1f},{i % 3},{i % 4},{i % 5},{i}\n" for i in range(20))
        self.show("cm", files.write("cm.csv", "t,x,y,phi,phi_command,torque_phi,mine\n" + rows))
        self.assertEqual(self.js("[...document.querySelectorAll('.plot h3 small')].map((e) => e.textContent)"), [])
        self.assertNotIn("mm", self.browser.text(".scale"))
        self.assertNotIn(" m", self.browser.text(".scale"))
        self.assertEqual(self.js("document.querySelector('.dygraph-xlabel').textContent"), "t")
        # Every column still has its plot, in the numbers of the file.
        shown = set(self.js("bbsim.plots.plots.flatMap((p) => p.curves.map((c) => c.name))"))
        self.assertEqual(shown, {"x", "y", "phi", "phi_command", "torque_phi", "mine"})
        self.js("bbsim.seek(0.5)")
        self.assertEqual(number(self.browser.text(".plot .legend li:first-child output")), -7)


class TheStage(Made):
    def inside(self, t):
        """Whether the ball is visible at that time, and on the drawn plate."""
        self.js("bbsim.seek(arguments[0])", t)
        x, y = self.js("bbsim.ballOnScreen()")
        left, top, width, height = self.js("bbsim.view().canvas")
        self.assertTrue(left < x < left + width and top < y < top + height, (t, x, y))
        place = self.js("bbsim.data.runs[0].placeAt(bbsim.clock.now)")
        stage = self.js("bbsim.data.scene.stage")
        self.assertLessEqual(abs(place[0]), stage["width"] / 2)
        self.assertLessEqual(abs(place[1]), stage["depth"] / 2)

    def test_holds_the_whole_path_in_view(self):
        for scene in ["hold", "hard/pulse", "hard/unstable", "fig2a", "incline"]:
            with self.subTest(scene):
                self.show(scene.replace("/", "-"), f"configs/{scene}.yaml")
                end = self.js("bbsim.data.end")
                for k in range(9):
                    self.inside(end * k / 8)
                # Its corners are visible too, at every tilt.
                for k in range(9):
                    self.seek(end * k / 8)
                    corners = self.js("""[[-1, -1], [-1, 1], [1, -1], [1, 1]].map(([x, y]) => {
                        const {width, depth} = bbsim.data.scene.stage;
                        const v = new THREE.Vector3(x * width / 2, y * depth / 2, 0).applyMatrix4(bbsim.picture.rig.plane.matrixWorld);
                        v.project(bbsim.picture.eyes.camera); return [v.x, v.y]; })""")
                    self.assertLessEqual(max(abs(c) for corner in corners for c in corner), 1, scene)

    def test_of_one_axis_is_a_beam(self):
        self.show("beam", "configs/beam.yaml")
        stage = self.js("bbsim.data.scene.stage")
        self.assertLess(stage["depth"], stage["width"] / 3)

    def test_of_a_beam_has_a_frame_without_cracks(self):
        """Regression: a corner of a long frame was open. Rays from above meet the frame all around."""
        self.show("beam", "configs/beam.yaml")
        missed = self.js("""(() => { const {rig} = bbsim.picture, {stage} = bbsim.data.scene, missed = [];
            bbsim.picture.draw();
            rig.ring.updateMatrixWorld(true);
            const frame = rig.ring.children.find((one) => one.isGroup && one !== rig.cross), bar = 0.03 * rig.size, gap = 0.025 * rig.size;
            const x = (stage.width + bar) / 2 + gap, y = (stage.depth + bar) / 2 + gap;
            for (let i = 0; i < 400; ++i) {
              const along = i / 400 * 4, side = Math.floor(along), part = 2 * (along - side) - 1;
              const at = [[part * x, -y], [x, part * y], [-part * x, y], [-x, -part * y]][side];
              const from = new THREE.Vector3(...at, 1).applyMatrix4(rig.ring.matrixWorld), to = new THREE.Vector3(...at, 0).applyMatrix4(rig.ring.matrixWorld);
              if (new THREE.Raycaster(from, to.sub(from).normalize()).intersectObject(frame, true).length === 0) missed.push(at);
            }
            return missed; })()""")
        self.assertEqual(missed, [])

    def test_a_ball_too_small_to_be_seen_has_a_marker_of_constant_size(self):
        sizes = {}
        for scene, folder in [("fig2a", "configs"), ("small-ball", "tests/data/scenarios"), ("rig", "configs")]:
            self.show(scene, f"{folder}/{scene}.yaml")
            self.js("bbsim.picture.draw()")
            marker = "bbsim.picture.actors[0].marker"
            sizes[scene] = self.js(f"""(() => {{ if (!{marker}.visible) return 0;
                const on = (x) => {{ const v = new THREE.Vector3(x, 0, 0).applyMatrix4({marker}.matrixWorld).project(bbsim.picture.eyes.camera);
                  return v.x * bbsim.view().canvas[2] / 2; }};
                return on(9) - on(-9); }})()""")
        self.assertEqual(sizes["rig"], 0)
        self.near(sizes["fig2a"], 18, 0.5)
        self.near(sizes["small-ball"], 18, 0.5)

    def test_the_view_of_the_ball_goes_with_it(self):
        self.show("small-ball", "tests/data/scenarios/small-ball.yaml")
        self.browser.keys("6")
        for t in [0, 3.3, 10]:
            self.seek(t)
            left, top, width, height = self.js("bbsim.view().canvas")
            self.all_near(self.js("bbsim.ballOnScreen()"), [left + width / 2, top + height / 2], 1)
            # A sixth of half the picture's height.
            radius = self.js("""(() => { const {ball} = bbsim.picture.actors[0], {camera} = bbsim.picture.eyes;
                const p = ball.mesh.getWorldPosition(new THREE.Vector3()), q = p.clone().project(camera);
                const up = new THREE.Vector3().setFromMatrixColumn(camera.matrixWorld, 1).multiplyScalar(1e-5 / bbsim.picture.rig.size);
                return (p.add(up).project(camera).y - q.y) * bbsim.view().canvas[3] / 2; })()""")
            self.near(radius, height / 12, 1)
            self.assertFalse(self.js("bbsim.picture.actors[0].marker.visible"))

    def test_what_is_ahead_is_seen(self):
        """The dashes of the future path need the contrast of a line of text against the plate."""
        self.show("fig2a", "configs/fig2a.yaml")
        apart = self.js("""(() => { const c = bbsim.picture.actors[0].future.material.color, p = new THREE.Color(bbsim.palette.now().plate);
            const light = (k) => { const f = (v) => (v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
              return 0.2126 * f(k.r) + 0.7152 * f(k.g) + 0.0722 * f(k.b) + 0.05; };
            return Math.max(light(c), light(p)) / Math.min(light(c), light(p)); })()""")
        self.assertGreater(apart, 2)

    def test_infinite_values_are_said(self):
        self.show("overflow", "configs/hard/overflow.yaml")
        self.assertEqual(self.browser.console(), [])
        self.js("bbsim.seek(50000)")
        self.assertFalse(self.hidden("missing"))
        self.assertIn("it is not drawn", self.browser.text("#missing"))
        self.assertIn("∞", self.browser.text(".plot .legend li:first-child output"))
        self.assertNotIn("e154", self.browser.text(".scale"))
        self.assertIn("there it is not drawn", self.browser.text("#details"))
        self.assertTrue(all(math.isfinite(v) for v in self.js("bbsim.view().view")))
        self.js("bbsim.seek(0)")
        self.assertTrue(self.hidden("missing"))


class Missing(Made):
    def test_angles_are_said_to_be_missing(self):
        rows = "".join(f"{i},0.0{i},0,{',' if 3 <= i <= 7 else '0.02,0.03'}\n" for i in range(11))
        self.show("gaps", files.write("gaps.csv", "t,x,y,phi,theta\n" + rows))
        self.assertTrue(self.hidden("missing"))
        self.assertIn("°", self.browser.text("#level-tilt"))
        self.js("bbsim.seek(5)")
        self.assertIn("tilt is not recorded", self.browser.text("#missing"))
        self.assertFalse(self.hidden("missing"))
        self.assertNotIn("°", self.browser.text("#level-tilt"))
        self.assertEqual(self.js("document.getElementById('level-bubble').getAttribute('visibility')"), "hidden")
        self.js("bbsim.seek(9)")
        self.assertEqual(self.browser.text("#level-tilt"), "2.066°")
        # No orientation at all: a log of positions.
        self.show("places", files.write("places.csv", "t,x,y\n0,0,0\n1,0.1,0.1\n"))
        self.assertIn("No tilt was recorded", self.browser.text("#missing"))


class TheEnd(Made):
    def test_is_where_the_event_was(self):
        for name, file in [("falls", "configs/falls.yaml"), ("falls-csv", files.result("end", "falls"))]:
            with self.subTest(name):
                self.show(name, file)
                self.browser.keys("\ue010")  # End
                place = self.js("bbsim.data.runs[0].placeAt(bbsim.clock.now)")
                self.near(place[0], 0.16, 1e-8)
                time = "0.542322"
                self.assertIn(f"stopped at {time} s of 8 s", self.browser.text("#subtitle"))
                self.assertIn(f"at t = {time} s of 8 s", self.browser.text("#ended"))
                self.assertIn(f"{time} / {time} s", self.browser.text("#time"))
                row = {"x": 0.16, "y": -0.020345410307771216, "phi": -0.2396367700421219, "theta": -0.07284538574323257}
                self.ball_is_at(row, 0.02, 0.1)
                self.assertIn("All 28 rows are in this page", self.browser.text("#details"))

    def test_of_a_run_without_a_second_row_has_its_time(self):
        self.show("creep", "configs/hard/creep.yaml")
        _, _, place = self.browser.text("#subtitle").partition("failed at ")
        shown = place.removesuffix(" s of 13 s")
        # The summary has the time at which the integrator gave up; the page shows six digits.
        files.result("creep", "hard/creep")
        with open(files("creep.json")) as summary:
            end = json.load(summary)["end_time"]
        self.assertLess(0, end)
        self.assertEqual(float(f"{end:.6g}"), number(shown))
        self.assertIn(f"{shown} / {shown} s", self.browser.text("#time"))


class WithoutColour(Made):
    def test_no_two_curves_of_a_plot_are_alike(self):
        for scene in ["rig", "slides", "torque-lqr", "three-servos", "hold", "fig2b"]:
            self.show(scene, f"configs/{scene}.yaml")
            plots = self.js("""bbsim.plots.plots.map((p) => p.curves.map((c) =>
                JSON.stringify([c.pattern, c.dots, c.width > 3, (c.width || 1.8) < 1.5])))""")
            for looks in plots:
                self.assertEqual(len(set(looks)), len(looks), (scene, looks))


class Links(Made):
    def test_nonsense_in_an_address_throws_nothing(self):
        page = self.page_of("rig", "configs/rig.yaml")
        self.open(page + "#t=%&view=above&zoom=%E0%A4&x=%")
        self.assertEqual(self.js("bbsim.picture.eyes.view"), "above")
        self.browser.keys("\ue014")
        self.near(self.js("bbsim.clock.now"), 0.02, 1e-12)
        self.assertEqual(self.browser.console(), [])

    def test_zoom_is_kept_and_follows_the_time(self):
        page = self.page_of("rig", "configs/rig.yaml")
        self.open(page)
        self.js("bbsim.plots.zoom([10, 14])")
        self.js("bbsim.seek(12)")
        self.wait("location.hash.includes('zoom=10,14')")
        self.assertIn("zoom=10,14", self.js("location.hash"))
        self.open(page + "#t=12&zoom=10,14")
        self.assertEqual(self.ranges()[0], [10, 14])
        for t in (14.5, 3):
            self.js("bbsim.seek(arguments[0])", t)
            low, high = self.ranges()[0]
            self.assertTrue(low <= t <= high)
            self.near(high - low, 4, 1e-9)


class Hands(Made):
    def wheel(self, x, y, modifiers=0):
        self.browser.devtools("Input.dispatchMouseEvent", {"type": "mouseWheel", "x": x, "y": y, "deltaX": 0, "deltaY": 120,
                                                           "modifiers": modifiers})
        self.browser.frame()

    def test_a_wheel_scrolls_the_page_until_the_view_is_clicked(self):
        self.open(self.page_of("rig", "configs/rig.yaml"))
        left, top, *_ = self.box("#canvas")
        x, y = left + 200, top + 300
        distance = "Math.hypot(...bbsim.picture.eyes.state().slice(0, 3))"
        before = self.js(distance)
        self.wheel(x, y)
        self.assertTrue(self.wait("window.scrollY > 0"))
        self.assertEqual(self.js(distance), before)
        self.assertFalse(self.hidden("hint"))
        self.wheel(x, y, modifiers=2)  # Ctrl
        zoomed = self.js(distance)
        self.assertGreater(zoomed, before)
        self.js("window.scrollTo(0, 0)")
        self.browser.click_at(x, y)
        self.wheel(x, y)
        self.assertGreater(self.js(distance), zoomed)
        self.assertEqual(self.js("window.scrollY"), 0)

    def test_a_finger_scrolls_the_page_until_the_view_is_tapped(self):
        self.open(self.page_of("rig", "configs/rig.yaml"))
        left, top, *_ = self.box("#canvas")
        x, y = left + 200, top + 300
        touch = lambda kind, *points: self.browser.devtools("Input.dispatchTouchEvent", {
            "type": kind, "touchPoints": [{"x": px, "y": py} for px, py in points]})
        eye = lambda: self.js("bbsim.picture.eyes.state()")
        action = "getComputedStyle(document.getElementById('canvas')).touchAction"
        before = eye()
        touch("touchStart", (x, y))
        touch("touchMove", (x + 40, y))
        touch("touchEnd")
        self.browser.frame()
        self.assertEqual(eye(), before)
        self.assertEqual(self.js(action), "pan-y")
        touch("touchStart", (x, y))
        touch("touchEnd")
        self.assertTrue(self.wait("document.activeElement.id === 'canvas'"))
        self.assertEqual(self.js(action), "none")
        touch("touchStart", (x, y))
        touch("touchMove", (x + 20, y))
        touch("touchMove", (x + 60, y))
        touch("touchEnd")
        self.browser.frame()
        self.assertNotEqual(eye(), before)


class Words(Made):
    def test_of_events_are_not_printed_over_each_other(self):
        self.show("slides", "configs/slides.yaml")
        self.assertEqual(self.js("""(() => { const wanted = Array.from({length: 6}, (_, i) => ({x: 3 * i, y: 0, width: 40, height: 12}));
            const up = bbsim.placeLabels(wanted);
            const boxes = wanted.map((w, i) => up[i] === null ? null : [w.x - 20, -up[i] - 6, w.x + 20, -up[i] + 6]).filter(Boolean);
            return [boxes.length > 1, boxes.some((a, i) => boxes.some((b, k) => i < k && a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]))]; })()"""),
            [True, False])

    def test_of_marks_are_above_their_rims(self):
        """Regression: rims drawn later than what they surround used to hide it."""
        self.show("slides", "configs/slides.yaml")
        orders = self.js("bbsim.picture.rig.plane.children.flatMap((group) => group.children).filter((mark) => mark.children.length === 2)"
                         ".map((mark) => mark.children.map((part) => part.renderOrder))")
        marks = [order for order in orders if order[0] != order[1]]
        self.assertGreaterEqual(len(marks), 3)
        for rim, inner in marks:
            self.assertGreater(inner, rim)

    def test_of_motors_are_a_table_with_units(self):
        self.show("rig", "configs/rig.yaml")
        table = self.browser.text(".motors")
        for word in ["torque φ", "N·m", "power", "mW", "s"]:
            self.assertIn(word, table)


class Pace(Made):
    def test_slow_pictures_have_fewer_pixels_and_then_are_flat(self):
        self.show("rig", "configs/rig.yaml")
        # Draws as many pictures as are examined, each after this time; the page's own frames are stopped.
        self.js("[window.fake = 0, performance.now = () => window.fake, window.requestAnimationFrame = () => 0, bbsim.clock.play()]")
        frames = "Array.from({length: arguments[0]}, () => [window.fake += arguments[1], bbsim.seek(bbsim.clock.now + 1e-3)]).length"
        self.js(frames, 30, 20)
        ratio = "bbsim.picture.renderer.getPixelRatio()"
        self.assertEqual(self.js(ratio), 1)
        self.js(frames, 8, 60)
        self.assertEqual(self.js(ratio), 0.5)
        self.assertFalse(self.js("bbsim.screen.isFlat"))
        self.js("bbsim.clock.pause()")
        self.assertEqual(self.js(ratio), 1)  # a still picture has full resolution
        self.js("bbsim.clock.play()")
        self.js(frames, 8, 120)
        self.assertTrue(self.js("bbsim.screen.isFlat"))
        self.assertFalse(self.hidden("flat"))
        self.assertTrue(self.hidden("picture"))
        self.assertIn("pictures a second", self.browser.text("#hint"))
        # A user who chooses three dimensions keeps them.
        self.browser.click("[data-view=above]")
        self.assertFalse(self.js("bbsim.screen.isFlat"))
        self.js(frames, 30, 120)
        self.assertFalse(self.js("bbsim.screen.isFlat"))

    def test_what_has_not_changed_is_not_drawn_again(self):
        self.show("rest", "configs/hard/rest.yaml")
        draws = lambda: self.js("bbsim.picture.draws")
        self.js("bbsim.seek(1e5)")
        self.browser.frame()
        before = draws()
        for t in [2e5, 3.3e5, 7e5]:
            self.js("bbsim.seek(arguments[0])", t)
            self.browser.frame()
        self.assertEqual(draws(), before)
        self.js("bbsim.picture.eyes.turn(0.1, 0)")
        self.browser.frame()
        self.assertEqual(draws(), before + 1)

    def test_numbers_of_plots_are_written_only_where_they_change(self):
        self.show("rest", "configs/hard/rest.yaml")
        self.js("""[window.written = 0, new MutationObserver((seen) => { window.written += seen.length; }).observe(
            document.getElementById('plots'), {subtree: true, childList: true, characterData: true})]""")
        for t in [1e5, 2e5, 3e5]:
            self.js("bbsim.seek(arguments[0])", t)
            self.browser.frame()
        self.assertEqual(self.js("window.written"), 0)


class Flat(Made):
    def test_shows_the_ball_where_the_rows_say(self):
        self.show("rig", "configs/rig.yaml")
        self.browser.keys("7")
        self.assertTrue(self.js("bbsim.screen.isFlat"))
        left, top, width, height = self.box("#flat-canvas")
        scale = None
        for t in [0, 7.3, 24]:
            self.js("bbsim.seek(arguments[0])", t)
            x, y = self.js("bbsim.ballOnScreen()")
            px, py = self.js("bbsim.data.runs[0].placeAt(bbsim.clock.now)")
            dx, dy = x - left - width / 2, y - top - height / 2
            scale = scale or math.hypot(dx, dy) / math.hypot(px, py)
            self.all_near([dx, dy], [scale * px, -scale * py], 0.05)
        # The ball is drawn there, and nowhere else: in the colour of its run.
        self.js("[bbsim.screen.show('trail', false), bbsim.screen.show('arrows', false)]")
        self.browser.frame()
        drawn = self.js("""(() => { const canvas = document.getElementById('flat-canvas'), box = canvas.getBoundingClientRect();
            const {data, width} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
            let count = 0, x = 0, y = 0;
            for (let i = 0; i < data.length; i += 4) {
              if (data[i] < 1.5 * data[i + 2] || data[i] < 60) continue;
              ++count; x += i / 4 % width; y += Math.floor(i / 4 / width);
            }
            return [box.left + x / count / width * box.width, box.top + y / count / canvas.height * box.height, count]; })()""")
        self.assertGreater(drawn[2], 500)
        self.all_near(drawn[:2], [x, y], 3)
        self.assertIn("view=flat", self.wait("location.hash.includes('view=flat') && location.hash"))
        self.browser.keys("1")
        self.assertFalse(self.js("bbsim.screen.isFlat"))


class Paper(Made):
    def pages(self):
        pdf = base64.b64decode(self.browser.devtools("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69})["data"])
        return len(re.findall(rb"/Type\s*/Page[^s]", pdf))

    def test_has_the_whole_scenario_all_plots_and_a_round_ball(self):
        for scene in ["rig", "falls", "fig2a", "slides", "torque-lqr", "three-servos", "pushrod", "hard/overflow"]:
            with self.subTest(scene):
                self.show(scene.replace("/", "-"), f"configs/{scene}.yaml")
                self.assertLessEqual(self.pages(), 4)
                # No card is left out or cut off.
                self.js("bbsim.print.begin()")
                cards = self.js("""[...document.querySelectorAll('#details .card')].map((card) => [card.querySelector('h3').textContent,
                    card.getBoundingClientRect().height > 0 && [...card.querySelectorAll('pre')].every((text) => text.scrollHeight <= text.clientHeight + 1)])""")
                self.assertEqual([name for name, whole in cards if not whole], [])
                with open(os.path.join(SOURCE, f"configs/{scene}.yaml")) as text:
                    self.assertEqual(self.browser.text("#details .card.text code").split(), text.read().split())
        self.show("rig", "configs/rig.yaml")
        on_screen = self.js("bbsim.plots.plots.map(({canvas}) => [canvas.clientWidth, canvas.clientHeight])")
        self.js("bbsim.print.begin()")
        drawn = self.js("""bbsim.plots.plots.map(({canvas}) => { const c = canvas.querySelector('canvas.printed');
            const bytes = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let inked = 0;
            for (let i = 3; i < bytes.length; i += 4) inked += bytes[i] > 0; return inked / (bytes.length / 4); })""")
        self.assertGreater(len(drawn), 4)
        self.assertGreater(min(drawn), 0.005)
        # The printed aspect ratio is the drawn one.
        width, height, shown_width, shown_height = self.js("""(() => { const c = document.querySelector('#screen > canvas.printed'),
            b = c.getBoundingClientRect(); return [c.width, c.height, b.width, b.height]; })()""")
        self.near(width / height, shown_width / shown_height, 0.01)
        self.js("bbsim.print.end()")
        self.assertEqual(self.js("document.querySelectorAll('canvas.printed').length"), 0)
        self.assertEqual(self.js("document.documentElement.className"), "")
        self.assertEqual(self.js("bbsim.plots.plots.map(({canvas}) => [canvas.clientWidth, canvas.clientHeight])"), on_screen)
        # Print preview gives the same.
        self.browser.devtools("Emulation.setEmulatedMedia", {"media": "print"})
        self.assertTrue(self.wait("document.querySelectorAll('canvas.printed').length > 5"))
        self.browser.devtools("Emulation.setEmulatedMedia", {"media": "", "features": [
            {"name": "prefers-color-scheme", "value": "light"}, {"name": "prefers-reduced-motion", "value": "reduce"}]})
        self.assertTrue(self.wait("document.querySelectorAll('canvas.printed').length === 0"))
        # The picture on the screen is unchanged.
        left, top, width, height = self.js("bbsim.view().canvas")
        self.near(self.js("bbsim.picture.eyes.camera.aspect"), width / height, 0.01)


class SweepPages(Made):
    def sweep_page(self, name, text):
        self.show(name, files.write(name + ".csv", text))

    def test_say_how_many_cases_they_show(self):
        rows = "".join(f"{i},{i // 300},{i % 300},done,1,{(i % 7) / 7}\n" for i in range(90000))
        self.sweep_page("thinned", "case,a,b,status,end_time,max_tilt\n" + rows)
        self.assertIn("22,500 of 90,000 shown", self.browser.text("#sweeps"))
        # As in a plot, the first of two keys is horizontal; the page says what the colors show.
        self.assertEqual(self.js("[bbsim.sweeps[0].state.x, bbsim.sweeps[0].state.y]"), [0, 1])
        self.assertEqual(self.js("[...document.querySelectorAll('.over .name')].map((e) => e.textContent)").count("max tilt, °"), 1)

    def test_with_one_case_that_is_done_show_it(self):
        self.sweep_page("one-done", "case,a,status,end_time,max_distance\n0,1,failed,0.1,9\n1,2,done,1,0.02\n2,3,failed,0.1,9\n")
        self.assertEqual(self.browser.text(".case h3"), "Case 1")
        ticks = [number(text) for text in self.js("[...document.querySelectorAll('.over text[text-anchor=end]')].map((e) => e.textContent)")]
        self.assertTrue(0 < min(ticks) and max(ticks) < 0.05, ticks)  # an axis about 0.02, not from -1 to 1


class LongRuns(InBrowser):
    def test_a_million_rows(self):
        page = files.page("long", files.run("long", "fig2b", "--set", "time.step=2.1e-5"))
        self.assertLess(os.path.getsize(files("long.html")), 5_000_000)
        self.open(page)
        self.assertEqual(self.js("bbsim.data.runs[0].rows"), 1_000_001)
        self.assertIn("Of 1000001 rows", self.browser.text("#details"))
        # Between kept rows too, the ball is within half a pixel of the file's place.
        rows = rows_of(files("long.csv"))
        for index in [123_456, 500_000, 876_543]:
            row = rows[index]
            self.js("bbsim.seek(arguments[0])", row["t"])
            self.ball_is_at(row, 0.01, 0.5)


class Legs(InBrowser):
    def test_end_where_the_joints_are(self):
        """Rods and horns have their lengths, horns the servos' angles, and joints their places in the plate."""
        files.run("three-servos", "three-servos")
        rows = rows_of(files("three-servos.csv"))
        self.open(files.replay("three-servos"))
        base, plate, horn, rod, height = 0.06, 0.09, 0.04, 0.1, 0.11
        far = math.hypot(plate - base, height)
        home = math.atan2(height, plate - base) - math.acos((far ** 2 + horn ** 2 - rod ** 2) / (2 * horn * far))
        for row in rows[100::200]:
            self.seek(row["t"])
            legs = self.js("bbsim.picture.rig.legs.points().map((leg) => [leg.axis, leg.knee, leg.joint])")
            self.assertEqual(len(legs), 3)
            names = ["servo_phi", "servo_theta", "servo_third"]
            for i, (axis, knee, joint) in enumerate(legs):
                self.near(math.dist(axis, knee), horn, 1e-7)
                self.near(math.dist(knee, joint), rod, 1e-7)
                out = math.hypot(knee[0], knee[1]) - base
                self.near(math.atan2(knee[2] - axis[2], out), home + row[names[i]], 1e-4)
                self.near(math.dist(joint, legs[(i + 1) % 3][2]), math.sqrt(3) * plate, 1e-7)
            # The plane through the joints has the plate's normal.
            a, b, c = (leg[2] for leg in legs)
            u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
            normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            size = math.hypot(*normal)
            self.near(normal[0] / size, math.sin(row["phi"]) * math.cos(row["theta"]), 1e-5)
            self.near(normal[1] / size, -math.sin(row["theta"]), 1e-5)
            # The meshes' ends are at the computed places.
            ends = self.js("bbsim.picture.rig.legs.group.children.filter((mesh) => mesh.geometry.type.startsWith('Sphere'))"
                           ".map((mesh) => mesh.position.toArray())")
            for end, (_, _, joint) in zip(ends, legs):
                self.near(math.dist(end, joint), 0, 1e-9)


class PushRods(InBrowser):
    def test_lead_from_horns_to_the_plate(self):
        """Bars keep their lengths, the plate carries the joints, and horns have the servos' angles but for backlash."""
        files.run("pushrod", "pushrod")
        rows = rows_of(files("pushrod.csv"))
        self.open(files.replay("pushrod"))
        horn, arm, offset, backlash = 0.024, 0.06, (-0.016, 0.07), math.radians(0.3)
        rod = math.hypot(offset[0] + arm - horn, offset[1])
        moved = []
        for row in rows[:60:4] + rows[100::150]:
            self.seek(row["t"])
            for axis, name in enumerate(["phi", "theta"]):
                ends = self.js(f"bbsim.picture.rig.rods[{axis}].places()")
                self.near(math.dist(ends["axis"], ends["knee"]), horn, 1e-9)
                self.near(math.dist(ends["knee"], ends["joint"]), rod, 1e-9)
                self.near(ends["horn"], row["servo_" + name], backlash / 2 + 1e-4)
                # The joint goes with the plate: its place in the frame that the axis turns is always the same.
                fixed = self.js("""((joint, axis) => { const {rig} = bbsim.picture, base = [rig.base, rig.cross][axis], turned = [rig.ring, rig.hinge][axis];
                    return new THREE.Vector3(...joint).applyMatrix4(base.matrixWorld).applyMatrix4(new THREE.Matrix4().getInverse(turned.matrixWorld)).toArray(); })
                    (arguments[0], arguments[1])""", ends["joint"], axis)
                self.near(fixed[axis], [-arm, arm][axis], 1e-6)
                self.near(fixed[2], 0, 1e-6)
                moved.append(ends["horn"])
            # The drawn bars end there.
            for axis in range(2):
                drawn = self.js(f"""(() => {{ const {{group, places}} = bbsim.picture.rig.rods[{axis}], {{knee, joint}} = places(), middle = knee.map((v, i) => (v + joint[i]) / 2);
                    return group.children.filter((bar) => bar.position.distanceTo(new THREE.Vector3(...middle)) < 1e-9).map((bar) => bar.scale.y); }})()""")
                self.assertEqual(len(drawn), 1)
                self.near(drawn[0], rod, 1e-6)
        self.assertGreater(max(moved) - min(moved), 0.05)


def fit_page():
    """The page of a fit of two logs: a rig with a hollow ball, with a third of the windows held out."""
    page = files("fit.html")
    if not os.path.exists(page):
        logs = []
        for which in [1, 2]:
            bbsim("run", "configs/recorded.yaml", "--set", "ball.inertia_factor=0.6", "--set",
                  f"ball.position=[{which} cm, 0]", "--set", "output.columns=[t,x,y]", "-o", files("fit-run.csv"))
            text = "t,x,y\n"
            # An error like a sensor's, and rows without x.
            for i, row in enumerate(rows_of(files("fit-run.csv"))):
                x = "" if i % 50 == 7 else row["x"] + 5e-4 * math.sin(7.3 * i * i)
                text += f"{row['t']},{x},{row['y'] + 5e-4 * math.cos(5.9 * i * i)}\n"
            logs.append(files.write(f"fit-log-{which}.csv", text))
        bbsim("fit", "configs/recorded.yaml", *logs, "--free", "ball.inertia_factor", "--free",
              "gimbal.motion.phi.table.offset", "--window", "1 s", "--hold-out", "0.34", "--report", page,
              "--json", files("fit.json"))
    return "file://" + page


class AFit(InBrowser):
    def test_has_the_numbers_of_the_fit_in_its_tables(self):
        self.open(fit_page())
        with open(files("fit.json")) as stream:
            parameters = json.load(stream)["parameters"]
        rows = self.js("""[...document.querySelectorAll('#parameters tbody tr')].map((row) =>
            [...row.children].map((cell) => cell.textContent))""")
        self.assertEqual([row[0] for row in rows], [one["key"] for one in parameters])
        for row, one in zip(rows, parameters):
            self.near(number(row[2]), one["estimate"], 0.1 * one["sd"])
        self.assertIn("held out", self.browser.text("#residuals"))
        self.assertIn("2 logs", self.browser.text("#compared"))

    def test_draws_log_and_model(self):
        self.open(fit_page())
        self.js("bbsim.plots.plots.forEach((plot) => plot.build())")
        self.assertEqual(self.js("bbsim.plots.plots.map((plot) => plot.group.title)"),
                         ["x", "x: model minus log", "y", "y: model minus log"])
        row = rows_of(files("fit-log-1.csv"))[123]
        self.js("bbsim.seek(arguments[0])", row["t"])
        read = self.js("bbsim.plots.plots.map((plot) => plot.readings.map((one) => one.textContent))")
        numbers = [[number(words) for words in plot] for plot in read]
        # In mm, with four digits of the largest number.
        self.near(numbers[0][0], 1e3 * row["x"], 0.06)
        self.near(numbers[2][0], 1e3 * row["y"], 0.06)
        modelled = self.js("bbsim.data.runs[0].values('x_modelled')[bbsim.data.runs[0].nearest(arguments[0])]", row["t"])
        self.near(numbers[0][1], 1e3 * modelled, 0.06)
        self.near(numbers[1][0], 1e3 * (modelled - row["x"]), 0.006)
        # Each plot's canvas contains its curves' colors.
        for index, colours in enumerate([["x", "run"], ["reference"], ["x", "run"], ["reference"]]):
            for colour in colours:
                painted = self.js("""(() => {
                    const hex = arguments[1] === 'run' ? bbsim.palette.run(0) : bbsim.palette.now()[arguments[1]];
                    const wanted = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
                    let count = 0;
                    for (const canvas of bbsim.plots.plots[arguments[0]].canvas.querySelectorAll('canvas')) {
                      const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
                      for (let i = 0; i < data.length; i += 4) {
                        if (data[i + 3] > 60 && wanted.every((part, k) => Math.abs(data[i + k] - part) < 40)) ++count;
                      }
                    }
                    return count; })()""", index, colour)
                self.assertGreater(painted, 100, (index, colour))

    def test_zoom_is_shared(self):
        self.open(fit_page())
        self.js("bbsim.plots.plots.forEach((plot) => plot.build())")
        self.browser.drag(*(self.in_plot(t) for t in (1, 1.5, 2)))
        self.assertEqual(len(self.ranges()), 4)
        for its in self.ranges():
            self.all_near(its, [1, 2], 0.05)

    def test_moves_the_two_balls(self):
        self.open(fit_page())
        places = lambda: self.js("""['measured', 'model'].map((name) => {
            const ball = document.querySelector(`[data-ball=${name}]`);
            return [ball.getAttribute('transform'), ball.getAttribute('visibility')]; })""")
        begin = places()
        self.assertEqual([is_shown for _, is_shown in begin], ["visible", "visible"])
        self.js("document.getElementById('scrub').focus()")
        self.browser.keys(*["\ue014"] * 40)
        rows = rows_of(files("fit-log-1.csv"))
        self.near(self.js("bbsim.clock.now"), rows[40]["t"], 1e-12)
        for before, after in zip(begin, places()):
            self.assertNotEqual(before, after)
        # The balls' distance agrees with the numbers.
        far = self.js("""(() => { const [run] = bbsim.data.runs, row = run.nearest(bbsim.clock.now);
            return Math.hypot(run.values('x_residual')[row], run.values('y_residual')[row]); })()""")
        self.assertIn(f"{1e3 * far:.2f} mm apart", self.browser.text("#plan"))
        # A row without x has no ball of the log.
        self.js("bbsim.seek(arguments[0])", rows[57]["t"])
        self.assertEqual([is_shown for _, is_shown in places()], ["hidden", "visible"])

    def test_the_pointer_in_a_plot_moves_them_too(self):
        self.open(fit_page())
        self.browser.hover(*self.in_plot(3.2))
        self.browser.frame()
        self.assertIn("t = 3.2", self.browser.text("#plan"))
        self.assertEqual(self.js("bbsim.clock.now"), 0)

    def test_shows_the_log_that_is_chosen(self):
        self.open(fit_page())
        self.assertFalse(self.hidden("choice"))
        self.js("""(() => { const log = document.getElementById('log');
            log.value = '1'; log.dispatchEvent(new Event('change')); })()""")
        self.browser.frame()
        self.assertEqual(self.js("document.querySelectorAll('.plot').length"), 4)
        first = rows_of(files("fit-log-2.csv"))[0]
        self.near(self.js("bbsim.data.runs[0].values('x')[0]"), first["x"], 1e-8)
        self.js("bbsim.seek(1)")
        self.assertIn("1.00", self.browser.text("#time"))
        self.assertEqual(self.browser.console(), [])

    def test_on_paper_are_all_plots(self):
        self.open(fit_page())
        self.js("bbsim.print.begin()")
        self.assertEqual(self.js("document.querySelectorAll('.plot canvas.printed').length"), 4)
        self.assertLessEqual(self.js("document.documentElement.scrollHeight"), 2 * 970)
        self.js("bbsim.print.end()")
        self.assertEqual(self.js("document.querySelectorAll('canvas.printed').length"), 0)


class FirstPicture(InBrowser):
    def test_is_drawn(self):
        """Prints a time in milliseconds since the request; no bound, because it would depend on the machine."""
        self.open(files.replay("rig"))
        first = self.js("bbsim.firstPicture")
        print(f"first picture after {first:.0f} ms", file=sys.stderr)
        self.assertGreater(first, 0)
        self.assertLess(first, self.js("performance.now()"))


class Phone(InBrowser):
    options = {"width": 400, "height": 800, "phone": True}

    def test_fits(self):
        for page in [files.replay("fig2a"), files.replay("rig"), self_sweep(), fit_page()]:
            self.open(page)
            self.assertLessEqual(self.js("document.documentElement.scrollWidth"), 400)


class Motion(InBrowser):
    options = {"still": False}

    def test_views_glide_and_arrive(self):
        self.open(files.replay("rig"))
        self.js("bbsim.picture.eyes.go('above')")
        arrived = self.ask("""const began = performance.now();
            const look = () => { const eye = bbsim.picture.eyes.state();
              if (Math.hypot(eye[0], eye[1]) < 1e-2 * eye[2] || performance.now() - began > 20000) done(eye);
              else requestAnimationFrame(look); };
            look();""")
        self.assertLess(math.hypot(arrived[0], arrived[1]), 1e-2 * arrived[2])
        self.assertEqual(self.browser.console(), [])


class WithoutWebGL(InBrowser):
    options = {"flags": ("--disable-3d-apis",)}

    def test_the_rest_is_there(self):
        self.browser.call("POST", "/url", {"url": "about:blank"})
        self.browser.open(files.replay("rig"))
        self.assertIn("WebGL", self.browser.text("#trouble"))
        self.assertTrue(self.hidden("picture"))
        self.assertGreater(self.js("bbsim.plots.plots.length"), 3)
        self.browser.keys("\ue014")
        self.near(self.js("bbsim.clock.now"), 0.02, 1e-12)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[5:]])
