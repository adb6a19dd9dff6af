# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The motion whose log determines keys of a scenario best: bbsim.design and `bbsim design`."""

from __future__ import annotations

import os
import re
import tempfile
from json import loads
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np
from scipy.optimize import minimize

from . import _bbsim
from ._experiment import Experiment, Motions
from ._scenario import Array, InputError, Scenario, Settings, counted, fault, from_to, given, listed, refuse
from ._task import Progress, as_json, carry_out, files_of, read_free_keys, refuse_own_controller, silent, write_all

Size = Union[float, str, None]

_TURN = 2 * np.pi
_FLOOR = 1e-8  # of information: a number u of size 1 with a standard deviation of 1e4 is unknown
_DRAWS = 60
_SIZES = {  # of options: unit, and what is allowed
    "rate": ("", "rows per second, such as 50"),
    "length": ("s", 'a time greater than 0, such as "10 s"'),
    "window": ("s", 'a time greater than 0, such as 2 or "500 ms"'),
    "max-tilt": ("rad", 'an angle greater than 0, such as "8 deg"'),
    "max-tilt-rate": ("rad/s", 'a rate greater than 0, such as "60 deg/s"'),
    "margin": ("m", 'a length greater than 0, such as "3 cm"'),
}
_NEAR = 0.1  # of a motion's size, for differences
_PARTS = (1, 0.3, 0.1)  # of the way to the best motion nearby


def merits(slopes: Array) -> Array:
    """The logarithm of the determinant of Fisher's information, for each motion. Its floor ranks motions that determine
    all keys above all others."""
    return np.linalg.slogdet(np.swapaxes(slopes, -1, -2) @ slopes + _FLOOR * np.eye(slopes.shape[-1]))[1]


def deviations(slopes: Array) -> Array:
    """The standard deviation of each number u; infinite if the log does not determine it."""
    sizes = np.maximum(np.linalg.norm(slopes, axis=0), 1e-150)
    values, vectors = np.linalg.eigh((slopes / sizes).T @ (slopes / sizes))
    known = values > 1e-8 * max(values[-1], 1e-150)  # the error of differences
    variances = (vectors[:, known] ** 2 / values[known]).sum(1)
    return np.where((np.abs(vectors[:, ~known]) > 0.02).any(1), np.inf, np.sqrt(variances) / sizes)


def within(experiment: Experiment, motions: Motions, centered: bool = False) -> Dict[int, Motions]:
    """The motions at the largest scale that keeps the limits, of those that have one."""
    numbers, waves = motions.numbers.copy(), motions.waves
    active, best = np.arange(len(numbers)), {}
    scale, largest = np.ones(len(numbers)), np.zeros(len(numbers))
    for _ in range(10):
        by = scale[active, None]
        played, middle = experiment.play(Motions(numbers[active] * by, waves[active]))
        greatest = played.shares.max((1, 2))
        for k in np.flatnonzero((greatest <= 1) & (scale[active] > largest[active])):
            best[active[k]], largest[active[k]] = played.take([k]), by[k, 0]
        if centered:  # the path has the most room in the middle of the plate
            numbers[active, -4:-2] -= middle / by
        # The use is almost proportional to the scale, except for parts that do not scale, such as an offset.
        scale[active] *= np.clip(np.where(np.isfinite(greatest), 0.99 / np.maximum(greatest, 1e-6), 0.2), 0.1, 100)
        active = active[(greatest > 1) | (greatest < 0.97)]
        if not len(active):
            break
    return best


def join(motions: Iterable[Sequence[Array]]) -> Motions:
    return Motions(*map(np.concatenate, zip(*motions)))


class Candidate:
    """A sum of four sines for each axis, at multiples of 1/length, that begins and ends at rest; if it tilts a ball at
    rest, it leaves it at rest. `turns`: directions in which its numbers may change."""

    slopes: Array = np.empty(0)
    merit: Any = -np.inf

    def __init__(self, experiment: Experiment, random: np.random.Generator, middle: float) -> None:
        waves, turns = np.ones((1, 2, 4)), []
        for axis in experiment.axes:
            multiples: List[int] = []
            while len(multiples) < 4:
                drawn = round(middle * np.exp(0.8 * random.normal()))
                multiples += [drawn] if 1 <= drawn <= experiment.highest and drawn not in multiples else []
            waves[0, axis] = _TURN / experiment.length * np.sort(multiples)
            w = waves[0, axis] / waves[0, axis, 0]
            # Tilts proportional to w^2 move the ball equally at all frequencies.
            weights = np.tile(w ** (2 * random.uniform() - 0.5 if experiment.tilts else 1.5 * random.uniform() - 2), 2)
            zero = np.zeros((3 if experiment.tilts else 2, 8))
            zero[0, :4], zero[1, 4:], zero[2:, 4:] = 1, w, 1 / w  # value, rate, and the velocity that a tilt leaves
            its = np.linalg.svd(zero * weights)[2][len(zero) :] * weights
            turns.append(np.pad(its, ((0, 0), (8 * axis, 12 - 8 * axis))))
        self.turns = np.concatenate(turns)
        numbers = random.normal(size=(1, len(self.turns))) @ self.turns
        self.motion = Motions(np.round(0.01 * numbers / np.abs(numbers).sum(), 10), waves)
        self.turns /= np.linalg.norm(self.turns, axis=1)[:, None]
        if experiment.tilts:
            self.turns = np.concatenate([self.turns, np.eye(20)[[16 + axis for axis in experiment.axes]]])

    def changed(self, changes: Array) -> Motions:
        size = np.where(np.arange(20) < 16, np.linalg.norm(self.motion.numbers[:, :16]), 0.05)  # rad or m
        # Rounded, because rounding errors of matrix products depend on addresses.
        numbers = np.round(self.motion.numbers + np.round(changes, 4) @ (self.turns * size), 10)
        return Motions(numbers, np.repeat(self.motion.waves, len(changes), 0))

    def best(self, near: Motions, slopes: Array) -> Motions:
        """Motions on the way to the best one within the limits, if slopes and shares are linear between this motion
        and those near it."""
        count, keys = len(slopes), slopes.shape[-1]
        runs = np.isfinite(near.shares).all((1, 2))
        shares = np.concatenate([self.motion.shares, np.where(runs[:, None, None], near.shares, 0)])
        shares = shares[:, :, :: max(1, shares.shape[-1] // 100)].reshape(1 + count, -1)
        by = (shares[1:] - shares[0]) / _NEAR
        flat = np.moveaxis(np.concatenate([self.slopes[None], slopes]), 0, 1).reshape(slopes.shape[1], -1)
        products = (flat.T @ flat).reshape(1 + count, keys, 1 + count, keys)

        def loss(change: Array) -> Tuple[float, Array]:
            weights = np.append(1 - change.sum() / _NEAR, change / _NEAR)
            half = np.tensordot(weights, products, 1)
            information = np.tensordot(half, weights, ([1], [0])) + _FLOOR * np.eye(keys)
            slope = -2 * np.einsum("kl,knl->n", np.linalg.inv(information), half) / _NEAR
            return -np.linalg.slogdet(information)[1], slope[1:] - slope[0]

        limits = {"type": "ineq", "fun": lambda change: 1 - shares[0] - change @ by, "jac": lambda change: -by.T}
        bounds = [(-run, run) for run in runs.astype(float)]
        change = minimize(loss, np.zeros(count), jac=True, method="SLSQP", bounds=bounds, constraints=limits).x
        return self.changed(np.outer(_PARTS, change))


def best_sines(experiment: Experiment, middle: float) -> Candidate:
    """Draws motions with multiples around `middle`, and improves the best ones as long as their merits grow."""
    random = np.random.default_rng(1)
    active = owners = pool = [Candidate(experiment, random, middle) for _ in range(_DRAWS)]
    motions = join(candidate.motion[:2] for candidate in pool)
    first = 6 if experiment.tilts else 12
    for count in (first, first // 2, 3, 3, 2, 2, 2, 2, 0):
        before = [candidate.merit for candidate in active]
        found = within(experiment, motions, experiment.tilts)
        for i, slopes in zip(found, experiment.slopes(join(found.values()))[0] if found else np.empty(0)):
            if merits(slopes) > owners[i].merit:
                owners[i].motion, owners[i].slopes, owners[i].merit = found[i], slopes, merits(slopes)
        active = [candidate for candidate, merit in zip(active, before) if candidate.merit > merit + 0.1]
        active = sorted(active, key=lambda candidate: -candidate.merit)[:count]
        if not active:
            break
        neighbors = join(candidate.changed(_NEAR * np.eye(len(candidate.turns)))[:2] for candidate in active)
        near = experiment.play(neighbors)[0]
        slopes = np.split(experiment.slopes(near)[0], len(active))
        nears = [near.take(its) for its in np.split(np.arange(len(near.numbers)), len(active))]
        motions = join(candidate.best(*its)[:2] for candidate, *its in zip(active, nears, slopes))
        owners = [candidate for candidate in active for _ in _PARTS]
    return max(pool, key=lambda candidate: candidate.merit)


def circles(experiment: Experiment, pull: float) -> Motions:
    """Circles of the ball from (1, 0), counterclockwise; in a groove, sines. Without a controller, it is launched.
    `pull`: the ball's acceleration by a tilt (m/s^2)."""
    multiples = [1]
    while multiples[-1] < experiment.highest:
        multiples.append(max(multiples[-1] + 1, int(multiples[-1] * 1.33)))
    w = _TURN / experiment.length * np.array([multiple for multiple in multiples if multiple <= experiment.highest])
    radius = 0.01 * pull / w**2 if experiment.tilts else np.full(len(w), 0.01)
    numbers = np.zeros((len(w), 20))  # phi accelerates the ball along x, theta against y
    numbers[:, 0], numbers[:, 12] = -0.01 if experiment.tilts else 0.01, 0.01
    numbers[:, 16], numbers[:, 19] = radius, radius * w
    numbers *= np.isin(np.repeat([0, 1, 0, 1, 0, 1], [8, 8, 1, 1, 1, 1]), experiment.axes)
    return Motions(numbers, np.tile(w[:, None, None], (1, 2, 4)))


def step(experiment: Experiment) -> Motions:
    """A step of both axes at a tenth of the time, that takes 0.1 s: the quintic of least jerk."""
    times = np.linspace(0, experiment.length, int(np.ceil(experiment.length / 0.02)) + 1)
    s = np.clip((times - experiment.length / 10) / 0.1, 0, 1)
    rows = np.outer(np.isin([0, 1], experiment.axes), 0.01 * s**3 * (10 + s * (6 * s - 15)))
    return Motions(np.append(rows, [0] * 4)[None], np.empty((1, 0)))


def section_of(rig: _bbsim.Given, sketch: Optional[str]) -> str:
    """What plays the motion."""
    for tilts in ("controller.commands", "gimbal.motion"):
        if rig.has(tilts):
            return tilts
    if not rig.has("controller"):
        raise fault("gimbal.torque: found, which a design cannot choose; allowed: gimbal.motion, or a controller with a "
                    "reference")  # fmt: skip
    refuse_own_controller(rig, "a design", "a law of bbsim, controller.commands, or gimbal.motion")
    if sketch:
        raise fault("sketch: the scenario has a controller with a reference; allowed: with gimbal.motion or controller."
                    "commands, whose tilts a sketch can play; --table writes the reference for your own firmware")
    return "controller.reference"


def axes_of(rig: _bbsim.Given) -> List[int]:
    """The axes that move the ball; one if it is in a groove, across which the reader refuses a start."""
    if rig.has("ball.rolling_radius"):
        try:
            rig.number_at("ball.position.0", "1e-9")
        except InputError:
            return [1]
        return [0]
    return [0, 1]


def limits_of(rig: _bbsim.Given, tilt: Optional[float], rate: Optional[float], margin: Optional[float]) -> List[Any]:
    """Limits on a motion: kind, name, size, source; and columns with factors, whose products are at most 1."""
    sides = [side for side in (rig.value(f"plate.{key}") for key in ("size.0", "size.1", "diameter")) if side]
    if not sides:
        raise fault("plate: has no size, but the ball must stay on it; allowed: with plate.size or plate.diameter, such as "
                    '--set "plate.size=[30 cm, 30 cm]"')  # fmt: skip
    half, short, rounded = min(sides) / 2, _bbsim.short_number, _bbsim.rounded
    margin = half / 5 if margin is None else margin
    if margin >= half:
        raise refuse("margin", f"{short(margin)} m", f"a length from 0 to below half the plate, {short(half)} m")
    edges = [side / 2 - margin for side in sides]
    # Only of servos that turn the plate directly. At its limits, a servo no longer follows.
    links = rig.has("gimbal.linkage") or rig.has("gimbal.three_servos")
    of_servos = not links and (rig.has("gimbal.servo") or rig.has("gimbal.motor.position_loop"))
    command, angle, speed = 0.95 * np.array(rig.rig_limits() if of_servos else [[np.inf] * 3] * 2, float).T
    total, friction = None if tilt else rig.value("events.tilt.limit"), rig.value("events.slip.friction")
    tilts = np.full(2, tilt) if tilt else np.fmin(np.fmin(command, angle), np.inf)
    by_servo = (angle < np.fmin(command, np.inf)).any()
    tilts_from = ("--max-tilt" if tilt else "gimbal.servo.angle_limit" if by_servo else "controller.limit"
                  if np.isfinite(tilts).any() else "events.tilt" if total else "usual; --max-tilt sets it")  # fmt: skip
    tilts[np.isinf(tilts)] = total or np.radians(10)  # of a hobby servo with a horn and a rod
    rates = np.full(2, rate) if rate else np.where(np.isfinite(speed), speed, np.radians(60))
    rates_from = ("--max-tilt-rate" if rate else "gimbal.servo.rate_limit" if np.isfinite(speed).any() else
                  "usual; --max-tilt-rate sets it")  # fmt: skip

    def parts(columns: Sequence[str], most: Any) -> List[Tuple[str, float]]:
        return [(column, sign / limit) for column, limit in zip(columns, most) for sign in (1, -1)]

    def degrees(most: Any) -> str:
        return " and ".join(dict.fromkeys(rounded(np.degrees(angle), 3) for angle in most)) + " deg"

    limits = [
        ("edge", "ball from the center", " and ".join(rounded(100 * edge, 4) for edge in edges) + " cm",
         "plate and margin", parts(("x", "y") if len(edges) > 1 else ("distance",), edges)),
        ("tilt", "tilt", degrees(tilts) + (f", in all {degrees([total])}" if total else ""), tilts_from,
         parts(("phi", "theta"), tilts) + (parts(("tilt",), [total]) if total else [])),
        ("tilt_rate", "tilt rate", f"{degrees(rates)}/s", rates_from, parts(("phi_rate", "theta_rate"), rates)),
    ]  # fmt: skip
    if friction:
        needed = parts(("friction_demand",), [friction])
        limits.append(("friction", "friction that rolling needs", short(friction), "events.slip", needed))
    return limits


def noise_of(rig: _bbsim.Given, axes: List[int], texts: Sequence[str], units: Dict[str, str]) -> Dict[str, float]:
    """The standard deviation of each column of the log. Rounding acts like an error that is uniformly distributed."""
    noise, resolution = (rig.value(f"controller.sensor.{key}") or 0.0 for key in ("noise", "resolution"))
    sizes = {("x", "y")[i]: float(np.hypot(noise, resolution / np.sqrt(12))) or 1e-3 for i in axes}
    for text in texts:
        name, _, deviation = (part.strip() for part in text.partition("="))
        size = _bbsim.value_in(deviation, units[name]) if name in units and name != "t" else None
        if not size or size < 0:
            allowed = "COLUMN=SIZE, a column of `bbsim columns` and a standard deviation greater than 0, such as x=0.5mm"
            raise refuse("noise", f'"{text}"', allowed)
        why = rig.lacks(name)
        if why:
            raise refuse("noise", f"{name}, {why}", "columns that the scenario has")
        sizes[name] = size
    return sizes


def player_sketch(hertz: float, tilts: Array, place: Array) -> str:
    """An Arduino sketch that plays tilts from its flash, as 16-bit integers, and prints a log."""
    rows, most = tilts.shape[1], 32767 // 4  # avr-gcc refuses an array of more bytes
    if rows > most:
        allowed = f"at most {most}, which a board's flash holds; use a lower --rate or a shorter --length"
        raise refuse("sketch", f"{rows} rows", allowed)
    unit = 0.001 if np.abs(np.degrees(tilts)).max() < 32 else 0.01
    pairs = [f"{{{phi}, {theta}}}," for phi, theta in np.rint(np.degrees(tilts.T) / unit).astype(int)]
    table = "\n".join("  " + " ".join(pairs[i : i + 6]) for i in range(0, rows, 6))
    x, y = (_bbsim.short_number(100 * coordinate) for coordinate in place)
    parts = {"X": x, "Y": y, "ROWS": rows, "UNIT": unit, "PERIOD": round(1e6 / hertz), "TABLE": table}
    text = (Path(__file__).parent / "player.ino").read_text("utf-8")
    return re.sub("@([A-Z]+)@", lambda found: str(parts[found[1]]), text)


def text_of(value: float) -> str:
    return repr(float(value)).removesuffix(".0")


def design(scenario: Union[Scenario, _bbsim.Given], free: Union[str, Sequence[str], Mapping[str, Any]], *,
           set: Settings = None, length: Size = None, rate: Size = None, noise: Union[str, Sequence[str]] = (),
           window: Size = None, max_tilt: Size = None, max_tilt_rate: Size = None, margin: Size = None,
           output: Optional[str] = None, table: Optional[str] = None, json: Optional[str] = None,
           sketch: Optional[str] = None, threads: Optional[int] = None,
           progress: Progress = silent) -> SimpleNamespace:  # fmt: skip
    """Chooses the motion whose log determines keys of a scenario best. Keywords are options of ``bbsim design``; sizes
    are numbers in SI units, or texts with a unit; ``noise`` is a text or a list, such as "x=0.5mm".

    free      the keys: "KEY" or "KEY=FROM:TO", or a dict {KEY: (FROM, TO)}

    The result has the names of the JSON as attributes, and ``report``. Raises InputError and OutputError.
    """
    rig, short = given(scenario, set), _bbsim.short_number
    output, table = (file and os.fspath(file) for file in (output, table))
    if table and table != "-" and not table.lower().endswith(".csv"):
        raise refuse("table", table, "FILE.csv, or - for standard output")
    if output and (table == "-" or (not table and output == "-")):
        raise fault("table: found no file, and the scenario of -o must name one; allowed: FILE.csv")
    table = table or (os.path.splitext(output)[0] + "-motion.csv" if output else None)  # a run writes FILE.csv
    named = {"table": table, "output": output, "sketch": sketch, "json": json}
    files = files_of(named, rig, {}, "table", "output", "sketch", "json")  # the scenario refers to the table
    section = section_of(rig, sketch)
    tilts = section != "controller.reference"
    sizes: Dict[str, Any] = {}
    for option, value in zip(_SIZES, (rate, length, window, max_tilt, max_tilt_rate, margin)):
        unit, allowed = _SIZES[option]
        sizes[option] = None if value is None else _bbsim.value_in(str(value), unit)
        if value is not None and not (sizes[option] or 0) > 0:
            raise refuse(option, str(value) if option == "rate" else f'"{value}"', allowed)
    period = rig.value("controller.sensor.period") or rig.value("controller.sampling.period")
    # Boards and sensors exchange values more often than a log has rows.
    hertz = sizes["rate"] or (min(1 / period, 200.0) if period else 50.0)
    end = sizes["length"] or rig.value("time.end") or 0.0
    rows = round(end * hertz)
    if not 16 <= rows <= 100_000:
        raise refuse("length", f"{end:.12g} s at {hertz:.12g} Hz", "a log of 16 to 100000 rows")
    seconds, axes = rows / hertz, axes_of(rig)
    units = {column[0]: column[2] for column in _bbsim.known_columns("rad")}
    deviations_of_log = noise_of(rig, axes, listed("noise", noise), units)
    limits = limits_of(rig, sizes["max-tilt"], sizes["max-tilt-rate"], sizes["margin"])

    def settings(file: str, place: Sequence[float] = (0, 0)) -> List[Tuple[str, str]]:
        """Make the scenario play a table, with the scale, offset and delay of its own."""
        file, profiles = "'" + file.replace("'", "''") + "'", []
        for i, name in enumerate(("phi", "theta")):
            own = [key for key in ("scale", "offset", "delay") if rig.has(f"{section}.{name}.table.{key}")]
            more = [f", {key}: {text_of(rig.value(f'{section}.{name}.table.{key}') or 0)}" for key in own]
            its = f"{{table: {{file: {file}, time: t, value: {name}, unit: rad{''.join(more)}}}}}"
            profiles.append(f"{name}: {its if i in axes else 0}")
        reference = f"table: {{file: {file}, time: t, x: x, y: y, unit: m}}"
        moves = rig.value("ball.velocity.0") or rig.value("ball.velocity.1")
        return [(section, f"{{{', '.join(profiles) if tilts else reference}}}"),
                ("ball.position", f"[{text_of(place[0])}, {text_of(place[1])}]"),
                *([("ball.velocity", "[0, 0]")] if moves else []),
                ("time.end", text_of(seconds)), ("time.step", text_of(1 / hertz))]  # fmt: skip

    name_of_table = os.path.relpath(table, os.path.dirname(os.path.abspath(output))) if output and table else ""
    if output:
        rig.edited(settings(name_of_table), "")  # fails now if the text cannot be written
    with tempfile.TemporaryDirectory(prefix="bbsim-") as folder:
        still, names = Path(folder) / "still.csv", "phi,theta" if tilts else "x,y"
        still.write_text(f"t,{names}\n" + "".join(f"{seconds * i / 3!r},0,0\n" for i in range(4)))
        plain = rig.changed(settings(str(still)))
        keys = read_free_keys(listed("free", free, from_to), plain)
        if not keys:
            raise refuse("free", "no key of the scenario", "keys that a fit may free, but not those of a log")
        parts, cut = [part for limit in limits for part in limit[-1]], sizes["window"] or (2 if tilts else 2 * seconds)
        experiment = Experiment(plain, section, axes, keys, deviations_of_log, cut, seconds, hertz, parts,
                                int(threads or 0), progress)  # fmt: skip
        turned = (rig.value("ball.rolling_radius") or 1) / ((rig.value("ball.radius") or 1) if len(axes) < 2 else 1)
        pull = (rig.value("gravity") or 0) / (1 + (rig.value("ball.inertia_factor") or 0) / turned**2)
        circle, frequency = None, 3.0  # rad/s
        found = within(experiment, circles(experiment, pull))
        if found:  # it shows which frequencies are informative
            tried_circles = join(found.values())
            circle = tried_circles.take([np.argmax(merits(experiment.slopes(tried_circles)[0]))])
            frequency = float(circle.waves[0, 0, 0])
        chosen = best_sines(experiment, frequency * seconds / _TURN)
        if not np.isfinite(chosen.merit):
            share = experiment.play(Motions(np.zeros((1, 2 * rows + 6)), np.empty((1, 0))))[0].shares.max()
            why = ("the scenario does not run to its end without a motion" if np.isinf(share) else
                   "without a motion, the ball or the plate goes beyond its limits" if share > 1 else
                   "found no motion within the limits")  # fmt: skip
            allowed = f"a rig that keeps the ball on the plate for {short(seconds)} s, or a shorter --length"
            raise fault(f"{why}; allowed: {allowed}")
        tried, final = experiment.played, chosen.motion.table(experiment.times)
        place = final.numbers[0, -4:-2] = np.round(final.numbers[0, -4:-2], 3) + 0.0  # placed by hand
        rise = within(experiment, step(experiment)).get(0)
        played: List[Any] = [motion and experiment.play(motion)[0] for motion in (final, circle, rise)]
        slopes, effects = zip(*(experiment.slopes(motion, True) if motion else (None, None) for motion in played))
    idle = [key.name for key, effect in zip(keys, effects[0][0]) if effect <= 1e-6]  # in units of noise
    if idle:
        what = f"free: {idle[0]}: has no effect on {', '.join(deviations_of_log)}"
        raise fault(f"{what}; allowed: keys that the log's columns depend on")
    of_u = [np.full(len(keys), np.inf) if slope is None else deviations(slope[0]) for slope in slopes]
    sds = [[float(f"{sd * abs(key.slope(0)):.8g}") for sd, key in zip(of_motion, keys)] for of_motion in of_u]
    used = dict.fromkeys((limit[0] for limit in limits), 0.0)
    for (kind, *_), share in zip((limit for limit in limits for _ in limit[-1]), played[0].shares[0].max(1)):
        used[kind] = max(used[kind], float(share))
    sines: Dict[str, List[Any]] = {name: [] for name in experiment.names}
    for i in axes:
        cosine, sine = chosen.motion.numbers[0, 8 * i : 8 * i + 8].reshape(2, 4)
        waves = np.stack([np.hypot(cosine, sine), chosen.motion.waves[0, i], np.arctan2(cosine, sine)], 1).tolist()
        sines[experiment.names[i]] = [dict(zip(("amplitude", "frequency", "phase"), wave)) for wave in waves]
    result = {
        "parameters": [dict(zip(("key", "value", "sd", "circle_sd", "step_sd"), (key.name, float(key.value(0)), *its)))
                       for key, *its in zip(keys, *sds)],
        "length": seconds, "rate": hertz, "noise": deviations_of_log, "used": used, "position": place.tolist(),
        "sines": sines, "identifiable": bool(np.isfinite(sds[0]).all()),
    }  # fmt: skip
    begin = f"begin with the ball at rest at x = {short(100 * place[0])} cm, y = {short(100 * place[1])} cm"
    shown = [[f"{sd:.3g}" if np.isfinite(sd) else "-" for sd in its] for its in zip(*sds)]
    comments = (f"# Designed by bbsim {_bbsim.__version__}: plays {name_of_table}, {short(seconds)} s; {begin}\n"
                "# Standard deviations to expect from a fit:\n")  # fmt: skip
    for key, (designed, *_) in zip(keys, shown):
        comments += f"#   {key.name}: {designed}" + f" {key.unit}" * (designed != "-" and key.unit != "") + "\n"
    commands = experiment.commands(final)[0]
    lines = [",".join(map(text_of, row)) for row in zip(experiment.times, *commands)]
    texts = {
        "table": "\n".join([f"t,{names}", *lines, ""]), "json": as_json(result),
        "sketch": player_sketch(hertz, commands, place) if sketch else "",
        "output": rig.edited(settings(name_of_table, place), comments) if output else "",
    }  # fmt: skip
    write_all(rig, files, texts, lambda text: None)
    made = loads(texts["json"], object_hook=lambda its: SimpleNamespace(**its))
    better = circle and merits(slopes[0])[0] < merits(slopes[1])[0]
    circling = f"; the best circle has {frequency / _TURN:.3g} Hz" if circle else ""
    logged = ", ".join(f"{name} {size:.3g} {units[name]}".strip() for name, size in deviations_of_log.items())
    windows = counted(experiment.windows, "window")
    by_key = [[key.name, short(key.value(0)), *its, key.unit or "1"] for key, its in zip(keys, shown)]
    percent = {kind: f"{_bbsim.rounded(100 * share, 3)} %" for kind, share in used.items()}
    by_limit = [[name, size, percent[kind], source] for kind, name, size, source, _ in limits]
    made.report = "\n".join([
        _bbsim.aligned([["standard deviation", "value", "designed", "circle", "step", "unit"], *by_key]),
        _bbsim.aligned([["limit", "of", "used", "from"], *by_limit]),
        f"{short(seconds)} s at {short(hertz)} Hz: {experiment.numbers} numbers in {windows}; noise {logged}",
        f"best of {tried} motions{circling}", begin,
        *["the circle determines the keys better" + ", but its ball is launched" * tilts] * bool(better),
        *(f"not identifiable: {key.name}, which a log of this length cannot separate from the other keys and the "
          "windows' starts" for key, its in zip(keys, shown) if its[0] == "-"), "",
    ])  # fmt: skip
    return made


def command(options: Dict[str, Any], say: Any) -> int:
    def task(rig: _bbsim.Given, options: Dict[str, Any], progress: Progress, say: Any) -> SimpleNamespace:
        for remark in rig.remarks():
            say(remark)
        return design(rig, **options, progress=progress)

    return 130 if carry_out("design", task, options, say) is None else 0
