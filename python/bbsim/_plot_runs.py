# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws runs: the path in the plate, and columns over time, of which related ones share a panel."""

from __future__ import annotations

import math
from collections import namedtuple
from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Sequence, Tuple

import numpy as np

from . import _bbsim
from ._plot_axes import (Range, Unit, Units, choose_scale, choose_scales, covered, is_wide, largest, linear, linear_limits,
                         width)  # fmt: skip
from ._plot_sheet import BAND, ORANGE, Box, Legend, Sheet, Stroke, clean, mark, number, stroke
from ._scenario import Array, fault

MAIN, REFERENCE, MEASURED, COMMAND = range(4)  # roles of columns
Known = namedtuple("Known", "name symbol unit panel heading role beside axis")  # what bbsim knows of a column
_MEASURED_STROKE: Stroke = {"color": "#f2c45c", "lw": 2.4}
_COMMAND_STROKE: Stroke = {"color": "#707070", "lw": 0.7}
_EDGE: Stroke = {"color": "#404040", "lw": 0.9}  # of a plate
_MOST_UPRIGHTS = 40  # with more events, marks stand at the panels' top only, without lines


@dataclass
class Line:
    column: str
    role: int
    name: str  # in a legend


@dataclass
class Panel:
    unit: Unit
    lines: List[Line]
    name: str = ""


def _command_unit(run: _bbsim.Stored) -> str:
    """From the scenario; without one, angles or accelerations, whichever fits the commands better."""
    if run.controller is not None:
        return run.controller[0]
    misfits = np.zeros(2)  # sums of squares
    for axis in ("phi", "theta"):
        if {"t", axis, f"{axis}_command"} <= set(run.names) and run.rows > 1:
            t, command, angle = (run.numbers(name) for name in ("t", f"{axis}_command", axis))
            with np.errstate(all="ignore"):  # rows at the same time
                errors = command - [angle, np.gradient(np.gradient(angle, t), t)]
            misfits += (errors[:, np.isfinite(errors).all(0)] ** 2).sum(1)
    return "rad/s^2" if misfits[1] < misfits[0] else "rad"


class Runs:
    """The runs of a picture, and how their columns are drawn."""

    def __init__(self, runs: Sequence[_bbsim.Stored]) -> None:
        self.runs, self.single = runs, len(runs) == 1
        self.kinds = list(dict.fromkeys(event.name for run in runs for event in run.events))  # of events
        self.units = Units(next((run.scenario_text for run in runs if run.scenario_text), ""))
        self.known = {column[0]: Known(*column) for column in _bbsim.known_columns(_command_unit(runs[0]))}
        # Time goes across; row numbers if one of the runs has no t.
        self.is_timed = all("t" in run.names and not run.is_text("t") for run in runs)
        range_: Any = (0.0, max(run.rows for run in runs) - 1.0)
        if self.is_timed:
            range_ = covered([event.t for run in runs for event in run.events], *(run.numbers("t") for run in runs))
        self.time_scale = choose_scale(self.unit("t") if self.is_timed else Unit(), range_)
        self.time_limits = linear_limits(self.time_scale.of(range_), 0)

    def having(self, column: str) -> List[_bbsim.Stored]:
        return [run for run in self.runs if column in run.names]

    def range(self, column: str) -> Range:
        return covered(*(run.numbers(column) for run in self.having(column)))

    def unit(self, column: str) -> Unit:
        """Plain if one of the runs does not tell its unit."""
        if not all(run.units_known or run.unit(column) for run in self.having(column)):
            return Unit()
        known = self.known.get(column)
        if known is None:
            return self.units.drawn(next((run.unit(column) for run in self.having(column) if run.unit(column)), ""))
        if known.role == COMMAND and not all(run.units_known for run in self.runs):
            known = Known(*next(its for its in _bbsim.known_columns("rad") if its[0] == column))
        return self.units.drawn(known.unit, column in ("gamma", "spin"))

    def facts(self, column: str) -> Known:
        return self.known.get(column) or Known(column, clean(column), "", 0, "", MAIN, "", 0)

    def line(self, column: str) -> Line:
        return Line(column, self.facts(column).role, self.facts(column).symbol)

    def stroke(self, run: _bbsim.Stored) -> Stroke:
        return stroke(next(i for i, other in enumerate(self.runs) if other is run))

    def mark(self, run: _bbsim.Stored, kind: str) -> Stroke:
        """That of a kind of event, the same in all panels."""
        color = ORANGE if self.single else self.stroke(run)["color"]
        return mark(("^", "D", "s", " s", "+")[self.kinds.index(kind) % 5], color, 3.5)

    def planned(self) -> List[Panel]:
        """A panel for each quantity, in an order that suits a control engineer; own columns last."""
        panels: List[Panel] = []
        names = set(column for run in self.runs for column in run.names if self.range(column) is not None)
        last_place = max(known.panel for known in self.known.values())  # of columns without a panel
        places: Dict[int, Panel] = {}
        for name, known in self.known.items():
            if name in names and known.panel != last_place:
                places.setdefault(known.panel, Panel(self.unit(name), [])).lines.append(self.line(name))
        for _, panel in sorted(places.items()):
            # x and y, or phi and theta, share a panel if it has no other quantity.
            alone = [each.lines[0].column for each in panels[-1:] + [panel] if len(each.lines) == 1]
            if alone in (["x", "y"], ["phi", "theta"]):
                panels[-1].lines.append(panel.lines[0])
            else:
                panels.append(panel)
        planned = {line.column for panel in panels for line in panel.lines} | {"t"}
        # A column of a log from which another was made would be the same line again.
        planned |= {column for run in self.runs for column in run.raw} - set(self.known)
        own = dict.fromkeys(column for run in self.runs for column in run.names if column in names - planned)
        panels += [Panel(self.unit(column), [self.line(column)]) for column in own]
        return self._finished(panels, may_split=True)

    def asked(self, lists: Sequence[Sequence[str]]) -> List[Panel]:
        panels = []
        for names in lists:
            for name in names:
                found = f"columns: found {name or 'nothing'}"
                if name == "t":
                    raise fault(f"{found}, over which the others are drawn")
                if not self.having(name):
                    its, source = self.runs[0].names, self.runs[0].file or "the result"
                    near = _bbsim.nearest(name, [*its, "path"])
                    hint = f"; did you mean {near}?" if near else ""
                    raise fault(f"{found}{hint}; {source} has {', '.join(its)}, and path is their picture in the plane")
                if self.range(name) is None:
                    raise fault(f"{found}, which holds no finite number")
                if self.unit(name) != self.unit(names[0]):
                    beside = f"{found} in a panel with {names[0]}, which has another unit"
                    raise fault(f"{beside}; a semicolon begins another panel")
            panels.append(Panel(self.unit(names[0]), [self.line(name) for name in names]))
        return self._finished(panels, may_split=False)

    def _finished(self, wanted: Sequence[Panel], may_split: bool) -> List[Panel]:
        panels: List[Panel] = []
        for panel in wanted:
            roles = [line.role for line in panel.lines]
            if not self.single:
                # Lines of a panel differ by run, so two quantities cannot share one. References can: they are bands.
                panels += self._split(panel, [line for line in panel.lines if line.role != REFERENCE])
            elif may_split and roles.count(MAIN) > 1 and (COMMAND in roles or self._flattens(panel)):
                panels += self._split(panel, [line for line in panel.lines if line.role == MAIN])
            else:
                panels.append(panel)
        for panel in panels:
            self._name(panel)
        return panels

    def _flattens(self, panel: Panel) -> bool:
        """Whether one of the lines would look flat beside another."""
        ranges = [self.range(line.column) for line in panel.lines if line.role == MAIN]
        widths = [width(range_) for range_ in ranges if is_wide(range_)]
        return max(widths, default=0.0) > 50 * min(widths, default=0.0)

    def _split(self, panel: Panel, leaders: List[Line]) -> List[Panel]:
        """A panel for each leader; other lines join that of their axis, or else the first one."""
        parts = [Panel(panel.unit, [line]) for line in leaders] or [Panel(panel.unit, [])]
        for line in panel.lines:
            if not any(line is leader for leader in leaders):
                axis = self.facts(line.column).axis
                same = [part for part in parts if part.lines and self.facts(part.lines[0].column).axis == axis]
                (same or parts)[0].lines.append(line)
        return parts

    def _name(self, panel: Panel) -> None:
        """Sets the heading, and shortens names of lines that the heading completes."""
        mains = [self.facts(line.column) for line in panel.lines if line.role == MAIN]
        common = {known.heading for known in mains}
        if len(mains) > 1 and len(common) == 1 and "" not in common:
            panel.name = common.pop()
            for line in panel.lines:
                line.name = self.facts(line.column).beside or line.name
            return
        panel.name = ", ".join(line.name for line in panel.lines if line.role == MAIN or not mains)
        if len(mains) == 1:
            for line in panel.lines:
                line.name = (mains[0].beside or line.name, "reference", "as seen", "command")[line.role]


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


def _time_panel(sheet: Sheet, box: Box, runs: Runs, planned: Panel, lowest: bool) -> None:
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
    label = runs.time_scale.heading("t" if runs.is_timed else "row")
    linear(axes.xaxis, *runs.time_limits, label, numbered=lowest)
    linear(axes.yaxis, *linear_limits(scale.of(shown)))
    # References and measurements are bands below the thin lines of commands and the motion.
    order = [REFERENCE, MEASURED, COMMAND, MAIN]
    for run, line, look in sorted(curves, key=lambda curve: order.index(curve[1].role)):
        x = runs.time_scale(run.numbers("t") if runs.is_timed else np.arange(run.rows))
        # A sampled controller holds each command until the next one; a sensor holds its value.
        held = line.role == MEASURED or (line.role == COMMAND and (run.controller is None or run.controller[1]))
        _line(axes, x, scale(run.numbers(line.column)), drawstyle="steps-post" if held else "default", **look)
    if in_sight:
        for value in limits:
            axes.axhline(float(scale(value)), **edge)
    for run in runs.runs if runs.is_timed else []:
        _mark_events(axes, runs, run)


def _mark_events(axes: Any, runs: Runs, run: _bbsim.Stored) -> None:
    """Marks events at the top of the panel, with vertical lines if they are few."""
    above = axes.get_xaxis_transform()
    for kind in dict.fromkeys(event.name for event in run.events):
        times = runs.time_scale([event.t for event in run.events if event.name == kind])
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
        turn = np.linspace(0, 2 * math.pi, 181)
        circle, square = np.array([np.cos(turn), np.sin(turn)]), np.array([[-1, 1, 1, -1, -1], [-1, -1, 1, 1, -1]])
        sizes = dict.fromkeys(tuple(run.plate) for run in runs.runs if run.plate)
        plates = [np.array(size)[:, None] / 2 * (circle if len(size) == 1 else square) for size in sizes]
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
    waiting = iter(panels)
    for column in sorted(range(len(counts)), reverse=with_path):  # with a path, panels fill the right column first
        for i in range(counts[column]):
            left, top = _LEFT + column * (part + _BETWEEN), tops[column] + i * pitch
            box = Box(left, top + _ABOVE, part, pitch - _ABOVE - _BELOW)
            _time_panel(sheet, box, runs, next(waiting), lowest=i + 1 == counts[column])
    return sheet.figure, len(panels) + with_path
