// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The one table of output columns: CSV headers, HDF5 datasets, `bbsim columns`, docs/reference,
// pictures and replays. record/column_values.hpp computes them.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/integrals.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::scenario {

// What a column is computed from. All from `dynamics` on need forces, torques or energy.
enum class Needs {
  ball,           // the ball's motion
  gamma,          // the ball's angle about the normal
  orientation,    // the ball's orientation, from all rows so far
  gimbal,         // the gimbal's angles and rates
  accelerations,  // of the gimbal
  servos,         // angles of servos
  third_servo,    // angle of the third of three servos
  believed,       // angles of two steppers
  legs_believed,  // angles of the steppers of three legs
  controller,     // any controller that follows a path
  commands,       // commands of a controller
  samples,        // a discrete-time controller
  own,            // a number that your own controller gives beside its commands
  dynamics,       // forces and energy
  plate,          // forces, with the plate's inertia
  torques,        // torques that move the gimbal
  armature,       // DC motors that move the gimbal
  coupled,        // is_coupled() or is_linked() (coupled.hpp)
  work,           // the same, and the work of its motors
  pushed          // a push on the ball
};

// The role of a curve in a picture: the main subject, or a curve for comparison.
enum class Role { main, reference, measured, command };

// A panel of a picture.
struct Panel {
  std::string_view name;
  std::string_view heading;  // common quantity of several columns
  std::string_view plot;     // plot of a replay that has its columns; empty if none has
};

// The panels, in their order. A plot of a replay may hold several of them.
inline constexpr std::array panels = {
    Panel{"x", "", "Position"},
    Panel{"y", "", "Position"},
    Panel{"tracking_error", "", "Distance"},
    Panel{"position_error", "", "Error of x, y"},
    Panel{"distance", "", "Distance"},
    Panel{"velocity", "velocity", "Velocity"},
    Panel{"spin", "", "Rates"},
    Panel{"gamma", "", "Turn of the ball"},
    Panel{"orientation", "ball's orientation", ""},
    Panel{"phi", "", "Gimbal"},
    Panel{"theta", "", "Gimbal"},
    Panel{"servos", "servos", "Servos"},
    Panel{"believed", "drivers' angles", "Drivers' angles"},
    Panel{"rates", "rates", "Rates"},
    Panel{"accelerations", "accelerations", "Accelerations"},
    Panel{"tilt", "", "Gimbal"},
    Panel{"tilt_rate", "", "Rates"},
    Panel{"friction", "", "Friction demand"},
    Panel{"forces", "forces", "Forces"},
    Panel{"push", "push", "Push"},
    Panel{"torques", "torque", "Torques"},
    Panel{"motor_torques", "motor torque", "Torques"},
    Panel{"given_torques", "motors' torque", "Motors' torque"},
    Panel{"currents", "motors' current", "Motors' current"},
    Panel{"voltages", "motors' voltage", "Motors' voltage"},
    Panel{"slip", "slip", "Slip"},
    Panel{"power", "power", "Power"},
    Panel{"energy", "energy", "Energy"},
    Panel{"singularity", "", "Distance from singularity"},
    Panel{"none", "", ""},
};

// The plots of a replay, in their order.
inline constexpr std::array<std::string_view, 21> plots = {"Position",
                                                           "Gimbal",
                                                           "Servos",
                                                           "Drivers' angles",
                                                           "Distance",
                                                           "Error of x, y",
                                                           "Velocity",
                                                           "Turn of the ball",
                                                           "Rates",
                                                           "Accelerations",
                                                           "Friction demand",
                                                           "Forces",
                                                           "Push",
                                                           "Motors' torque",
                                                           "Torques",
                                                           "Motors' current",
                                                           "Motors' voltage",
                                                           "Slip",
                                                           "Power",
                                                           "Energy",
                                                           "Distance from singularity"};

struct Column {
  std::string_view name;
  std::string_view symbol;   // in a legend
  std::string_view unit;     // "1" if dimensionless
  std::string_view meaning;  // one phrase, without a period
  Needs needs;
  std::string_view panel = "none";
  Role role = Role::main;
  std::string_view beside{};  // symbol below the panel's heading, if different
};

// All columns, in the order of `bbsim columns`.
inline constexpr std::array catalogue = {
    Column{"t", "t", "s", "time", Needs::ball, "none"},
    Column{"x", "x", "m", "contact point along the plate's x axis", Needs::ball, "x"},
    Column{"y", "y", "m", "contact point along the plate's y axis", Needs::ball, "y"},
    Column{"distance", "distance", "m", "distance of the contact point from the plate's origin",
           Needs::ball, "distance"},
    Column{"vx", "vx", "m/s", "velocity of the contact point in the plate frame, x'", Needs::ball,
           "velocity"},
    Column{"vy", "vy", "m/s", "velocity of the contact point in the plate frame, y'", Needs::ball,
           "velocity"},
    Column{"spin", "spin", "rad/s",
           "ball's rate of turn about the plate's normal, relative to the plate", Needs::ball,
           "spin"},
    Column{"gamma", "γ", "rad",
           "ball's turn about the plate's normal since the start: integral of spin", Needs::gamma,
           "gamma"},
    Column{"ball_qw", "orientation w", "1",
           "ball's orientation in the plate frame, a unit quaternion: scalar part",
           Needs::orientation, "orientation", Role::main, "w"},
    Column{"ball_qx", "orientation x", "1",
           "ball's orientation: x part of the quaternion, 0 at the start", Needs::orientation,
           "orientation", Role::main, "x"},
    Column{"ball_qy", "orientation y", "1", "ball's orientation: y part", Needs::orientation,
           "orientation", Role::main, "y"},
    Column{"ball_qz", "orientation z", "1", "ball's orientation: z part", Needs::orientation,
           "orientation", Role::main, "z"},
    Column{"phi", "φ", "rad", "first (outer) gimbal angle, about the fixed y axis", Needs::gimbal,
           "phi"},
    Column{"theta", "θ", "rad", "second (inner) gimbal angle, about the x axis that phi carries",
           Needs::gimbal, "theta"},
    Column{"phi_rate", "φ'", "rad/s", "rate of phi", Needs::gimbal, "rates"},
    Column{"theta_rate", "θ'", "rad/s", "rate of theta", Needs::gimbal, "rates"},
    Column{"phi_acceleration", "φ''", "rad/s^2", "acceleration of phi", Needs::accelerations,
           "accelerations"},
    Column{"theta_acceleration", "θ''", "rad/s^2", "acceleration of theta", Needs::accelerations,
           "accelerations"},
    Column{
        "servo_phi", "servo φ", "rad",
        "real angle of phi's servo, before backlash and linkage; with three servos, of the first",
        Needs::servos, "servos", Role::main, "φ"},
    Column{"servo_theta", "servo θ", "rad",
           "real angle of theta's servo, before backlash and linkage; with three servos, of the "
           "second",
           Needs::servos, "servos", Role::main, "θ"},
    Column{"servo_third", "third servo", "rad", "real angle of the third of three servos",
           Needs::third_servo, "servos", Role::main, "third"},
    Column{"phi_believed", "believed φ", "rad",
           "angle of phi's stepper as its driver counts it; servo_phi is the real one",
           Needs::believed, "believed", Role::main, "φ"},
    Column{"theta_believed", "believed θ", "rad",
           "angle of theta's stepper as its driver counts it; servo_theta is the real one",
           Needs::believed, "believed", Role::main, "θ"},
    Column{"servo_1_believed", "believed 1", "rad",
           "angle of the first leg's stepper as its driver counts it; servo_phi is the real one",
           Needs::legs_believed, "believed", Role::main, "1"},
    Column{"servo_2_believed", "believed 2", "rad",
           "angle of the second leg's stepper as its driver counts it; servo_theta is the real one",
           Needs::legs_believed, "believed", Role::main, "2"},
    Column{"servo_3_believed", "believed 3", "rad",
           "angle of the third leg's stepper as its driver counts it; servo_third is the real one",
           Needs::legs_believed, "believed", Role::main, "3"},
    Column{"push_x", "push x", "N", "push on the ball's center along the plate's x axis",
           Needs::pushed, "push", Role::main, "x"},
    Column{"push_y", "push y", "N", "push on the ball's center along the plate's y axis",
           Needs::pushed, "push", Role::main, "y"},
    Column{"x_reference", "x reference", "m", "where the controller wants x", Needs::controller,
           "x", Role::reference},
    Column{"y_reference", "y reference", "m", "where the controller wants y", Needs::controller,
           "y", Role::reference},
    Column{"tracking_error", "tracking error", "m",
           "distance of the contact point from its reference", Needs::controller, "tracking_error"},
    Column{"phi_command", "φ command", "rad",
           "command for phi: an angle, of the servo behind a linkage; rad/s^2, N m or V if the "
           "controller drives accelerations, torques or voltages",
           Needs::commands, "phi", Role::command},
    Column{"theta_command", "θ command", "rad",
           "command for theta: an angle, of the servo behind a linkage; rad/s^2, N m or V if the "
           "controller drives accelerations, torques or voltages",
           Needs::commands, "theta", Role::command},
    Column{"x_measured", "x as seen", "m", "x that the sensor measured last", Needs::samples, "x",
           Role::measured},
    Column{"y_measured", "y as seen", "m", "y that the sensor measured last", Needs::samples, "y",
           Role::measured},
    Column{"tilt", "tilt", "rad", "angle between the plate's normal and the vertical",
           Needs::gimbal, "tilt"},
    Column{"tilt_rate", "tilt rate", "rad/s", "size of the plate's angular velocity", Needs::gimbal,
           "tilt_rate"},
    Column{"singularity_distance", "singularity distance", "1",
           "distance from the state in which no gimbal accelerations give the ball the wanted "
           "acceleration: 0 there, 1 at home on the paper's gimbal",
           Needs::gimbal, "singularity"},
    Column{"normal_force", "normal force", "N",
           "force of the plate on the ball along the normal; contact needs > 0", Needs::dynamics,
           "forces", Role::main, "normal"},
    Column{"friction_force", "friction force", "N",
           "size of the force of the plate on the ball along the plate", Needs::dynamics, "forces",
           Role::main, "friction"},
    Column{"friction_demand", "friction demand", "1",
           "friction_force / normal_force; rolling needs it below the friction coefficient, and it "
           "grows to infinity at lift-off; of a sliding ball, its coefficient of friction",
           Needs::dynamics, "friction"},
    Column{"torque_phi", "torque φ", "N m", "motor torque about phi's axis that carries the ball",
           Needs::dynamics, "torques", Role::main, "φ"},
    Column{"torque_theta", "torque θ", "N m",
           "motor torque about theta's axis that carries the ball", Needs::dynamics, "torques",
           Role::main, "θ"},
    Column{"motor_torque_phi", "motor torque φ", "N m",
           "motor torque about phi's axis that carries ball and plate", Needs::plate,
           "motor_torques", Role::main, "φ"},
    Column{"motor_torque_theta", "motor torque θ", "N m",
           "motor torque about theta's axis that carries ball and plate", Needs::plate,
           "motor_torques", Role::main, "θ"},
    Column{"motor_power", "motor power", "W", "power of the two motors with ball and plate",
           Needs::plate, "power", Role::main, "motors, with plate"},
    Column{"energy", "energy", "J",
           "ball's kinetic and potential energy; potential is 0 at the gimbal's center",
           Needs::dynamics, "energy", Role::main, "ball"},
    Column{"power", "power", "W",
           "power of the two motor torques that carry the ball: the rate of change of energy, "
           "except for losses",
           Needs::dynamics, "power", Role::main, "motors, ball only"},
    Column{"push_power", "power of the push", "W", "power of the push on the ball", Needs::pushed,
           "power", Role::main, "push"},
    Column{"total_energy", "total energy", "J",
           "kinetic and potential energy of ball, plate, ring and the motors' rotors",
           Needs::dynamics, "energy", Role::main, "total"},
    Column{"slip_x", "slip x", "m/s",
           "velocity of the ball's surface over the plate at the contact, along x", Needs::coupled,
           "slip", Role::main, "x"},
    Column{"slip_y", "slip y", "m/s",
           "velocity of the ball's surface over the plate at the contact, along y", Needs::coupled,
           "slip", Role::main, "y"},
    Column{"loss_power", "power lost", "W",
           "power lost to the ball's couples, to sliding and in the motors' friction",
           Needs::coupled, "power", Role::main, "lost"},
    Column{"energy_lost", "energy lost", "J", "energy lost since the start: integral of loss_power",
           Needs::coupled, "energy", Role::main, "lost"},
    Column{
        "motor_work", "motors' work", "J",
        "work of the motors on ball, plate, ring and rotors since the start, before their friction",
        Needs::work, "energy", Role::main, "motors' work"},
    Column{"phi_torque_asked", "φ torque asked", "N m",
           "torque asked of phi's motor, before its limits", Needs::torques, "given_torques",
           Role::command},
    Column{"theta_torque_asked", "θ torque asked", "N m",
           "torque asked of theta's motor, before its limits", Needs::torques, "given_torques",
           Role::command},
    Column{"phi_torque", "φ motor's torque", "N m",
           "torque that phi's motor gives, before its friction", Needs::torques, "given_torques",
           Role::main, "φ"},
    Column{"theta_torque", "θ motor's torque", "N m",
           "torque that theta's motor gives, before its friction", Needs::torques, "given_torques",
           Role::main, "θ"},
    Column{"phi_current", "φ motor's current", "A", "current of phi's motor", Needs::armature,
           "currents", Role::main, "φ"},
    Column{"theta_current", "θ motor's current", "A", "current of theta's motor", Needs::armature,
           "currents", Role::main, "θ"},
    Column{"phi_voltage", "φ motor's voltage", "V", "voltage of phi's motor", Needs::armature,
           "voltages", Role::main, "φ"},
    Column{"theta_voltage", "θ motor's voltage", "V", "voltage of theta's motor", Needs::armature,
           "voltages", Role::main, "θ"},
    Column{"electrical_power", "electrical power", "W", "voltage times current of the two motors",
           Needs::armature, "power", Role::main, "electrical"},
};

// An additional column of HDF5 results. No scenario asks for it.
inline constexpr Column position_error{
    "position_error",
    "error of x, y",
    "m",
    "estimate of the error of x and y: the larger one in this row",
    Needs::ball,
    "position_error"};

// Returns the column, or nullptr. Finds numbers of your own controller once a scene has asked for
// them.
[[nodiscard]] const Column* find_column(std::string_view name);

// Returns the column of a number from your own controller. Requires is_own_name() and a name that
// is not in the catalogue. The column exists until the program ends.
const Column& own_column(std::string_view name);

// Whether a number of your own controller may have this name: at most 60 letters, digits and
// underscores, and no digit first.
[[nodiscard]] bool is_own_name(std::string_view name);

// The most columns of your own controller in a scene.
inline constexpr std::size_t most_own_columns = 64;

// The names of your own controller's numbers among the scene's output columns, in their order.
[[nodiscard]] std::vector<std::string> own_columns(const Scenario& scenario);

// The names of the catalogue.
[[nodiscard]] std::vector<std::string_view> column_names();

// Returns the columns in the order of the names. Throws InputError for an unknown name.
[[nodiscard]] std::vector<const Column*> columns_named(const std::vector<std::string>& names);

[[nodiscard]] std::vector<std::string> names_of(const std::vector<const Column*>& columns);

[[nodiscard]] bool any_needs(const std::vector<const Column*>& columns, Needs what);

// Whether a column is computed from forces, torques or energy.
[[nodiscard]] bool need_dynamics(const std::vector<const Column*>& columns);

// The axis that a column belongs to, by its name: 1 for x and phi, 2 for y and theta, else 0.
[[nodiscard]] int axis_of(std::string_view name);

// The table has commands as angles. panel_of() puts commands in another unit (command_unit())
// beside the quantity that they command.
[[nodiscard]] bool is_command(std::string_view name);
[[nodiscard]] const Panel& panel_of(const Column& column, std::string_view unit);

// Why the scene cannot fill a column, and what to use instead; both null if it can.
struct Missing {
  const char* why = nullptr;
  const char* instead = nullptr;
  explicit operator bool() const { return why != nullptr; }
};
[[nodiscard]] Missing missing(const Column& column, const Scenario& scenario);

}  // namespace bbsim::scenario
