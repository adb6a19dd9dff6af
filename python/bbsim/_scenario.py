# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Scenarios: a path, YAML text or a dict."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Callable, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _bbsim
from ._errors import fault

Array = np.ndarray  # of numbers
Scenario = Union[str, "os.PathLike[str]", Mapping[str, Any]]
Settings = Optional[Mapping[str, Any]]


def _plain(value: Any) -> Any:
    """The value in the types of JSON: dicts, lists, texts, numbers, booleans and None."""
    if isinstance(value, (str, bool, int)) or value is None:
        return value
    if isinstance(value, (float, np.floating)):
        number = float(value)
        if not math.isfinite(number):  # the reader refuses these words of YAML and names the key
            return _Word(".nan" if math.isnan(number) else ".inf" if number > 0 else "-.inf")
        return number
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, (np.integer, np.bool_)):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Iterable):
        return [_plain(one) for one in value]
    raise TypeError(
        f"found {value!r} of type {type(value).__name__}; "
        "allowed: numbers, texts, lists, dicts, numpy arrays and None"
    )


class _Word(str):
    """A word to write without quotation marks."""


def _quoted(text: str) -> str:
    return json.dumps(_whole(text), ensure_ascii=False)


def _whole(text: str) -> str:
    try:
        text.encode()
    except UnicodeEncodeError:
        raise fault(f"found {text!r}, a part of a character; allowed: Unicode text") from None
    return text


def _text(plain: Any) -> str:
    if isinstance(plain, _Word):
        return str(plain)
    if isinstance(plain, dict):
        return "{" + ", ".join(f"{_quoted(key)}: {_text(one)}" for key, one in plain.items()) + "}"
    if isinstance(plain, list):
        return "[" + ", ".join(map(_text, plain)) + "]"
    return _quoted(plain) if isinstance(plain, str) else json.dumps(plain)


def as_yaml(value: Any) -> str:
    """The value as written after ``KEY=``: texts unchanged, everything else in YAML's flow style."""
    return _whole(value) if isinstance(value, str) else _text(_plain(value))


def _without_callable(scenario: Mapping[str, Any]) -> Tuple[Mapping[str, Any], Optional[Callable[..., Any]]]:
    """The dict with a library in place of its callable, which YAML cannot hold; and the callable."""
    controller = scenario.get("controller")
    if not isinstance(controller, Mapping) or "callable" not in controller:
        return scenario, None
    function = controller["callable"]
    if not callable(function):
        raise fault(f"controller.callable: found {function!r}; allowed: a callable")
    rest = {key: value for key, value in controller.items() if key != "callable"}
    laws = [key for key in ("program", "library") if key in rest]
    if laws:
        raise fault(f"controller.{laws[0]}: found beside callable; allowed: one law")
    name = getattr(function, "__qualname__", type(function).__qualname__)
    return {**scenario, "controller": {"library": {"file": f"Python: {name}"}, **rest}}, function


def overrides(settings: Settings) -> List[str]:
    """KEY=VALUE, as ``--set`` takes them."""
    if settings is not None and not isinstance(settings, Mapping):
        raise TypeError(f"set: found {settings!r}; allowed: a dict such as {{'ball.radius': '2 cm'}}")
    return [f"{key}={as_yaml(value)}" for key, value in (settings or {}).items()]


def listed(texts: Any) -> List[str]:
    """Texts of an option: one text or path, or several. A dict has what follows KEY=: a text, a tuple of two bounds,
    other values, or None for the key alone."""
    if texts is None:
        return []
    if isinstance(texts, (str, os.PathLike)):
        return [os.fspath(texts)]
    if not isinstance(texts, Mapping):
        return list(texts)
    return [f"{key}={_value(one)}" if one is not None else str(key) for key, one in texts.items()]


def _value(value: Any) -> str:
    if isinstance(value, tuple) and len(value) == 2:
        return ":".join(map(as_yaml, value))
    return as_yaml(value) if np.isscalar(value) else specification(value)


def given(scenario: Union[Scenario, _bbsim.Given], settings: Settings = None, error: Any = None) -> _bbsim.Given:
    """The scenario with settings. One that is already given stays as it is, and simulate() reads it only once."""
    if isinstance(scenario, _bbsim.Given):
        return scenario
    texts = overrides(settings)
    if error is not None:
        texts.append(f"solver.error={as_yaml(error)}")
    if isinstance(scenario, Mapping):
        plain, function = _without_callable(scenario)
        return _bbsim.Given("<dict>", _text(_plain(plain)), texts, function)
    name = os.fspath(scenario)
    if not isinstance(name, str):
        raise TypeError(f"found a scenario of type {type(scenario).__name__}; allowed: a path, YAML text or a dict")
    if isinstance(scenario, str) and ("\n" in name or name.lstrip().startswith("{")):
        return _bbsim.Given("<text>", _whole(name), texts, None)
    return _bbsim.Given(name, None, texts, None)


def specification(values: Union[str, Sequence[Any]]) -> str:
    """A key's values over a sweep, as ``bbsim sweep --vary KEY=`` takes them."""
    if isinstance(values, str):
        return values
    return "list:" + ",".join(map(as_yaml, [values] if np.isscalar(values) else values))
