# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Many runs of one scenario, as arrays."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _bbsim
from ._scenario import Array, Columns, Scenario, Settings, as_yaml, given, listed, refuse

Cases = Union[Mapping[str, Any], Sequence[Mapping[str, Any]]]
Names = Union[str, Sequence[str]]


class Simulated(Columns):
    """The columns, measures and status of each case; ``made["x"]`` has a row for each case."""

    def __init__(self, made: Any, columns: Sequence[str], measures: Sequence[str]) -> None:
        super().__init__(dict(zip(columns, made[0])))
        self.measures: Dict[str, Array] = dict(zip(measures, made[1]))
        self.status: "np.ndarray[Any, np.dtype[np.str_]]" = np.array(made[2], dtype=np.str_)
        self.reason: List[str] = made[3]

    def __len__(self) -> int:
        return len(self.status)

    def __repr__(self) -> str:
        words, counts = np.unique(self.status, return_counts=True)
        ends = ", ".join(f"{count} {word}" for word, count in zip(words, counts))
        return f"<bbsim.Simulated {len(self)} cases ({ends}): {', '.join([*self.columns, *self.measures])}>"


def _numbers(what: str, values: Any) -> Array:
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise refuse(what, f"{values!r:.60}", "an array of numbers") from None


def _key(key: str, values: Any) -> Tuple[str, Array, List[str]]:
    """The name of a key, and its numbers or texts."""
    what = f"cases: {key}"
    if isinstance(values, (str, bytes, Mapping)) or not hasattr(values, "__len__"):
        raise refuse(what, f"{values!r:.60}", "an array or list with a value for each case")
    plain = isinstance(values, np.ndarray) or all(isinstance(one, (float, int)) for one in values)
    array = np.asarray(values) if plain else None
    if array is not None and array.ndim == 1 and array.dtype.kind in "fiu":
        return key, _numbers(what, array), []
    return key, np.empty(0), [as_yaml(one) for one in values]


def _keys(cases: Cases) -> Tuple[Optional[int], List[Any]]:
    """The number of cases, if the keys tell it, and their values."""
    if isinstance(cases, Mapping):
        keys = [_key(str(key), values) for key, values in cases.items()]
        lengths = [len(values) for values in cases.values()]
        return (lengths[0] if lengths else None), keys
    if isinstance(cases, (str, bytes)) or not all(isinstance(one, Mapping) for one in cases):
        raise refuse("cases", f"{cases!r:.60}", "{KEY: array}, or a list of {KEY: value}")
    names = dict.fromkeys(str(key) for one in cases for key in one)
    lists = {name: [one.get(name, "") for one in cases] for name in names}
    return len(cases), [_key(name, values) for name, values in lists.items()]


def simulate(
    scenario: Scenario, cases: Cases, columns: Names, times: Any = None, measures: Names = (), begin: Any = None,
    end: Any = None, start: Any = None, events: bool = True, *, set: Settings = None, threads: int = 0,
) -> Simulated:  # fmt: skip
    """Runs a scenario at many values of its keys; returns arrays.

    cases     {KEY: array of n values}, or a list of n dicts; {} if only begin, end or start differ
    times     one array of m times in s, or an array (n, m); by default the scenario's rows
    begin     n times from which the cases cover the scenario (s), and in ``end`` those until which they do
    start     an array (n, 9) of states at the begins: x, y, vx, vy, phi, theta, phi_rate, theta_rate, spin (SI)
    events    False: without the events that stop a run or only observe it

    A case that does not run to its end says why in ``status`` and ``reason``. Raises InputError.
    """
    count, keys = _keys(cases)
    parts = {"begin": begin, "end": end}
    arrays = {name: _numbers(name, () if value is None else value) for name, value in parts.items()}
    states = _numbers("start", np.empty((0, len(_bbsim.START))) if start is None else start)
    if states.ndim != 2 or states.shape[1] != len(_bbsim.START):
        raise refuse("start", f"an array of shape {states.shape}", f"(n, {len(_bbsim.START)}): {', '.join(_bbsim.START)}")
    at = None if times is None else _numbers("times", times)
    if at is not None and at.ndim not in (1, 2):
        raise refuse("times", f"an array of shape {at.shape}", "(m,), or (n, m) for n cases")
    if count is None:
        lists = [*arrays.values(), states] + ([at] if at is not None and at.ndim == 2 else [])
        count = max(len(one) for one in lists if one.ndim > 0) or 1
    for name, array in arrays.items():
        if array.ndim == 0:
            arrays[name] = np.full(count, array)
        elif array.ndim != 1:
            raise refuse(name, f"an array of shape {array.shape}", "(n,) for n cases")
    names, asked = listed(columns), listed(measures)
    windows = (at, arrays["begin"], arrays["end"], states, events)
    made = _bbsim.simulate(given(scenario, set), count, keys, names, asked, *windows, threads)
    return Simulated(made, names, asked)
