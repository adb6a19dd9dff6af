// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/fault.hpp"

#include <algorithm>
#include <cstddef>

namespace bbsim::api {

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

}  // namespace bbsim::api
