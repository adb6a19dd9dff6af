// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The SPEC of `bbsim sweep --vary KEY=SPEC`: the values of a key over a sweep.
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
  std::size_t count = 0;  // for linear, log and list

  // Whether the values are random, one for each case.
  [[nodiscard]] bool random() const { return kind == Kind::uniform || kind == Kind::normal; }
};

// Reads linear:FROM:TO:COUNT, log:FROM:TO:COUNT, list:A,B,C, uniform:FROM:TO or normal:MEAN:SD.
// Commas within brackets do not separate list items. Throws InputError: "KEY: found ...".
[[nodiscard]] VariationSpec parse_variation(const Variation& variation);

// One of several keys that vary together.
struct TiedKey {
  std::string path;
  double factor = 1;  // multiplies the values for this key
};

// The keys of a variation: KEY, -KEY or NUMBER*KEY, separated by commas. Throws InputError.
[[nodiscard]] std::vector<TiedKey> tied_keys(const Variation& variation);

// A written value times a factor: -2 times "5 cm" is "-10 cm". Empty if the value is not a number
// and the factor is not 1.
[[nodiscard]] std::string scaled(const std::string& value, double factor);

// Splits KEYS=SPEC from a command line. Throws InputError.
[[nodiscard]] Variation split_variation(const std::string& assignment);

}  // namespace bbsim::scenario
