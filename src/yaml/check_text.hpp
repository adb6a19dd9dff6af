// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks bytes before a YAML parser reads them.
#pragma once

#include <string_view>

namespace bbsim::yaml {

[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

// Returns the text without a byte order mark. Throws TextFault (document.hpp) unless the text is
// UTF-8 without control characters and without tabs in indentation.
[[nodiscard]] std::string_view check_text(std::string_view text, int source);

}  // namespace bbsim::yaml
