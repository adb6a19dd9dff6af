# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""What fit, tune and design write: a report, its JSON, and a scenario with the numbers that they found."""

from __future__ import annotations

import json
import math
import os
import sys
from typing import Any, Dict, List, Sequence

from . import _bbsim


def aligned(lines: Sequence[Sequence[str]]) -> str:
    """A table: the first field of each line to the left, the others to the right."""
    widths = [max(map(len, column)) for column in zip(*lines)]
    texts = []
    for first, *rest in lines:
        texts.append(first.ljust(widths[0]) + "".join("  " + one.rjust(n) for one, n in zip(rest, widths[1:])))
    return "".join(text.rstrip() + "\n" for text in texts)


def _plain(value: Any) -> Any:
    """JSON has no numbers that are not finite."""
    if isinstance(value, dict):
        return {key: _plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def as_json(value: Dict[str, Any]) -> str:
    return json.dumps(_plain(value), indent=2, ensure_ascii=False) + "\n"


def reports(options: Dict[str, Any], *others: str) -> bool:
    """Whether the report goes to standard output: no file does."""
    return "-" not in [options[name] for name in ("output", "json", *others)]


def declare(options: Dict[str, Any], reads: Dict[str, str], *others: str) -> None:
    """Refuses files that would overwrite each other or an input. `others`: more options that name a file."""
    outputs = _bbsim.Outputs()
    for file, what in reads.items():
        outputs.reads(file, what)
    for name in ("output", "json", *others):
        if options[name]:
            outputs.writes(options[name], "-o" if name == "output" else f"--{name}")
    if reports(options, *others):
        outputs.writes("-", "the report")


def write(target: str, text: str) -> None:
    _bbsim.write_file(target, text.encode())


def write_found(given: _bbsim.Given, options: Dict[str, Any], scenario: str, json_text: str, say: Any) -> None:
    """Writes the files that the options ask for."""
    output = options["output"]
    if output:
        write(output, scenario)
        folders: List[str] = [os.path.dirname(os.path.abspath(file)) for file in (output, given.name)]
        if output != "-" and folders[0] != folders[1] and _bbsim.tables(given):
            say(f"note: {output} is not in the scenario's folder, from which its tables are read; move it there to "
                "run it")  # fmt: skip
    if options["json"]:
        write(options["json"], json_text)


def print_report(report: str, options: Dict[str, Any], *others: str) -> None:
    """Unless a file goes to standard output."""
    if reports(options, *others):
        sys.stdout.write(report)
        sys.stdout.flush()
