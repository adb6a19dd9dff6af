# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The progress of work that takes longer than a second, on the terminal."""

from __future__ import annotations

import shutil
import sys
import time
from typing import Callable

Progress = Callable[[float, str], None]  # the fraction done, and a detail for people
_CLEAR = "\r\x1b[K"


def silent(fraction: float, detail: str = "") -> None:
    pass


def _time_text(seconds: float) -> str:
    if seconds > 7200:
        return f"{seconds / 3600:.1f} h"
    return f"{seconds / 60:.0f} min" if seconds > 120 else f"{seconds:.0f} s"


class Bar:
    """Draws a bar on standard error if that is a terminal; `with Bar(name, quiet) as progress: ...`."""

    def __init__(self, label: str, quiet: bool) -> None:
        self._label = label
        self._draws = not quiet and sys.stderr.isatty()
        self._start = self._last = time.monotonic()
        self._drawn = False

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: object) -> None:
        if self._drawn:
            sys.stderr.write(_CLEAR)
            sys.stderr.flush()

    def __call__(self, fraction: float, detail: str = "") -> None:
        now = time.monotonic()
        if not self._draws or now - self._start < 1 or now - self._last < 0.1:
            return
        self._last = now
        done = min(max(fraction, 0.0), 1.0)
        text = f" {100 * done:3.0f}%" + (f", {detail}" if detail else "")
        if done > 0.01:
            text += f", {_time_text((now - self._start) * (1 - done) / done)} left"
        length = min(30, shutil.get_terminal_size().columns - len(self._label) - len(text) - 5)
        if length >= 8:
            filled = int(done * length)
            text = f"{self._label} [{'#' * filled}{'.' * (length - filled)}]{text}"
        sys.stderr.write(_CLEAR + text.strip()[: shutil.get_terminal_size().columns - 1])
        sys.stderr.flush()
        self._drawn = True
