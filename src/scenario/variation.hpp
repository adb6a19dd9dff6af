// SPEC of `bbsim sweep --vary KEY=SPEC`: which values a key takes over a sweep.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim::input {

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

// KEY=SPEC as on a command line. Throws InputError.
[[nodiscard]] Variation split_variation(const std::string& assignment);

}  // namespace bbsim::input
