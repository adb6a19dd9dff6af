// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Quantities: "10 cm", 1e-3, "0.5 Hz".
//
// The first byte of an input selects the dimension and whether the text is quoted; the rest is the
// text.
#include "yaml/quantity.hpp"

#include <cmath>

#include "base/number_text.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bbsim::yaml;
  using bbsim::number_text;
  using bbsim_fuzz::must;
  if (size == 0) return 0;
  const auto dimension = static_cast<Dimension>(data[0] / 2 % 8);
  static_assert(static_cast<int>(Dimension::acceleration) == 7, "eight dimensions");
  const bool quoted = data[0] % 2 == 1;
  const Quantity quantity =
      read_quantity(bbsim_fuzz::text_of(data + 1, size - 1), quoted, dimension);
  if (!quantity.value) return 0;
  must(std::isfinite(*quantity.value));
  // A valid value written in SI units reads back as the same value.
  const Quantity again = read_quantity(number_text(*quantity.value), false, dimension);
  must(again.value.has_value() && *again.value == *quantity.value);
  return 0;
}
