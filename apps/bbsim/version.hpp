// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What this program is, and what it is made of.
#pragma once

#include <string>

namespace bbsim::app {

// Lines: the version, the instruction set that was chosen, the commit of the source, the libraries
// that it was built with.
[[nodiscard]] std::string version();

}  // namespace bbsim::app
