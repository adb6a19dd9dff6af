// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// gnuplot as a separate process.
#pragma once

#include <string>

namespace bbsim::app {

// Throws OutputError, with a remedy, if gnuplot cannot be found.
void require_gnuplot();

// Standard output of gnuplot for `script`. If gnuplot fails, throws OutputError with the first line
// of its message.
[[nodiscard]] std::string run_gnuplot(const std::string& script);

}  // namespace bbsim::app
