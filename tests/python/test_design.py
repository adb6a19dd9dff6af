# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Designs: bbsim.design and `bbsim design`. Needs BBSIM (the program) and BBSIM_SOURCE in the environment."""

import json
import os
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
from bbsim import _design, _result
from bbsim._experiment import Motions

INERTIA = "ball.inertia_factor"
SERVO = ["gimbal.servo.natural_frequency", "gimbal.servo.damping", INERTIA]
LEVEL = """
ball: {radius: 1 cm, mass: 33 g}
plate: {diameter: 30 cm}
gimbal: {motion: {phi: 0, theta: 0}}
time: {end: 3, step: 20 ms}
"""
# A plate above the gimbal's center, which moves the ball sideways as it tilts.
OPEN = """# Mine.
ball: {radius: 1 cm, mass: 33 g}
plate: {size: [30 cm, 30 cm]}
gimbal:
  mounting: {height: 2 cm}
  motion:  # as recorded
    phi: {table: {file: gone.csv, time: t, value: phi, scale: 1.1, offset: 0.004}}
    theta: 0
time: {end: 6, step: 20 ms}
output: {columns: [t, x, y]}
"""
COMMANDS = """
ball: {radius: 2 cm}
plate: {size: [30 cm, 24 cm]}
gimbal: {servo: {natural_frequency: 5 Hz, damping: 0.8}}
controller: {commands: {phi: 0, theta: 0}, drives: angle}
time: {end: 4, step: 20 ms}
"""
RIG = """
ball: {radius: 2 cm}
plate: {size: [32 cm, 32 cm]}
gimbal: {motion: {phi: 0, theta: 0}}
time: {end: 2, step: 20 ms}
"""


class Case(cases.Case):
    def design(self, *words, code=0):
        return self.command("design", *words, "-j", "2", code=code)

    def require_half_of(self, made, kind):
        for one in made.parameters:
            self.assertLessEqual(one.sd, 0.5 * getattr(one, kind), f"{one.key}\n{made.report}")

    def require_near(self, made, kind, expected, by=0.01):
        for one, its in zip(made.parameters, expected):
            self.assertLess(abs(getattr(one, kind) / its - 1), by, f"{one.key}: {kind}")


class Rigs(Case):
    """A designed log leaves at most half the deviations of the best circle, unless few keys are free. The deviations of
    circles and steps are those of the C++ design of commit 41547b38, which shared only the simulation with this one."""

    def test_high_plate(self):
        keys = [INERTIA, "gimbal.mounting.height", "gimbal.motion.phi.table.scale", "gimbal.motion.theta.table.scale"]
        settings = {"plate.size": "[30 cm, 30 cm]", "gimbal.mounting.height": "2 cm"}
        made = bbsim.design(CONFIGS / "recorded.yaml", keys, set=settings, length=6)
        self.require_half_of(made, "circle_sd")
        self.require_near(made, "circle_sd", [9.64852, 1.93820, 3.47347, 3.44987])
        self.assertLess(abs(made.parameters[1].step_sd / 0.338748 - 1), 0.02)
        self.assertIsNone(made.parameters[0].step_sd)
        # The same design had these deviations; 0.5 of the logarithm of the determinant is 6 % of each.
        ratios = [one.sd / old for one, old in zip(made.parameters, [0.0406, 0.00146, 0.0297, 0.0299])]
        self.assertLess(np.exp(np.mean(np.log(ratios))), 1.06)

    def test_beam(self):
        made = bbsim.design(CONFIGS / "beam.yaml", SERVO, set={"plate.size": "[60 cm, 10 cm]"})
        self.require_half_of(made, "circle_sd")
        self.require_half_of(made, "step_sd")
        self.require_near(made, "circle_sd", [92.7025, 3.23743, 0.485198], 0.02)
        self.require_near(made, "step_sd", [6.37157, 0.243557, 0.0771091])

    def test_hobby_rig(self):
        keys = ["gimbal.servo.natural_frequency", "gimbal.servo.damping", "controller.sampling.delay"]
        made = bbsim.design(CONFIGS / "rig.yaml", keys, length="4 s")
        self.require_half_of(made, "circle_sd")
        self.require_near(made, "circle_sd", [2.85103, 0.0194221, 0.00361744])
        self.require_near(made, "step_sd", [1.06996, 0.0184978, 0.00111408])
        self.assertEqual((made.noise.x, made.used.friction < 1), (made.noise.y, True))
        self.assertAlmostEqual(made.noise.x, np.hypot(0.2e-3, 0.32e-3 / np.sqrt(12)))
        self.assertEqual(len(made.sines.x), 4)

    def test_a_better_circle_is_named(self):
        for scenario in (CONFIGS / "hold.yaml", RIG):  # with a controller, and without
            made = bbsim.design(scenario, [INERTIA], length=1, set={"plate.size": "[30 cm, 30 cm]"})
            better = made.parameters[0].circle_sd < made.parameters[0].sd
            self.assertEqual("the circle determines the keys better" in made.report, better, made.report)

    def test_commands(self):
        made = bbsim.design(COMMANDS, SERVO)
        self.require_half_of(made, "circle_sd")
        self.require_near(made, "circle_sd", [11.7137, 0.305476, 0.0107125])
        self.require_near(made, "step_sd", [293.987, 7.14499, 0.0381384], 0.02)

    def test_limits_of_a_model_and_of_an_axis(self):
        servo = {"gimbal.servo": "{model: hobby-standard, theta: {rate_limit: 200 deg/s, angle_limit: 4 deg}}"}
        _, _, rates, *_ = limits = _design.limits_of(bbsim.given(CONFIGS / "rig.yaml", servo), None, None, None)
        self.assertEqual([limit[0] for limit in limits], ["edge", "tilt", "tilt_rate", "friction"])
        factors = [1 / factor for _, factor in rates[-1][::2]]
        np.testing.assert_allclose(np.degrees(factors), [0.95 * 60 / 0.17, 190], rtol=0.02)
        np.testing.assert_allclose([np.degrees(1 / factor) for _, factor in limits[1][-1][::2]], [11.4, 3.8])
        self.assertEqual(limits[1][3], "gimbal.servo.angle_limit")


class Written(Case):
    KEYS = [INERTIA, *(f"gimbal.motion.phi.table.{name}" for name in ("scale", "offset", "delay"))]

    def setUp(self):
        super().setUp()
        self.scenario = self.write("rig.yaml", OPEN)
        self.write("gone.csv", "t,phi\n0,0\n3,0\n6,0\n9,0\n")
        self.files = {name: str(self.folder / f"designed.{name}") for name in ("yaml", "json", "ino")}
        self.table = str(self.folder / "moves it's.csv")  # a name that YAML must quote

    def made(self, threads):
        return bbsim.design(
            self.scenario, self.KEYS, set={"ball.velocity": "[1 cm/s, 0]"}, max_tilt="8 deg", output=self.files["yaml"],
            table=self.table, json=self.files["json"], sketch=self.files["ino"], threads=threads,
        )  # fmt: skip

    def texts(self):
        return {name: Path(file).read_text() for name, file in (*self.files.items(), ("csv", self.table))}

    def test_what_is_written_and_its_fit(self):
        made = self.made(2)
        texts = self.texts()
        # The scenario keeps its comments, and free keys keep their values.
        for part in ("# Mine.", "# as recorded", "velocity: [0, 0]", "scale: 1.1, offset: 0.004", "time: {end: 6,"):
            self.assertIn(part, texts["yaml"])
        self.assertNotIn("gone.csv", texts["yaml"])
        # The ball stays on the plate, and the plate within its tilt. 60 deg/s is the default rate. Rounding the start
        # to a millimeter moves the path by little more.
        columns = ["x", "y", "phi", "theta", "phi_rate", "theta_rate"]
        run = bbsim.run(self.files["yaml"], {"output.columns": ["t", *columns]})
        for name, most in zip(columns, [0.12, 0.12, *np.radians([8, 8, 60, 60])]):
            self.assertLess(np.abs(run[name]).max(), 1.03 * most, name)
        np.testing.assert_allclose(run["phi"][[0, -1]], 0, atol=1e-6)
        self.assertGreater(max(made.used.edge, made.used.tilt), 0.9)
        result = json.loads(texts["json"])
        self.assertEqual([one["key"] for one in result["parameters"]], self.KEYS)
        self.assertEqual(result["parameters"][0]["sd"], made.parameters[0].sd)
        self.assertGreater(result["parameters"][0]["step_sd"], result["parameters"][0]["sd"])
        self.assertEqual((result["identifiable"], result["length"], result["rate"]), (True, 6, 50))
        self.assertEqual(result["noise"], {"x": 1e-3, "y": 1e-3})
        self.assertEqual([len(its) for its in result["sines"].values()], [4, 4])
        # A fit has the deviations that the design expects. It estimates the noise from 602 numbers, to 3 %; its
        # estimates change the derivatives by about as much.
        random = np.random.default_rng(5)
        rows = np.column_stack([run["t"], *(run[name] + random.normal(0, 1e-3, len(run["t"])) for name in ("x", "y"))])
        np.savetxt(self.folder / "log.csv", rows, delimiter=",", header="t,x,y", comments="")
        free = [word for key in self.KEYS for word in ("--free", key)]
        fitted = json.loads(self.bbsim("fit", "designed.yaml", "log.csv", *free, "--json", "-", "-q").stdout)
        for one, expected in zip(fitted["parameters"], made.parameters):
            self.assertLess(abs(one["sd"] / expected.sd - 1), 0.15, one["key"])
            self.assertLess(abs(one["estimate"] - expected.value), 3.9 * one["sd"], one["key"])
        # The same with any number of threads.
        self.made(1)
        self.assertEqual(texts, self.texts())

    def test_inseparable_keys(self):
        keys = ["gimbal.motion.phi.table.offset", "gimbal.mounting.phi_offset", INERTIA]  # two offsets of one angle
        made = bbsim.design(LEVEL, keys, noise="x=2mm")
        for key in keys[:2]:
            self.assertIn(f"not identifiable: {key}, which a log", made.report)
        self.assertEqual([one.sd is None for one in made.parameters], [True, True, False])
        self.assertFalse(made.identifiable)
        self.assertEqual(vars(made.noise), {"x": 2e-3, "y": 1e-3})

    def test_value_at_its_bound(self):
        made = bbsim.design(LEVEL, INERTIA, set={INERTIA: 0.67}, length=2)
        self.assertLess(made.parameters[0].sd, 0.00232)  # that of the C++ design

    def test_groove(self):
        keys = ["gimbal.motion.theta.table.scale", "gimbal.motion.theta.table.offset"]
        settings = {"ball.rolling_radius": "8 mm", "gimbal.motion": "{phi: 0, theta: 1 deg}"}
        made = bbsim.design(LEVEL, keys, set=settings, length=2)
        self.assertEqual((vars(made.noise), made.sines.phi, made.position[0]), ({"y": 1e-3}, [], 0))
        self.assertTrue(made.identifiable)

    def test_log_of_the_angle_in_windows(self):
        keys = ["gimbal.servo.natural_frequency", "gimbal.servo.damping"]
        rig, options = CONFIGS / "rig.yaml", {"length": 2, "noise": ["phi=0.1deg"]}
        whole, cut = (bbsim.design(rig, keys, **options, window=window) for window in (None, 1))
        self.assertIn("303 numbers in 1 window;", whole.report)
        self.assertIn("303 numbers in 2 windows;", cut.report)
        self.assertTrue(cut.identifiable)


class Refused(Case):
    def refuses(self, message, scenario=LEVEL, free=INERTIA, **options):
        super().refuses(message, bbsim.design, scenario, free, **{"length": "2 s", **options})

    def test_scenarios(self):
        self.refuses("plate: has no size, but the ball must stay on it", LEVEL.replace("plate: {diameter: 30 cm}", ""))
        torque = LEVEL.replace("{motion:", "{torque:").replace("30 cm}", "30 cm, inertia: [4e-3, 6e-3, 1e-2]}")
        self.refuses("gimbal.torque: found, which a design cannot choose", torque)
        program = {"controller.gravity_compensation": None, "controller.program": "{command: [true]}"}
        self.refuses("controller: found a program or library of your own", CONFIGS / "rig.yaml", set=program)
        leaning = {"gimbal.mounting.phi_offset": "5 deg"}
        self.refuses("without a motion, the ball or the plate goes beyond its limits", set=leaning)
        self.refuses("sketch: the scenario has a controller", CONFIGS / "rig.yaml", sketch="a.ino")
        sketch = {"length": 20, "rate": 500, "sketch": str(self.folder / "a.ino")}
        self.refuses("sketch: found 10001 rows; allowed: at most 8191", **sketch)
        self.assertEqual(os.listdir(self.folder), [])

    def test_keys(self):
        self.refuses("each window's start is fitted anyway", free="ball.position.0")
        self.refuses("ball.inertia_factor is given twice", free=[INERTIA, INERTIA])
        self.refuses("free: ball.mass: has no effect on x, y", free="ball.mass")
        self.refuses("free: found no key of the scenario", free="log.x.scale")

    def test_options(self):
        for option, value, message in (
            ("length", "0 s", 'length: found "0 s"'), ("length", "0.1 s", "allowed: a log of 16 to 100000 rows"),
            ("rate", -1, "rate: found -1"), ("noise", "ball=1", 'noise: found "ball=1"; allowed: COLUMN=SIZE'),
            ("noise", "phi_command=1deg", "noise: found phi_command, there is no controller"),
            ("margin", "15 cm", "margin: found 0.15 m; allowed: a length from 0 to below half the plate"),
            ("max_tilt", "8 cm", 'max_tilt: found "8 cm"'), ("window", "x", 'window: found "x"'),
        ):  # fmt: skip
            self.refuses(message, **{option: value})


class Command(Case):
    def setUp(self):
        super().setUp()
        self.write("rig.yaml", RIG)

    def test_scenario_table_and_json(self):
        out, _ = self.design("rig.yaml", "--free", INERTIA, "-o", "designed.yaml", "--json", "designed.json")
        self.assertRegex(out, r"(?s)ball\.inertia_factor.*begin with the ball at rest")
        self.assertEqual(json.loads(self.read("designed.json"))["parameters"][0]["key"], INERTIA)
        self.assertEqual(len(self.read("designed-motion.csv").splitlines()), 102)
        self.bbsim("run", "designed.yaml", "-q")
        for words, code, message in (
            (("-o", "a.yaml", "--table", "a.yaml"), 2, "--table: found a.yaml; allowed: FILE.csv"),
            (("-o", "-"), 2, "--table: found no file, and the scenario of -o must name one"),
            (("--json", "rig.yaml"), 2, "rig.yaml"),
            (("--json", "/dev/full"), 3, "/dev/full"),
        ):
            self.assertIn(message, self.design("rig.yaml", "--free", INERTIA, *words, code=code)[1])
        self.assertEqual(self.read("rig.yaml"), RIG)

    def test_table_in_another_folder(self):
        (self.folder / "tables").mkdir()
        self.design("rig.yaml", "--free", INERTIA, "-o", "designed.yaml", "--table", "tables/it.csv")
        self.assertIn("file: 'tables/it.csv'", self.read("designed.yaml"))
        self.bbsim("run", "designed.yaml", "-q")

    def test_interrupted(self):
        with mock.patch.object(_result._bbsim, "simulate", side_effect=KeyboardInterrupt):
            _, said = self.design("rig.yaml", "--free", INERTIA, "--table", "a.csv", code=130)
        self.assertEqual(said, "design: interrupted before the first result; nothing is written\n")
        self.assertEqual(os.listdir(self.folder), ["rig.yaml"])

    def test_sketch_on_the_board(self):
        self.design("rig.yaml", "--free", INERTIA, "--table", "it.csv", "--sketch", "play.ino", "-q")
        self.bbsim("sketch", "play.ino", "-o", "play.so")
        for name in ("wiring.yaml", "board.yaml"):
            shutil.copy(SOURCE / "tests/examples" / name, self.folder)
        said = self.bbsim("run", "board.yaml", "-o", "board.csv").stderr.splitlines()
        header, *log = [line[len("controller: ") :] for line in said if line.startswith("controller: ")]
        self.assertEqual(header, "t_ms,phi_deg,theta_deg,x_mm,y_mm")
        played = np.array([list(map(float, line.split(","))) for line in log])
        table = np.genfromtxt(self.folder / "it.csv", delimiter=",", skip_header=1)
        self.assertEqual(played.shape, (len(table), 5))
        # The sketch's loop may be a millisecond or two late; rounding is a thousandth of a degree.
        np.testing.assert_allclose(played[:, 0], 1000 * table[:, 0], atol=3)
        np.testing.assert_allclose(played[:, 1:3], np.degrees(table[:, 1:]), atol=0.0011)

    def test_only_the_table_is_printed(self):
        code = "import sys; from bbsim._command import main; sys.exit(main('design'))"
        words = [sys.executable, "-c", code, "-", "--free", INERTIA, "--table", "-", "-q"]
        lines = subprocess.run(words, input=RIG, check=True, capture_output=True, text=True).stdout.splitlines()
        self.assertEqual((len(lines), lines[0], lines[1], lines[101]), (102, "t,phi,theta", "0,0,0", "2,0,0"))


class Parts(Case):
    def test_deviations_are_infinite_for_keys_that_cannot_be_found(self):
        both = np.linalg.cholesky([[4, 1], [1, 2]]).T
        np.testing.assert_allclose(_design.deviations(both), np.sqrt([2 / 7, 4 / 7]))
        self.assertAlmostEqual(float(_design.merits(both)), np.log(7), 6)
        torn = np.array([[1, 1e3, 0], [0, 0, 2]])  # the first two keys enter only as a sum, whatever their scales
        np.testing.assert_allclose(_design.deviations(torn), [np.inf, np.inf, 0.5])
        self.assertTrue(np.isfinite(_design.merits(torn)))

    def test_sums_of_sines_begin_and_end_at_rest_and_leave_the_ball_at_rest(self):
        times = np.linspace(0, 6, 6001)
        for tilts, axes in ((True, [0, 1]), (False, [0, 1]), (True, [1])):
            rig = mock.Mock(tilts=tilts, axes=axes, length=6.0, highest=18)
            one = _design.Candidate(rig, np.random.default_rng(3), 3.0)
            periods = one.motion.waves[0, axes] * 6 / (2 * np.pi)
            np.testing.assert_allclose(periods, np.round(periods))
            motion = Motions(*one.changed(np.random.default_rng(4).normal(size=(1, len(one.turns))))[:2])
            values = motion.at(times)[0]
            size = np.abs(values).max()
            rates = np.gradient(values, times, axis=1)
            np.testing.assert_allclose(values[:, [0, -1]], 0, atol=1e-9)  # amplitudes are rounded to 1e-10
            np.testing.assert_allclose(rates[:, [0, -1]], 0, atol=0.02 * size)
            self.assertTrue((np.abs(values).max(1) > 0).tolist() == [axis in axes for axis in (0, 1)])
            if tilts:  # the mean velocity of x'' = tilt, from rest
                velocity = np.cumsum(values, axis=1) * 1e-3
                np.testing.assert_allclose(velocity.mean(1), 0, atol=1e-3 * np.abs(velocity).max())

    def test_step_rises_smoothly(self):
        rig = mock.Mock(axes=[0], length=10.0)
        phi, theta = _design.step(rig).at(np.empty(0))[0]
        np.testing.assert_allclose(phi[[50, 55, 500]], [0, 0.01, 0.01], atol=1e-12)
        self.assertFalse(theta.any())


if __name__ == "__main__":
    unittest.main()
