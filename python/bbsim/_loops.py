# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Frequency responses, poles and step responses of a scenario's loop, as columns of numbers."""

from __future__ import annotations

import math
from typing import Callable, Dict, Optional, Sequence

import numpy as np

from . import _bbsim
from ._result import Linearization
from ._scenario import Array, Scenario, Settings, fault, given

Complex = np.ndarray
Columns = Dict[str, Array]

AXES = ("phi", "theta")


def linearized(scenario: Scenario, set: Settings = None) -> Linearization:
    """The closed loop about home. Raises InputError for a scenario without one."""
    return Linearization(_bbsim.linearize(given(scenario, set), "loop", "home"))


def rates(poles: Complex, dt: Optional[float]) -> Complex:
    """The poles in 1/s; with a period, s of z = exp(s dt)."""
    if not dt:
        return poles
    with np.errstate(divide="ignore"):
        return np.log(poles.astype(np.complex128)) / dt


def _responses(loop: Linearization, parts: Dict[str, Callable[[Complex], Array]]) -> Columns:
    """Frequencies, and parts of the open-loop response of each axis; nan for an axis without a loop."""
    at = loop._frequencies
    if not len(at):
        raise fault("found a scenario in which no command closes a loop; allowed: a controller that feeds back")
    lacking = np.full(len(at), np.nan * 1j)
    found = {axis: loop.open_loop(axis).response(at) if f"{axis}_command" in loop.margins else lacking for axis in AXES}
    return {"frequency": at, **{f"{axis}_{name}": part(found[axis]) for axis in AXES for name, part in parts.items()}}


def phase_of(response: Complex) -> Array:
    """The phase without jumps, rad; at the lowest frequency between -7/4 pi and pi/4."""
    phase = np.unwrap(np.angle(response))
    return phase - 2 * math.pi * np.round((phase[:1] + 0.75 * math.pi) / (2 * math.pi))


def bode(loop: Linearization) -> Columns:
    """Gain and phase of the open loops over the frequency. Raises InputError for a scenario without a loop."""
    return _responses(loop, {"gain": np.abs, "phase": phase_of})


def nyquist(loop: Linearization) -> Columns:
    """The same loops as complex numbers."""
    return _responses(loop, {"real": np.real, "imag": np.imag})


def poles(loop: Linearization) -> Columns:
    """The closed loop's poles. Those of a sampled loop are z; damping and frequency are those of s."""
    at = rates(loop.poles, loop.dt)
    size = np.abs(at)
    with np.errstate(invalid="ignore"):
        damping = np.where(np.isinf(size), 1.0, -at.real / size)
    return {"real": loop.poles.real, "imag": loop.poles.imag, "damping": damping, "frequency": size}


def root_locus(scenario: Scenario, set: Settings, key: str, bounds: Sequence[str], count: int) -> Columns:
    """A row for each pole of the closed loop at evenly spaced values of the key, between texts such as "2 cm"."""
    ends = [given(scenario, set).number_at(key, bound) for bound in bounds]
    if None in ends:
        raise fault(f"{key}: found {bounds[ends.index(None)]}; allowed: the bounds of a key that holds one number")
    values = np.linspace(ends[0], ends[1], count)
    found = [linearized(scenario, {**(set or {}), key: float(value)}).poles for value in values]
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
    columns = {"t": np.arange(count + 1) * period, "x": np.full(count + 1, np.nan), "y": np.full(count + 1, np.nan)}
    for output in ("x", "y"):
        if output in loop.outputs and f"{output}_reference" in loop.inputs:
            row, of = [loop.outputs.index(output)], [loop.inputs.index(f"{output}_reference")]
            system = (loop.A, loop.B[:, of], loop.C[row], loop.D[row][:, of])
            sampled = (*system, period) if loop.dt else cont2discrete(system, period)
            columns[output] = dlsim(sampled, np.ones(count + 1))[1][:, 0]
    return columns
