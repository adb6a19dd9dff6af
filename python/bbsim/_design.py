# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The motion whose log determines keys of a scenario best: bbsim.design and `bbsim design`."""

from __future__ import annotations

import os
import sys
import tempfile
from json import loads
from pathlib import Path
from types import SimpleNamespace
from typing import Any, Dict, List, NoReturn, Optional, Sequence, Tuple, Union

import numpy as np
from scipy.optimize import minimize

from . import _bbsim
from ._errors import InputError
from ._experiment import Experiment, Motions
from ._found_files import aligned, as_json, declare, reports, write
from ._free_keys import read_free_keys
from ._progress import Bar, Progress, silent
from ._scenario import Scenario, Settings, given
from ._simulate import Array, refuse

_TURN = 2 * np.pi
_FLOOR = 1e-8  # of information: a number u of size 1 with a standard deviation of 1e4 is unknown
_DRAWS = 60
_NEAR = 0.1  # of a motion's size, for differences
_PARTS = (1, 0.3, 0.1)  # of the way to the best motion nearby


def merits(slopes: Array) -> Array:
    """The logarithm of the determinant of Fisher's information, for each motion. Its floor ranks motions that determine
    all keys above all others."""
    information = np.swapaxes(slopes, -1, -2) @ slopes
    return np.linalg.slogdet(information + _FLOOR * np.eye(slopes.shape[-1]))[1]


def deviations(slopes: Array) -> Array:
    """The standard deviation of each number u; infinite if the log does not determine it."""
    sizes = np.maximum(np.linalg.norm(slopes, axis=0), 1e-150)
    _, values, vectors = np.linalg.svd(slopes / sizes, full_matrices=False)
    known = values**2 > 1e-8 * max(values[0] ** 2, 1e-150)  # the error of differences
    variances = ((vectors[known] / values[known, None]) ** 2).sum(0)
    return np.where((np.abs(vectors[~known]) > 0.02).any(0), np.inf, np.sqrt(variances) / sizes)


def within(experiment: Experiment, motions: Motions, centered: bool = False) -> Dict[int, Motions]:
    """The motions at the largest scale that keeps the limits, of those that have one."""
    scale, largest, active = np.ones(len(motions.start)), np.zeros(len(motions.start)), np.arange(len(motions.start))
    values, waves, start = motions[:3]
    best = {}
    for _ in range(10):
        by = scale[active, None]
        played, middle = experiment.play(Motions(values[active] * by[..., None], waves[active], start[active] * by))
        greatest = played.shares.max((1, 2))
        for i in np.flatnonzero((greatest <= 1) & (scale[active] > largest[active])):
            best[active[i]], largest[active[i]] = played.take([i]), scale[active[i]]
        if centered:  # the path has the most room in the middle of the plate
            start[active, :2] -= middle / by
        # The use is almost proportional to the scale, except for parts that do not scale, such as an offset.
        scale[active] *= np.clip(np.where(np.isfinite(greatest), 0.99 / np.maximum(greatest, 1e-6), 0.2), 0.1, 100)
        active = active[(greatest > 1) | (greatest < 0.97)]
        if not len(active):
            break
    return best


def join(motions: Any) -> Motions:
    return Motions(*map(np.concatenate, zip(*motions)))


class Candidate:
    """A sum of four sines for each axis, at multiples of 1/length, that begins and ends at rest; if it tilts a ball at
    rest, it leaves it at rest. `turns` and `places` are directions in which amplitudes and starts may change."""

    slopes, merit = np.empty(0), -np.inf

    def __init__(self, experiment: Experiment, random: np.random.Generator, middle: float) -> None:
        waves, turns = np.ones((1, 2, 4)), []  # rad/s
        for axis in experiment.axes:
            multiples: List[int] = []
            while len(multiples) < 4:
                drawn = round(middle * np.exp(0.8 * random.normal()))
                multiples += [drawn] if 1 <= drawn <= experiment.highest and drawn not in multiples else []
            waves[0, axis] = _TURN / experiment.length * np.sort(multiples)
            w = waves[0, axis] / waves[0, axis, 0]
            # Tilts proportional to w^2 move the ball equally at all frequencies.
            power = 2 * random.uniform() - 0.5 if experiment.tilts else 1.5 * random.uniform() - 2
            rest = np.zeros((3 if experiment.tilts else 2, 8))
            rest[0, :4], rest[1, 4:], rest[2:, 4:] = 1, w, 1 / w  # value, rate, and the velocity that a tilt leaves
            weights = np.tile(w**power, 2)
            turns.append(np.zeros((8 - len(rest), 2, 8)))
            turns[-1][:, axis] = np.linalg.svd(rest * weights)[2][len(rest) :] * weights
        self.turns = np.concatenate(turns)
        values = np.tensordot(random.normal(size=len(self.turns)), self.turns, 1)
        self.motion = Motions(0.01 / np.abs(values).sum() * values[None], waves, np.zeros((1, 4)))
        moves = experiment.axes if experiment.tilts else []
        self.turns /= np.linalg.norm(self.turns, axis=(1, 2), keepdims=True)
        self.places = np.zeros((len(self.turns) + len(moves), 4))
        self.places[len(self.turns) :, moves] = 0.05 * np.eye(len(moves))  # m
        self.turns = np.concatenate([self.turns, np.zeros((len(moves), 2, 8))])

    def take(self, motion: Motions, slopes: Array) -> None:
        if merits(slopes) > self.merit:
            self.motion, self.slopes, self.merit = motion, slopes, merits(slopes)

    def changed(self, changes: Array) -> Motions:
        values, waves, start = self.motion[:3]
        turns = np.linalg.norm(values) * np.tensordot(changes, self.turns, 1)
        return Motions(values + turns, np.repeat(waves, len(changes), 0), start + changes @ self.places)

    def best(self, near: Motions, slopes: Array) -> Motions:
        """Motions on the way to the best one within the limits, if slopes and shares are linear between this one and
        those near it."""
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
    """Draws motions, and improves the best ones as long as their merits grow."""
    random = np.random.default_rng(1)
    active = owners = pool = [Candidate(experiment, random, middle) for _ in range(_DRAWS)]
    motions = join(one.motion[:3] for one in pool)
    first = 6 if experiment.tilts else 12
    for count in (first, first // 2, 3, 3, 2, 2, 2, 2, 0):
        before = [one.merit for one in active]
        found = within(experiment, motions, experiment.tilts)
        for i, slopes in zip(found, experiment.slopes(join(found.values()))[0] if found else []):
            owners[i].take(found[i], slopes)
        active = [one for one, merit in zip(active, before) if one.merit > merit + 0.1]
        active = sorted(active, key=lambda one: -one.merit)[:count]
        if not active:
            break
        near = experiment.play(join(one.changed(_NEAR * np.eye(len(one.turns))) for one in active))[0]
        slopes = np.split(experiment.slopes(near)[0], len(active))
        nears = [near.take(some) for some in np.split(np.arange(len(near.start)), len(active))]
        motions = join(one.best(*its)[:3] for one, *its in zip(active, nears, slopes))
        owners = [one for one in active for _ in _PARTS]
    return max(pool, key=lambda one: one.merit)


def circles(experiment: Experiment, rig: _bbsim.Given) -> Motions:
    """Circles of the ball (in a groove, sines) from (1, 0) counterclockwise; without a controller, it is launched."""
    multiples = [1]
    while max(multiples[-1] + 1, int(multiples[-1] * 1.33)) <= experiment.highest:
        multiples.append(max(multiples[-1] + 1, int(multiples[-1] * 1.33)))
    w = _TURN / experiment.length * np.array(multiples)
    value = {key: _bbsim.key_facts(rig, "", key).value for key in ("gravity", "ball.inertia_factor", "ball.radius")}
    turned = (_bbsim.key_facts(rig, "", "ball.rolling_radius").value or value["ball.radius"]) / value["ball.radius"]
    values, start = np.zeros((len(w), 2, 8)), np.zeros((len(w), 4))
    # phi accelerates the ball along x, theta against y.
    values[:, 0, 0], values[:, 1, 4] = -0.01 if experiment.tilts else 0.01, 0.01
    radius = 0.01 * value["gravity"] / (1 + value["ball.inertia_factor"] / turned**2) / w**2 if experiment.tilts else 0.01
    start[:, 0], start[:, 3] = radius, radius * w
    other = [i for i in (0, 1) if i not in experiment.axes]
    values[:, other], start[:, other], start[:, [2 + i for i in other]] = 0, 0, 0
    return Motions(values, np.tile(w[:, None, None], (1, 2, 4)), start)


def limits_of(rig: _bbsim.Given, tilt: Optional[float], rate: Optional[float], margin: Optional[float]) -> List[Any]:
    """Limits on a motion: kind, text, source, and columns with factors whose products are at most 1."""

    def facts(key: str) -> Optional[float]:
        return _bbsim.key_facts(rig, "", key).value

    sides = [side for side in (facts("plate.size.0"), facts("plate.size.1"), facts("plate.diameter")) if side]
    if not sides:
        allowed = 'allowed: with plate.size or plate.diameter, such as --set "plate.size=[30 cm, 30 cm]"'
        raise InputError([("", f"plate: has no size, but the ball must stay on it; {allowed}")])
    half, short = min(sides) / 2, _bbsim.short_number
    margin = half / 5 if margin is None else margin
    if not margin < half:
        raise refuse("margin", f"{short(margin)} m", f"a length from 0 to below half the plate, {short(half)} m")
    edges = [side / 2 - margin for side in sides]
    direct = not (_bbsim.has(rig, "gimbal.linkage") or _bbsim.has(rig, "gimbal.three_servos"))
    of_angle = direct and (_bbsim.has(rig, "gimbal.servo") or _bbsim.has(rig, "gimbal.motor.position_loop"))
    # At its limits, a servo no longer follows.
    own = 0.95 * np.array(_bbsim.rig_limits(rig) if of_angle else [[None] * 3] * 2, float).T
    command, angle, speed = np.nan_to_num(own, nan=np.inf)
    total, friction = None if tilt else facts("events.tilt.limit"), facts("events.slip.friction")
    tilts = np.full(2, tilt) if tilt else np.minimum(command, angle)
    source = ("--max-tilt" if tilt else "gimbal.servo.angle_limit" if (angle < command).any() else "controller.limit"
              if np.isfinite(tilts).any() else "events.tilt" if total else "usual; --max-tilt sets it")  # fmt: skip
    tilts[np.isinf(tilts)] = total or np.radians(10)  # of a hobby servo with a horn and a rod
    rates = np.full(2, rate) if rate else np.where(np.isinf(speed), np.radians(60), speed)
    rate_source = ("--max-tilt-rate" if rate else "gimbal.servo.rate_limit" if np.isfinite(speed).any()
                   else "usual; --max-tilt-rate sets it")  # fmt: skip

    def both(names: Tuple[str, str], most: Any) -> List[Tuple[str, float]]:
        return [(name, sign / one) for name, one in zip(names, most) for sign in (1, -1)]

    def degrees(most: Array, unit: str) -> str:
        texts = [_bbsim.rounded(np.degrees(one), 3) for one in most]
        return " and ".join(dict.fromkeys(texts)) + unit

    all_tilts = f", in all {_bbsim.rounded(np.degrees(total), 3)} deg" if total else ""
    limits = [
        ["edge", "ball from the center", " and ".join(_bbsim.rounded(100 * one, 4) for one in edges) + " cm", "plate and margin",
         both(("x", "y"), edges) if len(edges) == 2 else [("distance", 1 / edges[0])]],
        ["tilt", "tilt", degrees(tilts, " deg") + all_tilts, source,
         both(("phi", "theta"), tilts) + ([("tilt", 1 / total)] if total else [])],
        ["tilt_rate", "tilt rate", degrees(rates, " deg/s"), rate_source, both(("phi_rate", "theta_rate"), rates)],
    ]  # fmt: skip
    if friction:
        limits.append(["friction", "friction that rolling needs", short(friction), "events.slip", [("friction_demand", 1 / friction)]])
    return limits


def step(experiment: Experiment) -> Motions:
    """A step of both axes at a tenth of the time, that takes 0.1 s: the quintic of least jerk."""
    s = np.clip((experiment.times - experiment.length / 10) / 0.1, 0, 1)
    values = np.zeros((1, 2, len(s)))
    values[:, experiment.axes] = 0.01 * s**3 * (10 + s * (6 * s - 15))
    return Motions(values, np.empty((1, 0)), np.zeros((1, 4)))


class Design(SimpleNamespace):
    """What `bbsim design` finds, with the names of its JSON; `report`, `scenario`, `table` and `sketch` are its texts."""


def design(
    scenario: Union[Scenario, _bbsim.Given], free: Union[str, Sequence[str]], *, set: Settings = None, length: Any = None,
    rate: Any = None, noise: Union[str, Sequence[str]] = (), window: Any = None, max_tilt: Any = None,
    max_tilt_rate: Any = None, margin: Any = None, output: Optional[str] = None, table: Optional[str] = None,
    json: Optional[str] = None, sketch: Optional[str] = None, threads: int = 0, progress: Progress = silent,
) -> Design:  # fmt: skip
    """Chooses a motion whose log determines keys of a scenario best. The keywords are the options of ``bbsim design``.

    free      the keys: "KEY" or "KEY=FROM:TO"
    noise     standard deviations of the log's columns: "x=0.5mm"
    length    and all other sizes: numbers in SI or texts with units
    output    also writes the scenario that plays the motion to this file; ``table``, ``json`` and ``sketch`` likewise

    The result has the names of the JSON. Raises InputError and OutputError.
    """
    rig = given(scenario, set)

    def size(option: str, value: Any, unit: str, allowed: str) -> Optional[float]:
        number = None if value is None else _bbsim.value_in(str(value), unit)
        if value is not None and not (number and number > 0):
            raise refuse(option, f'"{value}"', allowed)
        return number

    def facts(key: str) -> Optional[float]:
        return _bbsim.key_facts(rig, "", key).value

    if table and table != "-" and not table.lower().endswith(".csv"):
        raise refuse("table", table, "FILE.csv, or - for standard output")
    if output and (table == "-" or (not table and output == "-")):
        raise InputError([("", "table: found no file, and the scenario of -o must name one; allowed: FILE.csv")])
    table = table or (os.path.splitext(output)[0] + "-motion.csv" if output else None)  # a run writes FILE.csv
    declare({"output": output, "json": json, "table": table, "sketch": sketch}, {rig.name: "the scenario"}, "table", "sketch")
    section = next((key for key in ("controller.commands", "gimbal.motion") if _bbsim.has(rig, key)), "controller.reference")
    if section == "controller.reference":
        if not _bbsim.has(rig, "controller"):
            allowed = "which a design cannot choose; allowed: gimbal.motion, or a controller with a reference"
            raise InputError([("", f"gimbal.torque: found, {allowed}")])
        if _bbsim.has(rig, "controller.program") or _bbsim.has(rig, "controller.library"):
            allowed = "a law of bbsim, controller.commands, or gimbal.motion"
            raise InputError([("", f"controller: found a program or library of your own; allowed in a design: {allowed}")])
        if sketch:
            allowed = ("with gimbal.motion or controller.commands, whose tilts a sketch can play; --table writes the reference "
                       "for your own firmware")  # fmt: skip
            raise InputError([("", f"sketch: the scenario has a controller with a reference; allowed: {allowed}")])
    axis = None if not _bbsim.has(rig, "ball.rolling_radius") else _bbsim.groove_axis(rig)
    axes = [0, 1] if axis is None else [axis]
    period = facts("controller.sensor.period") or facts("controller.sampling.period")
    hertz = size("rate", rate, "", "rows per second, such as 50") or (min(1 / period, 200) if period else 50.0)
    asked = size("length", length, "s", 'a time greater than 0, such as "10 s"') or facts("time.end") or 0.0
    rows, short = round(asked * hertz), _bbsim.short_number
    if not 16 <= rows <= 100_000:
        raise refuse("length", f"{asked:.12g} s at {hertz:.12g} Hz", "a log of 16 to 100000 rows")
    seconds = rows / hertz
    usual = np.hypot(facts("controller.sensor.noise") or 0, (facts("controller.sensor.resolution") or 0) / np.sqrt(12))
    of_column = {("x", "y")[i]: float(usual) or 1e-3 for i in axes}
    units = {column[0]: column[2] for column in _bbsim.known_columns("")}
    for text in [noise] if isinstance(noise, str) else noise:
        name, _, deviation = (part.strip() for part in text.partition("="))
        its = _bbsim.value_in(deviation, units[name]) if name in units and name != "t" else None
        if not its or its < 0:
            allowed = "COLUMN=SIZE, a column of `bbsim columns` and a standard deviation greater than 0, such as x=0.5mm"
            raise refuse("noise", f'"{text}"', allowed)
        why, _ = _bbsim.lacks(rig, name)
        if why:
            raise refuse("noise", f"{name}, {why}", "columns that the scenario has")
        of_column[name] = its
    cut = size("window", window, "s", 'a time greater than 0, such as 2 or "500 ms"')
    limits = limits_of(rig, size("max-tilt", max_tilt, "rad", 'an angle greater than 0, such as "8 deg"'),
                       size("max-tilt-rate", max_tilt_rate, "rad/s", 'a rate greater than 0, such as "60 deg/s"'),
                       size("margin", margin, "m", 'a length greater than 0, such as "3 cm"'))  # fmt: skip

    def settings(file: str, place: Any) -> List[Tuple[str, str]]:
        """Make the scenario play a table, with the scale, offset and delay of its own."""
        file = "'" + file.replace("'", "''") + "'"
        its = {}
        for i, name in enumerate(("phi", "theta")):
            own = f"{section}.{name}.table."
            more = [f", {key}: {facts(own + key)!r}" for key in ("scale", "offset", "delay") if _bbsim.has(rig, own + key)]
            its[name] = f"{{table: {{file: {file}, time: t, value: {name}, unit: rad{''.join(more)}}}}}" if i in axes else "0"
        profile = "{phi: " + its["phi"] + ", theta: " + its["theta"] + "}"
        reference = f"{{table: {{file: {file}, time: t, x: x, y: y, unit: m}}}}"
        return [(section, reference if section == "controller.reference" else profile),
                ("ball.position", "[" + ", ".join(map(text_of, place)) + "]"),
                *([("ball.velocity", "[0, 0]")] if facts("ball.velocity.0") or facts("ball.velocity.1") else []),
                ("time.end", text_of(seconds)), ("time.step", text_of(1 / hertz))]  # fmt: skip

    played = os.path.relpath(table, os.path.dirname(os.path.abspath(output))) if output and table else ""
    if output:
        _bbsim.edited(rig, settings(played, (0, 0)), "", False)  # fails now if the text cannot be written
    with tempfile.TemporaryDirectory(prefix="bbsim-") as folder:
        file, names = f"{folder}/still.csv", "phi,theta" if section != "controller.reference" else "x,y"
        Path(file).write_text(f"t,{names}\n" + "".join(f"{seconds * i / 3!r},0,0\n" for i in range(4)))
        plain = rig.changed(settings(file, (0, 0)))
        keys = read_free_keys([free] if isinstance(free, str) else free, plain)
        experiment = Experiment(plain, section, axes, keys, of_column, cut or (2 if section != "controller.reference" else 2 * seconds),
                                seconds, hertz, [part for one in limits for part in one[-1]], threads, progress)  # fmt: skip
        round_trip = within(experiment, circles(experiment, rig))
        circle, frequency = None, 3.0
        if round_trip:
            its = join(round_trip.values())
            best = int(np.argmax(merits(experiment.slopes(its)[0])))
            circle, frequency = its.take([best]), float(its.waves[best, 0, 0])
        chosen = best_sines(experiment, frequency * seconds / _TURN)
        if not np.isfinite(chosen.merit):
            refuse_limits(experiment)
        place = np.round(chosen.motion.start[0, :2], 3) + 0.0  # by hand
        final = Motions(chosen.motion.at(experiment.times), np.empty((1, 0)), np.append(place, [0, 0])[None])
        tried = experiment.played
        usual_step = within(experiment, step(experiment))
        others = [None if one is None else Motions(one.at(experiment.times) if one.waves.size else one.values, np.empty((1, 0)), one.start)
                  for one in (circle, usual_step.get(0))]  # fmt: skip
        several = experiment.play(join(one[:3] for one in (final, *others) if one))[0]
        slopes, effects = experiment.slopes(several, True)
    idle = [key.name for key, effect in zip(keys, effects[0]) if effect <= 1e-6]
    if idle:
        allowed = "allowed: keys that the log's columns depend on"
        raise InputError([("", f"free: {idle[0]}: has no effect on {', '.join(of_column)}; {allowed}")])
    found = iter([deviations(one) * [abs(key.slope(0)) for key in keys] for one in slopes])
    deviation, of_circle, of_step = (next(found).tolist() if one else [None] * len(keys) for one in (final, *others))
    used, first = {}, 0
    for kind, _, _, _, parts in limits:
        used[kind] = max(0.0, float(several.shares[0, first : first + len(parts)].max()))
        first += len(parts)
    values, waves = chosen.motion.values[0], chosen.motion.waves[0]
    result = {
        "parameters": [{"key": key.name, "value": float(key.value(0)), "sd": sd, "circle_sd": one, "step_sd": other}
                       for key, sd, one, other in zip(keys, deviation, of_circle, of_step)],
        "length": seconds, "rate": hertz, "noise": of_column, "used": used, "position": place.tolist(),
        "sines": {name: [{"amplitude": float(np.hypot(c, s)), "frequency": float(w), "phase": float(np.arctan2(c, s))}
                         for c, s, w in zip(values[i, :4], values[i, 4:], waves[i])] if i in axes else []
                  for i, name in enumerate(experiment.names)},
        "identifiable": bool(np.isfinite(deviation).all()),
    }  # fmt: skip
    begin = f"begin with the ball at rest at x = {short(100 * place[0])} cm, y = {short(100 * place[1])} cm"

    def shown(sd: Optional[float]) -> str:
        return _bbsim.rounded(sd, 3) if sd is not None and np.isfinite(sd) else "-"

    lines = [["standard deviation", "value", "designed", "circle", "step", "unit"]]
    for key, one in zip(keys, result["parameters"]):
        lines.append([key.name, short(one["value"]), *(shown(one[name]) for name in ("sd", "circle_sd", "step_sd")), key.unit or "1"])
    of_limits = [["limit", "of", "used", "from"]]
    of_limits += [[name, text, f"{_bbsim.rounded(100 * used[kind], 3)} %", source] for kind, name, text, source, _ in limits]
    log = f"{short(seconds)} s at {short(hertz)} Hz: {experiment.numbers} numbers in {experiment.windows} window"
    log += "s" * (experiment.windows != 1) + "; noise " + ", ".join(f"{name} {_bbsim.rounded(one, 3)} {units[name]}".rstrip() for name, one in of_column.items())
    tries = f"best of {tried} motions" + (f"; the best circle has {_bbsim.rounded(frequency / _TURN, 3)} Hz" if circle else "")
    unknown = "".join(f"not identifiable: {one['key']}, which a log of this length cannot separate from the other keys and the "
                      "windows' starts\n" for one in result["parameters"] if not np.isfinite(one["sd"]))  # fmt: skip
    report = f"{aligned(lines)}\n{aligned(of_limits)}\n{log}\n{tries}\n{begin}\n{unknown}"
    comments = f"# Designed by bbsim {_bbsim.__version__}: plays {played}, {short(seconds)} s; {begin}\n# Standard deviations to expect from a fit:\n"
    for key, sd in zip(keys, deviation):
        comments += f"#   {key.name}: {shown(sd)}" + (f" {key.unit}" if key.unit and np.isfinite(sd) else "") + "\n"
    commands = experiment.commands(final.values[0])
    csv = f"t,{','.join(experiment.names)}\n" + "".join(",".join(map(text_of, row)) + "\n" for row in zip(experiment.times, *commands))
    texts = {"table": csv, "json": as_json(result), "scenario": _bbsim.edited(rig, settings(played, place), comments, False) if output else "",
             "sketch": player_sketch(hertz, commands, place) if sketch else ""}
    for name, file in (("table", table), ("scenario", output), ("sketch", sketch), ("json", json)):  # the scenario refers to the table
        if file:
            write(file, texts[name])
    made = loads(texts["json"], object_hook=lambda its: SimpleNamespace(**its))
    return Design(**{**vars(made), "report": report})


def text_of(value: float) -> str:
    return repr(float(value))[:-2] if float(value).is_integer() and abs(value) < 1e15 else repr(float(value))


def refuse_limits(experiment: Experiment) -> NoReturn:
    still = experiment.play(Motions(np.zeros((1, 2, len(experiment.times))), np.empty((1, 0)), np.zeros((1, 4))))[0].shares.max()
    what = ("the scenario does not run to its end without a motion" if np.isinf(still) else
            "without a motion, the ball or the plate goes beyond its limits" if still > 1 else "found no motion within the limits")  # fmt: skip
    allowed = f"a rig that keeps the ball on the plate for {_bbsim.short_number(experiment.length)} s, or a shorter --length"
    raise InputError([("", f"{what}; allowed: {allowed}")])


def player_sketch(hertz: float, tilts: Array, place: Array) -> str:
    """An Arduino sketch that keeps the table in flash, as 16-bit integers, plays it and prints a log."""
    rows, most = tilts.shape[1], 32767 // 4  # avr-gcc refuses an array of more bytes
    if rows > most:
        allowed = f"at most {most}, which a board's flash holds; use a lower --rate or a shorter --length"
        raise refuse("sketch", f"{rows} rows", allowed)
    unit = 0.001 if np.abs(np.degrees(tilts)).max() < 32 else 0.01
    pairs = [f"{{{phi}, {theta}}}," for phi, theta in np.rint(np.degrees(tilts.T) / unit).astype(int).tolist()]
    lines = ["  " + " ".join(pairs[i : i + 6]) for i in range(0, rows, 6)]
    text = (Path(__file__).parent / "player.ino").read_text("utf-8")
    x, y = (_bbsim.short_number(100 * one) for one in place)
    for name, value in (("X", x), ("Y", y), ("PERIOD", round(1e6 / hertz)), ("ROWS", rows), ("UNIT", unit), ("TABLE", "\n".join(lines))):
        text = text.replace(f"@{name}@", str(value))
    return text


def command(options: Dict[str, Any], say: Any) -> int:
    """`bbsim design`; `say` prints a message unless -q is given."""
    rig, quiet = _bbsim.Given(options.pop("scenario"), None, options.pop("set"), None), options.pop("quiet")
    for remark in _bbsim.remarks(rig):
        say(remark)
    try:
        with Bar(rig.name, quiet) as progress:
            made = design(rig, **options, progress=progress)
    except KeyboardInterrupt:
        say("design: interrupted; nothing is written")
        return 130
    if reports(options, "table", "sketch"):
        sys.stdout.write(made.report)
        sys.stdout.flush()
    return 0
