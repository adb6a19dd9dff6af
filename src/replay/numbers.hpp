// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The numbers of a page's JSON, and base64.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace bbsim::replay {

[[nodiscard]] std::string base64(std::span<const unsigned char> bytes);

// Values beyond the range of a float become infinite.
[[nodiscard]] std::string base64_of_floats(std::span<const double> values);
[[nodiscard]] std::string base64_of_doubles(std::span<const double> values);

// Values from -1 to 1, in steps of 1/32767.
[[nodiscard]] std::string base64_of_parts(std::span<const double> values);

// The nearest float; infinite on overflow, where a plain conversion is undefined.
[[nodiscard]] float to_float(double value);

// How numbers enter the JSON: as base64. A page that is open already takes arrays, and JSON with
// their places.
class Numbers {
 public:
  using Json = nlohmann::ordered_json;

  explicit Numbers(std::vector<std::vector<double>>* arrays) : arrays_(arrays) {}

  [[nodiscard]] Json floats(std::vector<double> values) const {
    return arrays_ != nullptr ? place(std::move(values)) : Json(base64_of_floats(values));
  }
  [[nodiscard]] Json doubles(std::vector<double> values) const {
    return arrays_ != nullptr ? place(std::move(values)) : Json(base64_of_doubles(values));
  }
  // Between -1 and 1.
  [[nodiscard]] Json parts(std::vector<double> values) const {
    return arrays_ != nullptr ? place(std::move(values)) : Json(base64_of_parts(values));
  }

 private:
  [[nodiscard]] Json place(std::vector<double> values) const {
    arrays_->push_back(std::move(values));
    return arrays_->size() - 1;
  }

  std::vector<std::vector<double>>* arrays_;
};

}  // namespace bbsim::replay
