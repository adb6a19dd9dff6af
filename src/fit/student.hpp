// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

namespace bbsim::fit {

// The t that a variable of Student's distribution exceeds, in size, with a probability of 1 in 20.
[[nodiscard]] double student_95(double degrees_of_freedom);

}  // namespace bbsim::fit
