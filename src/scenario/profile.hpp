// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads a profile of a gimbal angle, a motor's torque or a force: a number, a shape of ProfileTerm,
// or a list of these, which are summed.
#pragma once

#include <string>

#include "scenario/scenario.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

enum class ProfileOf { angle, torque, force };

struct ProfileRule {
  ProfileOf of = ProfileOf::angle;
  [[nodiscard]] std::string allowed() const;
  [[nodiscard]] yaml::Declared declared() const;
  bool read(const yaml::Value& value, Profile& into) const;
};

}  // namespace bbsim::scenario
