// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Version of this program and of its parts, and their licenses.
#pragma once

#include <string>

namespace bbsim::app {

// Lines: the version, the chosen instruction set, the commit of the source, the libraries of the
// build.
[[nodiscard]] std::string version();

[[nodiscard]] std::string licenses();

}  // namespace bbsim::app
