// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The words of a C++ source, as far as it takes to find its functions: comments and blanks are
// gone.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace bbsim::sketch {

struct Token {
  enum class Kind { name, other, directive } kind;
  std::string_view text;  // of the source; a directive's lines from # on
  std::size_t offset;     // in the source

  [[nodiscard]] bool is(std::string_view what) const { return text == what; }
};

// The text outlives them. Numbers and strings are words, and each other character one of its own
// but for "::" and "->".
[[nodiscard]] std::vector<Token> tokens_of(std::string_view source);

}  // namespace bbsim::sketch
