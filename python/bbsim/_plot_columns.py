# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Which columns of runs share a panel, with their names and units there."""

from __future__ import annotations

from collections import namedtuple
from dataclasses import dataclass
from typing import Dict, List, Sequence

import numpy as np

from . import _bbsim
from ._plot_axes import Range, Unit, Units, covered, is_wide, width
from ._plot_sheet import ORANGE, Stroke, clean, mark, stroke
from ._scenario import fault

MAIN, REFERENCE, MEASURED, COMMAND = range(4)  # roles of columns
Known = namedtuple("Known", "name symbol unit panel heading role beside axis")  # what bbsim knows of a column


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
