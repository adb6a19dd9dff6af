#include "record/columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace bbsim::record {
namespace {

using R = const Row&;

constexpr std::array columns = {
    Column{"t", "s", "time", Needs::state, [](R row) { return row.sample.t; }},
    Column{"x", "m", "contact point along the plane's x axis", Needs::state,
           [](R row) { return row.sample.ball.x; }},
    Column{"y", "m", "contact point along the plane's y axis", Needs::state,
           [](R row) { return row.sample.ball.y; }},
    Column{"distance", "m", "distance of the contact point from the plane's origin", Needs::state,
           [](R row) { return std::hypot(row.sample.ball.x, row.sample.ball.y); }},
    Column{"vx", "m/s", "velocity of the contact point in the plane, x'", Needs::state,
           [](R row) { return row.sample.ball.x_dot; }},
    Column{"vy", "m/s", "velocity of the contact point in the plane, y'", Needs::state,
           [](R row) { return row.sample.ball.y_dot; }},
    Column{"spin", "rad/s", "ball's rate of turn about the plane normal, relative to the plane",
           Needs::state, [](R row) { return row.sample.ball.gamma_dot; }},
    Column{"gamma", "rad", "ball's turn about the plane normal since the start: integral of spin",
           Needs::gamma, [](R row) { return row.sample.gamma; }},
    Column{"ball_qw", "1", "ball's orientation in the plane's frame, a unit quaternion: its scalar",
           Needs::orientation, [](R row) { return (*row.orientation)[0]; }},
    Column{"ball_qx", "1", "ball's orientation: x part of the quaternion, 0 at the start",
           Needs::orientation, [](R row) { return (*row.orientation)[1]; }},
    Column{"ball_qy", "1", "ball's orientation: y part", Needs::orientation,
           [](R row) { return (*row.orientation)[2]; }},
    Column{"ball_qz", "1", "ball's orientation: z part", Needs::orientation,
           [](R row) { return (*row.orientation)[3]; }},
    Column{"phi", "rad", "first (outer) gimbal angle, about the fixed y axis", Needs::state,
           [](R row) { return row.sample.gimbal.phi; }},
    Column{"theta", "rad", "second (inner) gimbal angle, about the x axis that phi carries",
           Needs::state, [](R row) { return row.sample.gimbal.theta; }},
    Column{"phi_rate", "rad/s", "rate of phi", Needs::state,
           [](R row) { return row.sample.gimbal.phi_dot; }},
    Column{"theta_rate", "rad/s", "rate of theta", Needs::state,
           [](R row) { return row.sample.gimbal.theta_dot; }},
    Column{"phi_acceleration", "rad/s^2", "acceleration of phi", Needs::state,
           [](R row) { return row.sample.gimbal.phi_ddot; }},
    Column{"theta_acceleration", "rad/s^2", "acceleration of theta", Needs::state,
           [](R row) { return row.sample.gimbal.theta_ddot; }},
    Column{"x_reference", "m", "where the controller wants x", Needs::reference,
           [](R row) { return row.sample.reference[0]; }},
    Column{"y_reference", "m", "where the controller wants y", Needs::reference,
           [](R row) { return row.sample.reference[1]; }},
    Column{"tracking_error", "m", "distance of the contact point from where the controller wants it",
           Needs::reference,
           [](R row) {
             const model::Sample& now = row.sample;
             return std::hypot(now.ball.x - now.reference[0], now.ball.y - now.reference[1]);
           }},
    Column{"phi_command", "rad",
           "command that the servo of phi follows (rad/s^2 if accelerations are driven)",
           Needs::reference, [](R row) { return row.sample.command[0]; }},
    Column{"theta_command", "rad",
           "command that the servo of theta follows (rad/s^2 if accelerations are driven)",
           Needs::reference, [](R row) { return row.sample.command[1]; }},
    Column{"x_measured", "m", "x as the sensor last saw it", Needs::samples,
           [](R row) { return row.sample.measured[0]; }},
    Column{"y_measured", "m", "y as the sensor last saw it", Needs::samples,
           [](R row) { return row.sample.measured[1]; }},
    Column{"tilt", "rad", "angle between the plane's normal and the vertical", Needs::dynamics,
           [](R row) { return row.dynamics->tilt; }},
    Column{"tilt_rate", "rad/s", "size of the plane's angular velocity", Needs::dynamics,
           [](R row) { return row.dynamics->tilt_rate; }},
    Column{"singularity_distance", "1",
           "how far from where no gimbal accelerations give the ball any acceleration wanted: 0 "
           "there, 1 at home on the paper's gimbal",
           Needs::dynamics, [](R row) { return row.dynamics->singularity_distance; }},
    Column{"normal_force", "N",
           "force of the plane on the ball along the normal; contact needs > 0", Needs::dynamics,
           [](R row) { return row.dynamics->normal_force(); }},
    Column{"friction_force", "N", "size of the force of the plane on the ball along the plane",
           Needs::dynamics, [](R row) { return row.dynamics->friction_force(); }},
    Column{"friction_demand", "1",
           "friction_force / normal_force; rolling needs it below the friction coefficient",
           Needs::dynamics,
           [](R row) { return row.dynamics->friction_force() / row.dynamics->normal_force(); }},
    Column{"torque_phi", "N m", "motor torque about phi's axis that carries the ball",
           Needs::dynamics, [](R row) { return row.dynamics->torque_phi; }},
    Column{"torque_theta", "N m", "motor torque about theta's axis that carries the ball",
           Needs::dynamics, [](R row) { return row.dynamics->torque_theta; }},
    Column{"motor_torque_phi", "N m", "motor torque about phi's axis that carries ball and plate",
           Needs::plate,
           [](R row) { return row.dynamics->torque_phi + row.dynamics->plate_torque_phi; }},
    Column{"motor_torque_theta", "N m",
           "motor torque about theta's axis that carries ball and plate", Needs::plate,
           [](R row) { return row.dynamics->torque_theta + row.dynamics->plate_torque_theta; }},
    Column{"motor_power", "W", "power of the two motors with ball and plate", Needs::plate,
           [](R row) {
             const model::GimbalMotion& gimbal = row.sample.gimbal;
             const model::Dynamics& d = *row.dynamics;
             return (d.torque_phi + d.plate_torque_phi) * gimbal.phi_dot +
                    (d.torque_theta + d.plate_torque_theta) * gimbal.theta_dot;
           }},
    Column{"energy", "J",
           "ball's kinetic and potential energy; potential is 0 at the gimbal's centre",
           Needs::dynamics, [](R row) { return row.dynamics->energy; }},
    Column{"power", "W", "power of the two motor torques; the rate of change of energy",
           Needs::dynamics,
           [](R row) {
             const model::GimbalMotion& gimbal = row.sample.gimbal;
             return row.dynamics->torque_phi * gimbal.phi_dot +
                    row.dynamics->torque_theta * gimbal.theta_dot;
           }},
};

}  // namespace

std::span<const Column> all_columns() {
  return columns;
}

const Column* find_column(std::string_view name) {
  const auto named = [name](const Column& column) { return column.name == name; };
  const auto found = std::find_if(columns.begin(), columns.end(), named);
  return found == columns.end() ? nullptr : &*found;
}

}  // namespace bbsim::record
