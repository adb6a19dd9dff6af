# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""bbsim simulates a ball that rolls on a plate tilted about two axes.

    import bbsim
    result = bbsim.run("configs/fig2b.yaml", set={"ball.radius": "2 cm"})
    result["x"]        # a numpy array, in m
    result.plot()

A scenario is the path of a YAML file, YAML text, or a dict. All numbers are in SI units and radians.
"""

from __future__ import annotations

import importlib
import os
from numbers import Real
from typing import TYPE_CHECKING, Any, List, Mapping, Optional, Sequence, Union

import numpy as np

from . import _bbsim
from ._bbsim import Sample, __version__
from ._environments import Env, VectorEnv
from ._result import (Compared, Linearization, OpenLoop, Page, Result, Simulated, compare, examples, replay,
                      simulate)  # fmt: skip
from ._scenario import (ControllerError, Error, InputError, OutputError, Problem, Scenario, Settings, given, listed,
                        require, specification)  # fmt: skip

__all__ = [
    "Compared", "ControllerError", "Env", "Error", "InputError", "Linearization", "OpenLoop", "OutputError", "Page",
    "Problem", "Result", "Sample", "Simulated", "VectorEnv", "__version__", "check", "compare", "design", "examples",
    "fit", "linearize", "plot", "replay", "run", "simulate", "sweep", "tune",
]  # fmt: skip

if TYPE_CHECKING:
    from ._design import design
    from ._fit import fit
    from ._plot import plot
    from ._tune import tune
else:

    def __getattr__(name: str) -> Any:
        """Reads these on first use, because matplotlib and SciPy take longer to import than most runs take."""
        if name not in ("design", "fit", "plot", "tune"):
            raise AttributeError(f"module 'bbsim' has no attribute {name!r}")
        return getattr(importlib.import_module(f"bbsim._{name}"), name)


def __dir__() -> List[str]:
    return __all__


def run(scenario: Scenario, set: Settings = None, error: Union[float, str, None] = None, *,
        measures: Union[str, Sequence[str], None] = None, expect: Union[str, Sequence[str]] = (),
        output: Union[str, "os.PathLike[str]", None] = None) -> Result:  # fmt: skip
    """Runs a scenario; if an event stops it, the result has the rows until then.

    set       values of keys in place of the scenario's: ``{"ball.radius": "2 cm"}``; None removes a key
    error     bounds the error of x and y: 1e-9 (m) or "1 um"; replaces the scenario's tolerances
    measures  by default the usual ones of ``bbsim sweep``
    expect    conditions such as "max_tilt < 5 deg"
    output    a .csv or .h5 file that also gets the rows
    """
    asked = None if measures is None else listed("measures", measures)
    file = "" if output is None else os.fspath(output)
    return Result(_bbsim.run(given(scenario, set, error), asked, listed("expect", expect), file))


def check(scenario: Scenario, set: Settings = None) -> str:
    """What ``bbsim check`` prints: the model, gains, poles and margins. Raises InputError."""
    return _bbsim.check(given(scenario, set))


def linearize(
    scenario: Scenario, set: Settings = None, *, kind: Optional[str] = None, at: Union[str, float] = "home"
) -> Linearization:
    """The scenario as a linear system. `kind`: "plant", "loop" or "sampled"; `at`: "home", "equilibrium" or a time of
    the run, a number (s) or a text such as "2 s". Raises InputError."""
    at = at if isinstance(at, str) else f"{float(at)!r} s"
    return Linearization(_bbsim.linearize(given(scenario, set), kind, at))


def sweep(
    scenario: Scenario, vary: Optional[Mapping[str, Any]] = None,
    measures: Union[str, Sequence[str]] = (), *, set: Settings = None, error: Union[float, str, None] = None,
    combine: str = "", samples: Optional[int] = None, seed: Optional[int] = None, threads: int = 0,
    expect: Union[str, Sequence[str]] = (),
) -> "np.ndarray[Any, np.dtype[np.void]]":  # fmt: skip
    """Runs a scenario at many values of its keys; returns a structured array, one row per case.

    vary      {KEY: values}: a sequence, or a SPEC such as "linear:0:1:11" or "normal:0:2 mm"
    combine   "grid": all combinations (default); "zip": the first values together, then the second
    samples   the number of cases to draw for "uniform" and "normal"

    The fields are those of ``bbsim sweep``: case, the keys, status, reason, end_time, the measures, and 1 or 0 for each
    condition of ``expect``. Raises InputError.
    """
    its = require("vary", {} if vary is None else vary, Mapping, "a dict such as {'ball.radius': [0.01, 0.02]}")
    for what, found in (("samples", samples or 0), ("seed", seed or 0), ("threads", threads)):
        require(what, found, Real, "a whole number")
    drawn = ([(key, specification(values)) for key, values in its.items()], combine, samples, seed)
    texts = (listed("measures", measures), listed("expect", expect))
    made = _bbsim.sweep(given(scenario, set, error), *drawn, *texts, threads)
    fields = {name: np.array(its, np.str_) if isinstance(its, list) else its for name, its in made}
    fields["case"] = fields["case"].astype(np.int64)
    table = np.empty(len(fields["case"]), dtype=[(name, field.dtype) for name, field in fields.items()])
    for name, field in fields.items():
        table[name] = field
    return table
