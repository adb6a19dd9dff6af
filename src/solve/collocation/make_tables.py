#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the constants of Radau IIA collocation, and those of the sine and cosine of packs.

    python3 src/solve/collocation/make_tables.py radau > src/solve/collocation/radau_table.hpp
    python3 src/solve/collocation/make_tables.py sine > src/simd/sine_table.hpp

Needs mpmath; works with 60 digits and prints the shortest text of the nearest double.

Nodes: the right Radau points, roots of P_s - P_(s-1) on [-1, 1]. On the nodes a polynomial of
degree s - 1 has Legendre coefficients `legendre` times its values; integrating its Legendre series
gives A. For even s, the eigenvalues of A come in complex pairs; one of each pair is kept.
"""
import sys

import mpmath as mp

mp.mp.dps = 60
STAGES = (8, 12, 16)


def legendre(x, top):
    values = [mp.mpf(1), x]
    for m in range(1, top):
        values.append(((2 * m + 1) * x * values[m] - m * values[m - 1]) / (m + 1))
    return values[: top + 1]


def radau_nodes(s):
    """Roots of P_s - P_(s-1), found between the sign changes of a fine Chebyshev-spaced scan."""
    def f(x):
        p = legendre(x, s)
        return p[s] - p[s - 1]
    scan = [-mp.cos(mp.pi * i / (20 * s)) for i in range(20 * s)]
    roots = [mp.findroot(f, (a, b), solver="anderson", tol=mp.mpf(10) ** -100)
             for a, b in zip(scan, scan[1:]) if f(a) * f(b) < 0]
    roots.append(mp.mpf(1))
    assert len(roots) == s, (s, len(roots))
    return roots


def tables(s):
    x = radau_nodes(s)
    basis = mp.matrix(s, s)
    integral = mp.matrix(s, s)
    for i in range(s):
        p = legendre(x[i], s + 1)
        for j in range(s):
            basis[i, j] = p[j]
            integral[i, j] = (x[i] + 1) / 2 if j == 0 else (p[j + 1] - p[j - 1]) / (2 * (2 * j + 1))
    to_legendre = basis ** -1
    a = integral * to_legendre
    values, vectors = mp.eig(a)
    inverse = vectors ** -1
    # inverse * a * vectors = diag(values). Of each pair, keep the eigenvalue above the real axis.
    kept = sorted((k for k in range(s) if mp.im(values[k]) > 0), key=lambda k: mp.im(values[k]))
    assert len(kept) == s // 2
    # Scale each eigenvector to unit maximum norm.
    scale = {k: max(abs(vectors[i, k]) for i in range(s)) for k in kept}
    v = [[vectors[i, k] / scale[k] for i in range(s)] for k in kept]
    w = [[inverse[k, i] * scale[k] for i in range(s)] for k in kept]
    return {
        "c": [(xi + 1) / 2 for xi in x],
        "a": [[a[i, j] for i in range(s)] for j in range(s)],
        "a_squared": [[(a * a)[i, j] for i in range(s)] for j in range(s)],
        "legendre": [[to_legendre[i, j] for i in range(s)] for j in range(s)],
        "lambda_re": [mp.re(values[k]) for k in kept],
        "lambda_im": [mp.im(values[k]) for k in kept],
        "forward_re": [[mp.re(w[k][j]) for k in range(s // 2)] for j in range(s)],
        "forward_im": [[mp.im(w[k][j]) for k in range(s // 2)] for j in range(s)],
        "back_re": [[2 * mp.re(v[k][i]) for i in range(s)] for k in range(s // 2)],
        "back_im": [[-2 * mp.im(v[k][i]) for i in range(s)] for k in range(s // 2)],
    }


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


def show_table(rows):
    return ",\n".join("      {" + show(row).lstrip() + "}" for row in rows)


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


def write_radau():
    print("""// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Written by make_tables.py, which says how. Do not edit.
//
// Matrices are stored by columns, the index of the result last: column[j][i].
#pragma once

namespace bbsim::solve::radau {

// Radau IIA with s stages on [0, 1].
//   c           nodes
//   a           integrates nodal values from 0 to the nodes; a_squared = a * a
//   legendre    nodal values -> coefficients of the shifted Legendre polynomials
//   lambda      eigenvalues of a above the real axis; forward: nodal values -> coordinates in the
//               eigenvectors; back: these and their conjugates -> real nodal values
template <int s>
struct RadauTable;
""")
    for s in STAGES:
        t = tables(s)
        h = s // 2
        print(f"template <>\nstruct RadauTable<{s}> {{")
        for name, size in (("c", s), ("lambda_re", h), ("lambda_im", h)):
            print(f"  static constexpr double {name}[{size}] = {{\n{show(t[name])}}};")
        for name, rows, columns in (("a", s, s), ("a_squared", s, s), ("legendre", s, s),
                                    ("forward_re", s, h), ("forward_im", s, h),
                                    ("back_re", h, s), ("back_im", h, s)):
            print(f"  static constexpr double {name}[{rows}][{columns}] = {{\n"
                  f"{show_table(t[name])}}};")
        print("};\n")
    print("}  // namespace bbsim::solve::radau")


def write_sine():
    sine, cosine, parts = sine_tables()
    print("""// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Written by make_tables.py, which says how. Do not edit.
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


{"radau": write_radau, "sine": write_sine}[sys.argv[1]]()
