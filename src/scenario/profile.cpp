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
// The dimensions and messages for each kind of profile.
struct OfAngle {
  static constexpr yaml::Dimension value = yaml::Dimension::angle;
  static constexpr yaml::Dimension rate = yaml::Dimension::angular_rate;
  static constexpr std::string_view term =
      "an angle, such as 0.1 or \"4 deg\", or one of sinusoid, ramp, pulse, table";
};
struct OfTorque {
  static constexpr yaml::Dimension value = yaml::Dimension::torque;
  static constexpr yaml::Dimension rate = yaml::Dimension::number;
  static constexpr std::string_view term =
      "a torque, such as 0.01 or \"10 mN m\", or one of sinusoid, ramp, pulse, table";
};
struct OfForce {
  static constexpr yaml::Dimension value = yaml::Dimension::force;
  static constexpr yaml::Dimension rate = yaml::Dimension::number;
  static constexpr std::string_view term =
      "a force, such as 0.01 or \"10 mN\", or one of sinusoid, ramp, pulse, table";
};

template <class Of>
void read_sinusoid(yaml::Keys& keys, Sinusoid& sinusoid) {
  keys.required("amplitude", yaml::Number{Of::value}, sinusoid.amplitude,
                {"A in offset + A sin(ωt + p)", "of the quantity"});
  keys.required("frequency", angular_rate, sinusoid.frequency, {"ω"});
  keys.optional("phase", angle, sinusoid.phase, {"p"});
  keys.optional("offset", yaml::Number{Of::value}, sinusoid.offset, {"offset", "of the quantity"});
}

template <class Of>
void read_ramp(yaml::Keys& keys, Ramp& ramp) {
  keys.required("start", yaml::Number{Of::value}, ramp.start,
                {"value at t = 0", "of the quantity"});
  keys.required("rate", yaml::Number{Of::rate}, ramp.rate, {"rate", "of the quantity, per s"});
}

template <class Of>
void read_pulse(yaml::Keys& keys, Pulse& pulse) {
  keys.required("start", yaml::Number{yaml::Dimension::time}, pulse.start, {"when it begins"});
  keys.required("duration", yaml::Number{yaml::Dimension::time, {.above = 0}}, pulse.duration,
                {"duration of rise and fall together"});
  keys.required("value", yaml::Number{Of::value}, pulse.value,
                {"value in its middle", "of the quantity"});
}

template <class Of>
void read_table(yaml::Keys& keys, Table& table) {
  TableRows rows;
  keys.about({"header"}, {"names of the columns of a CSV without a header: `[t, x, y]`"});
  keys.about({"unit", "time_unit"},
             {.meaning = "units of the values and of the times", .standard = "SI"});
  read_table_rows(keys, {"value"}, Of::value, rows);
  if (rows.values.empty()) return;
  table = {std::move(rows.file), std::move(rows.times), std::move(rows.values[0])};
}

struct Shapes {
  std::optional<Sinusoid> sinusoid;
  std::optional<Ramp> ramp;
  std::optional<Pulse> pulse;
  std::optional<Table> table;
};

template <class Of>
void read_shapes(yaml::Keys& keys, Shapes& shapes) {
  keys.exactly_one({"sinusoid", "ramp", "pulse", "table"});
  keys.optional("sinusoid", yaml::MappingOf(read_sinusoid<Of>), shapes.sinusoid);
  keys.optional("ramp", yaml::MappingOf(read_ramp<Of>), shapes.ramp);
  keys.optional("pulse", yaml::MappingOf(read_pulse<Of>), shapes.pulse);
  keys.optional("table", yaml::MappingOf(read_table<Of>), shapes.table);
}

template <class Of>
bool read_term(const yaml::Value& value, Profile& into) {
  if (value.node->kind == yaml::Node::Kind::scalar) {
    const yaml::Quantity quantity =
        yaml::read_quantity(value.node->text, value.node->quoted, Of::value);
    if (!quantity.value) return value.refuse(quantity.fault, Of::term);
    into.emplace_back(*quantity.value);
    value.note(*quantity.value, Of::value);
    return true;
  }
  if (value.node->kind != yaml::Node::Kind::mapping) return value.refuse("", Of::term);
  Shapes shapes;
  if (!yaml::MappingOf(read_shapes<Of>).read(value, shapes)) return false;
  if (shapes.sinusoid) into.emplace_back(*shapes.sinusoid);
  if (shapes.ramp) into.emplace_back(*shapes.ramp);
  if (shapes.pulse) into.emplace_back(*shapes.pulse);
  if (shapes.table) into.emplace_back(std::move(*shapes.table));
  return true;
}

}  // namespace

std::string ProfileRule::allowed() const {
  const std::string_view term = of == ProfileOf::torque  ? OfTorque::term
                                : of == ProfileOf::force ? OfForce::term
                                                         : OfAngle::term;
  return std::string(term) + ", or a list of these: their sum";
}

yaml::Declared ProfileRule::declared() const {
  const auto sum_of = [](yaml::Dimension dimension, yaml::Declared shapes) {
    const auto term = yaml::Declared::any({yaml::Declared::number(dimension), std::move(shapes)});
    auto sum = yaml::Declared::any({term, yaml::Declared::list(1, most_terms, term)});
    sum.definition = "profile of " + std::string(yaml::noun(dimension));
    std::ranges::replace(sum.definition, ' ', '_');
    return sum;
  };
  switch (of) {
    case ProfileOf::torque:
      return sum_of(OfTorque::value, yaml::MappingOf(read_shapes<OfTorque>).declared());
    case ProfileOf::force:
      return sum_of(OfForce::value, yaml::MappingOf(read_shapes<OfForce>).declared());
    case ProfileOf::angle:
      break;
  }
  return sum_of(OfAngle::value, yaml::MappingOf(read_shapes<OfAngle>).declared());
}

bool ProfileRule::read(const yaml::Value& value, Profile& into) const {
  const auto term = of == ProfileOf::torque  ? read_term<OfTorque>
                    : of == ProfileOf::force ? read_term<OfForce>
                                             : read_term<OfAngle>;
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
