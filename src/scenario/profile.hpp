// A profile of a gimbal angle, or of a motor's torque: a number, one of sinusoid, ramp and table,
// or a list: their sum.
#pragma once

#include <string>

#include "scenario/scenario.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

struct ProfileRule {
  bool of_torque = false;
  [[nodiscard]] std::string allowed() const;
  bool read(const yaml::Value& value, Profile& into) const;
};

}  // namespace bbsim::scenario
