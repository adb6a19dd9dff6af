#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes verify_references.hpp: the reference solutions of `bbsim verify`.

    python3 src/study/make_verify_references.py > src/study/verify_references.hpp

Takes the scenarios of tests/data/scenarios and rows of their quad-precision solutions in
tests/data/reference: those at a fifth, two fifths ... of the scene and at its end, with all
digits. Scenarios are kept as text: the program reads them as it reads a file.
"""
import csv
import pathlib

SCENES = ("fig2a", "fig2b", "fast", "small-ball", "spin", "stiff-servo", "tumble")
COLUMNS = ("t", "x", "y", "spin", "gamma")

data = pathlib.Path(__file__).resolve().parents[2] / "tests" / "data"
print("""// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Written by make_verify_references.py from tests/data; do not edit.""")
print("#pragma once\n\n#include <array>\n")
print("namespace bbsim::study {\n")
print("struct ReferenceRow {\n  double t, x, y, spin, gamma;\n};\n")
print("struct ReferenceScene {\n  const char* name;\n  const char* scenario;  // YAML")
print("  std::array<ReferenceRow, 5> rows;\n};\n")
print("// clang-format off")
print(f"inline constexpr std::array<ReferenceScene, {len(SCENES)}> reference_scenes{{{{")
for name in SCENES:
    with open(data / "reference" / f"{name}.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    print(f'  {{"{name}", R"yaml({(data / "scenarios" / f"{name}.yaml").read_text()})yaml",')
    last = len(rows) - 1
    print("   {{")
    for part in range(1, 6):
        row = rows[last * part // 5]
        print("     {" + ", ".join(row[column] for column in COLUMNS) + "},")
    print("   }}},")
print("}};\n// clang-format on\n\n}  // namespace bbsim::study")
