// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The numbers of a page's JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

namespace bbsim::replay {

// How lists of numbers enter the JSON: as base64. A page that is open already takes arrays, and
// JSON with their places.
class Numbers {
 public:
  using Json = nlohmann::ordered_json;

  explicit Numbers(std::vector<std::vector<double>>* arrays) : arrays_(arrays) {}

  // Values beyond the range of a float become infinite.
  [[nodiscard]] Json floats(std::vector<double> values) const;
  [[nodiscard]] Json doubles(std::vector<double> values) const;
  // Values from -1 to 1, in steps of 1/32767.
  [[nodiscard]] Json parts(std::vector<double> values) const;

 private:
  template <class WordOf>
  [[nodiscard]] Json list(std::vector<double> values, WordOf word_of) const;

  std::vector<std::vector<double>>* arrays_;
};

}  // namespace bbsim::replay
