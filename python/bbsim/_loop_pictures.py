# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a scenario: the columns of _loops, with margins or a grid of damping; and the time that each method takes
for its error."""

from __future__ import annotations

import csv
import math
from typing import Any, Dict, List, Optional, Tuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator, MultipleLocator, NullFormatter

from . import _loops
from ._loops import AXES, Columns
from ._plot_axes import covered, logarithmic
from ._plot_sheet import MM, TEXT, Box, Figure, Sheet, cut, mark, number, stroke, width_of
from ._result import Linearization
from ._scenario import Array, Scenario, Settings, fault

Label = Tuple[str, float, float, bool, str]  # text, x, y, whether above y, color

NAMES = {"phi": "φ", "theta": "θ"}
LOOKS: Dict[str, Any] = {"phi": {"color": "#0072b2", "ls": "-"}, "theta": {"color": "#d55e00", "ls": (0, (4, 1.5))}}
QUIET = {"color": "#909090", "lw": 0.6}
GRID = {"color": "#d0d0d0", "lw": 0.5, "zorder": 0}
DAMPINGS = (0.1, 0.3, 0.5, 0.7, 0.9)


def _figure(width: float, height: float) -> Figure:
    return Figure(figsize=(width * MM, height * MM), layout="constrained", facecolor="white")


def _curves(columns: Columns, part: str) -> List[Tuple[str, str, Array]]:
    """Axis, label and values of each curve to draw: one for both axes if they do not differ."""
    found = {axis: columns[f"{axis}_{part}"] for axis in AXES}
    present = [axis for axis in AXES if np.isfinite(found[axis]).any()]
    if len(present) == 2 and np.allclose(found["phi"], found["theta"], rtol=1e-6, atol=0, equal_nan=True):
        return [("phi", "φ, θ", found["phi"])]
    return [(axis, NAMES[axis], found[axis]) for axis in present]


def _legend(axes: Axes) -> None:
    """Above the panel, since curves may go anywhere in it."""
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, borderaxespad=0.2)


def _decibels(gain: Any) -> Any:
    with np.errstate(divide="ignore"):
        return 20 * np.log10(gain)


def bode(columns: Columns, loop: Linearization, width: float = 135.0) -> Figure:
    """Gain and phase of the open loops over the frequency, with the margins marked. ``width`` in mm."""
    figure = _figure(width, 0.85 * width)
    above, below = figure.subplots(2, 1, sharex=True)
    at, curves = columns["frequency"], _curves(columns, "gain")
    phases = {axis: np.degrees(columns[f"{axis}_phase"]) for axis, _, _ in curves}
    for axis, label, gain in curves:
        above.semilogx(at, _decibels(gain), **LOOKS[axis], label=label)
        below.semilogx(at, phases[axis], **LOOKS[axis])
    above.axhline(0, **QUIET)
    above.set_ylabel("gain (dB)")
    _legend(above)
    below.axhline(-180, **QUIET)
    below.set_ylabel("phase (°)")
    below.set_xlabel("frequency (rad/s)")
    below.yaxis.set_major_locator(MultipleLocator(90))
    below.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    below.xaxis.set_minor_formatter(NullFormatter())
    for axes in (above, below):
        axes.margins(x=0)
    labels: Dict[Axes, List[Label]] = {above: [], below: []}
    for axis, _, _ in curves:
        its, color = loop.margins.get(f"{axis}_command", {}), LOOKS[axis]["color"]
        for name in ("gain", "gain_reduction", "phase"):
            margin, where = its.get(name), its.get(f"{name}_frequency")
            if margin is None or not where:
                continue
            if name == "phase":
                level = float(np.interp(where, at, phases[axis]))
                critical = level - math.degrees(margin)  # an odd multiple of 180 degrees
                text = f"{math.degrees(margin):.3g}°"
            else:
                level, critical, text = -_decibels(margin), 0.0, f"{_decibels(margin):+.3g} dB"
            panel = below if name == "phase" else above
            panel.vlines(where, *sorted((critical, level)), color=color, lw=1.6)
            labels[panel].append((text, where, critical, level < critical, color))
    for axes, texts in labels.items():
        _write(axes, texts)
    return figure


def _write(axes: Axes, labels: List[Label]) -> None:
    """Writes each label at the end of its margin's line: within the panel, apart from curves and other labels."""
    to_panel = axes.transData + axes.transAxes.inverted()
    taken = np.concatenate([to_panel.transform(line.get_xydata()) for line in axes.lines if len(line.get_xdata()) > 2])
    width, height = axes.figure.get_size_inches() / MM - (18, 20)  # of a panel, mm; there are two
    for text, x, y, above, color in labels:
        size = np.array([(width_of(text, TEXT) + 2) / width, 4.0 / (height / 2)])
        for right, up in ((True, above), (False, above), (True, not above), (False, not above)):
            low = to_panel.transform((x, y)) - size * (0 if right else 1, 0 if up else 1)
            hit = ((taken > low) & (taken < low + size)).all(axis=1).any()
            if not hit and (low >= 0).all() and (low + size <= 1).all():
                break
        edges = np.linspace(0, 1, 9)
        taken = np.concatenate([taken, low + size * np.stack(np.meshgrid(edges, edges), axis=2).reshape(-1, 2)])
        axes.annotate(
            text, (x, y), (3 if right else -3, 3 if up else -3), textcoords="offset points", color=color,
            ha="left" if right else "right", va="bottom" if up else "top",
        )  # fmt: skip


def nyquist(columns: Columns, loop: Linearization, width: float = 100.0) -> Figure:
    """The open loops in the complex plane, with -1 and the unit circle; mirrored for negative frequencies."""
    figure = _figure(width, width)
    axes = figure.subplots()
    turn = np.linspace(0, 2 * math.pi, 200)
    axes.plot(np.cos(turn), np.sin(turn), **QUIET)
    for axis, label, real in _curves(columns, "real"):
        imag = columns[f"{axis}_imag"]
        axes.plot(real, imag, **LOOKS[axis], label=label)
        axes.plot(real, -imag, color=LOOKS[axis]["color"], ls=(0, (1, 1.2)), lw=0.8)
    axes.plot([-1], [0], "k+", ms=8)
    far = 2.5  # integrators go to infinity
    axes.set(xlim=(-far, far), ylim=(-far, far), aspect="equal", xlabel="real part", ylabel="imaginary part")
    _legend(axes)
    return figure


def _grid(axes: Axes, dt: Optional[float], reach: float) -> None:
    """Lines of equal damping ratio, and of equal natural frequency, in the plane of s or of z."""

    def place(s: Any) -> Any:
        return np.exp(s * dt) if dt else s

    along = np.linspace(0, 1, 200)
    for damping in DAMPINGS:
        to = math.pi / dt / math.sqrt(1 - damping**2) if dt else 2 * reach
        line = place(along * to * complex(-damping, math.sqrt(1 - damping**2)))
        _line(axes, line)
        at = line[60 if dt else 90]
        if dt or abs(at) < reach:
            axes.text(at.real, at.imag, f"{damping:g}", color="#909090", size="x-small", ha="right")
    for frequency in np.array([0.2, 0.4, 0.6, 0.8, 1.0]) * (math.pi / dt if dt else reach):
        _line(axes, place(frequency * np.exp(1j * math.pi * (0.5 + 0.5 * along))))
    if dt:
        turn = np.exp(1j * 2 * math.pi * along)
        axes.plot(turn.real, turn.imag, **QUIET)
    else:
        axes.axvline(0, **QUIET)


def _line(axes: Axes, points: Any) -> None:
    for sign in (1, -1):
        axes.plot(points.real, sign * points.imag, **GRID)


def _plane(columns: Columns, dt: Optional[float], width: float, height: float = 0) -> Tuple[Figure, Axes]:
    figure = _figure(width, height or width)
    axes = figure.subplots()
    real, imag = columns["real"], columns["imag"]
    finite = np.isfinite(real) & np.isfinite(imag)
    reach = float(np.abs(real[finite] + 1j * imag[finite]).max(initial=0.0)) or 1.0
    if dt:
        reach = max(1.0, reach)
    _grid(axes, dt, reach)
    room = 1.08 * reach
    axes.set(xlim=(-room, room if dt or real[finite].max(initial=0.0) > 0.3 * reach else 0.3 * reach), ylim=(-room, room))
    axes.set_aspect("equal")
    unit = "" if dt else " (1/s)"
    axes.set(xlabel=f"real part of {'z' if dt else 's'}{unit}", ylabel=f"imaginary part{unit}")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(max(2, int(width / 16)), steps=[1, 2, 5, 10]))
    return figure, axes


def poles(columns: Columns, loop: Linearization, width: float = 100.0) -> Figure:
    """The closed loop's poles: of s, or of z if it is sampled."""
    figure, axes = _plane(columns, loop.dt, width)
    axes.plot(columns["real"], columns["imag"], "x", color=LOOKS["phi"]["color"], ms=6)
    return figure


def root_locus(columns: Columns, loop: Linearization, key: str, width: float = 110.0) -> Figure:
    """The poles at each value of a key, colored by it; crosses at its first value, circles at its last."""
    figure, axes = _plane(columns, loop.dt, width, 1.14 * width)
    value = columns["value"]
    branches, its = _branches(columns)
    points = axes.add_collection(LineCollection(branches, array=its, cmap="viridis", lw=1.6, zorder=2))
    for end, shape in ((value[0], "x"), (value[-1], "o")):
        at = value == end
        axes.plot(columns["real"][at], columns["imag"][at], shape, color="black", ms=5, mfc="none", mew=0.8,
                  label=f"at {number(end)}")  # fmt: skip
    _legend(axes)
    figure.colorbar(points, ax=axes, location="bottom", aspect=40, fraction=0.05, label=cut(key, 0.8 * width, TEXT))
    return figure


def _branches(columns: Columns) -> Tuple[List[Array], Array]:
    """Lines from each pole to the pole that it moves to at the next value, and these values."""
    from scipy.optimize import linear_sum_assignment  # takes long to import

    lines: List[Array] = []
    values: List[float] = []
    before: Optional[Array] = None
    for value in np.unique(columns["value"]):
        at = columns["value"] == value
        now = columns["real"][at] + 1j * columns["imag"][at]
        if before is not None and len(before) == len(now):
            one, other = linear_sum_assignment(np.abs(before[:, None] - now[None, :]))
            ends = np.stack([before[one], now[other]], axis=1)
            lines += list(np.stack([ends.real, ends.imag], axis=2))
            values += [value] * len(now)
        before = now
    return lines, np.array(values)


def step(columns: Columns, loop: Linearization, width: float = 135.0) -> Figure:
    """The response of x and y to a unit step of their references."""
    figure = _figure(width, 0.55 * width)
    axes = figure.subplots()
    axes.axhline(1, **QUIET)
    same = np.allclose(columns["x"], columns["y"], rtol=1e-6, atol=1e-9)
    for name, axis in zip("xy", AXES):
        if np.isfinite(columns[name]).any() and not (same and name == "y"):
            axes.plot(columns["t"], columns[name], **LOOKS[axis], label="x, y" if same else name)
    axes.set(xlabel="t (s)", ylabel="step response")
    axes.margins(x=0)
    _legend(axes)
    return figure


# The pictures of one loop, and what the rows of their columns are.
_PICTURES = {"bode": (bode, "frequencies"), "nyquist": (nyquist, "frequencies"), "poles": (poles, "poles"),
             "step": (step, "times")}  # fmt: skip
KINDS = (*_PICTURES, "root_locus")
_VALUES = 200  # of the key of a root locus


def _csv(columns: Columns) -> str:
    rows = zip(*(map(repr, column.tolist()) for column in columns.values()))
    return "\n".join([",".join(columns), *(",".join(row) for row in rows), ""])


def draw_loop(kind: str, scenario: Scenario, set: Settings, locus: str, wide: Optional[float]) -> Tuple[str, Figure, str]:
    """The numbers as CSV, the figure, and what is in it. Raises InputError for a scenario without a loop."""
    width, loop = {"width": wide} if wide else {}, _loops.linearized(scenario, set)
    if kind == "root_locus":
        key, _, between = locus.partition("=")
        bounds = between.partition(":")[::2]
        if not all((key, *bounds)):
            raise fault(f"root-locus: found {locus}; allowed: KEY=FROM:TO, such as controller.pd.kv.0.0=0.2:2")
        columns = _loops.root_locus(scenario, set, key, bounds, _VALUES)
        return _csv(columns), root_locus(columns, loop, key, **width), f"the poles at {_VALUES} values of {key}"
    (picture, rows), columns = _PICTURES[kind], getattr(_loops, kind)(loop)
    return _csv(columns), picture(columns, loop, **width), f"{len(next(iter(columns.values())))} {rows}"


def draw_accuracy(text: str, title: str, wide: Optional[float]) -> Tuple[Any, int]:
    """The figure of a table of `bbsim accuracy --csv`, without runs that ended early; and its number of points."""
    points: Dict[str, List[Tuple[float, float]]] = {}
    for row in csv.DictReader(text.splitlines()):
        if row["status"] != "failed":
            # A logarithm has no zero. An error below all rounding can be zero.
            points.setdefault(row["method"], []).append((max(float(row["error_m"]), 1e-20), float(row["time_us"])))
    shapes = ("o", "^", "s", "D")
    looks = {name: {**mark(shapes[i % 4], stroke(i)["color"], 3.5), **stroke(i)} for i, name in enumerate(points)}
    width = wide or 135.0
    height = 0.6 * (width - 19)
    sheet = Sheet(width, height + 14, title, "", list(looks.items()))
    box = Box(15.0, 4.8, width - 4, 4.8 + height)
    axes = sheet.panel(box, "processor time of a run (µs)")
    every = [point for method in points.values() for point in method]
    label = "error: largest |Δx|, |Δy| over the output times (m)"
    logarithmic(axes.xaxis, covered([error for error, _ in every]), label, air=0.04)
    logarithmic(axes.yaxis, covered([time for _, time in every]), air=0.06)
    for method, look in looks.items():
        axes.plot(*zip(*points[method]), **look)
    return sheet.figure, len(every)
