# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of runs, sweeps and logs: bbsim.plot and `bbsim plot`."""

from __future__ import annotations

import io
import os
import sys
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _bbsim
from ._loops import KINDS, draw_accuracy, draw_loop
from ._plot_runs import draw_runs
from ._plot_sheet import FONT, Figure, require_font, style
from ._plot_sweeps import draw_sweep
from ._result import File, Result, Texts
from ._scenario import (InputError, Log, Settings, as_files, counted, fault, from_to, given, is_table, listed,
                        log_choice, overrides, refuse, without_folders)  # fmt: skip

Drawn = Union[Log, Result, "np.ndarray[Any, np.dtype[np.void]]"]

_MARK = "drawn by bbsim plot"  # identifies pictures of bbsim
_OF_SCENARIO = ("accuracy", *KINDS)


def _parts(what: str, texts: Any, separator: str) -> List[str]:
    several = [texts] if isinstance(texts, str) else [",".join(listed(what, text)) for text in texts or ()]
    return [part.strip() for text in several for part in text.split(separator)]


def _millimeters(width: Union[float, str, None]) -> Optional[float]:
    """A length in mm: meters as a number, or a text such as "88 mm"."""
    if width is None:
        return None
    size = 1000 * (_bbsim.value_in(str(width), "m") or 0.0)
    if not 50 <= size <= 600:
        raise refuse("width", width, 'a length from 50 mm to 600 mm, such as "88 mm"')
    return size


def _in_memory(drawn: Any) -> _bbsim.Stored:
    if isinstance(drawn, Result):
        return drawn._stored()
    if not isinstance(drawn, np.ndarray) or not drawn.dtype.names:
        allowed = "allowed: files, results of bbsim.run, arrays of bbsim.sweep, dicts of arrays"
        raise TypeError(f"found {type(drawn).__name__}; {allowed}")
    columns = []
    for name in drawn.dtype.names:
        is_text = drawn[name].dtype.kind == "U"
        numbers = np.full(len(drawn), np.nan) if is_text else drawn[name].astype(float)
        columns.append((name, "", numbers, list(map(str, drawn[name])) if is_text else []))
    return _bbsim.Stored(columns, "")


class _Options:
    """What all pictures of one call share."""

    def __init__(self, options: Dict[str, Any]) -> None:
        self.columns, self.over = _parts("columns", options["columns"], ";"), _parts("over", options["over"], ",")
        self.width, self.font = _millimeters(options["width"]), options["font"] or FONT
        asked = [name for name in _OF_SCENARIO if options[name]]
        if len(asked) > 1:
            both = " and --".join(asked).replace("_", "-")
            raise fault(f"found --{both}; allowed: one picture of a scenario at a time")
        self.kind = asked[0] if asked else ""  # of the picture, if a scenario is drawn
        locus, self.csv = options["root_locus"], options["csv"]
        locus = {locus[0]: locus[1:]} if locus and isinstance(locus, (list, tuple)) else locus
        self.locus = ",".join(listed("root_locus", locus, from_to))
        self.scenario, self.summary = (os.fspath(options[name] or "") for name in ("scenario", "summary"))
        self.set, header = options["set"], _parts("header", options["header"], ",")
        self.log = log_choice(options["map"], header, options["period"], options["time_offset"], options["missing"])
        require_font(self.font)
        if self.csv and not self.kind:
            names = ", --".join(_OF_SCENARIO).replace("_", "-")
            raise fault(f"csv: allowed with the pictures of a scenario, --{names}")
        if self.set and not self.scenario and not self.kind:
            raise fault("set: allowed with --scenario, in which it sets a key")

    def read(self, files: Sequence[Any], say: Any) -> List[_bbsim.Stored]:
        results, beside = [], _bbsim.Beside(self.summary, self.scenario, overrides(self.set))
        for file in files:
            if isinstance(file, Result) or not (isinstance(file, (str, os.PathLike)) or is_table(file)):
                results.append(_in_memory(file))
                continue
            with as_files(file) as (name,):
                results.append(_bbsim.read_result(name, beside, self.log))
            for note in results[-1].notes:
                say(without_folders(note))
        return results

    def draw(self, results: Sequence[_bbsim.Stored]) -> Tuple[Figure, str]:
        """The figure, and what is in it."""
        with style(self.font):
            if not any(result.is_sweep for result in results):
                if self.over:
                    raise fault(f"over: {results[0].file or 'the result'} is not a sweep; bbsim draws a run over time")
                asked = [[name.strip() for name in panel.split(",")] for panel in self.columns]
                figure, panels = draw_runs(results, asked, self.width)
                rows, what = sum(result.rows - result.has_end_row for result in results), "rows"
            else:
                if len(results) > 1:
                    raise fault("overlay: found a sweep; allowed: runs, since a sweep has its own picture")
                figure, panels = draw_sweep(results[0], _parts("columns", self.columns, ","), self.over, self.width)
                rows, what = results[0].rows, "cases"
        return figure, f"{rows} {what}, {counted(panels, 'panel')}"

    def draw_scenario(self, scenario: Any, output: Any) -> Tuple[Figure, str]:
        figure: Any
        outputs = _bbsim.Outputs()
        rig = given(scenario, self.set).changed([])  # reads standard input once
        outputs.reads_scenario(rig)
        for file, name in ((self.csv, "csv"), (output, "output")):
            if file:
                outputs.writes(os.fspath(file), name)
        with style(self.font):
            if self.kind != "accuracy":
                text, figure, content = draw_loop(self.kind, rig, self.locus, self.width)
            else:
                title, text = _bbsim.accuracy(rig, "1e-3:1e-13")
                ends = ",done\n" in text or ",stopped\n" in text
                figure, points = draw_accuracy(text, title, self.width) if ends else (None, 0)
                content = f"{points} points"
        if self.csv:
            _bbsim.write_file(os.fspath(self.csv), text)
        if figure is None:
            raise fault("no method reached the end of the scenario; `bbsim run` says why")
        return figure, content


def plot(files: Union[Drawn, Sequence[Drawn]], *, columns: Texts = (), over: Texts = (), summary: Optional[File] = None,
         scenario: Optional[File] = None, set: Settings = None, map: Texts = (),
         header: Texts = (), period: Optional[str] = None, time_offset: Optional[str] = None,
         missing: Union[float, str, None] = None, accuracy: bool = False, bode: bool = False, nyquist: bool = False,
         poles: bool = False, step: bool = False, root_locus: Union[str, Sequence[Any], Mapping[str, Any], None] = None,
         csv: Optional[File] = None, width: Union[float, str, None] = None, font: Optional[str] = None,
         output: Optional[File] = None, format: Optional[str] = None) -> Figure:  # fmt: skip
    """Draws runs, a sweep or a log; returns a matplotlib figure. The keywords are the options of ``bbsim plot``.

    files    CSV or HDF5 files, results of ``bbsim.run``, an array of ``bbsim.sweep``, or logs as dicts of arrays or
             DataFrames; several runs are compared in one figure. With ``accuracy``, ``bode``, ``nyquist``, ``poles``,
             ``step`` or ``root_locus="KEY=FROM:TO"`` or ``(KEY, FROM, TO)``: a scenario
    columns  the panels, ``["path", "x,x_reference"]`` or ``["path", ["x", "x_reference"]]``; of a sweep, measures
    width    0.088 (m) or "88 mm"
    """
    options = _Options(dict(locals()))
    chosen = _format(None if output is None else os.fspath(output), format)
    all_files = files if isinstance(files, (list, tuple)) else [files]
    if options.kind:
        figure, _ = options.draw_scenario(files, output)
    elif not all_files:
        raise refuse("files", "none", "a file, a result, or a list of them")
    else:
        figure, _ = options.draw(options.read(all_files, lambda note: None))
    if output is not None:
        _save(figure, os.fspath(output), chosen)
    return figure


def _format(output: Optional[str], asked: Optional[str]) -> str:
    name = asked or ("svg" if output in (None, "-") else Path(str(output)).suffix[1:].lower())
    if name in ("svg", "png", "pdf"):
        return name
    if asked:
        raise refuse("format", asked, "svg, png and pdf")
    raise refuse("output", output, "a name that ends in .svg, .png or .pdf")


def _save(figure: Figure, output: str, format: str) -> None:
    """Writes a file that appears whole, with the same bytes each time, and with a mark of bbsim's."""
    drawn = io.BytesIO()
    metadata, end = {"svg": ({"Date": None}, f"<!-- {_MARK} -->\n"), "pdf": ({"CreationDate": None}, f"% {_MARK}\n"),
                     "png": ({"Comment": _MARK}, "")}[format]  # fmt: skip
    figure.savefig(drawn, format=format, metadata=metadata)
    _bbsim.write_file(output, drawn.getvalue() + end.encode())


def _tasks(files: List[str], kind: str, options: Dict[str, Any], ending: str) -> List[Tuple[List[str], str, str]]:
    """The files of each picture, its name, and what names it in messages."""
    output, kind, several = options["output"], kind.replace("_", "-"), len(files) > 1
    if several and kind:
        raise refuse(kind, "several files", "one scenario")
    together = kind or "overlay" * (several and options["overlay"])
    if several and not together and output:
        raise refuse("output", f"{output} for several files", "with --overlay, which draws them in one picture")
    if output:
        return [(files, str(output), "-o")]
    tasks = []
    for group in [files] if together else [[file] for file in files]:
        if group[0] == "-":
            raise fault("output: missing; standard input (-) gives the picture no name")
        name = Path(Path(group[0]).name if kind else group[0]).with_suffix("")
        ends = f"-{together}.{ending}" if together else f".{ending}"
        tasks.append((group, f"{name}{ends}", f"the picture of {group[0]}, without -o"))
    return tasks


def _declare(tasks: Sequence[Tuple[List[str], str, str]], options: Dict[str, Any]) -> None:
    """Call it before any of the files is opened."""
    outputs = _bbsim.Outputs()
    for file in [file for files, _, _ in tasks for file in files]:
        outputs.reads(file, "what is drawn")
        summary = _bbsim.summary_beside(file)
        if summary:
            outputs.reads(summary, f"the summary of {file}")
    for name, does in (("summary", outputs.reads), ("scenario", outputs.reads), ("csv", outputs.writes)):
        if options[name]:
            does(options[name], f"--{name}")
    for _, output, what in tasks:
        outputs.writes(output, what)


def command(options: Dict[str, Any], say: Any) -> None:
    _bbsim.end_at_signals()
    files, format, shared = options["files"], _format(options["output"], options["format"]), _Options(options)
    tasks = _tasks(files, shared.kind, options, format)
    if len(files) > 1 and options["summary"]:
        raise refuse("summary", "several files", "one run, to which the summary belongs")
    _declare(tasks, options)
    # Draw what can be drawn, even if other files have faults.
    problems: List[Tuple[str, str]] = []
    for group, output, what in tasks:
        try:
            if "-" in group and not shared.kind and sys.stdin.isatty():
                say("reading a CSV from the terminal; Ctrl-D ends it, Ctrl-C ends bbsim")
            results = [] if shared.kind else shared.read(group, say)
            outputs = _bbsim.Outputs()
            for result in results:
                outputs.reads_with(result)
            outputs.writes(output, what)
            if not options["output"] and not options["force"]:
                _bbsim.require_mark(output, "a picture of bbsim's", _MARK)
            figure, content = shared.draw(results) if results else shared.draw_scenario(group[0], output)
            _save(figure, output, format)
            if output != "-":
                say(f"{output}: {content}")
        except InputError as error:
            problems += error.told
    if problems:
        raise InputError(problems)
