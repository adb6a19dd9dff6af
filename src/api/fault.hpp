// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Parts of a message about a key: "ball.radius: found -1; allowed: a length greater than 0".
#pragma once

#include <string>
#include <string_view>

namespace bbsim::api {

struct KeyAndHint {
  std::string key;   // ball.radius; empty if the message begins with no key
  std::string hint;  // "did you mean radius?", "allowed: ..."; may be empty
};

[[nodiscard]] KeyAndHint key_and_hint(std::string_view message);

}  // namespace bbsim::api
