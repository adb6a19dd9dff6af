// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The readers of a scenario's sections, one function each (schema.hpp), and what they share.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {

inline constexpr std::string_view period_example = "0.02, \"20 ms\" or \"30 Hz\"";

// A period, or a number per second: "30 Hz".
struct Period {
  yaml::Usual time;

  [[nodiscard]] std::string allowed() const { return time.allowed(); }
  [[nodiscard]] yaml::Declared declared() const {
    return yaml::Declared::any(
        {time.declared(), yaml::Declared::number(yaml::Dimension::angular_rate, {.above = 0})});
  }
  bool read(const yaml::Value& value, double& into) const {
    if (value.node->kind != yaml::Node::Kind::scalar) return time.read(value, into);
    std::string_view text = value.node->text;
    if (!text.ends_with("Hz")) return time.read(value, into);
    text.remove_suffix(2);
    const bool kilo = text.ends_with('k');
    if (kilo) text.remove_suffix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    const double rate = yaml::read_quantity(text, false, yaml::Dimension::number).value.value_or(0);
    if (!(rate > 0 && rate < std::numeric_limits<double>::infinity())) {
      return value.refuse("", allowed());
    }
    into = 1 / (kilo ? 1e3 * rate : rate);
    return true;
  }
};

// A profile of a gimbal angle, a motor's torque or a force: a number, a shape of ProfileTerm, or a
// list of these, which are summed.
struct ProfileRule {
  yaml::Dimension of = yaml::Dimension::angle;
  [[nodiscard]] std::string allowed() const;
  [[nodiscard]] yaml::Declared declared() const;
  bool read(const yaml::Value& value, Profile& into) const;
};

void read_ball(yaml::Keys& keys, Ball& ball);
// Takes the keys of the scenario. Call it after read_ball and read_time.
void read_ball_push(yaml::Keys& scenario, Ball& ball);
void read_plate(yaml::Keys& keys, Plate& plate);
void read_events(yaml::Keys& keys, Events& events);
void read_time(yaml::Keys& keys, OutputTimes& time);
void read_gimbal(yaml::Keys& keys, Gimbal& gimbal);
// The keys of a servo, with its present values for defaults.
[[nodiscard]] yaml::Declared declared_servo(const Servo& servo);
// Three servos, and the servo of legs without their own.
struct ThreeServos {
  ThreeServoPlate plate;
  std::optional<Servo> servo{};
};
void read_three_servos(yaml::Keys& keys, ThreeServos& of);
void read_controller(yaml::Keys& keys, Controller& controller);
void read_program(yaml::Keys& keys, Controller& controller);
void read_library(yaml::Keys& keys, Controller& controller);
void read_reference(yaml::Keys& keys, Reference& reference);
void read_solver(yaml::Keys& keys, Solver& solver);
void read_output(yaml::Keys& keys, Output& output);
void read_sweep(yaml::Keys& keys, Sweep& sweep);

// Reads all sections and checks them.
void read_sections(yaml::Keys& keys, Scenario& scenario);

// No problems yet of a scenario's text and overrides, and of the settings of one case.
[[nodiscard]] yaml::Problems problems_of(const Source& source,
                                         std::vector<std::string> settings = {});

// The tree of a scenario's text with all overrides applied. Reports problems. Returns nullptr if
// the text is not a tree.
[[nodiscard]] const yaml::Node* build_tree(const Source& source, yaml::Problems& problems,
                                           yaml::Nodes& nodes);

// Checks what lies between keys: their relations, and values that do not go together.
void check_rig(const yaml::Value& root, const Scenario& scenario);

// Why the scene does not move along x (0) or y (1) alone; empty if it does.
[[nodiscard]] std::string why_not_along(int axis, const Scenario& scene);

// Sets the axis of a ball in a groove or between rails and the coordinate that its sensor measures.
// Call it after all sections are read.
void place_groove(Scenario& scene);

}  // namespace bbsim::scenario
