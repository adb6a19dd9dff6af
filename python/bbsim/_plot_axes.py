# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Units and axes that fit a range of values and keep labels short."""

from __future__ import annotations

import math
import re
from collections import Counter
from typing import Any, NamedTuple, Optional, Sequence, Tuple

import numpy as np
from matplotlib.ticker import (FixedFormatter, FixedLocator, FuncFormatter, LogLocator, MaxNLocator, NullLocator,
                               ScalarFormatter)  # fmt: skip

from ._plot_sheet import MM, SMALL, TEXT, cut, number

Range = Optional[Tuple[float, float]]  # the interval that finite values cover; None if there are none

_ROUNDING = 1e-9  # a range below this part of its values' size counts as rounding
_SMALLEST = 1e-290  # smaller values count as zero
CLOSE = 1e-3  # below this width relative to the values' size, labels need more than four digits to differ
_AUTO = {  # prefixes with their sizes, and the smallest value that takes each
    "m": [("n", 1e-9, 0), ("µ", 1e-6, 1e-7), ("m", 1e-3, 1e-4), ("c", 1e-2, 1e-2), ("", 1, 1), ("k", 1e3, 1e4)],
    "s": [("n", 1e-9, 0), ("µ", 1e-6, 1e-6), ("m", 1e-3, 1e-3), ("", 1, 0.1)],
    "N": [("n", 1e-9, 0), ("µ", 1e-6, 1e-6), ("m", 1e-3, 1e-3), ("", 1, 1), ("k", 1e3, 1e3), ("M", 1e6, 1e6)],
}
_AUTO.update({"m/s": _AUTO["m"], "N m": _AUTO["N"], "J": _AUTO["N"], "W": _AUTO["N"]})


def covered(*arrays: Any) -> Range:
    values = np.concatenate([np.empty(0), *(np.ravel(array) for array in arrays)], dtype=float)
    finite = values[np.isfinite(values)]
    return (float(finite.min()), float(finite.max())) if len(finite) else None


def width(range_: Range) -> float:
    return 0.0 if range_ is None else range_[1] - range_[0]


def largest(range_: Range) -> float:
    return 0.0 if range_ is None else max(abs(range_[0]), abs(range_[1]))


def is_wide(range_: Range) -> bool:
    """Whether the range is wider than the rounding of its values."""
    return range_ is not None and range_[1] / 2 - range_[0] / 2 > max(_ROUNDING / 2 * largest(range_), _SMALLEST)


class Unit(NamedTuple):
    """The unit in which a quantity is drawn: times `factor`, a value in SI has it. Empty for a plain number."""

    text: str = ""
    factor: float = 1.0
    prefix: Optional[str] = None  # the scenario's own; None: chosen by the size of the values


class Scale(NamedTuple):
    """The drawn value is (value - offset) * factor."""

    factor: float = 1.0
    offset: float = 0.0
    unit: str = ""
    shift: str = ""  # follows the quantity's name: " − 0.1 m"

    def __call__(self, values: Any) -> Any:
        return (np.asarray(values, float) - self.offset) * self.factor

    def of(self, range_: Range) -> Range:
        return None if range_ is None else (float(self(range_[0])), float(self(range_[1])))

    def heading(self, name: str) -> str:
        return f"{name}{self.shift}" + (f" ({self.unit})" if self.unit else "")


class Units:
    """How a scenario writes lengths and angles."""

    def __init__(self, text: str = "") -> None:
        text = re.sub("#.*", "", text)
        lengths = Counter(re.findall(r"\d\s*([mc]?)m\b(?!/s\^2)", text)).most_common(1)
        self.prefix = lengths[0][0] if lengths else None
        self.degrees = not re.search(r"\d\s*rad\b", text) or bool(re.search(r"\d\s*deg\b", text))

    def drawn(self, unit: str, turns: bool = False) -> Unit:
        """The unit in which values in an SI unit are drawn; `turns` stay in radians."""
        if unit in ("rad", "rad/s", "rad/s^2"):
            superscript = unit.replace("^2", "²")
            in_degrees = self.degrees and (not turns or unit == "rad/s^2")
            return Unit(superscript.replace("rad", "°"), 180 / math.pi) if in_degrees else Unit(superscript)
        return Unit("" if unit == "1" else unit, 1.0, self.prefix if unit in ("m", "m/s") else None)


def power_of_ten(exponent: int) -> str:
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def _prefixed(unit: Unit, most: float) -> Scale:
    """The scale for values of at most this size. Adds a power of ten if labels would still be long."""
    if most < _SMALLEST and unit.text == "m":
        most = 0.1  # zero lengths: centimeters suit a plate
    if most < _SMALLEST:
        return Scale(unit.factor, 0.0, unit.text)
    prefixes = _AUTO.get(unit.text, [("", 1, 0)])
    prefix, size, _ = [entry for entry in prefixes if most >= entry[2]][-1]
    for own, its, _ in prefixes:
        if own == unit.prefix and 0.5 <= most / its < 1e4:
            prefix, size = own, its
    factor = unit.factor / size
    if 1e-2 <= most * factor < 1e5:
        return Scale(factor, 0.0, prefix + unit.text)
    exponent = math.floor((math.log10(most) + math.log10(factor)) / 3) * 3
    # In two factors, because one could overflow.
    factor = factor * 10.0 ** (-exponent // 2) * 10.0 ** (-exponent - -exponent // 2)
    return Scale(factor, 0.0, f"{power_of_ten(exponent)} {prefix}{unit.text}".rstrip())


def _shifted(unit: Unit, range_: Tuple[float, float], wide: float) -> Scale:
    """A scale whose labels are differences from a round value near the middle of the range."""
    scale = _prefixed(unit, wide)
    step = 10.0 ** math.ceil(math.log10(wide * unit.factor))
    middle = round((range_[0] / 2 + range_[1] / 2) * unit.factor / step) * step
    shift = (" + " if middle < 0 else " − ") + f"{number(abs(middle), 12)} {unit.text}".rstrip()
    return Scale(scale.factor, middle / unit.factor, scale.unit, shift)


def choose_scale(unit: Unit, range_: Range, close: float = CLOSE) -> Scale:
    """The scale for values in SI; differences from a round value if they are `close` together."""
    if range_ is not None and is_wide(range_) and width(range_) <= close * largest(range_):
        return _shifted(unit, range_, width(range_))
    return _prefixed(unit, largest(range_))


def choose_scales(unit: Unit, x: Range, y: Range) -> Tuple[Scale, Scale]:
    """The scales of the two axes of a plane, with the same factor."""
    wide, size = max(width(x), width(y)), max(largest(x), largest(y))
    far = [range_ is not None and wide <= CLOSE * largest(range_) for range_ in (x, y)]
    if wide <= _ROUNDING * size or not any(far):
        return (_prefixed(unit, size),) * 2
    of_x, of_y = (_shifted(unit, its, wide) if off and its else _prefixed(unit, wide) for its, off in zip((x, y), far))
    return of_x, of_y


def linear_limits(range_: Range, air: float = 0.06) -> Tuple[float, float]:
    """The ends of an axis over a range, with free space at both."""
    if range_ is None:
        return 0.0, 1.0
    constant = largest(range_) / 2 if largest(range_) > _SMALLEST else 1.0  # with its value in the middle
    more = air * width(range_) if is_wide(range_) else constant
    return range_[0] - more, range_[1] + more


def _millimeters(axis: Any) -> float:
    size = axis.axes.bbox.width if axis.axis_name == "x" else axis.axes.bbox.height
    return float(size / axis.figure.dpi / MM)


def _most_ticks(axis: Any) -> float:
    return _millimeters(axis) / (11 if axis.axis_name == "x" else 4.5)


def _set(axis: Any, low: float, high: float, locator: Any, formatter: Any, label: str, numbered: bool) -> None:
    getattr(axis.axes, f"set_{axis.axis_name}lim")(low, high)
    axis.set_major_locator(locator)
    axis.set_major_formatter(formatter)
    axis.set_minor_locator(NullLocator())
    if not numbered:
        axis.set_tick_params(labelbottom=False, labelleft=False)
    elif label:
        axis.set_label_text(cut(label, _millimeters(axis), TEXT))


def linear(axis: Any, low: float, high: float, label: str = "", *, numbered: bool = True, whole: bool = False) -> None:
    """An axis with round ticks, or ticks at whole numbers."""
    locator = MaxNLocator(max(2, min(9, int(1.4 * _most_ticks(axis)))), steps=[1, 2, 5, 10], integer=whole)
    formatter = ScalarFormatter(useOffset=False)
    formatter.set_scientific(False)
    _set(axis, low, high, locator, formatter, label, numbered)


def _of_decade(value: float, _: int) -> str:
    exponent = math.floor(math.log10(value) + 1e-9)
    mantissa, ten = round(value / 10.0**exponent), power_of_ten(exponent)
    return number(value) if -3 <= exponent <= 3 else ten if mantissa == 1 else f"{mantissa}·{ten}"


def logarithmic(axis: Any, range_: Range, label: str = "", *, air: float = 0.0, numbered: bool = True) -> None:
    """An axis over positive values, with ticks at decades, and between them if there is room."""
    low, high = range_ or (1.0, 10.0)
    more = (high / low) ** air if is_wide(range_) else 2.0
    low, high = low / more, high * more
    most, decades = _most_ticks(axis), math.log10(high) - math.log10(low)
    within = (1, 2, 5) if 3 * decades <= most else (1, 3) if 2 * decades <= most else (1,)
    getattr(axis.axes, f"set_{axis.axis_name}scale")("log")
    _set(axis, low, high, LogLocator(subs=within, numticks=max(2, int(most))), FuncFormatter(_of_decade), label, numbered)


def fitted(axis: Any, log: bool, range_: Range, label: str = "", *, air: float = 0.0, numbered: bool = True) -> None:
    """A logarithmic or a linear axis over a range."""
    if log:
        logarithmic(axis, range_, label, air=air, numbered=numbered)
    else:
        linear(axis, *linear_limits(range_, air), label, numbered=numbered)


def words(axis: Any, texts: Sequence[str], label: str, numbered: bool = True) -> None:
    """An axis with a text at each whole number."""
    room = 0.9 * _millimeters(axis) / len(texts) if axis.axis_name == "x" else 9.0
    formatter = FixedFormatter([cut(text, room, SMALL) for text in texts])
    _set(axis, -0.5, len(texts) - 0.5, FixedLocator(range(len(texts))), formatter, label, numbered)
