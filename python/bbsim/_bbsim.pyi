# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple

import numpy as np

_Array = np.ndarray[Any, np.dtype[np.float64]]
_Pair = Tuple[float, float]

__version__: str

class Given:
    name: str
    def __init__(
        self, name: str, text: Optional[str], overrides: Sequence[str], callable: Optional[Callable[..., Any]]
    ) -> None: ...
    def changed(self, settings: Sequence[Tuple[str, str]]) -> Given: ...

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
def sweep(given: Given, choice: SweepChoice, expect: Sequence[str], threads: float) -> Sweep: ...
def simulate(given: Given, asked: CasesAsked, threads: float) -> CasesResult: ...
def frequencies(poles: Sequence[complex], closed: Sequence[complex], period: float) -> List[float]: ...
def number_at(given: Given, key: str, value: str) -> Optional[float]: ...
def key_and_hint(message: str) -> Tuple[str, str]: ...

def accuracy(given: Given, rtols: str) -> Tuple[str, str]: ...

class StoredEvent:
    name: str
    stopped: bool
    t: float
    x: float
    y: float

class Stored:
    file: str
    shown_file: str
    rows: int
    names: List[str]
    title: str
    status: str
    end_time: Optional[float]
    events: List[StoredEvent]
    units_known: bool
    has_end_row: bool
    is_sweep: bool
    scenario_text: str
    plate: List[float]
    friction: Optional[float]
    command_unit: Optional[str]
    sampled: Optional[bool]
    def __init__(self, columns: Sequence[Tuple[str, str, _Array, List[str]]], summary: str) -> None: ...
    def unit(self, name: str) -> str: ...
    def is_text(self, name: str) -> bool: ...
    def numbers(self, name: str) -> _Array: ...

class SweepKey:
    name: str
    labels: List[str]
    unit: str
    drawn: bool
    leader: int
    values: _Array
    distinct: _Array

class SweepTable:
    keys: List[SweepKey]
    status: List[str]
    others: List[Tuple[str, int]]
    measures: List[str]
    def followers(self, key: SweepKey) -> List[str]: ...

class Outputs:
    def __init__(self) -> None: ...
    def reads(self, file: str, what: str) -> None: ...
    def writes(self, file: str, what: str) -> None: ...
    def reads_with(self, result: Stored) -> None: ...

def read_result(
    file: str, summary: str, scenario: str, overrides: Sequence[str],
    maps: Sequence[str], header: Sequence[str], period: str, time_offset: str, missing: str,
) -> Tuple[Stored, List[str]]: ...  # fmt: skip
def sweep_table(stored: Stored) -> SweepTable: ...
def known_columns(command_unit: str) -> List[Tuple[str, str, str, int, str, int, str, int]]: ...
def measure_unit(name: str) -> Tuple[str, str]: ...
def nearest(word: str, names: Sequence[str]) -> str: ...
def summary_beside(file: str) -> str: ...
def require_mark(target: str, what: str, mark: str) -> None: ...
def write_file(target: str, content: bytes) -> None: ...
def printable(text: str) -> str: ...
def end_at_signals() -> None: ...

class KeyFacts:
    """A key that takes a number: its value (SI) in the scenario, else its default; and its range."""

    name: str
    unit: str
    value: Optional[float]
    lower: float
    upper: float
    positive: bool

def key_facts(given: Given, option: str, key: str) -> KeyFacts: ...
def value_in(text: str, unit: str) -> Optional[float]: ...
def text_at(given: Given, key: str) -> str: ...
def has(given: Given, key: str) -> bool: ...
def rig_limits(given: Given) -> List[List[Optional[float]]]: ...  # of each axis: command, servo angle and rate
def remarks(given: Given) -> List[str]: ...
def begins_anywhere(given: Given) -> bool: ...
def edited(given: Given, settings: Sequence[Tuple[str, str]], comments: str, reads: bool) -> str: ...
def tables(given: Given) -> List[Tuple[str, str]]: ...
def lacks(given: Given, column: str) -> Tuple[str, str]: ...
def unit_doubt(column: str, largest: float) -> str: ...
def read_log(
    file: str, maps: Sequence[str], header: Sequence[str], period: str, time_offset: str, missing: str
) -> Tuple[Stored, List[str]]: ...

class Drawn:
    """Cases of `vary`: for each key, numbers (SI) or texts."""

    count: int
    names: List[str]
    units: List[str]
    draws: bool
    def numbers(self, place: int) -> _Array: ...
    def texts(self, place: int) -> List[str]: ...

def without_notes(given: Given, keys: Sequence[str], measures: Sequence[str]) -> Given: ...
def drawn(given: Given, vary: Sequence[str], samples: Optional[float], seed: float) -> Drawn: ...

class Expectation:
    text: str
    value: float
    measure: str
    unit: str
    upper: bool
    of_loop: bool
    def holds(self, measured: float) -> bool: ...

def expectation(given: Given, option: str, text: str) -> Expectation: ...
def measure_name(given: Given, option: str, name: str) -> Tuple[str, str]: ...
def filled_page(template: str, title: str, json: str) -> str: ...
def short_number(value: float) -> str: ...
def rounded(value: float, digits: int) -> str: ...

class LogOptions:
    def __init__(
        self, maps: Sequence[str], header: Sequence[str], period: str, time_offset: str, missing: str
    ) -> None: ...

class Page:
    html: str
    reason: str
    notes: List[str]

def replay(
    shown: Sequence[Any], logs: Sequence[str], log: LogOptions, summary: str, scenario: str,
    overrides: Sequence[str], title: str, output: str,
) -> Page: ...  # fmt: skip

class Compared:
    alike: bool
    reason: str
    text: str
    warnings: List[str]

def compare(
    a: str, b: str, overrides: Sequence[str], rtol: Optional[float], atol: Optional[float],
    columns: Sequence[str], log: LogOptions,
) -> Compared: ...  # fmt: skip
