// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Where the headers are that a sketch includes, and which sources belong to them.
#pragma once

#include <string>
#include <vector>

namespace bbsim::sketch {

struct Libraries {
  std::vector<std::string> folders;  // of headers
  std::vector<std::string> sources;  // to be compiled with the sketch
};

// Looks for the headers `included`, and for what these include in turn, in `own` folders, those of
// the sketch, then in `given` ones: a folder X.h is in, or has in src/, or has in Name/ or
// Name/src/. Beside a header of its own a sketch has X.cpp; a library has all sources of the
// folder. Headers in `ours` are the board's.
[[nodiscard]] Libraries find_libraries(const std::vector<std::string>& included,
                                       const std::vector<std::string>& own,
                                       const std::vector<std::string>& given,
                                       const std::string& ours);

}  // namespace bbsim::sketch
