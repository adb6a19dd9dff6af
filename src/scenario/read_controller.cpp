// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `controller`: laws, sampling, delays, sensors, limits.
#include <limits>
#include <numeric>
#include <utility>

#include "scenario/sections.hpp"
#include "scenario/table_rows.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

void read_pd(yaml::Keys& keys, Controller& controller) {
  keys.required(
      "kv", yaml::GainMatrix{}, controller.kv,
      {"gains of the error (`kp`) and of its rate (`kv`): 2x2; rows phi, theta; columns x, "
       "y: [[k, 0], [0, -k]] (*Signs*, below). A number k stands for [[k, 0], [0, k]]; under "
       "`drives: angle`, only 0 is allowed",
       "below"});
  keys.required("kp", yaml::GainMatrix{}, controller.kp, yaml::same);
}

void read_pid(yaml::Keys& keys, Controller& controller) {
  keys.about(
      {"kv"},
      {"gains of the error (`kp`), of its rate (`kv`) and of its integral (`ki`), as in `pd`",
       "below"});
  read_pd(keys, controller);
  keys.required("ki", yaml::GainMatrix{}, controller.ki, yaml::same);
}

void read_gravity_compensation(yaml::Keys& keys, Controller& controller) {
  keys.about(
      {"kv"},
      {"gains of the error (`kp`) and of its rate (`kv`): a number or 2x2; rows x, y; columns x, y",
       "1/s, 1/s²"});
  read_pd(keys, controller);
}

void read_feedback_linearisation(yaml::Keys& keys, Controller& controller) {
  keys.about({"kv"},
             {"gains of the error (`kp`) and of its rate (`kv`), as in `gravity_compensation`",
              "1/s, 1/s²"});
  read_pd(keys, controller);
}

void read_state_feedback(yaml::Keys& keys, Controller& controller) {
  keys.required(
      "gain", yaml::StateGain{}, controller.gain,
      {"K: rows phi, theta, each of 4 numbers (x, y, vx, vy) or 8 (phi, theta and their rates too)",
       "below"});
}

void read_lqr(yaml::Keys& keys, Controller& controller) {
  LqrWeights& weights = controller.weights;
  const yaml::Number weight{yaml::Dimension::number, {.at_least = 0}, "1"};
  keys.required("position", yaml::Number{yaml::Dimension::number, {.above = 0}, "1"},
                weights.position, {"weight of x² and y²", "1/m²"});
  keys.optional("velocity", weight, weights.velocity, {"weight of vx² and vy²", "1/(m/s)²"});
  keys.optional("angle", weight, weights.angle, {"weight of the servos' angles²", "1/rad²"});
  keys.optional("rate", weight, weights.rate, {"weight of their rates²", "1/(rad/s)²"});
  keys.required("command", yaml::Number{yaml::Dimension::number, {.above = 0}, "0.1"},
                weights.command, {"weight of $u_\\phi^2$ and $u_\\theta^2$", "1/command²"});
}

void read_commands(yaml::Keys& keys, Controller& controller) {
  CommandProfiles commands;
  const bool phi = keys.find("phi").has_value(), theta = keys.find("theta").has_value();
  keys.optional(
      "phi", ProfileRule{}, commands.phi,
      {.meaning =
           "[profiles](#profiles): commands that are known beforehand, whatever the ball does",
       .standard = "0"});
  keys.optional("theta", ProfileRule{}, commands.theta, yaml::same);
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
    {"gravity_compensation", Law::gravity_compensation, read_gravity_compensation},
    {"feedback_linearization", Law::feedback_linearisation, read_feedback_linearisation},
    {"commands", Law::commands, read_commands},
    {"program", Law::own, read_program},
    {"library", Law::own, read_library},
};

void read_law(yaml::Keys& keys, Controller& controller) {
  std::vector<std::string_view> names;
  std::vector<const NamedLaw*> given;
  for (const NamedLaw& law : laws) {
    names.push_back(law.key);
    const yaml::About about{law.law == Law::own
                                ? "a controller of your own: [controllers.md](controllers.md#keys)"
                            : law.law == Law::commands ? ""
                                                       : "one of the built-in [laws](#laws)",
                            {},
                            "-"};
    if (keys.find(law.key, yaml::MappingOf(law.read), about)) given.push_back(&law);
  }
  keys.one_of(names);
  if (given.empty()) {
    keys.missing("pd", yaml::MappingOf(read_pd).allowed() + "; or another law: " + joined(names));
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
    keys.about({"file"}, {.meaning = "instead of a number: a table of measured periods, and its "
                                     "column; after the last period it starts again",
                          .standard = "-"});
    keys.about({"unit"}, {.meaning = "unit of these periods", .standard = "s"});
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
  keys.required("period", Period{{period, "ms", 1}}, sampling.period,
                {"a sample at t = 0 and every period after"});
  keys.optional("delay", time, sampling.delay,
                {.meaning = "from a sample to its command; may exceed a period",
                 .range = "0 to 100 periods"});
  keys.optional("resolution", yaml::angle_limit({.at_least = 0}, 0.15), sampling.resolution,
                {"the command is rounded to the nearest multiple; 0 does not round"});
  keys.optional("derivative_filter", time, sampling.derivative_filter,
                {"time constant of the filter of velocities"});
  keys.optional("jitter", Jitter{}, sampling, {"standard deviation of a period"});
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
      const std::string what = allowed();
      return yaml::ArrayOf<2>{factor, what}.read(value, into);
    }
    if (value.node->kind != yaml::Node::Kind::scalar) return value.refuse("", allowed());
    double both = 1;
    if (!factor.read(value, both)) return false;
    into = {both, both};
    return true;
  }
};

// [x0, y0, x1, y1]: opposite corners of a rectangle.
struct Zone : yaml::ArrayOf<4> {
  Zone()
      : ArrayOf{{yaml::Dimension::length},
                "four lengths [x0, y0, x1, y1] with x0 < x1 and y0 < y1, such as [0.05, -0.1, "
                "0.08, 0.1]"} {}
  bool read(const yaml::Value& value, std::array<double, 4>& into) const {
    const bool fine = ArrayOf::read(value, into);
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

void read_stuck(yaml::Keys& keys, SensorFault& fault) {
  keys.about({"probability"}, {"probability that the sensor sticks at a reading"});
  keys.about({"duration"}, {"time for which it then repeats this reading"});
  read_fault(keys, fault);
}

void read_burst(yaml::Keys& keys, SensorFault& fault) {
  keys.about({"probability"}, {"probability that a frame waits, and others after it"});
  keys.about({"duration"}, {"time for which the first one waits; all then arrive together"});
  read_fault(keys, fault);
}

void read_sensor(yaml::Keys& keys, Sensor& sensor) {
  const yaml::Number length{yaml::Dimension::length, {.at_least = 0}};
  const yaml::Usual fine{length, "mm", 0.05};
  keys.optional("resolution", fine, sensor.resolution,
                {"each coordinate, noise included, is [rounded](#sampling) to the nearest "
                 "multiple; 0 does not round"});
  keys.optional("noise", fine, sensor.noise,
                {"standard deviation of each coordinate: normal, drawn at each sample"});
  auto seed = static_cast<double>(sensor.seed);
  if (keys.optional("seed", yaml::Whole{0, "1"}, seed,
                    {"seed of noise, dropouts, faults and jitter; gives the same numbers on every "
                     "machine"})) {
    sensor.seed = static_cast<std::uint64_t>(seed);
  }
  const yaml::Number delay{yaml::Dimension::time, {.at_least = 0}};
  keys.optional(
      "delay", yaml::Usual{delay, "ms", 1}, sensor.delay,
      {.meaning = "from the measurement to the sample; before t = 0 the ball is where it starts",
       .range = "0 to 100 periods"});
  keys.optional("dropout",
                yaml::Number{yaml::Dimension::number, {.at_least = 0, .at_most = 1}, "0.05"},
                sensor.dropout, {"probability that a sample sees nothing"});
  keys.optional("stuck", yaml::MappingOf(read_stuck), sensor.stuck);
  keys.optional("burst", yaml::MappingOf(read_burst), sensor.burst);
  keys.optional(
      "area", yaml::sides, sensor.area,
      {"[a, b], sides along x and y of the rectangle about the origin in which it sees the ball"});
  keys.optional("dead_zones",
                yaml::ListOf<Zone, std::array<double, 4>>{{}, 1, 100, "zones [x0, y0, x1, y1]"},
                sensor.dead_zones,
                {"rectangles in which it does not: a list of corners [x0, y0, x1, y1] with x0 < "
                 "x1, y0 < y1"});
  keys.optional("contact_force", yaml::Number{yaml::Dimension::force, {.at_least = 0}},
                sensor.contact_force,
                {"least normal force that a touch screen reads; needs `ball.mass`"});
  keys.optional(
      "on_miss",
      yaml::NameOf<OnMiss>{
          {{OnMiss::none, "none"}, {OnMiss::last, "last"}, {OnMiss::edge, "edge"}}},
      sensor.on_miss,
      {"what a sample that sees nothing reads: `none`; `last`: the last reading again; `edge`: the "
       "corner of `area` at its least x and y, as screens that nobody touches"});
  keys.optional("rotation", yaml::Number{yaml::Dimension::angle}, sensor.rotation,
                {"rotation of the measured position"});
  keys.optional("offset", yaml::PairOf{yaml::Dimension::length}, sensor.offset,
                {"offset of the measured position"});
  keys.optional("scale", Scale{}, sensor.scale, {"factor on the measured position, or [x, y]"});
  const yaml::Number period{yaml::Dimension::time, {.above = 0}, period_example};
  keys.optional("period", Period{{period, "ms", std::numeric_limits<double>::max()}}, sensor.period,
                {"period of the sensor's own frames"});
  keys.optional("phase", yaml::Number{yaml::Dimension::time, {.at_least = 0}}, sensor.phase,
                {.meaning = "time of the first frame", .range = "≥ 0, < `period`"});
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

  [[nodiscard]] std::string allowed() const { return single() + ", or {phi: ..., theta: ...}"; }
  [[nodiscard]] std::string single() const {
    return of_angle ? yaml::angle_limit({.above = 0}).allowed() : number().allowed();
  }
  [[nodiscard]] static yaml::Number number() {
    return {yaml::Dimension::number, {.above = 0}, "5"};
  }
  // Declares angles. limit_of_numbers() in json_schema.cpp refuses units for other commands.
  [[nodiscard]] static yaml::Declared declared() {
    const auto angle = yaml::Declared::number(yaml::Dimension::angle, {.above = 0});
    yaml::Declared axes(yaml::Declared::Kind::mapping);
    constexpr yaml::About about{"the same for one axis", "of the command"};
    axes.keys = {{"phi", angle, false, {}, false, about},
                 {"theta", angle, false, {}, false, about}};
    axes.choices = {{{{"phi", "theta"}}, true}};
    return yaml::Declared::any({angle, axes});
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
                controller.drives, {"what the commands are"});
  keys.exclusive({{"reference"}, {"commands"}}, true);
  const yaml::MappingOf path(read_reference);
  if (const auto given =
          keys.find("reference", path,
                    {.meaning = "where the ball should be: [reference paths](#reference-paths)",
                     .standard = "required, except with `commands`"});
      controller.law != Law::commands) {
    keys.section("reference", read_reference, controller.reference);
  } else if (given) {
    given->report("found beside commands, which follow no path; allowed: without it");
  }
  keys.optional(
      "limit", CommandLimit{drives_servos(controller.drives)}, controller,
      {"each command saturates at ± this: a number, or {phi: ..., theta: ...} with one or both",
       "of the command"});
  keys.optional(
      "assumes", AssumesRule{}, controller,
      {.meaning = "how a law converts an angle of the plate into a servo angle; or the keys of "
                  "[three servos](#three-servos), the legs that the firmware assumes",
       .standard = "`ratio`; `exact` with `three_servos`",
       .range = "`exact`, `ratio`"});
  keys.optional(
      "sampling", yaml::MappingOf(read_sampling), controller.sampling,
      {"a discrete-time controller: [sampling](#sampling); without it the law is continuous"});
  keys.optional(
      "sensor", yaml::MappingOf(read_sensor), controller.sensor,
      {"what a sampled controller measures: [sensor](#sensor); without it, the exact position"});
}

}  // namespace bbsim::scenario
