#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Marks answers to circle.yaml with bbsim's Python package; `mark` does the same in a shell loop.

    mark.py SEED ANSWER...

Runs circle.yaml with each ANSWER on the same ten rigs, which SEED draws: keep it to yourself. An ANSWER is
a file of lines KEY=VALUE; only the free keys of the exercise count. Prints, as CSV, the answer and on how
many rigs each task holds.
"""
import pathlib
import sys

import bbsim

EXERCISE = pathlib.Path(__file__).with_name("circle.yaml")
FREE = ("controller.gravity_compensation.kp", "controller.gravity_compensation.kv")
RIGS = {
    "gimbal.servo.natural_frequency": "uniform:3.5 Hz:6 Hz",
    "gimbal.mounting.phi_offset": "uniform:-0.1 deg:0.1 deg",
    "gimbal.mounting.theta_offset": "uniform:-0.1 deg:0.1 deg",
    "gimbal.servo.backlash": "uniform:0.01 deg:0.2 deg",
    "controller.sensor.delay": "uniform:5 ms:20 ms",
}
TASKS = ("max_tracking_error from 5 s < 3 mm", "max_tilt < 2.5 deg")


def gains(answer):
    lines = (line.split("=", 1) for line in answer.read_text(encoding="utf-8").splitlines() if "=" in line)
    return {key: value for key, value in lines if key in FREE}


def mark(answer, seed):
    rows = bbsim.sweep(EXERCISE, RIGS, set=gains(answer), samples=10, seed=seed, expect=TASKS)
    return [int(rows["expect: " + task].sum()) for task in TASKS]


def main(arguments):
    if len(arguments) < 2 or arguments[0] in ("-h", "--help"):
        print(__doc__, end="")
        return 0 if arguments[:1] in (["-h"], ["--help"]) else 2
    print("answer,circle,tilt")
    for answer in map(pathlib.Path, arguments[1:]):
        try:
            marks = mark(answer, int(arguments[0]))
        except bbsim.Error as error:
            print(f"{answer.stem}: {error}", file=sys.stderr)
            marks = ["refused", "refused"]
        print(answer.stem, *marks, sep=",")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
