// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/text.hpp"

#include <array>

namespace bbsim {

Utf8Character first_character(std::string_view text) {
  struct Form {
    unsigned char mask, lead;
    std::uint32_t least;  // codes below it have a shorter form
  };
  constexpr std::array forms = {Form{0x80, 0x00, 0}, Form{0xE0, 0xC0, 0x80},
                                Form{0xF0, 0xE0, 0x800}, Form{0xF8, 0xF0, 0x10000}};
  const auto lead = static_cast<unsigned char>(text[0]);
  for (std::size_t length = 1; length <= forms.size(); ++length) {
    const Form& form = forms[length - 1];
    if ((lead & form.mask) != form.lead) continue;
    std::uint32_t code = lead & ~std::uint32_t{form.mask};
    if (text.size() < length) return {};
    for (std::size_t i = 1; i < length; ++i) {
      const auto next = static_cast<unsigned char>(text[i]);
      if ((next & 0xC0U) != 0x80U) return {};
      code = code << 6U | (next & 0x3FU);
    }
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    if (code < form.least || code > 0x10FFFF || surrogate) return {};
    return {code, length};
  }
  return {};
}

}  // namespace bbsim
