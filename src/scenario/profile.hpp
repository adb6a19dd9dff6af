// A profile of a gimbal angle: a number, one of sinusoid, ramp and table, or a list: their sum.
#pragma once

#include <string>

#include "scenario/scenario.hpp"
#include "scenario/schema.hpp"

namespace bbsim::input {

struct ProfileRule {
  [[nodiscard]] std::string allowed() const;
  bool read(const Value& value, Profile& into) const;
};

}  // namespace bbsim::input
