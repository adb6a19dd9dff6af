// The sections of a scenario, each read by one function (schema.hpp).
#pragma once

#include "scenario/scenario.hpp"
#include "scenario/schema.hpp"

namespace bbsim::input {

void read_ball(Keys& keys, Ball& ball);
void read_plate(Keys& keys, Plate& plate);
void read_events(Keys& keys, Events& events);
void read_time(Keys& keys, OutputTimes& time);
void read_gimbal(Keys& keys, Gimbal& gimbal);
void read_controller(Keys& keys, Controller& controller);
void read_reference(Keys& keys, Reference& reference);
void read_solver(Keys& keys, Solver& solver);
void read_output(Keys& keys, Output& output);
void read_sweep(Keys& keys, Sweep& sweep);

// All of them.
void read_sections(Keys& keys, Scenario& scenario);

// The tree of a scenario's text with all overrides applied; nullptr, with the problems reported, if
// the text holds none.
[[nodiscard]] const Node* build_tree(const Source& source, Problems& problems, Nodes& nodes);

// What must hold between the sections: whether a controller or a prescribed motion moves the
// gimbal, and what may stand beside each.
void check_loop(Keys& scenario);

// What parts of the rig ask of each other: a servo limit of a servo, a sensor of samples, an edge
// of a plate. After check_loop.
void check_rig(Keys& keys, const Scenario& scenario);

}  // namespace bbsim::input
