# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Frequency responses, poles and step responses of a scenario's loop, as columns of numbers and as pictures, with margins
or a grid of damping; and the time that each method takes for its error."""

from __future__ import annotations

import csv
import math
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.ticker import MaxNLocator, MultipleLocator, NullFormatter

from . import _bbsim
from ._plot_axes import covered, logarithmic
from ._plot_sheet import MM, TEXT, Box, Figure, Sheet, cut, mark, number, stroke, width_of
from ._result import Linearization
from ._scenario import Array, Scenario, fault, given

Columns = Dict[str, Array]
Label = Tuple[str, float, float, bool, str]  # text, x, y, whether above y, color

AXES = {"phi": "φ", "theta": "θ"}
LOOKS: Dict[str, Any] = {axis: stroke(i) for i, axis in enumerate(AXES)}
QUIET = {"color": "#909090", "lw": 0.6}
GRID = {"color": "#d0d0d0", "lw": 0.5, "zorder": 0}
DAMPINGS = (0.1, 0.3, 0.5, 0.7, 0.9)
_VALUES = 200  # of the key of a root locus


def linearized(scenario: Scenario) -> Linearization:
    """The closed loop about home. Raises InputError for a scenario without one."""
    return Linearization(_bbsim.linearize(given(scenario), "loop", "home"))


# Numbers

def rates(poles: Array, dt: Optional[float]) -> Array:
    """The poles in 1/s; with a period, s of z = exp(s dt)."""
    with np.errstate(divide="ignore"):
        return np.log(poles.astype(np.complex128)) / dt if dt else poles


def _responses(loop: Linearization, parts: Dict[str, Callable[[Array], Array]]) -> Columns:
    """Frequencies, and parts of the open-loop response of each axis; nan for an axis without a loop."""
    at = loop._frequencies
    if not len(at):
        raise fault("found a scenario in which no command closes a loop; allowed: a controller that feeds back")
    lacking = np.full(len(at), np.nan * 1j)
    found = {axis: loop.open_loop(axis).response(at) if f"{axis}_command" in loop.margins else lacking for axis in AXES}
    return {"frequency": at, **{f"{axis}_{name}": part(found[axis]) for axis in AXES for name, part in parts.items()}}


def phase_of(response: Array) -> Array:
    """The phase without jumps, rad; at the lowest frequency between -7/4 pi and pi/4."""
    phase = np.unwrap(np.angle(response))
    return phase - 2 * math.pi * np.round((phase[:1] + 0.75 * math.pi) / (2 * math.pi))


def bode(loop: Linearization) -> Columns:
    return _responses(loop, {"gain": np.abs, "phase": phase_of})


def nyquist(loop: Linearization) -> Columns:
    return _responses(loop, {"real": np.real, "imag": np.imag})


def poles(loop: Linearization) -> Columns:
    """Those of a sampled loop are z; damping and frequency are those of s."""
    at = rates(loop.poles, loop.dt)
    size = np.abs(at)
    with np.errstate(invalid="ignore"):
        damping = np.where(np.isinf(size), 1.0, -at.real / size)
    return {"real": loop.poles.real, "imag": loop.poles.imag, "damping": damping, "frequency": size}


def root_locus(rig: _bbsim.Given, key: str, bounds: Sequence[str], count: int) -> Columns:
    """A row for each pole of the closed loop at evenly spaced values of the key, between texts such as "2 cm"."""
    ends = [rig.number_at(key, bound) for bound in bounds]
    if None in ends:
        raise fault(f"{key}: found {bounds[ends.index(None)]}; allowed: the bounds of a key that holds one number")
    values = np.linspace(ends[0], ends[1], count)
    found = [linearized(rig.changed([(key, repr(float(value)))])).poles for value in values]
    every = np.concatenate(found)
    return {"value": np.repeat(values, [len(poles) for poles in found]), "real": every.real, "imag": every.imag}


def step(loop: Linearization) -> Columns:
    """The linear responses to a unit step of each reference, until the slowest mode has decayed to 0.1 %, or has grown
    tenfold. A sampled loop has a row for each sample."""
    from scipy.signal import cont2discrete, dlsim  # take long to import

    if not loop.inputs:
        raise fault("found a controller of your own, whose answer to a reference is not known; allowed: a law of bbsim")
    decay = rates(loop.poles, loop.dt).real
    decay = decay[np.isfinite(decay) & (np.abs(decay) > 1e-6 * np.abs(decay[np.isfinite(decay)]).max())]
    growth = decay.max()
    end = math.log(1000) / -growth if growth < 0 else math.log(10) / growth
    count = min(int(round(end / loop.dt)), 20000) if loop.dt else 500
    period = loop.dt or end / count
    system = (loop.A, loop.B, loop.C, loop.D)
    sampled = (*system, period) if loop.dt else cont2discrete(system, period)
    columns = {"t": np.arange(count + 1) * period, "x": np.full(count + 1, np.nan), "y": np.full(count + 1, np.nan)}
    for output in ("x", "y"):
        if output in loop.outputs and f"{output}_reference" in loop.inputs:
            steps = np.zeros((count + 1, len(loop.inputs)))
            steps[:, loop.inputs.index(f"{output}_reference")] = 1
            columns[output] = dlsim(sampled, steps)[1][:, loop.outputs.index(output)]
    return columns


# Pictures; `width` in mm

def _figure(width: float, height: float) -> Figure:
    return Figure(figsize=(width * MM, height * MM), layout="constrained", facecolor="white")


def _curves(columns: Columns, part: str) -> List[Tuple[str, str, Array]]:
    """Axis, label and values of each curve to draw: one for both axes if they do not differ."""
    found = {axis: columns[f"{axis}_{part}"] for axis in AXES}
    present = [axis for axis in AXES if np.isfinite(found[axis]).any()]
    if len(present) == 2 and np.allclose(found["phi"], found["theta"], rtol=1e-6, atol=0, equal_nan=True):
        return [("phi", "φ, θ", found["phi"])]
    return [(axis, AXES[axis], found[axis]) for axis in present]


def _legend(axes: Axes) -> None:
    """Above the panel, since curves may go anywhere in it."""
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, frameon=False, borderaxespad=0.2)


def _decibels(gain: Any) -> Any:
    with np.errstate(divide="ignore"):
        return 20 * np.log10(gain)


def draw_bode(columns: Columns, loop: Linearization, width: float = 135.0) -> Figure:
    """Gain and phase of the open loops over the frequency, with the margins marked."""
    figure = _figure(width, 0.85 * width)
    above, below = figure.subplots(2, 1, sharex=True)
    at, curves = columns["frequency"], _curves(columns, "gain")
    phases = {axis: np.degrees(columns[f"{axis}_phase"]) for axis, _, _ in curves}
    for axis, label, gain in curves:
        above.semilogx(at, _decibels(gain), **LOOKS[axis], label=label)
        below.semilogx(at, phases[axis], **LOOKS[axis])
    for axes, limit, label in ((above, 0, "gain (dB)"), (below, -180, "phase (°)")):
        axes.axhline(limit, **QUIET)
        axes.set_ylabel(label)
        axes.margins(x=0)
    _legend(above)
    below.set_xlabel("frequency (rad/s)")
    below.yaxis.set_major_locator(MultipleLocator(90))
    below.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    below.xaxis.set_minor_formatter(NullFormatter())
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
        axes.annotate(text, (x, y), (3 if right else -3, 3 if up else -3), textcoords="offset points", color=color,
                      ha="left" if right else "right", va="bottom" if up else "top")  # fmt: skip


def draw_nyquist(columns: Columns, loop: Linearization, width: float = 100.0) -> Figure:
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

    def lines(s: Any) -> Any:
        points = np.exp(s * dt) if dt else s
        for sign in (1, -1):
            axes.plot(points.real, sign * points.imag, **GRID)
        return points

    along = np.linspace(0, 1, 200)
    for damping in DAMPINGS:
        to = math.pi / dt / math.sqrt(1 - damping**2) if dt else 2 * reach
        at = lines(along * to * complex(-damping, math.sqrt(1 - damping**2)))[60 if dt else 90]
        if dt or abs(at) < reach:
            axes.text(at.real, at.imag, f"{damping:g}", color="#909090", size="x-small", ha="right")
    for frequency in np.array([0.2, 0.4, 0.6, 0.8, 1.0]) * (math.pi / dt if dt else reach):
        lines(frequency * np.exp(1j * math.pi * (0.5 + 0.5 * along)))
    if dt:
        turn = np.exp(1j * 2 * math.pi * along)
        axes.plot(turn.real, turn.imag, **QUIET)
    else:
        axes.axvline(0, **QUIET)


def _plane(columns: Columns, dt: Optional[float], width: float, height: float = 0) -> Tuple[Figure, Axes]:
    figure = _figure(width, height or width)
    axes = figure.subplots()
    real, imag = columns["real"], columns["imag"]
    finite = np.isfinite(real) & np.isfinite(imag)
    reach = float(np.abs(real[finite] + 1j * imag[finite]).max(initial=0.0)) or 1.0
    reach = max(1.0, reach) if dt else reach
    _grid(axes, dt, reach)
    room, unit = 1.08 * reach, "" if dt else " (1/s)"
    right = room if dt or real[finite].max(initial=0.0) > 0.3 * reach else 0.3 * reach
    axes.set(xlim=(-room, right), ylim=(-room, room), aspect="equal", xlabel=f"real part of {'z' if dt else 's'}{unit}",
             ylabel=f"imaginary part{unit}")  # fmt: skip
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(max(2, int(width / 16)), steps=[1, 2, 5, 10]))
    return figure, axes


def draw_poles(columns: Columns, loop: Linearization, width: float = 100.0) -> Figure:
    """The closed loop's poles: of s, or of z if it is sampled."""
    figure, axes = _plane(columns, loop.dt, width)
    axes.plot(columns["real"], columns["imag"], "x", color=LOOKS["phi"]["color"], ms=6)
    return figure


def draw_root_locus(columns: Columns, loop: Linearization, key: str, width: float = 110.0) -> Figure:
    """The poles at each value of a key, colored by it; crosses at its first value, circles at its last."""
    from scipy.optimize import linear_sum_assignment  # takes long to import

    figure, axes = _plane(columns, loop.dt, width, 1.14 * width)
    lines: List[Array] = []  # from each pole to the pole that it moves to at the next value
    colors: List[float] = []
    value, before = columns["value"], np.empty(0)
    for its in np.unique(value):
        now = (columns["real"] + 1j * columns["imag"])[value == its]
        if len(before) == len(now):
            from_pole, to_pole = linear_sum_assignment(np.abs(before[:, None] - now))
            ends = np.stack([before[from_pole], now[to_pole]], axis=1)
            lines += list(np.stack([ends.real, ends.imag], axis=2))
            colors += [its] * len(now)
        before = now
    points = axes.add_collection(LineCollection(lines, array=np.array(colors), cmap="viridis", lw=1.6, zorder=2))
    for end, shape in ((value[0], "x"), (value[-1], "o")):
        at = value == end
        axes.plot(columns["real"][at], columns["imag"][at], shape, color="black", ms=5, mfc="none", mew=0.8,
                  label=f"at {number(end)}")  # fmt: skip
    _legend(axes)
    figure.colorbar(points, ax=axes, location="bottom", aspect=40, fraction=0.05, label=cut(key, 0.8 * width, TEXT))
    return figure


def draw_step(columns: Columns, loop: Linearization, width: float = 135.0) -> Figure:
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


# Of one loop: numbers, picture, and what the rows are.
_PICTURES = {"bode": (bode, draw_bode, "frequencies"), "nyquist": (nyquist, draw_nyquist, "frequencies"),
             "poles": (poles, draw_poles, "poles"), "step": (step, draw_step, "times")}  # fmt: skip
KINDS = (*_PICTURES, "root_locus")


def _csv(columns: Columns) -> str:
    rows = zip(*(map(repr, column.tolist()) for column in columns.values()))
    return "\n".join([",".join(columns), *(",".join(row) for row in rows), ""])


def draw_loop(kind: str, rig: _bbsim.Given, locus: str, wide: Optional[float]) -> Tuple[str, Figure, str]:
    """The numbers as CSV, the figure, and what is in it. Raises InputError for a scenario without a loop."""
    width, loop = {"width": wide} if wide else {}, linearized(rig)
    if kind == "root_locus":
        key, _, between = locus.partition("=")
        bounds = between.partition(":")[::2]
        if not all((key, *bounds)):
            raise fault(f"root-locus: found {locus}; allowed: KEY=FROM:TO, such as controller.pd.kv.0.0=0.2:2")
        columns = root_locus(rig, key, bounds, _VALUES)
        return _csv(columns), draw_root_locus(columns, loop, key, **width), f"the poles at {_VALUES} values of {key}"
    numbers, picture, rows = _PICTURES[kind]
    columns = numbers(loop)
    return _csv(columns), picture(columns, loop, **width), f"{len(next(iter(columns.values())))} {rows}"


def draw_accuracy(text: str, title: str, wide: Optional[float]) -> Tuple[Any, int]:
    """The figure of a table of `bbsim accuracy --csv`, without runs that ended early; and its number of points."""
    points: Dict[str, List[Tuple[float, float]]] = {}
    for row in csv.DictReader(text.splitlines()):
        if row["status"] != "failed":
            # A logarithm has no zero. An error below all rounding can be zero.
            points.setdefault(row["method"], []).append((max(float(row["error_m"]), 1e-20), float(row["time_us"])))
    looks = {name: {**mark("o^sD"[i % 4], stroke(i)["color"], 3.5), **stroke(i)} for i, name in enumerate(points)}
    width = wide or 135.0
    height = 0.6 * (width - 19)
    sheet = Sheet(width, height + 14, title, "", list(looks.items()))
    axes = sheet.panel(Box(15.0, 4.8, width - 19, height), "processor time of a run (µs)")
    every = [point for method in points.values() for point in method]
    label = "error: largest |Δx|, |Δy| over the output times (m)"
    logarithmic(axes.xaxis, covered([error for error, _ in every]), label, air=0.04)
    logarithmic(axes.yaxis, covered([time for _, time in every]), air=0.06)
    for method, look in looks.items():
        axes.plot(*zip(*points[method]), **look)
    return sheet.figure, len(every)
