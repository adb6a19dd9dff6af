// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A profile of a gimbal angle, of a motor's torque or of a force: a number, one of the shapes of a
// ProfileTerm, or a list: their sum.
#pragma once

#include <string>

#include "scenario/scenario.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

enum class ProfileOf { angle, torque, force };

struct ProfileRule {
  ProfileOf of = ProfileOf::angle;
  [[nodiscard]] std::string allowed() const;
  bool read(const yaml::Value& value, Profile& into) const;
};

}  // namespace bbsim::scenario
