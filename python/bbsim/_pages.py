# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Replay pages, comparisons of results, and the example scenarios."""

from __future__ import annotations

import html
import os
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import Any, Dict, List, Optional, Sequence, Union

from . import _bbsim
from ._errors import refuse
from ._result import Result
from ._scenario import Settings, listed, overrides

File = Union[str, "os.PathLike[str]"]
Texts = Union[str, Sequence[str]]


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


def replay(
    *files: Union[File, Result], output: Optional[File] = None, data: Texts = (), map: Texts = (), header: Texts = (),
    period: str = "", time_offset: str = "", title: str = "", summary: File = "", scenario: File = "", set: Settings = None,
) -> Page:  # fmt: skip
    """A page that plays results of runs or sweeps, or scenarios. The keywords are the options of ``bbsim replay``.

    files     files, or results of ``bbsim.run``
    output    also writes the page to this file, NAME.html
    """
    shown: List[Any] = []
    for file in files:
        if isinstance(file, Result):
            columns = [(name, file.units[name], file[name], []) for name in file.columns]
            shown.append(_bbsim.Stored(columns, file._run.summary))
        else:
            shown.append(os.fspath(file))
    log = _bbsim.LogChoice(listed(map), listed(header), period, time_offset)
    beside = _bbsim.Beside(os.fspath(summary), os.fspath(scenario), overrides(set))
    target = "" if output is None else os.fspath(output)
    if target and not target.lower().endswith(".html"):
        raise refuse("output", target, "a name that ends in .html")
    made = _bbsim.replay(shown, listed(data), log, beside, title, target)
    if target:
        _bbsim.write_file(target, made[0].encode())
    return Page(*made)


def compare(
    a: File, b: File, *, rtol: Optional[float] = None, atol: Optional[float] = None, columns: Texts = (),
    map: Texts = (), header: Texts = (), period: str = "", time_offset: str = "", set: Settings = None,
) -> Compared:  # fmt: skip
    """Compares two files of results, or a log with a run or a scenario. The keywords are the options of ``bbsim compare``."""
    log = _bbsim.LogChoice(listed(map), listed(header), period, time_offset)
    for name, found in (("rtol", rtol), ("atol", atol)):
        if not (found is None or isinstance(found, Real)):
            raise refuse(name, repr(found), "a number, in SI units")
    made = _bbsim.compare(os.fspath(a), os.fspath(b), overrides(set), rtol, atol, listed(columns), log)
    return Compared(made.alike, made.text, made.reason, made.warnings)


def examples() -> Dict[str, Path]:
    """The scenarios that come with bbsim: their files, by name."""
    return {file.stem: file for file in sorted((Path(__file__).parent / "examples").glob("*.yaml"))}
