# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Windows of logs in which servos with a dead band follow no command: they tell nothing of the servos."""

from __future__ import annotations

from typing import Any, List, Sequence

import numpy as np

from . import _bbsim
from ._scenario import Array
from ._simulate import simulate

_FORGET = 1.0  # s; a servo comes to rest in less


def _followed(commands: Array, dead_band: float) -> Array:
    """Whether a servo follows each command."""
    follows, last = np.zeros(len(commands), bool), 0.0
    for i, command in enumerate(commands):
        if abs(command - last) > dead_band:
            follows[i], last = True, command
    return follows


def _quiet(log: Any, begins: Array, ends: Array) -> Array:
    """Of each window and axis: whether the servo follows no command that could still move it."""
    given, number = log.given, lambda key: _bbsim.key_facts(log.given, "", key).value
    quiet = np.zeros((len(begins), 2), bool)
    usual, period = number("gimbal.servo.dead_band"), number("controller.sampling.period")
    times = np.arange(max(log.times[0], 0.0), log.times[-1], period)
    made = simulate(given, {}, ["phi_command", "theta_command"], times, begin=times[:1], end=times[-1:], events=False)
    for axis, name in enumerate(("phi", "theta")):
        own = number(f"gimbal.servo.{name}.dead_band")
        at = times[_followed(made[f"{name}_command"][0], own if own is not None else usual or 0.0)]
        quiet[:, axis] = np.searchsorted(at, ends) == np.searchsorted(at, begins - _FORGET)
    return quiet & (made.status == "done").all()


def deaf_windows(logs: Sequence[Any], windows: Any, keys: List[str]) -> Array:
    """Of each window and key: whether the key acts only through servos that follow no command there."""
    deaf, given = np.zeros((len(windows), len(keys)), bool), logs[0].given
    dead_bands = [f"gimbal.servo{axis}.dead_band" for axis in ("", ".phi", ".theta")]
    servos = [key.startswith("gimbal.servo") or key.startswith("controller.commands") and key.endswith("delay") for key in keys]
    plain = _bbsim.has(given, "controller.commands") and not _bbsim.has(given, "gimbal.linkage")
    # A band that is free may be narrower, and the commands of three legs are not phi and theta.
    if not any(servos) or not plain or _bbsim.has(given, "gimbal.three_servos") or set(dead_bands) & set(keys) \
            or not any(_bbsim.key_facts(given, "", one).value for one in dead_bands):
        return deaf
    for number in np.unique(windows.log):
        its = windows.log == number
        quiet = _quiet(logs[number], windows.begin[its], windows.end[its])
        for k in np.flatnonzero(servos):
            axes = [axis for axis, name in enumerate(("phi", "theta")) if f".{name}." in keys[k]] or [0, 1]
            deaf[its, k] = quiet[:, axes].all(1)
    return deaf
