# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The exceptions of bbsim."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Iterable, List, Optional, Tuple

from . import _bbsim


class Error(Exception):
    """Any error of bbsim."""


@dataclass(frozen=True)
class Problem:
    """One fault of a scenario or an argument."""

    message: str
    """The key, what was found, and what is allowed."""
    place: str = ""
    """``file:line:column``, or the setting; empty for a dict."""
    key: Optional[str] = None
    """The path of the key, such as ``ball.radius``."""
    hint: str = ""
    """What to write instead."""

    def __str__(self) -> str:
        return f"{self.place}: {self.message}" if self.place else self.message


def _problem(place: str, message: str) -> Problem:
    if place.startswith("<dict>"):
        place = ""
    elif place.startswith("--set "):
        place = place[len("--set "):]
    message = message.removeprefix("--set ")
    key, hint = _bbsim.key_and_hint(message)
    return Problem(message, place, key or None, hint)


class InputError(Error, ValueError):
    """The scenario or an argument is wrong."""

    problems: List[Problem]
    """All problems, in the order of the scenario."""
    key: Optional[str]
    """The key of the first problem; None if no key is at fault."""
    hint: str
    """What to write instead, for the first problem."""

    def __init__(self, problems: Iterable[Tuple[str, str]]) -> None:
        self.problems = [_problem(place, message) for place, message in problems]
        super().__init__("\n".join(str(problem) for problem in self.problems))
        first = self.problems[0] if self.problems else Problem("")
        self.key = first.key
        self.hint = first.hint

    def __reduce__(self):  # type: ignore[no-untyped-def]
        return type(self), ([(p.place, p.message) for p in self.problems],)


def fault(text: str) -> InputError:
    return InputError([("", text)])


def refuse(what: str, found: object, allowed: str) -> InputError:
    return fault(f"{what}: found {found}; allowed: {allowed}")


class OutputError(Error, OSError):
    """A file could not be written."""


class ControllerError(Error, RuntimeError):
    """The scenario's controller failed; its exception is the cause (``__cause__``)."""
