// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The readers of a scenario's sections, one function each (schema.hpp).
#pragma once

#include "scenario/scenario.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

void read_ball(yaml::Keys& keys, Ball& ball);
// Takes the keys of the scenario. Call it after read_ball and read_time.
void read_ball_push(yaml::Keys& scenario, Ball& ball);
void read_plate(yaml::Keys& keys, Plate& plate);
void read_events(yaml::Keys& keys, Events& events);
void read_time(yaml::Keys& keys, OutputTimes& time);
void read_gimbal(yaml::Keys& keys, Gimbal& gimbal);
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

}  // namespace bbsim::scenario
