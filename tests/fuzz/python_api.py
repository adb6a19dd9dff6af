# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Calls the Python package with odd arguments: of wrong types and shapes, NaN, huge, negative, hostile.

    python_api.py [--seconds N] [--runs N] [--first SEED] [--into FOLDER]
    python_api.py --case SEED     makes one call again

Each call must return or raise an exception of Python or bbsim. A signal, an error within C++ (a SystemError, or
the text of a standard exception), and a call that Ctrl-C does not end are findings; they are written to FOLDER.
Exit code 1 if there are any.
"""
import argparse
import copy
import math
import os
import random
import re
import resource
import selectors
import signal
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

PATIENCE = 20  # s until Ctrl-C, and from there until the call counts as one that hangs
MEMORY = 4 << 30  # bytes of a worker's addresses: requests for more must be refused like any other
INTERNAL = re.compile(r"unknown exception|std::|vector::|basic_string|map::at|bad_|Unable to cast C\+\+")

RIG = {
    "ball": {"radius": 0.02, "position": [0.05, 0]},
    "plate": {"size": [0.3, 0.2], "inertia": [4e-3, 6e-3, 1e-2]},
    "gimbal": {"servo": {"natural_frequency": 30, "damping": 0.8, "angle_limit": "25 deg"}},
    "controller": {
        "pd": {"kv": [[0.5, 0], [0, -0.5]], "kp": [[0.7, 0], [0, -0.7]]}, "drives": "angle", "limit": 0.2,
        "reference": {"circle": {"radius": 0.05, "rate": -0.3}}, "sampling": {"period": 0.02, "delay": 0.005},
        "sensor": {"noise": 2e-4, "resolution": 3e-4},
    },
    "events": {"edge": "stop"},
    "time": {"end": 0.2, "step": 0.02},
    "output": {"columns": ["t", "x", "y", "phi"]},
}  # fmt: skip


class Hostile:
    """Raises whenever it is used."""

    def _raise(self, *_):
        raise ZeroDivisionError("hostile")

    __len__ = __iter__ = __float__ = __index__ = __bool__ = __array__ = __repr__ = __getitem__ = __fspath__ = _raise


class Odd:
    """Draws calls; the same seed gives the same call."""

    def __init__(self, bbsim, np, seed):
        self.bbsim, self.np = bbsim, np
        self.random = random.Random(seed)

    def one_of(self, *choices):
        return self.random.choice(choices)

    def value(self, depth=0):
        np, draw = self.np, self.random
        simple = [
            None, True, 0, -1, 1, 2.5, -0.0, math.nan, math.inf, -math.inf, 1e-300, 5e-324, 1e300, 2**31, 2**62, 2**64,
            -(2**63), 10**400, 1j, "", "x", "nan", "1 cm", "-1", "[1, 2", "a\0b", "\ud83d", "é" * 300, b"x", object(),
            Hostile(), len, Path("none.yaml"), Ellipsis, np.float32(0.1), np.int8(-3), np.datetime64(0, "s"),
        ]  # fmt: skip
        if depth > 3 or draw.random() < 0.6:
            return draw.choice(simple)
        some = [self.value(depth + 1) for _ in range(draw.randrange(4))]
        deep = []
        for _ in range(draw.choice((10, 1000, 100000))):
            deep = [deep]
        return self.one_of(
            some, tuple(some), {str(i): one for i, one in enumerate(some)}, {1: 2}, iter(some), deep,
            np.zeros(draw.randrange(12), self.one_of(float, bool, complex, "S2", object)),
            np.full((draw.randrange(12), self.one_of(0, 1, 2, 3)), self.one_of(0.0, 0.05, math.nan, 1e308)),
            np.zeros((3, 0, 2)), np.arange(24.0).reshape(2, 12).T[::-3], np.array(0.5),
        )  # fmt: skip

    def perhaps(self, usual, odds=0.1):
        return self.value() if self.random.random() < odds else usual

    def scenario(self):
        draw = self.random
        scene = copy.deepcopy(RIG)
        if draw.random() < 0.5:
            scene["controller"]["callable"] = self.law()
            del scene["controller"]["pd"]
        for _ in range(draw.choice((0, 0, 0, 1, 2))):
            at = scene
            while draw.random() < 0.7 and any(isinstance(one, dict) for one in at.values()):
                at = draw.choice([one for one in at.values() if isinstance(one, dict)])
            key = self.one_of(*at, "none", 3) if at else "none"
            if draw.random() < 0.2:
                at.pop(key, None)
            else:
                at[key] = self.value()
        return self.perhaps(scene, 0.02)

    def law(self):
        answer = self.one_of((0, 0), (0.01, -0.02), (0.01, -0.02), self.value(), (self.value(), self.value()))
        work = self.one_of(None, None, None, lambda: self.bbsim.run(RIG), lambda: 1 / 0, lambda: self.bbsim.run(scene))
        scene = {**RIG, "controller": {**RIG["controller"], "callable": lambda sample: law(sample)}}
        del scene["controller"]["pd"]

        def law(sample):
            if work is not None:
                work()
            return answer

        return law

    def settings(self):
        key = self.one_of("ball.radius", "time.end", "controller.sensor.seed", "output.columns", "none", "", "a..b", "ball")
        return self.one_of(*8 * [None], {key: self.value()}, {"ball.radius": 0.01}, self.value())

    def measures(self):
        return self.perhaps(self.one_of(None, "max_tilt", ["end_x", "rms_y from 0.1 s"], "none"))

    def run(self, folder):
        output = self.perhaps(self.one_of(None, None, f"{folder}/a.csv", f"{folder}/a.h5", folder, "/dev/full"))
        expect = self.perhaps(self.one_of((), (), "max_tilt < 5 deg", "x"))
        result = self.bbsim.run(
            self.scenario(), self.settings(), self.perhaps(None, 0.05), measures=self.measures(), expect=expect, output=output
        )
        self.one_of(lambda: result[self.perhaps("x")], lambda: repr(result), lambda: result.summary, result._repr_html_)()

    def check(self, _):
        self.bbsim.check(self.scenario(), self.settings())

    def linearize(self, _):
        kind, at = self.perhaps(self.one_of(None, "plant", "loop", "sampled")), self.perhaps(self.one_of("home", "0.1 s"))
        repr(self.bbsim.linearize(self.scenario(), self.settings(), kind=kind, at=at))

    def sweep(self, _):
        specs = ["linear:0.01:0.02:5", "uniform:0.01:0.02", "normal:0.02:0.001", "log:0:1:2"]
        spec = self.perhaps(self.one_of([0.01, 0.02], *specs))
        vary = self.perhaps({self.one_of("ball.radius", "ball.radius", "gravity", "time.step", "none"): spec}, 0.05)
        drawn = isinstance(spec, str) and spec.startswith(("uniform", "normal"))
        given = {"samples": 3 if drawn else None, "seed": None, "threads": 1, "combine": "", "error": None}
        name = self.one_of(*given)
        given[name] = self.perhaps(given[name], 0.3)
        measures = self.perhaps(self.one_of((), "max_tilt"))
        self.bbsim.sweep(self.scenario(), vary, measures, set=self.settings(), **given)

    def simulate(self, _):
        np, draw = self.np, self.random
        n = self.one_of(0, 1, 3, 9)
        cases = self.perhaps(
            self.one_of(
                {}, {"ball.radius": np.linspace(0.01, 0.02, n)}, {"ball.radius": ["2 cm"] * n}, {"none": [1.0] * n},
                [{"ball.radius": 0.01}, {}], [self.value()], {"ball.radius": self.value(), "gravity": self.value()},
            )
        )  # fmt: skip
        columns = self.perhaps(self.one_of("x", ["t", "x", "phi"], ["x", "none"], []))
        parts = {
            "times": self.one_of(None, [0, 0.1, 0.2], np.full((n, 3), 0.1), [0.2, 0.1]),
            "begin": self.one_of(None, None, 0.05, np.full(n, 0.1)),
            "end": self.one_of(None, None, 0.2, np.full(n, 0.15)),
            "start": self.one_of(None, None, np.zeros((n, 9))),
            "events": self.one_of(True, False),
            "threads": 1,
        }
        name = self.one_of(*parts)
        parts[name] = self.perhaps(parts[name], 0.5)
        measures = self.perhaps(self.one_of((), "max_tilt", ["end_x", "phi_delay_margin"]))
        made = self.bbsim.simulate(self.scenario(), cases, columns, measures=measures, set=self.settings(), **parts)
        self.one_of(lambda: made[self.perhaps("x")], lambda: repr(made), lambda: draw.choice(made.reason or [""]))()

    def environments(self, _):
        np, draw = self.np, self.random
        bounds = self.perhaps(self.one_of((0.01, 0.02), (0.02, 0.01), lambda random: self.perhaps(0.02)))
        randomize = self.perhaps(self.one_of(*3 * [None], *3 * [{"ball.radius": bounds}], {"none": (0, 1)}), 0.03)
        n = self.perhaps(self.one_of(1, 3, 8, 11))
        reward = self.perhaps(self.one_of(None, lambda o, a, terminated: self.perhaps(np.zeros(len(o)))))
        envs = self.bbsim.VectorEnv(
            self.scenario(), n, randomize, self.perhaps(1, 0.05), set=self.settings(), reward=reward, record=draw.random() < 0.2
        )
        faults = (AttributeError, TypeError, ValueError, ArithmeticError, RuntimeError, LookupError, self.bbsim.Error)
        for _ in range(draw.randrange(40)):
            try:
                act = draw.random()
                if act < 0.15:
                    mask = self.perhaps(np.arange(envs.num_envs) % 2 == 0, 0.5)
                    options = self.one_of(None, {"reset_mask": mask}, {"ball.radius": self.value()}, self.value())
                    envs.reset(seed=self.perhaps(None), options=options)
                elif act < 0.2:
                    envs.result(self.perhaps(0, 0.5))
                else:
                    envs.step(self.perhaps(np.full((envs.num_envs, 2), self.one_of(0, 0.05, 0.2, 1e6)), 0.2))
            except faults as fault:
                require_own(fault)  # the environment must still be usable


def require_own(fault):
    """Whether the exception is one that a caller may get."""
    if isinstance(fault, SystemError) or INTERNAL.search(str(fault)):
        raise AssertionError(f"an internal error: {type(fault).__name__}: {fault}") from fault


def call(seed, folder):
    import numpy as np

    import bbsim

    odd = Odd(bbsim, np, seed)
    which = odd.one_of("run", "check", "linearize", "sweep", "simulate", "environments", "environments")
    try:
        getattr(odd, which)(folder)
    except KeyboardInterrupt:
        pass  # a long call, which ended as it should
    except MemoryError:
        pass
    except Exception as fault:
        require_own(fault)


def work(seed):
    """Makes calls from this seed on, and names each before it is made."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as folder:
        while True:
            print(seed, flush=True)
            try:
                call(seed, folder)
            except AssertionError as found:
                print(f"! {found}", flush=True)
            except KeyboardInterrupt:  # after the call
                pass
            seed += 1


class Worker:
    def __init__(self, seed):
        environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONFAULTHANDLER": "1"}
        self.errors = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen(
            [sys.executable, __file__, "--work", str(seed)], stdout=subprocess.PIPE, stderr=self.errors, env=environment
        )
        self.seed, self.text = seed, ""
        self.ready = selectors.DefaultSelector()
        self.ready.register(self.process.stdout, selectors.EVENT_READ)

    def line(self, seconds):
        """The next line; None if there is none in this time; "" if the worker has ended."""
        until = time.monotonic() + seconds
        while "\n" not in self.text:
            if not self.ready.select(max(0, until - time.monotonic())):
                return None
            some = os.read(self.process.stdout.fileno(), 4096).decode()
            if not some:
                return ""
            self.text += some
        line, _, self.text = self.text.partition("\n")
        return line + "\n"

    def end(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        self.errors.seek(0)
        return self.errors.read()[-4000:]


def fuzz(seconds, runs, first, into):
    until, findings, calls = time.monotonic() + seconds, 0, 0
    worker, interrupted = Worker(first), False
    patience = 60  # the worker imports numpy first

    def found(what, text=""):
        nonlocal findings
        findings += 1
        into.mkdir(parents=True, exist_ok=True)
        file = into / f"python-{what}-{worker.seed}"
        file.write_text(f"{sys.executable} {__file__} --case {worker.seed}\n{text}")
        print(f"{file}: {text.splitlines()[0] if text else what}", flush=True)

    while time.monotonic() < until and calls < runs:
        line = worker.line(patience)
        if line is None and not interrupted:
            worker.process.send_signal(signal.SIGINT)
            interrupted, patience = True, PATIENCE
            continue
        if line and line.startswith("!"):
            found("error", line)
            continue
        if line:
            worker.seed, interrupted, patience = int(line), False, PATIENCE
            calls += 1
            continue
        text = worker.end()
        found("timeout" if line is None else "crash", text)
        worker, interrupted, patience = Worker(worker.seed + 1), False, 60
    worker.end()
    print(f"{calls} executions")
    return findings


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--runs", type=float, default=math.inf)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--into", type=Path, default=Path("out/fuzz"))
    parser.add_argument("--case", type=int)
    parser.add_argument("--work", type=int, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.work is not None:
        work(given.work)
    elif given.case is not None:
        with tempfile.TemporaryDirectory() as folder:
            call(given.case, folder)
    else:
        sys.exit(1 if fuzz(given.seconds, given.runs, given.first, given.into) else 0)


if __name__ == "__main__":
    main()
