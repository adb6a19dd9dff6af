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

// {file: motion.csv, time: t, value: phi}; reads the file, once a scenario.
void read_table_term(Keys& keys, Table& table);

}  // namespace bbsim::input
