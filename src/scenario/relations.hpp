// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which keys need or exclude others: one table for the checks and the JSON Schema.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

// A key of servos, and whether a servo has a value for it: by its own keys, by those of all servos,
// or by its model.
struct ServoKey {
  std::string_view path;
  bool (*holds)(const Servo&);
};

// A condition on one key. "gimbal.servo": it is given. "controller.drives=torque|voltage": it has
// one of these values. "controller.drives=acceleration|": it has this value or is absent.
// "plate.mass>0": it is positive. "gravity>0|": it is not 0.
struct Condition {
  explicit Condition(std::string_view text);

  std::string_view path;
  std::vector<std::string_view> values;
  bool or_absent = false, positive = false;
  const ServoKey* servo = nullptr;  // if it is a key of servos
};

// Alternatives joined by " or ", each of conditions joined by " and ". An empty text always holds.
using Conditions = std::vector<std::vector<Condition>>;
[[nodiscard]] Conditions conditions(std::string_view text);

// If `keys` hold, then `others` hold (`needs`), or do not (`excludes`).
struct KeyRelation {
  enum class Kind { needs, excludes };
  std::string_view keys;
  Kind kind;
  std::string_view others;
  // {path} stands for the name of a key as written, {=path} for its value.
  std::string_view message;
  // The key where the message stands, if not the first of `keys`: "controller.limit". "=path"
  // stands at the key's value. "gimbal:plate.inertia" is a key that is missing in `gimbal`, if
  // there is one.
  std::string_view at{};
};

// What moves the gimbal; what goes with it; everything else.
[[nodiscard]] std::array<std::span<const KeyRelation>, 3> relations();

// Reports relations that do not hold. Returns whether one thing moves the gimbal; otherwise reports
// nothing about what goes with it.
bool check_relations(const yaml::Value& root, const Scenario& scenario);

}  // namespace bbsim::scenario
