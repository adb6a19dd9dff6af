#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause
#
# Writes the golden CSVs anew. Only for a change that is meant to change the answers.
#     tests/golden/regenerate.sh build/release/bin/bbsim
set -euo pipefail
bbsim=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")"
for name in fig2a fig2b incline beam hold recorded; do
  "$bbsim" run "../../configs/$name.yaml" --set time.step=0.1 --set solver.method=radau \
    --set solver.rtol=1e-13 --set solver.atol=1e-15 -o "$name.csv"
done
