// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which keys of a scenario need or exclude others, as one table for the checks and the JSON Schema.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "yaml/schema.hpp"

namespace bbsim::scenario {

// A condition on one key. "gimbal.servo": it is given. "controller.drives=torque|voltage": it has
// one of these values. "controller.drives=acceleration|": it has this value or is absent.
// "plate.mass>0": it is positive.
struct Condition {
  explicit Condition(std::string_view text);

  std::string_view path;
  std::vector<std::string_view> values;
  bool or_absent = false, positive = false;
};

// If the condition `key` holds, then one of `others` holds (`needs`), or none of them (`excludes`).
// `others` are alternatives joined by " or ", each of conditions joined by " and ".
struct KeyRelation {
  enum class Kind { needs, excludes };
  std::string_view key;
  Kind kind;
  std::string_view others;
  // Reported at the key. Empty if the check needs more than the keys (check_loop.cpp,
  // check_rig.cpp, the readers).
  std::string_view message{};

  [[nodiscard]] std::vector<std::vector<Condition>> alternatives() const;
};
[[nodiscard]] std::span<const KeyRelation> relations();

// Reports broken relations with a message: with these `others`, or all but check_loop()'s own.
void check_relations(yaml::Keys& scenario, std::string_view others);
void check_relations(yaml::Keys& scenario);

}  // namespace bbsim::scenario
