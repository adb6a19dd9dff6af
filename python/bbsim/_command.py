# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""The commands that are written in Python: their options, from commands.json, and their exit codes."""

from __future__ import annotations

import argparse
import functools
import importlib
import json
import logging
import math
import re
import signal
import sys
from pathlib import Path
from typing import Any, Dict, List, NoReturn, Optional, Sequence

from . import _bbsim
from ._scenario import ControllerError, InputError, OutputError, fault

_ENDED_EARLY, _INPUT_AT_FAULT, _OUTPUT_FAILED, _INTERRUPTED = 1, 2, 3, 130


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise fault(f"{message}\nRun {self.prog} --help for more information.")


def _number(option: Dict[str, Any], text: str) -> float:
    """An option's number: a whole one from option["whole"] on, if the option has that."""
    least = option.get("whole")
    try:
        number = float(text) if least is None else int(text)
    except ValueError:
        number = math.nan
    if math.isfinite(number) and (least is None or number >= least):
        return number
    name, allowed = option["names"].split(",")[-1], "a number" if least is None else f"a whole number from {least} up"
    raise fault(f"{name}: found {text}; allowed: {allowed}")


def _parsed(name: str, table: Dict[str, Any], words: Sequence[str]) -> Dict[str, Any]:
    parser = _Parser(prog=f"bbsim {name}", description=table["description"], epilog=table["footer"],
                     allow_abbrev=False, formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    quiet = "print results and the reason why a run ended early; no messages, no progress"
    parser.add_argument("-q", "--quiet", action="store_true", help=quiet)
    known = ["quiet", "help"]
    for option in table["options"]:
        names = option["names"].split(",")
        known.append(names[-1].lstrip("-"))
        how: Dict[str, Any] = {"help": option["help"].replace("%", "%%")}
        if option.get("flag"):
            how["action"] = "store_true"
        elif not names[0].startswith("-"):
            how.update(metavar=names[0], nargs="+" if option.get("repeatable") else None)
            names = [names[0].lower()]
        else:
            how.update(metavar=option["takes"], choices=option.get("choices"), required=option.get("required", False))
            how.update({"action": "append", "default": []} if option.get("repeatable") else {})
        option["keyword"] = parser.add_argument(*names, **how).dest
    parsed, rest = parser.parse_known_intermixed_args(words)
    for word in rest:
        word = word.split("=")[0]
        near = _bbsim.nearest(word.lstrip("-"), known)
        parser.error(f"unknown option {word} of bbsim {name}" + (f"; did you mean --{near}?" if near else ""))
    values = vars(parsed)
    for key, value in values.items():
        if "" in (value if isinstance(value, list) else [value]):
            parser.error(f"--{key}: found nothing; allowed: a value, or leave the option out")
    for option in table["options"]:
        keyword = option["keyword"]
        if ("whole" in option or option.get("number")) and values[keyword] is not None:
            values[keyword] = _number(option, values[keyword])
    return values


def _say(text: str) -> None:
    # In one piece, so that other processes cannot split the message.
    sys.stderr.write(_bbsim.printable(text) + "\n")


def main(name: str, words: Optional[List[str]] = None) -> int:
    """Carries out `bbsim NAME` by command() of its module, which gets the options and a function that prints messages,
    unless -q is given. Returns its exit code."""
    for number in (signal.SIGTERM, signal.SIGHUP):
        if signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)
    logging.disable(logging.ERROR)  # of matplotlib, on its own folders
    table = json.loads((Path(__file__).parent / "commands.json").read_text("utf-8"))[name]
    try:
        options = _parsed(name, table, sys.argv[1:] if words is None else words)
        command = importlib.import_module(f"bbsim._{name}").command
        return command(options, (lambda text: None) if options["quiet"] else _say) or 0
    except InputError as error:
        # Options are named as on a command line.
        names = [option["names"].split(",")[-1] for option in table["options"]]
        known = "|".join(re.escape(name[2:]) for name in names if name.startswith("--"))
        texts = (f"{place}: {text}" if place else text for place, text in error.told)
        _say("\n".join(re.sub(rf"^({known}): ", r"--\1: ", text) for text in texts))
        return _INPUT_AT_FAULT
    except BrokenPipeError:  # the reader has seen enough
        return _OUTPUT_FAILED
    except (OutputError, ControllerError) as error:
        _say(str(error))
        return _OUTPUT_FAILED if isinstance(error, OutputError) else _ENDED_EARLY
    except MemoryError:
        _say("out of memory: ask for fewer output rows, or end other programs")
        return _ENDED_EARLY
    except KeyboardInterrupt:
        return _INTERRUPTED


design, fit, plot, tune = (functools.partial(main, name) for name in ("design", "fit", "plot", "tune"))
