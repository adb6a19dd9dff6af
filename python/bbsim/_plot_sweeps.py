# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws sweeps: measures over the keys that vary, as lines, maps or histograms."""

from __future__ import annotations

import math
from typing import Any, Dict, List, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize

from . import _bbsim
from ._plot_axes import (CLOSE, Unit, Units, choose_scale, covered, fitted, is_wide, linear,
                         linear_limits, width, words)  # fmt: skip
from ._plot_sheet import ORANGE, Box, Sheet, Stroke, mark, number, stroke
from ._scenario import counted, fault, refuse

_MOST_GROUPS = 5  # more values make a map instead of a line for each
_MOST_BANDS = 3  # more would hide each other
_MOST_MARKERS = 60  # lines with more points have no markers
_MANY_POINTS, _MOST_POINTS = 500, 20000  # of random cases: small ones above the first, only some above the second
_NO_VALUE = mark("s", "#d9d9d9")  # of done cases, in maps
_MOST_CELLS = 160  # of a map along one side; more values share cells


class _Sweep:
    def __init__(self, stored: _bbsim.Stored) -> None:
        self.stored, self.table = stored, _bbsim.sweep_table(stored)
        self.status = np.array(self.table.status)
        self.done = self.status == "done"
        self.units = Units(stored.scenario_text)

    def mark(self, status: str) -> Stroke:
        """The mark of each status except `done`."""
        place = [other for other, _ in self.table.others].index(status)
        return mark(("x", "+", " s", "D", "^")[place % 5], ORANGE, 4)


class _Measure:
    """A measure's values, and its axis: in a fitting unit, logarithmic if the values span decades."""

    def __init__(self, sweep: _Sweep, name: str, close: float = CLOSE, decades: float = 3) -> None:
        self.name, self.values = name, sweep.stored.numbers(name)
        whole = covered(self.values[sweep.done])
        self.log = whole is not None and whole[0] > 0 and whole[1] / whole[0] > 10**decades
        unit, column = _bbsim.measure_unit(name)
        # Frequencies of the loop stay in rad/s.
        drawn = sweep.units.drawn(unit, column in ("gamma", "spin")) if column or unit != "rad/s" else Unit(unit)
        self.scale = choose_scale(drawn, whole, 0 if self.log else close)
        self.range = self.scale.of(whole)
        self.heading = self.scale.heading(name)

    def set(self, axis: Any, air: float, label: str = "") -> None:
        fitted(axis, self.log, self.range, label, air=air)


class _Key:
    """The axis of a key: numbers, logarithmic if they grow by equal factors, or texts side by side."""

    def __init__(self, sweep: _Sweep, key: _bbsim.SweepKey) -> None:
        self.key, self.distinct, self.is_text = key, key.distinct, bool(key.labels)
        self.label = ", with ".join(filter(None, [key.name, ", ".join(sweep.table.followers(key))]))
        self.log, self.scale = False, choose_scale(Unit(), None)
        if not self.is_text:
            low, high = self.distinct[[0, -1]]
            # Logarithmic: positive values that grow by equal factors, over at least a factor of ten.
            if len(self.distinct) > 2 and low > 0 and high >= 10 * low:
                factors = self.distinct[1:] / self.distinct[:-1]
                self.log = bool(np.all(np.abs(factors / factors[0] - 1) < 1e-3))
            self.scale = choose_scale(sweep.units.drawn(key.unit), covered(self.distinct), 0 if self.log else CLOSE)
            self.label = self.scale.heading(self.label)

    def edges(self) -> Any:
        """Of the values' cells: halfway between neighbors, and beyond the outermost values."""
        at = np.log(self.scale(self.distinct)) if self.log else self.scale(self.distinct)
        middle = (at[1:] + at[:-1]) / 2
        edges = np.concatenate([[2 * at[0] - middle[0]], middle, [2 * at[-1] - middle[-1]]])
        return np.exp(edges) if self.log else edges

    def set(self, axis: Any, cells: bool, numbered: bool = True) -> None:
        """Leaves half the distance to the next value at both ends if `cells`, else room for a marker."""
        if self.is_text:
            words(axis, self.key.labels, self.label, numbered)
        else:
            ends = self.edges() if cells else self.scale(self.distinct)
            fitted(axis, self.log, covered(ends), self.label, air=0.0 if cells else 0.02, numbered=numbered)


# Panels; `lowest` of its column: the others have no labels below

def _group_stroke(group: int) -> Stroke:
    return {**mark(("o", "^", "s", "D", " o")[group % 5], stroke(group)["color"], 3), **stroke(group)}


def _bundles(places: Any, values: Any) -> Tuple[Any, List[Any]]:
    """The distinct places, and the values at each."""
    order = np.argsort(places, kind="stable")
    at, first = np.unique(places[order], return_index=True)
    return at, np.split(values[order], first[1:]) if len(at) else []


def _lines(sweep: _Sweep, name: str, over: _bbsim.SweepKey, group: Optional[_bbsim.SweepKey],
           sheet: Sheet, box: Box, lowest: bool) -> None:  # fmt: skip
    """A curve for each value of `group` through the medians, with a band that holds nine of ten cases."""
    along, up = _Key(sweep, over), _Measure(sweep, name)
    axes = sheet.panel(box, up.heading)
    along.set(axes.xaxis, cells=False, numbered=lowest)
    up.set(axes.yaxis, 0.08)
    groups = [0.0] if group is None else list(group.distinct)
    chosen = np.arange(len(over.values)) % (len(over.values) // _MOST_POINTS + 1 if over.drawn else 1) == 0
    for g, value in enumerate(groups):
        mine = chosen & ~np.isnan(over.values) & (True if group is None else group.values == value)
        look = _group_stroke(g)
        if len(over.distinct) > _MOST_MARKERS and not over.drawn:
            look["marker"] = ""
        if along.is_text or over.drawn:  # no lines between texts or random values
            look["ls"] = "none"
        if over.drawn and len(over.values) > _MANY_POINTS:
            look["ms"] = 1.5
        good = mine & sweep.done & np.isfinite(up.values)
        at, bundles = _bundles(over.values[good], up.scale(up.values[good]))
        present = np.unique(over.values[mine])
        low, middle, high = levels = np.full((3, len(present)), np.nan)
        for i, bundle in zip(np.searchsorted(present, at), bundles):
            levels[:, i] = np.quantile(bundle, [0.05, 0.5, 0.95])
        x = along.scale(present)
        if any(len(bundle) > 1 for bundle in bundles) and len(groups) <= _MOST_BANDS:
            axes.fill_between(x, low, high, color=look["color"], alpha=0.25, lw=0)
        axes.plot(x, middle, **look)
    for other, _ in sweep.table.others:  # at the foot
        x = along.scale(np.unique(over.values[chosen & (sweep.status == other)]))
        axes.plot(x, np.zeros(len(x)), transform=axes.get_xaxis_transform(), clip_on=False, **sweep.mark(other))


def _shared(key: _Key) -> Tuple[Any, Any, Any]:
    """Edges of a map's cells along a key; the cell of each case, -1 without a value; and the cells' middles."""
    values, distinct = key.key.values, key.distinct
    cells = min(len(distinct), _MOST_CELLS)
    edges = key.edges()[[-(-cell * len(distinct) // cells) for cell in range(cells + 1)]]
    found = np.searchsorted(distinct, np.nan_to_num(values)) * cells // len(distinct)
    middles = np.sqrt(edges[1:] * edges[:-1]) if key.log else (edges[1:] + edges[:-1]) / 2
    return edges, np.where(np.isnan(values), -1, np.minimum(found, cells - 1)), middles


def _map(sweep: _Sweep, name: str, over: _bbsim.SweepKey, against: _bbsim.SweepKey, sheet: Sheet, box: Box,
         lowest: bool) -> None:  # fmt: skip
    """A map of medians, with a color scale on its right, logarithmic over more than two decades."""
    box = box._replace(across=box.across - 16)
    along, up, colors = _Key(sweep, over), _Key(sweep, against), _Measure(sweep, name, close=1e-2, decades=2)
    axes = sheet.panel(box, colors.heading)
    axes.grid(False)
    axes.spines[:].set_visible(True)
    scattered = over.drawn or against.drawn  # each value is another case's
    along.set(axes.xaxis, cells=not scattered, numbered=lowest)
    up.set(axes.yaxis, cells=not scattered)
    norm: Any = None
    if colors.range is not None:
        low, high = colors.range if is_wide(colors.range) else linear_limits(colors.range, 0)
        norm = (LogNorm if colors.log else Normalize)(low, high)
        scale = sheet.axes(box._replace(left=box.left + box.across + 2.5, across=2.5))
        sheet.figure.colorbar(ScalarMappable(norm, "viridis"), scale).solids.set_rasterized(True)
        colors.set(scale.yaxis, 0.0)
    if scattered:
        return _points(sweep, axes, colors, norm, along, up)
    (x_edges, columns, x), (y_edges, rows, y) = _shared(along), _shared(up)
    shape = len(y), len(x)
    there = (columns >= 0) & (rows >= 0)
    cells = np.where(there, rows * shape[1] + columns, -1)
    medians = np.full(shape, np.nan)
    good = there & sweep.done & np.isfinite(colors.values)
    at, bundles = _bundles(cells[good], colors.scale(colors.values[good]))
    medians.flat[at] = [np.median(bundle) for bundle in bundles]
    present = np.where(np.isin(np.arange(medians.size), cells), 0.85, np.nan).reshape(shape)
    many = medians.size > 2500  # as one image in SVG and PDF
    gray = Normalize(0, 1)
    axes.pcolormesh(x_edges, y_edges, np.ma.masked_invalid(present), cmap="gray", norm=gray, rasterized=many)
    if norm is not None:
        drawn = np.ma.masked_invalid(medians)
        axes.pcolormesh(x_edges, y_edges, drawn, cmap="viridis", norm=norm, rasterized=many)
        if box.across / shape[1] >= 7 and box.up / shape[0] >= 3.2:
            for row, column in np.argwhere(np.isfinite(medians)):
                value = medians[row, column]
                color = "#ffffff" if norm(value) < 0.55 else "#000000"  # readable on both halves of the colors
                axes.text(x[column], y[row], number(value, 3), size=6, ha="center", va="center_baseline", color=color)
    _mark_cells(sweep, axes, cells, x, y, min(box.across / shape[1], box.up / shape[0]))


def _points(sweep: _Sweep, axes: Any, colors: _Measure, norm: Any, along: _Key, up: _Key) -> None:
    """A point for each case."""
    x, y = along.scale(along.key.values), up.scale(up.key.values)
    good = sweep.done & np.isfinite(colors.values)
    many, size = len(x) > _MANY_POINTS, 3 if len(x) > _MANY_POINTS else 14
    axes.scatter(x[good], y[good], size, colors.scale(colors.values[good]), cmap="viridis", norm=norm, lw=0, rasterized=many)
    none = sweep.done & ~good
    axes.scatter(x[none], y[none], size, _NO_VALUE["color"], lw=0, rasterized=many)
    for other, _ in sweep.table.others:
        axes.plot(x[sweep.status == other], y[sweep.status == other], **sweep.mark(other))


def _mark_cells(sweep: _Sweep, axes: Any, cells: Any, x: Any, y: Any, size: float) -> None:
    """Marks cells with a case that is not done, by the status of the first one."""
    marked: Dict[str, List[int]] = {}
    which = np.flatnonzero((cells >= 0) & ~sweep.done)
    for cell, first in zip(*np.unique(cells[which], return_index=True)):
        marked.setdefault(sweep.table.status[which[first]], []).append(cell)
    for other, of in marked.items():
        look = {**sweep.mark(other), "ms": min(max(size / 0.35 * 0.55, 0.8), 4.0)}
        look["mew"] = min(0.9, look["ms"] / 4)
        axes.plot(x[np.array(of) % len(x)], y[np.array(of) // len(x)], rasterized=len(of) > 2500, **look)


def _histogram(sweep: _Sweep, name: str, sheet: Sheet, box: Box) -> None:
    along = _Measure(sweep, name)
    good = along.values[sweep.done & np.isfinite(along.values)]
    values = np.sort(np.log(along.scale(good)) if along.log else along.scale(good))
    legend: List[Tuple[str, Stroke]] = []
    edges, counts, at = np.empty(0), np.ones(1), np.empty(0)
    median: Stroke = {"color": "#000000", "lw": 0.9}
    tail: Stroke = {"color": "#000000", "lw": 0.7, "ls": (0, (4, 2))}
    if len(values):
        if is_wide(along.range):  # the bin width of Freedman and Diaconis, within visible limits
            counts, edges = np.histogram(values, min(max(len(np.histogram_bin_edges(values, "fd")) - 1, 5), 60))
        else:  # one bar, no wider than others would be
            thick = 0.05 if along.log else width(linear_limits(along.range, 0.03)) / 40
            counts, edges = np.array([len(values)]), np.array([values[0] - thick / 2, values[0] + thick / 2])
        at = np.quantile(values, [0.05, 0.5, 0.95])
        at = np.exp(at) if along.log else at
        ends = np.exp(values[[0, -1]]) if along.log else values[[0, -1]]
        part = np.ptp(ends) / max(*np.abs(ends), 1e-300)
        # As many digits as resolve a hundredth of the range.
        digits = min(max(2 - math.floor(math.log10(part)), 3), 12) if part > 0 else 4
        if number(at[0], digits) == number(at[2], digits):
            at, legend = at[1:2], [(f"all {number(at[1], digits)}", median)]
        else:
            tails = f"5, 95 %: {number(at[0], digits)}, {number(at[2], digits)}"
            legend = [(f"median {number(at[1], digits)}", median), (tails, tail)]
    axes = sheet.panel(box, "", legend)
    along.set(axes.xaxis, 0.03, along.heading)
    linear(axes.yaxis, 0, 1.05 * counts.max(), "cases", whole=True)
    if len(edges):
        axes.stairs(counts, np.exp(edges) if along.log else edges, fill=True, color="#7fb8d8")
    for value in at:
        axes.axvline(value, **(median if value == at[len(at) // 2] else tail))


# What is drawn over what

class _Form(NamedTuple):
    """The keys on the axes: two for a map, one for lines, none for histograms."""

    over: Optional[_bbsim.SweepKey] = None
    against: Optional[_bbsim.SweepKey] = None
    group: Optional[_bbsim.SweepKey] = None  # a line for each of its values


def _choose_form(table: _bbsim.SweepTable, names: Sequence[str]) -> _Form:
    def makes_groups(key: _bbsim.SweepKey) -> bool:
        return len(key.distinct) <= _MOST_GROUPS or bool(key.labels)

    # Keys with listed values, except those that vary with another key.
    listed = [key for k, key in enumerate(table.keys) if not key.drawn and key.leader == k]
    if names:
        if len(names) > 2:
            raise refuse("over", ", ".join(names), "one key, or two")
        if len(set(names)) < len(names):
            raise fault(f"over: found {names[0]} twice")
        keys = {key.name: key for key in table.keys}
        for name in names:
            if name not in keys:
                raise fault(f"over: found {name}; what varies: {', '.join(keys)}")
        first = keys[names[0]]
        if len(names) == 2:
            return _Form(first, keys[names[1]])
        groups = [key for key in listed if key.leader != first.leader and makes_groups(key)]
        return _Form(first, group=groups[0] if groups and not first.drawn else None)
    # The two with the most values, in the file's order.
    by_count = sorted(listed, key=lambda key: -len(key.distinct))
    if len(by_count) < 2:
        return _Form(*by_count)
    first, second = by_count[:2]
    if makes_groups(second) and not first.labels:
        return _Form(first, group=second)
    return _Form(*sorted((first, second), key=lambda key: key.leader))


def _choose_measures(sweep: _Sweep, asked: Sequence[str]) -> List[str]:
    """Those asked for; by default those that vary, or all if none does."""
    known = sweep.table.measures
    for name in asked:
        if name not in known and not (name == "end_time" and name in sweep.stored.names):
            source = sweep.stored.file or "the sweep"
            raise fault(f"columns: found {name or 'nothing'}; measures of {source}: {', '.join(known)}")
    return list(asked) or [name for name in known if is_wide(_Measure(sweep, name).range)] or known


def _taken_over(table: _bbsim.SweepTable, form: _Form) -> str:
    """Describes medians over the keys that are not on an axis."""
    if form.over is None or form.over.drawn:
        return ""
    axes = {key.leader for key in form if key is not None}
    rest = [key for key in table.keys if key.leader not in axes]
    listed = ", ".join(key.name for key in rest if not key.drawn)
    drawn = ", ".join(key.name for key in rest if key.drawn)
    bands = form.against is None and (form.group is None or len(form.group.distinct) <= _MOST_BANDS)
    how = "median, and 5 to 95 % as a band, over " if bands else "median over "
    return "; " + how + " and ".join(filter(None, [listed, drawn and f"draws of {drawn}"])) if rest else ""


def draw_sweep(stored: _bbsim.Stored, asked: Sequence[str], over: Sequence[str], wide: Optional[float]) -> Tuple[Any, int]:
    """The figure of a sweep, without cases that are not done, which marks show; and its number of panels."""
    sweep = _Sweep(stored)
    measures = _choose_measures(sweep, asked) if sweep.table.keys else []
    if not measures:
        why = "it has no measures" if sweep.table.keys else "no key varies"
        raise fault(f"{stored.file or 'the sweep'}: nothing to draw: {why}")
    form = _choose_form(sweep.table, over)
    histogram, is_map = form.over is None, form.against is not None
    single = len(measures) == 1
    sheet_width = wide or (135.0 if single else 180.0)
    columns = 1 if single or sheet_width < 125 else 2
    left, right, between = (15.0, 4.0, 19.0)
    part = (sheet_width - left - right - between * (columns - 1)) / columns
    pitch = 0.42 * part + 20 if single else 0.5 * part + 11 if is_map else 34.5 if histogram else 30.5
    rows = -(-len(measures) // columns)
    cases = f"{stored.rows} cases{_taken_over(sweep.table, form)}"
    others = [(f"{word}: {counted(n, 'case')}", sweep.mark(word)) for word, n in sweep.table.others]
    none = sum(not np.isfinite(sweep.stored.numbers(name)[sweep.done]).all() for name in measures)
    if is_map and none:
        others.append(("no value", _NO_VALUE))
    legend: List[Tuple[str, Stroke]] = []
    if form.group is not None:
        names = form.group.labels or [number(value) for value in form.group.distinct]
        legend = [(f"{form.group.name} = {name}", _group_stroke(g)) for g, name in enumerate(names)]
    title = stored.title or stored.shown_file
    subtitle = ", ".join(filter(None, [stored.shown_file if stored.title else "", cases]))
    sheet = Sheet(sheet_width, pitch * rows + (1 if histogram else 8.5), title, subtitle, legend + others)
    for m, name in enumerate(measures):
        x, y = left + (m % columns) * (part + between), pitch * (m // columns)
        box, lowest = Box(x, y + 5.0, part, pitch - (14.5 if histogram else 6.5)), m + columns >= len(measures)
        if form.over is None:
            _histogram(sweep, name, sheet, box)
        elif form.against is not None:
            _map(sweep, name, form.over, form.against, sheet, box, lowest)
        else:
            _lines(sweep, name, form.over, form.group, sheet, box, lowest)
    return sheet.figure, len(measures)
