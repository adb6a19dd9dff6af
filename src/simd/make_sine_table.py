#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the constants of the sine and cosine of packs.

    python3 src/simd/make_sine_table.py > src/simd/sine_table.hpp

Needs mpmath; works with 60 digits and prints the shortest text of the nearest double.
"""
import mpmath as mp

mp.mp.dps = 60


def number(value):
    return repr(float(value))


def show(values):
    lines, line = [], "      "
    for text in (number(v) for v in values):
        if len(line) + len(text) + 2 > 98:
            lines.append(line.rstrip())
            line = "      "
        line += text + ", "
    lines.append(line.rstrip(", "))
    return "\n".join(lines)


def minimax(f, degree, low, high):
    """Remez exchange for p(u) ~ f(u) on [low, high], with f smooth and the weight 1."""
    points = [(low + high) / 2 - (high - low) / 2 * mp.cos(mp.pi * i / (degree + 1))
              for i in range(degree + 2)]
    for _ in range(12):
        m = mp.matrix(degree + 2, degree + 2)
        b = mp.matrix(degree + 2, 1)
        for i, u in enumerate(points):
            for j in range(degree + 1):
                m[i, j] = u ** j
            m[i, degree + 1] = (-1) ** i
            b[i] = f(u)
        p = mp.lu_solve(m, b)
        error = lambda u: f(u) - mp.polyval([p[j] for j in range(degree, -1, -1)], u)
        grid = [(low + high) / 2 - (high - low) / 2 * mp.cos(mp.pi * i / 800) for i in range(801)]
        values = [error(u) for u in grid]
        extremes = [0]
        for i in range(1, 801):
            if (values[i] > 0) == (values[extremes[-1]] > 0):
                if abs(values[i]) > abs(values[extremes[-1]]):
                    extremes[-1] = i
            else:
                extremes.append(i)
        if len(extremes) != degree + 2:
            break
        points = [grid[i] for i in extremes]
    return [p[j] for j in range(degree + 1)]


def sine_tables():
    top = (mp.pi / 4) ** 2 * mp.mpf("1.001")

    def sine(u):  # (sin r - r) / r^3, u = r^2
        if u == 0:
            return -mp.mpf(1) / 6
        r = mp.sqrt(u)
        return (mp.sin(r) - r) / r ** 3

    def cosine(u):  # (cos r - 1 + r^2 / 2) / r^4
        if u == 0:
            return mp.mpf(1) / 24
        return (mp.cos(mp.sqrt(u)) - 1 + u / 2) / u ** 2

    def head(value, bits):
        exponent = mp.floor(mp.log(abs(value), 2)) + 1
        unit = mp.mpf(2) ** (exponent - bits)
        return mp.floor(value / unit) * unit

    first = head(mp.pi / 2, 33)
    second = head(mp.pi / 2 - first, 33)
    return (minimax(sine, 5, mp.mpf(0), top), minimax(cosine, 5, mp.mpf(0), top),
            [first, second, mp.pi / 2 - first - second])


def main():
    sine, cosine, parts = sine_tables()
    print("""// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Written by make_sine_table.py, which says how. Do not edit.
#pragma once

namespace bbsim::simd {

// On |r| <= pi/4, by the Remez exchange: sin r = r + r^3 p(r^2), cos r = 1 - r^2/2 + r^4 q(r^2).
// pi/2 is in three parts. The first two have 33 bits, so their products with integers below 2^20
// are exact.
struct SineTable {""")
    for name, values in (("sine", sine), ("cosine", cosine), ("half_pi", parts)):
        print(f"  static constexpr double {name}[{len(values)}] = {{\n{show(values)}}};")
    print(f"  static constexpr double two_over_pi = {number(2 / mp.pi)};")
    print("};\n\n}  // namespace bbsim::simd")


if __name__ == "__main__":
    main()
