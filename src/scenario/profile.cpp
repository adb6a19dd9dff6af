// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads profiles.
#include <algorithm>
#include <utility>

#include "scenario/sections.hpp"
#include "scenario/table_rows.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

// Enough for a Fourier series. Stops lists that grow exponentially through aliases.
constexpr std::size_t most_terms = 1000;

constexpr yaml::Number angle{yaml::Dimension::angle};
constexpr yaml::Number angular_rate{yaml::Dimension::angular_rate};

// What a term may be.
std::string one_term(yaml::Dimension of) {
  return yaml::Number{of}.allowed() + ", or one of sinusoid, ramp, pulse, table";
}

template <yaml::Dimension of>
void read_sinusoid(yaml::Keys& keys, Sinusoid& sinusoid) {
  keys.required("amplitude", yaml::Number{of}, sinusoid.amplitude,
                {"A in offset + A sin(ωt + p)", "of the quantity"});
  keys.required("frequency", angular_rate, sinusoid.frequency, {"ω"});
  keys.optional("phase", angle, sinusoid.phase, {"p"});
  keys.optional("offset", yaml::Number{of}, sinusoid.offset, {"offset", "of the quantity"});
}

template <yaml::Dimension of>
void read_ramp(yaml::Keys& keys, Ramp& ramp) {
  keys.required("start", yaml::Number{of}, ramp.start, {"value at t = 0", "of the quantity"});
  constexpr bool is_angle = of == yaml::Dimension::angle;
  keys.required("rate",
                yaml::Number{is_angle ? yaml::Dimension::angular_rate : yaml::Dimension::number},
                ramp.rate, {"rate", "of the quantity, per s"});
}

template <yaml::Dimension of>
void read_pulse(yaml::Keys& keys, Pulse& pulse) {
  keys.required("start", yaml::Number{yaml::Dimension::time}, pulse.start, {"when it begins"});
  keys.required("duration", yaml::Number{yaml::Dimension::time, {.above = 0}}, pulse.duration,
                {"duration of rise and fall together"});
  keys.required("value", yaml::Number{of}, pulse.value, {"value in its middle", "of the quantity"});
}

template <yaml::Dimension of>
void read_table(yaml::Keys& keys, Table& table) {
  TableRows rows;
  keys.about({"header"}, {"names of the columns of a CSV without a header: `[t, x, y]`"});
  keys.about({"unit", "time_unit"},
             {.meaning = "units of the values and of the times", .standard = "SI"});
  read_table_rows(keys, {"value"}, of, rows);
  if (rows.values.empty()) return;
  table = {std::move(rows.file), std::move(rows.times), std::move(rows.values[0])};
}

struct Shapes {
  std::optional<Sinusoid> sinusoid;
  std::optional<Ramp> ramp;
  std::optional<Pulse> pulse;
  std::optional<Table> table;
};

template <yaml::Dimension of>
void read_shapes(yaml::Keys& keys, Shapes& shapes) {
  keys.exactly_one({"sinusoid", "ramp", "pulse", "table"});
  keys.optional("sinusoid", yaml::MappingOf(read_sinusoid<of>), shapes.sinusoid);
  keys.optional("ramp", yaml::MappingOf(read_ramp<of>), shapes.ramp);
  keys.optional("pulse", yaml::MappingOf(read_pulse<of>), shapes.pulse);
  keys.optional("table", yaml::MappingOf(read_table<of>), shapes.table);
}

template <yaml::Dimension of>
bool read_term(const yaml::Value& value, Profile& into) {
  if (value.node->kind == yaml::Node::Kind::scalar) {
    const yaml::Quantity quantity = yaml::read_quantity(value.node->text, value.node->quoted, of);
    if (!quantity.value) return value.refuse(quantity.fault, one_term(of));
    into.emplace_back(*quantity.value);
    value.note(*quantity.value, of);
    return true;
  }
  if (value.node->kind != yaml::Node::Kind::mapping) return value.refuse("", one_term(of));
  Shapes shapes;
  if (!yaml::MappingOf(read_shapes<of>).read(value, shapes)) return false;
  if (shapes.sinusoid) into.emplace_back(*shapes.sinusoid);
  if (shapes.ramp) into.emplace_back(*shapes.ramp);
  if (shapes.pulse) into.emplace_back(*shapes.pulse);
  if (shapes.table) into.emplace_back(std::move(*shapes.table));
  return true;
}

}  // namespace

std::string ProfileRule::allowed() const {
  return one_term(of) + ", or a list of these: their sum";
}

yaml::Declared ProfileRule::declared() const {
  using yaml::Declared;
  using yaml::Dimension;
  const auto term = Declared::any(
      {Declared::number(of),
       of == Dimension::torque  ? yaml::MappingOf(read_shapes<Dimension::torque>).declared()
       : of == Dimension::force ? yaml::MappingOf(read_shapes<Dimension::force>).declared()
                                : yaml::MappingOf(read_shapes<Dimension::angle>).declared()});
  auto sum = Declared::any({term, Declared::list(1, most_terms, term)});
  sum.definition = "profile of " + std::string(yaml::noun(of));
  std::ranges::replace(sum.definition, ' ', '_');
  return sum;
}

bool ProfileRule::read(const yaml::Value& value, Profile& into) const {
  using yaml::Dimension;
  const auto term = of == Dimension::torque  ? read_term<Dimension::torque>
                    : of == Dimension::force ? read_term<Dimension::force>
                                             : read_term<Dimension::angle>;
  if (value.node->kind == yaml::Node::Kind::null) return value.refuse("", allowed());
  if (value.node->kind != yaml::Node::Kind::sequence) return term(value, into);
  const std::size_t count = value.node->items.size();
  if (count == 0 || count > most_terms) {
    return value.refuse("", "a list of 1 to " + std::to_string(most_terms));
  }
  bool fine = true;
  for (std::size_t i = 0; i < count; ++i) fine = term(value.item(i), into) && fine;
  return fine;
}

}  // namespace bbsim::scenario
