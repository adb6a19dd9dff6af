// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// gnuplot, as a process of its own.
#pragma once

#include <string>

namespace bbsim::app {

// Throws OutputError, with what to do about it, if there is no gnuplot to be run.
void require_gnuplot();

// What gnuplot writes to its standard output when it runs `script`. Throws OutputError with the
// first line of its complaint if it fails.
[[nodiscard]] std::string run_gnuplot(const std::string& script);

}  // namespace bbsim::app
