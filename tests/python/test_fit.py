# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Fits: bbsim.fit and `bbsim fit`. Needs BBSIM (the program) and BBSIM_SOURCE in the environment."""

import base64
import json
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path
from unittest import mock

import cases
import numpy as np
from cases import CONFIGS, SOURCE

import bbsim
from bbsim import _fit_search, _fit_windows

DATA = SOURCE / "tests" / "data"

# Two servos follow sines of different periods, starting at their greatest angles so that the ball does not drift.
TRUE_RIG = """
ball: {radius: 1 cm, position: [2 cm, -1 cm], inertia_factor: 0.43}
gimbal:
  motion:
    phi:
      - {sinusoid: {amplitude: 3 deg, frequency: 5.3 rad/s, phase: 1.5708 rad}}
      - {sinusoid: {amplitude: 2 deg, frequency: 2.9 rad/s, phase: 1.5708 rad}}
    theta:
      - {sinusoid: {amplitude: 3 deg, frequency: 4.1 rad/s, phase: 1.5708 rad}}
      - {sinusoid: {amplitude: 2 deg, frequency: 7.7 rad/s, phase: 1.5708 rad}}
time: {end: 20, step: 50 ms}
output: {columns: [t, x, y, phi, theta]}
"""
# The rig as its owner believes it to be.
ASSUMED_RIG = """# A rig, as bought.
ball: {radius: 1 cm}  # solid
gimbal:
  motion:
    phi: {table: {file: log.csv, time: t, value: phi}}
    theta: {table: {file: log.csv, time: t, value: theta}}
time: {end: 10, step: 50 ms}
"""
PHI, THETA = "gimbal.motion.phi.table.", "gimbal.motion.theta.table."
NAMES = ("t", "x", "y", "phi", "theta")


def rows_of(scene=TRUE_RIG, sd=0.0, scale=1.0, offset=0.0, seed=1, step=0.0):
    """Rows of a rig, with noise of `sd` (m) on the ball, rounded to `step`, and phi from a gauge that reads
    (phi - offset) / scale."""
    run, random = bbsim.run(scene), np.random.default_rng(seed)
    rows = {name: np.array(run[name]) for name in NAMES}
    for name in ("x", "y"):
        rows[name] += sd * random.normal(size=rows[name].size)
        if step:
            rows[name] = step * np.round(rows[name] / step)
    rows["phi"] = (rows["phi"] - offset) / scale
    return rows


class Case(cases.Case):
    def put(self, rows, scene=ASSUMED_RIG, file="log.csv"):
        table = np.column_stack(list(rows.values()))
        lines = [",".join("" if np.isnan(one) else repr(float(one)) for one in row) for row in table]
        Path(file).write_text("\n".join([",".join(rows), *lines]) + "\n")
        Path("rig.yaml").write_text(scene)

    def fit(self, free, **options):
        return bbsim.fit("rig.yaml", options.pop("logs", "log.csv"), free, **options)

    def assert_near(self, one, value):
        """Holds for 99.99 % of all logs; the logs of a test never change."""
        self.assertLess(abs(one.estimate - value), 3.9 * one.sd, one)

    def refused(self, message, free, **options):
        self.refuses(message, self.fit, free, **options)


class Estimates(Case):
    def test_rows_that_saw_nothing_are_left_out(self):
        rows = rows_of(sd=5e-4)
        unseen = np.arange(rows["x"].size) % 7 == 3
        rows["x"][unseen] = rows["y"][unseen] = -1
        self.put(rows)
        made = self.fit("ball.inertia_factor", missing=-1)
        self.assert_near(made.parameters[0], 0.43)

    def test_keys_within_their_intervals(self):
        self.put(rows_of(sd=5e-4, scale=1.1, offset=0.01))
        free = ["ball.inertia_factor", PHI + "scale", PHI + "offset=-5 deg:5 deg"]
        made = self.fit(free, output="fitted.yaml")
        for one, value in zip(made.parameters, (0.43, 1.1, 0.01)):
            self.assert_near(one, value)
            self.assertLess(one.sd, 0.05 * value)
            self.assertTrue(one.interval[0] < one.estimate < one.interval[1])
            self.assertFalse(one.at_bound)
        self.assertTrue(made.identifiable and made.white)
        self.assertEqual(made.windows, 10)
        for name in ("x", "y"):  # the starts absorb a part of the noise
            self.assertAlmostEqual(made.residual_rms[name] / 5e-4, 1, delta=0.14)
            self.assertAlmostEqual(made.ideal_rms[name] / made.before_rms[name], 1, delta=0.2)
        self.assertGreater(made.before_rms["x"], 2 * made.residual_rms["x"])
        text = Path("fitted.yaml").read_text()
        self.assertIn("# A rig, as bought.\n", text)
        self.assertIn("  # solid\n", text)
        self.assertIn(repr(made.parameters[0].estimate), text)
        again = self.fit(free, threads=1)
        self.assertEqual([one.estimate for one in again.parameters], [one.estimate for one in made.parameters])

    def test_windows_begin_with_a_spin_of_their_own(self):
        # The log is bbsim's own, without noise: every estimate is right only if the spin at each start is found.
        self.put(rows_of(), ASSUMED_RIG.replace("radius: 1 cm", "radius: 1 cm, inertia_factor: 0.43"))
        sines = TRUE_RIG.split("gimbal:")[1].split("time:")[0]
        ball, time = "ball: {radius: 1 cm, inertia_factor: 0.4}\n", "time: {end: 20, step: 50 ms}\n"
        Path("rig.yaml").write_text(ball + "gimbal:" + sines + time)
        made = self.fit(["ball.inertia_factor", "gimbal.mounting.height", "gimbal.mounting.theta_offset"])
        self.assertEqual(made.windows, 10)
        for one, value in zip(made.parameters, (0.43, 0, 0)):
            self.assertAlmostEqual(one.estimate, value, delta=1e-8)  # of an integration to 1e-10
        self.assertLess(made.residual_rms["x"], 1e-9)
        self.assertTrue(all(np.isfinite([one.sd, *one.interval]).all() for one in made.parameters))

    def test_eight_keys_with_noise_and_rounding(self):
        slowed = TRUE_RIG.replace("inertia_factor: 0.43", "inertia_factor: 0.43, mass: 3 g, losses: {viscous: 2e-7}")
        believed = ASSUMED_RIG.replace("radius: 1 cm", "radius: 1 cm, mass: 3 g, losses: {viscous: 0}")
        self.put(rows_of(slowed, 5e-4, 1.1, 0.01, 3, 3.2e-4), believed)
        free = ["ball.inertia_factor", "ball.losses.viscous", PHI + "scale", PHI + "offset", THETA + "scale",
                THETA + "offset", PHI + "delay=-100:100 ms", THETA + "delay=-100:100 ms"]  # fmt: skip
        made = self.fit(free)
        for one, value in zip(made.parameters, (0.43, 2e-7, 1.1, 0.01, 1, 0, 0, 0)):
            self.assert_near(one, value)
            self.assertTrue(one.told)
        self.assertTrue(made.white)

    def test_a_sensor(self):
        rows = rows_of(sd=2e-4, seed=5)
        late = {name: rows[name][2:] if name in ("phi", "theta") else rows[name][:-2] for name in NAMES}
        late["t"] = rows["t"][:-2]
        late["x"] = -0.8 * late["x"]  # mirrored
        self.put(late)
        made = self.fit(["log.x.scale", "ball.inertia_factor", "log.delay"])
        found = {one.key: one for one in made.parameters}
        self.assert_near(found["log.x.scale"], -0.8)
        self.assert_near(found["ball.inertia_factor"], 0.43)
        self.assert_near(found["log.delay"], 0.1)  # two rows
        self.assertEqual(found["log.delay"].unit, "s")

    def test_several_logs_each_with_its_own_table(self):
        self.put(rows_of(sd=5e-4, scale=1.1))
        self.put(rows_of(TRUE_RIG.replace("frequency: 5.3", "frequency: 6.1"), 5e-4, 1.1, seed=2), file="second.csv")
        made = self.fit([PHI + "scale", "ball.inertia_factor"], logs=["log.csv", "second.csv"])
        self.assert_near(made.parameters[0], 1.1)
        self.assertEqual(made.windows, 20)

    def test_units_of_a_table_are_its_own(self):
        rows = rows_of(sd=5e-4, offset=0.01)
        rows["phi_deg"] = np.degrees(rows.pop("phi"))
        scene = ASSUMED_RIG.replace("value: phi}", "value: phi_deg}")
        self.put(rows, scene.replace("1 cm", "1 cm, inertia_factor: 0.43"))
        made = self.fit(PHI + "offset")
        self.assertEqual(made.parameters[0].unit, "rad")
        self.assert_near(made.parameters[0], 0.01)

    def test_servos_from_their_commands(self):
        sines = ("[{{sinusoid: {{amplitude: 3 deg, frequency: {}, phase: 1.5708 rad}}}}, "
                 "{{sinusoid: {{amplitude: 1 deg, frequency: {}}}}}]")  # fmt: skip
        scene = ("ball: {{radius: 2 cm, position: [5 cm, 0]}}\n"
                 "gimbal: {{servo: {{natural_frequency: {} Hz, damping: {}}}}}\n"
                 "controller: {{drives: angle, commands: {{phi: {}, theta: {}}}}}\ntime: {{end: 20, step: 20 ms}}\n"
                 "output: {{columns: [t, x, y, phi, theta, phi_command, theta_command]}}\n")  # fmt: skip
        run = bbsim.run(scene.format(4, 0.7, sines.format("5.3", "17"), sines.format("4.1", "13")))
        random = np.random.default_rng(1)
        rows = {name: np.array(run[name]) + 3e-4 * random.normal(size=run[name].size) for name in ("x", "y")}
        rows.update(t=run["t"], u=(run["phi_command"] - 0.005) / 1.1, v=run["theta_command"])
        table = "{{table: {{file: log.csv, time: t, value: {}}}}}"
        self.put(rows, scene.format(5, 0.9, table.format("u"), table.format("v")))
        free = ["gimbal.servo.natural_frequency", "gimbal.servo.damping", "controller.commands.phi.table.scale"]
        made = self.fit([*free, "controller.commands.phi.table.offset"])
        for one, value in zip(made.parameters, (8 * np.pi, 0.7, 1.1, 0.005)):
            self.assert_near(one, value)
        # An ideal rig has no servos; the effect on the ball exceeds the noise.
        self.assertGreater(made.ideal_rms["x"], 1.2 * made.residual_rms["x"])

    def test_a_loop_is_one_window(self):
        loop = TRUE_RIG.split("gimbal:")[0] + (
            "gimbal: {servo: {natural_frequency: 5 Hz, damping: 0.8}}\n"
            "controller: {gravity_compensation: {kp: 10, kv: 8}, drives: angle, "
            "reference: {lissajous: {amplitude: [5 cm, 4 cm], rate: [2.1, 3.3]}}}\n"
            "time: {end: 10, step: 50 ms}\noutput: {columns: [t, x, y, phi, theta]}\n")  # fmt: skip
        rows = rows_of(loop, 3e-4)
        random = np.random.default_rng(2)
        rows.update({name: rows[name] + 6e-5 * random.normal(size=rows[name].size) for name in ("phi", "theta")})
        self.put(rows, loop.replace("kp: 10, kv: 8", "kp: 9, kv: 8.5"))
        free = ["controller.gravity_compensation.kp", "controller.gravity_compensation.kv"]
        for options, windows in (({}, 1), ({"window": "2 s"}, 5)):
            made = self.fit(free, **options)
            self.assertEqual(made.windows, windows)
            self.assert_near(made.parameters[0], 10)
            self.assert_near(made.parameters[1], 8)

    def test_a_loop_with_noise_and_rounding(self):
        """Its noise is not the log's. The servo's dead band and backlash are those of its model."""
        rig = (CONFIGS / "rig.yaml").read_text()
        rig = rig[: rig.index("events:")] + "time: {end: 30, step: 50 ms}\noutput: {columns: [t, x, y, phi, theta]}\n"
        servo = {"gimbal.servo": {"model": "smart-serial"}}
        truth = {"gimbal.mounting.phi_offset": "0.6 deg", "controller.sensor.delay": "30 ms", "controller.sensor.seed": 8}
        made = bbsim.run(rig, {**servo, **truth}, output="log.csv")
        self.assertEqual(made.status, "done")
        fitted = bbsim.fit(rig, "log.csv", list(truth)[:2] + ["gimbal.servo.damping=0.3:3"], set=servo)
        offset, delay, damping = (its.estimate for its in fitted.parameters)
        self.assertAlmostEqual(offset, np.radians(0.6), delta=1e-3)
        self.assertAlmostEqual(delay, 0.03, delta=0.01)
        self.assertEqual(fitted.parameters[2].before, 1)
        self.assertIn("the fit leaves out noise, rounding, dead band and backlash in the loop", fitted.report)

    def test_several_starts_find_what_one_start_misses(self):
        # The minimum nearest to a delay of 0.9 s is another period of the motion.
        late = ASSUMED_RIG.replace("value: theta", "value: theta, delay: 0.9")
        self.put(rows_of(sd=5e-4), late.replace("radius: 1 cm", "radius: 1 cm, inertia_factor: 0.43"))
        self.assertGreater(abs(self.fit(THETA + "delay=-1:1").parameters[0].estimate), 0.1)
        self.assertAlmostEqual(self.fit(THETA + "delay=-1:1", starts=12).parameters[0].estimate, 0, delta=2e-3)


class Frame:
    """What bbsim needs of a pandas DataFrame."""

    def __init__(self, columns):
        self._columns, self.columns = columns, list(columns)

    def __getitem__(self, name):
        return self._columns[name]


class Tables(Case):
    def test_a_log_in_memory_is_that_of_a_file(self):
        rows = rows_of(sd=5e-4)
        rows["x"][3] = np.nan
        self.put(rows)
        for log in (rows, Frame(rows), {name: its.tolist() for name, its in rows.items()}):
            files = [{"logs": its, "json": f"{i}.json", "output": f"{i}.yaml"} for i, its in enumerate((log, ["log.csv"]))]
            ours, theirs = (self.fit("ball.inertia_factor", **one) for one in files)
            self.assertEqual(ours.report, theirs.report)
            self.assertEqual(Path("0.json").read_text(), Path("1.json").read_text())
        self.assertIn("#   log-1.csv\n", Path("0.yaml").read_text())
        two = self.fit("ball.inertia_factor", logs=[rows, "log.csv"])
        self.assertEqual((two.logs, two.windows), (["log-1.csv", "log.csv"], 20))

    def test_clocks_and_units(self):
        rows = rows_of(sd=5e-4)
        self.put(rows)
        expected = self.fit("ball.inertia_factor")
        hour = np.datetime64("2026-03-01T12:00:00", "ns")
        clock = hour + np.round(1e9 * rows["t"]).astype("timedelta64[ns]")
        for t, made in (("datetime", clock), ("seconds", clock - hour)):
            found = self.fit("ball.inertia_factor", logs={t: made, "px": 100 * rows["x"] + 5, "y": rows["y"]},
                             map=["x=0.01*px-0.05", "y=y"])  # fmt: skip
            self.assertAlmostEqual(found.parameters[0].estimate, expected.parameters[0].estimate, delta=1e-6)

    def test_what_is_refused(self):
        self.put(rows_of())
        for log, message in (
            ({"t": [0, 1], "x": [1]}, "column x: found 1 values; allowed: 2, as in t"),
            ({"t": [0, 1], "x": [[1, 2], [3, 4]]}, "column x: found an array of shape (2, 2)"),
            ({"t": [0, 1], "x": [[1], [3, 4]]}, "column x: found rows of different lengths"),
            ({"t": [0, 1], "x": ["\ud800", "b"]}, "a part of a character"),
            ({"t": [0, 1, 1.5], "phi": [1, 2, 3]}, "log-1.csv: has no column to compare"),
            ({"t": [0, 1, 1.5], "x": ["a", "b", "c"]}, "log-1.csv: column x: found texts"),
            ({"t": [0, 1, 1.5], "x": [np.inf, None, np.nan]}, "log-1.csv: found no finite numbers in x"),
            ({"ball": {"radius": 0.01}}, "found a scenario; allowed: a file, a table or a result"),
        ):  # fmt: skip
            self.refused(message, "ball.inertia_factor", logs=log)
        with self.assertRaisesRegex(bbsim.InputError, "^log-1.csv: nothing to draw"):
            bbsim.plot({"t": [0, 1], "x": [None, None]})

    def test_pictures_comparisons_and_pages(self):
        rows = rows_of()
        self.put(rows)
        figures = [bbsim.plot(log, map="x=x,y=y") for log in (rows, "log.csv")]
        lines = [[line.get_xydata().tolist() for axes in one.axes for line in axes.lines] for one in figures]
        self.assertEqual(*lines)
        made = bbsim.compare(rows, "log.csv", atol=0)
        self.assertTrue(made and "bbsim-" not in made.text, made.text)
        page = bbsim.replay("rig.yaml", data=[rows])
        self.assertIn("log-1.csv", page.html)
        self.assertNotIn("bbsim-logs-", page.html + "".join(page.notes))


class Intervals(Case):
    def test_growth_at_the_ends(self):
        # The inertia correlates with the sensor's scale. It may be held at its bound, which it leaves again.
        self.put(rows_of(sd=4e-3))
        for inertia in ("ball.inertia_factor", "ball.inertia_factor=0.3:0.38"):
            best = self.fit(["log.x.scale", "log.y.scale", inertia])
            one = {parameter.key: parameter for parameter in best.parameters}["log.x.scale"]
            held_at_bound = [one.at_bound for one in best.parameters if one.key == "ball.inertia_factor"]
            self.assertEqual(held_at_bound, ["=" in inertia])
            degrees = best.numbers - 5 * best.windows - 3
            for end in one.interval:
                there = self.fit([f"log.x.scale={end - 1e-7}:{end + 1e-7}", "log.y.scale", inertia])
                growth = sum((there.residual_rms[name] / best.residual_rms[name]) ** 2 - 1 for name in "xy")
                # Ends are found to a twentieth of the half-width, and the growth is its square. Student's t: 1.967.
                self.assertAlmostEqual(degrees / 2 * growth / 1.967**2, 1, delta=0.1)

    def test_intervals_leave_the_residuals_as_they_are(self):
        interval, costs = _fit_search.Search.interval, []

        def watched(search, *rest):
            costs.append([search.cost()])
            ends = interval(search, *rest)
            costs[-1].append(search.cost())
            return ends

        self.put({name: values[:61] for name, values in rows_of(sd=5e-4).items()}, ASSUMED_RIG.replace("end: 10", "end: 3"))
        with mock.patch.object(_fit_search.Search, "interval", watched):
            self.fit(["ball.inertia_factor", "log.x.scale", "log.y.scale", PHI + "delay"], window=1)
        self.assertEqual(len(costs), 4)
        for before, after in costs:
            self.assertEqual(before, after)

    def test_bounds(self):
        self.put(rows_of(sd=5e-4))
        one = self.fit("ball.inertia_factor=0.3:0.41").parameters[0]
        self.assertEqual((one.estimate, one.at_bound), (0.41, True))
        self.assertLessEqual(one.interval[1], 0.41)
        in_a_dict = self.fit({"ball.inertia_factor": (0.3, 0.41), PHI + "offset": None}).parameters
        self.assertEqual((in_a_dict[0].estimate, in_a_dict[0].at_bound, len(in_a_dict)), (0.41, True, 2))
        self.refused("threads: found -1", "ball.inertia_factor", threads=-1)
        key = bbsim._task.read_free_key
        given = bbsim._scenario.given("rig.yaml")
        for text, ends in (("-100:100 ms", (-0.1, 0.1)), ("5ms:0.06 s", (0.005, 0.06)), ("0.005:0.06", (0.005, 0.06))):
            its = key(PHI + "delay=" + text, given)
            self.assertEqual((its.lower, its.upper), ends)

    def test_keys_that_only_act_together_stay_near_their_start(self):
        self.put(rows_of(sd=5e-4, offset=0.01))
        free = [PHI + "offset", "gimbal.mounting.phi_offset", "ball.inertia_factor", "log.delay=0:0.1"]
        made = self.fit(free, json="f.json")
        offset, mounting = (one for one in made.parameters if "offset" in one.key)
        # Right: 0.01 rad in all.
        self.assertAlmostEqual(offset.estimate + mounting.estimate, 0.01, delta=2e-3)
        for one in (offset, mounting):
            self.assertLess(abs(one.estimate), 0.02)
            self.assertFalse(one.told)
        self.assertFalse(made.identifiable)
        words = f"{PHI}offset and gimbal.mounting.phi_offset cannot be told apart"
        self.assertTrue(any(words in note for note in made.notes), made.notes)
        self.assertTrue(all(note.replace("not identifiable: ", "") in made.report for note in made.notes))
        data = json.loads(Path("f.json").read_text())
        self.assertEqual(data["notes"], made.notes)
        self.assertEqual([one["sd"] is None for one in data["parameters"]].count(True), 2)
        self.assertEqual({one["at_bound"] for one in data["parameters"]}, {False})

    def test_coverage(self):
        # Of 10 logs: 99.9 % of the binomial distribution at 0.95 is above 6.
        free = ["ball.inertia_factor", PHI + "scale", PHI + "offset"]
        holds, white = np.zeros(3), 0
        for seed in range(10):
            self.put(rows_of(sd=5e-4, scale=1.1, offset=0.01, seed=seed))
            made = self.fit(free)
            holds += [a.interval[0] <= b <= a.interval[1] for a, b in zip(made.parameters, (0.43, 1.1, 0.01))]
            white += made.white
        self.assertTrue((holds >= 7).all(), holds)
        self.assertGreaterEqual(white, 9)

    def test_coverage_with_a_dead_band(self):
        # Which commands a servo follows changes in steps with their scale. A step of the residuals divided by a small
        # difference is no slope: the deviation of the scale was down to a thousandth of its scatter.
        truth = {"gimbal.servo.time_constant": 0.06, "controller.sampling.delay": 0.008,
                 "gimbal.mounting.phi_offset": np.radians(0.3), "controller.commands.phi.table.scale": 1}  # fmt: skip
        rig = ("ball: {{radius: 2 cm, position: [4 cm, 0]}}\n"
               "gimbal: {{servo: {{time_constant: {} ms, dead_band: 1 deg}}, mounting: {{phi_offset: {} deg}}}}\n"
               "controller: {{drives: angle, sampling: {{period: 20 ms, delay: {} ms}}, {}}}\n"
               "time: {{end: 5, step: 10 ms}}\noutput: {{columns: [t, x, y, phi_command, theta_command]}}\n")  # fmt: skip
        law = ("gravity_compensation: {{kp: 8, kv: 4}}, reference: {{circle: {{radius: 4 cm, rate: -2.5}}}}, "
               "sensor: {{noise: 0.3 mm, seed: {}}}")  # fmt: skip
        table = "commands: {phi: {table: {file: log.csv, time: t, value: u}}, theta: {table: {file: log.csv, time: t, value: v}}}"
        sums = np.zeros(len(truth))
        for seed in range(20):
            run, random = bbsim.run(rig.format(60, 0.3, 8, law.format(seed))), np.random.default_rng(seed)
            # The firmware logs each command when it computes it, half a sample before the next one.
            rows = {"t": run["t"][:-1:2], "u": run["phi_command"][1::2], "v": run["theta_command"][1::2]}
            rows.update((name, run[name][:-1:2] + 3e-4 * random.normal(size=250)) for name in ("x", "y"))
            self.put(rows, rig.format(45, 0, 12, table).replace("end: 5", "end: 4.98"))
            free = [f"{key}=0:60 ms" if key.endswith("delay") else key for key in truth]
            made = self.fit(free, window="5 s")
            sums += [((one.estimate - value) / one.sd) ** 2 for one, value in zip(made.parameters, truth.values())]
        # Chi-square with 20 degrees of freedom: 99.9 % below 45.3, and 99.9 % above 5.9.
        self.assertTrue(((sums > 5.9) & (sums < 45.3)).all(), sums)


class DeadBands(Case):
    """Servos that ignore changes of less than a degree, driven by a table of commands; whole logs without `window`."""

    DELAY, LAG = "controller.commands.phi.table.delay", "gimbal.servo.time_constant"

    def fit_of(self, t, u, v, free, end=8, window="20 s", delay=33, **believed):
        table = "{{table: {{file: u.csv, time: t, value: {}{}}}}}"
        rig = ("ball: {radius: 2 cm, position: [4 cm, 0]}\ngimbal: {servo: {time_constant: 60 ms, dead_band: 1 deg}}\n"
               "controller: {drives: angle, sampling: {period: 20 ms}, commands: {phi: "
               f"{table.format('u', f', delay: {delay} ms')}, theta: {table.format('v', '')}}}}}\n"
               f"time: {{end: {end}, step: 20 ms}}\noutput: {{columns: [t, x, y]}}\n")  # fmt: skip
        self.put({"t": t, "u": np.radians(u), "v": np.radians(v)}, file="u.csv")
        run, random = bbsim.run(rig), np.random.default_rng(1)
        self.put({"t": run["t"], **{name: run[name] + 3e-4 * random.normal(size=run["t"].size) for name in "xy"}}, rig)
        return self.fit(free, set=believed, window=window)

    def test_a_delay_in_another_valley(self):
        # The residuals have a valley for each period of 20 ms.
        t = 0.02 * np.arange(-50, 450)
        for u, v in ((3 * np.cos(5.3 * t), 3 * np.cos(4.1 * t)), (3 * np.sign(np.cos(5.3 * t)), 3 * np.sign(np.cos(4.1 * t)))):
            made = self.fit_of(t, u, v, self.DELAY + "=0:200 ms", delay=93, **{self.DELAY: 0})
            self.assertTrue(made.parameters[0].interval[0] <= 0.093 <= made.parameters[0].interval[1], made.report)
            self.assertLess(made.parameters[0].sd, 2e-4)
            self.assertTrue(made.identifiable, made.notes)

    def test_a_delay_that_no_sample_sees(self):
        # Commands that change every 100 ms: all delays between two samples give the same motion.
        t = 1e-3 * np.arange(-1000, 9000)
        steps = np.floor(t / 0.1 + 1e-6) * 0.1
        made = self.fit_of(t, 3 * np.cos(5.3 * steps), 3 * np.cos(4.1 * steps), self.DELAY + "=0:60 ms", **{self.DELAY: 0.01})
        one = made.parameters[0]
        self.assertTrue(0.02 <= one.interval[0] < 0.025 and 0.035 < one.interval[1] <= 0.04, one)
        self.assertFalse(made.identifiable)
        self.assertTrue(any("fit equally well: between them, the servos follow" in note for note in made.notes), made.notes)

    def test_windows_without_a_followed_command(self):
        t = 0.02 * np.arange(-50, 650)
        still = t > 6
        u, v = np.where(still, 0, 3 * np.cos(5.3 * t)), np.where(still, 0, 3 * np.cos(4.1 * t))
        made = self.fit_of(t, u, v, self.LAG + "=20:300 ms", 12, "4 s", **{self.LAG: 0.08})
        self.assertIn(f"note: 1 of 3 windows tell nothing of {self.LAG}: no command passes the dead band", made.report)
        self.assertTrue(made.parameters[0].told)
        made = self.fit_of(t, u / 4, v / 4, [self.LAG, self.DELAY], 12, "4 s", **{self.LAG: 0.08})
        self.assertFalse(made.identifiable)
        self.assertEqual([one.told for one in made.parameters], [False, False])
        np.testing.assert_allclose([one.estimate for one in made.parameters], [0.08, 0.033], rtol=1e-9)
        self.assertIn(f"not identifiable: {self.LAG} is not determined by the log: no command passes", made.report)


class Residuals(Case):
    def test_hold_out(self):
        self.put(rows_of(sd=5e-4))
        made = self.fit("ball.inertia_factor", window="2 s", hold_out=0.3)
        # floor(0.3 (i + 1)) > floor(0.3 i) for i = 3, 6, 9
        self.assertEqual((made.windows, made.held), (7, 3))
        for name in "xy":
            self.assertAlmostEqual(made.hold_out_rms[name] / 5e-4, 1, delta=0.25)

    def test_outliers(self):
        rows = rows_of(sd=5e-4)
        rows["x"][6::80] = 0.3  # as when the screen is not touched
        self.put(rows)
        free = ["ball.inertia_factor", PHI + "scale"]
        squares, huber = self.fit(free), self.fit(free, loss="huber")
        self.assertIn("; --loss huber gives such numbers less weight", squares.report)
        self.assertEqual(huber.outliers, {"x": 5, "y": 0})
        self.assertIn("the first at t = 0.3 s of log.csv", huber.report)
        for one, other, value in zip(huber.parameters, squares.parameters, (0.43, 1)):
            self.assertLess(one.sd, other.sd)
            self.assert_near(one, value)

    def test_the_next_key(self):
        self.put(rows_of(sd=5e-4, offset=0.01))
        made = self.fit("ball.inertia_factor")
        self.assertFalse(made.white)
        self.assertEqual(made.suggestion["key"], PHI + "offset")
        self.assertGreater(made.suggestion["residuals_smaller_by"], 0.25)
        self.assertIn(f"note: --free {PHI}offset could make the residuals", made.report)
        self.assertIsNone(self.fit(["ball.inertia_factor", PHI + "offset"]).suggestion)

    def test_kinks(self):
        # Made with ball.losses.rolling 0.012 and 0.3 mm of noise, and fitted without losses.
        for file in ("fit-hint.csv", "fit-hint-tilt.csv"):
            shutil.copy(DATA / file, ".")
        scene = ("ball: {radius: 2 cm, mass: 2.7 g, inertia_factor: 0.667, position: [-5 mm, 0]}\n"
                 "gimbal: {motion: {phi: {table: {file: fit-hint-tilt.csv, time: t_s, value: tilt_deg}}}}\n"
                 "time: {end: 4.8, step: 100 ms}\n")  # fmt: skip
        Path("rig.yaml").write_text(scene)
        made = self.fit(PHI + "offset", logs="fit-hint.csv")
        self.assertEqual(made.suggestion["key"], "ball.losses.rolling")
        made = self.fit([PHI + "offset", "ball.losses.rolling=0:0.1"], logs="fit-hint.csv")
        self.assertAlmostEqual(made.parameters[1].estimate, 0.012, delta=1e-3)
        self.assertAlmostEqual(made.residual_rms["x"] / 3e-4, 1, delta=0.2)

    def test_stuck(self):
        # A ball that hardly moves: all resistances from 0.0225 up hold it, with 1.9 mm of residuals; a fit that stays
        # where it starts has 20 to 45 mm.
        shutil.copy(DATA / "fit-stuck.csv", ".")
        Path("rig.yaml").write_text(
            "ball: {radius: 2 cm, mass: 2.7 g, inertia_factor: 0.667, position: [-6 mm, -52 mm], "
            "losses: {rolling: 0.01}}\n"
            "gimbal:\n  motion:\n    phi: {table: {file: fit-stuck.csv, time: t_s, value: tilt_x_deg}}\n"
            "    theta: {table: {file: fit-stuck.csv, time: t_s, value: tilt_y_deg}}\n"
            "time: {end: 4.6, step: 20 ms}\n")  # fmt: skip
        made = self.fit("ball.losses.rolling=0:0.05", logs="fit-stuck.csv", starts=2)
        one = made.parameters[0]
        self.assertLess(max(made.residual_rms.values()), 2.5e-3)
        self.assertGreater(one.estimate, 0.02)
        self.assertGreater(one.interval[1], 0.04)
        self.assertFalse(made.identifiable)
        self.assertTrue(any("starts end at" in note for note in made.notes), made.notes)

    def test_a_noise_free_log(self):
        run = bbsim.run(str(CONFIGS / "recorded.yaml"), set={"time.step": 0.02, "output.columns": ["t", "x", "y"]})
        self.put({name: np.array(run[name]) for name in ("t", "x", "y")})
        made = bbsim.fit(str(CONFIGS / "recorded.yaml"), "log.csv", "ball.inertia_factor")
        one = made.parameters[0]
        self.assertAlmostEqual(one.estimate, 0.4, delta=1e-9)
        self.assertTrue(np.isfinite([one.sd, *one.interval]).all())
        self.assertTrue(made.identifiable)

    def test_gaps_of_any_length(self):
        rows = rows_of(TRUE_RIG.replace("end: 20", "end: 4"), 5e-4)
        scene = "ball: {radius: 1 cm}\ngimbal: {motion: {phi: 0.01, theta: 0}}\ntime: {end: 10, step: 50 ms}\n"
        for last in (1.7e9, 1.7e12, 1e300):
            rows["t"][-1] = last
            self.put({name: rows[name] for name in "txy"}, scene)
            made = self.fit("ball.inertia_factor")
            self.assertEqual(made.windows, 2)
            self.assertEqual(made.numbers, 2 * 80)


class Windows(unittest.TestCase):
    @staticmethod
    def cut(*ends, share=0.0, step=0.1, fewest=4):
        logs = []
        for end in ends:
            times = step * np.arange(round(end / step) + 1)
            logs.append(_fit_windows.Log("log", times, np.zeros((1, times.size)), None))
        return _fit_windows.cut(logs, 2.0, share, fewest, 0.0)

    def test_cut(self):
        windows, held = self.cut(10, share=0.5)
        self.assertEqual((len(windows), len(held)), (3, 2))
        np.testing.assert_allclose(windows.begin, [0, 4, 8])
        np.testing.assert_allclose(held.begin, [2, 6])
        self.assertEqual(windows.rows[-1], 21)  # with the log's last row
        self.assertEqual(windows.rows.sum() + held.rows.sum(), 101)
        for ends, count in (((10.9,), 5), ((11.5,), 6), ((4, 6), 5)):
            self.assertEqual(len(self.cut(*ends)[0]), count)
        self.assertEqual(len(self.cut(4, step=1.0)[0]), 0)


class Command(Case):
    FREE = ("--free", "ball.inertia_factor")

    def recorded(self):
        settings = {"ball.inertia_factor": 0.6, "time.step": 0.02, "output.columns": ["t", "x", "y"]}
        run = bbsim.run(str(CONFIGS / "recorded.yaml"), set=settings)
        self.put({name: np.array(run[name]) for name in ("t", "x", "y")})
        return str(CONFIGS / "recorded.yaml")

    def test_a_page(self):
        rig = self.recorded()
        words = [rig, "log.csv", *self.FREE, "-q", "--report", "fit.html", "--json", "fit.json", "--hold-out", "0.5"]
        out, said = self.command("fit", *words)
        self.assertEqual(said, "")
        self.assertIn("ball.inertia_factor", out)
        page, data = Path("fit.html").read_text(), json.loads(Path("fit.json").read_text())
        self.assertIn("<title>Fit of A recorded motion, with a drift added</title>", page)
        for request in ("<script src", "stylesheet", 'src="http', 'href="http', "@import", "url(http"):
            self.assertNotIn(request, page)
        shown = json.loads(re.search('id="bbsim-data">(.*?)</script>', page, re.S)[1])
        self.assertEqual(shown["parameters"]["rows"][0][0], "ball.inertia_factor")
        self.assertAlmostEqual(float(shown["parameters"]["rows"][0][2]), data["parameters"][0]["estimate"], delta=1e-4)
        self.assertEqual(shown["place"], ["x", "y"])
        run = shown["runs"][0]
        self.assertEqual((run["rows"], run["every"]), (201, 1))
        times = np.frombuffer(base64.b64decode(run["time"]), "<f8")
        self.assertEqual(times.size, 201 + len(run["windows"]) - 1)  # a row without numbers between two windows
        self.assertTrue((np.diff(times) > 0).all())
        log, model, rest = (np.frombuffer(base64.b64decode(one["data"]), "<f4") for one in run["columns"][3:6])
        np.testing.assert_allclose(rest, model - log, atol=1e-7, equal_nan=True)
        squares = {}
        for window in run["windows"]:
            squares.setdefault(window["held"], []).extend(rest[window["first"] : window["last"] + 1] ** 2)
        for held, name in ((False, "residual_rms"), (True, "hold_out_rms")):
            self.assertAlmostEqual(np.sqrt(np.mean(squares[held])), data[name]["y"], delta=1e-7)  # of floats

    def test_files_are_whole_or_absent(self):
        rig = self.recorded()
        for words, code, message in (
            (["--report", "/dev/full"], 3, "/dev/full"), (["-o", "/dev/full"], 3, "/dev/full"),
            (["--json", "/dev/full"], 3, "/dev/full"), (["--report", "none/fit.html"], 3, "none/fit.html"),
            (["--report", "log.csv"], 2, "the log"), (["--report", rig], 2, "the scenario"),
            (["--report", bbsim._bbsim.file_of_template("fit.html")], 2, "the template of pages"),
            (["--report", "one", "-o", "./one"], 2, "--report"), (["--report", "-", "--json", "-"], 2, "--report"),
            (["--continuity"], 2, "--continuity"), (["--hold-out", "1"], 2, "--hold-out: found 1"),
            (["--starts", "0"], 2, "--starts"), (["--lost", "huber"], 2, "did you mean --loss?"),
        ):  # fmt: skip
            out, said = self.command("fit", rig, "log.csv", *self.FREE, "-q", *words, code=code)
            self.assertEqual(out, "", words)
            self.assertIn(message, said)
        self.assertEqual(sorted(os.listdir()), ["log.csv", "rig.yaml"])

    def test_no_command_overwrites_what_its_scenario_reads(self):
        self.put(rows_of())
        self.write("loop.yaml", """
ball: {radius: 1 cm}
gimbal: {servo: {natural_frequency: 10, damping: 1}}
controller:
  pd: {kp: [[0.7, 0], [0, -0.7]], kv: [[0.5, 0], [0, -0.5]]}
  drives: angle
  reference: {table: {file: table.csv, time: t, x: x, y: y}}
  sampling: {period: 20 ms}
time: {end: 1, step: 20 ms}
""")
        self.write("table.csv", "t,x,y\n0,0,0\n1,0.01,0\n2,0,0\n")
        free, bode = ["--free", "ball.inertia_factor"], ["plot", "loop.yaml", "--bode"]
        tune = ["tune", "loop.yaml", "--free", "ball.radius=0.01:0.02", "--minimize", "rms_x"]
        before = {name: self.read(name) for name in os.listdir()}
        for words in (
            ["fit", "rig.yaml", "other.csv", *free, "-o", "log.csv"],
            ["fit", "rig.yaml", "other.csv", *free, "--json", "./log.csv"],
            ["design", "rig.yaml", *free, "--length", "2", "--table", "log.csv"],
            [*tune, "-o", "table.csv"], [*tune, "--json", "table.csv"],
            [*bode, "-o", "a.svg", "--csv", "table.csv"], [*bode, "-o", "table.csv", "--format", "svg"],
        ):  # fmt: skip
            with self.subTest(words):
                self.assertIn("a table of the scenario", self.command(*words, code=2)[1])
        self.refuses("a table of the scenario", bbsim.plot, "rig.yaml", accuracy=True, csv="log.csv")
        self.assertEqual({name: self.read(name) for name in os.listdir()}, before)

    def test_a_full_disk_behind_standard_output(self):
        rig = self.recorded()
        with open("/dev/full", "w") as full:
            made = subprocess.run([cases.PROGRAM, "fit", rig, "log.csv", *self.FREE, "-q"], stdout=full,
                                  stderr=subprocess.PIPE, text=True)  # fmt: skip
        self.assertEqual(made.returncode, 3)
        self.assertEqual(made.stderr.count("\n"), 1)
        self.assertIn("standard output", made.stderr)

    def test_an_interrupt_keeps_the_best_so_far(self):
        self.put(rows_of(sd=5e-4, scale=1.1))
        advance = _fit_search.Search._advance

        def interrupted(search, u):
            advance(search, u)
            raise KeyboardInterrupt

        words = ["rig.yaml", "log.csv", *self.FREE, "--free", PHI + "scale", "-o", "fitted.yaml"]
        with mock.patch.object(_fit_search.Search, "_advance", interrupted):
            out, _ = self.command("fit", *words, code=130)
        self.assertIn("note: interrupted after 1 iteration: these are the best values so far", out)
        self.assertIn("Fitted by bbsim", Path("fitted.yaml").read_text())
        with mock.patch.object(_fit_windows, "simulate", side_effect=KeyboardInterrupt):
            out, said = self.command("fit", *words, code=130)
        self.assertEqual(out, "")
        self.assertIn("interrupted before the first result; nothing is written", said)

    def test_standard_output(self):
        rig = self.recorded()
        start = f"from bbsim._command import main; main('fit', {[rig, 'log.csv', *self.FREE]!r} + "
        for words, beginning in ((["--json", "-"], '{\n  "parameters"'), (["--report", "-"], "<!doctype html>")):
            program = [sys.executable, "-c", f"{start}{words!r})"]
            made = subprocess.run(program, capture_output=True, text=True, check=True)
            self.assertTrue(made.stdout.lower().startswith(beginning), made.stdout[:100])

    def test_a_log_on_standard_input(self):
        rig = self.recorded()
        words = ["fit", rig, "-", *self.FREE, "--set", "title='It''s a {plate}'", "-o", "fitted.yaml"]
        self.assertEqual(self.bbsim(*words, "--report", "fit.html", "-q", input=Path("log.csv").read_text()).stderr, "")
        self.assertIn("to\n#   -\n# ball.inertia_factor: 0.6", Path("fitted.yaml").read_text())
        self.assertIn("<title>Fit of It's a {plate}</title>", Path("fit.html").read_text().replace("&#39;", "'"))

    def test_what_a_fit_refuses(self):
        self.put(rows_of(sd=5e-4))
        radius = "ball.radius"
        for free, options, message in (
            ("ball.inertia_facter", {}, "did you mean ball.inertia_factor?"),
            ("ball.position.0", {}, "each window's start is fitted anyway"),
            ("ball.mass", {}, "ball.mass: has no effect on x, y"),
            ("ball.inertia_factor=2", {}, "allowed: FROM:TO"),
            ("ball.inertia_factor=0.5:0.3", {}, "allowed: FROM:TO with FROM below TO"),
            ([radius, radius], {}, "ball.radius is given twice"),
            (["log.delay", "log.delay"], {}, "log.delay is given twice"),
            (radius, {"window": -1}, "window: found"),
            (radius, {"hold_out": 1}, "hold_out: found 1"),
            (radius, {"loss": "cauchy"}, "loss: found 'cauchy'; allowed: squares or huber"),
            (radius, {"window": "60 ms"}, "0 numbers in 0 windows; allowed: more than the 1 that are sought, starts included; "
             "use a longer window or fewer free keys"),
            ({radius: [0.02, 0.01]}, {}, "free: ball.radius: found '0.02:0.01'"),
            ("log.phi.scale", {}, "allowed for a log: log.delay, log.x.scale, log.x.offset, log.y.scale"),
            ("log.delay=-1:1", {}, "allowed: values from 0"),
            (radius, {"set": {"time.end": 5}, "time_offset": "100 s"}, "tables cover"),
        ):  # fmt: skip
            self.refused(message, free, **options)
        rows = rows_of(sd=5e-4)
        late = ASSUMED_RIG.replace("time: t,", "time: t, time_offset: start,")
        self.put({**rows, "t": rows["t"] + 15}, late)
        self.refused("time_offset start moves the log", radius)
        self.fit(radius, time_offset="start")
        Path("log.csv").write_text("t,phi,theta\n0,0,0\n1,0,0\n2,0,0\n3,0,0\n10,0,0\n")
        self.refused("has no column to compare", radius)
        own = {"ball": {"radius": 0.01}, "controller": {"callable": lambda sample: (0, 0), "drives": "acceleration"}}
        with self.assertRaises(bbsim.InputError):
            bbsim.fit(own, "log.csv", radius)


if __name__ == "__main__":
    unittest.main()
