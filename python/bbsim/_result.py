# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The results of runs: of one, of many as arrays, as a linear system, on pages, compared; and the example scenarios."""

from __future__ import annotations

import html
import json
import os
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _bbsim
from ._scenario import (Array, Columns, Log, Scenario, Settings, as_files, as_yaml, fault, given, is_text, listed,
                        log_choice, numbers, overrides, refuse, require, without_folders)  # fmt: skip

if TYPE_CHECKING:
    import matplotlib.figure
    import pandas

File = Union[str, "os.PathLike[str]"]
Texts = Union[str, Sequence[str]]
Cases = Union[Mapping[str, Any], Sequence[Mapping[str, Any]]]


class Result(Columns):
    """The rows of a run, by column, and how the run ended.

    ``result["x"]`` is a numpy array that shares the memory of the run, in SI units and radians.
    """

    def __init__(self, run: Any) -> None:
        super().__init__(run.rows)
        self._run = run
        self.units: Dict[str, str] = dict(zip(run.columns, run.units))  # "1" for a number without a unit
        self.measures: Dict[str, float] = dict(run.measures)
        self.status: str = run.status  # done, stopped by an event, or failed
        self.reason: str = run.reason  # why the run ended early
        self.warnings: List[str] = run.warnings
        self.unmet: List[str] = run.unmet  # conditions of `expect` that do not hold

    @cached_property
    def summary(self) -> Dict[str, Any]:
        """What ``bbsim run --summary`` writes."""
        return json.loads(self._run.summary)

    @property
    def events(self) -> List[Dict[str, Any]]:
        """The events that occurred, with the state at each."""
        return self.summary["events"]

    def __reduce__(self) -> "tuple[type, tuple[Any]]":
        names = ("columns", "units", "unmet", "measures", "warnings", "title", "status", "reason", "summary", "rows")
        return Result, (SimpleNamespace(**{name: getattr(self._run, name) for name in names}),)

    def __len__(self) -> int:
        return len(self[self.columns[0]])

    def __repr__(self) -> str:
        title = f"{self._run.title!r}, " if self._run.title else ""
        return f"<bbsim.Result {title}{self.status}, {len(self)} rows: {', '.join(self.columns)}>"

    def to_pandas(self) -> "pandas.DataFrame":
        """A pandas DataFrame of the columns; its ``attrs["units"]`` are the units."""
        import pandas

        frame = pandas.DataFrame({name: self[name] for name in self.columns})
        frame.attrs["units"] = dict(self.units)
        return frame

    def _stored(self) -> _bbsim.Stored:
        return _bbsim.Stored([(name, self.units[name], self[name], []) for name in self.columns], self._run.summary)

    def plot(self, columns: Union[str, Sequence[str]] = (), **options: Any) -> "matplotlib.figure.Figure":
        """Draws the run with ``bbsim.plot``: all columns, or the panels ``["path", "x,x_reference", "phi"]``."""
        from ._plot import plot

        return plot(self, columns=columns, **options)

    def _repr_html_(self) -> str:
        rows = [("status", self.status), *[("reason", self.reason)] * bool(self.reason), ("rows", str(len(self)))]
        rows += [(name, f"{value:.6g}") for name, value in self.measures.items()]
        rows += [*(("unmet", text) for text in self.unmet), *(("warning", text) for text in self.warnings)]
        cell = "<t{0} style='text-align:left'>{1}</t{0}>".format
        table = "".join(f"<tr>{cell('h', html.escape(name))}{cell('d', html.escape(text))}</tr>" for name, text in rows)
        title = f"<caption>{html.escape(self._run.title)}</caption>" if self._run.title else ""
        style = "display:flex;gap:2em;align-items:flex-start"
        return f"<div style='{style}'><table>{title}{table}</table>{self._path()}</div>"

    def _path(self) -> str:
        """The ball's path from above, as SVG; empty without the columns x and y."""
        if "x" not in self or "y" not in self:
            return ""
        points = np.column_stack([self["x"], -self["y"]])[:: max(1, len(self) // 500)]  # SVG's y points down
        points = points[np.isfinite(points).all(1)]
        if not len(points):
            return ""
        low, high = points.min(0), points.max(0)
        points = (points - (low + high) / 2) * 200 / (1.1 * max((high - low).max(), 1e-9)) + 100
        shown = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        return (
            "<svg width='200' height='200' viewBox='0 0 200 200' role='img' aria-label='path of the ball'>"
            f"<polyline points='{shown}' fill='none' stroke='currentColor' stroke-width='1.5'/>"
            f"<circle cx='{points[0, 0]:.1f}' cy='{points[0, 1]:.1f}' r='3' fill='currentColor'/></svg>"
        )


class Simulated(Columns):
    """The columns, measures and status of each case; ``made["x"]`` has a row for each case."""

    def __init__(self, cases: Any, columns: Sequence[str], measures: Sequence[str]) -> None:
        arrays, values, status, reasons = cases
        super().__init__(dict(zip(columns, arrays)))
        self.measures: Dict[str, Array] = dict(zip(measures, values))
        self.status: "np.ndarray[Any, np.dtype[np.str_]]" = np.array(status, dtype=np.str_)
        self.reason: List[str] = reasons

    def __len__(self) -> int:
        return len(self.status)

    def __repr__(self) -> str:
        words, counts = np.unique(self.status, return_counts=True)
        ends = ", ".join(f"{count} {word}" for word, count in zip(words, counts))
        return f"<bbsim.Simulated {len(self)} cases ({ends}): {', '.join([*self.columns, *self.measures])}>"


def _key(key: str, values: Any) -> Tuple[str, Array, List[str]]:
    """The name of a key, and its numbers or texts."""
    what = f"cases: {key}"
    if isinstance(values, (str, bytes, Mapping)) or not hasattr(values, "__len__") or getattr(values, "ndim", 1) == 0:
        raise refuse(what, f"{values!r:.60}", "an array or list with a value for each case")
    plain = isinstance(values, np.ndarray) or all(isinstance(value, (float, int)) for value in values)
    array = np.asarray(values) if plain else None
    if array is not None and array.ndim == 1 and array.dtype.kind in "fiu":
        return key, array.astype(float), []
    return key, np.empty(0), [as_yaml(value) for value in values]


def _keys(cases: Cases) -> Tuple[Optional[int], List[Any]]:
    """The number of cases, if the keys tell it, and their values."""
    if isinstance(cases, Mapping):
        keys = [_key(str(key), values) for key, values in cases.items()]
        return next(map(len, cases.values()), None), keys
    if isinstance(cases, (str, bytes)) or not all(isinstance(case, Mapping) for case in cases):
        raise refuse("cases", f"{cases!r:.60}", "{KEY: array}, or a list of {KEY: value}")
    names = dict.fromkeys(str(key) for case in cases for key in case)
    lists = {name: [case.get(name, "") for case in cases] for name in names}
    return len(cases), [_key(name, values) for name, values in lists.items()]


def simulate(scenario: Scenario, cases: Cases, columns: Texts, times: Any = None, measures: Texts = (),
             begin: Any = None, end: Any = None, start: Any = None, events: bool = True, *, set: Settings = None,
             threads: int = 0) -> Simulated:  # fmt: skip
    """Runs a scenario at many values of its keys; returns arrays.

    cases     {KEY: array of n values}, or a list of n dicts; {} if only begin, end or start differ
    times     one array of m times in s, or an array (n, m); by default the scenario's rows
    begin     n times from which the cases cover the scenario (s), and in ``end`` those until which they do
    start     an array (n, 9) of states at the begins: x, y, vx, vy, phi, theta, phi_rate, theta_rate, spin (SI)
    events    False: without the events that stop a run or only observe it

    A case that does not run to its end says why in ``status`` and ``reason``. Raises InputError.
    """
    count, keys = _keys(cases)
    ends = [numbers(name, () if when is None else when, (), ("n",)) for name, when in (("begin", begin), ("end", end))]
    width = len(_bbsim.START)
    states = numbers("start", np.empty((0, width)) if start is None else start, ("n", width))
    at = None if times is None else numbers("times", times, ("m",), ("n", "m"))
    if count is None:
        lists = [*ends, states] + ([at] if at is not None and at.ndim == 2 else [])
        count = max(len(one) for one in lists if one.ndim > 0) or 1
    ends = [array if array.ndim else np.full(count, array) for array in ends]
    names, asked = listed("columns", columns), listed("measures", measures)
    require("threads", threads, Real, "a whole number")
    windows = (at, *ends, states, require("events", events, (bool, np.bool_), "True or False"))
    cases_done = _bbsim.simulate(given(scenario, set), count, keys, names, asked, *windows, threads)
    return Simulated(cases_done, names, asked)


class _StateSpace:
    """dz = A z + B u, y = C z + D u: dz is z', or z after one period ``dt``."""

    def __init__(self, system: Any) -> None:
        self._matrices: Tuple[Array, Array, Array, Array] = (system.A, system.B, system.C, system.D)
        self.A, self.B, self.C, self.D = self._matrices
        self.dt: Optional[float] = system.dt
        signals = (system.states, system.inputs, system.outputs)
        self.states, self.inputs, self.outputs = ([name for name, _ in its] for its in signals)

    def to_scipy(self) -> Any:
        """A ``scipy.signal.StateSpace``."""
        from scipy.signal import StateSpace

        return StateSpace(*self._matrices, dt=self.dt) if self.dt else StateSpace(*self._matrices)

    def to_control(self) -> Any:
        """A state space of python-control."""
        import control

        names = {"states": self.states, "inputs": self.inputs, "outputs": self.outputs}
        return control.ss(*self._matrices, self.dt or 0, **names)


class OpenLoop(_StateSpace):
    """The loop broken at the command of one axis, with the other one closed.

    One input and one output, with the sign for which -1 is the critical point. A sampled loop goes from
    sample to sample, with all its delays; in continuous time ``dt`` is 0.
    """

    dt: float

    def __init__(self, system: Any) -> None:
        super().__init__(system)
        self.dt = system.dt or 0.0
        (self.command, self.unit), = system.inputs
        self.outputs = [self.command]

    def response(self, frequencies: Any) -> "np.ndarray[Any, np.dtype[np.complex128]]":
        """The frequency response at these angular frequencies (rad/s); not finite at a pole."""
        w = np.asarray(frequencies, dtype=np.float64)
        return np.reshape(_bbsim.response(*self._matrices, self.dt, w.ravel()), w.shape)

    def __repr__(self) -> str:
        time = f"every {self.dt} s" if self.dt else "in continuous time"
        return f"<bbsim.OpenLoop at {self.command}, {len(self.states)} states, {time}>"


class Linearization(_StateSpace):
    """A scenario as a linear system. In continuous time ``dt`` is None."""

    def __init__(self, linear: Any) -> None:
        super().__init__(linear.system)
        self.units: Dict[str, str] = dict([*linear.system.states, *linear.system.inputs, *linear.system.outputs])
        self.kind, self.at, self.note = (str(text) for text in (linear.kind, linear.at, linear.note))
        self._json: Dict[str, Any] = json.loads(linear.json)
        self._report: str = linear.report.rstrip("\n")
        self._loops = {loop.command: OpenLoop(loop.open) for loop in linear.open_loops}
        self._frequencies = np.array(linear.frequencies)  # at which to look at these loops

    @property
    def poles(self) -> "np.ndarray[Any, np.dtype[np.complex128]]":
        return np.array([complex(*pole) for pole in self._json["poles"]])

    @property
    def stable(self) -> bool:
        """Whether all poles decay."""
        return bool((self.poles.real < 0).all() if self.dt is None else (np.abs(self.poles) < 1).all())

    @property
    def margins(self) -> Dict[str, Any]:
        """As ``bbsim linearize`` writes them, for each command's loop; {} for a plant."""
        return self._json.get("margins") or {}

    def open_loop(self, axis: str) -> OpenLoop:
        """The loop with ``margins[f"{axis}_command"]``. Raises InputError if this axis, "phi" or "theta", has none."""
        if axis not in ("phi", "theta"):
            raise fault(f"axis: found {axis!r}; allowed: phi, theta")
        if f"{axis}_command" not in self._loops:
            why = "its command closes no loop" if self.kind == "loop" else f"this is the {self.kind}, without a loop"
            raise fault(f"axis: found {axis}, but {why}; allowed: axes of a closed loop")
        return self._loops[f"{axis}_command"]

    def __repr__(self) -> str:
        return self._report


@dataclass
class Page:
    """A page that plays runs; notebooks show it."""

    html: str
    reason: str  # why the run of a scenario ended early
    notes: List[str]

    def __repr__(self) -> str:
        return f"<bbsim.Page, {len(self.html) / 1e6:.2f} MB>"

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{html.escape(self.html)}" style="width: 100%; height: 600px; border: 0"></iframe>'


@dataclass
class Compared:
    """Whether two results are alike, with the table that ``bbsim compare`` prints."""

    alike: bool
    text: str
    reason: str  # why the run of a scenario ended early
    warnings: List[str]

    def __bool__(self) -> bool:
        return self.alike


def replay(*files: Union[Scenario, Result], output: Optional[File] = None, data: Union[Log, Sequence[Log]] = (),
           map: Texts = (), header: Texts = (), period: str = "", time_offset: str = "", missing: Any = None,
           title: str = "", summary: File = "", scenario: File = "", set: Settings = None) -> Page:  # fmt: skip
    """A page that plays files or results of runs or sweeps, or scenarios; ``data``: logs beside a scenario, as files,
    dicts of arrays or DataFrames. ``output`` is NAME.html. The other keywords are the options of ``bbsim replay``."""
    shown, ran = [], []  # type: List[Any], List[Result]
    for file in files:
        if isinstance(file, Mapping) or is_text(file):
            file = Result(_bbsim.run(given(file, set), None, [], ""))
            ran.append(file)
        shown.append(file._stored() if isinstance(file, Result) else os.fspath(file))
    log = log_choice(map, header, period, time_offset, missing)
    others = not ran or any(isinstance(file, str) for file in shown)
    beside = _bbsim.Beside(os.fspath(summary), os.fspath(scenario), overrides(set) if others else [])
    target = "" if output is None else os.fspath(output)
    if target and not target.lower().endswith(".html"):
        raise refuse("output", target, "a name that ends in .html")
    with as_files(data) as logs:
        page, reason, notes = _bbsim.replay(shown, logs, log, beside, title, target)
    if target:
        _bbsim.write_file(target, page)
    warnings = [text for run in ran for text in run.warnings]
    reason = next((run.reason for run in ran if run.reason), reason)
    return Page(page, reason, warnings + [without_folders(note) for note in notes])


def compare(a: Log, b: Log, *, rtol: Optional[float] = None, atol: Optional[float] = None, columns: Texts = (),
            map: Texts = (), header: Texts = (), period: str = "", time_offset: str = "", missing: Any = None,
            set: Settings = None) -> Compared:  # fmt: skip
    """Compares two files of results, or a log (also a dict of arrays or a DataFrame) with a run or a scenario's file.
    The keywords are the options of ``bbsim compare``."""
    log = log_choice(map, header, period, time_offset, missing)
    for name, found in (("rtol", rtol), ("atol", atol)):
        require(name, 0 if found is None else found, Real, "a number, in SI units")
    with as_files([a, b]) as (first, second):
        limits = (rtol, atol, listed("columns", columns))
        alike, text, reason, notes = _bbsim.compare(first, second, overrides(set), *limits, log)
    return Compared(alike, without_folders(text), reason, [without_folders(note) for note in notes])


def examples() -> Dict[str, Path]:
    """The scenarios that come with bbsim: their files, by name."""
    return {file.stem: file for file in sorted((Path(__file__).parent / "examples").glob("*.yaml"))}
