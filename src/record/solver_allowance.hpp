// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How far two results may be apart by what their solver was asked for.
#pragma once

#include <optional>

#include "record/compare.hpp"

namespace bbsim::record {

// From what HDF5 files carry: tolerances (attributes rtol, atol), or a bound on the error of the
// positions (error_bound). Nothing if neither file carries any, as CSV cannot.
//
// Tolerances hold for a step; the errors of all steps together are allowed to be a hundred times
// that, as they are of the golden files. So each file may be off, in a column, by
//
//     100 (rtol size + atol unit)
//
// and two files by the sum. `size` is the largest value in any column that is of the column's kind
// (where x goes, y may come, with the error of x). `unit` is what a state's error of 1 in its own
// unit makes of the column: 1 of most; 1/r of the spin, which is integrated as r spin; that times
// the length of the run, of gamma, its integral; and omega_n^2 + 2 zeta omega_n of the gimbal's
// accelerations behind a servo. Columns that are not computed from states, such as t, a sweep's
// keys and texts, are compared by the standard tolerances.
[[nodiscard]] std::optional<Allowances> solver_allowances(const file::CellTable& a,
                                                          const file::CellTable& b);

}  // namespace bbsim::record
