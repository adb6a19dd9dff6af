// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/error.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace bbsim {
namespace {

std::string one_line_each(const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& problem : problems) {
    if (!text.empty()) text += '\n';
    if (!problem.where.empty()) text += problem.where + ": ";
    text += problem.message;
  }
  return text;
}

}  // namespace

InputError::InputError(std::vector<Problem> problems)
    : std::runtime_error(one_line_each(problems)), problems_(std::move(problems)) {}

KeyAndHint key_and_hint(std::string_view message) {
  KeyAndHint found;
  if (constexpr std::string_view option = "--set "; message.starts_with(option)) {
    message.remove_prefix(option.size());
  }
  const std::string_view key = message.substr(0, std::min(message.find(": "), message.size()));
  const auto in_key = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.';
  };
  if (key.size() < message.size() && !key.empty() && std::ranges::all_of(key, in_key)) {
    found.key = key;
  }
  if (const std::size_t at = message.find("did you mean "); at != std::string_view::npos) {
    const std::string_view rest = message.substr(at);
    found.hint = rest.substr(0, std::min(rest.find('?'), rest.size() - 1) + 1);
  } else if (const std::size_t allowed = message.find("allowed: ");
             allowed != std::string_view::npos) {
    found.hint = message.substr(allowed);
  }
  return found;
}

}  // namespace bbsim
