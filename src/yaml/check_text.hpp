// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Bytes -> text that a YAML parser may see.
#pragma once

#include <string_view>

namespace bbsim::yaml {

[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

// The text without a byte order mark, once it is UTF-8 that holds no control characters and no
// tabs in indentation. Throws TextFault (document.hpp).
[[nodiscard]] std::string_view check_text(std::string_view text, int source);

}  // namespace bbsim::yaml
