// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The license of this program, and the notices of what it contains, without the last line's end.
#pragma once

#include <string>

namespace bbsim::app {

[[nodiscard]] std::string licenses();

}  // namespace bbsim::app
