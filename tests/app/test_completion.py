#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""Tests completion in the installed shells: types into bash and zsh, and queries fish.

test_completion.py BBSIM"""

import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

PROGRAM = os.path.abspath(sys.argv[1])
# Typed text; what the line or the list below it must contain; what it must not contain.
CASES = [
    ("bbsim swe", ["bbsim sweep"], []),
    ("bbsim run --summ", ["--summary"], []),
    ("bbsim run --set ball.rad", ["ball.radius="], []),
    ("bbsim run --set=ball.rad", ["--set=ball.radius="], []),
    ("bbsim run --set ball.", ["ball.mass", "ball.position", "ball.losses."], ["ball.losses.rolling"]),
    ("bbsim sweep a.yaml --vary controller.pid.kp.0", ["controller.pid.kp.0."], []),
    ("bbsim run --measure rms_x,max_til", ["rms_x,max_tilt"], []),
    ("bbsim run --measure x.Ov", ["x.Overshoot"], []),
    ("bbsim run --measure phi_del", ["phi_delay_margin"], []),
    ("bbsim compare --columns t,phi_comm", ["t,phi_command"], []),
    ("bbsim sweep --combine z", ["--combine zip"], []),
    ("bbsim run in", ["input.yaml"], ["input.csv"]),
    ("bbsim measure in", ["input.csv"], ["input.yaml"]),
    ("bbsim run -o old", ["old.h5"], ["old.html"]),
    ("bbsim run --replay old", ["old.html"], ["old.h5"]),
    ("bbsim help line", ["linearize"], []),
    ("bbsim summarise --qu", ["--quantiles", "--quiet"], []),
    ("bbsim completion f", ["fish"], []),
]
FILES = ["input.yaml", "input.csv", "old.h5", "old.html"]


def type_into(command, prepare, text, folder):
    """Returns what a shell in a terminal shows after text and two tabs."""
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(folder)
        environment = {"PATH": os.environ["PATH"], "TERM": "dumb", "HOME": folder, "PS1": "> ",
                       "INPUTRC": "/dev/null", "LC_ALL": "C.UTF-8"}
        os.execvpe(command[0], command, environment)

    def read_until_quiet(quiet):
        shown = b""
        while select.select([terminal], [], [], quiet)[0]:
            try:
                part = os.read(terminal, 65536)
            except OSError:
                break
            if not part:
                break
            shown += part
        return shown.decode(errors="replace")

    def run(line, mark):
        os.write(terminal, line.encode() + b"\n")
        shown, end = "", time.monotonic() + 20
        while mark not in shown and time.monotonic() < end:
            shown += read_until_quiet(0.1)

    # The shell assembles the mark, so that the echoed line does not contain it.
    for line in prepare:
        os.write(terminal, line.encode() + b"\n")
    run("echo rea''dy", "ready\r")
    read_until_quiet(0.2)
    os.write(terminal, text.encode() + b"\t")
    shown = read_until_quiet(0.4)
    os.write(terminal, b"\t")
    shown += read_until_quiet(0.6)
    os.kill(process, 9)
    os.waitpid(process, 0)
    os.close(terminal)
    return re.sub(r"\x1b\[[0-9;?]*[a-zA-Z]|\x07", "", shown)


def bash(script, text, folder):
    return type_into(["bash", "--norc", "--noprofile", "-i"],
                     ["bind 'set completion-query-items 0'; bind 'set page-completions off'",
                      f"source {script}"], text, folder)


def zsh(script, text, folder):
    os.makedirs(f"{folder}/functions", exist_ok=True)
    shutil.copy(script, f"{folder}/functions/_bbsim")
    return type_into(["zsh", "-f", "-i"],
                     ["unsetopt zle_bracketed_paste prompt_cr prompt_sp; LISTMAX=10000",
                      f"fpath=({folder}/functions $fpath); autoload -Uz compinit; compinit -u -D"],
                     text, folder)


def fish(script, text, folder):
    found = subprocess.run(["fish", "--no-config", "-c",
                            f"source {script}; complete -C '{text}'"], cwd=folder, text=True,
                           env={"PATH": os.environ["PATH"], "HOME": folder, "LC_ALL": "C.UTF-8"},
                           capture_output=True, check=False)
    if found.returncode != 0 or found.stderr:
        return "fish: " + found.stderr
    # fish returns the whole last word.
    before = text.rpartition(" ")[0]
    return "\n".join(f"{before} {line}" for line in found.stdout.splitlines())


def main():
    failed = tried = 0
    for name, shell in (("bash", bash), ("zsh", zsh), ("fish", fish)):
        if not shutil.which(name):
            print(f"{name}: not installed, not tried")
            continue
        with tempfile.TemporaryDirectory() as folder:
            for file in FILES:
                open(f"{folder}/{file}", "w", encoding="utf-8").close()
            os.makedirs(f"{folder}/scripts")
            script = f"{folder}/scripts/{name}"
            with open(script, "wb") as out:
                subprocess.run([PROGRAM, "completion", name], stdout=out, check=True)
            for text, wanted, unwanted in CASES:
                shown = shell(script, text, folder)
                tried += 1
                lacks = [word for word in wanted if word not in shown]
                surplus = [word for word in unwanted if word in shown]
                if lacks or surplus:
                    failed += 1
                    print(f"{name}: {text}<Tab>: lacks {lacks}, has {surplus}:\n{shown}\n")
    print(f"{tried - failed} of {tried} completions are right")
    return 1 if failed or tried == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
