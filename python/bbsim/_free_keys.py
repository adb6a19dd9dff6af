# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keys that a fit, a design or tuning may choose: `--free KEY=FROM:TO`."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import List, NoReturn, Optional, Sequence

import numpy as np

from . import _bbsim
from ._errors import InputError

# A change that probably has a visible effect, by unit (SI). Other units span orders of magnitude.
_USUAL = {"m": 0.01, "s": 0.01, "rad": 0.01, "m/s": 0.01, "N": 0.01}
_ROUNDING = 1e-12


def refuse(what: str) -> NoReturn:
    raise InputError([("", f"--free: {what}")])


def usual_scale(start: float, unit: str) -> float:
    if unit in _USUAL:
        return max(abs(start), _USUAL[unit])
    return abs(start) or 0.1


@dataclass
class FreeKey:
    """A key as a number u without bounds or unit, which is 0 at the start: its value is start exp(u) if it must
    be positive, else start + scale u. Differences and deviations of u then have size 1."""

    name: str
    unit: str = ""  # SI
    start: float = 0.0
    lower: float = -math.inf
    upper: float = math.inf
    logarithmic: bool = False
    scale: float = 1.0

    def value(self, u: "float | np.ndarray") -> "float | np.ndarray":  # type: ignore[type-arg]
        """Within the bounds."""
        raw = self.start * np.exp(u) if self.logarithmic else self.start + self.scale * np.asarray(u)
        # value(number(bound)) equals the bound only within rounding.
        raw = np.where(raw >= self.upper - _ROUNDING * abs(self.upper), self.upper, raw)
        return np.where(raw <= self.lower + _ROUNDING * abs(self.lower), self.lower, raw)[()]

    def number(self, value: float) -> float:
        return math.log(value / self.start) if self.logarithmic else (value - self.start) / self.scale

    def slope(self, u: float) -> float:
        """The derivative of the value by u."""
        return float(self.value(u)) if self.logarithmic else self.scale

    def text(self, value: float) -> str:
        """A value as a scenario writes it."""
        return f"{float(value)!r} {self.unit}".strip()


def read_bounds(text: str, key: FreeKey) -> None:
    """Reads FROM:TO into the key. If only TO has a unit, it applies to FROM, too."""
    first, colon, last = (part.strip() for part in text.partition(":"))
    unit = re.fullmatch(r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*(.*)", last)
    if unit and re.fullmatch(r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?", first):
        first += " " + unit[1]
    low: Optional[float] = _bbsim.value_in(first, key.unit) if colon else None
    high: Optional[float] = _bbsim.value_in(last, key.unit) if colon else None
    if low is None or high is None or not low < high:
        units = f" of {key.unit}" if key.unit else ""
        allowed = f"FROM:TO with FROM below TO, numbers in SI units or with a unit{units}"
        refuse(f"{key.name}: found '{text}'; allowed: {allowed}")
    if low < key.lower or high > key.upper:
        refuse(f"{key.name}: found '{text}'; allowed: values from {key.lower:g} to {key.upper:g}")
    key.lower, key.upper = low, high


def read_free_key(text: str, given: _bbsim.Given) -> FreeKey:
    """KEY or KEY=FROM:TO. Raises InputError for a key that the scenario does not take."""
    name, equals, bounds = (part.strip() for part in text.partition("="))
    facts = _bbsim.key_facts(given, "--free", name)
    key = FreeKey(name, facts.unit, lower=facts.lower, upper=facts.upper)
    if equals:
        read_bounds(bounds, key)
    start = facts.value
    if equals and (start is None or not key.lower <= start <= key.upper):
        start = math.sqrt(key.lower * key.upper) if key.lower > 0 else (key.lower + key.upper) / 2
    if start is None:
        _bbsim.number_at(given, name, key.text(1.0))  # reports a misspelled key, or one of another law
        allowed = f"{name}=FROM:TO, or a value in the scenario"
        refuse(f"{name}: the scenario gives no value to start from; allowed: {allowed}")
    key.start = start
    key.logarithmic = start > 0 and (facts.positive or key.lower > 0)
    bounded = bool(equals) and math.isfinite(key.upper - key.lower)
    key.scale = (key.upper - key.lower) / 10 if bounded else usual_scale(start, key.unit)
    _bbsim.number_at(given, name, key.text(start))  # raises if the scenario does not take the key
    return key


def read_free_keys(texts: Sequence[str], given: _bbsim.Given) -> List[FreeKey]:
    """Skips keys of a log (log.x.scale). Refuses keys of a window's start, and a key that stands twice."""
    keys: List[FreeKey] = []
    for text in texts:
        name = text.partition("=")[0].strip()
        if name.startswith("log."):
            continue
        if name.startswith(("ball.position", "ball.velocity")):
            allowed = "any other key that is a number"
            refuse(f"{name}: each window's start is fitted anyway; allowed: {allowed}")
        if any(key.name == name for key in keys):
            refuse(f"{name} is given twice")
        keys.append(read_free_key(text, given))
    return keys
