// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The tokens of a C++ source, without comments and blanks. They suffice to find its functions.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace bbsim::sketch {

struct Token {
  enum class Kind { name, other, directive } kind;
  std::string_view text;  // part of the source; for a directive, its lines from # on
  std::size_t offset;     // in the source

  [[nodiscard]] bool is(std::string_view what) const { return text == what; }
};

// The source must outlive the tokens. A name, number, string, directive, "::" or "->" is one
// token, and so is every other character.
[[nodiscard]] std::vector<Token> tokens_of(std::string_view source);

}  // namespace bbsim::sketch
