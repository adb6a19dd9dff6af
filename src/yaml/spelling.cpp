// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/spelling.hpp"

#include <array>
#include <cstddef>

namespace bbsim::yaml {
namespace {

struct Word {
  std::string_view american, british;
};
// All words with two spellings that occur in keys.
constexpr std::array words{Word{"center", "centre"}, Word{"linearization", "linearisation"}};

// Underscores and dots separate the words of a path.
bool parts(char c) {
  return c == '_' || c == '.';
}

bool is_word(std::string_view path, std::size_t begin, std::size_t size) {
  const std::size_t end = begin + size;
  return (begin == 0 || parts(path[begin - 1])) && (end == path.size() || parts(path[end]));
}

std::string spelled(std::string_view path, std::string_view Word::*from,
                    std::string_view Word::*to) {
  std::string text(path);
  for (const Word& word : words) {
    const std::string_view old = word.*from;
    for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + 1)) {
      if (is_word(text, at, old.size())) text.replace(at, old.size(), word.*to);
    }
  }
  return text;
}

}  // namespace

std::string american(std::string_view path) {
  return spelled(path, &Word::british, &Word::american);
}

std::string british(std::string_view path) {
  return spelled(path, &Word::american, &Word::british);
}

std::optional<std::string> other_spelling(std::string_view name) {
  // Most names have one spelling. They return without making a string, because a sweep looks up
  // many names.
  const auto holds = [&](std::string_view word) {
    return name.find(word) != std::string_view::npos;
  };
  for (const Word& word : words) {
    if (holds(word.british)) return american(name);
    if (holds(word.american)) return british(name);
  }
  return {};
}

}  // namespace bbsim::yaml
