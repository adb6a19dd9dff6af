// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// License of this program and notices of what it contains, without a line break at the end.
#pragma once

#include <string>

namespace bbsim::app {

[[nodiscard]] std::string licenses();

}  // namespace bbsim::app
