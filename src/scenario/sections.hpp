// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The sections of a scenario, each read by one function (schema.hpp).
#pragma once

#include "scenario/scenario.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

void read_ball(yaml::Keys& keys, Ball& ball);
// Of the scenario's keys, after read_ball and read_time.
void read_ball_push(yaml::Keys& scenario, Ball& ball);
void read_plate(yaml::Keys& keys, Plate& plate);
void read_events(yaml::Keys& keys, Events& events);
void read_time(yaml::Keys& keys, OutputTimes& time);
void read_gimbal(yaml::Keys& keys, Gimbal& gimbal);
void read_controller(yaml::Keys& keys, Controller& controller);
void read_reference(yaml::Keys& keys, Reference& reference);
void read_solver(yaml::Keys& keys, Solver& solver);
void read_output(yaml::Keys& keys, Output& output);
void read_sweep(yaml::Keys& keys, Sweep& sweep);

// All of them.
void read_sections(yaml::Keys& keys, Scenario& scenario);

// The tree of a scenario's text with all overrides applied; nullptr, with the problems reported, if
// the text holds none.
[[nodiscard]] const yaml::Node* build_tree(const Source& source, yaml::Problems& problems,
                                           yaml::Nodes& nodes);

// What must hold between the sections: whether a controller or a prescribed motion moves the
// gimbal, and what may stand beside each.
void check_loop(yaml::Keys& scenario);

// What parts of the rig ask of each other: a servo limit of a servo, a sensor of samples, an edge
// of a plate. After check_loop.
void check_rig(yaml::Keys& keys, const Scenario& scenario);

}  // namespace bbsim::scenario
