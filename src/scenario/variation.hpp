// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// SPEC of `bbsim sweep --vary KEY=SPEC`: which values a key takes over a sweep.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim::scenario {

struct VariationSpec {
  enum class Kind { linear, log, list, uniform, normal } kind = Kind::list;
  // As written, in any unit of the key: FROM, TO; or MEAN, SD; or the items of a list.
  std::vector<std::string> values;
  std::size_t count = 0;  // of linear and log

  // Whether the values are drawn by chance, one for each case.
  [[nodiscard]] bool random() const { return kind == Kind::uniform || kind == Kind::normal; }
};

// Reads linear:FROM:TO:COUNT, log:FROM:TO:COUNT, list:A,B,C, uniform:FROM:TO or normal:MEAN:SD.
// Commas within brackets do not part the items of a list. Throws InputError: "KEY: found ...".
[[nodiscard]] VariationSpec parse_variation(const Variation& variation);

// One of the keys that vary together.
struct TiedKey {
  std::string path;
  double factor = 1;  // by which it takes the values
};

// The keys of a variation: KEY, -KEY or NUMBER*KEY, parted by commas. Throws InputError.
[[nodiscard]] std::vector<TiedKey> tied_keys(const Variation& variation);

// A value as written, times a factor: -2 times "5 cm" is "-10 cm". Empty if it is no number and the
// factor is not 1.
[[nodiscard]] std::string scaled(const std::string& value, double factor);

// KEYS=SPEC as on a command line. Throws InputError.
[[nodiscard]] Variation split_variation(const std::string& assignment);

}  // namespace bbsim::scenario
