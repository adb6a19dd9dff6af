// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which letters the fonts of this machine have.
#pragma once

#include <cstdint>

namespace bbsim::app {

// Whether some font has a letter for this character, as fontconfig says; false where it is not
// installed, which is where gnuplot cannot be either.
[[nodiscard]] bool some_font_has(std::uint32_t code);

}  // namespace bbsim::app
