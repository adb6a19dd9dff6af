// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Quantiles of Student's distribution.
#pragma once

namespace bbsim::fit {

// The t that |T| exceeds with probability 1/20, for a T with Student's distribution.
[[nodiscard]] double student_95(double degrees_of_freedom);

}  // namespace bbsim::fit
