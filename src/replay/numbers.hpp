// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The numbers of a page's JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "replay/base64.hpp"

namespace bbsim::replay {

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
