# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The look of bbsim's pictures: a figure with boxes in millimeters, texts that fit, strokes, legends."""

from __future__ import annotations

import contextlib
import functools
import io
import math
import re
import warnings
from typing import Any, Dict, Iterator, List, NamedTuple, Sequence, Tuple

import matplotlib
from matplotlib import font_manager, ft2font
from matplotlib.axes import Axes
from matplotlib.figure import Figure as _Figure
from matplotlib.lines import Line2D

from ._scenario import refuse

MM = 1 / 25.4  # inches
TITLE, TEXT, SMALL = 9.5, 8.0, 7.0  # points
FONT = "DejaVu Sans"  # comes with matplotlib, and has Greek letters, superscripts and arrows

Stroke = Dict[str, Any]  # of Line2D
Legend = Sequence[Tuple[str, Stroke]]


class Box(NamedTuple):
    """mm from the left, and from below the heading; width and height."""

    left: float
    top: float
    across: float
    up: float


_STYLE = {
    "text.parse_math": False,  # texts are the user's
    "text.color": "#202020", "axes.labelcolor": "#202020", "axes.edgecolor": "#404040",
    "xtick.color": "#404040", "ytick.color": "#404040", "xtick.labelcolor": "#202020", "ytick.labelcolor": "#202020",
    "font.size": TEXT, "axes.labelsize": TEXT, "legend.fontsize": SMALL,
    "xtick.labelsize": SMALL, "ytick.labelsize": SMALL, "axes.labelpad": 2.0,
    "axes.linewidth": 0.6, "xtick.major.width": 0.6, "ytick.major.width": 0.6,
    "xtick.major.size": 2.5, "ytick.major.size": 2.5, "xtick.major.pad": 2.0, "ytick.major.pad": 2.0,
    "axes.spines.top": False, "axes.spines.right": False, "axes.axisbelow": True, "axes.titley": 1.0,  # else sought
    "axes.grid": True, "grid.color": "#e4e4e4", "grid.linewidth": 0.5,
    "path.simplify": True, "path.simplify_threshold": 1 / 9,  # of a pixel: millions of rows keep their extremes
    "lines.linewidth": 1.1, "lines.markersize": 4.0, "lines.solid_capstyle": "round",
    "svg.fonttype": "none", "svg.hashsalt": "bbsim", "pdf.fonttype": 42, "savefig.dpi": 200,
}  # fmt: skip


@contextlib.contextmanager
def style(font: str) -> Iterator[None]:
    """bbsim's look instead of the user's settings."""
    with matplotlib.rc_context(), warnings.catch_warnings():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(_STYLE)
        matplotlib.rcParams["font.family"] = [font] if font == FONT else [font, FONT]
        warnings.filterwarnings("ignore", message="Glyph .* missing")  # shown as a box
        yield


@functools.lru_cache(maxsize=None)
def _face(font: str) -> Any:
    path = font_manager.findfont(font_manager.FontProperties(family=[font]), fallback_to_default=False)
    return font_manager.get_font(path)


def require_font(font: str) -> None:
    try:
        _face(font)
    except ValueError:
        raise refuse("font", font, f"a font that matplotlib finds, such as {FONT}") from None


class Figure(_Figure):
    """A matplotlib figure that notebooks show, and that is saved in bbsim's look."""

    bbsim_font = FONT

    def savefig(self, file: Any, **options: Any) -> None:
        with style(self.bbsim_font):
            super().savefig(file, **options)

    def _repr_svg_(self) -> str:
        drawn = io.StringIO()
        self.savefig(drawn, format="svg", metadata={"Date": None})
        return drawn.getvalue()


def clean(text: str) -> str:
    """One line that every format can hold, without characters that hide or turn others."""
    text = re.sub("[\0-\x1f\x7f-\x9f\u2028\u2029]+", " ", text).strip()
    hostile = "\u200b-\u200f\u202a-\u202e\u2066-\u2069\ufdd0-\ufdef\ufeff\ufffe\uffff\ud800-\udfff"
    return re.sub(f"[{hostile}]", "\ufffd", text)


def width_of(text: str, size: float) -> float:
    """The width of a text, mm."""
    face = _face(matplotlib.rcParams["font.family"][0])
    face.set_size(size, 72)
    face.set_text(text, 0.0, flags=ft2font.LOAD_NO_HINTING)
    return float(face.get_width_height()[0]) / 64 / 72 / MM


def cut(text: str, room: float, size: float) -> str:
    """The cleaned text, shortened to the room (mm) with … in the middle: names differ at either end."""
    text = clean(text)
    if width_of(text, size) <= room:
        return text
    kept = (text[: keep - keep // 2] + "…" + text[len(text) - keep // 2 :] for keep in range(len(text) - 1, 0, -1))
    return next((short for short in kept if width_of(short, size) <= room), "…")


def number(value: float, digits: int = 4) -> str:
    return f"{value:.{digits}g}".replace("-", "−")


# Distinct with any color vision (Okabe and Ito's palette). Dashes distinguish lines without color.
_COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]
_DASHES = ["-", (0, (4, 1.5)), (0, (1, 1.2)), (0, (5, 1.2, 1, 1.2))]
BAND: Stroke = {"color": "#d0d0d0", "lw": 3.5}  # of references
ORANGE = "#d55e00"


def stroke(index: int) -> Stroke:
    return {"color": _COLORS[index % len(_COLORS)], "lw": 1.1, "ls": _DASHES[index % len(_DASHES)]}


def mark(shape: str, color: str = "#000000", size: float = 4.5) -> Stroke:
    """A marker without a line; `shape` with a leading blank is hollow."""
    face = "none" if shape.startswith(" ") else color
    return {"color": color, "ls": "none", "marker": shape.strip(), "ms": size, "mfc": face, "mew": 0.9}


class Sheet:
    """A figure with a heading, and boxes below it. Make and use it within style()."""

    _ROW, _LINE, _PAD, _GAP = 3.7, 5.0, 1.0, 4.0  # mm: of a legend: a row, a line's sample, beside it, between names
    _SAMPLE = _LINE + _PAD

    def __init__(self, width: float, height: float, title: str, subtitle: str = "", legend: Legend = ()) -> None:
        self.width, room = width, width - 8
        names = [cut(name, room - self._SAMPLE, SMALL) for name, _ in legend]
        widest = max((width_of(name, SMALL) for name in names), default=0.0) + self._SAMPLE + self._GAP
        columns = max(1, min(int((room + self._GAP) / widest), len(names)))
        rows = math.ceil(len(names) / columns)
        top, lines = 2.0, []
        for text, size, color, step in ((title, TITLE, "#202020", 5.2), (subtitle, SMALL, "#505050", 4.0)):
            if clean(text):
                lines.append((top, cut(text, room, size), size, color))
                top += step
        self._heading = top + (rows * self._ROW + 1.5 if rows else 0.5)
        self.height = self._heading + height
        self.figure = Figure(figsize=(width * MM, self.height * MM), facecolor="white")
        self.figure.bbsim_font = matplotlib.rcParams["font.family"][0]
        for at, text, size, color in lines:
            self.figure.text(0.5, 1 - at / self.height, text, ha="center", va="top", size=size, color=color)
        if names:
            self._legend(self.figure, legend, names, columns, "upper center", (0.5, 1 - top / self.height))

    def _legend(self, owner: Any, legend: Legend, names: List[str], columns: int, where: str, anchor: Any) -> None:
        em, handles = SMALL / 72 / MM, [Line2D([], [], **line) for _, line in legend]
        owner.legend(handles, names, ncol=columns, loc=where, bbox_to_anchor=anchor, frameon=False, borderpad=0,
                     borderaxespad=0, handlelength=self._LINE / em, handletextpad=self._PAD / em,
                     columnspacing=self._GAP / em, labelspacing=0.35, numpoints=1)  # fmt: skip

    def axes(self, box: Box) -> Axes:
        corner = box.left / self.width, 1 - (self._heading + box.top + box.up) / self.height
        return self.figure.add_axes([*corner, box.across / self.width, box.up / self.height])

    def panel(self, box: Box, heading: str, legend: Legend = ()) -> Axes:
        """Axes with a heading above their left corner, and a legend in one row beside it."""
        axes, width = self.axes(box), box.across
        heading = cut(heading, width * (0.55 if legend else 1), TEXT)
        axes.text(-0.5 / width, 1 + 1.4 / box.up, heading, transform=axes.transAxes, size=TEXT, va="baseline", ha="left")
        if legend:
            room = width - width_of(heading, TEXT) - len(legend) * (self._SAMPLE + self._GAP)
            widths = [width_of(clean(name), SMALL) for name, _ in legend]
            most = max(widths)
            while sum(min(need, most) for need in widths) > room and most > 3:  # cuts the longest names until all fit
                most *= 0.95
            names = [cut(name, most, SMALL) for name, _ in legend]
            self._legend(axes, legend, names, len(names), "lower right", (1, 1 + 1.2 / box.up))
        return axes
