# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np

_Array = np.ndarray[Any, np.dtype[np.float64]]
_Pair = Tuple[float, float]

__version__: str

class Given:
    def __init__(
        self, name: str, text: Optional[str], overrides: Sequence[str], callable: Optional[Callable[..., Any]]
    ) -> None: ...

class Sample:
    """What a callable controller receives, in SI units and radians."""

    sample: int
    t: float
    ball: Optional[_Pair]
    reference: _Pair
    reference_rate: _Pair
    reference_acceleration: _Pair
    servo: _Pair
    servo_rate: _Pair
    def __getitem__(self, name: str) -> Any: ...

class Run:
    columns: List[str]
    units: List[str]
    unmet: List[str]
    measures: List[Tuple[str, float]]
    warnings: List[str]
    title: str
    status: str
    reason: str
    def column(self, name: str) -> _Array: ...
    def summary(self) -> str: ...

class SweepChoice:
    def __init__(
        self,
        vary: Sequence[Tuple[str, str]],
        combine: str,
        samples: Optional[float],
        seed: Optional[float],
        measures: Sequence[str],
    ) -> None: ...

class SweepColumn:
    name: str
    unit: str
    is_text: bool
    texts: List[str]
    numbers: _Array

class Sweep:
    engine: str
    columns: List[SweepColumn]

class CaseKey:
    def __init__(self, key: str, numbers: _Array, texts: Sequence[str]) -> None: ...

class CasesAsked:
    def __init__(
        self,
        count: int,
        keys: Sequence[CaseKey],
        columns: Sequence[str],
        measures: Sequence[str],
        times: Optional[_Array],
        begin: _Array,
        end: _Array,
        start: _Array,
        events: bool,
    ) -> None: ...

class CasesResult:
    times: int
    status: List[str]
    reason: List[str]
    def column(self, place: int) -> _Array: ...
    def measure(self, place: int) -> _Array: ...

START: List[str]

class LinearSystem:
    A: _Array
    B: _Array
    C: _Array
    D: _Array
    dt: Optional[float]
    states: List[Tuple[str, str]]
    inputs: List[Tuple[str, str]]

class Linearized:
    A: _Array
    B: _Array
    C: _Array
    D: _Array
    dt: Optional[float]
    states: List[Tuple[str, str]]
    inputs: List[Tuple[str, str]]
    outputs: List[Tuple[str, str]]
    kind: str
    at: str
    note: str
    def open_loop(self, command: str) -> Optional[LinearSystem]: ...
    def json(self) -> str: ...
    def report(self) -> str: ...

class Beginnings:
    def __init__(self, which: Sequence[int], values: Sequence[Sequence[str]], seeds: Sequence[int]) -> None: ...

class Environments:
    columns: List[List[str]]
    command_unit: str
    limits: Tuple[Optional[float], Optional[float]]
    observations: _Array
    terminated: np.ndarray[Any, np.dtype[np.bool_]]
    truncated: np.ndarray[Any, np.dtype[np.bool_]]
    costs_of_ending: _Array
    def __init__(self, given: Given, count: int, keys: Sequence[str], keeps_rows: bool) -> None: ...
    def begin(self, these: Beginnings) -> None: ...
    def step(self, commands: _Array, these: Beginnings) -> None: ...
    def result(self, which: int) -> Optional[Run]: ...
    in_lanes: int

def run(given: Given, measures: Optional[Sequence[str]], expect: Sequence[str], output: str) -> Run: ...
def check(given: Given) -> str: ...
def linearize(given: Given, kind: Optional[str], at: str) -> Linearized: ...
def sweep(given: Given, choice: SweepChoice, threads: float) -> Sweep: ...
def simulate(given: Given, asked: CasesAsked, threads: float) -> CasesResult: ...
def frequencies(poles: Sequence[complex], closed: Sequence[complex], period: float) -> List[float]: ...
def number_at(given: Given, key: str, value: str) -> Optional[float]: ...
def key_and_hint(message: str) -> Tuple[str, str]: ...
