// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the libraries of the headers that a sketch includes, and their sources.
#pragma once

#include <string>
#include <vector>

namespace bbsim::sketch {

struct Libraries {
  std::vector<std::string> folders;  // of headers
  std::vector<std::string> sources;  // compiled with the sketch
};

// Searches for the headers `included`, and for those that these include: first in the folders `own`
// of the sketch, then in each folder `given` and its src/, Name/ and Name/src/. A header X.h of the
// sketch brings X.cpp with it; a header of a library brings all sources of its folder. The board
// has the headers in the folder `ours`.
[[nodiscard]] Libraries find_libraries(const std::vector<std::string>& included,
                                       const std::vector<std::string>& own,
                                       const std::vector<std::string>& given,
                                       const std::string& ours);

}  // namespace bbsim::sketch
