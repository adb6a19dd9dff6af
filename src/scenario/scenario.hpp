// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scenario as read: SI units and radians, with all defaults.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/pair.hpp"

namespace bbsim {

namespace model {
class ExternalController;
}
struct Scenario;

// A limit that does not exist.
inline constexpr double unlimited = std::numeric_limits<double>::infinity();

// Couples that the plate exerts on the ball against its rotation.
struct Losses {
  double rolling = 0;   // coefficient of rolling resistance: couple over N r
  double viscous = 0;   // couple over the rotation rate along the plane, N m s
  double pivoting = 0;  // couple about the normal over N, m

  [[nodiscard]] bool any() const { return *this != Losses{}; }
  friend bool operator==(const Losses&, const Losses&) = default;
};

// Terms of a profile. move_clock(begin) moves the zero of a term's clock to the time `begin` (s)
// without changing the motion.

// offset + amplitude sin(frequency t + phase).
struct Sinusoid {
  double amplitude = 0;  // rad
  double frequency = 0;  // rad/s
  double phase = 0;      // rad
  double offset = 0;     // rad

  void move_clock(double begin) { phase += frequency * begin; }
};

// start + rate t.
struct Ramp {
  double start = 0;  // rad
  double rate = 0;   // rad/s

  void move_clock(double begin) { start += rate * begin; }
};

// C2 interpolant through (time, value): at least four rows with strictly increasing times.
// sweep/window.cpp moves its clock and drops rows far outside the new run.
struct Table {
  std::string file;
  std::vector<double> times;   // s
  std::vector<double> values;  // rad
};

// Zero except for `duration` seconds from `start`, when it rises to `value` and falls back. Each
// half has minimum jerk.
struct Pulse {
  double start = 0, duration = 0, value = 0;

  void move_clock(double begin) { start -= begin; }
};

// The units are those of an angle. In a profile of torque or force, N m or N replaces rad.
using ProfileTerm = std::variant<double, Sinusoid, Ramp, Pulse, Table>;  // a number is a constant
using Profile = std::vector<ProfileTerm>;                                // their sum; empty is zero

// A force on the ball's center along the plane's axes, N.
struct BallPush {
  Profile x, y;
};

// A ball between two rails, or in a groove, rolls about the axis through its two contacts.
struct Groove {
  double ball_radius = 0;  // m
  int axis = 0;            // 0: along x, 1: along y
};

struct Ball {
  double radius =
      0;            // m, > 0, required; in a groove, the distance from center to the contacts' axis
  double mass = 1;  // kg, > 0; needed only for forces, or if the mass affects the motion
  Pair position{0, 0};  // contact point in the plane frame, m
  Pair velocity{0, 0};  // of the contact point in the plane frame, m/s
  double spin = 0;      // about the plane's normal, relative to the plane, rad/s
  // Moment of inertia over m r^2: 2/5 if solid, 2/3 for a thin shell; more in a groove.
  double inertia_factor = 0.4;
  std::optional<Groove> groove{};
  Losses losses{};
  // Rotation rate about the plane's x and y axes relative to the plane, rad/s. Default: rolling
  // without slip.
  std::optional<Pair> rotation{};
  std::optional<BallPush> push{};
};

// The plate, if the scene needs it: a rectangle or a disk centered on the plane's origin.
struct Plate {
  std::optional<Pair> size{};        // along x and y, m
  std::optional<double> diameter{};  // m
  // Moments of inertia about the gimbal's center, along the plane's x and y axes and normal, kg
  // m^2.
  std::optional<std::array<double, 3>> inertia{};
  double mass = 0;            // kg
  double centre_of_mass = 0;  // height above the gimbal's center along the normal, m
};

struct GimbalMotion {
  Profile phi, theta;
};

struct GimbalStart {
  double phi = 0, theta = 0;            // rad
  double phi_rate = 0, theta_rate = 0;  // rad/s
};

// A stepper motor and its driver.
struct StepperMotor {
  double steps = 200, microsteps = 16;  // in a turn of the motor, and in a step
  double gear = 1;                      // turns of the motor in a turn of the shaft
  // Set together, for a motor that loses steps: its greatest torque, N m, and the moment of inertia
  // that it turns, its own and that of the plate behind the gear, at the motor, kg m^2.
  std::optional<double> torque{}, inertia{};
  std::optional<double> corner_speed{};  // of the motor: beyond, torque falls as 1/speed, rad/s
  // Of the shaft's swings about the driver's angle: rad/s, and the damping ratio. Without a
  // frequency, the shaft is at that angle.
  std::optional<double> natural_frequency{};
  double damping = 0.1;

  [[nodiscard]] double microstep() const {  // of the shaft, rad
    return 2 * std::numbers::pi / (steps * microsteps * gear);
  }
  friend bool operator==(const StepperMotor&, const StepperMotor&) = default;
};

// Second order: phi'' = omega_n^2 (u_phi - phi) - 2 zeta omega_n phi', and the same for theta.
// First order: phi' = (u_phi - phi) / time_constant.
struct Servo {
  double natural_frequency = 0;           // omega_n, rad/s, > 0
  double damping = 0;                     // zeta, >= 0
  std::optional<double> time_constant{};  // s, > 0; replaces the two above
  double angle_limit = unlimited;         // hard stops at +-angle_limit, rad
  double rate_limit = unlimited;          // rad/s
  double acceleration_limit = unlimited;  // rad/s^2
  double dead_band = 0;                   // ignores commands that differ from the last by less, rad
  double backlash = 0;                    // free play between servo and plane, rad
  // Replaces natural_frequency and damping: the shaft follows a ramp within the limits of rate and
  // acceleration.
  std::optional<StepperMotor> stepper{};

  // Whether it is of second order without limits and losses.
  [[nodiscard]] bool plain() const { return *this == Servo{natural_frequency, damping}; }
  friend bool operator==(const Servo&, const Servo&) = default;
};

// A push rod connects the servo's horn to an arm on the plate. In the plane of the linkage, the
// servo's axis is at (0, 0), and both bars point along +x at angle zero.
struct RodLinkage {
  double horn = 0, arm = 0;     // m, > 0
  std::optional<double> rod{};  // m; default: the length that fits the home position
  Pair offset{0, 0};            // of the gimbal's axis, m
};

// A measured curve: a C2 interpolant through (servo, plate).
struct CurveLinkage {
  std::string file;
  std::vector<double> servo;  // rad, strictly increasing, at least four
  std::vector<double> plate;  // rad
  // Whether means replaced rows of noise. An interpolant may turn back between the rows left.
  bool smoothed = false;
};

using AxisLinkage = std::variant<RodLinkage, CurveLinkage>;

// Lengths of one of three legs under the plate: a servo with a horn, a rod and a ball joint.
struct LegLengths {
  double radius_base = 0, radius_plate = 0;  // of the servo's axis and of the joint, m, > 0
  double horn = 0, rod = 0;                  // m, > 0
  double height = 0;  // of the joint above the servo's axis with the plate level, m, > 0
};

struct ServoLeg : LegLengths {
  double angle = 0;              // azimuth, from the plate's x axis, rad
  double joint_height = 0;       // of the joint in the plate, above a level common to all legs, m
  double offset = 0;             // of the horn from home when the servo is at zero, rad
  int direction = 1;             // -1: the horn falls as the servo's angle grows
  std::optional<Servo> servo{};  // if it differs from gimbal.servo
};

// Three servos below the plate (3-RRS): equal legs at 0, 120 and 240 degrees, or `legs`.
struct ThreeServoPlate : LegLengths {
  std::optional<std::array<ServoLeg, 3>> legs{};

  [[nodiscard]] ServoLeg leg(std::size_t i) const {
    if (legs) return (*legs)[i];
    constexpr double third = 2.0943951023931953;  // of a turn
    return {*this, third * static_cast<double>(i)};
  }
};

// Mounting of the plane on the gimbal. The defaults are those of the paper.
struct Mounting {
  double height = 0;                        // of the contact plane above the gimbal's center, m
  double phi_offset = 0, theta_offset = 0;  // angle of the plane at the servo's zero, rad
  double skew = 0;  // deviation of theta's axis from a right angle to phi's, about the normal, rad
  double yaw = 0;   // of the plane's x axis from theta's axis without skew, about the normal, rad
  double base_tilt = 0;  // of the base about its x axis, rad

  friend bool operator==(const Mounting&, const Mounting&) = default;
};

// A DC motor with a gear at the voltage V: torque = gear k_t (V - gear k_t rate) / R.
struct DcMotor {
  double resistance = 0;                  // R, ohm, > 0
  double torque_constant = 0;             // k_t, N m/A, > 0
  double gear = 1;                        // motor turns per turn of the axis, > 0
  std::optional<double> voltage_limit{};  // V
};

// torque = kp (u - angle) + ki (integral of u - angle) - kd rate.
struct PositionLoop {
  double kp = 0;  // N m/rad, > 0
  double kd = 0;  // N m s/rad
  double ki = 0;  // N m/(rad s)
};

// The motor of each axis, if torques move the gimbal. Both axes have the same motor.
struct Motor {
  double rotor_inertia = 0;              // at the axis, through the gear, kg m^2
  double viscous = 0;                    // N m s
  double friction = 0;                   // dry friction, N m
  std::optional<double> torque_limit{};  // N m
  std::optional<DcMotor> dc{};
  std::optional<PositionLoop> position_loop{};
};

struct Gimbal {
  std::optional<GimbalMotion> motion{};  // prescribed; otherwise a controller or torques move it
  std::optional<GimbalMotion> torque{};  // of the motors, N m
  double ring_inertia = 0;  // of the parts that turn only with phi, about phi's axis, kg m^2
  std::optional<Motor> motor{};
  GimbalStart start;
  std::optional<Servo> servo{};  // present exactly when servos move the gimbal
  // theta's servo if it differs; `servo` is then phi's.
  std::optional<Servo> theta_servo{};
  std::array<std::optional<AxisLinkage>, 2> linkage{};  // from servo to plane: phi, theta
  std::optional<ThreeServoPlate> three_servos{};
  Mounting mounting;

  // The servo of phi (0) or theta (1), or of a leg. Requires a servo.
  [[nodiscard]] const Servo& servo_of(std::size_t axis) const {
    if (three_servos) {
      const auto& legs = three_servos->legs;
      return legs && (*legs)[axis].servo ? *(*legs)[axis].servo : *servo;
    }
    return axis == 1 && theta_servo ? *theta_servo : *servo;
  }
  [[nodiscard]] bool has_steppers() const {
    return any_stepper([](const StepperMotor& /*motor*/) { return true; });
  }
  // Whether a stepper has a torque, beyond which it loses steps.
  [[nodiscard]] bool loses_steps() const {
    return any_stepper([](const StepperMotor& motor) { return motor.torque.has_value(); });
  }

 private:
  template <class Is>
  [[nodiscard]] bool any_stepper(Is is) const {
    bool any = false;
    for (std::size_t i = 0; servo && i < (three_servos ? 3U : 2U); ++i) {
      any = any || (servo_of(i).stepper && is(*servo_of(i).stepper));
    }
    return any;
  }
};

struct PointReference {
  Pair position{0, 0};  // m
};

// center + radius (cos(rate t + phase), sin(rate t + phase)).
struct CircleReference {
  double radius = 0;  // m, >= 0
  double rate = 0;    // rad/s
  double phase = 0;   // rad
  Pair centre{0, 0};  // m
};

// center + (amplitude_x cos(rate_x t + phase_x), amplitude_y sin(rate_y t + phase_y)).
struct LissajousReference {
  Pair amplitude{0, 0};  // m
  Pair rate{0, 0};       // rad/s
  Pair phase{0, 0};      // rad
  Pair centre{0, 0};     // m
};

// Smooth path through each point at its time. Holds the first point before its time and the last
// point after its time.
struct WaypointReference {
  std::vector<Pair> points;   // m, at least two
  std::vector<double> times;  // s, strictly increasing, one for each point
  bool rest = false;          // at rest at each point; otherwise only at the first and the last
};

// A C2 interpolant through (time, x, y): at least four rows with strictly increasing times.
struct TableReference {
  std::string file;
  std::vector<double> times;  // s
  std::vector<double> x, y;   // m
};

// Holds each point until the next jump, and the first point before the first jump.
struct StaircaseReference {
  std::vector<Pair> points;   // m, at least two
  std::vector<double> jumps;  // s, strictly increasing: to points[i + 1] at jumps[i]
};

inline constexpr std::size_t most_jumps = 100000;  // of an axis, within a run
// Along each axis, center + amplitude for the fraction `duty` of each period, then center -
// amplitude. A period begins when 2 pi t / period + phase is a multiple of 2 pi.
struct SquareReference {
  Pair amplitude{0, 0};  // m
  double period = 0;     // s, > 0
  Pair phase{0, 0};      // rad
  Pair centre{0, 0};     // m
  double duty = 0.5;     // > 0, < 1
};

// Known commands of Law::commands, independent of the ball. They replace a path.
using CommandProfiles = GimbalMotion;

using Reference =
    std::variant<PointReference, CircleReference, LissajousReference, WaypointReference,
                 TableReference, StaircaseReference, SquareReference, CommandProfiles>;

enum class Drives { acceleration, angle, torque, voltage, legs };  // legs: angles of three servos

// The word in scenarios.
[[nodiscard]] constexpr const char* name_of(Drives drives) {
  constexpr const char* names[] = {"acceleration", "angle", "torque", "voltage", "legs"};
  return names[static_cast<std::size_t>(drives)];
}
[[nodiscard]] constexpr bool drives_servos(Drives drives) {
  return drives == Drives::angle || drives == Drives::legs;
}
[[nodiscard]] constexpr const char* command_unit(Drives drives) {
  constexpr const char* units[] = {"rad/s^2", "rad", "N m", "V", "rad"};
  return units[static_cast<std::size_t>(drives)];
}

enum class Law {
  pd,                      // u = kv e' + kp e with e = reference - (x, y): equation (31)
  pid,                     // pd plus ki times the integral of e
  state_feedback,          // u = gain (e, e' [, -angles, -rates])
  lqr,                     // state feedback with the gain that minimizes a quadratic cost
  gravity_compensation,    // angles at which gravity accelerates the ball by x_d'' + kv e' + kp e
  feedback_linearisation,  // gimbal accelerations that give the ball that acceleration
  commands,                // no law: profiles of the commands
  own,                     // an external program or library (docs/reference/controllers.md)
};

// Weights of the cost of lqr: the integral of the weighted squares of the ball's position and
// velocity, the servos' angles and rates, and the command.
struct LqrWeights {
  double position = 0, velocity = 0, angle = 0, rate = 0, command = 0;
};

// Sampling of a discrete-time controller, which holds its command between samples.
struct Sampling {
  double period = 0;              // s, > 0
  double delay = 0;               // from a sample to its command taking effect, s
  double resolution = 0;          // quantization of the command, rad; 0: none
  double derivative_filter = 0;   // time constant of the filtered derivative, s
  double jitter = 0;              // standard deviation of the period, s
  std::string periods_file{};     // measured periods, which replace `jitter`
  std::vector<double> periods{};  // s; start again after the last
  // Time from the first sample to t = 0, s; not 0 in a run of a part of known commands.
  double since = 0;

  [[nodiscard]] bool is_even() const { return jitter == 0 && periods.empty(); }
};

// What a sensor that does not see the ball reads: nothing, its last reading, or its corner at
// -area/2.
enum class OnMiss { none, last, edge };

// A fault that begins by chance at a reading, and lasts.
struct SensorFault {
  double probability = 0, duration = 0;  // > 0; s
};

// The controller's measurement of the ball.
struct Sensor {
  double resolution = 0;   // quantization, m; 0: none
  double noise = 0;        // standard deviation of each coordinate, m
  std::uint64_t seed = 1;  // for noise, dropouts, faults and the jitter of the sampling
  double delay = 0;        // from the measurement to the sample, s
  double dropout = 0;      // probability that a sample has no measurement
  // Readings repeat the first one; frames wait, and arrive together at the end.
  std::optional<SensorFault> stuck{}, burst{};
  std::optional<Pair> area{};                       // sides of the field of view, a rectangle, m
  std::vector<std::array<double, 4>> dead_zones{};  // corners x0, y0, x1, y1 of blind rectangles, m
  double contact_force = 0;                         // a touch screen misses a lesser force, N
  OnMiss on_miss = OnMiss::none;
  std::optional<int> only{};  // in a groove, the measured coordinate; the other is 0
  // Measurement of a ball at p, before noise: scale R(rotation) p + offset.
  double rotation = 0;  // rad
  Pair scale{1, 1};
  Pair offset{0, 0};  // m
  // Period of the sensor's frames, at phase + n period. Default: a measurement at each controller
  // sample.
  std::optional<double> period{};  // s, > 0
  double phase = 0;                // s

  [[nodiscard]] bool is_random() const { return noise > 0 || dropout > 0 || stuck || burst; }
  [[nodiscard]] bool is_aligned() const {
    return rotation == 0 && scale == Pair{1, 1} && offset == Pair{0, 0};
  }
};

// A parameter of an external controller.
struct Parameter {
  std::string name;
  double value = 0;
};

// An external program that receives each sample on its standard input and answers on its standard
// output.
struct ControllerProgram {
  std::vector<std::string> command;  // at least one word; no shell interprets them
  double timeout = 1;                // s, > 0: for each answer
  double start_timeout = 5;          // s, > 0: for the first answer, including the program's start
};

// A program at the other end of a sketch's serial line.
struct SerialProgram {
  ControllerProgram program;
  std::vector<Parameter> parameters;  // in the file's order
  double period = 0;                  // s: between its samples; at least the sampling's
  double delay = 0;                   // s: from a sample to the first byte that it sends
};

// A shared library with a function for each sample (bbsim/controller.h).
struct ControllerLibrary {
  std::string file;                       // as in the scenario
  std::string wiring;                     // wiring file of a sketch's pins; empty without a sketch
  std::optional<SerialProgram> serial{};  // only with a wiring
};

// A controller in the process that uses bbsim as a library. ScenarioFamily::give_controller() sets
// it; no scenario's text names it.
struct ControllerFactory {
  std::string name;  // in messages
  // Makes a controller for a run of the scene.
  std::function<std::shared_ptr<model::ExternalController>(const Scenario&)> make;
};

// An external controller.
struct OwnController {
  std::variant<ControllerProgram, ControllerLibrary, ControllerFactory> by;
  std::vector<Parameter> parameters;  // in the file's order
  std::string folder;  // the scenario's: base of file names and working folder of the program
};

// The controller's model of the linkage: a line with the slope at home, or the exact curve.
enum class Assumes { ratio, exact };

// The tracking error is e = reference - (x, y).
struct Controller {
  Law law = Law::pd;
  Matrix2 kv{}, kp{}, ki{};  // pd, pid, gravity_compensation, feedback_linearisation
  std::array<std::array<double, 8>, 2> gain{};  // state_feedback
  LqrWeights weights;                           // lqr
  std::optional<OwnController> own{};           // own
  Drives drives = Drives::acceleration;
  Reference reference;
  std::optional<double> limit{};  // of the command, rad, rad/s^2, N m or V
  // Separate limits for phi and theta, which replace `limit`.
  std::optional<std::array<std::optional<double>, 2>> axis_limits{};
  std::optional<Assumes> assumes{};               // only with a linkage or three servos
  std::optional<ThreeServoPlate> assumed_legs{};  // for exact; may differ from the real legs
  std::optional<Sampling> sampling{};
  std::optional<Sensor> sensor{};  // only with sampling

  [[nodiscard]] std::optional<double> limit_of(std::size_t axis) const {
    return axis_limits ? (*axis_limits)[axis] : limit;
  }
  [[nodiscard]] bool is_sketch() const {
    const auto* const library = own ? std::get_if<ControllerLibrary>(&own->by) : nullptr;
    return library != nullptr && !library->wiring.empty();
  }
};

enum class OnEvent { stop, note };

struct SlipEvent {
  double friction = 0;  // coefficient of static friction, > 0
  OnEvent action = OnEvent::note;
  // Coefficient of sliding friction. If set, the ball slides when it slips, and `action` does not
  // apply.
  std::optional<double> sliding{};
};
struct TiltEvent {
  double limit = 0;  // of the angle between the plane's normal and the vertical, rad
  OnEvent action = OnEvent::note;
};
struct SingularityEvent {
  double distance = 0.1;  // threshold for the column singularity_distance
  OnEvent action = OnEvent::stop;
};

// The events to detect, and the action for each.
struct Events {
  std::optional<OnEvent> edge{};  // the contact point leaves the plate
  std::optional<SlipEvent> slip{};
  std::optional<OnEvent> lift_off{};  // the normal force drops to zero
  std::optional<TiltEvent> tilt{};
  std::optional<SingularityEvent> singularity{};  // of feedback linearization
  std::optional<OnEvent> rest{};                  // rolling resistance brings the ball to rest
  std::optional<OnEvent> stick{};                 // dry friction holds a gimbal axis
  std::optional<OnEvent> steps_lost{};            // by a stepper; noted by default
};

// Output exactly at i * step, and at `end`.
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
[[nodiscard]] constexpr std::string_view method_name(Method method) {
  return named_methods[static_cast<std::size_t>(method)].name;
}

// The method that `auto` takes. Radau is the cheapest one at every error, by factors of 2 to 30,
// over all scenes (smooth and stiff) and all tolerances (docs/explanation/accuracy.md).
[[nodiscard]] constexpr Method choose_method(Method asked) {
  return asked == Method::automatic ? Method::radau : asked;
}

struct Solver {
  Method method = Method::automatic;
  double rtol = 1e-8;
  double atol = 1e-10;  // in the unit of each state: m, m/s, rad, rad/s
  // A bound on the error of x and y at all output times, m. Replaces the tolerances.
  std::optional<double> error{};
};

struct Output {
  std::vector<std::string> columns{"t", "x", "y", "gamma", "phi", "theta"};
};

// The values of a key, or of several tied keys, over a sweep, as written: "linear:1:2:9".
struct Variation {
  std::string key, spec;
};

enum class Combine { grid, zip };

// Many runs of the scene (`bbsim sweep`). A single run ignores it.
struct Sweep {
  std::vector<Variation> vary;
  Combine combine = Combine::grid;     // of keys with listed values, not random ones
  std::optional<double> samples{};     // number of random cases; an integer
  double seed = 1;                     // of the random values; an integer
  std::vector<std::string> measure{};  // empty: the default of bbsim sweep --help
};

// The origin of a scenario, kept for the metadata of its results.
struct Source {
  std::string file;                    // as the user gave it
  std::string text;                    // the complete text
  std::vector<std::string> overrides;  // each "key.path=value", in the given order
};

struct Scenario {
  std::string title;
  double gravity = 9.80665;  // m/s^2, >= 0
  Ball ball;
  Plate plate;
  Gimbal gimbal;
  std::optional<Controller> controller{};  // present exactly when gimbal.motion and .torque are not
  Events events;
  OutputTimes time;
  Solver solver;
  Output output;
  Sweep sweep;
  bool has_exercise = false;  // which scenario/exercise.hpp reads
  Source source;
  // Keys that name files of tables, and the files' paths.
  std::vector<std::pair<std::string, std::string>> tables{};
  // Notes and warnings on valid values that may be mistakes: one line each, with the place.
  std::vector<std::string> remarks{};
};

// The known commands of Law::commands; null for any other law and without a controller.
template <class AnyScenario>
[[nodiscard]] auto* commands_of(AnyScenario& scenario) {
  using Commands = decltype(std::get_if<CommandProfiles>(&scenario.controller->reference));
  return scenario.controller ? std::get_if<CommandProfiles>(&scenario.controller->reference)
                             : Commands{nullptr};
}

}  // namespace bbsim
