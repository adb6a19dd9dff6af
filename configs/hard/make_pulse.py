#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes pulse.csv: a pulse of phi(t), 1 ms wide, in the middle of 1000 s.

    python3 configs/hard/make_pulse.py > configs/hard/pulse.csv

phi = 0.02 (1 - s^2)^4 rad with s = (t - 500 s) / 0.5 ms within |s| < 1, and zero elsewhere. It
meets zero with three derivatives, and 64 intervals resolve it. A spline rings a little at the ends of
the pulse, and this decays 3.7 times each interval: 60 more of the same width damp it out. Beyond them,
the intervals double in width each time.
"""
from fractions import Fraction

middle, half = Fraction(500), Fraction(1, 2000)
step = half / 32
offsets = [step * k for k in range(93)]
while offsets[-1] < 400:
    step *= 2
    offsets.append(offsets[-1] + step)
offsets[-1] = middle
times = sorted({middle + sign * offset for offset in offsets for sign in (-1, 1)})
print("t,phi")
for time in times:
    at = float(time)
    s = float((Fraction(at) - middle) / half)
    print(f"{at!r},{0.02 * max(0.0, 1 - s * s) ** 4!r}")
