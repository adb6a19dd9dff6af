# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Logs: how they are read, and tables in memory as files."""

from __future__ import annotations

import contextlib
import csv
import io
import os
import re
import tempfile
from pathlib import Path
from typing import Any, Iterator, List, Mapping, Union

import numpy as np

from . import _bbsim
from ._scenario import InputError, listed, refuse, whole

# A file, or a table in memory: a dict of arrays, a pandas DataFrame, or anything else with `columns`, each by its name.
Log = Union[str, "os.PathLike[str]", Mapping[str, Any], Any]

_PREFIX = "bbsim-logs-"
_GAPS = ("nan", "None", "NaT", "<NA>")  # pandas has several


def log_choice(map: Any, header: Any, period: Any, time_offset: Any, missing: Any) -> _bbsim.LogChoice:
    """How to read a log; None and "" leave an option out."""
    gone = "" if missing is None else str(missing)
    return _bbsim.LogChoice(listed(map), listed(header), str(period or ""), str(time_offset or ""), gone)


def is_table(log: Any) -> bool:
    return isinstance(log, Mapping) or (hasattr(log, "columns") and hasattr(log, "__getitem__"))


@contextlib.contextmanager
def as_files(logs: Any) -> Iterator[List[str]]:
    """The files of one log or several. Tables in memory become temporary files, for the one reader of logs."""
    logs = [logs] if is_table(logs) else listed(logs)
    if not any(map(is_table, logs)):
        yield [os.fspath(log) for log in logs]
        return
    with tempfile.TemporaryDirectory(prefix=_PREFIX) as folder, tables_named():
        files = [f"{folder}/log-{i}.csv" if is_table(log) else os.fspath(log) for i, log in enumerate(logs, 1)]
        for log, file in zip(logs, files):
            if is_table(log):
                _write(log, file)
        yield files


@contextlib.contextmanager
def tables_named() -> Iterator[None]:
    """Within it, errors name tables in memory without the folders of their files."""
    try:
        yield
    except InputError as error:
        texts = [(without_folders(its.place), without_folders(its.message)) for its in error.problems]
        raise InputError(texts) from None


def without_folders(text: str) -> str:
    """The text without the folders of temporary files, which differ each time."""
    return re.sub(f"{re.escape(tempfile.gettempdir())}/{_PREFIX}[^/]+/", "", text)


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
