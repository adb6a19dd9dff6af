# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""What the log of a motion tells about keys of a scenario, and how much of the rig's limits the motion uses."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, Dict, List, NamedTuple, Tuple

import numpy as np

from . import _bbsim
from ._fit_windows import Log, cut, start_coordinates
from ._result import simulate
from ._scenario import Array
from ._task import ROUGH, FreeKey, Progress

_STEP = 1e-3  # of keys' numbers u and of starts (SI), for differences
_CHANGES = ("scale", "offset", "delay")  # of a table


class Motions(NamedTuple):
    """Motions, and their runs: each array has an entry for each motion."""

    numbers: Array  # of each axis amplitudes of cosines and sines, or values at even times; the ball's x, y, vx, vy
    waves: Array  # the frequencies of these cosines and sines (rad/s): (motion, axis, 4), or (motion, 0)
    shares: Array = np.empty(0)  # of the limits: (motion, limit, time)
    states: Array = np.empty(0)  # at the begins of windows: (motion, window, state)

    def take(self, which: Any) -> "Motions":
        return Motions(*(array[which] if len(array) else array for array in self))

    def at(self, times: Array) -> Array:
        """The values of both axes."""
        axes, angles = self.numbers[:, :-4].reshape(len(self.numbers), 2, -1), self.waves[..., None] * times
        both = np.concatenate([np.cos(angles), np.sin(angles)], 2)
        return np.einsum("nac,nact->nat", axes, both) if both.size else axes

    def table(self, times: Array) -> "Motions":
        rows = self.at(times).reshape(len(self.numbers), -1)
        return Motions(np.hstack([rows, self.numbers[:, -4:]]), np.empty((len(rows), 0)))


class Experiment:
    """A log of a scenario that plays tables of tilts as `section`, or of a reference. `limits`: columns and factors,
    whose products are at most 1."""

    def __init__(self, plain: _bbsim.Given, section: str, axes: List[int], keys: List[FreeKey], noise: Dict[str, float],
                 window: float, length: float, rate: float, limits: List[Tuple[str, float]], threads: int,
                 progress: Progress) -> None:  # fmt: skip
        self.axes, self.keys, self.length, self._noise, self._limits = axes, keys, length, noise, limits
        self._threads, self._progress, self.played = threads, progress, 0
        self.tilts = section != "controller.reference"
        self.names = ("phi", "theta") if self.tilts else ("x", "y")
        self._profiles = [f"{section}.{self.names[i]}" for i in axes] if self.tilts else [section]
        own = {key.name: key.start for key in keys}
        self._changes: Dict[str, float] = {}
        for key in (f"{its}.table.{name}" for its in self._profiles[: 2 * self.tilts] for name in _CHANGES):
            self._changes[key] = own[key] if key in own else plain.value(key) or 0.0
        smooth = [(key, "null") for key in ROUGH if plain.has(key)]
        if not any(key.name.endswith("dead_band") for key in keys) and plain.has("controller.sampling"):
            servos = [f"gimbal.servo{axis}" for axis in ("", ".phi", ".theta")]
            servos = [key for key in servos if plain.has(key)]
            smooth += [(f"{key}.{end}", to) for key in servos for end, to in (("scale", "null"), ("dead_band", "0"))]
        tolerances = (("solver.rtol", 1e-10), ("solver.atol", 1e-12))
        smooth += [(key, repr(min(most, plain.value(key) or most))) for key, most in tolerances]
        self._of_tables = plain.changed([*smooth, ("solver.error", "null")])
        terms = "{sinusoid: {amplitude: 0, frequency: 1}}, " * 4
        self._of_waves = self._of_tables.changed([(its, f"[{terms}0]") for its in self._profiles[: 2 * self.tilts]])
        parts = int(np.ceil(50 / rate * (1 - 1e-9)))  # the fastest wave has 16 in a period
        self._times = np.linspace(0, length, round(length * rate) * parts + 1)
        self.times = self._times[::parts]
        # The highest multiple of 1/length: faster tilts move a ball by less than its sensor resolves.
        self.highest = max(4, int(min(3, rate / 8) * length))
        rows = np.arange(len(self.times), dtype=float)
        windows, _ = cut([Log("", self.times, rows[None], plain)], window, 0, 0, 0)  # as in a fit
        self.windows, self.numbers = len(windows), int(windows.rows.sum()) * len(noise)
        self._window_times, self._real = windows.times, np.isfinite(windows.values[:, 0])
        self._begins = windows.values[:, 0, 0].astype(int) * parts
        starts = start_coordinates(list(noise), plain, len(windows) > 1)
        self._free = [place for place in starts if _bbsim.START[place] != "spin"]
        home = [plain.value(f"gimbal.start.{name}") for name in _bbsim.START[4:8]]
        self._home = np.array([*home, plain.value("ball.spin")], float)

    def commands(self, motions: Motions) -> Array:
        """What tables at even times have, so that the rig moves like this: (motion, axis, time)."""
        values = motions.at(np.empty(0)) * np.isin([0, 1], self.axes)[:, None]
        for i, its in zip(self.axes, self._profiles[: 2 * self.tilts]):
            values[:, i] = (values[:, i] - self._changes[f"{its}.table.offset"]) / self._changes[f"{its}.table.scale"]
        return np.round(values, 8) + 0.0  # no -0

    def _simulate(self, motions: Motions, per: int, keys: Dict[str, Array], columns: List[str], **windows: Any) -> Any:
        """`per` cases of each motion."""
        self._progress(1 - 0.998**self.played, f"{self.played} motions")
        how: Dict[str, Any] = {"events": False, "threads": self._threads, **windows}
        if motions.waves.size and not self.tilts:
            motions = motions.table(np.linspace(0, self.length, 16 * self.highest + 1))
        if motions.waves.size:
            w, axes = np.repeat(motions.waves, per, 0), np.repeat(motions.numbers[:, :16].reshape(-1, 2, 2, 4), per, 0)
            cases = {key: its for key, its in keys.items() if key not in self._changes}
            for i, its in zip(self.axes, self._profiles):
                names = [f"{its}.table.{name}" for name in _CHANGES]
                scale, offset, delay = (keys.get(name, np.full(len(w), self._changes[name])) for name in names)
                ratio = scale / self._changes[names[0]]
                cases[f"{its}.4"] = offset - ratio * self._changes[names[1]]
                for k in range(4):
                    cosine, sine = axes[:, i, :, k].T
                    cases[f"{its}.{k}.sinusoid.amplitude"] = ratio * np.hypot(cosine, sine)
                    cases[f"{its}.{k}.sinusoid.frequency"] = w[:, i, k]
                    cases[f"{its}.{k}.sinusoid.phase"] = np.arctan2(cosine, sine) - w[:, i, k] * delay
            return simulate(self._of_waves, cases, columns, **how)
        values = self.commands(motions)
        times = np.linspace(0, self.length, values.shape[-1]).tolist()
        text = "".join([f"t,{','.join(self.names)}\n", *(f"{t!r},%.8f,%.8f\n" for t in times)])
        with tempfile.TemporaryDirectory(prefix="bbsim-") as folder:
            files = [f"{folder}/{i}.csv" for i in range(len(values))]
            for file, rows in zip(files, values):
                Path(file).write_text(text % tuple(rows.T.ravel().tolist()))
            tables = dict.fromkeys((f"{its}.table.file" for its in self._profiles), np.repeat(files, per).tolist())
            return simulate(self._of_tables, {**tables, **keys}, columns, **how)

    def play(self, motions: Motions) -> Tuple[Motions, Array]:
        """The motions with their runs, and the middle of the ball's path in each."""
        self.played += len(motions.numbers)
        begin = np.hstack([motions.numbers[:, -4:], np.tile(self._home, (len(motions.numbers), 1))])
        columns = list(dict.fromkeys([*_bbsim.START, *(column for column, _ in self._limits)]))
        run = self._simulate(motions, 1, {}, columns, times=self._times, start=begin)
        shares = np.nan_to_num(np.stack([run[column] * factor for column, factor in self._limits], 1), nan=np.inf)
        states = np.nan_to_num(np.stack([run[name][:, self._begins] for name in _bbsim.START], -1))
        states[:, 0] = begin
        path = np.nan_to_num(np.stack([run["x"], run["y"]], 1))
        return Motions(motions.numbers, motions.waves, shares, states), (path.min(2) + path.max(2)) / 2

    def slopes(self, motions: Motions, central: bool = False) -> Tuple[Array, Array]:
        """Derivatives of the log by the keys' numbers u, in units of noise, less what other starts of the windows
        explain: (motion, number, key). And the norms of the derivatives with known starts: (motion, key)."""
        count, free, windows = len(motions.numbers), len(self._free), self.windows
        if count > 8:  # for progress, and less memory
            parts = [self.slopes(motions.take(slice(i, i + 8)), central) for i in range(0, count, 8)]
            return np.concatenate([slopes for slopes, _ in parts]), np.concatenate([norms for _, norms in parts])
        # A value at its bound has a neighbor on one side only.
        signs = np.array([1] * free + [-1 if key.value(_STEP) == key.value(0) else 1 for key in self.keys])
        single = _STEP * np.diag(signs)
        steps = np.vstack([0 * single[:1], single, -single] if central else [0 * single[:1], single])
        values = np.column_stack([key.value(steps[:, free + k]) for k, key in enumerate(self.keys)])
        starts = np.zeros((len(steps), 1, len(_bbsim.START)))
        starts[:, 0, self._free] = steps[:, :free]
        at = np.tile(self._window_times, (count * len(steps), 1))
        keys = {key.name: np.tile(np.repeat(its, windows), count) for key, its in zip(self.keys, values.T)
                if key.name not in ROUGH}  # fmt: skip
        begins = (motions.states[:, None] + starts).reshape(-1, len(_bbsim.START))
        run = self._simulate(motions, len(steps) * windows, keys, list(self._noise), times=at, begin=at[:, 0],
                             end=at[:, -1], start=begins)  # fmt: skip
        shape = (count, len(steps), windows)
        log = np.stack([run[name].reshape(*shape, -1) / its for name, its in self._noise.items()], -1)
        log = np.where(self._real[..., None], log, 0).reshape(*shape, -1)
        moves = (values != values[0]).any(1) | starts.any((1, 2)) | (np.arange(len(steps)) == 0)
        done = (run.status == "done").reshape(shape) & np.isfinite(log).all(-1) & moves[:, None]
        log = np.where(done[..., None], log, np.where(done[:, :1, :, None], log[:, :1], 0))
        up, down = log[:, 1 : 1 + len(single)], log[:, 1 + len(single) :] if central else log[:, :1]
        width = (done[:, 1:] & done[:, :1]).reshape(count, -1, len(single), windows).sum(1)[..., None]
        width[:, free:] *= (width[:, :free] > 0).all(1)[:, None]
        slopes = np.divide(up - down, _STEP * signs[:, None, None] * width, out=np.zeros_like(up), where=width > 0)
        by_start, by_key = np.moveaxis(slopes[:, :free], 1, -1), np.moveaxis(slopes[:, free:], 1, -1)
        u, sizes, _ = np.linalg.svd(by_start, full_matrices=False)
        u *= (sizes > 1e-9 * sizes[..., :1])[..., None, :]  # others have no effect
        projected = by_key - u @ (np.swapaxes(u, -1, -2) @ by_key)
        return projected.reshape(count, -1, len(self.keys)), np.sqrt((by_key**2).sum((1, 2)))
