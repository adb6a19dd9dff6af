# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a scenario's loop: what `bbsim plot --bode` and its like draw, with its numbers as CSV."""

from __future__ import annotations

from typing import Any, Dict, Optional, Tuple

from . import _loop_pictures, _loops
from ._errors import InputError
from ._plot_sheet import Figure
from ._scenario import Scenario, Settings

KINDS = ("bode", "nyquist", "poles", "step", "root_locus")
_VALUES = 200  # of the key of a root locus


def _csv(columns: _loops.Columns) -> str:
    rows = zip(*(map(repr, column.tolist()) for column in columns.values()))
    return "\n".join([",".join(columns), *(",".join(row) for row in rows), ""])


def _locus(text: str) -> Tuple[str, str, str]:
    key, _, between = text.partition("=")
    low, _, high = between.partition(":")
    if not (key and low and high):
        raise InputError([("", f"root-locus: found {text}; allowed: KEY=FROM:TO, such as controller.pd.kv.0.0=0.2:2")])
    return key, low, high


def draw_loop(
    kind: str, scenario: Scenario, set: Settings, locus: str, wide: Optional[float]
) -> Tuple[str, Figure, str]:
    """The numbers as CSV, the figure, and what is in it. Raises InputError for a scenario without a loop."""
    width: Dict[str, Any] = {"width": wide} if wide else {}
    if kind == "root_locus":
        key, low, high = _locus(locus)
        values = _loops.values_between(scenario, key, low, high, _VALUES, set)
        columns = _loops.root_locus(scenario, key, list(values), set)
        figure = _loop_pictures.root_locus(columns, _loops.linearized(scenario, set).dt, key, **width)
        return _csv(columns), figure, f"the poles at {_VALUES} values of {key}"
    columns = getattr(_loops, kind)(scenario, set)
    if kind == "poles":
        figure = _loop_pictures.poles(columns, _loops.linearized(scenario, set).dt, **width)
        return _csv(columns), figure, f"{len(columns['real'])} poles"
    if kind == "bode":
        figure = _loop_pictures.bode(columns, _loops.margins(scenario, set), **width)
    else:
        figure = getattr(_loop_pictures, kind)(columns, **width)
    rows = len(next(iter(columns.values())))
    return _csv(columns), figure, f"{rows} {'times' if kind == 'step' else 'frequencies'}"
