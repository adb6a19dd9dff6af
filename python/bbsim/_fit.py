# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keys of a scenario from logs of a rig: bbsim.fit and `bbsim fit`."""

from __future__ import annotations

import math
import os
import sys
from types import SimpleNamespace
from typing import Any, Dict, List, Optional, Sequence, Tuple, Union

import numpy as np

from . import _bbsim, _fit_text
from ._errors import InputError
from ._fit_search import Search
from ._fit_windows import Log, LogKey, Windows, WindowsFit, cut, start_coordinates
from ._found_files import declare, write, write_found
from ._free_keys import FreeKey, read_bounds, read_free_key, read_free_keys, refuse, usual_scale
from ._progress import Bar, Progress, silent
from ._scenario import Scenario, Settings, given as given_of
from ._simulate import Array, refuse as refuse_option

_USUAL_WINDOW = 2.0  # s; short, because a plate makes the ball a double integrator
_USUAL_DELAY = 0.2  # s; a camera's delay is at most that
_BALL, _GIMBAL = ("x", "y", "vx", "vy"), ("phi", "theta", "phi_rate", "theta_rate")
# Keys that a rig may need, in the order in which they are suggested.
_CANDIDATES = ("ball.inertia_factor", "ball.losses.rolling", "ball.losses.viscous", "gimbal.mounting.phi_offset",
               "gimbal.mounting.theta_offset", "gimbal.mounting.yaw", "gimbal.mounting.skew", "gimbal.mounting.height",
               "gimbal.servo.natural_frequency", "gimbal.servo.damping", "gimbal.servo.time_constant",
               "controller.sampling.delay")  # fmt: skip


def _listed(texts: Any) -> List[str]:
    return [] if texts is None else [texts] if isinstance(texts, (str, os.PathLike)) else list(texts)


def _compared(given: _bbsim.Given, maps: Sequence[str], log: _bbsim.Stored, notes: List[str]) -> List[str]:
    """The columns that the user maps, else those that the log has."""
    names = [one.partition("=")[0].replace(" ", "") for text in maps for one in text.split(",")]
    names = [name for name in dict.fromkeys(names) if name != "t"]
    moved = _bbsim.has(given, "gimbal.motion")
    if not names:
        names = [name for name in _BALL + _GIMBAL if name in log.names and not (moved and name in _GIMBAL)]
    kept = []
    for name in names:
        if moved and name in _GIMBAL:
            notes.append(f"note: {name} is given by gimbal.motion, and not compared with the log")
            continue
        why, _ = _bbsim.lacks(given, name)
        if why:
            raise InputError([("", f"--map: found {name}, {why}; allowed: columns that the scenario has")])
        kept.append(name)
    if not kept:
        allowed = "x, y, vx or vy by name, or --map x=NAME:UNIT"
        raise InputError([("", f"{log.shown_file}: has no column to compare; allowed: {allowed}")])
    return kept


def _numbers(log: _bbsim.Stored, name: str, hint: str) -> Array:
    if name not in log.names:
        raise InputError([("", f"{log.shown_file}: has no column {name}; it has {', '.join(log.names)}{hint}")])
    if log.is_text(name):
        raise InputError([("", f"{log.shown_file}: column {name}: found texts; allowed: numbers, or an empty field")])
    return np.array(log.numbers(name), dtype=float)


def _log(given: _bbsim.Given, stored: _bbsim.Stored, columns: Sequence[str], notes: List[str]) -> Log:
    times = _numbers(stored, "t", ". --map t=NAME:UNIT names the time")
    values = np.array([_numbers(stored, name, "") for name in columns])
    wrong = np.flatnonzero(~np.isfinite(times) | (np.diff(times, prepend=-np.inf) <= 0))
    if wrong.size:
        row, allowed = int(wrong[0]), "finite times that increase"
        place = f"{stored.shown_file}: column t, row {row + 1}"
        raise InputError([("", f"{place}: found {times[row]:.17g}; allowed: {allowed}")])
    if not times.size:
        raise InputError([("", f"{stored.shown_file}: has no rows")])
    for name, its in zip(columns, values):
        largest = float(np.nanmax(np.abs(its), initial=0))
        doubt = _bbsim.unit_doubt(name, largest)
        if doubt:
            notes.append(f"warning: {stored.shown_file}: {name} goes up to {largest!r}, read in SI: it looks like {doubt}")
    return Log(stored.shown_file, times, values, given)


def _log_key(text: str, columns: Sequence[str], units: Sequence[str]) -> LogKey:
    """log.COLUMN.scale, log.COLUMN.offset or log.delay, with or without bounds."""
    name, equals, bounds = (part.strip() for part in text.partition("="))
    _, _, rest = name.partition(".")
    column, _, of = rest.rpartition(".")
    if rest == "delay":
        key = LogKey(name, "s", lower=0.0, upper=math.inf if equals else _USUAL_DELAY)
    elif column in columns and of in ("scale", "offset"):
        place = columns.index(column)
        key = LogKey(name, units[place] if of == "offset" else "", of=of, column=place)
    else:
        allowed = [f"log.{one}.scale, log.{one}.offset" for one in columns]
        refuse(f"{name}: allowed for a log: log.delay, {', '.join(allowed)}")
    if equals:
        read_bounds(bounds, key)
    key.logarithmic = key.of == "scale" and key.lower > 0
    key.start = 1.0 if key.of == "scale" else 0.0
    if key.of == "delay" or not key.lower <= key.start <= key.upper:
        key.start = (key.lower + key.upper) / 2
    bounded = math.isfinite(key.upper - key.lower)
    key.scale = (key.upper - key.lower) / 10 if bounded else usual_scale(key.start, "" if key.of == "scale" else "m")
    return key


def _candidates(given: _bbsim.Given, keys: Sequence[FreeKey], columns: Sequence[str], units: Sequence[str]) -> List[FreeKey]:
    """Keys of this scene that are not free."""
    tables = [file[: -len(".file")] for file, _ in _bbsim.tables(given)]
    tables = [one for one in tables if one.startswith(("gimbal.motion", "controller.commands"))]
    names = [f"{table}.{of}" for table in tables for of in ("offset", "delay", "scale")] + list(_CANDIDATES)
    found: List[FreeKey] = [_log_key(f"log.{name}.scale", columns, units) for name in columns]
    for name in names:
        try:
            found.insert(len(found) - len(columns), read_free_key(name, given))
        except InputError:
            pass
    return [key for key in found if key.name not in {one.name for one in keys}]


def _ideal(given: _bbsim.Given) -> Optional[_bbsim.Given]:
    """A solid ball that rolls without losses on a perfectly mounted plate, which follows the motion or the commands
    without lag. None for scenes with feedback or torques."""
    changes = [("controller", "null")] if _bbsim.has(given, "controller") else []
    if _bbsim.has(given, "controller.commands"):
        phi, theta = (_bbsim.text_at(given, f"controller.commands.{axis}") for axis in ("phi", "theta"))
        changes += [("gimbal.motion", f"{{phi: {phi}, theta: {theta}}}")]
    elif not _bbsim.has(given, "gimbal.motion"):
        return None
    parts = ["output", "gimbal.servo", "gimbal.linkage", "gimbal.three_servos", "gimbal.mounting", "ball.losses", "events"]
    parts += [] if _bbsim.has(given, "ball.groove") else ["ball.inertia_factor"]
    return given.changed(changes + [(part, "null") for part in parts if _bbsim.has(given, part)])


def _rms(search: Search, residuals: Array) -> Dict[str, float]:
    return dict(zip(search.windows.columns, map(float, search.sizes(residuals).rms)))


def _rms_of(fit: Search, windows: Windows, keys: Sequence[FreeKey], u: Array, given: Any = None) -> Dict[str, float]:
    """Of other windows, or of another rig, at u; nothing if one does not run."""
    its = fit.windows
    logs = its.logs if given is None else [Log(log.name, log.times, log.values, given(log.given)) for log in its.logs]
    other = WindowsFit(logs, its.columns, windows, keys, its.free, its.threads)
    search = Search(other, False, silent, its.noise)
    try:
        residuals = other.residuals(u)
    except InputError:
        return {}
    return _rms(search, residuals) if other.point.runs.all() else {}


def _time(option: str, value: Any) -> Optional[float]:
    if value is None:
        return None
    time = _bbsim.value_in(str(value), "s")
    if time is None or not time > 0:
        raise refuse_option(option, repr(value), 'a time greater than 0, such as 2 or "500 ms"')
    return time


def _share(value: Any) -> float:
    try:
        share = float(value or 0)
    except ValueError:
        share = math.nan
    if not 0 <= share < 1:
        raise refuse_option("hold-out", str(value), "a share from 0 to below 1, such as 0.3")
    return share


def _whole(option: str, value: Any, least: int) -> int:
    if not str(value).isdecimal() or int(value) < least:
        raise refuse_option(option, str(value), f"a whole number, {least} or more")
    return int(value)


class _Task:
    """What is asked for, checked, and the logs, read."""

    def __init__(self, given: _bbsim.Given, logs: Any, free: Any, map: Any, header: Any, period: Any, time_offset: Any,
                 window: Any, hold_out: Any, loss: Optional[str], starts: Any, threads: Any) -> None:  # fmt: skip
        self.given, self.files, self.warnings = given, [os.fspath(file) for file in _listed(logs)], []  # type: ignore
        self.share, self.length = _share(hold_out), _time("window", window)
        loss = loss or "squares"
        if loss not in ("squares", "huber"):
            raise refuse_option("loss", f"'{loss}'", "squares or huber")
        self.robust, self.threads = loss == "huber", _whole("threads", threads or 0, 0)
        self.starts = None if starts is None else _whole("starts", starts, 1)
        for own in ("program", "library"):
            if _bbsim.has(given, f"controller.{own}"):
                allowed = "a law of bbsim, or gimbal.motion from the log's table"
                raise InputError([("", f"controller: found a {own} of your own; allowed in a fit: {allowed}")])
        free = _listed(free)
        if not free or not self.files:
            raise refuse_option("free" if self.files else "logs", "nothing", "at least one")
        self.keys: List[FreeKey] = read_free_keys(free, given)
        run = given.changed([("solver.error", "null"), ("solver.rtol", "1e-10"), ("solver.atol", "1e-12")])
        maps, header = _listed(map), [name for text in _listed(header) for name in text.split(",")]
        tables = self._tables_of_logs()
        self.logs: List[Log] = []
        for file in self.files:
            stored, notes = _bbsim.read_log(file, maps, header, str(period or ""), str(time_offset or ""))
            self.warnings += notes
            if not self.logs:
                self.columns = _compared(given, maps, stored, self.warnings)
            its = [(key, f"'{os.path.abspath(file)}'") for key in tables if len(self.files) > 1]
            self.logs.append(_log(run.changed(its), stored, self.columns, self.warnings))
        known = {column[0]: column[2] for column in _bbsim.known_columns("rad")}
        self.units = [known[name] for name in self.columns]
        for text in free:
            if text.strip().startswith("log."):
                self.keys.append(_log_key(text, self.columns, self.units))
        names = [key.name for key in self.keys]
        if len(set(names)) < len(names):
            refuse(f"{max(names, key=names.count)} is given twice")

    def _tables_of_logs(self) -> List[str]:
        """If a table of the scenario is one of the logs, each log replaces it in turn."""
        folder = os.path.dirname(self.given.name) if os.path.exists(self.given.name) else ""
        for file in self.files:
            found = [key for key, path in _bbsim.tables(self.given) if not key.startswith("ball.")
                     and os.path.exists(os.path.join(folder, path)) and os.path.exists(file)
                     and os.path.samefile(os.path.join(folder, path), file)]  # fmt: skip
            if found:
                return found
        return []

    def cut(self) -> Tuple[Windows, Windows, List[int], float]:
        """The windows to fit and those held out, the coordinates of their starts, and their length."""
        given = self.logs[0].given
        loop = _bbsim.has(given, "controller") and not _bbsim.has(given, "controller.commands")
        # Feedback keeps errors small over whole logs and carries on states that no log shows.
        whole = loop and self.length is None and not self.share
        length = math.inf if whole else self.length or _USUAL_WINDOW
        delay = max((key.upper for key in self.keys if isinstance(key, LogKey) and key.of == "delay"), default=0.0)
        fewest = len(start_coordinates(self.columns, given, not whole))
        windows, held = cut(self.logs, length, self.share, fewest, delay)
        within = len(windows) + len(held) > len(set(windows.log.tolist() + held.log.tolist()))
        free = start_coordinates(self.columns, given, within)
        numbers, unknowns = int(np.isfinite(windows.values).sum()), len(windows) * len(free) + len(self.keys)
        if numbers <= unknowns:
            raise InputError([("", f"the logs have {numbers} numbers in {len(windows)} windows; allowed: more than the "
                              f"{unknowns} that are sought, starts included; use a longer --window or fewer --free "
                              "keys")])  # fmt: skip
        return windows, held, free, length


def _fit(task: _Task, progress: Progress, series: bool) -> Any:
    """A result without a text; None if it is interrupted before there is one."""
    windows, held, free, length = task.cut()
    fit = WindowsFit(task.logs, task.columns, windows, task.keys, free, task.threads)
    search = Search(fit, task.robust, progress)
    interrupted, before = False, None
    try:
        residuals = fit.residuals(search.u)
        if not fit.point.runs.all():
            w = int(np.argmin(fit.point.runs))
            raise InputError([("", f"{task.logs[windows.log[w]].name}: from t = {windows.begin[w]:.6g} s on, the scenario "
                              f"does not run to the window's end: {fit.point.why[w]}")])  # fmt: skip
        before = _rms(search, residuals)
        search.begin(task.starts)
        search.settle()
    except KeyboardInterrupt:
        if before is None:
            return None
        interrupted = True
    made = SimpleNamespace(interrupted=interrupted, logs=task.files, windows=len(windows), held=len(held),
                           numbers=fit.size, window=length, units=dict(zip(task.columns, task.units)))  # fmt: skip
    made.notes, made.warnings = [text.partition(": ")[2] for text in task.warnings], len(task.warnings)
    residuals = fit.residuals(search.u)
    _describe(made, search, residuals, before)
    made.ideal_rms = made.hold_out_ideal_rms = made.hold_out_before_rms = made.hold_out_rms = {}
    ideal = _ideal(task.logs[0].given)
    if ideal is not None and not any(_bbsim.lacks(ideal, name)[0] for name in task.columns):
        made.ideal_rms = _rms_of(search, windows, [], np.empty(0), _ideal)
    pairs = [(made.residual_rms[name], one) for name, one in made.ideal_rms.items()]
    if not made.exact and sum(math.log(its / one) for its, one in pairs if one > 0) > 1e-3:
        search.doubts.append("the fit is worse than an ideal rig: try other starting values, bounds or keys")
    if len(held):
        made.hold_out_before_rms = _rms_of(search, held, task.keys, np.zeros(len(task.keys)))
        made.hold_out_rms = _rms_of(search, held, task.keys, search.u)
        if made.ideal_rms:
            made.hold_out_ideal_rms = _rms_of(search, held, [], np.empty(0), _ideal)
    made.series = []
    if series:
        made.series = _series(fit, search.u, False)
        if len(held):
            made.series += _series(WindowsFit(task.logs, task.columns, held, task.keys, free, task.threads), search.u, True)
    _judge(made, search, task, interrupted)
    return made


def _series(fit: WindowsFit, u: Array, held: bool) -> List[Any]:
    """Log and model of each window."""
    shown, its = fit.modelled(u), fit.windows
    return [SimpleNamespace(log=int(its.log[w]), held=held, times=its.times[w, : its.rows[w]],
                            measured=its.values[w, :, : its.rows[w]], modelled=shown[w, :, : its.rows[w]])
            for w in range(len(its))]  # fmt: skip


def _describe(made: Any, search: Search, residuals: Array, before: Dict[str, float]) -> None:
    """What the residuals tell."""
    fit, sizes = search.windows, search.sizes(residuals)
    made.before_rms, made.residual_rms = before, _rms(search, residuals)
    errors = np.zeros(fit.there.shape)
    errors[fit.there] = residuals
    errors = errors.reshape(fit.windows.values.shape)
    products = (errors[..., 1:] * errors[..., :-1]).sum((0, 2)) / np.maximum((errors**2).sum((0, 2)), 1e-300)
    exact = sizes.rms <= 1e-6 * search.spreads
    made.exact = bool(exact.all())
    # Fitting the starts reduces correlation, so white residuals rarely reach this.
    made.white = bool(np.all(exact | (products < 3 / np.sqrt(np.maximum(sizes.counts, 1)))))
    made.correlated = ", ".join(f"{name}: {_bbsim.rounded(one, 2)}" for name, one in zip(fit.columns, products))
    raw = np.zeros(fit.there.shape)
    raw[fit.there] = search.in_si(residuals)
    far = (np.abs(raw.reshape(errors.shape)) > 5 * sizes.usual[:, None]) & ~exact[:, None]
    made.outliers, made.outlier_notes = dict(zip(fit.columns, map(int, far.sum((0, 2))))), []
    for c, name in enumerate(fit.columns):
        if far[:, c].any():
            window, row = (int(one[0]) for one in np.nonzero(far[:, c]))
            count = made.outliers[name]
            made.outlier_notes.append(
                f"{count} number{' of' if count == 1 else 's of'} {name} {'is' if count == 1 else 'are'} beyond 5 standard "
                f"deviations, the first at t = {fit.windows.times[window, row]:.6g} s of "
                f"{made.logs[fit.windows.log[window]]}"
                + ("" if search.robust else "; --loss huber gives such numbers less weight"))  # fmt: skip


def _judge(made: Any, search: Search, task: _Task, interrupted: bool) -> None:
    """Estimates, intervals and notes."""
    linear = search.linear()
    scatter, u = search.scatter(), search.u
    made.parameters, profiled = [], not interrupted
    for k, key in enumerate(search.keys):
        one = SimpleNamespace(key=key.name, unit=key.unit, before=key.start, estimate=float(key.value(u[k])), sd=math.inf,
                              told=bool(linear.told[k]), interval=[-math.inf, math.inf])  # fmt: skip
        one.at_bound = one.estimate in (key.lower, key.upper)
        if one.told:
            one.sd = math.sqrt(linear.covariance[k, k] * scatter) * abs(key.slope(u[k]))
            try:
                one.interval = list(search.interval(k, linear, profiled))
            except KeyboardInterrupt:
                made.interrupted, profiled = True, False
                one.interval = list(search.interval(k, linear, profiled))
        made.parameters.append(one)
    search.windows.residuals(u)
    made.correlations = linear.correlations
    notes = [f"not identifiable: {words}" for words in linear.untold]
    notes += [f"{one.key} is at a bound of its range" for one in made.parameters if one.at_bound]
    most = np.nanmax(np.abs(np.nan_to_num(linear.correlations) - np.diag(linear.told.astype(float))), axis=0, initial=0)
    names = [key.name for key, one in zip(search.keys, most) if one > 0.95]
    if names:
        notes.append(f"{', '.join(names[:-1])} and {names[-1]} are correlated, up to {_bbsim.rounded(most.max(), 4)}: the "
                     "logs determine a combination of them better than each")  # fmt: skip
    notes += made.outlier_notes
    if made.interrupted:
        count = search.iterations
        notes.append(f"interrupted after {count} iteration{'' if count == 1 else 's'}: these are the best values so far")
    made.suggestion = None
    if not made.white:
        notes.append(f"neighboring residuals are correlated ({made.correlated}); the model is incomplete and the intervals "
                     "are too short")  # fmt: skip
        if not made.interrupted:
            its = search.suggestion(_candidates(task.logs[0].given, search.keys, task.columns, task.units))
            if its is not None:
                made.suggestion = {"key": its[0], "residuals_smaller_by": its[1]}
                notes.append(f"--free {its[0]} could make the residuals about {_bbsim.rounded(100 * its[1], 2)} % smaller")
    made.identifiable = not linear.untold and not search.doubts
    made.notes += [*search.doubts, *notes]


def fit(
    scenario: Scenario, logs: Any, free: Any, *, set: Settings = None, map: Any = (), header: Any = (),
    period: Any = None, time_offset: Any = None, window: Any = None, hold_out: float = 0, loss: str = "squares",
    starts: Optional[int] = None, output: Any = None, json: Any = None, report: Any = None, threads: int = 0,
) -> Any:  # fmt: skip
    """Finds the values of a scenario's keys at which its runs are closest to logs of a rig.

    logs      files, as `bbsim fit` reads them
    free      the keys to fit, "KEY" or "KEY=FROM:TO"; also log.x.scale, log.x.offset and log.delay
    map, header, period, time_offset   how to read the logs
    window    the length of a window: 2, "500 ms"
    hold_out  the share of windows to keep out of the fit
    loss      "squares" or "huber"
    starts    the number of sets of starting values
    output, json, report   files to write: the scenario with the estimates, the results, a page

    The result has the names of the JSON: parameters (key, estimate, sd, interval, at_bound), residual_rms,
    hold_out_rms, identifiable, correlations, white, suggestion, outliers, notes; `report` is the printed text. An
    interrupted fit gives the best values so far.
    """
    options = dict(locals())
    return _carry_out(given_of(options.pop("scenario"), options.pop("set")), options, silent, None)


def _carry_out(given: _bbsim.Given, options: Dict[str, Any], progress: Progress, say: Any) -> Any:
    """Fits, and writes what the options ask for; with `say`, also the report. None if it is interrupted before there is
    a result."""
    files = {name: str(options.pop(name) or "") for name in ("output", "json", "report")}
    task = _Task(given, **options)
    reads = {given.name: "the scenario"} if os.path.exists(given.name) else {}
    template: Dict[str, str] = {}
    declare(files, {**reads, **{file: "the log" for file in task.files}, **template}, "report")
    if files["output"]:  # fails before the work if the text cannot be written
        _bbsim.edited(given, [(key.name, key.text(key.start)) for key in task.keys if not isinstance(key, LogKey)], "", False)
    if files["report"]:
        _bbsim.filled_page("fit.html", "", "{}")
    for text in task.warnings if say else ():
        say(text)
    made = _fit(task, progress, bool(files["report"]))
    if made is None:
        return None
    made.report = _fit_text.report(made)
    made.scenario = _fit_text.scenario(made, given) if files["output"] else ""
    if files["report"]:
        write(files["report"], _fit_text.page(made, given))
    text = made.report if say else ""
    write_found(given, given.name, files, made.scenario, _fit_text.as_document(made), text, say or str, "report")
    return made


def command(options: Dict[str, Any], say: Any) -> int:
    """`bbsim fit`; `say` prints a message unless -q is given."""
    given = _bbsim.Given(options.pop("scenario"), None, options.pop("set"), None)
    options["logs"] = options.pop("log")
    with Bar(given.name, options.pop("quiet")) as progress:
        made = _carry_out(given, options, progress, say)
    if made is None:
        sys.stderr.write("fit: interrupted before the first iteration; nothing is written\n")
    return 130 if made is None or made.interrupted else 0
