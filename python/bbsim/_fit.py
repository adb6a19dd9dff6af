# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Keys of a scenario from logs of a rig: bbsim.fit and `bbsim fit`."""

from __future__ import annotations

import math
import os
from types import SimpleNamespace
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from . import _bbsim, _fit_text
from ._fit_search import Search
from ._fit_windows import Log, LogKey, Windows, WindowsFit, cut, start_coordinates
from ._scenario import (Array, InputError, Scenario, Settings, as_files, counted, fault, from_to, given as given_of,
                        listed, log_choice, refuse, without_folders)  # fmt: skip
from ._task import (ROUGH, FreeKey, Progress, carry_out, files_of, read_bounds, read_free_key, read_free_keys,
                    refuse_free, refuse_own_controller, refuse_twice, silent, usual_scale, write_all)  # fmt: skip

_USUAL_WINDOW = 2.0  # s; short, because a plate makes the ball a double integrator
_USUAL_DELAY = 0.2  # s; a camera's delay is at most that
_BALL, _GIMBAL = ("x", "y", "vx", "vy"), ("phi", "theta", "phi_rate", "theta_rate")
# Keys that a rig may need, in the order in which they are suggested.
_CANDIDATES = ("ball.inertia_factor", "ball.losses.rolling", "ball.losses.viscous", "gimbal.mounting.phi_offset",
               "gimbal.mounting.theta_offset", "gimbal.mounting.yaw", "gimbal.mounting.skew", "gimbal.mounting.height",
               "gimbal.servo.natural_frequency", "gimbal.servo.damping", "gimbal.servo.time_constant",
               "controller.sampling.delay")  # fmt: skip


def _compared(given: _bbsim.Given, maps: Sequence[str], log: _bbsim.Stored, notes: List[str]) -> List[str]:
    """The columns that the user maps, else those that the log has."""
    moved = _GIMBAL if given.has("gimbal.motion") else ()
    mapped = [part.partition("=")[0].replace(" ", "") for text in maps for part in text.split(",")]
    names = [name for name in dict.fromkeys(mapped) if name != "t"]
    names = names or [name for name in _BALL + _GIMBAL if name in log.names and name not in moved]
    notes += [f"note: {name} is given by gimbal.motion, and not compared with the log" for name in names if name in moved]
    names = [name for name in names if name not in moved]
    for name in names:
        why = given.lacks(name)
        if why:
            raise refuse("--map", f"{name}, {why}", "columns that the scenario has")
    if not names:
        allowed = "x, y, vx or vy by name, or --map x=NAME:UNIT"
        raise fault(f"{log.shown_file}: has no column to compare; allowed: {allowed}")
    return names


def _log(given: _bbsim.Given, stored: _bbsim.Stored, columns: Sequence[str], notes: List[str]) -> Log:
    file, values = stored.shown_file, []
    for name, hint in (("t", ". --map t=NAME:UNIT names the time"), *((name, "") for name in columns)):
        if name not in stored.names:
            raise fault(f"{file}: has no column {name}; it has {', '.join(stored.names)}{hint}")
        if stored.is_text(name):
            raise fault(f"{file}: column {name}: found texts; allowed: numbers, or an empty field")
        values.append(np.array(stored.numbers(name), dtype=float))
        largest = float(np.nanmax(np.abs(values[-1]), initial=0))
        doubt = name != "t" and _bbsim.unit_doubt(name, largest)
        if doubt:
            notes.append(f"warning: {file}: {name} goes up to {largest!r}, read in SI: it looks like {doubt}")
    if not np.isfinite(values[1:]).any():
        raise fault(f"{file}: found no finite numbers in {', '.join(columns)}")
    return Log(file, values[0], np.array(values[1:]), given)


def _log_key(text: str, columns: Sequence[str], units: Sequence[str]) -> LogKey:
    """log.COLUMN.scale, log.COLUMN.offset or log.delay, with or without bounds."""
    name, equals, bounds = (part.strip() for part in text.partition("="))
    column, _, of = name.removeprefix("log.").rpartition(".")
    if name == "log.delay":
        key = LogKey(name, "s", lower=0.0, upper=math.inf if equals else _USUAL_DELAY)
    elif column in columns and of in ("scale", "offset"):
        place = columns.index(column)
        key = LogKey(name, units[place] if of == "offset" else "", of=of, column=place)
    else:
        allowed = ", ".join(f"log.{name}.scale, log.{name}.offset" for name in columns)
        refuse_free(f"{name}: allowed for a log: log.delay, {allowed}")
    if equals:
        read_bounds(bounds, key)
    key.logarithmic = of == "scale" and key.lower > 0
    key.start = 1.0 if of == "scale" else 0.0
    if of == "delay" or not key.lower <= key.start <= key.upper:
        key.start = (key.lower + key.upper) / 2
    width = key.upper - key.lower
    key.scale = width / 10 if math.isfinite(width) else usual_scale(key.start, "" if of == "scale" else "m")
    return key


def _candidates(task: "_Task") -> List[FreeKey]:
    """Keys of this scenario that are not free."""
    given = task.logs[0].given
    tables = [file.removesuffix(".file") for file, _ in given.tables()]
    tables = [table for table in tables if table.startswith(("gimbal.motion", "controller.commands"))]
    found: List[FreeKey] = []
    for name in [f"{table}.{of}" for table in tables for of in ("offset", "delay", "scale")] + list(_CANDIDATES):
        try:
            found.append(read_free_key(name, given))
        except InputError:
            pass
    delay = _log_key("log.delay", task.columns, task.units)
    delay.start = 0.0
    found += [delay, *(_log_key(f"log.{name}.scale", task.columns, task.units) for name in task.columns)]
    return [key for key in found if key.name not in {free.name for free in task.keys}]


def _ideal(given: _bbsim.Given) -> Optional[_bbsim.Given]:
    """A solid ball that rolls without losses on a perfectly mounted plate, which follows the motion or the commands
    without lag. None for scenarios with feedback or torques."""
    parts, motion = ["controller", "ball.losses", "events", "output"], []
    if given.has("controller.commands"):
        phi, theta = (given.text_at(f"controller.commands.{axis}") or "0" for axis in ("phi", "theta"))
        motion = [("gimbal.motion", f"{{phi: {phi}, theta: {theta}}}")]
    elif not given.has("gimbal.motion"):
        return None
    parts += [f"gimbal.{name}" for name in ("servo", "linkage", "three_servos", "mounting")]
    parts += [] if given.has("ball.groove") else ["ball.inertia_factor"]
    return given.changed(motion + [(part, "null") for part in parts if given.has(part)])


def _closes_a_loop(given: _bbsim.Given) -> bool:
    return given.has("controller") and not given.has("controller.commands")


class _Task:
    """What is asked for, checked, and the logs, read."""

    def __init__(self, given: _bbsim.Given, logs: List[str], free: Any, map: Any, header: Any, period: Any, time_offset: Any,
                 missing: Any, window: Any, hold_out: Any, loss: Optional[str], starts: Any, threads: Any) -> None:  # fmt: skip
        self.given, self.files, self.notes = given, logs, []  # type: ignore[var-annotated]
        self.share, self.starts, self.threads, self.robust = hold_out or 0, starts, threads or 0, loss == "huber"
        self.length = None if window is None else _bbsim.value_in(str(window), "s")
        free = listed("free", free, from_to)
        for option, wrong, found, allowed in (
            ("hold-out", not 0 <= self.share < 1, hold_out, "a share from 0 to below 1, such as 0.3"),
            ("loss", loss not in (None, "squares", "huber"), f"'{loss}'", "squares or huber"),
            ("starts", starts is not None and (starts != int(starts) or starts < 1), starts, "1 or more"),
            ("window", window is not None and not (self.length or 0) > 0, f"'{window}'",
             'a time greater than 0, such as 2 or "500 ms"'),
            ("threads", self.threads < 0, threads, "0, for one per processor, or more"),
            ("free", not free, "nothing", "at least one key"), ("logs", not self.files, "nothing", "at least one"),
        ):  # fmt: skip
            if wrong:
                raise refuse(option, found, allowed)
        refuse_own_controller(given, "a fit", "a law of bbsim, or controller.commands or gimbal.motion from the log's table")
        self.keys: List[FreeKey] = read_free_keys(free, given)
        run = given.changed([("solver.error", "null"), ("solver.rtol", "1e-10"), ("solver.atol", "1e-12")])
        run, self.warnings = self._without_noise(run), list(given.remarks())
        maps, header = listed("map", map), [name for text in listed("header", header) for name in text.split(",")]
        choice = log_choice(maps, header, period, time_offset, missing)
        self.logs: List[Log] = []
        self.columns: List[str] = []
        tables = self._tables_of_logs()
        moved = [given.text_at(f"{key.removesuffix('.file')}.time_offset") for key, _ in given.tables()]
        self.hint = "; --time-offset start moves the log as the tables are" if time_offset is None and "start" in moved else ""
        for file in self.files:
            stored = _bbsim.read_log(file, choice)
            self.warnings += [without_folders(note) for note in stored.notes]
            self.columns = self.columns or _compared(given, maps, stored, self.warnings)
            its = [(key, f"'{os.path.abspath(file)}'") for key in tables if len(self.files) > 1]
            self.logs.append(_log(run.changed(its), stored, self.columns, self.warnings))
        units = {column[0]: column[2] for column in _bbsim.known_columns("rad")}
        self.units: List[str] = [units[name] for name in self.columns]
        self.keys += [_log_key(text, self.columns, self.units) for text in free if text.strip().startswith("log.")]
        refuse_twice([key.name for key in self.keys])

    def _without_noise(self, given: _bbsim.Given) -> _bbsim.Given:
        """Leaves out the noise in a loop, which differs in the log, and the steps that this noise smooths."""
        free = {key.name for key in self.keys}
        parts = [(part, "null") for part in ROUGH if given.has(part) and part not in free]
        if not _closes_a_loop(given):
            return given
        for name in ("gimbal.servo.dead_band", "gimbal.servo.backlash"):
            its = [f"gimbal.servo.{axis}.{name[13:]}" for axis in ("phi", "theta")]
            if not free & {name, *its}:
                parts += [(part, "0") for part in its if given.has(part)]
                parts += [(name, "0")] if given.value(name) else []
        if parts:
            self.notes.append("the fit leaves out noise, rounding, dead band and backlash in the loop, unless they are free")
        return given.changed(parts)

    def _tables_of_logs(self) -> List[str]:
        """If a table of the scenario is one of the logs, each log replaces it in turn."""
        folder = os.path.dirname(self.given.name) if os.path.exists(self.given.name) else ""
        tables = [(key, os.path.join(folder, path)) for key, path in self.given.tables() if key[:5] != "ball."]
        tables = [(key, path) for key, path in tables if os.path.exists(path)]
        files = [file for file in self.files if os.path.exists(file)]
        same = [[key for key, path in tables if os.path.samefile(path, file)] for file in files]
        return next((keys for keys in same if keys), [])

    def cut(self) -> Tuple[Windows, Windows, List[int], float]:
        """The windows to fit and those held out, the coordinates of their starts, and their length."""
        given = self.logs[0].given
        loop = _closes_a_loop(given)
        # Feedback keeps errors small over whole logs and carries on states that no log shows.
        whole = loop and self.length is None and not self.share
        length = math.inf if whole else self.length or _USUAL_WINDOW
        delay = max((key.upper for key in self.keys if key.name == "log.delay"), default=0.0)
        fewest = len(start_coordinates(self.columns, given, not whole))
        windows, held = cut(self.logs, length, self.share, fewest, delay)
        within = len(windows) + len(held) > len({*windows.log, *held.log})
        free = start_coordinates(self.columns, given, within)
        numbers, unknowns = int(np.isfinite(windows.values).sum()), len(windows) * len(free) + len(self.keys)
        if numbers <= unknowns:
            allowed = f"more than the {unknowns} that are sought, starts included"
            raise fault(f"the logs have {numbers} numbers in {len(windows)} windows; allowed: {allowed}; use a longer "
                         "--window or fewer --free keys")  # fmt: skip
        return windows, held, free, length


def _other(search: Search, windows: Windows, u: Array, ideal: bool = False) -> Optional[WindowsFit]:
    """Other windows at u, or those of an ideal rig; None if one does not run."""
    fit, logs = search.windows, search.windows.logs
    if ideal:
        logs = [Log(log.name, log.times, log.values, _ideal(log.given)) for log in logs]
    other = WindowsFit(logs, fit.columns, windows, [] if ideal else fit.keys, fit.free, fit.threads)
    other.reweigh(fit.noise)
    other.residuals(np.empty(0) if ideal else u)
    return other if other.point.runs.all() else None


def _rms(fit: Optional[WindowsFit]) -> Dict[str, float]:
    return {} if fit is None else dict(zip(fit.columns, map(float, fit.sizes()[0])))


def _series(fit: WindowsFit, held: bool) -> List[Any]:
    """Log and model of each window."""
    shown, its = fit.modelled(), fit.windows
    return [SimpleNamespace(log=int(its.log[w]), held=held, times=its.times[w, :rows], measured=its.values[w, :, :rows],
                            modelled=shown[w, :, :rows]) for w, rows in enumerate(its.rows)]  # fmt: skip


def _fit(task: _Task, progress: Progress, series: bool) -> Any:
    """A result without a text."""
    windows, held, free, length = task.cut()
    fit = WindowsFit(task.logs, task.columns, windows, task.keys, free, task.threads)
    search, before = Search(fit, task.robust, progress), None
    fitted = SimpleNamespace(
        logs=[without_folders(file) for file in task.files], units=dict(zip(task.columns, task.units)), window=length,
        windows=len(windows), held=len(held), numbers=fit.size, interrupted=False, suggestion=None,
        ideal_rms={}, hold_out_before_rms={}, hold_out_rms={}, hold_out_ideal_rms={},
    )  # fmt: skip
    try:
        fit.residuals(search.u)
        w = int(np.argmin(fit.point.runs))
        if not fit.point.runs[w]:
            place = f"{task.logs[windows.log[w]].name}: from t = {windows.begin[w]:.6g} s on"
            raise fault(f"{place}, the scenario does not run to the window's end: {fit.point.why[w]}{task.hint}")
        before = _rms(fit)
        search.begin(task.starts)
        search.settle()
        search.compare_delays()
    except KeyboardInterrupt:
        if before is None:
            raise
        fitted.interrupted = True
    fit.residuals(search.u)
    fitted.before_rms, fitted.residual_rms = before, _rms(fit)
    notes = _describe(fitted, search)
    if fit.kinked and fit.jumps and not fitted.white:
        search.doubts.append("the residuals jump, as with a dead band, and are correlated: the fit may be held between two "
                             "jumps, for which no deviation accounts; try starting values nearby, --starts, or a "
                             "longer --window, since windows forget which command a servo followed last")  # fmt: skip
    fitted.series = _series(fit, False) if series else []
    ideal = _ideal(task.logs[0].given)
    if ideal is not None and not any(ideal.lacks(name) for name in task.columns):
        fitted.ideal_rms = _rms(_other(search, windows, search.u, True))
    pairs = [(fitted.residual_rms[name], rms) for name, rms in fitted.ideal_rms.items()]
    if not fitted.exact and sum(math.log(rms / ideal_rms) for rms, ideal_rms in pairs if ideal_rms > 0) > 1e-3:
        search.doubts.append("the fit is worse than an ideal rig: try other starting values, bounds or keys")
    if len(held):
        fitted.hold_out_before_rms = _rms(_other(search, held, np.zeros(len(task.keys))))
        its = _other(search, held, search.u)
        fitted.hold_out_rms, fitted.series = _rms(its), fitted.series + (_series(its, True) if series and its else [])
        fitted.hold_out_ideal_rms = _rms(_other(search, held, search.u, True)) if fitted.ideal_rms else {}
    notes = _estimate(fitted, search) + notes
    if fitted.interrupted:
        notes.append(f"interrupted after {counted(search.iterations, 'iteration')}: these are the best values so far")
    if not fitted.white:
        notes.append(f"neighboring residuals are correlated ({fitted.correlated}); the model is incomplete and the "
                     "intervals are too short")  # fmt: skip
        best = None if fitted.interrupted else search.suggestion(_candidates(task))
        if best is not None:
            fitted.suggestion = {"key": best[0], "residuals_smaller_by": best[1]}
            notes.append(f"--free {best[0]} could make the residuals about {_bbsim.rounded(100 * best[1], 2)} % smaller")
    fitted.warnings = [text.partition(": ")[2] for text in task.warnings]
    fitted.notes = [*fitted.warnings, *task.notes, *search.doubts, *notes]
    return fitted


def _describe(fitted: Any, search: Search) -> List[str]:
    """What the residuals tell: whether they are white; notes on outliers."""
    fit, (rms, usual, counts) = search.windows, search.windows.sizes()
    errors = np.nan_to_num(fit.point.differences).reshape(fit.windows.values.shape)
    weighted = errors * fit.weights.reshape(errors.shape)
    products = (weighted[..., 1:] * weighted[..., :-1]).sum((0, 2)) / np.maximum((weighted**2).sum((0, 2)), 1e-300)
    exact = rms <= 1e-6 * search.spreads
    # Fitting the starts reduces correlation, so white residuals rarely reach this.
    fitted.white = bool(np.all(exact | (products < 3 / np.sqrt(np.maximum(counts, 1)))))
    fitted.exact = bool(exact.all())
    fitted.correlated = ", ".join(f"{name}: {_bbsim.rounded(its, 2)}" for name, its in zip(fit.columns, products))
    far, notes = (np.abs(errors) > 5 * usual[:, None]) & ~exact[:, None], []
    fitted.outliers = dict(zip(fit.columns, map(int, far.sum((0, 2)))))
    for c, (name, count) in enumerate(fitted.outliers.items()):
        if count:
            w, row = (int(places[0]) for places in np.nonzero(far[:, c]))
            words = f"{count} number of {name} is" if count == 1 else f"{count} numbers of {name} are"
            place = f"t = {fit.windows.times[w, row]:.6g} s of {fitted.logs[fit.windows.log[w]]}"
            notes.append(f"{words} beyond 5 standard deviations, the first at {place}"
                         + ("" if search.robust else "; --loss huber gives such numbers less weight"))  # fmt: skip
    return notes


def _estimate(fitted: Any, search: Search) -> List[str]:
    """The parameters, and notes on them."""
    linear, scatter, u = search.linear(), search.scatter(), search.u
    fitted.parameters, fitted.correlations = [], linear.correlations
    for k, key in enumerate(search.keys):
        parameter = SimpleNamespace(key=key.name, unit=key.unit, before=key.start, estimate=float(key.value(u[k])),
                                    sd=math.inf, told=bool(linear.told[k]), interval=[-math.inf, math.inf])  # fmt: skip
        parameter.at_bound = parameter.estimate in (key.lower, key.upper)
        if parameter.told:
            parameter.sd = math.sqrt(linear.covariance[k, k] * scatter) * abs(key.slope(u[k]))
            try:
                parameter.interval = search.interval(k, linear, not fitted.interrupted)
            except KeyboardInterrupt:
                fitted.interrupted = True
                parameter.interval = search.interval(k, linear, False)
        fitted.parameters.append(parameter)
    fitted.identifiable = not linear.untold and not search.doubts
    notes = [f"not identifiable: {words}" for words in linear.untold]
    deaf = search.windows.deaf
    if deaf.any():
        unheard = ", ".join(key.name for key, its in zip(search.keys, deaf.T) if its.any())
        notes.append(f"{deaf.any(1).sum()} of {counted(len(deaf), 'window')} tell nothing of {unheard}: no command passes "
                     "the dead band in them")  # fmt: skip
    notes += [f"{parameter.key} is at a bound of its range" for parameter in fitted.parameters if parameter.at_bound]
    most = np.abs(np.nan_to_num(linear.correlations) * (1 - np.eye(len(u)))).max(0)
    names = [key.name for key, size in zip(search.keys, most) if size > 0.95]
    if names:
        size = _bbsim.rounded(most.max(), 4)
        notes.append(f"{', '.join(names[:-1])} and {names[-1]} are correlated, up to {size}: the logs determine a "
                     "combination of them better than each")  # fmt: skip
    return notes


def fit(scenario: Scenario, logs: Any, free: Any, *, set: Settings = None, map: Any = (), header: Any = (),
        period: Any = None, time_offset: Any = None, missing: Any = None, window: Any = None, hold_out: float = 0,
        loss: str = "squares", starts: Optional[int] = None, output: Any = None, json: Any = None, report: Any = None,
        threads: int = 0) -> Any:  # fmt: skip
    """Finds the values of a scenario's keys at which its runs are closest to logs of a rig. Keywords are the options of
    ``bbsim fit``.

    logs      files, or dicts of arrays or DataFrames with such columns; one or a list
    free      the keys, "KEY" or "KEY=FROM:TO", or a dict {KEY: (FROM, TO)}; also log.x.scale, log.x.offset, log.delay

    The result has the names of the JSON, in SI units, and `report`. An interrupted fit gives the best values so far, or
    raises KeyboardInterrupt if there are none. Raises InputError and OutputError.
    """
    options = dict(locals())
    with as_files(options["logs"]) as options["logs"]:
        return _carry_out(given_of(options.pop("scenario"), options.pop("set")), options, silent, lambda text: None)


def _carry_out(given: _bbsim.Given, options: Dict[str, Any], progress: Progress, say: Any) -> Any:
    reads = dict.fromkeys(options["logs"], "the log")
    if options["report"]:
        reads[_bbsim.file_of_template("fit.html")] = "the template of pages"
    files = files_of(options, given, reads, "report", "output", "json")
    task = _Task(given, **options)
    if files["output"]:  # fails before the work if the text cannot be written
        keys = [key for key in task.keys if not isinstance(key, LogKey)]
        given.edited([(key.name, key.text(key.start)) for key in keys], "")
    if files["report"]:
        _bbsim.filled_page("fit.html", "", "{}")
    for text in task.warnings:
        say(text)
    fitted = _fit(task, progress, bool(files["report"]))
    progress(1, "")
    fitted.report = _fit_text.report(fitted)
    texts = {"json": _fit_text.as_document, "output": _fit_text.scenario, "report": _fit_text.page}
    write_all(given, files, {name: its(fitted, given) for name, its in texts.items() if files[name]}, say)
    return fitted


def command(options: Dict[str, Any], say: Any) -> int:
    options["logs"] = options.pop("log")
    fitted = carry_out("fit", _carry_out, options, say)
    return 130 if fitted is None or fitted.interrupted else 0
