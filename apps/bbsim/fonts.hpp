// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Characters that the fonts of this machine have.
#pragma once

#include <cstdint>

namespace bbsim::app {

// Whether some font has this character, according to fontconfig; false if fontconfig is not
// installed, since gnuplot needs it too.
[[nodiscard]] bool some_font_has(std::uint32_t code);

}  // namespace bbsim::app
