# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws runs: the path in the plate, and columns over time."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from . import _bbsim
from ._plot_axes import Unit, choose_scale, choose_scales, covered, is_wide, largest, linear, linear_limits, width
from ._plot_columns import COMMAND, MAIN, MEASURED, REFERENCE, Panel, Runs
from ._plot_sheet import BAND, Box, Legend, Sheet, Stroke, mark, number, stroke
from ._scenario import Array, fault

_MEASURED_STROKE: Stroke = {"color": "#f2c45c", "lw": 2.4}
_COMMAND_STROKE: Stroke = {"color": "#707070", "lw": 0.7}
_EDGE: Stroke = {"color": "#404040", "lw": 0.9}  # of a plate
_MOST_UPRIGHTS = 40  # with more events, marks stand at the panels' top only, without lines


class _Abscissa:
    """The time axis of runs; row numbers if one of them has no t."""

    def __init__(self, runs: Runs) -> None:
        self.is_time = all("t" in run.names and not run.is_text("t") for run in runs.runs)
        range_: Any = (0.0, max(run.rows for run in runs.runs) - 1.0)
        if self.is_time:
            ends = [event.t for run in runs.runs for event in run.events]
            range_ = covered(ends, *(run.numbers("t") for run in runs.runs))
        self.scale = choose_scale(runs.unit("t") if self.is_time else Unit(), range_)
        self.limits = linear_limits(self.scale.of(range_), 0)

    def of(self, run: _bbsim.Stored) -> Any:
        return self.scale(run.numbers("t") if self.is_time else np.arange(run.rows))


def _legend_of_events(runs: Runs) -> Legend:
    entries = []
    for kind in runs.kinds:
        events = [event for run in runs.runs for event in run.events if event.name == kind]
        text = kind + (f", {len(events)} times" if len(events) > 1 else "")
        text += " (stops)" if runs.single and any(event.stopped for event in events) else ""
        look = runs.mark(runs.runs[0], kind)
        entries.append((text, look if runs.single else {**look, "color": "#000000"}))
    return entries


def _line(axes: Any, x: Any, y: Any, **look: Any) -> None:
    """A line, and dots at points between two gaps, through which it does not go."""
    axes.plot(x, y, **look)
    drawn = np.pad(np.isfinite(x) & np.isfinite(y), 1)
    lone = drawn[1:-1] & ~drawn[:-2] & ~drawn[2:]
    if lone.any():
        axes.plot(x[lone], y[lone], **mark("o", look["color"], 2.0))


def _time_panel(sheet: Sheet, box: Box, runs: Runs, planned: Panel, abscissa: _Abscissa, lowest: bool) -> None:
    range_ = covered(*(runs.range(line.column) or [] for line in planned.lines))
    demanded = any(line.column == "friction_demand" for line in planned.lines)
    limits = sorted({run.friction for run in runs.runs if run.friction is not None}) if demanded else []
    shown = covered(range_ or [], limits)
    in_sight = width(shown) < 20 * width(range_)  # a limit far away appears only in the legend
    shown = shown if in_sight else range_
    scale = choose_scale(planned.unit, shown)
    legend, curves = [], []
    for run in runs.runs:
        mains = 0
        for line in planned.lines:
            look = {MEASURED: _MEASURED_STROKE, COMMAND: _COMMAND_STROKE}.get(line.role) or stroke(mains)
            look = BAND if line.role == REFERENCE else look if runs.single else runs.stroke(run)
            mains += line.role == MAIN
            if len(planned.lines) > 1 and run is runs.runs[0] and (runs.single or line.role == REFERENCE):
                legend.append((line.name, look))
            if line.column in run.names:
                curves.append((run, line, look))
    edge: Stroke = {"color": "#000000", "lw": 0.8, "ls": (0, (4, 2))}
    if limits:
        names = "coefficient " + ", ".join(map(number, limits)) + ("" if in_sight else ", above")
        legend.append((names, edge))
    axes = sheet.panel(box, scale.heading(planned.name), legend)
    label = abscissa.scale.heading("t" if abscissa.is_time else "row")
    linear(axes.xaxis, *abscissa.limits, label, numbered=lowest)
    linear(axes.yaxis, *linear_limits(scale.of(shown)))
    # References and measurements are bands below the thin lines of commands and the motion.
    order = [REFERENCE, MEASURED, COMMAND, MAIN]
    for run, line, look in sorted(curves, key=lambda curve: order.index(curve[1].role)):
        x, y = abscissa.of(run), scale(run.numbers(line.column))
        # A sampled controller holds each command until the next one; a sensor holds its value.
        held = line.role == MEASURED or (line.role == COMMAND and (run.controller is None or run.controller[1]))
        _line(axes, x, y, drawstyle="steps-post" if held else "default", **look)
    if in_sight:
        for value in limits:
            axes.axhline(float(scale(value)), **edge)
    for run in runs.runs if abscissa.is_time else []:
        _mark_events(axes, runs, run, abscissa)


def _mark_events(axes: Any, runs: Runs, run: _bbsim.Stored, abscissa: _Abscissa) -> None:
    """Marks events at the top of the panel, with vertical lines if they are few."""
    above = axes.get_xaxis_transform()
    for kind in dict.fromkeys(event.name for event in run.events):
        times = abscissa.scale([event.t for event in run.events if event.name == kind])
        look = runs.mark(run, kind)
        if len(run.events) <= _MOST_UPRIGHTS:
            upright = np.tile([0.0, 1.0, np.nan], len(times))
            axes.plot(np.repeat(times, 3), upright, transform=above, color=look["color"], lw=0.6, ls=":", marker="")
        axes.plot(times, np.ones(len(times)), transform=above, clip_on=False, **look)


def _points(run: _bbsim.Stored, suffix: str = "") -> Array:
    """Two rows, x and y; without columns if the run lacks one of them."""
    names = [f"x{suffix}", f"y{suffix}"]
    points = np.array([run.numbers(name) if set(names) <= set(run.names) else [] for name in names], float)
    return np.where(np.isfinite(points).all(0), points, np.nan)


def _plates(runs: Sequence[_bbsim.Stored]) -> List[Array]:
    """The edges of the known plates, m."""
    turn = np.linspace(0, 2 * math.pi, 181)
    circle, square = np.array([np.cos(turn), np.sin(turn)]), np.array([[-1, 1, 1, -1, -1], [-1, -1, 1, 1, -1]])
    sizes = dict.fromkeys(tuple(run.plate) for run in runs if run.plate)
    return [np.array(size)[:, None] / 2 * (circle if len(size) == 1 else square) for size in sizes]


class _Path:
    """The paths in the plane, to scale."""

    def __init__(self, runs: Runs) -> None:
        self._runs = runs
        paths = [_points(run, suffix) for run in runs.runs for suffix in ("", "_reference")]
        self._references = [(its, BAND if any(is_wide(covered(part)) for part in its) else mark("x", "#009e73", 5))
                            for its in paths[1::2] if covered(its[0]) is not None]  # fmt: skip
        self.exists = any(covered(_points(run)[0]) for run in runs.runs)
        spots = np.array([(event.x, event.y) for run in runs.runs for event in run.events]).reshape(-1, 2).T

        def ranges(*more: Array) -> List[Any]:
            return [covered(*(points[i] for points in (*paths, *more))) for i in range(2)]

        shorter, longer = sorted(map(width, ranges()))
        plates = _plates(runs.runs)
        # Whether the picture shows no more than the columns: the ball stays on a line along x or y.
        self.is_along_an_axis = self.exists and not plates and shorter < 1e-6 * longer
        # A plate ten times the path's size would make the path too small to see.
        most = 10 * max(map(width, ranges(spots)))
        self._edges = [edge for edge in plates if max(width(covered(part)) for part in edge) <= most]
        self._x, self._y = ranges(spots, *self._edges)

    def legend(self) -> Legend:
        entries: Dict[str, Stroke] = {"path": stroke(0)} if self._runs.single else {}
        entries.update(("reference", look) for _, look in self._references)
        entries.update([("plate's edge", _EDGE)] if self._edges else [])
        return [*entries.items(), ("start", mark(" o")), ("end", mark("o", size=4))]

    def draw(self, sheet: Sheet, box: Box) -> None:
        runs = self._runs
        x_scale, y_scale = choose_scales(runs.unit("x"), self._x, self._y)
        x, y = x_scale.of(self._x) or (0.0, 1.0), y_scale.of(self._y) or (0.0, 1.0)
        # Widens the shorter range until both axes have the same scale.
        wide, most = max(width(x), width(y) * box.across / box.up), max(largest(x), largest(y))
        half = 0.54 * (wide if wide > 1e-9 * most else most or 1.0)
        axes = sheet.panel(box, y_scale.heading("y"))
        middle = x[0] / 2 + x[1] / 2
        linear(axes.xaxis, middle - half, middle + half, x_scale.heading("x"))
        middle, tall = y[0] / 2 + y[1] / 2, half * box.up / box.across
        linear(axes.yaxis, middle - tall, middle + tall)

        def line(points: Array, look: Stroke) -> None:
            _line(axes, x_scale(points[0]), y_scale(points[1]), **look)

        def spot(points: Array, at: int, look: Stroke) -> None:
            finite = np.flatnonzero(np.isfinite(points[0]))
            if len(finite):
                axes.plot(x_scale(points[0][finite[at]]), y_scale(points[1][finite[at]]), **look)

        for reference, look in self._references:
            if look is BAND:
                line(reference, look)
        for edge in self._edges:
            line(edge, _EDGE)
        for run in runs.runs:
            line(_points(run), runs.stroke(run))
        for reference, look in self._references:
            if look is not BAND:
                spot(reference, 0, look)
        for run in runs.runs:
            color = "#000000" if runs.single else runs.stroke(run)["color"]
            spot(_points(run), 0, mark(" o", color))
            spot(_points(run), -1, mark("o", color, 4))
            for event in run.events:
                axes.plot(x_scale(event.x), y_scale(event.y), **runs.mark(run, event.name))


_LEFT, _RIGHT, _BETWEEN = 12.0, 4.0, 16.0  # mm: beside the panels, and between two columns of them
_ABOVE, _BELOW, _UNDER = 4.8, 1.2, 9.0  # of a panel: heading, gap, and labels of a time axis
_NARROW = 125.0  # mm: narrower pictures have one column


def _layout(path: bool, panels: int, wide: Optional[float]) -> Tuple[float, float, float, List[int]]:
    """The picture's width, the height of a panel with its gaps, and that of the path, mm; and the number of panels in
    each column, the first of them below the path."""
    least, two = 20.0, wide or 180.0
    if path and panels == 0:
        across = wide or 88.0
        return across, 0.0, min(across - _LEFT - _RIGHT, 130.0), [0]
    if two < _NARROW or (not path and panels <= 6):
        across = wide or 135.0
        pitch = max((66 if panels > 1 else 54) / panels, least)
        return across, pitch, 0.85 * (across - _LEFT - _RIGHT), [panels]
    if not path:
        return two, least, 0.0, [panels - panels // 2, panels // 2]
    right = panels if panels < 6 else (panels + 5) // 2
    left = panels - right
    pitch = max(((two - _LEFT - _RIGHT - _BETWEEN) / 2 + 4) / right, least)
    return two, pitch, (right - left) * pitch - _ABOVE - _BELOW - (_UNDER if left else 0), [left, right]


def _status(run: _bbsim.Stored) -> str:
    if run.status in ("", "done"):
        return ""
    when = "" if run.end_time is None else f" at t = {number(run.end_time, 6)} s"
    return run.status + when + (f": {run.events[-1].name}" if run.status == "stopped" and run.events else "")


def _titles(runs: Runs) -> Tuple[str, str, Legend]:
    first = runs.runs[0]
    title = first.title if all(run.title == first.title for run in runs.runs) else ""
    if not runs.single:
        shown = [run.shown_file for run in runs.runs]
        names = [run.file if shown.count(run.shown_file) > 1 else run.shown_file for run in runs.runs]
        if not any(names):
            names = [run.title if not title and run.title else f"run {i + 1}" for i, run in enumerate(runs.runs)]
        texts = [", ".join(filter(None, [name, _status(run)])) for name, run in zip(names, runs.runs)]
        return title, "", list(zip(texts, map(runs.stroke, runs.runs)))
    title, subtitle = (title, first.shown_file) if title else (first.shown_file, "")
    return title, ", ".join(filter(None, [subtitle, _status(first)])), []


def draw_runs(results: Sequence[_bbsim.Stored], asked: Sequence[Sequence[str]], wide: Optional[float]) -> Tuple[Any, int]:
    """The figure of one run, or of a comparison of several; and its number of panels."""
    runs = Runs(results)
    path = _Path(runs)
    lists = [list(names) for names in asked if list(names) != ["path"]]
    if len(lists) < len(asked) and not path.exists:
        raise fault(f"columns: found path; {results[0].file or 'the result'} has no numbers x and y")
    panels = runs.asked(lists) if asked else runs.planned()
    with_path = len(lists) < len(asked) if asked else path.exists and (not panels or not path.is_along_an_axis)
    if not panels and not with_path:
        raise fault(f"{results[0].file or 'the result'}: nothing to draw: no column but t holds finite numbers")
    sheet_width, pitch, path_height, counts = _layout(with_path, len(panels), wide)
    title, subtitle, legend = _titles(runs)
    legend = [*legend, *(path.legend() if with_path else ()), *_legend_of_events(runs)]
    part = (sheet_width - _LEFT - _RIGHT - _BETWEEN * (len(counts) - 1)) / len(counts)
    path_room = _ABOVE + path_height + _BELOW if with_path else 0.0
    # Below the path stand the labels of its axis, if panels follow there.
    tops = [path_room + (_UNDER if with_path and counts[0] else 0.0), 0.0][: len(counts)]
    tallest = max(top + pitch * count for top, count in zip(tops, counts))
    sheet = Sheet(sheet_width, tallest + _UNDER, title, subtitle, legend)
    if with_path:
        path.draw(sheet, Box(_LEFT, _ABOVE, part, path_height))
    waiting, abscissa = iter(panels), _Abscissa(runs)
    for column in sorted(range(len(counts)), reverse=with_path):  # with a path, panels fill the right column first
        for i in range(counts[column]):
            left, top = _LEFT + column * (part + _BETWEEN), tops[column] + i * pitch
            box = Box(left, top + _ABOVE, part, pitch - _ABOVE - _BELOW)
            _time_panel(sheet, box, runs, next(waiting), abscissa, lowest=i + 1 == counts[column])
    return sheet.figure, len(panels) + with_path
