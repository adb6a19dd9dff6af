# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""What fits, tuning and designs have in common: free keys, the files that they write, and progress on the terminal."""

from __future__ import annotations

import contextlib
import json
import math
import os
import re
import shutil
import sys
import time
from dataclasses import dataclass
from typing import Any, Callable, Dict, Iterator, List, NoReturn, Sequence, Tuple

import numpy as np

from . import _bbsim
from ._scenario import OutputError, fault

# A change that probably has a visible effect, by unit (SI). Other units span orders of magnitude.
_USUAL = {"m": 0.01, "s": 0.01, "rad": 0.01, "m/s": 0.01, "N": 0.01}
_ROUNDING = 1e-12
# Noise and rounding in a loop: they differ in each log, and have no derivatives.
ROUGH = tuple(f"controller.{key}" for key in ("sensor.noise", "sensor.dropout", "sensor.seed", "sensor.resolution",
                                              "sampling.jitter", "sampling.resolution"))  # fmt: skip


def refuse_free(what: str) -> NoReturn:
    raise fault(f"--free: {what}")


def refuse_twice(names: Sequence[str]) -> None:
    for i, name in enumerate(names):
        if name in names[:i]:
            refuse_free(f"{name} is given twice")


def usual_scale(start: float, unit: str) -> float:
    return max(abs(start), _USUAL[unit]) if unit in _USUAL else abs(start) or 0.1


def refuse_own_controller(given: _bbsim.Given, task: str, allowed: str) -> None:
    if given.has("controller.program") or given.has("controller.library"):
        raise fault(f"controller: found a program or library of your own; allowed in {task}: {allowed}")


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

    @np.errstate(over="ignore")  # far away
    def value(self, u: Any) -> Any:
        """Within the bounds."""
        raw = self.start * np.exp(u) if self.logarithmic else self.start + self.scale * np.asarray(u)
        # value(number(bound)) equals the bound only within rounding.
        raw = np.where(raw >= self.upper - _ROUNDING * abs(self.upper), self.upper, raw)
        return np.where(raw <= self.lower + _ROUNDING * abs(self.lower), self.lower, raw)[()]

    def number(self, value: float) -> float:
        return math.log(value / self.start) if self.logarithmic else (value - self.start) / self.scale

    def ends(self) -> Tuple[float, float]:
        low = -math.inf if self.logarithmic and self.lower <= 0 else self.number(self.lower)
        return low, self.number(self.upper)

    def slope(self, u: float) -> float:
        """The derivative of the value by u."""
        return float(self.value(u)) if self.logarithmic else self.scale

    def text(self, value: float) -> str:
        return f"{float(value)!r} {self.unit}".strip()


def read_bounds(text: str, key: FreeKey) -> None:
    """Reads FROM:TO into the key. If only TO has a unit, it applies to FROM, too."""
    first, colon, last = (part.strip() for part in text.partition(":"))
    unit = re.fullmatch(r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?\s*(.*)", last)
    if unit and re.fullmatch(r"[-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?", first):
        first += " " + unit[1]
    low, high = (_bbsim.value_in(end, key.unit) if colon else None for end in (first, last))
    allowed = ""
    if low is None or high is None or not low < high:
        allowed = "FROM:TO with FROM below TO, numbers in SI units or with a unit" + f" of {key.unit}" * bool(key.unit)
    elif low < key.lower or high > key.upper:
        allowed = f"values from {key.lower:g} to {key.upper:g}"
    if allowed:
        refuse_free(f"{key.name}: found '{text}'; allowed: {allowed}")
    key.lower, key.upper = low, high


def read_free_key(text: str, given: _bbsim.Given) -> FreeKey:
    """KEY or KEY=FROM:TO. Raises InputError for a key that the scenario does not take."""
    name, equals, bounds = (part.strip() for part in text.partition("="))
    facts = given.key_facts(name)
    key = FreeKey(name, facts.unit, lower=facts.lower, upper=facts.upper)
    if equals:
        read_bounds(bounds, key)
    start = facts.value
    if equals and (start is None or not key.lower <= start <= key.upper):
        start = math.sqrt(key.lower * key.upper) if key.lower > 0 else (key.lower + key.upper) / 2
    if start is None:
        given.number_at(name, key.text(1.0))  # reports a misspelled key, or one of another law
        allowed = f"{name}=FROM:TO, or a value in the scenario"
        refuse_free(f"{name}: the scenario gives no value to start from; allowed: {allowed}")
    key.start = start
    key.logarithmic = start > 0 and (facts.positive or key.lower > 0)
    bounded = bool(equals) and math.isfinite(key.upper - key.lower)
    key.scale = (key.upper - key.lower) / 10 if bounded else usual_scale(start, key.unit)
    given.number_at(name, key.text(start))  # raises if the scenario does not take the key
    return key


def read_free_keys(texts: Sequence[str], given: _bbsim.Given) -> List[FreeKey]:
    """Skips keys of a log (log.x.scale). Refuses keys of a window's start, and a key that stands twice."""
    keys: List[FreeKey] = []
    for text in texts:
        name = text.partition("=")[0].strip()
        if name.startswith("log."):
            continue
        if name.startswith(("ball.position", "ball.velocity")):
            refuse_free(f"{name}: each window's start is fitted anyway; allowed: any other key that is a number")
        refuse_twice([*(key.name for key in keys), name])
        keys.append(read_free_key(text, given))
    return keys


def as_json(value: Dict[str, Any]) -> str:
    """With null for numbers that are not finite, which JSON does not have."""
    plain = json.loads(json.dumps(value, default=vars), parse_constant=lambda name: None)
    return json.dumps(plain, indent=2, ensure_ascii=False) + "\n"


def files_of(options: Dict[str, Any], given: _bbsim.Given, reads: Dict[str, str], *names: str) -> Dict[str, str]:
    """The files to write, by option. Refuses those that would overwrite each other or an input."""
    files, outputs = {name: os.fspath(options.pop(name) or "") for name in names}, _bbsim.Outputs()
    outputs.reads_scenario(given)
    for file, what in reads.items():
        outputs.reads(file, what)
    for name, file in files.items():
        if file:
            outputs.writes(file, "-o" if name == "output" else f"--{name}")
    if "-" not in files.values():
        outputs.writes("-", "the report")
    return files


def write_all(given: _bbsim.Given, files: Dict[str, str], texts: Dict[str, str], say: Any) -> None:
    for name, file in files.items():
        if file:
            _bbsim.write_file(file, texts[name])
    output = files["output"] or "-"
    folders = {os.path.dirname(os.path.abspath(file)) for file in (output, given.name)}
    if output != "-" and len(folders) > 1 and given.tables():
        say(f"note: {output} is not in the scenario's folder, from which its tables are read; move it there to run it")


def carry_out(name: str, task: Any, options: Dict[str, Any], say: Any) -> Any:
    """The result of a command, `task(given, options, progress, say)`, after its report if no file goes to standard
    output; None if it is interrupted before there is one."""
    given = _bbsim.Given(options.pop("scenario"), None, options.pop("set"), None).changed([])  # reads standard input once
    to_files = "-" in [options.get(name) for name in ("output", "json", "report", "table", "sketch")]
    try:
        quiet = options.pop("quiet") or not sys.stderr.isatty()
        with contextlib.nullcontext(silent) if quiet else bar(given.name) as progress:
            result = task(given, options, progress, say)
    except KeyboardInterrupt:
        sys.stderr.write(f"{name}: interrupted before the first result; nothing is written\n")
        return None
    try:
        sys.stdout.write("" if to_files else result.report)
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        raise OutputError(f"cannot write to standard output: {(error.strerror or '').lower()}") from None
    return result


Progress = Callable[[float, str], None]  # the fraction done, and a detail for people
_CLEAR = "\r\x1b[K"


def silent(fraction: float, detail: str = "") -> None:
    pass


@contextlib.contextmanager
def bar(label: str) -> Iterator[Progress]:
    """Gives a function that draws a bar on standard error, from the first second on. The end, or a fraction of 1 after
    which messages may follow, clears it."""
    start = last = time.monotonic()

    def draw(fraction: float, detail: str = "") -> None:
        nonlocal last
        now = time.monotonic()
        if fraction >= 1 and last > start:
            sys.stderr.write(_CLEAR)
        elif fraction < 1 and now - start >= 1 and now - last >= 0.1:
            last = now
            left = (now - start) * (1 - fraction) / fraction if fraction > 0.01 else None
            columns = max(shutil.get_terminal_size().columns - 1, 10)
            sys.stderr.write(_CLEAR + _bbsim.progress_line(label, detail, max(fraction, 0.0), left, columns))
        sys.stderr.flush()

    try:
        yield draw
    finally:
        draw(1)
