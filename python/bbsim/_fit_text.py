# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""What a fit tells: a report, JSON, the fitted scenario and a page."""

from __future__ import annotations

import base64
import hashlib
import json
import math
from pathlib import Path
from typing import Any, Dict, List, Sequence

import numpy as np

from . import _bbsim
from ._scenario import Array, counted
from ._task import as_json

_MOST_ROWS = 40000  # of a page


def number(value: float, sd: float = 0.0) -> str:
    """With as many digits as the standard deviation justifies."""
    if not math.isfinite(sd) or sd <= 0 or value == 0 or not math.isfinite(value):
        return _bbsim.short_number(value)
    digits = math.ceil(math.log10(abs(value) / sd)) + 2
    return _bbsim.rounded(value, min(max(digits, 2), 12))


def _parameters(fitted: Any) -> List[List[str]]:
    lines = [["key", "before", "estimate", "sd", "95 % from", "to", "unit"]]
    for found in fitted.parameters:
        known = [f"{found.sd:.3g}", *(number(end, found.sd) for end in found.interval)] if found.told else ["-"] * 3
        lines.append([found.key, number(found.before), number(found.estimate, found.sd), *known, found.unit or "1"])
    return lines


def _residuals(fitted: Any) -> List[List[str]]:
    """A column for each model, of the fit's windows and of those held out."""
    held, ideal = fitted.held > 0, bool(fitted.ideal_rms or fitted.hold_out_ideal_rms)
    tables: List[Dict[str, float]] = [fitted.ideal_rms] * ideal + [fitted.before_rms, fitted.residual_rms]
    head = ["ideal rig"] * ideal + ["before", "fitted"]
    if held:
        tables += [fitted.hold_out_ideal_rms] * ideal + [fitted.hold_out_before_rms, fitted.hold_out_rms]
        head += ["held out: ideal rig", "before", "fitted"] if ideal else ["held out: before", "fitted"]
    rows = [[name, *(f"{table[name]:.3g}" if name in table else "-" for table in tables), unit or "1"]
            for name, unit in fitted.units.items()]  # fmt: skip
    return [["rms residual", *head, "unit"], *rows]


def _remarks(fitted: Any) -> List[str]:
    text = f"{fitted.numbers} numbers in {counted(fitted.windows, 'window')}"
    text += f" of {number(fitted.window)} s" if math.isfinite(fitted.window) else ""
    text += f", {fitted.held} more held out" if fitted.held else ""
    lines = [f"{text}; {counted(len(fitted.logs), 'log')}"]
    notes = fitted.notes[len(fitted.warnings) :]
    return lines + [note if note.startswith("not identifiable: ") else f"note: {note}" for note in notes]


def report(fitted: Any) -> str:
    return "\n".join([*map(_bbsim.aligned, (_parameters(fitted), _residuals(fitted))), *_remarks(fitted), ""])


def as_document(fitted: Any, _: Any) -> str:
    keys = ("key", "estimate", "sd", "interval", "at_bound")
    names = ("residual_rms", "hold_out_rms", "ideal_rms", "hold_out_ideal_rms", "identifiable", "correlations", "white",
             "suggestion", "outliers", "notes", "interrupted")  # fmt: skip
    optional = ("ideal_rms", "hold_out_ideal_rms", "suggestion", "interrupted")
    made: Dict[str, Any] = {"parameters": [{key: getattr(one, key) for key in keys} for one in fitted.parameters]}
    made.update((name, getattr(fitted, name)) for name in names if name not in optional or getattr(fitted, name))
    return as_json({**made, "correlations": fitted.correlations.tolist()})


def scenario(fitted: Any, given: _bbsim.Given) -> str:
    text = f"# Fitted by bbsim {_bbsim.__version__} to\n"
    for log in fitted.logs:
        # Standard input has been read.
        content = Path(log).read_bytes() if Path(log).is_file() else None
        text += f"#   {log}" + (f" (SHA-256 {hashlib.sha256(content).hexdigest()[:16]})" if content else "") + "\n"
    settings = []
    for parameter in fitted.parameters:
        unit = f" {parameter.unit}" if parameter.unit else ""
        ends = [number(end, parameter.sd) for end in parameter.interval]
        known = f", 95 % from {ends[0]} to {ends[1]}{unit}; was {number(parameter.before)}{unit}"
        text += f"# {parameter.key}: {number(parameter.estimate, parameter.sd)}{unit}"
        text += (known if parameter.told else ", which the logs do not determine") + "\n"
        if not parameter.key.startswith("log."):  # no scenario has those
            settings.append((parameter.key, f"{parameter.estimate!r}{unit}"))
    return given.edited(settings, text)


def _encoded(values: Any, kind: str) -> str:
    return base64.b64encode(np.asarray(values, kind).tobytes()).decode()


def _run(fitted: Any, log: str, windows: Sequence[Any], step: int) -> Dict[str, Any]:
    """The series of a log. Rows without numbers separate the lines of two windows."""
    times: List[Array] = []
    rows: List[Array] = []  # 3 x columns x rows: log, model and difference
    parts, first = [], 0
    for window in windows:
        count = len(window.times)
        kept = np.flatnonzero((np.arange(count) % step == 0) | (np.arange(count) == count - 1))
        if times:
            times.append((times[-1][-1:] + window.times[:1]) / 2)
            rows.append(np.full((3, len(fitted.units), 1), np.nan))
            first += 1
        times.append(window.times[kept])
        both = np.stack([window.measured, window.modelled, window.modelled - window.measured])
        rows.append(both[:, :, kept])
        parts.append({"first": first, "last": first + len(kept) - 1, "held": window.held})
        first += len(kept)
    data = np.concatenate(rows, 2)
    kinds = (("", "as logged"), ("_modelled", "of the model"), ("_residual", "model minus log"))
    columns = [{"name": name + ending, "unit": unit, "meaning": meaning, "data": _encoded(data[kind, c], "<f4")}
               for c, (name, unit) in enumerate(fitted.units.items())
               for kind, (ending, meaning) in enumerate(kinds)]  # fmt: skip
    return {"name": log, "rows": sum(len(one.times) for one in windows), "every": step, "windows": parts,
            "time": _encoded(np.concatenate(times), "<f8"), "columns": columns, "orientation": "", "reference": "",
            "reached": None, "unitsKnown": True, "events": []}  # fmt: skip


def page(fitted: Any, given: _bbsim.Given) -> str:
    title = given.text_at("title")
    title = "Fit of " + (title[1:-1].replace("''", "'") if title.startswith("'") else title or given.name)
    names = list(fitted.units)
    pairs = [pair for pair in (["x", "y"], ["x_measured", "y_measured"]) if set(pair) <= set(names)]
    symbols = {column[0]: column[1] for column in _bbsim.known_columns("rad")}
    radius = {one.key: one.estimate for one in fitted.parameters}.get("ball.radius", given.value("ball.radius"))
    rows = sum(len(one.times) for one in fitted.series)
    step = max(1, -(-rows // _MOST_ROWS))
    of_logs = [[one for one in fitted.series if one.log == number] for number in range(len(fitted.logs))]
    runs = [_run(fitted, log, sorted(windows, key=lambda one: one.times[0]), step)
            for log, windows in zip(fitted.logs, of_logs) if windows]  # fmt: skip
    tables = {name: {"head": lines[0], "rows": lines[1:]}
              for name, lines in (("parameters", _parameters(fitted)), ("residuals", _residuals(fitted)))}  # fmt: skip
    columns = [{"name": name, "symbol": symbols.get(name, name), "meaning": "", "unit": unit}
               for name, unit in fitted.units.items()]  # fmt: skip
    data = {"format": 1, "version": _bbsim.__version__, "title": title, "scenario": given.name,
            "logs": fitted.logs, **tables, "remarks": _remarks(fitted),
            "place": pairs[0] if pairs else None, "radius": radius, "columns": columns, "runs": runs}  # fmt: skip
    return _bbsim.filled_page("fit.html", title, json.dumps(data, ensure_ascii=False))
