// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the user wrote, in SI units and radians, with every default in sight.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/pair.hpp"

namespace bbsim {

// Couples against which the ball turns on the plate.
struct Losses {
  double rolling = 0;   // coefficient of rolling resistance: a couple of that times N r
  double viscous = 0;   // couple over the rate of turn along the plane, N m s
  double pivoting = 0;  // couple about the normal over N, m

  friend bool operator==(const Losses&, const Losses&) = default;
};

// offset + amplitude sin(frequency t + phase)
struct Sinusoid {
  double amplitude = 0;  // rad
  double frequency = 0;  // rad/s
  double phase = 0;      // rad
  double offset = 0;     // rad
};

// start + rate t
struct Ramp {
  double start = 0;  // rad
  double rate = 0;   // rad/s
};

// A C2 interpolant through (time, value): at least four rows, times strictly increasing.
struct Table {
  std::string file;
  std::vector<double> times;   // s
  std::vector<double> values;  // rad
};

// Of an angle; where it is of a torque or of a force, in N m or N.
using ProfileTerm = std::variant<double, Sinusoid, Ramp, Table>;  // a number is a constant
using Profile = std::vector<ProfileTerm>;                         // their sum; empty is zero

// A force on the ball's centre along the plane's axes, N.
struct BallPush {
  Profile x, y;
};

struct Ball {
  double radius = 0;            // m, > 0, required
  double mass = 1;              // kg, > 0; only where forces are asked for, or move something
  Pair position{0, 0};          // contact point in the plane frame, m
  Pair velocity{0, 0};          // of the contact point in the plane frame, m/s
  double spin = 0;              // about the plane normal, relative to the plane, rad/s
  double inertia_factor = 0.4;  // moment of inertia over m r^2: 2/5 solid, 2/3 a thin shell
  Losses losses{};
  // Rate of turn about the plane's axes x, y, relative to the plane, rad/s; what rolling gives if
  // it is not there.
  std::optional<Pair> rotation{};
  std::optional<BallPush> push{};
};

// The plate that the ball rolls on, where a scene needs to know: a rectangle or a disc about the
// plane's origin.
struct Plate {
  std::optional<Pair> size{};        // along x and y, m
  std::optional<double> diameter{};  // m
  // Moments of inertia about the gimbal's centre along the plane's axes x, y, normal, kg m^2.
  std::optional<std::array<double, 3>> inertia{};
  double mass = 0;            // kg
  double centre_of_mass = 0;  // its height above the gimbal's centre, along the normal, m
};

struct GimbalMotion {
  Profile phi, theta;
};

struct GimbalStart {
  double phi = 0, theta = 0;            // rad
  double phi_rate = 0, theta_rate = 0;  // rad/s
};

// phi'' = omega_n^2 (u_phi - phi) - 2 zeta omega_n phi'; theta alike. Or, of first order,
// phi' = (u_phi - phi) / time_constant.
struct Servo {
  double natural_frequency = 0;                // omega_n, rad/s, > 0
  double damping = 0;                          // zeta, >= 0
  std::optional<double> time_constant{};       // s, > 0; instead of the two above
  std::optional<double> angle_limit{};         // hard stops at +-this, rad
  std::optional<double> rate_limit{};          // rad/s
  std::optional<double> acceleration_limit{};  // rad/s^2
  double dead_band = 0;  // commands nearer than this to the last are not followed, rad
  double backlash = 0;   // by which servo and plane turn freely against each other, rad

  [[nodiscard]] bool plain() const {
    return !time_constant && !angle_limit && !rate_limit && !acceleration_limit && dead_band == 0 &&
           backlash == 0;
  }
};

// A servo's horn moves an arm on the plate through a rod. In the plane of the three the servo's
// axis is at (0, 0); both bars are along +x where their angles are zero.
struct RodLinkage {
  double horn = 0, arm = 0;     // m, > 0
  std::optional<double> rod{};  // m; what home needs, if it is not there
  Pair offset{0, 0};            // of the gimbal's axis, m
};

// A curve that was measured: a C2 interpolant through (servo, plate).
struct CurveLinkage {
  std::string file;
  std::vector<double> servo;  // rad, strictly increasing, at least four
  std::vector<double> plate;  // rad
};

using AxisLinkage = std::variant<RodLinkage, CurveLinkage>;

// Three servos on a circle below the plate, each with a horn, a rod, and a ball joint: 3-RRS.
struct ThreeServoPlate {
  double radius_base = 0, radius_plate = 0;  // of the servos' axes and of the joints, m, > 0
  double horn = 0, rod = 0;                  // m, > 0
  double height = 0;  // of the joints above the servos' axes where the plate is level, m, > 0
};

// How the plane sits on the gimbal, where not as in the paper.
struct Mounting {
  double height = 0;                        // of the plane of contact above the gimbal's centre, m
  double phi_offset = 0, theta_offset = 0;  // angle of the plane where the servo's is zero, rad
  double skew = 0;       // of theta's axis from square to phi's, about the normal, rad
  double yaw = 0;        // of the plane's x axis from theta's unskewed axis, about the normal, rad
  double base_tilt = 0;  // of the base, about its x axis, rad

  friend bool operator==(const Mounting&, const Mounting&) = default;
};

// Its armature under a voltage V, through the gear: torque = gear k_t (V - gear k_t rate) / R.
struct DcMotor {
  double resistance = 0;                  // R, ohm, > 0
  double torque_constant = 0;             // k_t, N m/A, > 0
  double gear = 1;                        // turns of the motor over those of the axis, > 0
  std::optional<double> voltage_limit{};  // V
};

// Torque = kp (u - angle) + ki (integral of u - angle) - kd rate.
struct PositionLoop {
  double kp = 0;  // N m/rad, > 0
  double kd = 0;  // N m s/rad
  double ki = 0;  // N m/(rad s)
};

// What turns an axis, both alike, where torques move the gimbal.
struct Motor {
  double rotor_inertia = 0;              // through the gear, kg m^2
  double viscous = 0;                    // N m s
  double friction = 0;                   // dry, N m
  std::optional<double> torque_limit{};  // N m
  std::optional<DcMotor> dc{};
  std::optional<PositionLoop> position_loop{};
};

struct Gimbal {
  std::optional<GimbalMotion> motion{};  // prescribed; otherwise a controller or torques move it
  std::optional<GimbalMotion> torque{};  // of the motors, N m
  double ring_inertia = 0;               // of what turns with phi alone, about its axis, kg m^2
  std::optional<Motor> motor{};
  GimbalStart start;
  std::optional<Servo> servo{};  // there exactly when the controller drives angle
  // Of theta, where it is another one; `servo` is phi's then.
  std::optional<Servo> theta_servo{};
  std::array<std::optional<AxisLinkage>, 2> linkage{};  // between servos and plane: phi, theta
  std::optional<ThreeServoPlate> three_servos{};
  Mounting mounting;

  // Of phi (0), theta (1). There is a servo.
  [[nodiscard]] const Servo& servo_of(std::size_t axis) const {
    return axis == 1 && theta_servo ? *theta_servo : *servo;
  }
};

struct PointReference {
  Pair position{0, 0};  // m
};

// centre + radius (cos(rate t + phase), sin(rate t + phase))
struct CircleReference {
  double radius = 0;  // m, >= 0
  double rate = 0;    // rad/s
  double phase = 0;   // rad
  Pair centre{0, 0};  // m
};

// centre + (amplitude_x cos(rate_x t + phase_x), amplitude_y sin(rate_y t + phase_y))
struct LissajousReference {
  Pair amplitude{0, 0};  // m
  Pair rate{0, 0};       // rad/s
  Pair phase{0, 0};      // rad
  Pair centre{0, 0};     // m
};

// Each point at its time, smoothly between; the first point before, the last one afterwards.
struct WaypointReference {
  std::vector<Pair> points;   // m, at least two
  std::vector<double> times;  // s, strictly increasing, one a point
  bool rest = false;          // at rest at each point; otherwise at the first and last only
};

// A C2 interpolant through (time, x, y): at least four rows, times strictly increasing.
struct TableReference {
  std::string file;
  std::vector<double> times;  // s
  std::vector<double> x, y;   // m
};

using Reference = std::variant<PointReference, CircleReference, LissajousReference,
                               WaypointReference, TableReference>;

enum class Drives { acceleration, angle, torque, voltage };

// The word for it in scenarios, and the unit of a command.
[[nodiscard]] constexpr const char* name_of(Drives drives) {
  constexpr const char* names[] = {"acceleration", "angle", "torque", "voltage"};
  return names[static_cast<std::size_t>(drives)];
}
[[nodiscard]] constexpr const char* command_unit(Drives drives) {
  constexpr const char* units[] = {"rad/s^2", "rad", "N m", "V"};
  return units[static_cast<std::size_t>(drives)];
}

enum class Law {
  pd,                      // u = kv e' + kp e, e = reference - (x, y): equation (31)
  pid,                     // ... + ki times the integral of e
  state_feedback,          // u = gain (e, e' [, -angles, -rates])
  lqr,                     // the same, with the gain that minimises a quadratic cost
  gravity_compensation,    // angles under which gravity gives the ball x_d'' + kv e' + kp e
  feedback_linearisation,  // accelerations of the gimbal that give the ball the same
  own,                     // one's own: a program or a library (docs/reference/controllers.md)
};

// Cost of lqr: the integral of the weighted squares of the ball's distance and velocity, of the
// servos' angles and rates, and of the command.
struct LqrWeights {
  double position = 0, velocity = 0, angle = 0, rate = 0, command = 0;
};

// A controller in discrete time, which holds its command between samples.
struct Sampling {
  double period = 0;              // s, > 0
  double delay = 0;               // from a sample to its command, s
  double resolution = 0;          // of the command, rad; 0: none
  double derivative_filter = 0;   // time constant of the filter of differences, s
  double jitter = 0;              // standard deviation of a period, s
  std::string periods_file{};     // of measured periods, instead of `jitter`
  std::vector<double> periods{};  // s; after the last one they begin anew

  [[nodiscard]] bool is_even() const { return jitter == 0 && periods.empty(); }
};

// What the controller sees of the ball, at its samples.
struct Sensor {
  double resolution = 0;       // m; 0: none
  double noise = 0;            // standard deviation of each coordinate, m
  unsigned long seed = 1;      // of noise, dropouts and the sampling's jitter
  double delay = 0;            // from what is seen to the sample, s
  double dropout = 0;          // probability that a sample sees nothing
  std::optional<Pair> area{};  // sides of the rectangle in which it sees the ball, m
  // What it says of a ball at p, before noise: scale R(rotation) p + offset.
  double rotation = 0;  // rad
  Pair scale{1, 1};
  Pair offset{0, 0};  // m
  // Of frames of its own, at phase + n period; without, it looks where the controller samples.
  std::optional<double> period{};  // s, > 0
  double phase = 0;                // s

  [[nodiscard]] bool is_aligned() const {
    return rotation == 0 && scale == Pair{1, 1} && offset == Pair{0, 0};
  }
};

// A number that one's own controller is given.
struct Parameter {
  std::string name;
  double value = 0;
};

// A program that is asked at each sample, over its standard input and output.
struct ControllerProgram {
  std::vector<std::string> command;  // its words, at least one; no shell reads them
  double timeout = 1;                // s, > 0: for each answer
  double start_timeout = 5;          // s, > 0: for the first, with all that it does to begin
};

// A shared library that is called at each sample (bbsim/controller.h).
struct ControllerLibrary {
  std::string file;    // as the scenario names it, and ...
  std::string wiring;  // ... of a sketch what its pins are wired to; empty: it is none
};

// A controller that is not built in.
struct OwnController {
  std::variant<ControllerProgram, ControllerLibrary> by;
  std::vector<Parameter> parameters;  // in the order of the file
  std::string folder;  // the scenario's: names of files begin there, and the program runs there
};

// What a controller of a linked gimbal takes the linkage for: a line with its slope at home, or the
// curve itself.
enum class Assumes { ratio, exact };

// e = reference - (x, y).
struct Controller {
  Law law = Law::pd;
  Matrix2 kv{}, kp{}, ki{};                     // pd, pid and the last two laws
  std::array<std::array<double, 8>, 2> gain{};  // state_feedback
  LqrWeights weights;                           // lqr
  std::optional<OwnController> own{};           // own
  Drives drives = Drives::acceleration;
  Reference reference;
  std::optional<double> limit{};  // of the command, rad or rad/s^2
  // Of phi's and theta's, where they differ, instead of `limit`.
  std::optional<std::array<std::optional<double>, 2>> axis_limits{};
  std::optional<Assumes> assumes{};  // only with a linkage or three servos
  std::optional<Sampling> sampling{};
  std::optional<Sensor> sensor{};  // only with sampling

  [[nodiscard]] std::optional<double> limit_of(std::size_t axis) const {
    return axis_limits ? (*axis_limits)[axis] : limit;
  }
};

enum class OnEvent { stop, note };

struct SlipEvent {
  double friction = 0;  // coefficient of static friction, > 0
  OnEvent action = OnEvent::note;
  // Of sliding friction: the ball slides when it slips, instead of an action.
  std::optional<double> sliding{};
};
struct TiltEvent {
  double limit = 0;  // of the angle between the plane's normal and the vertical, rad
  OnEvent action = OnEvent::note;
};
struct SingularityEvent {
  double distance = 0.1;  // of the column singularity_distance
  OnEvent action = OnEvent::stop;
};

// What is watched while the scene runs, and what happens when it occurs.
struct Events {
  std::optional<OnEvent> edge{};  // the contact point leaves the plate
  std::optional<SlipEvent> slip{};
  std::optional<OnEvent> lift_off{};  // the normal force is no longer positive
  std::optional<TiltEvent> tilt{};
  std::optional<SingularityEvent> singularity{};  // of feedback linearisation
  std::optional<OnEvent> rest{};                  // rolling resistance brings the ball to rest
  std::optional<OnEvent> stick{};                 // dry friction holds an axis of the gimbal
};

// Output at i * step, exactly, and at end.
struct OutputTimes {
  double end = 0;   // s, > 0, required
  double step = 0;  // s, > 0, required
};

enum class Method { automatic, radau, bdf, adams };

struct NamedMethod {
  Method method;
  std::string_view name;
};
inline constexpr std::array named_methods = {
    NamedMethod{Method::automatic, "auto"},
    NamedMethod{Method::radau, "radau"},
    NamedMethod{Method::bdf, "bdf"},
    NamedMethod{Method::adams, "adams"},
};

struct Solver {
  Method method = Method::automatic;
  double rtol = 1e-8;
  double atol = 1e-10;  // in each state's own unit: m, m/s, rad, rad/s
  // Instead of tolerances: a bound on the error of x and y at all output times, m.
  std::optional<double> error{};
};

struct Output {
  std::vector<std::string> columns{"t", "x", "y", "gamma", "phi", "theta"};
};

// How a key varies over a sweep, or several that are tied, as the user wrote it: "linear:1:2:9".
struct Variation {
  std::string key, spec;
};

enum class Combine { grid, zip };

// Many runs of the scene (`bbsim sweep`); a single run takes no notice.
struct Sweep {
  std::vector<Variation> vary;
  Combine combine = Combine::grid;     // of the keys whose values are listed, not drawn
  std::optional<double> samples{};     // cases drawn, where a key's values are; whole
  double seed = 1;                     // of what is drawn; whole
  std::vector<std::string> measure{};  // empty: those of bbsim sweep --help
};

// Where a scenario came from, kept for the metadata of its results.
struct Source {
  std::string file;                    // as the user named it
  std::string text;                    // whole
  std::vector<std::string> overrides;  // each "key.path=value", in the order given
};

struct Scenario {
  std::string title;
  double gravity = 9.80665;  // m/s^2, >= 0
  Ball ball;
  Plate plate;
  Gimbal gimbal;
  std::optional<Controller> controller{};  // there exactly when gimbal.motion and .torque are not
  Events events;
  OutputTimes time;
  Solver solver;
  Output output;
  Sweep sweep;
  Source source;
  // What is allowed, but may not be what the user meant: a line each, with its place.
  std::vector<std::string> remarks{};
};

}  // namespace bbsim
