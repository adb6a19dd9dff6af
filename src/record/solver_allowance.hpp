// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How far two results may differ according to the tolerances of their solvers.
#pragma once

#include <optional>

#include "record/compare.hpp"

namespace bbsim::record {

// Reads HDF5 attributes: the tolerances rtol and atol, or the bound error_bound on the error of
// positions. Empty if neither file has any, as with CSV.
//
// Tolerances hold for a step. The errors of all steps together may be a hundred times as large, as
// in the golden files. Each file may therefore be off, in a column, by
//
//     100 (rtol size + atol unit)
//
// and two files by the sum. `size` is the largest value in any column of the same kind, because an
// error of x may pass to y. `unit` is the change of the column per unit of the integrated state: 1
// for most columns; 1/r for the spin, which is integrated as r spin; 1/r times the length of the
// run for gamma, the integral of the spin; and omega_n^2 + 2 zeta omega_n for the gimbal's
// accelerations under a servo. Columns that are not computed from states, such as t, a sweep's keys
// and texts, have the standard tolerances.
[[nodiscard]] std::optional<Allowances> solver_allowances(const file::Table& a,
                                                          const file::Table& b);

}  // namespace bbsim::record
