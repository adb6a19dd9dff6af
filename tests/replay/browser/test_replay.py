# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""Replays in a real browser: what is drawn is what the files say, and what is pressed does what it says."""

import base64
import json
import math
import os
import re
import shlex
import sys
import unittest

from in_browser import InBrowser, bbsim, cases_of, content_of, files, rows_of

HOSTILE = "</script><script>window.broken = 1</script><img src=x onerror='window.broken = 2'> \"q\" 'q' \x1b[31m \u2028 \u202e &lt;"
RIGHT, LEFT, UP, HOME, END, SHIFT = "\ue014", "\ue012", "\ue013", "\ue011", "\ue010", "\ue008"
BALL = "bbsim.picture.actors[0].ball.mesh"


def number(text):
    return float(text.replace("\u2212", "-"))


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


class Pages(InBrowser):
    def show(self, name, *options):
        self.open(files.scene(name, *options))

    def seek(self, t):
        self.js("[bbsim.seek(arguments[0]), bbsim.picture && bbsim.picture.draw()]", t)

    def ranges(self):
        """Those of time in all drawn plots."""
        return self.js("bbsim.plots.plots.filter((p) => p.graph).map((p) => p.graph.xAxisRange())")

    def in_plot(self, t):
        """The place of a time in the first plot, halfway up."""
        return self.js("""(() => { const {graph, canvas} = bbsim.plots.plots[0], box = canvas.getBoundingClientRect();
            return [box.left + graph.toDomXCoord(arguments[0]), box.top + box.height / 2]; })()""", t)

    def columns_shown(self):
        return set(self.js("bbsim.plots.plots.flatMap((p) => p.curves.map((c) => c.name))"))

    def ball_is_at(self, row, radius, within, factor=1):
        self.all_near(self.js("bbsim.ballOnScreen()"), on_screen(self.js("bbsim.view()"), row, radius, factor), within)

    def quaternion(self):
        return self.js(f"{BALL}.quaternion.toArray()")

    def with_and_without(self, run, x, y, half):
        """The picture's pixels about a point of the window, (r, g, b, a) each, with a run and without it."""
        return self.js("""[true, false].map((shown) => {
            const {left, top} = document.getElementById('canvas').getBoundingClientRect();
            bbsim.data.runs[arguments[0]].shown = shown;
            const ink = bbsim.picture.whole().getContext('2d');
            return [...ink.getImageData(arguments[1] - left - arguments[3], arguments[2] - top - arguments[3],
                                        2 * arguments[3], 2 * arguments[3]).data]; })""", run, x, y, half)


class TheBall(Pages):
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
        self.assertFalse(self.hidden("exaggerated"))

    def test_is_drawn_there(self):
        """Removing the ball changes pixels only near the ball's computed place."""
        self.open(files.replay("rig"))
        rows = rows_of(files("rig.csv"))
        self.js("bbsim.picture.eyes.go('above')")
        for name in ["trail", "reference", "sensor", "events", "axes"]:
            self.js("bbsim.screen.show(arguments[0], false)", name)
        self.js("bbsim.picture.actors[0].shadow.material.uniforms.opacity.value = 0")
        for index in [0, 700, 1400]:
            self.js("bbsim.seek(arguments[0])", rows[index]["t"])
            x, y = on_screen(self.js("bbsim.view()"), rows[index], 0.02)
            corner = [math.floor(x) - 60, math.floor(y) - 60]
            ball, plate = self.with_and_without(0, corner[0] + 60, corner[1] + 60, 60)
            changed = [(i // 4 % 120, i // 480) for i in range(0, len(ball), 4)
                       if max(abs(a - b) for a, b in zip(ball[i:i + 3], plate[i:i + 3])) > 24]
            self.js("bbsim.data.runs[0].shown = true")
            self.assertGreater(len(changed), 200)
            # Seen from above, away from the middle, perspective shifts the ball's outline by less than a pixel.
            for axis, wanted in enumerate([x, y]):
                its = [place[axis] for place in changed]
                self.near(corner[axis] + (min(its) + max(its) + 1) / 2, wanted, 1.5)

    def test_turns_as_its_rows_say(self):
        files.run("oriented", "fig2a", "--set", "output.columns=[t,x,y,ball_qw,ball_qx,ball_qy,ball_qz]")
        # A stored run without them is drawn as one that rolls from row to row, and the page says so.
        for page, within, derived in [(files.scene("fig2a"), 1e-4, False), (files.replay("fig2a"), 1e-2, True)]:
            with self.subTest(derived=derived):
                self.open(page)
                for row in rows_of(files("oriented.csv"))[::200]:
                    self.seek(row["t"])
                    wanted = [row[f"ball_q{part}"] for part in "xyzw"]
                    # Quantized in steps of 1/32767; the sign is arbitrary.
                    self.near(abs(sum(a * b for a, b in zip(self.quaternion(), wanted))), 1, within)
                self.assertEqual("rolls straight from row to row" in self.browser.text("#details"), derived)


class Turns(Pages):
    SPIN = math.sqrt(20**2 + 110**2 + 15**2)  # rad/s at the start of slides.yaml: 20 about x, -110 about y

    def test_of_a_ball_that_slides_are_its_own(self):
        """Rolling would be 34.6 about y. Slip, velocity and spin are enough to know."""
        for page, given in [(files.scene("slides"), True), (files.page("told", files.run("told", "slides")), False)]:
            with self.subTest(given=given):
                self.open(page)
                self.seek(0.02)
                x, y, z, w = self.quaternion()
                # In 20 ms friction changes it by 6.9 m/s^2 / 0.026 m * 20 ms = 5 rad/s.
                self.near(2 * math.acos(min(1, abs(w))), 0.02 * self.SPIN, 0.06)
                self.near(y / math.copysign(math.sqrt(1 - w * w), w), -110 / self.SPIN, 0.05)
                self.assertEqual(self.js("bbsim.data.runs[0].orientationGiven"), given)

    def test_that_nobody_knows_are_not_drawn(self):
        for name, file in [
            ("untold", files.run("untold", "slides", "--set", "output.columns=[t,x,y,vx,vy]")),
            ("places", files.write("xy.csv", "t,x,y\n0,0,0\n1,0.01,0\n2,0.02,0.01\n")),
        ]:
            with self.subTest(name):
                self.open(files.page(name, file))
                self.assertFalse(self.js("bbsim.data.runs[0].turns"))
                self.seek(1)
                self.assertEqual(self.quaternion(), [0, 0, 0, 1])
                for place in ["#details", ".scale"]:
                    self.assertIn("ow the ball turns is not known", self.browser.text(place))


class TheAxes(Pages):
    def test_have_three_round_numbers_or_more(self):
        for name in ["slips", "rig", "fig2b", "three-servos", "sags"]:
            with self.subTest(name):
                self.show(name)
                self.js("bbsim.plots.plots.forEach((plot) => plot.build())")
                for labels in self.js("""bbsim.plots.plots.map((plot) =>
                    [...plot.canvas.querySelectorAll('.dygraph-axis-label-y')].map((label) => label.textContent))"""):
                    self.assertGreaterEqual(len(labels), 3)
                    step = abs(number(labels[1]) - number(labels[0]))
                    self.near(step / 10 ** math.floor(math.log10(step) + 1e-9) % 1, 0, 1e-6)

    def test_are_those_of_the_many_where_a_few_values_are_far_beyond(self):
        rows = "".join(f"{i / 100},{i / 1000},0,{-1.7e14 if i == 80 else 0.3 + i / 1000}\n" for i in range(81))
        self.open(files.page("beyond", files.write("far.csv", "t,x,y,normal_force\n" + rows)))
        low, high = self.js("bbsim.plots.plots.find((plot) => plot.group.title === 'Forces').graph.yAxisRange()")
        self.assertGreater(low, 0.2)
        self.assertLess(high, 0.5)

    def test_read_between_rows(self):
        self.open(files.replay("fig2b"))
        rows = rows_of(files("fig2b.csv"))
        self.seek((rows[100]["t"] + rows[101]["t"]) / 2)
        self.browser.frame()
        shown = self.js("bbsim.plots.plots[0].readings[0].title").split()[0]
        self.near(float(shown), (rows[100]["x"] + rows[101]["x"]) / 2, 1e-8)


class Time(Pages):
    def test_plays_at_the_speed_that_is_set(self):
        self.open(files.replay("rig"))
        for speed in [0.5, 4]:
            (wall_a, a), (wall_b, b) = self.ask("""const {clock} = bbsim, seen = [];
                clock.seek(1); clock.setSpeed(args[0]);
                clock.onTime((t) => seen.push([document.timeline.currentTime / 1000, t]));
                clock.play();
                while (seen.length < 6 || seen.at(-1)[0] - seen[1][0] < 0.5) await new Promise(requestAnimationFrame);
                clock.pause();
                return [seen[1], seen.at(-1)]""", speed)
            # Both clocks are those of the browser's frames.
            self.near((b - a) / (wall_b - wall_a), speed, 0.001 * speed)

    def test_ends_or_begins_again(self):
        self.open(files.replay("falls"))
        last = self.js("bbsim.data.end")
        for loop in [True, False]:
            self.browser.keys("l")
            playing, now = self.ask("""const {clock} = bbsim;
                clock.seek(args[0]); clock.play();
                while (clock.playing && clock.now >= args[0]) await new Promise(requestAnimationFrame);
                const found = [clock.playing, clock.now];
                clock.pause();
                return found""", last - 0.05)
            self.assertEqual(playing, loop)
            self.assertEqual(now < last - 0.05, loop)
        self.assertEqual(now, last)

    def test_keys(self):
        self.open(files.replay("rig"))
        rows = rows_of(files("rig.csv"))
        for keys, row in (([RIGHT] * 3, 3), ([LEFT], 2), ([END], -1), ([HOME], 0)):
            self.browser.keys(*keys)
            self.assertEqual(self.js("bbsim.clock.now"), rows[row]["t"])
        self.browser.keys(RIGHT, held=[SHIFT])
        self.near(self.js("bbsim.clock.now"), 1, 1e-12)
        playing, speed, view = "bbsim.clock.playing", "bbsim.clock.speed", "bbsim.picture.eyes.view"
        dialog, theme = "document.getElementById('keys').open", "document.documentElement.dataset.theme"
        for key, place, value in [
            (" ", playing, True), (" ", playing, False), ("]", speed, 2), ("]", speed, 4), ("[", speed, 2),
            ("1", view, "free"), ("2", view, "above"), ("3", view, "front"), ("4", view, "axis"), ("5", view, "plate"),
            ("t", theme, "dark"), ("t", theme, "light"), ("?", dialog, True),
            (" ", playing, False),  # a dialog handles its own keys
        ]:
            self.browser.keys(key)
            self.assertEqual(self.js(place), value, (key, place))

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


class TheAddress(Pages):
    def test_keeps_time_view_and_zoom(self):
        page = files.replay("rig")
        self.open(page)
        self.browser.keys("2", "e")
        self.js("[bbsim.plots.zoom([10, 14]), bbsim.seek(12.34)]")
        hash_ = self.wait("location.hash.includes('t=12.34') && location.hash")
        for part in ["view=above", "tilt=2", "zoom=10,14"]:
            self.assertIn(part, hash_)
        self.open(page + hash_)
        self.assertEqual(self.js("[bbsim.clock.now, bbsim.picture.eyes.view, bbsim.picture.factor]"), [12.34, "above", 2])
        self.assertEqual(self.ranges()[0], [10, 14])
        # The zoomed range follows the time.
        for t in (14.5, 3):
            self.js("bbsim.seek(arguments[0])", t)
            low, high = self.ranges()[0]
            self.assertTrue(low <= t <= high)
            self.near(high - low, 4, 1e-9)

    def test_keeps_the_eye_of_a_turned_view(self):
        page = files.replay("rig")
        self.open(page)
        left, top, *_ = self.box("#canvas")
        self.browser.drag((left + 200, top + 300), (left + 260, top + 330))
        eye = self.js("bbsim.picture.eyes.state()")
        here = "bbsim.picture.eyes.state().map((part) => Number(part.toPrecision(5))).join(',')"
        self.open(page + self.wait(f"location.hash.includes({here}) && location.hash"))
        self.all_near(self.js("bbsim.picture.eyes.state()"), eye, 1e-3)

    def test_ignores_nonsense(self):
        for hash_, view in [
            ("#t=abc&view=nowhere&eye=1,2&tilt=-3&x", "free"),
            ("#t=%&view=above&zoom=%E0%A4&x=%", "above"),
        ]:
            with self.subTest(hash_):
                self.open(files.replay("rig") + hash_)
                self.assertEqual(self.js("[bbsim.clock.now, bbsim.picture.eyes.view]"), [0, view])
                self.browser.keys(RIGHT)
                self.near(self.js("bbsim.clock.now"), 0.02, 1e-12)
                self.assertEqual(self.browser.console(), [])


class Plots(Pages):
    def test_click_goes_to_a_time_and_hover_reads_values(self):
        self.open(files.replay("rig"))
        rows = rows_of(files("rig.csv"))
        self.browser.click_at(*self.in_plot(10))
        t = self.js("bbsim.clock.now")
        self.near(t, 10, 0.15)
        self.assertIn(t, [row["t"] for row in rows])
        self.browser.mouse(self.in_plot(30))
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
        columns = set(content_of(files("rig.csv")).split("\n")[0].split(",")) - {"t"}
        self.assertLessEqual(columns | {"tracking_error", "friction"}, self.columns_shown())

    def test_no_two_curves_of_a_plot_differ_by_color_alone(self):
        for scene in ["rig", "slides", "torque-lqr", "three-servos", "hold", "fig2b"]:
            self.show(scene)
            plots = self.js("""bbsim.plots.plots.map((p) => p.curves.map((c) =>
                JSON.stringify([c.pattern, c.dots, c.width > 3, (c.width || 1.8) < 1.5])))""")
            for looks in plots:
                self.assertEqual(len(set(looks)), len(looks), (scene, looks))

    def test_have_no_units_that_nobody_tells(self):
        rows = "".join(f"{0.1 * i:.1f},{-12 + i},{3 - 0.1 * i:.1f},{i % 3},{i % 4},{i % 5},{i}\n" for i in range(20))
        self.open(files.page("cm", files.write("cm.csv", "t,x,y,phi,phi_command,torque_phi,mine\n" + rows)))
        self.assertEqual(self.texts(".plot h3 small"), [])
        self.assertNotIn("m", self.browser.text(".scale").split(" · ")[0])
        self.assertEqual(self.browser.text(".dygraph-xlabel"), "t")
        # Every column still has its plot, in the numbers of the file.
        self.assertEqual(self.columns_shown(), {"x", "y", "phi", "phi_command", "torque_phi", "mine"})
        self.seek(0.5)
        self.assertEqual(number(self.browser.text(".plot .legend li:first-child output")), -7)


class Comparison(Pages):
    def page(self):
        softer = files.run("softer", "fig2b", "--set", "controller.pd.kp.0.0=2", "--set", "controller.pd.kp.1.1=-2")
        lead = files.run("fig2b", "fig2b")
        rows = [f"{row['t'] + 0.001},{row['x'] - 0.002},{row['y'] + 0.003}\n" for row in rows_of(lead)[::3]]
        log = files.write("log.csv", "t,x,y\n" + "".join(rows))
        return files.page("compared", lead, softer, "--data", log, "--scenario", "configs/fig2b.yaml")

    def test_distance_between_runs_is_that_of_their_files(self):
        self.open(self.page())
        lead, softer = rows_of(files("fig2b.csv")), rows_of(files("softer.csv"))
        apart, from_log = self.js("bbsim.plots.plots.find((p) => p.curves[0].name === 'apart').curves.map((c) => [...c.values])")
        self.assertEqual(len(apart), len(lead))
        for a, b, shown in zip(lead, softer, apart):
            self.near(shown, math.hypot(a["x"] - b["x"], a["y"] - b["y"]), 2e-8)  # floats of 5 cm
        self.assertIsNone(from_log[0])  # before the log begins
        self.near(from_log[600], math.hypot(0.002, 0.003), 2e-4)

    def test_ghosts_are_where_their_files_say_and_are_switched_off(self):
        self.open(self.page())
        row = rows_of(files("softer.csv"))[400]
        self.seek(row["t"])
        seen = self.js("""(() => { const v = new THREE.Vector3();
            bbsim.picture.actors[1].ball.mesh.getWorldPosition(v).project(bbsim.picture.eyes.camera);
            const [l, t, w, h] = bbsim.view().canvas; return [l + (v.x + 1) / 2 * w, t + (1 - v.y) / 2 * h]; })()""")
        self.all_near(seen, on_screen(self.js("bbsim.view()"), row, 0.01), 0.05)
        self.assertEqual(self.count(".runs li"), 3)
        self.browser.click("input[data-run='1']")
        self.browser.frame()
        self.assertEqual(self.js("bbsim.picture.actors.map((a) => a.ball.mesh.visible)"), [True, False, True])

    def test_seven_have_their_picture_and_are_told_apart(self):
        gains = [f"controller.pd.kp.0.0={0.5 + 0.1 * n}" for n in range(7)]
        self.open(files.page("many", *(files.run(f"many{n}", "hold", "--set", gain) for n, gain in enumerate(gains))))
        self.assertTrue(self.hidden("trouble"))
        self.assertEqual(self.js("bbsim.picture.actors.length"), 7)
        looks = self.js("bbsim.data.runs.map((run) => bbsim.palette.run(run.index) + bbsim.palette.dash(run.index))")
        self.assertEqual(len(set(looks)), 7)

    def test_at_the_same_place_do_not_flicker(self):
        """Regression: the ghost of an equal run shone through the leading ball here and there."""
        self.open(files.page("equal", *(files.run(name, "rig") for name in ("equal0", "equal1"))))
        for view in ["free", "above", "ball"]:
            self.js("bbsim.picture.eyes.go(arguments[0])", view)
            for t in [1.3, 7.9, 23.1]:
                self.js("bbsim.seek(arguments[0])", t)
                both, lead = self.with_and_without(1, *self.js("bbsim.ballOnScreen()"), 6)
                self.assertEqual(both, lead, (view, t))

    def test_of_short_and_long_runs_has_one_span(self):
        self.open(files.page("spans", "configs/falls.yaml", "configs/fig2a.yaml"))
        ranges = self.ranges()
        self.assertGreater(len(ranges), 2)
        for its in ranges:
            self.all_near(its, [0, 10], 1e-3)
        self.assertEqual(self.browser.text(".dygraph-xlabel"), "t (s)")


def self_sweep():
    return files.sweep("delay", "falls", "--vary", "controller.sensor.delay=linear:0:0.2:11")[0]


class Sweeps(Pages):
    STATE = "bbsim.sweeps[0].state"

    def click_case(self, case):
        self.browser.click_at(*self.js("bbsim.sweeps[0].placeOf(arguments[0])", int(case)))

    def test_map_lines_and_the_command_of_a_case(self):
        page, table = files.sweep("gains", "fig2b", "--vary", "controller.pd.kv.0.0=linear:0.5:3.5:7", "--vary",
                                  "controller.pd.kp.0.0=linear:0:6:5", "--set", "time.end=3")
        self.open(page)
        cases = cases_of(table)
        self.assertIn("35 cases", self.browser.text("#sweeps"))
        done = sum(case["status"] == "done" for case in cases)
        self.assertIn(f"{done} done", self.browser.text(".statuses"))
        self.js(f"[{self.STATE}.measure = 0, bbsim.sweeps[0].refresh()]")
        case = next(case for case in cases if case["case"] == "8")
        self.click_case(8)
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
        for key, next_case in [(RIGHT, "Case 13"), (UP, "Case 14")]:
            self.browser.keys(key)
            self.assertEqual(self.browser.text(".case h3"), next_case)
        for kind in ["lines", "histogram", "map"]:
            self.browser.click(f"[data-kind={kind}]")
            self.assertEqual(self.js(self.STATE + ".kind"), kind)
        self.assertEqual(self.browser.console(), [])

    def test_of_one_key_has_lines_and_of_drawn_values_a_histogram(self):
        tied = ["one-tied", "hold", "--vary", "controller.pd.kp.0.0,-controller.pd.kp.1.1=linear:0.5:1.5:5"]
        for page in [self_sweep(), files.sweep(*tied, "--set", "time.end=2")[0]]:
            self.open(page)
            self.assertEqual(self.js(self.STATE + ".kind"), "lines")
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
        # The two keys with the most values are the axes, as in a plot; the third one has a slider.
        self.assertEqual(self.js(f"[{self.STATE}.kind, {self.STATE}.x, {self.STATE}.y]"), ["map", 0, 1])
        cases = cases_of(table)
        for level, place in [(0, "0.01"), (1, "0.03")]:
            self.js(f"[{self.STATE}.fixed.set('ball.position.0', {level}), bbsim.sweeps[0].refresh()]")
            shown = self.js("Array.from({length: 24}, (_, i) => i).filter((i) => bbsim.sweeps[0].placeOf(i))")
            self.assertEqual(shown, [i for i in range(24) if cases[i]["ball.position.0"] == place])
        self.assertIn("controller.pd.kp.0.0, controller.pd.kp.1.1", self.browser.text(".controls"))

    def test_medians_over_draws(self):
        page, table = files.sweep("draws", "fig2b", "--vary", "controller.pd.kv.0.0=linear:1:2:3", "--vary",
                                  "controller.pd.kp.0.0=list:1,2", "--vary", "ball.position.0=normal:5 cm:3 mm",
                                  "--samples", "7", "--set", "time.end=2")
        self.open(page)
        # The middle one of the cases in a cell is selected.
        cases = cases_of(table)
        cell = [case for case in cases
                if all(case[key] == cases[9][key] for key in ("controller.pd.kv.0.0", "controller.pd.kp.0.0"))]
        self.assertEqual(len(cell), 7)
        middle = sorted(cell, key=lambda case: float(case["rms_tracking_error"]))[3]
        self.click_case(cell[0]["case"])
        self.assertEqual(self.browser.text(".case h3"), f"Case {middle['case']}")

    def test_say_how_many_cases_they_show(self):
        rows = "".join(f"{i},{i // 300},{i % 300},done,1,{(i % 7) / 7}\n" for i in range(90000))
        self.open(files.page("thinned", files.write("large.csv", "case,a,b,status,end_time,max_tilt\n" + rows)))
        self.assertIn("22,500 of 90,000 shown", self.browser.text("#sweeps"))
        self.assertEqual(self.texts(".over .name").count("max tilt, °"), 1)

    def test_with_one_case_that_is_done_show_it(self):
        rows = "case,a,status,end_time,max_distance\n0,1,failed,0.1,9\n1,2,done,1,0.02\n2,3,failed,0.1,9\n"
        self.open(files.page("one-done", files.write("one.csv", rows)))
        self.assertEqual(self.browser.text(".case h3"), "Case 1")
        ticks = [number(text) for text in self.texts(".over text[text-anchor=end]")]
        self.assertTrue(0 < min(ticks) and max(ticks) < 0.05, ticks)  # an axis about 0.02, not from -1 to 1


class Texts(Pages):
    def test_hostile_ones_are_shown(self):
        file = files.run("a'b\"c<i>d", "falls")
        events = json.loads(content_of(file.replace(".csv", ".json")))["events"]
        events[0]["event"] = HOSTILE
        summary = files.change("a'b\"c<i>d.json", status="stopped", reason=HOSTILE, title=HOSTILE, events=events)
        self.open(files.page("hostile", file, "--summary", summary, "--title", HOSTILE, "--scenario", "configs/falls.yaml"))
        title = self.browser.text("#title")
        for words in ["</script><script>window.broken = 1</script>", "␛[31m", "⟨U+202E⟩"]:
            self.assertIn(words, title)
        self.assertIsNone(self.js("window.broken || null"))
        self.assertIn("a'b\"c<i>d.csv", self.browser.text("#subtitle"))
        self.assertIn("</script>", self.browser.text("#details"))
        self.assertEqual(self.count("img, #details i, #subtitle i"), 0)

    def test_what_was_run(self):
        self.open(files.replay("fig2b"))
        self.assertEqual(self.browser.text("#details pre code"), content_of("configs/fig2b.yaml"))
        details = self.browser.text("#details")
        for words in ["closed loop", "Poles about home", "rhs evaluations", "All 1051 rows"]:
            self.assertIn(words, details)
        self.assertEqual(self.count(".poles .pole"), 8)
        self.assertIn("Permission is hereby granted", self.browser.text("#licenses"))
        self.show("rig")
        for words in ["torque φ", "mN·m at ", "power", "mW at "]:
            self.assertIn(words, self.browser.text("#details"))

    def test_a_run_that_ended_early_says_why(self):
        files.run("interrupted", "fig2a")
        files.change("interrupted.json", status="interrupted", reason="interrupted at t = 10 s of 99 s.")
        bbsim("run", "configs/falls.yaml", "-o", files("stopped.h5"), "--replay", files("stopped.html"), ends=(1,))
        end = "at t = 0.542322 s of 8 s: the contact point left the plate"
        for page, subtitle, reason in [
            (files.scene("falls"), "stopped at 0.542322 s of 8 s", end),
            (files.replay("falls"), "stopped at 0.542322 s of 8 s", end),
            (files.page("stopped"), "stopped at 0.542322 s of 8 s", end),
            (files.page("stored", files("stopped.h5")), "stopped at 0.542322 s of 8 s", end),
            (files.replay("fig2b-literal"), "failed at", "grows without bound"),
            (files.page("interrupted", files("interrupted.csv"), "--scenario", "configs/fig2a.yaml"),
             "interrupted at 10 s", "Interrupted at t = 10 s of 99 s."),
        ]:
            with self.subTest(page):
                self.open(page)
                self.assertIn(subtitle, self.browser.text("#subtitle"))
                self.assertTrue(self.hidden("ended"))
                self.browser.keys(END)
                self.assertFalse(self.hidden("ended"))
                self.assertIn(reason, self.browser.text("#ended"))
                if reason is not end:
                    continue
                # It ends where the event was, after the last row of the file.
                self.assertIn("0.542322 / 0.542322 s", self.browser.text("#time"))
                row = {"x": 0.16, "y": -0.020345410307771216, "phi": -0.2396367700421219, "theta": -0.07284538574323257}
                self.near(self.js("bbsim.data.runs[0].placeAt(bbsim.clock.now)")[0], row["x"], 1e-8)
                self.ball_is_at(row, 0.02, 0.1)
                self.assertIn("All 28 rows are in this page", self.browser.text("#details"))

    def test_a_run_without_a_second_row_has_its_end(self):
        self.show("hard/creep")
        shown = self.browser.text("#subtitle").partition("failed at ")[2].removesuffix(" s of 13 s")
        # The summary has the time at which the integrator gave up; the page shows six digits.
        files.run("creep", "hard/creep")
        end = json.loads(content_of(files("creep.json")))["end_time"]
        self.assertLess(0, end)
        self.assertEqual(float(f"{end:.6g}"), number(shown))
        self.assertIn(f"{shown} / {shown} s", self.browser.text("#time"))

    def test_csv_and_png_are_those_of_the_page(self):
        self.open(files.replay("fig2b"))
        saved = self.js("bbsim.save.csvOf(bbsim.data.runs[0])").splitlines()
        lines = content_of(files("fig2b.csv")).splitlines()
        self.assertEqual([saved[0], len(saved)], [lines[0], len(lines)])
        for a, b in zip(saved[1:], lines[1:]):
            a, b = [float(v) for v in a.split(",")], [float(v) for v in b.split(",")]
            self.assertEqual(a[0], b[0])
            for found, wanted in zip(a, b):
                self.near(found, wanted, 1.2e-7 * abs(wanted) + 1e-37)  # rounded to a float and to its digits
        png = self.ask("""const make = URL.createObjectURL;
            return new Promise((done) => {
              URL.createObjectURL = (blob) => { blob.arrayBuffer().then((b) => done(
                  [blob.type, b.byteLength, ...new Uint8Array(b, 0, 4)])); return make.call(URL, blob); };
              document.getElementById('save-png').click();
            })""")
        self.assertEqual(png[0], "image/png")
        self.assertGreater(png[1], 10000)
        self.assertEqual(png[2:], [0x89, 0x50, 0x4E, 0x47])

    def test_everything_that_can_be_used_has_a_name(self):
        for page in [files.replay("rig"), self_sweep(), fit_page()]:
            self.open(page)
            self.assertEqual(self.js("""[...document.querySelectorAll('button, input, select, canvas, [role=img]')].filter((e) =>
                !(e.getAttribute('aria-label') || e.textContent.trim() || (e.labels && e.labels.length) ||
                  e.querySelector('title') || e.closest('.plot'))).map((e) => e.outerHTML)"""), [])


class Missing(Pages):
    def test_angles_are_said_to_be_missing(self):
        rows = "".join(f"{i},0.0{i},0,{',' if 3 <= i <= 7 else '0.02,0.03'}\n" for i in range(11))
        self.open(files.page("gaps", files.write("some.csv", "t,x,y,phi,theta\n" + rows)))
        for t, missing, tilt in [(0, True, "2.066°"), (5, False, "–"), (9, True, "2.066°")]:
            self.js("bbsim.seek(arguments[0])", t)
            self.assertEqual(self.hidden("missing"), missing)
            self.assertEqual(self.browser.text("#level-tilt"), tilt)
        # No orientation at all: a log of positions.
        self.open(files.page("log-alone", files.write("places.csv", "t,x,y\n0,0,0\n1,0.1,0.1\n")))
        self.assertIn("No tilt was recorded", self.browser.text("#missing"))

    def test_infinite_values_are_said(self):
        self.show("hard/overflow")
        self.js("bbsim.seek(50000)")
        self.assertIn("it is not drawn", self.browser.text("#missing"))
        self.assertFalse(self.hidden("missing"))
        self.assertIn("∞", self.browser.text(".plot .legend li:first-child output"))
        self.assertNotIn("e154", self.browser.text(".scale"))
        self.assertTrue(all(math.isfinite(v) for v in self.js("bbsim.view().view")))
        self.js("bbsim.seek(0)")
        self.assertTrue(self.hidden("missing"))


class TheStage(Pages):
    def test_holds_the_whole_path_in_view(self):
        for scene in ["hold", "hard/pulse", "hard/unstable", "fig2a", "incline"]:
            with self.subTest(scene):
                self.show(scene)
                end, stage = self.js("[bbsim.data.end, bbsim.data.scene.stage]")
                for k in range(9):
                    self.seek(end * k / 8)
                    x, y = self.js("bbsim.ballOnScreen()")
                    left, top, width, height = self.js("bbsim.view().canvas")
                    self.assertTrue(left < x < left + width and top < y < top + height, (k, x, y))
                    place = self.js("bbsim.data.runs[0].placeAt(bbsim.clock.now)")
                    self.assertLessEqual(abs(place[0]), stage["width"] / 2)
                    self.assertLessEqual(abs(place[1]), stage["depth"] / 2)
                    # Its corners are visible too, at every tilt.
                    corners = self.js("""[[-1, -1], [-1, 1], [1, -1], [1, 1]].flatMap(([x, y]) => {
                        const {width, depth} = bbsim.data.scene.stage;
                        const v = new THREE.Vector3(x * width / 2, y * depth / 2, 0).applyMatrix4(bbsim.picture.rig.plane.matrixWorld);
                        v.project(bbsim.picture.eyes.camera); return [v.x, v.y]; })""")
                    self.assertLessEqual(max(abs(c) for c in corners), 1, scene)

    def test_is_drawn_with_every_part(self):
        for scene in ["rig", "three-servos"]:
            self.show(scene)
            for name in self.js("Object.keys(bbsim.visible)"):
                for on in (True, False, True):
                    self.js("[bbsim.screen.show(arguments[0], arguments[1]), bbsim.picture.draw()].length", name, on)

    def test_of_one_axis_is_a_beam_whose_frame_has_no_cracks(self):
        """Regression: a corner of a long frame was open. Rays from above meet the frame all around."""
        self.show("beam")
        stage = self.js("bbsim.data.scene.stage")
        self.assertLess(stage["depth"], stage["width"] / 3)
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
        for page, size in [
            (files.scene("fig2a"), 18),
            (files.page("small", "tests/data/scenarios/small-ball.yaml"), 18),
            (files.scene("rig"), 0),
        ]:
            self.open(page)
            shown = self.js("""(() => { bbsim.picture.draw();
                const {marker} = bbsim.picture.actors[0];
                if (!marker.visible) return 0;
                const on = (x) => { const v = new THREE.Vector3(x, 0, 0).applyMatrix4(marker.matrixWorld).project(bbsim.picture.eyes.camera);
                  return v.x * bbsim.view().canvas[2] / 2; };
                return on(9) - on(-9); })()""")
            self.near(shown, size, 0.5)

    def test_the_view_of_the_ball_goes_with_it(self):
        self.open(files.page("small", "tests/data/scenarios/small-ball.yaml"))
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

    def test_names_of_events_are_not_printed_over_each_other(self):
        self.show("slides")
        self.assertEqual(self.js("""(() => { const wanted = Array.from({length: 6}, (_, i) => ({x: 3 * i, y: 0, width: 40, height: 12}));
            const up = bbsim.placeLabels(wanted);
            const boxes = wanted.map((w, i) => up[i] === null ? null : [w.x - 20, -up[i] - 6, w.x + 20, -up[i] + 6]).filter(Boolean);
            return [boxes.length > 1, boxes.some((a, i) => boxes.some((b, k) => i < k && a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]))]; })()"""),
            [True, False])

    def test_marks_are_above_their_rims(self):
        """Regression: rims drawn later than what they surround used to hide it."""
        self.show("slides")
        orders = self.js("bbsim.picture.rig.plane.children.flatMap((group) => group.children).filter((mark) => mark.children.length === 2)"
                         ".map((mark) => mark.children.map((part) => part.renderOrder))")
        marks = [order for order in orders if order[0] != order[1]]
        self.assertGreaterEqual(len(marks), 3)
        for rim, inner in marks:
            self.assertGreater(inner, rim)


class Hands(Pages):
    def setUp(self):
        self.open(files.replay("rig"))
        left, top, *_ = self.box("#canvas")
        self.place = left + 200, top + 300

    def eye(self):
        return self.js("bbsim.picture.eyes.state()")

    def test_a_wheel_scrolls_the_page_until_the_view_is_clicked(self):
        def wheel(modifiers=0):
            x, y = self.place
            self.browser.devtools("Input.dispatchMouseEvent", {"type": "mouseWheel", "x": x, "y": y, "deltaX": 0,
                                                               "deltaY": 120, "modifiers": modifiers})
            self.browser.frame()

        distance = lambda: math.hypot(*self.eye()[:3])
        before = distance()
        wheel()
        self.assertTrue(self.wait("window.scrollY > 0"))
        self.assertEqual(distance(), before)
        self.assertFalse(self.hidden("hint"))
        wheel(modifiers=2)  # Ctrl
        zoomed = distance()
        self.assertGreater(zoomed, before)
        self.js("window.scrollTo(0, 0)")
        self.browser.click_at(*self.place)
        wheel()
        self.assertGreater(distance(), zoomed)
        self.assertEqual(self.js("window.scrollY"), 0)

    def test_a_finger_scrolls_the_page_until_the_view_is_tapped(self):
        def touch(*shifts):
            for kind, points in [("touchStart", [0]), *(("touchMove", [shift]) for shift in shifts), ("touchEnd", [])]:
                self.browser.devtools("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [
                    {"x": self.place[0] + shift, "y": self.place[1]} for shift in points]})
            self.browser.frame()

        action = "getComputedStyle(document.getElementById('canvas')).touchAction"
        before = self.eye()
        touch(40)
        self.assertEqual(self.eye(), before)
        self.assertEqual(self.js(action), "pan-y")
        touch()
        self.wait("document.activeElement.id === 'canvas'")
        self.assertEqual(self.js(action), "none")
        touch(20, 60)
        self.assertNotEqual(self.eye(), before)


class Pace(Pages):
    def test_slow_pictures_have_fewer_pixels_and_then_are_flat(self):
        self.show("rig")
        # Draws as many pictures as are examined, each after this time; the page's own frames are stopped.
        self.js("[window.fake = 0, performance.now = () => window.fake, window.requestAnimationFrame = () => 0, bbsim.clock.play()]")
        frames = lambda *its: self.js("Array.from({length: arguments[0]}, () => [window.fake += arguments[1],"
                                      "bbsim.seek(bbsim.clock.now + 1e-3)]).length", *its)
        ratio = "bbsim.picture.renderer.getPixelRatio()"
        for count, span, pixels in [(30, 20, 1), (8, 60, 0.5)]:
            frames(count, span)
            self.assertEqual((self.js(ratio), self.js("bbsim.screen.isFlat")), (pixels, False))
        self.js("bbsim.clock.pause()")
        self.assertEqual(self.js(ratio), 1)  # a still picture has full resolution
        self.js("bbsim.clock.play()")
        frames(8, 120)
        self.assertEqual([self.hidden(name) for name in ("flat", "picture", "hint")], [False, True, False])
        # A user who chooses three dimensions keeps them.
        self.browser.click("[data-view=above]")
        frames(30, 120)
        self.assertFalse(self.js("bbsim.screen.isFlat"))

    def test_what_has_not_changed_is_not_drawn_again(self):
        self.show("hard/rest")
        drawn = lambda: self.js("bbsim.picture.renderer.info.render.frame")
        self.js("bbsim.seek(1e5)")
        self.browser.frame()
        before = drawn()
        for t in [2e5, 3.3e5, 7e5]:
            self.js("bbsim.seek(arguments[0])", t)
            self.browser.frame()
        self.assertEqual(drawn(), before)
        self.js("bbsim.picture.eyes.turn(0.1, 0)")
        self.browser.frame()
        self.assertGreater(drawn(), before)


class Flat(Pages):
    def test_shows_the_ball_where_the_rows_say(self):
        self.show("rig")
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
        self.wait("location.hash.includes('view=flat')")
        self.browser.keys("1")
        self.assertFalse(self.js("bbsim.screen.isFlat"))


class Paper(Pages):
    def pages(self):
        pdf = base64.b64decode(self.browser.devtools("Page.printToPDF", {"paperWidth": 8.27, "paperHeight": 11.69})["data"])
        return len(re.findall(rb"/Type\s*/Page[^s]", pdf))

    def test_has_the_whole_scenario_and_all_cards(self):
        for scene in ["rig", "falls", "fig2a", "slides", "torque-lqr", "three-servos", "pushrod", "hard/overflow"]:
            with self.subTest(scene):
                self.show(scene)
                self.assertLessEqual(self.pages(), 4)
                # No card is left out or cut off.
                self.js("bbsim.print.begin()")
                cards = self.js("""[...document.querySelectorAll('#details .card')].map((card) => [card.querySelector('h3').textContent,
                    card.getBoundingClientRect().height > 0 && [...card.querySelectorAll('pre')].every((text) => text.scrollHeight <= text.clientHeight + 1)])""")
                self.assertEqual([name for name, whole in cards if not whole], [])
                self.assertEqual(self.browser.text("#details .card.text code").split(), content_of(f"configs/{scene}.yaml").split())

    def test_has_all_plots_and_leaves_the_screen_as_it_was(self):
        sizes = "bbsim.plots.plots.map(({canvas}) => [canvas.clientWidth, canvas.clientHeight])"
        self.show("rig")
        on_screen = self.js(sizes)
        self.js("bbsim.print.begin()")
        drawn = self.js("""bbsim.plots.plots.map(({canvas}) => { const c = canvas.querySelector('canvas.printed');
            const bytes = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let inked = 0;
            for (let i = 3; i < bytes.length; i += 4) inked += bytes[i] > 0; return inked / (bytes.length / 4); })""")
        self.assertGreater(len(drawn), 4)
        self.assertGreater(min(drawn), 0.005)
        self.js("bbsim.print.end()")
        self.assertEqual(self.count("canvas.printed"), 0)
        self.assertEqual(self.js("document.documentElement.className"), "")
        self.assertEqual(self.js(sizes), on_screen)
        # Print preview gives the same.
        self.browser.devtools("Emulation.setEmulatedMedia", {"media": "print"})
        self.wait("document.querySelectorAll('canvas.printed').length > 5")
        self.browser.emulate()
        self.wait("document.querySelectorAll('canvas.printed').length === 0")


class LongRuns(Pages):
    def test_a_million_rows(self):
        run = files.run("long", "fig2b", "--set", "time.step=2.1e-5")
        self.open(files.page("long", run, "--scenario", "configs/fig2b.yaml"))
        self.assertLess(os.path.getsize(files("long.html")), 5_000_000)
        self.assertEqual(self.js("bbsim.data.runs[0].rows"), 1_000_001)
        # Between kept rows too, the ball is within half a pixel of the file's place.
        rows = rows_of(run)
        for index in [123_456, 500_000, 876_543]:
            self.js("bbsim.seek(arguments[0])", rows[index]["t"])
            self.ball_is_at(rows[index], 0.01, 0.5)


class Linkages(Pages):
    def test_legs_end_where_the_joints_are(self):
        """Rods and horns have their lengths, horns the servos' angles, and joints their places in the plate."""
        self.open(files.replay("three-servos"))
        rows = rows_of(files("three-servos.csv"))
        base, plate, horn, rod, height = 0.06, 0.09, 0.04, 0.1, 0.11
        far = math.hypot(plate - base, height)
        home = math.atan2(height, plate - base) - math.acos((far**2 + horn**2 - rod**2) / (2 * horn * far))
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

    def test_push_rods_lead_from_horns_to_the_plate(self):
        """Bars keep their lengths, the plate carries the joints, and horns have the servos' angles but for backlash."""
        self.open(files.replay("pushrod"))
        rows = rows_of(files("pushrod.csv"))
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
                # The drawn bar ends there.
                drawn = self.js(f"""(() => {{ const {{group, places}} = bbsim.picture.rig.rods[{axis}], {{knee, joint}} = places(), middle = knee.map((v, i) => (v + joint[i]) / 2);
                    return group.children.filter((bar) => bar.position.distanceTo(new THREE.Vector3(...middle)) < 1e-9).map((bar) => bar.scale.y); }})()""")
                self.all_near(drawn, [rod], 1e-6)
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


class AFit(Pages):
    def setUp(self):
        self.open(fit_page())

    def balls(self):
        return self.js("""['measured', 'model'].map((name) => {
            const ball = document.querySelector(`[data-ball=${name}]`);
            return [ball.getAttribute('transform'), ball.getAttribute('visibility')]; })""")

    def test_has_the_numbers_of_the_fit_in_its_tables(self):
        parameters = json.loads(content_of(files("fit.json")))["parameters"]
        rows = self.js("""[...document.querySelectorAll('#parameters tbody tr')].map((row) =>
            [...row.children].map((cell) => cell.textContent))""")
        self.assertEqual([row[0] for row in rows], [one["key"] for one in parameters])
        for row, one in zip(rows, parameters):
            self.near(number(row[2]), one["estimate"], 0.1 * one["sd"])
        self.assertIn("held out", self.browser.text("#residuals"))

    def test_draws_log_and_model(self):
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
        painted = self.js("""bbsim.plots.plots.flatMap((plot) => plot.curves.map((curve) => {
            const wanted = [1, 3, 5].map((i) => parseInt(curve.colour().slice(i, i + 2), 16));
            return [...plot.canvas.querySelectorAll('canvas')].reduce((count, canvas) => {
              const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
              for (let i = 0; i < data.length; i += 4) {
                if (data[i + 3] > 60 && wanted.every((part, k) => Math.abs(data[i + k] - part) < 40)) ++count;
              }
              return count;
            }, 0); }))""")
        self.assertEqual(len(painted), 6)
        self.assertGreater(min(painted), 100)

    def test_zoom_is_shared(self):
        self.js("bbsim.plots.plots.forEach((plot) => plot.build())")
        self.browser.drag(*(self.in_plot(t) for t in (1, 1.5, 2)))
        self.assertEqual(len(self.ranges()), 4)
        for its in self.ranges():
            self.all_near(its, [1, 2], 0.05)

    def test_moves_the_two_balls(self):
        begin = self.balls()
        self.assertEqual([is_shown for _, is_shown in begin], ["visible", "visible"])
        self.js("document.getElementById('scrub').focus()")
        self.browser.keys(*[RIGHT] * 40)
        rows = rows_of(files("fit-log-1.csv"))
        self.near(self.js("bbsim.clock.now"), rows[40]["t"], 1e-12)
        for before, after in zip(begin, self.balls()):
            self.assertNotEqual(before, after)
        # The balls' distance agrees with the numbers.
        far = self.js("""(() => { const [run] = bbsim.data.runs, row = run.nearest(bbsim.clock.now);
            return Math.hypot(run.values('x_residual')[row], run.values('y_residual')[row]); })()""")
        self.assertIn(f"{1e3 * far:.2f} mm apart", self.browser.text("#plan"))
        # A row without x has no ball of the log.
        self.js("bbsim.seek(arguments[0])", rows[57]["t"])
        self.assertEqual([is_shown for _, is_shown in self.balls()], ["hidden", "visible"])
        # The pointer in a plot moves them too.
        self.browser.mouse(self.in_plot(3.2))
        self.browser.frame()
        self.assertIn("t = 3.2", self.browser.text("#plan"))
        self.assertEqual(self.js("bbsim.clock.now"), rows[57]["t"])

    def test_shows_the_log_that_is_chosen(self):
        self.assertFalse(self.hidden("choice"))
        self.js("""(() => { const log = document.getElementById('log');
            log.value = '1'; log.dispatchEvent(new Event('change')); })()""")
        self.browser.frame()
        self.assertEqual(self.count(".plot"), 4)
        first = rows_of(files("fit-log-2.csv"))[0]
        self.near(self.js("bbsim.data.runs[0].values('x')[0]"), first["x"], 1e-8)
        self.js("bbsim.seek(1)")
        self.assertIn("1.00", self.browser.text("#time"))
        self.assertEqual(self.browser.console(), [])

    def test_on_paper_are_all_plots(self):
        self.js("bbsim.print.begin()")
        self.assertEqual(self.count(".plot canvas.printed"), 4)
        self.assertLessEqual(self.js("document.documentElement.scrollHeight"), 2 * 970)
        self.js("bbsim.print.end()")
        self.assertEqual(self.count("canvas.printed"), 0)


class Phone(Pages):
    options = {"width": 400, "height": 800, "phone": True}

    def test_fits(self):
        for page in [files.replay("fig2a"), files.replay("rig"), self_sweep(), fit_page()]:
            self.open(page)
            self.assertLessEqual(self.js("document.documentElement.scrollWidth"), 400)


class Motion(Pages):
    options = {"still": False}

    def test_views_glide_and_arrive(self):
        self.open(files.replay("rig"))
        self.js("bbsim.picture.eyes.go('above')")
        self.wait("(([x, y, z]) => Math.hypot(x, y) < 1e-2 * z)(bbsim.picture.eyes.state())")
        self.assertEqual(self.browser.console(), [])


class WithoutWebGL(Pages):
    options = {"flags": ("--disable-3d-apis",)}

    def test_the_rest_is_there(self):
        self.browser.open(files.replay("rig"))
        self.assertFalse(self.hidden("trouble"))
        self.assertTrue(self.hidden("picture"))
        self.assertGreater(self.js("bbsim.plots.plots.length"), 3)
        self.browser.keys(RIGHT)
        self.near(self.js("bbsim.clock.now"), 0.02, 1e-12)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
