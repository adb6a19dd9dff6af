# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the time that each method takes for its error."""

from __future__ import annotations

import csv
from typing import Any, Dict, List, Optional, Tuple

from ._plot_axes import covered, logarithmic
from ._plot_sheet import Sheet, mark, stroke


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
    box = (15.0, 4.8, width - 4, 4.8 + height)
    axes = sheet.panel(box, "processor time of a run (µs)")
    across = box[2] - box[0]
    every = [point for method in points.values() for point in method]
    label = "error: largest |Δx|, |Δy| over the output times (m)"
    logarithmic(axes.xaxis, covered([error for error, _ in every]), across, label, air=0.04)
    logarithmic(axes.yaxis, covered([time for _, time in every]), height, air=0.06)
    for method, look in looks.items():
        axes.plot(*zip(*points[method]), **look)
    return sheet.figure, len(every)
