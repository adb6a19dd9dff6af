# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""What users hand in: scenarios (a path, YAML text or a dict), settings, and logs (files, or tables in memory); and the
exceptions of bbsim."""

from __future__ import annotations

import contextlib
import csv
import io
import json
import os
import re
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterable, Iterator, List, Mapping, Optional, Tuple, Union

import numpy as np

from . import _bbsim

Array = np.ndarray  # of numbers
Scenario = Union[str, "os.PathLike[str]", Mapping[str, Any]]
Settings = Optional[Mapping[str, Any]]
# A file, or a table in memory: a dict of arrays, a pandas DataFrame, or anything else with `columns`, each by its name.
Log = Union[str, "os.PathLike[str]", Mapping[str, Any], Any]

_PREFIX = "bbsim-logs-"
_CALLABLE = "<dict with a callable>"  # the name of such a scenario
_OPTION = re.compile("--[a-z][-a-z]+|^([a-z]+-[-a-z]+|FILES)(?=: )")
_GAPS = ("nan", "None", "NaT", "<NA>")  # pandas has several


class Error(Exception):
    """Any error of bbsim."""


@dataclass(frozen=True)
class Problem:
    """One fault of a scenario or an argument."""

    message: str  # the key, what was found, and what is allowed
    place: str = ""  # file:line:column, or the setting; empty for a dict
    key: Optional[str] = None  # its path, such as ball.radius
    hint: str = ""  # what to write instead

    def __str__(self) -> str:
        return f"{self.place}: {self.message}" if self.place else self.message


class InputError(Error, ValueError):
    """The scenario or an argument is wrong: ``problems``, in order, and ``key`` and ``hint`` of the first."""

    def __init__(self, problems: Iterable[Tuple[str, str]]) -> None:
        # For a command line, whose options are keywords here.
        self.told = [(without_folders(place), without_folders(message)) for place, message in problems]
        self.problems: List[Problem] = []
        for place, message in self.told:
            if place.startswith(_CALLABLE):
                message = message.replace("controller.library", "controller.callable")
            message = _OPTION.sub(lambda m: m[0].lstrip("-").replace("-", "_").lower(), message.removeprefix("--set "))
            key, hint = _bbsim.key_and_hint(message)
            its_place = "" if place.startswith("<dict") else place.removeprefix("--set ")
            self.problems.append(Problem(message, its_place, key or None, hint))
        super().__init__("\n".join(str(problem) for problem in self.problems))
        self.key, self.hint = next(((each.key, each.hint) for each in self.problems), (None, ""))

    def __reduce__(self):
        return type(self), (self.told,)


def fault(text: str) -> InputError:
    return InputError([("", text)])


def refuse(what: str, found: object, allowed: str) -> InputError:
    return fault(f"{what}: found {found}; allowed: {allowed}")


class OutputError(Error, OSError):
    """A file could not be written."""


class ControllerError(Error, RuntimeError):
    """The scenario's controller failed; its exception is the cause (``__cause__``)."""


class Columns:
    """Arrays by name; ``columns``: the names, in order."""

    def __init__(self, arrays: Mapping[str, Array]) -> None:
        self._arrays, self.columns = arrays, list(arrays)

    def __getitem__(self, column: str) -> Array:
        try:
            return self._arrays[column]
        except KeyError:
            raise KeyError(f"there is no column {column!r}; there are {', '.join(self.columns)}") from None

    def __contains__(self, column: object) -> bool:
        return column in self._arrays

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def keys(self) -> List[str]:
        return self.columns


def require(what: str, found: Any, kind: Any, allowed: str) -> Any:
    """The argument `what`, if it is of this kind."""
    if not isinstance(found, kind):
        raise TypeError(f"{what}: found {' '.join(repr(found).split()):.60}; allowed: {allowed}")
    return found


def numbers(what: str, values: Any, *shapes: Tuple[Any, ...]) -> Array:
    """An array of numbers of one of these shapes, in which a text is any length."""
    try:
        array = np.asarray(values, np.float64, order="C")
    except (TypeError, ValueError):
        raise refuse(what, f"{values!r:.60}", "an array of numbers") from None
    for shape in shapes:
        if len(shape) == array.ndim and all(isinstance(n, str) or n == m for n, m in zip(shape, array.shape)):
            return array
    raise refuse(what, f"an array of shape {array.shape}", " or ".join(map(str, shapes)).replace("'", ""))


def whole(text: str) -> str:
    try:
        text.encode()
    except UnicodeEncodeError as error:
        found = text[error.start : error.end]
        raise fault(f"found {found!r}, a part of a character; allowed: Unicode text") from None
    return text


def _plain(value: Any) -> Any:
    """The value as a kind that JSON knows."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Iterable):
        return dict(value) if isinstance(value, Mapping) else list(value)
    kinds = "numbers, texts, lists, dicts, numpy arrays and None"
    raise TypeError(f"found {value!r} of type {type(value).__name__}; allowed: {kinds}")


def as_yaml(value: Any) -> str:
    """The value as written after ``KEY=``: texts unchanged, everything else in YAML's flow style, such as JSON."""
    return whole(value if isinstance(value, str) else json.dumps(value, ensure_ascii=False, default=_plain))


def _without_callable(scenario: Mapping[str, Any]) -> Tuple[Mapping[str, Any], Optional[Callable[..., Any]]]:
    """The dict with a library in place of its callable, which YAML cannot hold; and the callable."""
    controller = scenario.get("controller")
    if not isinstance(controller, Mapping) or "callable" not in controller:
        return scenario, None
    function = controller["callable"]
    if not callable(function):
        raise fault(f"controller.callable: found {function!r}; allowed: a callable")
    rest = {key: value for key, value in controller.items() if key != "callable"}
    if "library" in rest:
        raise fault("controller.library: found beside callable; allowed: one law")
    name = getattr(function, "__qualname__", type(function).__qualname__)
    return {**scenario, "controller": {"library": {"file": f"Python: {name}"}, **rest}}, function


def overrides(settings: Union[Settings, List[str]]) -> List[str]:
    """KEY=VALUE, as ``--set`` takes them; a list of a command line has them."""
    if isinstance(settings, list):
        return listed("set", settings)
    values = require("set", {} if settings is None else settings, Mapping, "a dict such as {'ball.radius': '2 cm'}")
    return [f"{key}={as_yaml(value)}" for key, value in values.items()]


def counted(count: int, what: str) -> str:
    return f"{count} {what}" + ("" if count == 1 else "s")


def listed(what: str, texts: Any, written: Callable[[Any], str] = as_yaml) -> List[str]:
    """Texts of an option: one text or path, or several. A dict has what follows KEY=, or None for the key alone."""
    if isinstance(texts, Mapping):
        return [str(key) if value is None else f"{key}={written(value)}" for key, value in texts.items()]
    several = [] if texts is None else [texts] if isinstance(texts, (str, os.PathLike)) else texts
    allowed = "a text, or a list of texts"
    return [os.fspath(require(what, one, (str, os.PathLike), allowed)) for one in require(what, several, Iterable, allowed)]


def is_text(scenario: Any) -> bool:
    """Whether it is YAML text, not a path."""
    return isinstance(scenario, str) and ("\n" in scenario or scenario.lstrip().startswith("{"))


def given(scenario: Any, settings: Union[Settings, List[str]] = None, error: Any = None) -> _bbsim.Given:
    """The scenario with settings. One that is already given stays as it is, and simulate() reads it only once."""
    if isinstance(scenario, _bbsim.Given):
        return scenario
    texts = overrides(settings)
    if error is not None:
        texts.append(f"solver.error={as_yaml(error)}")
    if isinstance(scenario, Mapping):
        plain, function = _without_callable(scenario)
        return _bbsim.Given(_CALLABLE if function else "<dict>", as_yaml(plain), texts, function)
    name = os.fspath(require("scenario", scenario, (str, os.PathLike), "a path, YAML text or a dict"))
    return _bbsim.Given("<text>", whole(name), texts, None) if is_text(scenario) else _bbsim.Given(name, None, texts, None)


def _each(values: Any) -> List[Any]:
    """The values of an array or another sequence, or a single one."""
    values = _plain(values) if isinstance(values, np.ndarray) else values
    return [values] if isinstance(values, (str, Mapping)) or not isinstance(values, Iterable) else list(values)


def from_to(values: Any) -> str:
    """FROM:TO, or a text that has it."""
    return ":".join(map(as_yaml, _each(values)))


def specification(values: Any) -> str:
    """A key's values over a sweep, as ``bbsim sweep --vary KEY=`` takes them."""

    def listed_value(value: Any) -> str:
        text = as_yaml(value)
        splits = "," in text and text[0] not in "[{\"'"
        return "'" + text.replace("'", "''") + "'" if splits else text

    return values if isinstance(values, str) else "list:" + ",".join(map(listed_value, _each(values)))


# Logs

def log_choice(map: Any, header: Any, period: Any, time_offset: Any, missing: Any) -> _bbsim.LogChoice:
    """How to read a log; None and "" leave an option out."""
    gone = "" if missing is None else str(missing)
    texts = listed("map", map), listed("header", header)
    return _bbsim.LogChoice(*texts, str(period or ""), str(time_offset or ""), gone)


def is_table(log: Any) -> bool:
    return isinstance(log, Mapping) or (hasattr(log, "columns") and hasattr(log, "__getitem__"))


@contextlib.contextmanager
def as_files(logs: Any) -> Iterator[List[str]]:
    """The files of one log or several. Tables in memory become temporary files, for the one reader of logs."""
    logs = [logs] if is_table(logs) or isinstance(logs, (str, os.PathLike)) else list(logs)
    for log in logs:
        if is_text(log) or (isinstance(log, Mapping) and any(isinstance(its, Mapping) for its in log.values())):
            raise fault("found a scenario; allowed: a file, a table or a result, such as bbsim.run(scenario)")
    folder: Any = tempfile.TemporaryDirectory(prefix=_PREFIX) if any(map(is_table, logs)) else contextlib.nullcontext()
    with folder as path:
        files = [f"{path}/log-{i}.csv" if is_table(log) else os.fspath(log) for i, log in enumerate(logs, 1)]
        for log, file in zip(logs, files):
            if is_table(log):
                _write(log, file)
        yield files


def without_folders(text: str) -> str:
    """The text without the folders of temporary files, which differ each time. The first one sets tempfile.tempdir."""
    return re.sub(f"{re.escape(tempfile.tempdir)}/{_PREFIX}[^/]+/", "", text) if tempfile.tempdir else text


def _write(table: Any, file: str) -> None:
    names = list(getattr(table, "columns", table))
    columns = [_fields(str(name), table[name]) for name in names]
    for name, fields in zip(names, columns):
        if len(fields) != len(columns[0]):
            raise refuse(f"a log's column {name}", f"{len(fields)} values", f"{len(columns[0])}, as in {names[0]}")
    text = io.StringIO()
    csv.writer(text).writerows([names, *zip(*columns)])
    Path(file).write_bytes(whole(text.getvalue()).encode())


def _fields(name: str, values: Any) -> List[str]:
    """Numbers with all their digits; a gap is empty."""
    try:
        array = np.asarray(values)
        found = f"an array of shape {array.shape}"
    except ValueError:
        array, found = np.empty(()), "rows of different lengths"
    if array.ndim != 1:
        raise refuse(f"a log's column {name}", found, "one value for each row")
    if array.dtype.kind == "M":
        array = np.datetime_as_string(array, "us")
    elif array.dtype.kind == "m":
        array = array / np.timedelta64(1, "s")
    elif array.dtype.kind == "b":
        array = array.astype(int)
    return ["" if text in _GAPS else text for text in map(str, array.tolist())]
