// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `controller`: laws, sampling, delays, sensors, limits.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "scenario/period.hpp"
#include "scenario/profile.hpp"
#include "scenario/sections.hpp"
#include "scenario/table_rows.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

void read_pd(yaml::Keys& keys, Controller& controller) {
  keys.required("kv", yaml::GainMatrix{}, controller.kv);
  keys.required("kp", yaml::GainMatrix{}, controller.kp);
}

void read_pid(yaml::Keys& keys, Controller& controller) {
  read_pd(keys, controller);
  keys.required("ki", yaml::GainMatrix{}, controller.ki);
}

void read_state_feedback(yaml::Keys& keys, Controller& controller) {
  keys.required("gain", yaml::StateGain{}, controller.gain);
}

void read_lqr(yaml::Keys& keys, Controller& controller) {
  LqrWeights& weights = controller.weights;
  const yaml::Number weight{yaml::Dimension::number, {.at_least = 0}, "1"};
  keys.required("position", yaml::Number{yaml::Dimension::number, {.above = 0}, "1"},
                weights.position);
  keys.optional("velocity", weight, weights.velocity);
  keys.optional("angle", weight, weights.angle);
  keys.optional("rate", weight, weights.rate);
  keys.required("command", yaml::Number{yaml::Dimension::number, {.above = 0}, "0.1"},
                weights.command);
}

void read_commands(yaml::Keys& keys, Controller& controller) {
  CommandProfiles commands;
  const bool phi = keys.find("phi").has_value(), theta = keys.find("theta").has_value();
  keys.optional("phi", ProfileRule{}, commands.phi);
  keys.optional("theta", ProfileRule{}, commands.theta);
  if (!phi && !theta) keys.missing("phi", "profiles of phi and theta, or of one of them");
  controller.reference = std::move(commands);
}

struct NamedLaw {
  std::string_view key;
  Law law;
  void (*read)(yaml::Keys&, Controller&);
};
constexpr NamedLaw laws[] = {
    {"pd", Law::pd, read_pd},
    {"pid", Law::pid, read_pid},
    {"state_feedback", Law::state_feedback, read_state_feedback},
    {"lqr", Law::lqr, read_lqr},
    {"gravity_compensation", Law::gravity_compensation, read_pd},
    {"feedback_linearization", Law::feedback_linearisation, read_pd},
    {"commands", Law::commands, read_commands},
    {"program", Law::own, read_program},
    {"library", Law::own, read_library},
};

void read_law(yaml::Keys& keys, Controller& controller) {
  std::vector<std::string_view> names;
  std::vector<const NamedLaw*> given;
  for (const NamedLaw& law : laws) {
    names.push_back(law.key);
    if (keys.find(law.key, yaml::MappingOf(law.read))) given.push_back(&law);
  }
  keys.one_of(names);
  if (given.empty()) {
    keys.missing("pd", yaml::MappingOf(read_pd).allowed() +
                           "; or another law: " + yaml::comma_separated(names));
    return;
  }
  if (given.size() > 1) {
    const yaml::Value first = *keys.find(given[0]->key);
    keys.find(given[1]->key)
        ->report("found beside " + std::string(first.name()) + "; allowed: one law");
  }
  controller.law = given[0]->law;
  keys.section(given[0]->key, given[0]->read, controller);
}

// The standard deviation of the period, or a file of measured periods.
struct Jitter {
  [[nodiscard]] static std::string allowed() {
    return number().allowed() + ", or {file: periods.csv, period: column}";
  }
  [[nodiscard]] static yaml::Number number() {
    return {yaml::Dimension::time, {.at_least = 0}, "\"1 ms\""};
  }
  // Warns if the mean of the measured periods is far above the nominal period.
  static void warn_of_periods(const yaml::Value& table, const Sampling& sampling) {
    const double mean = std::accumulate(sampling.periods.begin(), sampling.periods.end(), 0.0) /
                        static_cast<double>(sampling.periods.size());
    const auto doubt = doubt_of_span(mean, sampling.period);
    if (!doubt || !(sampling.period > 0)) return;
    warn_of_unit(table, sampling.periods_file,
                 "the mean period is " + number_text(mean) + ", for one of " +
                     number_text(sampling.period) + " s",
                 yaml::Dimension::time, *doubt, "unit");
  }
  static void read_file(yaml::Keys& keys, Sampling& sampling) {
    FileColumns read;
    if (!read_columns(keys, {"period"}, yaml::Dimension::time, read)) return;
    sampling.periods_file = std::move(read.file);
    sampling.periods = std::move(read.columns[0]);
    if (!read.has_unit) warn_of_periods(keys.mapping(), sampling);
    if (sampling.periods.empty()) {
      keys.mapping().report(yaml::shown(sampling.periods_file) +
                            ": found no rows; allowed: at least one period");
    }
    for (std::size_t i = 0; i < sampling.periods.size(); ++i) {
      if (sampling.periods[i] > 0) continue;
      keys.mapping().report(yaml::shown(sampling.periods_file) + ": found the period " +
                            number_text(sampling.periods[i]) + " in row " + std::to_string(i + 1) +
                            " below the header; allowed: periods greater than 0, in s");
      return;
    }
  }
  [[nodiscard]] static yaml::Declared declared() {
    return yaml::Declared::any({number().declared(), yaml::MappingOf(read_file).declared()});
  }
  [[nodiscard]] static std::string text_of(const Sampling& sampling) {
    return number_text(sampling.jitter);
  }
  static bool read(const yaml::Value& value, Sampling& into) {
    if (value.node->kind == yaml::Node::Kind::mapping) {
      return yaml::MappingOf(read_file).read(value, into);
    }
    if (value.node->kind != yaml::Node::Kind::scalar) return value.refuse("", allowed());
    return number().read(value, into.jitter);
  }
};

void read_sampling(yaml::Keys& keys, Sampling& sampling) {
  const yaml::Number time{yaml::Dimension::time, {.at_least = 0}};
  const yaml::Number period{yaml::Dimension::time, {.above = 0}, period_example};
  keys.required("period", Period{{period, "ms", 1}}, sampling.period);
  keys.optional("delay", time, sampling.delay);
  keys.optional("resolution", yaml::angle_limit({.at_least = 0}, 0.15), sampling.resolution);
  keys.optional("derivative_filter", time, sampling.derivative_filter);
  keys.optional("jitter", Jitter{}, sampling);
}

// One factor for both axes, or one for each.
struct Scale {
  [[nodiscard]] static std::string allowed() {
    return "a number greater than 0, such as 1.02, or two of them, [x, y]";
  }
  [[nodiscard]] static yaml::Declared declared() {
    const auto factor = yaml::Declared::number(yaml::Dimension::number, {.above = 0});
    return yaml::Declared::any({factor, yaml::Declared::list(2, 2, factor)});
  }
  [[nodiscard]] static std::string text_of(const Pair& scale) { return number_text(scale[0]); }
  static bool read(const yaml::Value& value, Pair& into) {
    const yaml::Number factor{yaml::Dimension::number, {.above = 0}, "1.02"};
    if (value.node->kind == yaml::Node::Kind::sequence) {
      if (value.node->items.size() != 2) return value.refuse("", allowed());
      const bool first = factor.read(value.item(0), into[0]);
      return factor.read(value.item(1), into[1]) && first;
    }
    if (value.node->kind != yaml::Node::Kind::scalar) return value.refuse("", allowed());
    double both = 1;
    if (!factor.read(value, both)) return false;
    into = {both, both};
    return true;
  }
};

// [x0, y0, x1, y1]: opposite corners of a rectangle.
struct Zone {
  [[nodiscard]] static std::string allowed() {
    return "four lengths [x0, y0, x1, y1] with x0 < x1 and y0 < y1, such as [0.05, -0.1, 0.08, "
           "0.1]";
  }
  [[nodiscard]] static yaml::Declared declared() {
    return yaml::Declared::list(4, 4, yaml::Declared::number(yaml::Dimension::length));
  }
  static bool read(const yaml::Value& value, std::array<double, 4>& into) {
    if (value.node->kind != yaml::Node::Kind::sequence || value.node->items.size() != into.size()) {
      return value.refuse("", allowed());
    }
    bool fine = true;
    for (std::size_t i = 0; i < into.size(); ++i) {
      fine = yaml::Number{yaml::Dimension::length}.read(value.item(i), into[i]) && fine;
    }
    if (fine && !(into[0] < into[2] && into[1] < into[3])) {
      return value.report("found corners in another order; allowed: " + allowed());
    }
    return fine;
  }
};

void read_fault(yaml::Keys& keys, SensorFault& fault) {
  const yaml::Range chance{.above = 0, .at_most = 1};
  keys.required("probability", yaml::Number{yaml::Dimension::number, chance, "0.01"},
                fault.probability);
  const yaml::Number duration{yaml::Dimension::time, {.above = 0}};
  keys.required("duration", yaml::Usual{duration, "ms", 10}, fault.duration);
}

void read_sensor(yaml::Keys& keys, Sensor& sensor) {
  const yaml::Number length{yaml::Dimension::length, {.at_least = 0}};
  const yaml::Usual fine{length, "mm", 0.05};
  keys.optional("resolution", fine, sensor.resolution);
  keys.optional("noise", fine, sensor.noise);
  auto seed = static_cast<double>(sensor.seed);
  if (keys.optional("seed", yaml::Whole{0, "1"}, seed)) {
    sensor.seed = static_cast<std::uint64_t>(seed);
  }
  const yaml::Number delay{yaml::Dimension::time, {.at_least = 0}};
  keys.optional("delay", yaml::Usual{delay, "ms", 1}, sensor.delay);
  keys.optional("dropout",
                yaml::Number{yaml::Dimension::number, {.at_least = 0, .at_most = 1}, "0.05"},
                sensor.dropout);
  const yaml::MappingOf fault(read_fault);
  keys.optional("stuck", fault, sensor.stuck);
  keys.optional("burst", fault, sensor.burst);
  keys.optional("area", yaml::SidesOf{}, sensor.area);
  keys.optional("dead_zones",
                yaml::ListOf<Zone, std::array<double, 4>>{{}, 1, 100, "zones [x0, y0, x1, y1]"},
                sensor.dead_zones);
  keys.optional("contact_force", yaml::Number{yaml::Dimension::force, {.at_least = 0}},
                sensor.contact_force);
  keys.optional("on_miss",
                yaml::NameOf<OnMiss>{
                    {{OnMiss::none, "none"}, {OnMiss::last, "last"}, {OnMiss::edge, "edge"}}},
                sensor.on_miss);
  keys.optional("rotation", yaml::Number{yaml::Dimension::angle}, sensor.rotation);
  keys.optional("offset", yaml::PairOf{yaml::Dimension::length}, sensor.offset);
  keys.optional("scale", Scale{}, sensor.scale);
  const yaml::Number period{yaml::Dimension::time, {.above = 0}, period_example};
  keys.optional("period", Period{{period, "ms", std::numeric_limits<double>::max()}},
                sensor.period);
  keys.optional("phase", yaml::Number{yaml::Dimension::time, {.at_least = 0}}, sensor.phase);
}

// How the controller converts angles of the plate: a name, or the legs that it assumes.
struct AssumesRule {
  [[nodiscard]] static yaml::NameOf<Assumes> names() {
    return {{{Assumes::exact, "exact"}, {Assumes::ratio, "ratio"}}};
  }
  [[nodiscard]] static std::string allowed() {
    return names().allowed() + ", or three legs as in gimbal.three_servos";
  }
  [[nodiscard]] static yaml::Declared declared() {
    return yaml::Declared::any({names().declared(), yaml::MappingOf(read_three_servos).declared()});
  }
  static bool read(const yaml::Value& value, Controller& into) {
    if (value.node->kind != yaml::Node::Kind::mapping) {
      return names().read(value, into.assumes.emplace());
    }
    ThreeServos legs;
    const bool fine = yaml::MappingOf(read_three_servos).read(value, legs);
    into.assumes = Assumes::exact;
    into.assumed_legs = legs.plate;
    return fine;
  }
};

// One limit for both axes, or one for each.
struct CommandLimit {
  bool of_angle;

  [[nodiscard]] std::string allowed() const { return one() + ", or {phi: ..., theta: ...}"; }
  [[nodiscard]] std::string one() const {
    return of_angle ? yaml::angle_limit({.above = 0}).allowed() : number().allowed();
  }
  [[nodiscard]] static yaml::Number number() {
    return {yaml::Dimension::number, {.above = 0}, "5"};
  }
  // Declares angles. limit_of_numbers() in json_schema.cpp refuses units for other commands.
  [[nodiscard]] static yaml::Declared declared() {
    const auto one = yaml::Declared::number(yaml::Dimension::angle, {.above = 0});
    yaml::Declared axes(yaml::Declared::Kind::mapping);
    axes.keys = {{"phi", one, false, {}}, {"theta", one, false, {}}};
    axes.choices = {{{{"phi", "theta"}}, true}};
    return yaml::Declared::any({one, axes});
  }
  bool read_one(const yaml::Value& value, double& into) const {
    return of_angle ? yaml::angle_limit({.above = 0}).read(value, into)
                    : number().read(value, into);
  }
  bool read(const yaml::Value& value, Controller& into) const {
    if (value.node->kind != yaml::Node::Kind::mapping) {
      return read_one(value, into.limit.emplace());
    }
    yaml::Keys keys(value);
    auto& limits = into.axis_limits.emplace();
    bool fine = true;
    constexpr std::string_view names[] = {"phi", "theta"};
    for (std::size_t i = 0; i < 2; ++i) {
      if (const auto given = keys.find(names[i])) {
        fine = read_one(*given, limits[i].emplace()) && fine;
      }
    }
    if (!limits[0] && !limits[1]) fine = value.refuse("", allowed());
    keys.finish();
    return fine;
  }
};

}  // namespace

void read_controller(yaml::Keys& keys, Controller& controller) {
  read_law(keys, controller);
  keys.optional("drives",
                yaml::NameOf<Drives>{{{Drives::acceleration, name_of(Drives::acceleration)},
                                      {Drives::angle, name_of(Drives::angle)},
                                      {Drives::torque, name_of(Drives::torque)},
                                      {Drives::voltage, name_of(Drives::voltage)},
                                      {Drives::legs, name_of(Drives::legs)}}},
                controller.drives);
  const yaml::MappingOf path(read_reference);
  if (const auto given = keys.find("reference", path); controller.law != Law::commands) {
    keys.section("reference", read_reference, controller.reference);
  } else if (given) {
    given->report("found beside commands, which follow no path; allowed: without it");
  }
  keys.optional("limit", CommandLimit{drives_servos(controller.drives)}, controller);
  keys.optional("assumes", AssumesRule{}, controller);
  keys.optional("sampling", yaml::MappingOf(read_sampling), controller.sampling);
  keys.optional("sensor", yaml::MappingOf(read_sensor), controller.sensor);
}

}  // namespace bbsim::scenario
