# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Windows of logs in which servos with a dead band follow no command: they tell nothing of the servos."""

from __future__ import annotations

import re
from typing import Any, List, Sequence

import numpy as np

from . import _bbsim
from ._scenario import Array
from ._simulate import simulate

_FORGET = 1.0  # s; a servo comes to rest in less


def _quiet(log: Any, begins: Array, ends: Array) -> Array:
    """Of each window and axis: whether the servo follows no command that could still move it."""
    number = lambda key: _bbsim.key_facts(log.given, "", key).value
    quiet = np.zeros((len(begins), 2), bool)
    times = np.arange(max(log.times[0], 0.0), log.times[-1], number("controller.sampling.period"))
    columns = ["phi_command", "theta_command"]
    made = simulate(log.given, {}, columns, times, begin=times[:1], end=times[-1:], events=False)
    for axis, name in enumerate(("phi", "theta")):
        own, followed, last = number(f"gimbal.servo.{name}.dead_band"), [], 0.0
        dead_band = number("gimbal.servo.dead_band") if own is None else own
        for t, command in zip(times, made[columns[axis]][0]):
            if abs(command - last) > (dead_band or 0.0):
                last = command
                followed.append(t)
        quiet[:, axis] = np.searchsorted(followed, ends) == np.searchsorted(followed, begins - _FORGET)
    return quiet & (made.status == "done").all()


def deaf_windows(logs: Sequence[Any], windows: Any, keys: List[str]) -> Array:
    """Of each window and key: whether the key acts only through servos that follow no command there."""
    deaf, given = np.zeros((len(windows), len(keys)), bool), logs[0].given
    bands = [f"gimbal.servo{axis}.dead_band" for axis in ("", ".phi", ".theta")]
    servos = [bool(re.match(r"gimbal\.servo|controller\.commands.*\.delay$", key)) for key in keys]
    # A band that is free may be narrower; behind a linkage, commands to servos are not phi and theta.
    has = [_bbsim.has(given, key) for key in ("controller.commands", "gimbal.linkage", "gimbal.three_servos")]
    banded = any(_bbsim.key_facts(given, "", one).value for one in bands) and not set(bands) & set(keys)
    if not (any(servos) and banded and has == [True, False, False]):
        return deaf
    for number in np.unique(windows.log):
        its = windows.log == number
        quiet = _quiet(logs[number], windows.begin[its], windows.end[its])
        for k in np.flatnonzero(servos):
            axes = [axis for axis, name in enumerate(("phi", "theta")) if f".{name}." in keys[k]] or [0, 1]
            deaf[its, k] = quiet[:, axes].all(1)
    return deaf
