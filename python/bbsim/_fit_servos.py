# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Servos with a dead band in a fit: windows in which they follow no command, which tell nothing of them, and delays of
their commands."""

from __future__ import annotations

import re
from typing import Any, Iterator, List, Sequence, Tuple

import numpy as np

from . import _bbsim
from ._result import simulate
from ._scenario import Array

DEAD_BANDS = tuple(f"gimbal.servo{axis}.dead_band" for axis in ("", ".phi", ".theta"))
_FORGET = 1.0  # s; a servo comes to rest in less
_SCANNED, _DELAYS = 201, 0.2  # delays in a scan, and how far it goes without bounds (s)


def _quiet(log: Any, begins: Array, ends: Array) -> Array:
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


def deaf_windows(logs: Sequence[Any], windows: Any, keys: List[str]) -> Array:
    """Of each window and key: whether the key acts only through servos that follow no command there."""
    deaf, given = np.zeros((len(windows), len(keys)), bool), logs[0].given
    servos = [bool(re.match(r"gimbal\.servo|controller\.commands.*\.delay$", key)) for key in keys]
    # A band that is free may be narrower; behind a linkage, commands to servos are not phi and theta.
    has = [given.has(key) for key in ("controller.commands", "gimbal.linkage", "gimbal.three_servos")]
    banded = any(map(given.value, DEAD_BANDS)) and not {*DEAD_BANDS} & {*keys}
    if not (any(servos) and banded and has == [True, False, False]):
        return deaf
    for number in np.unique(windows.log):
        its = windows.log == number
        quiet = _quiet(logs[number], windows.begin[its], windows.end[its])
        for k in np.flatnonzero(servos):
            axes = [axis for axis, name in enumerate(("phi", "theta")) if f".{name}." in keys[k]] or [0, 1]
            deaf[its, k] = quiet[:, axes].all(1)
    return deaf


def delays_of(windows: Any) -> List[int]:
    """The keys that are delays of commands which a servo with a dead band follows, or which are rounded."""
    return [k for k, key in enumerate(windows.keys) if windows.jumps and not windows.deaf[:, k].all()
            and key.name.startswith("controller.commands") and key.name.endswith("delay")]  # fmt: skip


def _scans(search: Any) -> Iterator[Tuple[int, Array, Array]]:
    """For each delay, numbers within its bounds, and sums of squares there with the other keys as they are. Which
    commands a servo follows, or how they are rounded, changes in steps with the delay: residuals have a valley for each
    period of the samples, or are flat between two steps."""
    for k in search.delays:
        key, bounds = search.keys[k], search.bounds()[:, k]
        limits = float(key.value(search.u[k])) + np.array([-_DELAYS, _DELAYS])
        ends = np.where(np.isfinite(bounds), bounds, [*map(key.number, limits)])
        many = np.tile(search.u, (_SCANNED, 1))
        many[:, k] = np.linspace(ends[0], ends[1], _SCANNED)
        yield k, many[:, k], search.windows.tried(many, False)[2]


def begin_at_delays(search: Any) -> Array:
    """Moves the search to the best delays of scans. Returns which keys have an effect in them."""
    acts = np.zeros(len(search.u), bool)
    for _ in search.delays:  # once more for each other delay
        for k, at, costs in _scans(search):
            acts[k] |= np.ptp(costs) > 1e-7 * costs.min()
            if costs.min() < search.cost() * (1 - 1e-4):
                search.u = np.where(np.arange(len(search.u)) == k, at[costs.argmin()], search.u)
                search.windows.restart()
                search.windows.residuals(search.u)
    return acts


def compare_delays(search: Any) -> None:
    """Finds other delays that fit as well: they count for the intervals, and as doubts."""
    for k, at, costs in _scans(search):
        near = at[costs <= search.cost() * (1 + 4 / search.degrees_of_freedom())]
        others = np.tile(search.u, (len(near), 1))
        others[:, k] = near
        search.rivals = np.concatenate([search.rivals, others])
        if len(near) > 1:
            low, high = (_bbsim.short_number(float(search.keys[k].value(end))) for end in near[[0, -1]])
            search.doubts.append(f"{search.keys[k].name}: values from {low} to {high} fit equally well: between them, "
                                 "the servos follow the same commands")  # fmt: skip
