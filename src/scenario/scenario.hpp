// What the user wrote, in SI units and radians, with every default in sight.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace bbsim {

using Pair = std::array<double, 2>;   // (x, y), or (phi, theta)
using Matrix2 = std::array<Pair, 2>;  // rows phi, theta; columns x, y

struct Ball {
  double radius = 0;    // m, > 0, required
  double mass = 1;      // kg, > 0; forces, torques and energy only
  Pair position{0, 0};  // contact point in the plane frame, m
  Pair velocity{0, 0};  // of the contact point in the plane frame, m/s
  double spin = 0;      // about the plane normal, relative to the plane, rad/s
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

using ProfileTerm = std::variant<double, Sinusoid, Ramp, Table>;  // a number is a constant
using Profile = std::vector<ProfileTerm>;                         // their sum; empty is zero

struct GimbalMotion {
  Profile phi, theta;
};

struct GimbalStart {
  double phi = 0, theta = 0;            // rad
  double phi_rate = 0, theta_rate = 0;  // rad/s
};

// phi'' = omega_n^2 (u_phi - phi) - 2 zeta omega_n phi'; theta alike.
struct Servo {
  double natural_frequency = 0;  // omega_n, rad/s, > 0
  double damping = 0;            // zeta, >= 0
};

struct Gimbal {
  std::optional<GimbalMotion> motion;  // prescribed; otherwise a controller moves it
  GimbalStart start;
  std::optional<Servo> servo;  // there exactly when the controller drives angle
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

enum class Drives { acceleration, angle };

// u = kv e' + kp e, e = reference - (x, y): equation (31).
struct Controller {
  Matrix2 kv{}, kp{};
  Drives drives = Drives::acceleration;
  Reference reference;
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
  std::optional<double> error;
};

struct Output {
  std::vector<std::string> columns{"t", "x", "y", "gamma", "phi", "theta"};
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
  Gimbal gimbal;
  std::optional<Controller> controller;  // there exactly when gimbal.motion is not
  OutputTimes time;
  Solver solver;
  Output output;
  Source source;
};

}  // namespace bbsim
