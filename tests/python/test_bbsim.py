# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package compared with the program. Needs BBSIM (the program) and BBSIM_SOURCE in the environment."""

import contextlib
import csv
import importlib.util
import io
import json
import math
import os
import pickle
import signal
import subprocess
import sys
import threading
import unittest
import warnings
from pathlib import Path

import cases
import numpy as np
from cases import CONFIGS, PROGRAM

import bbsim
from bbsim import _loops
from bbsim._scenario import given


def program(*words):
    return subprocess.run([PROGRAM, *map(str, words)], check=True, capture_output=True, text=True).stdout


def rows_of(text):
    header, *rows = csv.reader(io.StringIO(text))
    return {name: [row[i] for row in rows] for i, name in enumerate(header)}


def numbers_of(text):
    return {name: np.array([float(one) for one in column]) for name, column in rows_of(text).items()}


# The circle of fig2b with a sampled PD, which SampledPd repeats.
LOOP = {
    "gravity": 9.81,
    "ball": {"radius": "1 cm", "position": ["5 cm", 0]},
    "gimbal": {"servo": {"natural_frequency": 10, "damping": 1}},
    "controller": {
        "pd": {"kv": [[0.5, 0], [0, -0.5]], "kp": [[0.7, 0], [0, -0.7]]},
        "drives": "angle",
        "limit": 0.2,
        "reference": {"circle": {"radius": "5 cm", "rate": -0.3}},
        "sampling": {"period": "20 ms", "delay": "5 ms", "derivative_filter": "30 ms"},
        "sensor": {"noise": "0.2 mm", "resolution": "0.3 mm", "delay": "10 ms", "dropout": 0.05},
    },
    "time": {"end": 6, "step": 0.02},
    "output": {"columns": ["t", "x", "y", "phi", "theta", "phi_command", "theta_command"]},
}


def three_digits(number):
    """As bbsim prints margins: 2.25, 10.0, 0.129."""
    kept = float(f"{number:.3g}")
    return f"{kept:.{max(0, 2 - math.floor(math.log10(kept)))}f}" if number >= 1 else f"{number:.3g}"


class SampledPd:
    """The built-in PD, operation by operation."""

    def __init__(self, kp=0.7, kv=0.5, period=0.02, filter=0.03):
        self.kp, self.kv, self.period, self.filter = kp, kv, period, filter
        self.reset()

    def reset(self):
        self.position, self.velocity = [0.0, 0.0], [0.0, 0.0]
        self.seen, self.unseen, self.command = False, 0, (0.0, 0.0)

    def __call__(self, sample):
        if sample.ball is None:
            self.unseen += 1
            return self.command
        elapsed = (1 + self.unseen if self.seen else 1) * self.period
        keep = self.filter / (self.filter + elapsed)
        for i in range(2):
            difference = (sample.ball[i] - self.position[i]) / elapsed if self.seen else 0.0
            self.velocity[i] = keep * self.velocity[i] + (1.0 - keep) * difference
            self.position[i] = sample.ball[i]
        self.seen, self.unseen = True, 0
        rate = [sample.reference_rate[i] - self.velocity[i] for i in range(2)]
        error = [sample.reference[i] - self.position[i] for i in range(2)]
        u = [
            kp[0] * error[0] + kv[0] * rate[0] + (kp[1] * error[1] + kv[1] * rate[1])
            for kv, kp in (((self.kv, 0.0), (self.kp, 0.0)), ((0.0, -self.kv), (0.0, -self.kp)))
        ]
        self.command = tuple(min(max(one, -0.2), 0.2) for one in u)
        return self.command


def pickled(one):
    return pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(one))))


def repeated(scene, actions, first):
    """A run with an environment's actions, from its first observation: the result, and the samples."""
    given, heard = iter([*actions, actions[-1]]), []  # the sample at the end has the last commands

    def law(sample):
        heard.append(sample)
        return next(given)

    controller = {"callable": law, **{k: v for k, v in LOOP["controller"].items() if k not in ("pd", "sensor")}}
    return bbsim.run({**scene, "controller": controller}, {"ball.position.0": float(first)}), heard


def with_callable(function, **more):
    controller = {key: value for key, value in LOOP["controller"].items() if key != "pd"}
    return {**LOOP, "controller": {"callable": function, **controller}, **more}


# The parts of Gymnasium that an environment uses, in case it is not installed.
GYMNASIUM = {
    "__init__.py": """
from . import spaces, vector
registered = {}
class Env:
    def reset(self, *, seed=None, options=None): pass
def register(id, entry_point=None, vector_entry_point=None): registered[id] = entry_point, vector_entry_point
def make(id, **rest): return registered[id][0](**rest)
def make_vec(id, num_envs=1, **rest): return registered[id][1](num_envs=num_envs, **rest)
""",
    "spaces.py": """
class Box:
    def __init__(self, low, high, shape=None, dtype=None): self.low, self.high = low, high
""",
    "vector.py": """
import enum
class VectorEnv: pass
class AutoresetMode(enum.Enum): NEXT_STEP = "NextStep"
""",
}


class Runs(cases.Case):
    def test_equals_the_program(self):
        for name in ("fig2a", "fig2b", "rig", "step"):
            with self.subTest(name):
                file = CONFIGS / f"{name}.yaml"
                told = numbers_of(program("run", file, "-o", "-", "-q"))
                made = bbsim.run(file)
                self.assertEqual(made.columns, list(told))
                for column, values in told.items():
                    np.testing.assert_array_equal(made[column], values)
                    self.assertEqual(made[column].dtype, np.float64)

    def test_path_text_and_dict_are_alike(self):
        text = (CONFIGS / "fig2b.yaml").read_text()
        of_file = bbsim.run(str(CONFIGS / "fig2b.yaml"))
        np.testing.assert_array_equal(of_file["x"], bbsim.run(text)["x"])
        np.testing.assert_array_equal(bbsim.run(LOOP)["x"], bbsim.run(json.dumps(LOOP))["x"])

    def test_numpy_values_in_a_dict(self):
        scene = {**LOOP, "ball": {"radius": np.float64(0.01), "position": np.array([0.05, 0.0])}}
        np.testing.assert_array_equal(bbsim.run(scene)["x"], bbsim.run(LOOP)["x"])

    def test_set_and_error(self):
        file = CONFIGS / "fig2b.yaml"
        told = numbers_of(program("run", file, "--set", "ball.radius=2 cm", "--set", "ball.position=[0.04, 0.01]",
                                  "--error", "1 um", "-o", "-", "-q"))  # fmt: skip
        made = bbsim.run(file, {"ball.radius": "2 cm", "ball.position": (0.04, 0.01)}, "1 um")
        np.testing.assert_array_equal(made["x"], told["x"])
        self.assertLess(made.summary["error_estimate"], 1e-6)

    def test_columns_share_memory(self):
        made = bbsim.run(CONFIGS / "fig2b.yaml")
        x = made["x"]
        self.assertTrue(np.shares_memory(x, made["x"]))
        self.assertFalse(x.flags.owndata)
        end = x[-1]
        del made
        self.assertEqual(x[-1], end)

    def test_what_a_result_tells(self):
        made = bbsim.run(CONFIGS / "rig.yaml", measures=["max_tilt", "rms_x from 5 s"], expect="max_tilt < 0.5 deg")
        self.assertEqual(made.units["x"], "m")
        self.assertEqual(made.units["phi"], "rad")
        self.assertEqual(made.status, "done")
        self.assertEqual(made.summary["rows"], len(made))
        told = rows_of(program("run", CONFIGS / "rig.yaml", "-o", "/dev/null", "-q", "--measure",
                               "max_tilt,rms_x from 5 s"))  # fmt: skip
        self.assertEqual(list(made.measures), told["measure"])
        self.assertEqual([repr(float(v)) for v in told["value"]], [repr(v) for v in made.measures.values()])
        self.assertEqual(len(made.unmet), 1)
        self.assertEqual(made.events, made.summary["events"])
        self.assertIn("x", made)
        with self.assertRaisesRegex(KeyError, "there is no column 'z'"):
            made["z"]

    def test_a_stopped_run_is_a_result(self):
        made = bbsim.run(CONFIGS / "rig.yaml", {"plate.size": ["4 cm", "4 cm"], "ball.position": [0, 0]})
        self.assertEqual(made.status, "stopped")
        self.assertIn("edge", made.events[-1]["event"])
        self.assertTrue(made.reason)

    def test_output(self):
        for name in ("fig.csv", "fig.h5"):
            made = bbsim.run(CONFIGS / "fig2b.yaml", output=self.folder / name)
            self.assertTrue(Path(name).exists())
            if name.endswith(".csv"):
                np.testing.assert_array_equal(numbers_of(self.read(name))["x"], made["x"])
        with self.assertRaises(bbsim.OutputError):
            bbsim.run(CONFIGS / "fig2b.yaml", output=self.folder / "none" / "fig.csv")
        copy = self.write("copy.csv", (CONFIGS / "fig2b.yaml").read_text())
        self.refuses("copy.csv", bbsim.run, copy, output=copy)

    def test_for_notebooks(self):
        made = bbsim.run(CONFIGS / "fig2b.yaml", expect="max_tilt < 0.1 deg")
        shown = made._repr_html_()
        self.assertIn("max_tilt &lt; 0.1 deg", shown)
        self.assertIn("<svg", shown)
        self.assertIn("max_tilt", shown)
        self.assertIn("fig2b" if not made.summary["title"] else "Fig. 2(b)", repr(made))
        try:
            import pandas
        except ImportError:
            pass
        else:
            frame = made.to_pandas()
            self.assertIsInstance(frame, pandas.DataFrame)
            self.assertEqual(list(frame.columns), made.columns)

    def test_threads(self):
        scenes = [CONFIGS / "fig2b.yaml", CONFIGS / "rig.yaml", with_callable(SampledPd())]
        alone = [bbsim.run(scene)["x"].tobytes() for scene in scenes]
        found = []

        def work(number):
            scene = scenes[number % 2] if number % 3 else with_callable(SampledPd())
            found.append((alone[number % 2] if number % 3 else alone[2]) == bbsim.run(scene)["x"].tobytes())

        threads = [threading.Thread(target=work, args=(number,)) for number in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [True] * 8)


class Pages(cases.Case):
    def test_a_linearization_can_be_pickled(self):
        made = bbsim.linearize(CONFIGS / "rig.yaml", at=0.5)
        self.assertEqual(made.at, bbsim.linearize(CONFIGS / "rig.yaml", at="0.5 s").at)
        self.assertTrue(made.stable)
        self.assertFalse(bbsim.linearize(CONFIGS / "fig2b-literal.yaml").stable)
        again = pickled(made)
        self.assertEqual((repr(again), again.margins, again.kind), (repr(made), made.margins, made.kind))
        np.testing.assert_array_equal(again.A, made.A)
        for axis in ("phi", "theta"):
            np.testing.assert_array_equal(again.open_loop(axis).A, made.open_loop(axis).A)

    def test_odd_arguments(self):
        rig = CONFIGS / "rig.yaml"
        for bounds in ((0.03, 0.01), (float("nan"), 0.01)):
            with self.assertRaisesRegex(bbsim.InputError, "ball.radius: found .* in randomize; allowed: .low, high."):
                bbsim.VectorEnv(rig, 2, randomize={"ball.radius": bounds})
        for which in (-1, 2):
            with self.assertRaisesRegex(IndexError, f"which: found {which}; allowed: 0 to 1"):
                bbsim.VectorEnv(rig, 2).result(which)
        self.assertEqual(bbsim.sweep(rig, {"ball.radius": 0.01}, "max_tilt")["ball.radius"].tolist(), [0.01])

    def test_types_of_arguments(self):
        rig, result = CONFIGS / "rig.yaml", bbsim.run(LOOP)
        for name, call, *words in (
            *(("set", call, rig, "ball.radius=0.02") for call in (bbsim.run, bbsim.check, bbsim.linearize)),
            ("atol", lambda: bbsim.compare("a.csv", "b.csv", atol="1 mm")),
            ("vary", bbsim.sweep, rig, ["ball.radius=list:1"]), ("measures", bbsim.sweep, rig, {"gravity": [9]}, [1]),
            ("columns", bbsim.simulate, rig, {}, [1]), ("measures", bbsim.simulate, rig, {}, [], None, [1]),
            ("events", lambda: bbsim.simulate(rig, {}, "x", events="no")),
            ("n", bbsim.VectorEnv, rig, 1.5), ("randomize", bbsim.VectorEnv, rig, 4, [1]),
            ("scenario", bbsim.run, result), ("scenario", lambda: bbsim.plot(result, bode=True)),
            ("scenario", lambda: bbsim.plot(bbsim.linearize(rig), bode=True)),
        ):  # fmt: skip
            with self.subTest(name, words=words), self.assertRaisesRegex(TypeError, f"^{name}: found .*; allowed: "):
                call(*words)

    def test_values_of_arguments(self):
        rig, radius = CONFIGS / "rig.yaml", {"ball.radius": np.array(0.02)}
        env = bbsim.Env(rig)
        env.reset(seed=1)
        for message, call, *words in (
            ("cases: ball.radius: found", bbsim.simulate, rig, radius, ["x"]),
            ("root_locus: found ball.radius=1", lambda: bbsim.plot(rig, root_locus=("ball.radius", 1))),
            ("seed: found -1", bbsim.VectorEnv, rig, 4, None, -1), ("action: found an array of shape (1,)", env.step, [0.0]),
            ("at: found soon", lambda: bbsim.linearize(rig, at="soon")),
            ("samples: missing, but values are drawn; allowed: samples N", bbsim.sweep, rig, {"gravity": "normal:9:1"}),
            ("vary: found", lambda: bbsim.tune(rig, "gravity=9:10", "max_tilt", vary="x")), ("files: missing", bbsim.replay),
            ("found a scenario", bbsim.plot, LOOP), ("found a scenario", bbsim.compare, LOOP, "a.csv"),
        ):  # fmt: skip
            with self.subTest(message):
                self.refuses(message, call, *words)
        self.assertEqual(bbsim.sweep(rig, radius, "max_tilt")["ball.radius"].tolist(), [0.02])
        bbsim.plot(rig, root_locus={"ball.radius": (0.01, 0.02)})

    def test_a_result_can_be_pickled(self):
        made = bbsim.run(CONFIGS / "fig2a.yaml", measures="max_tilt")
        again = pickled(made)
        for name in made.columns:
            np.testing.assert_array_equal(again[name], made[name])
        for name in ("units", "summary", "measures", "status", "reason", "warnings", "unmet"):
            self.assertEqual(getattr(again, name), getattr(made, name))

    def test_comparisons_are_those_of_the_program(self):
        bbsim.run(CONFIGS / "fig2a.yaml", output="a.csv")
        bbsim.run(CONFIGS / "fig2a.yaml", set={"ball.radius": "2 cm"}, output="b.csv")
        self.assertTrue(bbsim.compare("a.csv", "a.csv"))
        made = bbsim.compare("a.csv", "b.csv", columns=["x", "phi"])
        self.assertFalse(made.alike)
        self.assertEqual(made.text, self.bbsim("compare", "a.csv", "b.csv", "--columns", "x,phi", code=1).stdout)
        log = bbsim.compare("a.csv", CONFIGS / "fig2a.yaml", atol=1e-9, set={"time.end": 21})
        self.assertTrue(log.alike, log.text)
        self.refuses("", bbsim.compare, "a.csv", "b.csv", set={"ball.radius": 1})

    def test_a_page_is_that_of_the_program(self):
        program("replay", CONFIGS / "fig2a.yaml", "-q", "-o", "program.html")
        page = bbsim.replay(CONFIGS / "fig2a.yaml", output="mine.html")
        self.assertEqual(page.html, self.read("mine.html"))
        # The rows and the scenario are the same; only the time that the run took differs.
        self.assertAlmostEqual(len(page.html), len(self.read("program.html")), delta=40)
        self.assertIn("<iframe", page._repr_html_())
        result = bbsim.run(CONFIGS / "fig2a.yaml")
        self.assertIn("Fig. 2(a)", bbsim.replay(result, title="Fig. 2(a) again").html)
        for scene in (LOOP, json.dumps(LOOP), with_callable(SampledPd())):
            stopped = bbsim.replay(scene, set={"plate.size": [0.08, 0.08], "events.edge": "stop", "title": "Mine"})
            self.assertIn("left the plate", stopped.reason)
            self.assertIn("Mine", stopped.html)
        self.refuses("ends in .html", bbsim.replay, CONFIGS / "fig2a.yaml", output="fig2a.yaml")
        bbsim.run(CONFIGS / "fig2a.yaml", output="run.csv")
        os.rename("run.csv", "run.html")
        self.refuses("output", bbsim.replay, "run.html", output="run.html")
        missing = self.refuses("none.yaml", bbsim.replay, CONFIGS / "none.yaml", CONFIGS / "neither.yaml")
        self.assertEqual(len(missing.problems), 2)

    def test_examples_run(self):
        files = bbsim.examples()
        self.assertIn("rig", files)
        self.assertEqual(bbsim.run(files["recorded"]).status, "done")


class Callables(cases.Case):
    def test_pd_equals_the_built_in_one(self):
        built_in, own = bbsim.run(LOOP), bbsim.run(with_callable(SampledPd()))
        for column in built_in:
            np.testing.assert_array_equal(own[column], built_in[column])

    def test_samples(self):
        samples = []

        def law(sample):
            samples.append(sample)
            return 0, np.float64(0.01)

        made = bbsim.run(with_callable(law, time={"end": 1, "step": 0.1}))
        self.assertEqual([one.sample for one in samples], list(range(len(samples))))
        self.assertEqual(samples[3].t, 3 * 0.02)
        self.assertEqual(samples[0]["reference"], samples[0].reference)
        with self.assertRaises(KeyError):
            samples[0]["ref"]
        self.assertEqual(made["theta_command"][-1], 0.01)
        self.assertIn("Python", bbsim.check(with_callable(law)))

    def test_columns_of_its_own(self):
        def law(sample):
            return 0, 0, {"twice": 2 * sample.t}

        made = bbsim.run(with_callable(law, output={"columns": ["t", "twice"]}))
        self.assertAlmostEqual(made["twice"][-1], 2 * made["t"][-1], delta=0.05)
        for wrong in ({"twice": math.nan}, {"twice": math.inf}, {"twice": "1"}, {}, None):
            with self.assertRaises(bbsim.ControllerError):
                bbsim.run(with_callable(lambda sample, wrong=wrong: (0, 0, wrong), output={"columns": ["t", "twice"]}))

    def test_what_it_raises(self):
        def law(sample):
            if sample.t > 0.5:
                raise ZeroDivisionError("no more")
            return 0, 0

        with self.assertRaisesRegex(bbsim.ControllerError, "at sample 26 .*ZeroDivisionError: no more") as caught:
            bbsim.run(with_callable(law))
        self.assertIsInstance(caught.exception.__cause__, ZeroDivisionError)
        for answer in (None, (1,), ("a", 0), (math.nan, 0), (1, 2, 3)):
            with self.assertRaisesRegex(bbsim.ControllerError, "its answer was"):
                bbsim.run(with_callable(lambda sample, answer=answer: answer))
        with self.assertRaises(bbsim.ControllerError):
            bbsim.sweep(with_callable(law), {"ball.radius": [0.01, 0.02]})

    def test_callables_may_call_bbsim_to_a_depth(self):
        depth = deepest = 0

        def nested(call):
            def law(sample):
                nonlocal depth, deepest
                depth += 1
                deepest = max(depth, deepest)
                try:
                    call(with_callable(law, time={"end": 0.02, "step": 0.02}))
                finally:
                    depth -= 1
                return 0, 0

            return with_callable(law)

        for call in (bbsim.run, lambda scene: bbsim.sweep(scene, {"ball.radius": [0.01]})):
            with self.assertRaises(bbsim.ControllerError) as raised:
                bbsim.run(nested(call))
            last = raised.exception
            while last.__cause__ is not None:
                last = last.__cause__
            self.assertIsInstance(last, RecursionError)
        bbsim.run(nested(bbsim.check))  # which only reports that the controller fails
        self.assertEqual(deepest, 8)
        inner = []

        def looks_ahead(sample):
            inner.append(bbsim.run(with_callable(lambda sample: (0, 0), time={"end": 0.1, "step": 0.02}))["x"][-1])
            return 0, 0

        self.assertEqual(bbsim.run(with_callable(looks_ahead, time={"end": 0.1, "step": 0.02})).status, "done")
        self.assertEqual(len(set(inner)), 1)

    def test_sweep(self):
        vary = {"ball.position.0": [0.01, 0.02, 0.03]}
        own, built_in = (bbsim.sweep(scene, vary, "end_x") for scene in (with_callable(SampledPd()), LOOP))
        np.testing.assert_allclose(own["end_x"], built_in["end_x"], rtol=0, atol=1e-6)

    def test_no_callable(self):
        self.refuses("", bbsim.run, with_callable(3), key="controller.callable")
        laws = with_callable(lambda sample: (0, 0))
        off = {"controller.sampling": None}
        for more, settings, key in (({"pd": 1}, {}, "callable"), ({}, off, "callable"), ({"library": {}}, {}, "library")):
            error = self.refuses("", bbsim.run, {**laws, "controller": {**laws["controller"], **more}}, settings)
            self.assertIn(f"controller.{key}", [problem.key for problem in error.problems])
            self.assertEqual("library" in str(pickled(error)), key == "library")

    def test_help_has_units(self):
        self.assertIn("rad", bbsim.Sample.__doc__)


class Sweeps(cases.Case):
    def test_equals_the_program(self):
        for file, vary, spec in (
            ("fig2a.yaml", {"ball.position.0": np.linspace(-0.1, 0.1, 41)}, "ball.position.0=linear:-0.1:0.1:41"),
            ("rig.yaml", {"ball.radius": ["1 cm", "2 cm"], "gravity": [9.8, 9.81]}, None),
        ):
            with self.subTest(file):
                words = []
                for key, values in vary.items():
                    listed = ",".join(v if isinstance(v, str) else repr(float(v)) for v in values)
                    words += ["--vary", f"{key}=list:{listed}"]
                told = rows_of(program("sweep", CONFIGS / file, *words, "-o", "-", "-q"))
                made = bbsim.sweep(CONFIGS / file, vary)
                self.assertEqual(list(made.dtype.names), list(told))
                for name in made.dtype.names:
                    if made.dtype[name].kind == "U":
                        self.assertEqual(made[name].tolist(), told[name])
                    else:
                        np.testing.assert_array_equal(made[name], np.array([float(v) for v in told[name]]))
                if spec is None:
                    continue
                np.testing.assert_allclose(made["end_time"], bbsim.sweep(CONFIGS / file,
                                           dict([spec.split("=")]))["end_time"])  # fmt: skip

    def test_expectations(self):
        made = bbsim.sweep(CONFIGS / "fig2a.yaml", {"ball.position.0": [0, 0.2]}, "end_x", expect="max_x < 15 cm")
        self.assertEqual(made.dtype.names[-2:], ("max_x", "expect: max_x < 15 cm"))
        self.assertEqual(made["expect: max_x < 15 cm"].tolist(), [1, 0])

    def test_numbers_that_the_program_refuses(self):
        fine = {"samples": 3, "seed": 5, "threads": 1}
        vary = {"ball.radius": "uniform:0.01:0.02"}
        self.assertEqual(len(bbsim.sweep(CONFIGS / "fig2b.yaml", vary, "end_x", **fine)), 3)
        self.assertEqual(len(bbsim.sweep(CONFIGS / "fig2b.yaml", {"title": ["one, it's", "two"]}, "end_x")), 2)
        wrong = [0, -1, 2.5, math.nan, math.inf, 1e300]
        for name, values in (("samples", [*wrong, None]), ("seed", wrong[1:]), ("threads", [*wrong[1:], 2**62])):
            for value in values:
                with self.subTest(name, value=value):
                    self.refuses("", bbsim.sweep, CONFIGS / "fig2b.yaml", vary, "end_x", **{**fine, name: value}, key=name)
            with self.assertRaisesRegex(TypeError, f"^{name}: found 'x'; allowed: a whole number"):
                bbsim.sweep(CONFIGS / "fig2b.yaml", vary, "end_x", **{**fine, name: "x"})

    def test_measures_and_draws(self):
        made = bbsim.sweep(CONFIGS / "fig2b.yaml", {"ball.position.0": "normal:5 cm:2 mm"}, ["max_tilt", "end_x"],
                           samples=5, seed=3)  # fmt: skip
        self.assertEqual(made.shape, (5,))
        self.assertEqual(made.dtype.names[-2:], ("max_tilt", "end_x"))
        self.assertEqual(made["case"].tolist(), [0, 1, 2, 3, 4])
        self.assertEqual(made["case"].dtype, np.int64)


class Linear(cases.Case):
    def test_margins_are_measures(self):
        made = bbsim.run(CONFIGS / "rig.yaml", {"time.end": 1}, measures=["phi_delay_margin", "x_bandwidth", "max_tilt"])
        margin = made.measures["phi_delay_margin"]
        self.assertGreater(margin, 0)
        self.assertEqual(made.measures["x_bandwidth"], float("inf"))  # feedforward has unlimited bandwidth
        # These need no run of a case.
        gains = bbsim.sweep(CONFIGS / "rig.yaml", {"controller.gravity_compensation.kp": [8.0, 90.0]},
                            ["phi_delay_margin", "stable"])  # fmt: skip
        self.assertEqual(gains["phi_delay_margin"][0], margin)
        self.assertTrue(np.isnan(gains["phi_delay_margin"][1]))
        self.assertEqual(gains["stable"].tolist(), [1, 0])
        self.assertTrue(np.isnan(gains["end_time"]).all())

    def test_equals_the_program(self):
        for name in ("fig2b", "rig"):
            program("linearize", CONFIGS / f"{name}.yaml", "-o", "linear.json")
            told = json.loads(self.read("linear.json"))
            made = bbsim.linearize(CONFIGS / f"{name}.yaml")
            for matrix in "ABCD":
                np.testing.assert_array_equal(getattr(made, matrix), np.array(told[matrix]))
            self.assertEqual(made.dt, told["period"])
            self.assertEqual(made.states, [one for one in told["states"]])
            self.assertEqual(len(made.poles), len(told["poles"]))
        self.assertIsNone(bbsim.linearize(CONFIGS / "fig2b.yaml", kind="plant").dt)
        self.refuses("", bbsim.linearize, CONFIGS / "fig2b.yaml", kind="plants")

    def test_scipy(self):
        try:
            from scipy.linalg import solve_continuous_are
        except ImportError:
            self.skipTest("there is no SciPy")
        plant = bbsim.linearize(CONFIGS / "fig2b.yaml", kind="plant")
        self.assertEqual(plant.margins, {})
        self.assertEqual(plant.to_scipy().A.shape, plant.A.shape)
        self.assertEqual(plant.B.shape, (len(plant.states), 2))
        spin_free = [i for i, name in enumerate(plant.states) if name != "spin"]
        a, b = plant.A[np.ix_(spin_free, spin_free)], plant.B[spin_free]
        cost = solve_continuous_are(a, b, np.eye(len(a)), np.eye(2))
        self.assertTrue(np.all(np.linalg.eigvals(a - b @ b.T @ cost).real < 0))


class Environments(cases.Case):
    SCENE = {**LOOP, "time": {"end": 0.5, "step": 0.02}, "plate": {"size": ["20 cm", "20 cm"]},
             "events": {"edge": "stop"}}  # fmt: skip

    def test_a_range_that_is_none_is_refused_at_once(self):
        for wrong in ("1 cm", ("1 cm", "2 cm"), 0.01, (0.01, 0.02, 0.03)):
            self.refuses("", bbsim.VectorEnv, self.SCENE, 2, {"ball.position.0": wrong}, key="ball.position.0")

    def test_equals_a_run_with_the_same_actions(self):
        envs = bbsim.VectorEnv(self.SCENE, 3, {"ball.position.0": (0.03, 0.05)}, seed=5, record=True,
                               set={"controller.sensor": None})  # fmt: skip
        observations, _ = envs.reset()
        first = observations[:, 0].copy()
        actions = np.random.default_rng(1).uniform(-0.05, 0.05, (25, 3, 2))
        seen = [observations]
        for action in actions:
            observations, _, terminated, truncated, _ = envs.step(action)
            seen.append(observations)
            self.assertEqual(truncated.any(), len(seen) > 25)
        self.assertTrue(truncated.all())
        self.assertFalse(terminated.any())
        for i in range(3):
            made, heard = repeated(self.SCENE, actions[:, i], first[i])
            for column in made:
                np.testing.assert_array_equal(envs.result(i)[column], made[column])
            np.testing.assert_array_equal([s.ball for s in heard], [o[i, :2] for o in seen[: len(heard)]])

    def test_lanes_equal_runs_with_the_same_actions(self):
        n = 11
        envs = bbsim.VectorEnv(self.SCENE, n, {"ball.position.0": (0.03, 0.05)}, seed=5, set={"controller.sensor": None})
        seen = [envs.reset()[0]]
        self.assertEqual(envs._runs.in_lanes, n)
        actions = np.random.default_rng(1).uniform(-0.05, 0.05, (25, n, 2))
        for action in actions:
            observations, _, _, truncated, _ = envs.step(action)
            seen.append(observations)
        self.assertTrue(truncated.all())
        for i in range(n):
            made, heard = repeated(self.SCENE, actions[:, i], seen[0][i, 0])
            self.assertEqual(len(heard), 26)
            for sample, observation in zip(heard, seen):
                np.testing.assert_allclose(observation[i, :2], sample.ball, rtol=0, atol=1e-9)
                np.testing.assert_allclose(observation[i, 7:9], sample.servo, rtol=0, atol=1e-12)
                self.assertEqual(observation[i, 3:5].tolist(), list(sample.reference))
            result = envs.result(i)
            self.assertEqual((result.status, result.summary["end_time"]), (made.status, made.summary["end_time"]))
        envs.step(actions[0])
        self.assertIsNone(envs.result(0))

    def test_lanes_equal_single_runs(self):
        rig = {"controller.sensor.noise": 0, "controller.sensor.resolution": 0, "time.end": 1}
        rigs = {
            "ball.position.0": (0.03, 0.07), "ball.radius": (0.015, 0.025),
            "gimbal.servo.natural_frequency": (25, 38), "controller.sampling.delay": (0, 0.015),
        }  # fmt: skip
        alone = {key: range_ for key, range_ in rigs.items() if key != "controller.sampling.delay"}
        servo = {"natural_frequency": "5 Hz", "damping": 0.8}
        accelerations = {
            "controller.gravity_compensation": None, "gimbal.servo": None, "controller.drives": "acceleration",
            "controller.sampling.resolution": None,
            "controller.pd": {"kv": [[0.5, 0], [0, -0.5]], "kp": [[0.7, 0], [0, -0.7]]}, "controller.limit": 3,
        }  # fmt: skip
        small = {"plate.size": ["14 cm", "14 cm"]}
        legs = {"radius_base": "6 cm", "radius_plate": "9 cm", "horn": "4 cm", "rod": "10 cm", "height": "11 cm"}
        crooked = {"gimbal.mounting": {"height": "2 cm", "skew": "3 deg", "yaw": "5 deg", "base_tilt": "1 deg"}}
        for name, drawn, settings, ends in (
            ("as it is", rigs, {}, "both"),
            ("each ends at its own time", {**rigs, "time.end": (0.3, 1)}, {}, "both"),
            ("between samples", rigs, {"time.end": 0.503}, "truncated"),
            ("events that are noted", rigs, {"events.slip": {"friction": 0.1, "action": "note"}}, "both"),
            ("an event that stops", rigs, {"events.tilt": {"limit": "8 deg", "action": "stop"}}, "both"),
            ("no delay", alone, {"controller.sampling.delay": 0}, "both"),
            ("a delay of some periods", alone, {"controller.sampling.delay": "50 ms"}, "both"),
            ("exposures between", rigs, {"controller.sensor.delay": "3 ms"}, "both"),
            ("a camera", rigs, {"controller.sensor.period": "33 ms"}, "both"),
            ("servos of first order", {}, {"gimbal.servo": {"time_constant": "50 ms", "rate_limit": "100 deg/s"}}, "both"),
            ("limits", {}, {"gimbal.servo": {**servo, "rate_limit": "20 deg/s", "angle_limit": "4 deg"}}, "both"),
            ("a limit of the acceleration", {}, {"gimbal.servo": {**servo, "acceleration_limit": 20}}, "both"),
            ("backlash", rigs, {"gimbal.servo.backlash": "0.5 deg"}, "both"),
            ("accelerations", {"ball.position.0": (0.03, 0.07)}, accelerations, "truncated"),
            ("push rods", rigs, {"gimbal.linkage": {"horn": "2.4 cm", "arm": "6 cm", "offset": ["-1.6 cm", "7 cm"]}}, "both"),
            ("three legs", rigs, {"gimbal.three_servos": legs}, "both"),
            ("other balls on a crooked gimbal", {**rigs, "ball.inertia_factor": (0.4, 0.667)}, crooked, "both"),
            ("a small plate", rigs, {**small, "time.end": 5}, "terminated"),
        ):
            with self.subTest(name):
                envs, single = (
                    bbsim.VectorEnv(CONFIGS / "rig.yaml", 19, drawn, set={**rig, **settings}, record=record)
                    for record in (False, True)
                )
                np.testing.assert_allclose(envs.reset(seed=7)[0], single.reset(seed=7)[0], rtol=0, atol=1e-12)
                self.assertEqual([envs._runs.in_lanes, single._runs.in_lanes], [19, 0])
                random = np.random.default_rng(1)
                tilts = random.uniform(-0.1, 0.1, (19, 2))
                ended = np.zeros(2, int)
                for _ in range(120):
                    actions = tilts + random.uniform(-0.1, 0.1, (19, 2))
                    one, other = envs.step(actions), single.step(actions)
                    np.testing.assert_array_equal(one[2], other[2])
                    np.testing.assert_array_equal(one[3], other[3])
                    np.testing.assert_allclose(one[0], other[0], rtol=0, atol=1e-9)
                    np.testing.assert_allclose(one[1], other[1], rtol=0, atol=1e-9)
                    ended += one[2].sum(), one[3].sum()
                self.assertEqual(envs._runs.in_lanes, 19)
                self.assertTrue(ended[0] > 0 or ends == "truncated")
                self.assertTrue(ended[1] > 0 or ends == "terminated")

    def test_noise_in_lanes_is_that_of_single_runs(self):
        envs, single = (bbsim.VectorEnv(CONFIGS / "rig.yaml", 8, record=record) for record in (False, True))
        envs.reset(seed=3), single.reset(seed=3)
        for _ in range(50):
            one, other = (each.step(np.zeros((8, 2)))[0] for each in (envs, single))
            # A rounding difference could cross a sensor step, but does not here.
            np.testing.assert_array_equal(one[:, :3], other[:, :3])

    def test_what_lanes_cannot_carry(self):
        for settings in ({"time.end": 1e5}, {"solver.method": "bdf"}, {"ball.mass": "50 g", "ball.losses.viscous": 1e-6}):
            with self.subTest(settings):
                envs = bbsim.VectorEnv(CONFIGS / "rig.yaml", 9, set=settings)
                envs.reset(seed=1)
                self.assertEqual(envs._runs.in_lanes, 0)
                observations = envs.step(np.zeros((9, 2)))[0]
                self.assertTrue(np.isfinite(observations).all() and observations[:, 0].all())
        some = bbsim.VectorEnv(CONFIGS / "rig.yaml", 16, {"time.end": lambda random: random.choice([1.0, 1e5])})
        some.reset(seed=1)
        self.assertIn(some._runs.in_lanes, range(1, 16))
        for _ in range(60):
            _, _, terminated, truncated, _ = some.step(np.zeros((16, 2)))
        self.assertIn(some._runs.in_lanes, range(1, 16))

    def test_a_rig_that_leaves_its_lane_takes_one_step(self):
        free = {"controller.limit": None, "gimbal.servo.angle_limit": None, "gimbal.servo.rate_limit": None, "events": None}
        envs, single = (bbsim.VectorEnv(CONFIGS / "rig.yaml", 16, set=free, record=record) for record in (False, True))
        envs.reset(seed=1), single.reset(seed=1)
        actions = np.random.default_rng(0).uniform(-1e5, 1e5, (16, 2))  # rad: the plate turns many times in a period
        one, other = envs.step(actions), single.step(actions)
        self.assertLess(envs._runs.in_lanes, 16)
        np.testing.assert_array_equal(one[2], other[2])
        np.testing.assert_allclose(one[0], other[0], rtol=1e-8, atol=1e-8)  # the solver's tolerance

    def test_some_lanes_begin_anew(self):
        envs = bbsim.VectorEnv(self.SCENE, 9, set={"controller.sensor": None})
        observations, _ = envs.reset(seed=1)
        first = observations.copy()
        for _ in range(5):
            envs.step(np.full((9, 2), 0.1))
        mask = np.arange(9) % 2 == 0
        again, _ = envs.reset(options={"reset_mask": mask})
        np.testing.assert_array_equal(again[mask], first[mask])
        self.assertTrue((again[~mask, 0] != first[~mask, 0]).all())

    def test_seeds(self):
        def episode(n, seed, envs=None):
            envs = envs or bbsim.VectorEnv(self.SCENE, n, {"ball.position.1": (-0.01, 0.01)})
            observations, _ = envs.reset(seed=seed)
            return np.stack([observations] + [envs.step(np.zeros((n, 2)))[0] for _ in range(60)])

        for n in (2, 20):
            np.testing.assert_array_equal(episode(n, 3), episode(n, 3))
            self.assertFalse(np.array_equal(episode(n, 3), episode(n, 4)))
            self.assertTrue(np.isfinite(episode(n, 3)).all())
        envs = bbsim.VectorEnv(self.SCENE, 20, {"ball.position.1": (-0.01, 0.01)})
        np.testing.assert_array_equal(episode(20, 3, envs), episode(20, 3, envs))

    def test_episodes_begin_by_themselves(self):
        envs = bbsim.VectorEnv(self.SCENE, 2, seed=1)
        envs.reset()
        ends = []
        for step in range(80):
            observations, rewards, terminated, truncated, _ = envs.step(np.zeros((2, 2)))
            self.assertEqual(observations.shape, (2, 11))
            if ends and ends[-1] == step - 1:
                self.assertEqual(rewards.tolist(), [0.0, 0.0])
            if truncated.all():
                ends.append(step)
        self.assertGreater(len(ends), 1)

    def test_an_episode_has_a_step_for_each_period(self):
        for n in (1, 8):
            for end, steps in ((2, 100), (0.3, 15), (0.503, 26), (0.01, 1)):
                envs = bbsim.VectorEnv(CONFIGS / "rig.yaml", n, set={"time.end": end})
                envs.reset(seed=1)
                ends = [envs.step(np.zeros((n, 2)))[3] for _ in range(steps)]
                self.assertTrue(ends.pop().all())
                self.assertFalse(np.any(ends))

    def test_to_end_an_episode_does_not_pay(self):
        tilt = {"events": {"tilt": {"limit": "5 deg", "action": "stop"}}, "time.end": 1}
        corner = 0.16**2 + 0.12**2
        nearest = (0.12 - 0.05) ** 2  # of the edge to a reference within 5 cm
        for settings, edge in (
            ({"time.end": 3}, corner),
            (tilt, nearest),
            ({**tilt, "plate": {"diameter": "24 cm", "inertia": [4e-3, 6e-3, 1e-2]}}, nearest),
            ({**tilt, "plate": None, "output": None}, nearest),
        ):
            for n in (1, 8):
                envs = bbsim.VectorEnv(CONFIGS / "rig.yaml", n, set=settings)
                period, end = 0.02, settings["time.end"]
                for wait in (0, 10):  # steps before the ball is thrown off
                    envs.reset(seed=1)
                    rewards, terminated = [], np.zeros(n, bool)
                    while not terminated.all():
                        action = 0.2 if len(rewards) >= wait else 0
                        _, reward, terminated, truncated, _ = envs.step(np.full((n, 2), action))
                        self.assertFalse(truncated.any())
                        rewards.append(reward)
                    left = round(end / period) - len(rewards) + 1
                    self.assertTrue((rewards[-1] <= -left * edge).all(), (settings, n, rewards[-1]))
                    self.assertTrue((np.array(rewards[:-1]) > -corner).all())
        own = bbsim.VectorEnv(CONFIGS / "rig.yaml", 2, reward=lambda o, a, terminated: -1.0 * terminated)
        own.reset()
        self.assertEqual(own.step(np.full((2, 2), 0.2))[1].tolist(), [-1, -1])

    def test_what_a_reward_takes_and_gives(self):
        rig, shapes = CONFIGS / "rig.yaml", []
        for n in (1, 8):
            for wrong in (np.zeros((n, 1)), np.zeros((n, n)), np.zeros(n + 1), 0.0):
                envs = bbsim.VectorEnv(rig, n, reward=lambda *batch, wrong=wrong: wrong)
                envs.reset()
                self.refuses("reward: found an array of shape", envs.step, np.zeros((n, 2)))
        env = bbsim.Env(rig, reward=lambda *its: shapes.append([one.shape for one in its]) or 2.5)
        env.reset()
        self.assertEqual((env.step([0, 0])[1], shapes), (2.5, [[(11,), (2,), ()]]))
        of_all = bbsim.VectorEnv(rig, 1)
        self.assertEqual((env.command_unit, env.observation_columns), (of_all.command_unit, of_all.observation_columns))
        self.assertIn("bbsim.Env", repr(env))

    def test_a_mask_has_a_boolean_for_each_run(self):
        for n in (2, 8):
            envs = bbsim.VectorEnv(CONFIGS / "rig.yaml", n)
            envs.reset(seed=1)
            for mask in (np.ones(n + 1, bool), np.ones(n - 1, bool), np.ones((n, 1), bool), np.arange(n), True, "x"):
                self.refuses("", envs.reset, options={"reset_mask": mask}, key="reset_mask")
            envs.reset(options={"reset_mask": [True] * n})

    def test_a_call_within_a_call_is_refused(self):
        inside, goes_on = threading.Event(), threading.Event()

        def reward(observations, actions, terminated):
            inside.set()
            self.assertTrue(goes_on.wait(60))
            for call in (envs.reset, envs.result, lambda: envs.step(np.zeros((8, 2)))):
                with self.assertRaisesRegex(RuntimeError, "one call"):
                    call()
            return np.zeros(8)

        envs = bbsim.VectorEnv(CONFIGS / "rig.yaml", 8, reward=reward)
        envs.reset(seed=1)
        made = []
        other = threading.Thread(target=lambda: made.append(envs.step(np.zeros((8, 2)))))
        other.start()
        self.assertTrue(inside.wait(60))
        with self.assertRaisesRegex(RuntimeError, "one call"):
            envs.step(np.zeros((8, 2)))
        goes_on.set()
        other.join()
        self.assertEqual(len(made), 1)
        envs.step(np.zeros((8, 2)))

    def test_a_reset_that_raises_changes_no_run(self):
        for n in (3, 9):  # alone, in lanes
            drawn = []

            def radius(random):
                drawn.append(0.01)
                return -1 if len(drawn) == n + n // 2 else 0.01

            scene = {**self.SCENE, "controller": {k: v for k, v in LOOP["controller"].items() if k != "sensor"}}
            envs = bbsim.VectorEnv(scene, n, {"ball.radius": radius})
            same = bbsim.VectorEnv(scene, n)
            envs.reset(), same.reset()

            def step():
                one, other = (each.step(np.full((n, 2), 0.05)) for each in (envs, same))
                for a, b in zip(one[:4], other[:4]):
                    np.testing.assert_array_equal(a, b)
                return one[3]

            step()
            self.refuses("", envs.reset)
            while not step().any():
                pass
            drawn[:] = [0] * (n + n // 2 - 2)  # the second run of the next episodes is refused
            self.refuses("", envs.step, np.full((n, 2), 0.05))
            while not step().any():
                pass

    def test_the_ball_falls_off(self):
        envs = bbsim.VectorEnv(self.SCENE, 1, set={"time.end": 20})
        envs.reset()
        for _ in range(1000):
            _, reward, terminated, truncated, _ = envs.step(np.full((1, 2), 0.2))
            if terminated[0]:
                break
        self.assertTrue(terminated[0])
        self.assertFalse(truncated[0])
        self.assertEqual(envs.result().status, "stopped")

    def test_spaces_options_and_faults(self):
        envs = bbsim.VectorEnv(self.SCENE, 2, {"ball.position.0": (0.0, 0.01)}, set={"controller.sensor": None})
        self.assertEqual(envs.action_space.shape, (2, 2))
        self.assertEqual(envs.single_action_space.high.tolist(), [0.2, 0.2])
        self.assertIn(envs.action_space.sample(), envs.action_space)
        observations, _ = envs.reset(options={"ball.position.0": 0.02})
        self.assertEqual(observations[:, 0].tolist(), [0.02, 0.02])
        self.refuses("", envs.reset, options={"gravity": 3})
        self.refuses("actions: found an array of shape (3, 2); allowed: (2, 2)", envs.step, np.zeros((3, 2)))
        for many in (envs, bbsim.VectorEnv(self.SCENE, 8)):
            many.reset()
            self.refuses("", many.step, np.full((many.num_envs, 2), np.nan))
            many.step(np.zeros((many.num_envs, 2)))
        self.refuses("", bbsim.VectorEnv(CONFIGS / "fig2b.yaml", 1).reset)
        for n in (0, -1, 2**40):
            self.refuses("", bbsim.VectorEnv, self.SCENE, n)
        with self.assertRaises(TypeError):
            bbsim.VectorEnv(self.SCENE, 2.5)

    def keeps_the_rules(self, env):
        """Checks from Gymnasium's documentation, as in its own checker."""
        with self.assertRaises(RuntimeError):
            env.step([0, 0])
        first, info = env.reset(seed=2)
        self.assertEqual(info, {})
        self.assertEqual((first.shape, first.dtype), (env.observation_space.shape, env.observation_space.dtype))
        self.assertTrue(env.observation_space.contains(first))
        np.testing.assert_array_equal(env.reset(seed=2)[0], first)
        self.assertFalse(np.array_equal(env.reset(seed=3)[0], first))
        for _ in range(2):
            before, kept = first, first.copy()
            over = False
            while not over:
                action = 0.1 * env.action_space.sample()
                self.assertTrue(env.action_space.contains(action))
                observation, reward, terminated, truncated, info = env.step(action)
                self.assertTrue(env.observation_space.contains(observation))
                self.assertEqual([type(one) for one in (reward, terminated, truncated, info)], [float, bool, bool, dict])
                np.testing.assert_array_equal(before, kept)  # the caller's arrays are not modified
                before, kept = observation, observation.copy()
                over = terminated or truncated
            with self.assertRaises(RuntimeError):
                env.step([0, 0])
            first, _ = env.reset()
        env.close()

    def test_single(self):
        self.keeps_the_rules(bbsim.Env(self.SCENE, {"ball.position.1": (-0.01, 0.01)}))

    def test_before_reset(self):
        with self.assertRaises(RuntimeError):
            bbsim.VectorEnv(self.SCENE, 2).step(np.zeros((2, 2)))

    def test_registered(self):
        files = {}
        if importlib.util.find_spec("gymnasium") is None:
            files = GYMNASIUM
        script = (
            "import gymnasium, bbsim, numpy as np\n"
            f"scene = {self.SCENE!r}\n"
            "env = gymnasium.make('bbsim/Plate-v0', scenario=scene, randomize={'ball.position.1': (-0.01, 0.01)})\n"
            "assert isinstance(env, gymnasium.Env) and env.reset(seed=1)[0].shape == (11,)\n"
            "assert len(env.step(np.zeros(2))) == 5\n"
            "envs = gymnasium.make_vec('bbsim/Plate-v0', num_envs=3, scenario=scene)\n"
            "assert isinstance(envs, gymnasium.vector.VectorEnv) and envs.reset(seed=1)[0].shape == (3, 11)\n"
            "assert envs.metadata['autoreset_mode'] == gymnasium.vector.AutoresetMode.NEXT_STEP\n"
            "assert isinstance(envs.single_action_space, gymnasium.spaces.Box)\n"
        )
        for name, text in files.items():
            os.makedirs("gymnasium", exist_ok=True)
            self.write(f"gymnasium/{name}", text)
        path = os.pathsep.join([str(self.folder), os.environ.get("PYTHONPATH", "")])
        subprocess.run([sys.executable, "-c", script], check=True, env={**os.environ, "PYTHONPATH": path})


class InjectingLaw:
    """The law of rig.yaml near home, with sines added to the command of one axis."""

    AMPLITUDE = 2e-5  # rad: the scene is linear to 1e-8 of this

    def __init__(self, axis, frequencies, kp=8, kv=4, gravity=9.81, period=0.02, filter=0.03):
        self.axis, self.frequencies, self.gains, self.period = axis, np.asarray(frequencies), (kp, kv), period
        self.keep = filter / (filter + period)
        self.per_acceleration = (1.4 / gravity, -1.4 / gravity)  # rad per m/s^2; theta drives the ball towards -y
        self.reset()

    def reset(self):
        self.position, self.velocity = np.zeros(2), np.zeros(2)
        self.answers, self.sent = [], []

    def __call__(self, sample):
        seen = np.array(sample.ball)
        self.velocity = self.keep * self.velocity + (1 - self.keep) * (seen - self.position) / self.period
        self.position = seen
        kp, kv = self.gains
        command = self.per_acceleration * (-kp * self.position - kv * self.velocity)
        self.answers.append(command[self.axis])
        command[self.axis] += self.AMPLITUDE * np.sin(self.frequencies * sample.t + np.arange(len(self.frequencies))).sum()
        self.sent.append(command[self.axis])
        return tuple(command)


class OpenLoops(cases.Case):
    def test_bode_is_what_a_simulation_measures(self):
        # Ten sines that fit into a window of 2048 samples, from 0.46 rad/s to just below the Nyquist frequency.
        window, skipped, period = 2048, 1000, 0.02
        numbers = np.array([3, 7, 15, 30, 60, 100, 180, 300, 500, 1000])
        frequencies = 2 * np.pi * numbers / (window * period)
        scene = {
            "gravity": 9.81,
            "ball": {"radius": "2 cm", "mass": "33 g"},
            "gimbal": {"servo": {"natural_frequency": "5 Hz", "damping": 0.8}},
            "controller": {
                "drives": "angle",
                "reference": {"point": [0, 0]},
                "sampling": {"period": "20 ms", "delay": "10 ms"},
                "sensor": {"delay": "10 ms"},
            },
            "time": {"end": (skipped + window) * period, "step": 1},
            "solver": {"rtol": 1e-10, "atol": 1e-16},
        }
        loop = bbsim.linearize(CONFIGS / "rig.yaml")
        bode = _loops.bode(loop)
        for axis, name in enumerate(("phi", "theta")):
            law = InjectingLaw(axis, frequencies)
            scene["controller"]["callable"] = law
            self.assertEqual(bbsim.run(scene).status, "done")
            answers, sent = (np.fft.rfft(each[skipped : skipped + window])[numbers] for each in (law.answers, law.sent))
            measured = -answers / sent
            np.testing.assert_allclose(measured, loop.open_loop(name).response(frequencies), rtol=0.002)
            gain, phase = (np.interp(frequencies, bode["frequency"], bode[f"{name}_{part}"]) for part in ("gain", "phase"))
            np.testing.assert_allclose(measured, gain * np.exp(1j * phase), rtol=0.01)

    def test_margins_are_those_of_check(self):
        for scene in (CONFIGS / "rig.yaml", CONFIGS / "fig2b.yaml", CONFIGS / "torque-lqr.yaml", CONFIGS / "three-servos.yaml"):
            margins = _loops.linearized(scene).margins
            self.assertEqual(set(margins), {"phi_command", "theta_command"})
            for axis, its in ((name.removesuffix("_command"), its) for name, its in margins.items()):
                with self.subTest(scene.name, axis=axis):
                    loop = bbsim.linearize(scene).open_loop(axis)
                    checked = bbsim.check(scene)
                    for key, shown in (("gain", "gain by"), ("phase", "phase"), ("delay", "delay")):
                        if its[key] is None:
                            continue
                        found = loop.response(its[f"{key}_frequency"])
                        if key == "gain":
                            np.testing.assert_allclose(found, -1 / its[key], rtol=1e-9)
                            self.assertIn(f"gain by {three_digits(its[key])}", checked)
                            continue
                        self.assertAlmostEqual(abs(found), 1, 9)
                        lag = its["phase"] if key == "phase" else its["delay"] * its["delay_frequency"]
                        np.testing.assert_allclose(found * np.exp(-1j * lag), -1, atol=1e-8)
                        degrees = three_digits(math.degrees(abs(lag)))
                        number = f"{degrees} deg" if key == "phase" else f"{three_digits(its['delay'])} s"
                        self.assertIn(f"{shown} {number}", checked)

    def test_columns(self):
        rig, circle = CONFIGS / "rig.yaml", CONFIGS / "fig2b.yaml"
        for scene in (rig, circle):
            bode, nyquist = _loops.bode(_loops.linearized(scene)), _loops.nyquist(_loops.linearized(scene))
            self.assertEqual(list(bode), ["frequency", "phi_gain", "phi_phase", "theta_gain", "theta_phase"])
            self.assertEqual(list(nyquist), ["frequency", "phi_real", "phi_imag", "theta_real", "theta_imag"])
            self.assertTrue((np.diff(bode["frequency"]) > 0).all())
            self.assertLess(np.abs(np.diff(bode["phi_phase"])).max(), 0.5)
            np.testing.assert_allclose(
                bode["phi_gain"] * np.exp(1j * bode["phi_phase"]), nyquist["phi_real"] + 1j * nyquist["phi_imag"], rtol=1e-12
            )
        self.assertAlmostEqual(_loops.bode(_loops.linearized(rig))["frequency"][-1], math.pi / 0.02, 9)
        self.assertEqual((bbsim.linearize(rig).open_loop("phi").dt, bbsim.linearize(circle).open_loop("phi").dt), (0.02, 0))

        poles = _loops.poles(_loops.linearized(circle))
        self.assertEqual(list(poles), ["real", "imag", "damping", "frequency"])
        np.testing.assert_allclose(poles["real"], -poles["damping"] * poles["frequency"], atol=1e-12)
        sampled = _loops.poles(_loops.linearized(rig))
        at = np.exp(sampled["frequency"] * 0.02 * (-sampled["damping"] + 1j * np.sqrt(1 - sampled["damping"] ** 2)))
        np.testing.assert_allclose(np.abs(at), np.hypot(sampled["real"], sampled["imag"]), atol=1e-9)

        key = "controller.gravity_compensation.kp"
        locus = _loops.root_locus(given(rig), key, ("2", "4"), 3)
        np.testing.assert_array_equal(np.unique(locus["value"]), [2, 3, 4])
        radii = _loops.root_locus(given(rig), "ball.radius", ("1 cm", "0.02"), 2)
        np.testing.assert_allclose(np.unique(radii["value"]), [0.01, 0.02])
        self.assertEqual(list(locus), ["value", "real", "imag"])
        middle = locus["value"] == 3
        np.testing.assert_array_equal(
            locus["real"][middle] + 1j * locus["imag"][middle], bbsim.linearize(rig, {key: 3.0}).poles
        )

    def test_a_step_is_that_of_a_small_jump(self):
        jump = 1e-5
        for scene in (
            {**LOOP, "controller": {**LOOP["controller"], "sensor": {"delay": "10 ms"}}},
            {**LOOP, "controller": {key: LOOP["controller"][key] for key in ("pd", "drives")}},
        ):
            scene = {**scene, "ball": {"radius": "1 cm"}}
            scene["controller"]["reference"] = {"point": [jump, 0]}
            step = _loops.step(_loops.linearized(scene))
            self.assertEqual(list(step), ["t", "x", "y"])
            early = step["t"] <= 4
            made = bbsim.simulate(scene, [{}], "x", step["t"][early], set={"solver.atol": 1e-15})
            np.testing.assert_allclose(made["x"][0] / jump, step["x"][early], atol=1e-5)
            self.assertEqual(step["y"][0], 0)
        self.assertAlmostEqual(_loops.step(_loops.linearized(CONFIGS / "rig.yaml"))["y"][-1], 1, 2)

    def test_a_callable_by_its_estimate(self):
        scene = with_callable(SampledPd())
        built_in = bbsim.linearize({**LOOP, "controller": {**LOOP["controller"], "sensor": {"delay": "10 ms"}}}, kind="loop")
        estimate = bbsim.linearize(scene, {"controller.sensor.dropout": 0}, kind="loop")
        self.assertIn("estimate", estimate.note)
        frequencies = np.array([0.1, 1, 10, 100])
        for axis in ("phi", "theta"):
            np.testing.assert_allclose(
                estimate.open_loop(axis).response(frequencies), built_in.open_loop(axis).response(frequencies), rtol=1e-3
            )
            self.assertAlmostEqual(
                estimate.margins[f"{axis}_command"]["phase"], built_in.margins[f"{axis}_command"]["phase"], 3
            )
        self.assertEqual(list(_loops.poles(estimate)), ["real", "imag", "damping", "frequency"])
        self.refuses("do not depend", bbsim.linearize, with_callable(lambda sample: (0, 0)), kind="loop")
        self.refuses("", _loops.step, estimate)  # an estimate has no reference

    def test_scenes_without_a_loop(self):
        for scene in ("fig2a", "recorded"):
            self.refuses("", lambda: _loops.bode(_loops.linearized(CONFIGS / f"{scene}.yaml")))
        self.refuses("", bbsim.linearize(CONFIGS / "rig.yaml", kind="plant").open_loop, "phi")
        self.refuses("", bbsim.linearize(CONFIGS / "rig.yaml").open_loop, "x")
        self.refuses("", _loops.root_locus, given(CONFIGS / "rig.yaml"), "ball.position", ("1", "2"), 3)


class Simulations(cases.Case):
    def test_columns_measures_and_times(self):
        radii = np.linspace(0.015, 0.025, 10)
        times = np.array([0, 0.3, 0.3, 1.94, 2])
        made = bbsim.simulate(
            CONFIGS / "rig.yaml", {"ball.radius": radii}, ["x", "t", "phi_command"], times, "end_x", set={"time.end": 2}
        )
        self.assertEqual(made["x"].shape, (10, 5))
        self.assertEqual((len(made), made.columns, list(made.status)), (10, ["x", "t", "phi_command"], ["done"] * 10))
        self.assertEqual(made.reason, [""] * 10)
        np.testing.assert_array_equal(made["t"], np.tile(times, (10, 1)))
        swept = bbsim.sweep(CONFIGS / "rig.yaml", {"ball.radius": radii}, "end_x", set={"time.end": 2})
        np.testing.assert_allclose(made.measures["end_x"], swept["end_x"], rtol=1e-12)
        for i in (0, 9):
            run = bbsim.run(CONFIGS / "rig.yaml", {"ball.radius": radii[i], "time.end": 2})
            for name in ("x", "phi_command"):
                np.testing.assert_allclose(made[name][i], run[name][[0, 15, 15, 97, 100]], atol=1e-6)
        with self.assertRaises(KeyError):
            made["y"]
        self.assertEqual(list(dict(made)), made.columns)
        np.testing.assert_array_equal(pickled(made)["x"], made["x"])

    def test_columns_in_lanes_are_those_of_runs(self):
        gains = np.linspace(4, 8, 9)
        for scene, more in (("rig", []), ("pushrod", []), ("three-servos", ["servo_third"])):
            columns = ["x", "vy", "phi", "theta_rate", "tilt", "servo_phi", "phi_command", "x_measured", *more]
            key = "controller.gravity_compensation.kp"
            made = bbsim.simulate(CONFIGS / f"{scene}.yaml", {key: gains}, columns, set={"time.end": 2})
            settings = {key: gains[8], "time.end": 2, "output.columns": ["t", *columns]}
            run = bbsim.run(CONFIGS / f"{scene}.yaml", settings)
            for name in columns:
                with self.subTest(scene=scene, column=name):
                    np.testing.assert_allclose(made[name][8], run[name], rtol=0, atol=1e-10)

    def test_lists_texts_and_default_rows(self):
        cases = [{"ball.radius": "1 cm"}, {"ball.radius": 0.02, "ball.position": [0.05, 0.01]}, {}]
        made = bbsim.simulate(CONFIGS / "fig2b.yaml", cases, "y", set={"time.end": 1})
        for i, case in enumerate(cases):
            run = bbsim.run(CONFIGS / "fig2b.yaml", {**case, "time.end": 1})
            np.testing.assert_allclose(made["y"][i], run["y"], atol=1e-9)

    def test_windows(self):
        scene = {**LOOP, "controller": {**LOOP["controller"]}}
        scene["controller"].update(sampling={"period": "20 ms"}, sensor={}, limit=10)
        states = ["x", "y", "vx", "vy", "phi", "theta", "phi_rate", "theta_rate", "spin"]
        whole = bbsim.run(scene, {"output.columns": ["t", *states]})
        rows = np.array([50, 100, 150])
        begin = whole["t"][rows]
        start = np.column_stack([whole[name] for name in states])[rows]
        made = bbsim.simulate(scene, {}, states, begin[:, None] + [0, 0, 0], begin=begin, end=begin + 1, start=start)
        self.assertEqual(made["x"].shape, (3, 3))
        for k, name in enumerate(states):
            np.testing.assert_allclose(made[name], np.tile(start[:, k, None], (1, 3)), atol=1e-12)
        default = bbsim.simulate(scene, {}, "x", begin=2, end=3)
        self.assertEqual(np.isfinite(default["x"]).sum(), 51)
        self.assertTrue(np.isfinite(default["x"][0, 100:151]).all())

    def test_each_case_ends_in_its_own_way(self):
        made = bbsim.simulate(
            CONFIGS / "rig.yaml", {"ball.radius": [0.02, -1, 0.02], "ball.position.0": [0, 0, 0.4]}, "x",
            set={"time.end": 1},
        )
        self.assertEqual(list(made.status), ["done", "refused", "stopped"])
        self.assertIn("ball.radius", made.reason[1])
        self.assertEqual(made.reason[2], "edge")
        self.assertIn("1 refused", repr(made))

    def test_a_callable(self):
        made = bbsim.simulate(with_callable(SampledPd()), {"ball.radius": [0.01, 0.02]}, "x", [0, 1, 2])
        run = bbsim.run(with_callable(SampledPd()), {"ball.radius": 0.02})
        np.testing.assert_array_equal(made["x"][1], run["x"][[0, 50, 100]])

        def tells(sample):
            return 0, 0, {"count": sample.sample}

        scene = with_callable(tells, output={"columns": ["t", "count"]})
        self.assertEqual(bbsim.simulate(scene, [{}], "x", [0, 1])["x"].shape, (1, 2))
        self.assertEqual(bbsim.simulate(scene, [{}], "count", [0, 1])["count"].tolist(), [[0, 50]])

        def breaks(sample):
            raise ValueError("no idea")

        with self.assertRaises(bbsim.ControllerError):
            bbsim.simulate(with_callable(breaks), {"ball.radius": [0.01, 0.02]}, "x")

    def test_odd_arguments(self):
        def refused(*told, cases=None, columns="x", **rest):
            for one in told:
                self.refuses(one, bbsim.simulate, CONFIGS / "fig2b.yaml",
                             {"ball.radius": [0.01, 0.02]} if cases is None else cases, columns, **rest)  # fmt: skip

        refused("radius", cases={"ball.radios": [1, 2]})
        refused("cases: ball.radius", "allowed", cases={"ball.radius": "2 cm"})
        refused("cases: ball.radius", cases={"ball.radius": 0.02})
        refused("cases: gravity", "for 2", cases={"ball.radius": [0.01, 0.02], "gravity": [9]})
        refused("cases: case 1", cases={"ball.radius": [0.01, math.nan]})
        refused("cases", cases="ball.radius")
        refused("did you mean phi", columns="phy")
        refused("did you mean max_tilt", measures="max_tild")
        refused("times", "shape ()", times=1.0)
        refused("times", "(n, m)", times=np.zeros((1, 2, 3)))
        refused("times", "for 2", times=np.zeros((3, 2)))
        refused("times", times=["now"])
        refused("do not decrease", times=[0.2, 0.1])
        refused("allowed", times=[0, math.nan])
        refused("0 to 21 s", times=[0, 22])
        refused("begin", begin=[1])
        refused("begin", "shape (1, 2)", begin=[[1, 2]])
        refused("end: case 0", begin=[1, 1], end=[1, 2])
        refused("start", "(n, 9)", start=[[1, 2]])
        refused("threads", threads=-1)
        with self.assertRaises(TypeError):
            bbsim.simulate(CONFIGS / "fig2b.yaml", {"ball.radius": [object()]}, "x")
        for times, shape in (([0, 1], (0, 2)), (np.empty((0, 2)), (0, 2))):
            self.assertEqual(bbsim.simulate(CONFIGS / "fig2b.yaml", [], "x", times)["x"].shape, shape)
        for times in ([], np.empty((2, 0))):
            made = bbsim.simulate(CONFIGS / "fig2b.yaml", {"ball.radius": [0.01, 0.02]}, "x", times)
            self.assertEqual((made["x"].shape, list(made.status)), ((2, 0), ["done", "done"]))


class Faults(cases.Case):
    def test_input(self):
        error = self.refuses("", bbsim.run, {**LOOP, "ball": {"radius": -1, "position": [0, 0]}, "gravty": 3})
        self.assertIsInstance(error, ValueError)
        self.assertEqual({problem.key for problem in error.problems}, {"ball.radius", "gravty"})
        hints = {problem.key: problem.hint for problem in error.problems}
        self.assertIn("gravity", hints["gravty"])
        self.assertIn("allowed", hints["ball.radius"])
        self.assertNotIn("<dict>", str(error))

    def test_texts_of_any_script(self):
        for key in ("größe", "\U0001f642"):
            self.refuses("unknown key", bbsim.check, {"ball": {"radius": "1 cm", key: 1}, "time": {"end": 1}})
        half = "\ud83d"  # of a surrogate pair
        for given in ({"title": half}, {half: 1}, f"title: {half}\n"):
            self.refuses("a part of a character", bbsim.check, given)
        self.refuses("", bbsim.check, CONFIGS / "fig2b.yaml", {"title": half})

    def test_file_and_settings(self):
        self.refuses("no-such-file.yaml", bbsim.run, "no-such-file.yaml")
        self.refuses("", bbsim.run, CONFIGS / "fig2b.yaml", {"ball.radius": float("nan")}, key="ball.radius")
        self.refuses("radius", bbsim.sweep, CONFIGS / "fig2b.yaml", {"ball.radios": [1, 2]})
        with self.assertRaises(TypeError):
            bbsim.run({**LOOP, "ball": object()})

    def test_it_can_be_pickled(self):
        try:
            bbsim.run(LOOP, {"ball.radius": -1})
        except bbsim.InputError as error:
            again = pickle.loads(pickle.dumps(error))
            self.assertEqual((str(again), again.key), (str(error), error.key))

    def test_check(self):
        self.assertEqual(bbsim.check(CONFIGS / "rig.yaml"), program("check", CONFIGS / "rig.yaml"))


class Types(cases.Case):
    def test_mypy(self):
        """Accepts what is documented, and knows the names of the package."""
        try:
            from mypy import api
        except ImportError as lacking:
            self.skipTest(str(lacking))
        self.write("mine.py", "import bbsim, numpy as np\n"
                   "bbsim.sweep('a', {'ball.radius': np.linspace(1, 2, 3)})\n"
                   "bbsim.design('a', {'ball.radius': (1, 2)})\n"
                   "bbsim.runn('a')\n")  # fmt: skip
        said, _, _ = api.run(["--ignore-missing-imports", "--follow-imports=silent", "mine.py"])
        self.assertEqual([line.split(":")[1] for line in said.splitlines()[:-1]], ["4"], said)


class Interruptions(unittest.TestCase):
    def test_ctrl_c_ends_all_work_with_a_keyboard_interrupt(self):
        rig = f"'{CONFIGS}/rig.yaml'"
        for work in (
            f"bbsim.run({rig}, {{'time.end': 1e6}})",
            f"bbsim.sweep({rig}, {{'gravity': 'linear:9:10:10000000'}})",
            f"bbsim.simulate({rig}, {{'gravity': np.linspace(9, 10, 10**6)}}, [], measures='end_x')",
            f"bbsim.run({{**{with_callable(None)!r}, 'controller': dict(callable=lambda sample: (0, 0), drives='angle', "
            "sampling=dict(period='20 ms'), reference=dict(point=[0, 0]))}, {'time.end': 1e6})",
        ):
            with self.subTest(work):
                script = (f"import bbsim, sys, numpy as np\nprint('ready', flush=True)\ntry:\n    {work}\n"
                          "except KeyboardInterrupt:\n    sys.exit(42)")  # fmt: skip
                with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as child:
                    self.assertEqual(child.stdout.readline(), "ready\n")
                    with contextlib.suppress(subprocess.TimeoutExpired):
                        child.wait(0.5)
                    child.send_signal(signal.SIGINT)
                    try:
                        self.assertEqual(child.wait(20), 42)
                    finally:
                        child.kill()


class Processes(cases.Case):
    """Threads within bbsim while their process ends or is forked."""

    def ended(self, work, before="", ends="sys.exit(5)"):
        """What a process writes that ends while four daemon threads do this work again and again."""
        script = (
            f"{before}\nimport bbsim, numpy as np, sys, threading, time\n"
            f"scene = {with_callable(None)!r}\nbegun = threading.Semaphore(0)\n"
            f"def law(sample):\n    begun.release()\n    return 0, 0\n"
            f"scene['controller']['callable'] = law\n"
            f"def work():\n    envs = bbsim.VectorEnv({str(CONFIGS / 'rig.yaml')!r}, 64)\n    envs.reset(seed=1)\n"
            f"    while True:\n        begun.release()\n        {work}\n"
            "for _ in range(4): threading.Thread(target=work, daemon=True).start()\n"
            f"for _ in range(40): begun.acquire()\n{ends}\n"
        )
        made = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
        self.assertEqual((made.returncode, made.stderr), (5, ""))
        return made.stdout

    def test_the_end_of_the_interpreter(self):
        for work in (
            f"bbsim.run({str(CONFIGS / 'fig2b.yaml')!r})",
            f"bbsim.sweep({str(CONFIGS / 'rig.yaml')!r}, {{'gravity': 'linear:9:10:20'}})",
            f"bbsim.simulate({str(CONFIGS / 'rig.yaml')!r}, {{'gravity': np.linspace(9, 10, 20)}}, 'x')",
            "envs.step(np.zeros((64, 2)))",
            "bbsim.run(scene)",
            "bbsim.run(scene, {'time.end': 1e6})",
        ):
            with self.subTest(work):
                self.ended(work)

    def test_functions_at_the_end_may_call_bbsim(self):
        late = "import atexit\natexit.register(lambda: print(bbsim.run(scene).status))"
        self.assertEqual(self.ended("bbsim.check(scene)", before=late), "done\n")

    def test_forked_processes_write_their_own_files(self):
        over = threading.Event()

        def write(which):
            while not over.is_set():
                bbsim.run(LOOP, output=f"thread{which}.h5")

        threads = [threading.Thread(target=write, args=(i,)) for i in range(2)]
        for one in threads:
            one.start()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", DeprecationWarning)  # of Python, about threads beside a fork
                for k in range(20):
                    child = os.fork()
                    if child == 0:
                        signal.alarm(60)  # ends it if it waits for a thread that it does not have
                        try:
                            bbsim.run(LOOP, output=f"child{k}.h5")
                            os._exit(0)
                        finally:
                            os._exit(1)
                    self.assertEqual(os.waitpid(child, 0)[1], 0)
        finally:
            over.set()
            for one in threads:
                one.join()
        files = sorted(self.folder.iterdir())
        self.assertEqual(len(files), 22)
        self.assertEqual(len({file.read_bytes() for file in files}), 1)


class Examples(unittest.TestCase):
    def test_cross_entropy(self):
        sys.path.insert(0, str(CONFIGS.parent / "examples/learning"))
        try:
            import cross_entropy
        finally:
            sys.path.pop(0)
        said = []
        rig = CONFIGS / "rig.yaml"
        weights = cross_entropy.learn(rig, policies=32, rigs=4, best=6, generations=12, said=said.append)
        self.assertEqual(len(said), 2)
        learned, built_in = cross_entropy.compared(rig, weights, rigs=64)
        self.assertLess(learned, 0.95 * built_in)
        self.assertLess(built_in, 60)  # mm^2: the law keeps the ball on the plate


class Documents(cases.Case):
    def run_code(self, page):
        """Runs the Python blocks of a page: their names, and what they print."""
        blocks = (CONFIGS.parent / "docs/tutorials" / page).read_text().split("```python\n")[1:]
        names = {}
        with contextlib.redirect_stdout(io.StringIO()) as said:
            for block in blocks:
                exec(block.split("```")[0], names)
        return names, said.getvalue()

    def test_the_notebook_runs(self):
        try:
            import pandas  # noqa: F401
            import scipy  # noqa: F401
        except ImportError as lacking:
            self.skipTest(str(lacking))
        os.chdir(CONFIGS.parent)
        names, said = self.run_code("notebook.md")
        self.assertIn("ball.radius - allowed: ", said)
        worse, better = (bbsim.run(names[one], measures="rms_tracking_error") for one in ("loop", "designed"))
        self.assertLess(3 * better.measures["rms_tracking_error"], worse.measures["rms_tracking_error"])

    def test_the_figures_for_a_paper(self):
        names, _ = self.run_code("paper-figure.md")
        self.assertEqual(sorted(os.listdir()), ["bode.pdf", "margin.pdf", "run.pdf", "settling.pdf"])
        # What the page says of the loop, the run and the rigs.
        margins, settling = names["margins"], names["rigs"]["x.SettlingTime"]
        self.assertEqual((round(math.degrees(margins["phase"])), round(20 * math.log10(margins["gain"]), 1)), (53, 16.8))
        self.assertLess(names["result"].measures["x.SettlingTime"], 1.1)
        np.testing.assert_allclose(np.quantile(settling, [0.05, 0.95]), [1.09, 1.15], atol=0.005)
        self.assertGreater(names["rigs"]["phi_delay_margin"].min(), 0.15)


if __name__ == "__main__":
    unittest.main()
