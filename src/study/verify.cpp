// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/verify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "base/real.hpp"
#include "model/ball/rolling.hpp"
#include "model/model.hpp"
#include "scenario/coupled.hpp"
#include "scenario/reader.hpp"
#include "solve/cvode/derivative.hpp"
#include "solve/integrate.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::study {
namespace {

// x, y and r gamma in m, r gamma' in m/s.
using Values = std::array<double, 4>;

struct KnownMotion {
  const char* name;
  const char* scenario;  // YAML
  Values (*at)(const Scenario& scene, double t);
  bool only_at_end = false;
};

Values reference(const Scenario& scene, double x, double y, double gamma, double spin) {
  const double r = scene.ball.radius;
  return {x, y, r * gamma, r * spin};
}

constexpr const char* fig2a = R"yaml(
gravity: 9.81
ball: {radius: 0.01, position: [0, -0.10]}
gimbal:
  motion:
    phi: {sinusoid: {amplitude: 0.01, frequency: 1, phase: "90 deg"}}
    theta: {sinusoid: {amplitude: -0.01, frequency: 1}}
time: {end: 10, step: 0.1}
)yaml";

constexpr const char* fig2b = R"yaml(
gravity: 9.81
ball: {radius: 0.01, position: [0.05, 0]}
gimbal: {servo: {natural_frequency: 10, damping: 1}}
controller:
  pd: {kv: [[1, 0], [0, -1]], kp: [[0.001, 0], [0, -0.001]]}
  drives: angle
  reference: {circle: {radius: 0.05, rate: -0.3}}
time: {end: 21, step: 0.1}
)yaml";

// References are quad-precision solutions, by another program with another method: the last rows of
// fig2a, fig2b, fast, spin and torque-loop of tests/data/reference.
constexpr KnownMotion known_motions[] = {
    {"fixed incline: closed form (M1)", R"yaml(
ball: {radius: 0.01, position: [0.1, -0.2], velocity: [0.3, 0.4], spin: 20}
gimbal: {motion: {phi: 0.2, theta: -0.3}}
time: {end: 3, step: 0.1}
)yaml",
     [](const Scenario& scene, double t) -> Values {
       const double a = 5.0 / 14 * scene.gravity, spun = 20 * scene.ball.radius;
       return {0.1 + 0.3 * t + a * std::sin(0.2) * t * t,
               -0.2 + 0.4 * t + a * std::cos(0.2) * std::sin(0.3) * t * t, spun * t, spun};
     }},
    {"plane turning at a constant rate: (M2), (M3)", R"yaml(
ball: {radius: 0.01, position: [0.05, 0], velocity: [0, 0.1], spin: 5}
gimbal: {motion: {phi: {ramp: {start: 0, rate: 2}}, theta: 0}}
time: {end: 3, step: 0.1}
)yaml",
     [](const Scenario& scene, double t) -> Values {
       const double w = 2, vy0 = 0.1, u0 = 5 * scene.ball.radius;
       const double k = w * std::sqrt(5.0 / 7), q = w * std::sqrt(2.0 / 7);
       const double b = 5 * scene.gravity / (12 * w);  // with this, x'(0) is zero
       const double c = 2.0 / 7 * u0 * w / q;
       // y is the integral of y' of (M3), and u' = -w y' by the third row of (27).
       const double y = (vy0 * std::sin(q * t) + c * (1 - std::cos(q * t))) / q;
       const double integral_of_y =
           (vy0 * (1 - std::cos(q * t)) / q + c * (t - std::sin(q * t) / q)) / q;
       return {0.05 * std::cosh(k * t) + b * (std::sinh(k * t) / k - std::sin(w * t) / w), y,
               u0 * t - w * integral_of_y, u0 - w * y};
     }},
    {"rolling resistance: coasts down and stays (M41)", R"yaml(
ball: {radius: 0.02, mass: 0.05, velocity: [0.2, 0], losses: {rolling: 0.004}}
gimbal: {motion: {}}
time: {end: 10, step: 0.1}
)yaml",
     [](const Scenario& scene, double t) -> Values {
       const double a = 0.004 * scene.gravity / 1.4, rolled = std::min(t, 0.2 / a);
       return {0.2 * rolled - a * rolled * rolled / 2};
     }},
    {"viscous loss: slows down exponentially", R"yaml(
ball: {radius: 0.02, mass: 0.05, velocity: [0.2, 0], losses: {viscous: 5e-6}}
gimbal: {motion: {}}
time: {end: 10, step: 0.1}
)yaml",
     [](const Scenario& scene, double t) -> Values {
       const double rate = 5e-6 / (1.4 * 0.05 * scene.ball.radius * scene.ball.radius);
       return {0.2 / rate * (1 - std::exp(-rate * t))};
     }},
    {"sliding: rolls after 2v/(7 mu g), with 5v/7", R"yaml(
ball: {radius: 0.02, mass: 0.05, velocity: [1, 0], rotation: [0, 0]}
gimbal: {motion: {}}
events: {slip: {friction: 0.3, sliding_friction: 0.25, action: slide}}
time: {end: 2, step: 0.02}
)yaml",
     [](const Scenario& scene, double t) -> Values {
       const double a = 0.25 * scene.gravity, slid = std::min(t, 2 / (7 * a));
       return {slid - a * slid * slid / 2 + (t - slid) * 5 / 7};
     }},
    {"Fig. 2(a): quad-precision reference", fig2a,
     [](const Scenario& scene, double) {
       return reference(scene, 0.128997060042080921854, 0.640144149966492423146,
                        0.740410992965113494092, 0.129133706248911483373);
     },
     true},
    {"Fig. 2(b): quad-precision reference", fig2b,
     [](const Scenario& scene, double) {
       return reference(scene, 0.0500659415640750923014, 0.00130369798481122916803,
                        -0.0203169638021230508574, -0.00096634848091631457435);
     },
     true},
    {"fast tilts: quad-precision reference", R"yaml(
gravity: 9.81
ball: {radius: 0.01, position: [0, -0.10]}
gimbal:
  motion:
    phi: {sinusoid: {amplitude: 0.3, frequency: 5, phase: "90 deg"}}
    theta: {sinusoid: {amplitude: -0.3, frequency: 5}}
time: {end: 10, step: 0.1}
)yaml",
     [](const Scenario& scene, double) {
       return reference(scene, -1263.5870629001539983, 295.349731081961728962,
                        6756.58198419250448039, -234.251119246236766868);
     },
     true},
    {"spinning ball: quad-precision reference", R"yaml(
gravity: 9.81
ball: {radius: 0.01, position: [0.1, -0.05], velocity: [0.2, 0], spin: 50}
gimbal:
  motion:
    phi: {sinusoid: {amplitude: 0.05, frequency: 3, phase: "90 deg", offset: 0.01}}
    theta: {sinusoid: {amplitude: -0.04, frequency: 2}}
time: {end: 10, step: 0.1}
)yaml",
     [](const Scenario& scene, double) {
       return reference(scene, 6.20698433288439306179, 1.23162812306841789223,
                        497.869147135942135708, 53.3890112275766053121);
     },
     true},
    {"motors' position loops: quad-precision reference", R"yaml(
gravity: 9.81
ball: {radius: 0.01, mass: 0.1, position: [0.05, 0]}
plate: {inertia: [2e-3, 3e-3, 5e-3]}
gimbal:
  ring_inertia: 1e-3
  motor: {rotor_inertia: 5e-4, viscous: 0.005, position_loop: {kp: 4, kd: 0.12}}
controller:
  pd: {kv: [[0.6, 0], [0, -0.6]], kp: [[0.7, 0], [0, -0.7]]}
  drives: angle
  reference: {circle: {radius: 0.05, rate: -0.3}}
time: {end: 10, step: 0.1}
)yaml",
     [](const Scenario& scene, double) {
       return reference(scene, -0.0728693868022719569246, -0.0206756855480585645164,
                        -0.0260799703186316307582, -0.00226025782725371146275);
     },
     true},
};

// In each step, the integrator may make an error of rtol |z| + atol in each state. An error in a
// speed lets the position drift by that times the rest of the scene. If a scene grows
// exponentially, an error grows as the solution does, so |z| is the solution's largest value.
// Hence, for positions, r gamma and r gamma',
//
//     bound = steps (rtol size + atol) (1 + end / 1 s).
Check compare(const KnownMotion& known, const solve::Watch& watch) {
  constexpr solve::Tolerances tolerances{1e-12, 1e-14};
  const Scenario scene = parse_scenario(known.scenario, known.name);
  const model::Model model = model::assemble(scene, true);
  const solve::OutputGrid grid(scene.time);
  solve::Trajectory rows(model.row_size());
  const solve::Outcome outcome =
      solve::integrate(model, Method::automatic, tolerances, grid, rows, {watch.stop, {}});
  const bool done = outcome.ending == solve::Ending::done && rows.rows() == grid.size();
  double error = done ? 0 : infinity, size = 0;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const model::Sample sample = model.sample(grid[i], rows.row(i));
    const model::BallMotion& ball = sample.ball;
    const double r = scene.ball.radius;
    const Values seen{ball.x, ball.y, r * sample.gamma, r * ball.gamma_dot};
    for (const double value : {ball.x, ball.y, ball.x_dot, ball.y_dot, r * ball.gamma_dot}) {
      size = larger(size, std::abs(value));
    }
    if (known.only_at_end && i + 1 < grid.size()) continue;
    const Values expected = known.at(scene, grid[i]);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      error = larger(error, std::abs(seen[k] - expected[k]));
    }
  }
  return {known.name, error,
          static_cast<double>(outcome.statistics.steps) *
              (tolerances.rtol * size + tolerances.atol) * (1 + scene.time.end)};
}

using solve::Trajectory;

constexpr solve::Tolerances tolerances{1e-9, 1e-11};

// Simpler equations of motion than (27), to measure what the full equation adds. Each is a policy
// for the systems of model/systems/system.hpp and replaces Equation27. In both, the spin stays
// constant.

// The ball rolls down the current slope as if the plane stood still.
struct SlopeOnly {
  template <class Real, class Phi, class Theta, class Ball>
  static Real x(const Phi& phi, const Theta&, const Ball&, double, double g) {
    return 5 * g * phi.sin / 7;
  }
  template <class Real, class Phi, class Theta, class Ball>
  static Real y(const Phi& phi, const Theta& theta, const Ball&, double, double g) {
    return -(5 * g * phi.cos * theta.sin) / 7;
  }
  template <class Real, class Phi, class Theta, class Ball>
  static Real u(const Phi&, const Theta&, const Ball&, double) {
    return Real(0.0);
  }
};

// The textbook ball and plate: slope and centrifugal terms, without the effect of the plane's
// rotation on the rolling inertia, without the spin, and without the gimbal's accelerations.
struct BallAndPlate {
  template <class Real, class Phi, class Theta, class Ball>
  static Real x(const Phi& phi, const Theta& theta, const Ball& ball, double, double g) {
    return 5 * (g * phi.sin + ball.x * (phi.rate * phi.rate) + ball.y * (phi.rate * theta.rate)) /
           7;
  }
  template <class Real, class Phi, class Theta, class Ball>
  static Real y(const Phi& phi, const Theta& theta, const Ball& ball, double, double g) {
    return 5 *
           (ball.y * (theta.rate * theta.rate) + ball.x * (phi.rate * theta.rate) - g * theta.sin) /
           7;
  }
  template <class Real, class Phi, class Theta, class Ball>
  static Real u(const Phi&, const Theta&, const Ball&, double) {
    return Real(0.0);
  }
};

template <class Equation>
solve::Derivative simpler_derivative(const model::Model& model) {
  return std::visit(
      [](const auto& system) -> solve::Derivative {
        if constexpr (requires { system.template with_equation<Equation>(); }) {
          return
              [simpler = system.template with_equation<Equation>()](
                  double t, const double* z, double* dz) { model::derivative(simpler, t, z, dz); };
        } else {
          throw InputError("verify: simpler models are compared over scenarios without switches");
        }
      },
      model.system);
}

struct Position {
  double x, y;
};

Position position(const model::Model& model, double t, const double* row) {
  const model::BallMotion ball = model.sample(t, row).ball;
  return {ball.x, ball.y};
}

SimplerModel compare(std::string name, std::string equation, const Trajectory& full,
                     const Trajectory& simpler, const model::Model& model,
                     const solve::OutputGrid& grid) {
  SimplerModel result{std::move(name), std::move(equation)};
  const std::size_t rows = std::min(full.rows(), simpler.rows());
  for (std::size_t i = 0; i < rows; ++i) {
    const Position a = position(model, grid[i], full.row(i));
    const Position b = position(model, grid[i], simpler.row(i));
    const double dx = std::abs(a.x - b.x), dy = std::abs(a.y - b.y);
    if (dx > result.dx) std::tie(result.dx, result.at_dx) = std::pair(dx, grid[i]);
    if (dy > result.dy) std::tie(result.dy, result.at_dy) = std::pair(dy, grid[i]);
    result.reached = grid[i];
  }
  return result;
}

}  // namespace

bool Verification::holds() const {
  return !interrupted && std::ranges::all_of(checks, &Check::holds);
}

Verification verify(const solve::Watch& watch) {
  Verification verification;
  for (const KnownMotion& motion : known_motions) {
    Check result = compare(motion, watch);
    if (watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed)) {
      verification.interrupted = true;
      break;
    }
    verification.checks.push_back(std::move(result));
    if (watch.progress) {
      watch.progress(static_cast<double>(verification.checks.size()) / std::size(known_motions));
    }
  }
  return verification;
}

std::vector<Scenario> paper_scenes(const std::vector<std::string>& overrides) {
  return {parse_scenario(fig2a, "fig2a", overrides), parse_scenario(fig2b, "fig2b", overrides)};
}

void require_comparable(const Scenario& scenario) {
  const model::Model model = model::assemble(scenario, false);
  if (model.hybrid() || model.rig || scenario::is_coupled(scenario) ||
      !model::is_the_papers(scenario)) {
    throw InputError(
        scenario.source.file +
        ": simpler models are compared over scenarios with the paper's gimbal and ball, "
        "with prescribed motion or under pd, without events and limits; try --set "
        "events=null, or run `bbsim verify` without a scenario");
  }
}

FullModelStudy compare_simpler(const Scenario& scenario, const solve::Watch& watch) {
  require_comparable(scenario);
  const model::Model model = model::assemble(scenario, false);
  const solve::OutputGrid grid(scenario.time);
  Trajectory full(model.size());
  const solve::Outcome outcome =
      solve::integrate(model, Method::automatic, tolerances, grid, full, watch);
  FullModelStudy study;
  study.reached = outcome.reached;
  const auto add = [&](std::string name, std::string equation, solve::Derivative derivative) {
    const Trajectory rows =
        solve::integrate_by_bdf(std::move(derivative), model, tolerances, grid, watch);
    study.simpler.push_back(compare(std::move(name), std::move(equation), full, rows, model, grid));
  };
  add("slope only", "x'' = (5/7) g sin phi, y'' = -(5/7) g cos phi sin theta",
      simpler_derivative<SlopeOnly>(model));
  add("ball and plate",
      "x'' = (5/7)(g sin phi + x phi'^2 + y phi' theta'), "
      "y'' = (5/7)(-g sin theta + y theta'^2 + x phi' theta')",
      simpler_derivative<BallAndPlate>(model));
  study.interrupted = watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed);
  return study;
}

}  // namespace bbsim::study
