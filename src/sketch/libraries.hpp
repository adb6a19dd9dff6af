// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the libraries whose headers a sketch includes, and the sources of these libraries.
#pragma once

#include <string>
#include <vector>

namespace bbsim::sketch {

struct Libraries {
  std::vector<std::string> folders;  // of headers
  std::vector<std::string> sources;  // compiled with the sketch
};

// Searches for the headers `included`, and for those that these include: first in the sketch's
// folders `own`, then in each folder `given` and its src/, Name/ and Name/src/. A header X.h of the
// sketch adds X.cpp; a header of a library adds all sources of its folder. Headers in the folder
// `ours` belong to the board. All sources in the folders `whole`, and below src/ in them, are
// compiled, except copies of the board's.
[[nodiscard]] Libraries find_libraries(const std::vector<std::string>& included,
                                       const std::vector<std::string>& own,
                                       const std::vector<std::string>& given,
                                       const std::string& ours,
                                       const std::vector<std::string>& whole = {});

}  // namespace bbsim::sketch
