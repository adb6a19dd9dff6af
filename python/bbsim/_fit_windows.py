# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Windows of logs: model minus log at any values of the free keys, with the best start of each window."""

from __future__ import annotations

import math
import re
import warnings
from dataclasses import dataclass
from typing import Any, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from scipy.sparse import block_diag, csr_matrix, hstack

from . import _bbsim
from ._result import simulate
from ._scenario import Array, InputError
from ._task import FreeKey

FAR = 1e6  # the residual of a window that does not run, in standard deviations
# Central differences: the error of a run over the step and the square of the step are both small.
KEY_STEP = 1e-3
WIDE = 20.0  # times these steps: to find kinks, and over them
# Parts of a step, in order. Residuals jump where a servo ignores one command more: the median of the slopes between
# neighbors leaves out a slope across a jump, which has no limit for small steps.
_BESIDE = np.array([-1, -0.5, 0.5, 1])
_ONLY_JUMPS = 1e-4  # if the median has less than this part of the mean's size, a key acts by jumps alone
_START_STEPS = np.array([1e-3] * 8 + [0.1])  # m, m/s, rad, rad/s; the spin has little effect
_LEAST_EFFECT = 1e-9  # directions of a start with less effect than this part stay fixed
_LONGEST_PAUSE = 60.0  # s; within a window that has no length
_DEAD_BANDS = tuple(f"gimbal.servo{axis}.dead_band" for axis in ("", ".phi", ".theta"))
_FORGET = 1.0  # s; a servo comes to rest in less
_SPIN = _bbsim.START.index("spin")


@dataclass
class LogKey(FreeKey):
    """A key of a sensor, whose log shows offset + scale column(t - delay)."""

    of: str = "delay"
    column: int = 0  # of a scale or an offset


class Log(NamedTuple):
    name: str
    times: Array  # s, by the scenario's clock; increasing
    values: Array  # for each compared column; NaN where a row has no number
    given: _bbsim.Given  # the scenario for this log


@dataclass
class Windows:
    """Arrays with a row for each window; shorter windows repeat their last time, without numbers."""

    log: "np.ndarray[Any, np.dtype[np.int64]]"
    begin: Array  # s
    end: Array
    rows: "np.ndarray[Any, np.dtype[np.int64]]"  # the number of times
    times: Array  # windows x rows
    values: Array  # windows x columns x rows

    def __len__(self) -> int:
        return len(self.log)


def cut(logs: Sequence[Log], length: float, share: float, fewest: int, delay: float) -> Tuple[Windows, Windows]:
    """Cuts logs into windows; returns those to fit and those held out: each window i with floor((i + 1) share) >
    floor(i share). A rest of less than half the length joins the window before. A window needs more than `fewest`
    numbers. A delayed sensor shows times before the window in its first rows, which no run covers: they go."""
    parts: List[Tuple[int, Array, Array]] = []
    for number, log in enumerate(logs):
        times = log.times
        if math.isinf(length):
            places = np.cumsum(np.diff(times, prepend=times[0]) > _LONGEST_PAUSE)
        else:
            last = max(1.0, np.floor((times[-1] - times[0]) / length + 0.5)) - 1
            places = np.minimum(np.floor((times - times[0]) / (length * (1 - 1e-9))), last)
        for rows in np.split(np.arange(len(times)), np.flatnonzero(np.diff(places)) + 1):
            if len(rows) > 1 and np.isfinite(log.values[:, rows]).sum() > fewest:
                parts.append((number, times[rows], log.values[:, rows]))
    order = np.arange(len(parts))
    held = np.floor((order + 1) * share) > np.floor(order * share)
    return _windows([parts[i] for i in order[~held]], delay), _windows([parts[i] for i in order[held]], delay)


def _windows(parts: Sequence[Tuple[int, Array, Array]], delay: float) -> Windows:
    kept = [(log, t[0], t[t - t[0] >= delay], values[:, t - t[0] >= delay]) for log, t, values in parts]
    kept = [part for part in kept if len(part[2]) > 1]
    rows = np.array([len(part[2]) for part in kept], int)
    most = rows.max(initial=0)
    times = np.array([np.pad(t, (0, most - len(t)), "edge") for _, _, t, _ in kept]).reshape(len(kept), most)
    filled = [np.pad(its, ((0, 0), (0, most - len(t))), constant_values=np.nan) for _, _, t, its in kept]
    values = np.array(filled).reshape(len(kept), len(kept[0][3]) if kept else 0, most)
    logs, begin = np.array([part[0] for part in kept], int), np.array([part[1] for part in kept], float)
    return Windows(logs, begin, times[:, -1:].ravel(), rows, times, values)


def start_coordinates(columns: Sequence[str], given: _bbsim.Given, from_within: bool) -> List[int]:
    """The coordinates of a start that the columns determine. Columns of the position or the velocity concern one axis.
    A log that is one window begins with the scenario's spin and gimbal."""
    along = np.array([[name in ("v" + axis, axis, axis + "_measured") for name in columns] for axis in "xy"])
    axes = [axis for axis in (0, 1) if along[axis].any() or not along.any(0).all()]
    places = [*axes, *(2 + axis for axis in axes)]
    if from_within and given.begins_anywhere():
        places += [4, 5, 6, 7]
    return places + ([_SPIN] if from_within and len(axes) == 2 else [])


def _quiet(log: Log, begins: Array, ends: Array) -> Array:
    """Of each window and axis: whether the servo follows no command that could still move it."""
    quiet = np.zeros((len(begins), 2), bool)
    times = np.arange(max(log.times[0], 0.0), log.times[-1], log.given.value("controller.sampling.period"))
    columns = ["phi_command", "theta_command"]
    run = simulate(log.given, {}, columns, times, begin=times[:1], end=times[-1:], events=False)
    for axis, name in enumerate(("phi", "theta")):
        own, followed, last = log.given.value(f"gimbal.servo.{name}.dead_band"), [], 0.0
        dead_band = log.given.value("gimbal.servo.dead_band") if own is None else own
        for t, command in zip(times, run[columns[axis]][0]):
            if abs(command - last) > (dead_band or 0.0):
                last = command
                followed.append(t)
        quiet[:, axis] = np.searchsorted(followed, ends) == np.searchsorted(followed, begins - _FORGET)
    return quiet & (run.status == "done").all()


def _deaf_windows(logs: Sequence[Log], windows: Windows, keys: List[str]) -> Array:
    """Of each window and key: whether the key acts only through servos that follow no command there."""
    deaf, given = np.zeros((len(windows), len(keys)), bool), logs[0].given
    servos = [bool(re.match(r"gimbal\.servo|controller\.commands.*\.delay$", key)) for key in keys]
    # A band that is free may be narrower; behind a linkage, commands to servos are not phi and theta.
    has = [given.has(key) for key in ("controller.commands", "gimbal.linkage", "gimbal.three_servos")]
    banded = any(map(given.value, _DEAD_BANDS)) and not {*_DEAD_BANDS} & {*keys}
    if not (any(servos) and banded and has == [True, False, False]):
        return deaf
    for number in np.unique(windows.log):
        its = windows.log == number
        quiet = _quiet(logs[number], windows.begin[its], windows.end[its])
        for k in np.flatnonzero(servos):
            axes = [axis for axis, name in enumerate(("phi", "theta")) if f".{name}." in keys[k]] or [0, 1]
            deaf[its, k] = quiet[:, axes].all(1)
    return deaf


class _Point(NamedTuple):
    """The windows at values u, with their starts. Differences are in SI units, windows x numbers."""

    u: Array
    starts: Array
    differences: Array
    runs: "np.ndarray[Any, np.dtype[np.bool_]]"
    why: List[str]
    by_key: Array = np.empty(0)  # windows x numbers x keys
    by_start: Array = np.empty(0)
    least: Array = np.empty(0)  # deviations of keys: the steps, where they act by jumps alone


class WindowsFit:
    """The residuals of windows and their derivatives. `free`: the coordinates of starts that are fitted."""

    def __init__(self, logs: Sequence[Log], columns: Sequence[str], windows: Windows, keys: Sequence[FreeKey],
                 free: Sequence[int], threads: int) -> None:  # fmt: skip
        self.logs, self.columns, self.windows, self.keys = logs, columns, windows, keys
        self.free, self.threads, self.kinked = list(free), threads, False
        count, width = len(windows), windows.values[0].size if len(windows) else 0
        self.measured = windows.values.reshape(count, width)
        self.there = np.isfinite(self.measured)
        self.column_of = np.repeat(np.arange(len(columns)), width // max(len(columns), 1))
        self.size = int(self.there.sum())
        self.noise, self.weights = np.ones(len(columns)), np.ones((count, width))
        self.base: Any  # a _Point with derivatives
        self.point: Any  # the last one
        self._solvers: Optional[Tuple[Array, Array]]
        self.restart()
        given = logs[0].given
        self.jumps = any(map(given.value, (*_DEAD_BANDS, "controller.sampling.resolution")))
        self.deaf = _deaf_windows(logs, windows, [key.name for key in keys])
        self.key_steps, self.start_steps = np.full(len(keys), KEY_STEP), _START_STEPS.copy()

    def bounds(self) -> Array:
        """Of the keys' numbers."""
        return np.array([key.ends() for key in self.keys]).T

    def over_noise(self) -> Array:
        """The factor of each difference; 0 where the log has no number."""
        return np.where(self.there, self.weights / self.noise[self.column_of], 0.0)

    def reweigh(self, noise: Array, weights: Optional[Array] = None) -> None:
        self.noise, self.point, self._solvers = noise, None, None
        self.weights = self.weights if weights is None else weights

    def restart(self, base: Any = None, point: Any = None) -> None:
        self.base, self.point, self._solvers = base, point, None

    def _guess(self) -> Array:
        """Starts: the first measurement, at rest; and what the scenario says."""
        facts = [f"ball.{name}.{axis}" for name in ("position", "velocity") for axis in (0, 1)]
        facts += [f"gimbal.start.{name}" for name in _bbsim.START[4:8]] + ["ball.spin"]
        starts = np.tile([self.logs[0].given.value(name) or 0.0 for name in facts], (len(self.windows), 1))
        for place in self.free:
            if place in (2, 3):
                starts[:, place] = 0.0
            elif _bbsim.START[place] in self.columns and place < 6:
                values = self.windows.values[:, self.columns.index(_bbsim.START[place])]
                has = np.isfinite(values)
                first = values[np.arange(len(values)), has.argmax(1)]
                starts[:, place] = np.where(has.any(1), first, starts[:, place])
        return starts

    def _run(self, which: Array, u: Array, starts: Array, zero: bool = False) -> Tuple[Array, Array, List[str]]:
        """Model minus log of n windows, or the model alone; whether they run, and why not."""
        windows, count = self.windows, len(which)
        values = [np.broadcast_to(key.value(u[:, k]), count) for k, key in enumerate(self.keys)]
        scales, delay = np.ones((count, len(self.columns), 1)), np.zeros(1)
        offsets = np.zeros_like(scales)
        for key, value in zip(self.keys, values):
            if isinstance(key, LogKey):
                if key.of == "delay":
                    delay = value[:, None]
                else:
                    (scales if key.of == "scale" else offsets)[:, key.column, 0] = value
        times = np.maximum(windows.times[which] - delay, windows.begin[which, None])
        shown, runs, why = np.full((count, *windows.values.shape[1:]), np.nan), np.zeros(count, bool), [""] * count
        for log in np.unique(windows.log[which]):
            rows = np.flatnonzero(windows.log[which] == log)
            its = which[rows]
            cases = {key.name: value[rows] for key, value in zip(self.keys, values) if not isinstance(key, LogKey)}
            try:
                made = simulate(self.logs[log].given, cases, self.columns, times[rows], begin=windows.begin[its],
                                end=windows.end[its], start=starts[rows], events=False, threads=self.threads)
                reasons = made.reason
                shown[rows] = np.stack([made[name] for name in self.columns], 1)
                runs[rows] = (made.status == "done") & np.isfinite(shown[rows]).all((1, 2))
            except InputError as error:  # of all cases
                reasons = [str(error)] * len(rows)
            for row, reason in zip(rows, reasons):
                why[row] = reason or "the run does not reach the window's end"
        shown = (offsets + scales * shown).reshape(count, -1)
        if not zero:
            shown = np.where(self.there[which], shown - self.measured[which], 0.0)
        return np.where(runs[:, None], shown, np.nan), runs, why

    def _run_all(self, u: Array, starts: Array, zero: bool = False) -> Tuple[Array, Array, List[str]]:
        return self._run(np.arange(len(starts)), np.tile(u, (len(starts), 1)), starts, zero)

    def linearize(self, u: Array, starts: Array) -> None:
        """Makes the base at u with these starts, by one call for all differences."""
        keys, count = len(u), len(self.windows)
        several = self.kinked and self.jumps
        beside = _BESIDE if several else _BESIDE[[0, -1]]
        steps = np.concatenate([self.key_steps, self.start_steps[self.free]])
        places = [*range(keys), *(keys + place for place in self.free)]
        at = np.outer(beside, steps)
        for k, key in enumerate(self.keys if several else []):
            at[:, k] = np.clip(u[k] + at[:, k], *key.ends()) - u[k]
        moves = np.zeros((len(beside), len(steps), keys + starts.shape[1]))
        moves[:, np.arange(len(steps)), places] = at
        moves = np.concatenate([np.zeros((1, moves.shape[2])), moves.reshape(-1, moves.shape[2])])
        all_u = np.repeat(u + moves[:, :keys], count, axis=0)
        all_starts = (starts + moves[:, None, keys:]).reshape(-1, starts.shape[1])
        shown, runs, why = self._run(np.tile(np.arange(count), len(moves)), all_u, all_starts)
        shown, runs = shown.reshape(len(moves), count, -1), runs.reshape(len(moves), count)
        # A value at its bound has a neighbor on one side only.
        moved = (runs[1:] & runs[0]).reshape(len(beside), len(steps), count)
        for k, key in enumerate(self.keys):
            moved[:, k] &= (key.value(u[k] + at[:, k]) != key.value(u[k]))[:, None]
        sides = np.where(moved[..., None], shown[1:].reshape(*moved.shape, -1), shown[0])
        by_all, jumps = self._slopes(sides, shown[0], np.where(moved, at[..., None], 0.0))
        by_all[..., :keys] *= ~self.deaf[:, None]
        least = np.where(jumps[:keys], steps[:keys], 0.0)
        self.base = _Point(u, starts, shown[0], runs[0], why[:count], by_all[..., :keys], by_all[..., keys:], least)
        self._solvers = None

    def _slopes(self, sides: Array, middle: Array, at: Array) -> Tuple[Array, Array]:
        """Windows x numbers x steps, from values at places beside the middle; whether they are of jumps alone."""

        def between(low: int, high: int) -> Array:
            widths = at[high] - at[low]
            return (sides[high] - sides[low]) / np.where(widths == 0, np.nan, widths)[..., None]

        slopes, jumps = between(0, -1), np.zeros(len(sides[0]), bool)
        if len(at) > 2:
            half = len(at) // 2
            sides, at = np.insert(sides, half, middle, 0), np.insert(at, half, 0, 0)
            parts = [between(i, i + 1) for i in range(len(at) - 1)]
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # numpy's, on windows that do not run
                median = np.nanmedian(parts, 0)
            sizes = [np.nansum((each * self.over_noise()) ** 2, (1, 2)) for each in (median, slopes)]
            jumps = sizes[0] < _ONLY_JUMPS**2 * sizes[1]
            slopes = np.where(jumps[:, None, None], slopes, median)
        return np.nan_to_num(np.moveaxis(slopes, 0, -1)), jumps

    def _solve(self) -> Tuple[Array, Array]:
        """For each window, the derivatives by its start over the noise, and their pseudoinverse."""
        if self._solvers is None:
            slopes = self.base.by_start * self.over_noise()[..., None]
            self._solvers = slopes, np.linalg.pinv(slopes, rcond=_LEAST_EFFECT)
        return self._solvers

    def starts_rank(self) -> int:
        """The number of start coordinates that the windows determine."""
        slopes, _ = self._solve()
        return int(np.linalg.matrix_rank(slopes, tol=_LEAST_EFFECT * np.linalg.norm(slopes, axis=(1, 2))).sum())

    def residuals(self, u: Array) -> Array:
        """Over the noise, times the weights, at the best starts."""
        if self.kinked and self.point is None and self.base is not None and np.array_equal(self.base.u, u):
            self.point = self.base  # its starts are the best
        if self.point is None or not np.array_equal(self.point.u, u):
            if self.base is None:
                starts = self._guess()
                for _ in range(4):  # the first start is a guess
                    self.linearize(u, starts)
                    if self._settle(u, starts):
                        break
                    starts = self.point.starts
            else:
                base, (_, inverse) = self.base, self._solve()
                change = np.nan_to_num(base.differences) + base.by_key @ (u - base.u)
                starts = base.starts.copy()
                starts[:, self.free] -= _times(inverse, change * self.over_noise())
                self._settle(u, starts)
        return np.where(self.point.runs[:, None], np.nan_to_num(self.point.differences) * self.over_noise(),
                        FAR * self.there)[self.there]  # fmt: skip

    @np.errstate(over="ignore")
    def _settle(self, u: Array, starts: Array) -> bool:
        """Newton's method for the best starts with known slopes: the motion depends on its start almost linearly.
        Returns whether a few rounds suffice."""
        (slopes, inverse), factors = self._solve(), self.over_noise()
        differences, runs, why = self._run_all(u, starts)
        starts, busy = starts.copy(), np.flatnonzero(runs)
        for rounds in range(12):
            rest = differences[busy] * factors[busy]
            step = _times(inverse[busy], rest)
            gain, size = ((_times(slopes[busy], step)) ** 2).sum(1), (rest**2).sum(1)
            go = (gain > 1e-8 * size) & (rounds < 11)
            done = busy[~go]  # what is left is linear
            starts[np.ix_(done, self.free)] -= step[~go]
            differences[done] -= _times(self.base.by_start[done], step[~go])
            busy, step, size = busy[go], step[go], size[go]
            if not busy.size:
                break
            moved = starts[busy].copy()
            moved[:, self.free] -= step
            its, ran, _ = self._run(busy, np.tile(u, (len(busy), 1)), moved)
            after = ((its * factors[busy]) ** 2).sum(1)
            better = ran & (after <= size * (1 + 1e-12))
            busy = busy[better]
            starts[busy], differences[busy] = moved[better], its[better]
        self.point = _Point(u.copy(), starts, differences, runs, why)
        return rounds < 4

    def at(self, u: Array, starts: Array, derivatives: bool = False) -> Array:
        """The residuals at these starts."""
        if derivatives:
            self.linearize(u, starts)
            self.point = self.base
        else:
            self.point = _Point(u.copy(), starts, *self._run_all(u, starts))
        return self.residuals(u)

    def side_by_side(self) -> Any:
        """The derivatives of the residuals by the keys and all starts."""
        factors = self.over_noise()
        blocks = [csr_matrix((self.base.by_start[w] * factors[w][:, None])[self.there[w]]) for w in range(len(factors))]
        slopes = hstack([csr_matrix((self.base.by_key * factors[..., None])[self.there]), block_diag(blocks)], "csr")
        return slopes if slopes.shape[1] > 300 else slopes.toarray()

    def find_kinks(self, u: Array, wide: Any = WIDE * KEY_STEP) -> None:
        """Whether the residuals near u have kinks, jumps or flat stretches, as with dry friction or dead bands: slopes
        over `wide` steps then differ, and replace those over small ones."""
        self.residuals(u)
        smooth, factors, (slopes, inverse) = self.base, self.over_noise()[..., None], self._solve()
        before = self.key_steps, self.start_steps
        self.key_steps, self.start_steps = np.broadcast_to(wide, u.shape), WIDE * before[1]
        self.linearize(u, self.base.starts)
        small, large = (np.concatenate([point.by_key, point.by_start], -1) * factors for point in (smooth, self.base))
        change, size = (np.sqrt((slope**2).sum(1)) for slope in (small - large, large))  # windows x numbers
        widths = np.concatenate([self.key_steps, self.start_steps[self.free]])
        seen = size * widths > 1e-3
        kinked = np.mean((change > 0.2 * size) & seen, 0) > np.maximum(0.3 * np.mean(seen, 0), 1e-9)
        if self.jumps:  # in one window, with more effect than all that the starts cannot undo
            alone = [slope - slopes @ (inverse @ slope) for slope in (small - large, large)]
            change, size = (np.sqrt((slope**2).sum((0, 1))) for slope in alone)
            kinked |= seen.any(0) & (change > 0.5 * size)
        self.key_steps = np.where(kinked[: len(u)], self.key_steps, before[0])
        self.start_steps = before[1].copy()
        self.start_steps[self.free] *= np.where(kinked[len(u) :], WIDE, 1)
        self.kinked = bool(kinked.any())
        if self.kinked:
            # Such runs take long, and larger steps allow larger errors.
            loose = [("solver.rtol", "1e-7"), ("solver.atol", "1e-9")]
            self.logs = [log._replace(given=log.given.changed(loose)) for log in self.logs]
            self.linearize(u, self.base.starts)
        else:
            self.base, self._solvers = smooth, None

    def derivatives(self, u: Array, near: bool = True) -> Tuple[Array, Array]:
        """Of residuals by u: what the starts cannot undo, and the norms of the columns with fixed starts. `near`: those
        of a point before will do if they predict the residuals here, since they cost as much as twenty residuals."""
        now, factors = self.residuals(u), self.over_noise()
        slopes, inverse = self._solve()
        before = np.nan_to_num(self.base.differences) * factors
        change = (self.base.by_key * factors[..., None]) @ (u - self.base.u)
        then = before + change - _times(slopes, _times(inverse, before + change))
        error, size = np.linalg.norm(now - then[self.there]), np.linalg.norm(now - before[self.there])
        if not near or error > 0.1 * min(size, np.linalg.norm(now)) + 0.02 * math.sqrt(np.mean(now**2)):
            self.linearize(u, self.point.starts)
            slopes, inverse = self._solve()
        by_key = self.base.by_key * factors[..., None]
        return (by_key - slopes @ (inverse @ by_key))[self.there], np.sqrt((by_key**2).sum((0, 1)))

    @np.errstate(over="ignore", invalid="ignore")  # far away
    def tried(self, many: Array, moves: bool) -> Tuple[Array, Array, Array]:
        """Many values u, after a step of Gauss and Newton from each if they are near the base and `moves`: these
        values, their starts, and the sums of squares."""
        (slopes, inverse), factors, count = self._solve(), self.over_noise(), len(self.windows)
        by_key = self.base.by_key * factors[..., None]
        by_key = np.linalg.pinv((by_key - slopes @ (inverse @ by_key)).reshape(-1, by_key.shape[2]))
        starts = np.tile(self.base.starts, (len(many), 1))
        for turn in range(2):
            its = self._run(np.tile(np.arange(count), len(many)), np.repeat(many, count, 0), starts)[0]
            rest = its.reshape(len(many), *factors.shape) * factors
            step = _times(inverse, rest)
            rest -= _times(slopes, step)  # the motion depends on its start almost linearly
            starts.reshape(len(many), count, -1)[..., self.free] -= step
            if moves and not turn:
                many = np.clip(many - np.nan_to_num(rest.reshape(len(many), -1)) @ by_key.T, *self.bounds())
        costs = np.nan_to_num(np.linalg.norm(rest, axis=(1, 2)), nan=np.inf)
        return many, starts.reshape(len(many), count, -1), costs**2

    def guess_velocities(self, u: Array) -> Array:
        """Starts: in each window, that which fits best of some with velocities over the first rows, and at rest."""
        best = starts = self._guess()
        least = np.full(len(best), np.inf)
        for rows in (0, 2, 4, 8):
            tried = starts.copy()
            for axis, name in ((0, "x"), (1, "y")):
                if rows and 2 + axis in self.free and name in self.columns:
                    its = self.windows.values[:, self.columns.index(name), :rows]
                    times = np.where(np.isfinite(its), self.windows.times[:, :rows], np.nan)
                    times, its = (array - np.nanmean(array, 1, keepdims=True) for array in (times, its))
                    tried[:, 2 + axis] = np.nansum(times * its, 1) / np.maximum(np.nansum(times**2, 1), 1e-12)
            cost = np.nan_to_num(((self._run_all(u, tried)[0] * self.over_noise()) ** 2).sum(1), nan=np.inf)
            best, least = np.where((cost < least)[:, None], tried, best), np.minimum(cost, least)
        return best

    def modelled(self) -> Array:
        """What the model shows at the last point: windows x columns x rows."""
        return self._run_all(self.point.u, self.point.starts, True)[0].reshape(self.windows.values.shape)

    def sizes(self) -> Array:
        """Of each column's differences at the last point, in SI units: rms; robust, 1.4826 times the median; number."""
        places = np.broadcast_to(self.column_of, self.there.shape)
        its = [np.abs(self.point.differences[self.there & (places == c)]) for c in range(len(self.columns))]
        return np.array([(math.sqrt(np.mean(column**2)), 1.4826 * np.sort(column)[column.size // 2], column.size)
                         if column.size else (0, 0, 0) for column in its], float).T  # fmt: skip


def _times(matrices: Array, vectors: Array) -> Array:
    return (matrices @ vectors[..., None])[..., 0]
