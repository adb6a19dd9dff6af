// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The one table of output columns: CSV headers, HDF5 datasets, `bbsim columns` and the docs. How
// each is computed is record/column_values.hpp's matter.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/scenario.hpp"

namespace bbsim::scenario {

// What a column is computed from, those that need the dynamics last: the ball's motion; its angle
// gamma, and of all rows so far its orientation; the gimbal's angles and rates, and its
// accelerations; the angles of servos, and of a third one; what is there with a controller, its
// commands, and what is there with one in discrete time; a number that one's own controller gives
// beside its commands; forces; forces where the plate's inertia is known, where torques move the
// gimbal, where DC motors do; and `coupled` where the ball has losses or may slide, or torques move
// the gimbal, `pushed` where something pushes it.
enum class Needs {
  ball,
  gamma,
  orientation,
  gimbal,
  accelerations,
  servos,
  third_servo,
  controller,
  commands,
  samples,
  own,
  dynamics,
  plate,
  torques,
  armature,
  coupled,
  pushed
};

struct Column {
  std::string_view name;
  std::string_view unit;     // "1" if dimensionless
  std::string_view meaning;  // one phrase, without a full stop
  Needs needs;
};

// All columns, in the order of `bbsim columns`.
inline constexpr std::array catalogue = {
    Column{"t", "s", "time", Needs::ball},
    Column{"x", "m", "contact point along the plate's x axis", Needs::ball},
    Column{"y", "m", "contact point along the plate's y axis", Needs::ball},
    Column{"distance", "m", "distance of the contact point from the plate's origin", Needs::ball},
    Column{"vx", "m/s", "velocity of the contact point in the plate frame, x'", Needs::ball},
    Column{"vy", "m/s", "velocity of the contact point in the plate frame, y'", Needs::ball},
    Column{"spin", "rad/s", "ball's rate of turn about the plate's normal, relative to the plate",
           Needs::ball},
    Column{"gamma", "rad", "ball's turn about the plate's normal since the start: integral of spin",
           Needs::gamma},
    Column{"ball_qw", "1", "ball's orientation in the plate frame, a unit quaternion: scalar part",
           Needs::orientation},
    Column{"ball_qx", "1", "ball's orientation: x part of the quaternion, 0 at the start",
           Needs::orientation},
    Column{"ball_qy", "1", "ball's orientation: y part", Needs::orientation},
    Column{"ball_qz", "1", "ball's orientation: z part", Needs::orientation},
    Column{"phi", "rad", "first (outer) gimbal angle, about the fixed y axis", Needs::gimbal},
    Column{"theta", "rad", "second (inner) gimbal angle, about the x axis that phi carries",
           Needs::gimbal},
    Column{"phi_rate", "rad/s", "rate of phi", Needs::gimbal},
    Column{"theta_rate", "rad/s", "rate of theta", Needs::gimbal},
    Column{"phi_acceleration", "rad/s^2", "acceleration of phi", Needs::accelerations},
    Column{"theta_acceleration", "rad/s^2", "acceleration of theta", Needs::accelerations},
    Column{"servo_phi", "rad",
           "angle of phi's servo, before backlash and linkage; with three servos, of the first",
           Needs::servos},
    Column{"servo_theta", "rad",
           "angle of theta's servo, before backlash and linkage; with three servos, of the second",
           Needs::servos},
    Column{"servo_third", "rad", "angle of the third of three servos", Needs::third_servo},
    Column{"push_x", "N", "push on the ball's center along the plate's x axis", Needs::pushed},
    Column{"push_y", "N", "push on the ball's center along the plate's y axis", Needs::pushed},
    Column{"x_reference", "m", "where the controller wants x", Needs::controller},
    Column{"y_reference", "m", "where the controller wants y", Needs::controller},
    Column{"tracking_error", "m", "distance of the contact point from its reference",
           Needs::controller},
    Column{"phi_command", "rad",
           "command for phi: an angle; rad/s^2, N m or V if the controller drives accelerations, "
           "torques or voltages",
           Needs::commands},
    Column{"theta_command", "rad",
           "command for theta: an angle; rad/s^2, N m or V if the controller drives accelerations, "
           "torques or voltages",
           Needs::commands},
    Column{"x_measured", "m", "x that the sensor measured last", Needs::samples},
    Column{"y_measured", "m", "y that the sensor measured last", Needs::samples},
    Column{"tilt", "rad", "angle between the plate's normal and the vertical", Needs::gimbal},
    Column{"tilt_rate", "rad/s", "size of the plate's angular velocity", Needs::gimbal},
    Column{"singularity_distance", "1",
           "distance from the state in which no gimbal accelerations give the ball the wanted "
           "acceleration: 0 there, 1 at home on the paper's gimbal",
           Needs::gimbal},
    Column{"normal_force", "N",
           "force of the plate on the ball along the normal; contact needs > 0", Needs::dynamics},
    Column{"friction_force", "N", "size of the force of the plate on the ball along the plate",
           Needs::dynamics},
    Column{"friction_demand", "1",
           "friction_force / normal_force; rolling needs it below the friction coefficient, and it "
           "grows to infinity at lift-off; of a sliding ball, its coefficient of friction",
           Needs::dynamics},
    Column{"torque_phi", "N m", "motor torque about phi's axis that carries the ball",
           Needs::dynamics},
    Column{"torque_theta", "N m", "motor torque about theta's axis that carries the ball",
           Needs::dynamics},
    Column{"motor_torque_phi", "N m", "motor torque about phi's axis that carries ball and plate",
           Needs::plate},
    Column{"motor_torque_theta", "N m",
           "motor torque about theta's axis that carries ball and plate", Needs::plate},
    Column{"motor_power", "W", "power of the two motors with ball and plate", Needs::plate},
    Column{"energy", "J",
           "ball's kinetic and potential energy; potential is 0 at the gimbal's center",
           Needs::dynamics},
    Column{"power", "W",
           "power of the two motor torques that carry the ball: the rate of change of energy, "
           "except for losses",
           Needs::dynamics},
    Column{"push_power", "W", "power of the push on the ball", Needs::pushed},
    Column{"total_energy", "J",
           "kinetic and potential energy of ball, plate, ring and the motors' rotors",
           Needs::dynamics},
    Column{"slip_x", "m/s", "velocity of the ball's surface over the plate at the contact, along x",
           Needs::coupled},
    Column{"slip_y", "m/s", "velocity of the ball's surface over the plate at the contact, along y",
           Needs::coupled},
    Column{"loss_power", "W",
           "power lost to the ball's couples, to sliding and in the motors' friction",
           Needs::coupled},
    Column{"energy_lost", "J", "energy lost since the start: integral of loss_power",
           Needs::coupled},
    Column{
        "motor_work", "J",
        "work of the motors on ball, plate, ring and rotors since the start, before their friction",
        Needs::coupled},
    Column{"phi_torque_asked", "N m", "torque asked of phi's motor, before its limits",
           Needs::torques},
    Column{"theta_torque_asked", "N m", "torque asked of theta's motor, before its limits",
           Needs::torques},
    Column{"phi_torque", "N m", "torque that phi's motor gives, before its friction",
           Needs::torques},
    Column{"theta_torque", "N m", "torque that theta's motor gives, before its friction",
           Needs::torques},
    Column{"phi_current", "A", "current of phi's motor", Needs::armature},
    Column{"theta_current", "A", "current of theta's motor", Needs::armature},
    Column{"phi_voltage", "V", "voltage of phi's motor", Needs::armature},
    Column{"theta_voltage", "V", "voltage of theta's motor", Needs::armature},
    Column{"electrical_power", "W", "voltage times current of the two motors", Needs::armature},
};

// The column of that name, or nullptr. Numbers of one's own controller are found once a scene has
// asked for them by that name.
[[nodiscard]] const Column* find_column(std::string_view name);

// The column of a number that one's own controller gives by that name, for which is_own_name()
// holds and which is not in the catalogue. It stays as long as the program.
const Column& own_column(std::string_view name);

// Whether a number of one's own controller may have that name: letters, digits and underscores, at
// most 60, and no digit first.
[[nodiscard]] bool is_own_name(std::string_view name);

// How many of them a scene may ask for.
inline constexpr std::size_t most_own_columns = 64;

// The names of those that the scene's output columns ask for, in their order.
[[nodiscard]] std::vector<std::string> own_columns(const Scenario& scenario);

// The columns of these names, in this order. Throws InputError for an unknown one.
[[nodiscard]] std::vector<const Column*> columns_named(const std::vector<std::string>& names);

[[nodiscard]] std::vector<std::string> names_of(const std::vector<const Column*>& columns);

[[nodiscard]] bool any_needs(const std::vector<const Column*>& columns, Needs what);

// Whether one of them is computed from forces, torques or energy.
[[nodiscard]] bool need_dynamics(const std::vector<const Column*>& columns);

// Whether one of them is computed from gamma, which the model then integrates.
[[nodiscard]] bool need_gamma(const std::vector<const Column*>& columns);

// Why the scene cannot fill a column, and which ones it can; both null if it can.
struct Missing {
  const char* why = nullptr;
  const char* instead = nullptr;
  explicit operator bool() const { return why != nullptr; }
};
[[nodiscard]] Missing missing(const Column& column, const Scenario& scenario);

}  // namespace bbsim::scenario
