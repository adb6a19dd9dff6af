// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/linearize.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "model/control/linear_system.hpp"
#include "model/control/sampled_cycle.hpp"
#include "model/dense.hpp"
#include "model/eigenvalues.hpp"
#include "scenario/coupled.hpp"

namespace bbsim::model {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Of both axes.
constexpr const char *coordinate[] = {"x", "y"}, *angle_name[] = {"phi", "theta"};

std::string command_unit(const Scenario& scene) {
  if (scene.gimbal.torque) return "N m";
  if (!scene.controller) return "rad/s^2";
  return bbsim::command_unit(scene.controller->drives);
}

std::vector<LinearSignal> signals_of_commands(const Scenario& scene, const std::vector<int>& axes) {
  std::vector<LinearSignal> signals;
  for (const int axis : axes) {
    const char* const suffix = scene.controller      ? "_command"
                               : scene.gimbal.torque ? "_torque"
                                                     : "_acceleration";
    signals.push_back({std::string(angle_name[axis]) + suffix, command_unit(scene)});
  }
  return signals;
}

std::vector<LinearSignal> signals_of_positions(const std::vector<int>& axes, const char* suffix) {
  std::vector<LinearSignal> signals;
  for (const int axis : axes) signals.push_back({std::string(coordinate[axis]) + suffix, "m"});
  return signals;
}

// Columns of the reference that are inputs: its values, and those rates and accelerations that the
// loop feels.
std::vector<int> reference_inputs(const MatrixXd& of_reference, const std::vector<int>& axes,
                                  std::vector<LinearSignal>& signals) {
  constexpr const char* suffixes[] = {"_reference", "_reference_rate", "_reference_acceleration"};
  constexpr const char* units[] = {"m", "m/s", "m/s^2"};
  std::vector<int> columns;
  for (int order = 0; order < 3; ++order) {
    if (order > 0 && of_reference.middleCols(2 * order, 2).isZero(0)) continue;
    for (const int axis : axes) {
      columns.push_back(2 * order + axis);
      signals.push_back({std::string(coordinate[axis]) + suffixes[order], units[order]});
    }
  }
  return columns;
}

// A system whose outputs are the positions, its first states.
LinearSystem system_of(std::vector<LinearSignal> states, std::vector<LinearSignal> inputs,
                       const std::vector<int>& axes, const MatrixXd& a, const MatrixXd& b) {
  const Eigen::Index outputs = std::ssize(axes);
  return {std::move(states),
          std::move(inputs),
          signals_of_positions(axes, ""),
          a,
          b,
          MatrixXd::Identity(outputs, a.rows()),
          MatrixXd::Zero(outputs, b.cols()),
          {}};
}

// At home three servos act as two ideal ones, unless they differ or the scene has losses or a push.
Heave heave_of(const Scenario& scene, const LinearPoint& at) {
  const auto& three = scene.gimbal.three_servos;
  const bool differ =
      three && three->legs &&
      std::ranges::any_of(*three->legs, [](const ServoLeg& leg) { return leg.servo.has_value(); });
  return at.home && !differ && !scenario::is_coupled(scene) ? Heave::left_out : Heave::kept;
}

Linearization plant_about(const Scenario& scene, const Model& model, const LinearPoint& at) {
  if (model.rig && std::ranges::any_of(model.rig->servo, [](const RigServo& servo) {
        return servo.time_constant.has_value();
      })) {
    throw InputError(
        "linearize: the plant has a servo of first order (gimbal.servo.time_constant), whose rate "
        "jumps with its command; allowed: sampled or loop");
  }
  const std::vector<int> axes = moving_axes(model);
  const PlantDerivatives plant = plant_derivatives(model, at, heave_of(scene, at));
  const std::vector<int> states =
      linear_states(plant.places, plant.of_state, axes, SpinStands::after_velocities);
  Linearization linearization;
  LinearSystem& system = linearization.system;
  system = system_of(state_signals(plant.places, command_unit(scene), states),
                     signals_of_commands(scene, axes), axes, plant.of_state(states, states),
                     plant.of_command(states, axes));
  linearization.poles = sorted_eigenvalues(system.a);
  linearization.zeros = transmission_zeros(system.a, system.b, system.c, system.d);
  return linearization;
}

// Response of the ball's position to the reference, including the reference's derivatives.
std::function<std::complex<double>(double)> tracking(const FrequencyResponse& response,
                                                     const std::vector<int>& columns,
                                                     const std::vector<int>& axes, int axis) {
  return [=](double w) {
    std::complex<double> sum = 0;
    for (std::size_t j = 0; j < columns.size(); ++j) {
      if (columns[j] % 2 != axis) continue;
      const std::complex<double> derivative = std::pow(std::complex<double>(0, w), columns[j] / 2);
      const auto output = std::find(axes.begin(), axes.end(), axis) - axes.begin();
      sum += response.at(w, output, static_cast<Eigen::Index>(j)) * derivative;
    }
    return sum;
  };
}

// A closed loop for margins and bandwidth: without an idle axis and without the spin, whose pole no
// command moves. Off home that pole is next to 0, so the response at rest, the pole's side of the
// border, and the factor that changes that side mean nothing.
struct PlainLoop {
  std::vector<int> states;  // indices in the system
  MatrixXd a;
  Eigenvalues poles;
  // Gain margins slower than this mean nothing either, rad/s: on a moving gimbal, the point has
  // moved on by then.
  double slowest;
};

// Frequency below which a point has moved on before anything happens, rad/s: four times the rate at
// which the plane turns, or at which its acceleration throws the ball.
double slowest_at(const PlantDerivatives& plant) {
  const int angle = spin_state + 1, servos = plant.places.servos;
  const auto largest = [servos](const VectorXd& of, int first) {
    return of.segment(first, servos).cwiseAbs().maxCoeff();
  };
  return 4 * std::max(largest(plant.rates, angle), std::sqrt(largest(plant.rates, angle + servos) *
                                                             largest(plant.state, angle)));
}

PlainLoop plain_loop(Linearization& linearization, double slowest, std::optional<int> idle = {}) {
  const LinearSystem& system = linearization.system;
  PlainLoop plain;
  plain.slowest = slowest;
  plain.states = states_without(system.states, idle);
  std::erase_if(plain.states, [&](int i) {
    return system.states[static_cast<std::size_t>(i)].name == spin_name;
  });
  plain.a = system.a(plain.states, plain.states);
  plain.poles = plain.states.size() == system.states.size() ? linearization.poles
                : system.period                             ? poles_of_period(plain.a)
                                                            : sorted_eigenvalues(plain.a);
  linearization.stable = stable(plain.poles, system.period.has_value());
  return plain;
}

void add_bandwidths(Linearization& linearization, const PlainLoop& plain,
                    const std::vector<int>& columns, const std::vector<int>& axes,
                    const LoopParts& parts, std::optional<int> idle) {
  if (!parts.bandwidths[0] && !parts.bandwidths[1]) return;
  const LinearSystem& system = linearization.system;
  const double period = system.period.value_or(0);
  const FrequencyResponse response(plain.a, system.b(plain.states, Eigen::all),
                                   system.c(Eigen::all, plain.states), system.d, period);
  const std::vector<double> frequencies = frequencies_to_look_at({}, plain.poles, period);
  // A law that is told the reference's accelerations may follow it at any frequency, by inverting
  // the plant. Its feedback shows without them.
  std::vector<int> fed_back;
  std::ranges::copy_if(columns, std::back_inserter(fed_back), [](int j) { return j / 2 < 2; });
  for (const int axis : axes) {
    if (axis == idle || !parts.bandwidths[static_cast<std::size_t>(axis)]) continue;
    const auto width = [&](const std::vector<int>& of) {
      return bandwidth_of(tracking(response, of, axes, axis), frequencies);
    };
    const double whole = width(columns);
    linearization.bandwidths.push_back(
        {coordinate[axis], whole, fed_back.size() == columns.size() ? whole : width(fed_back)});
  }
}

// Adds the margins of one command's loop. A, B and C are those of the loop opened there.
void add_margins(Linearization& linearization, const PlainLoop& plain, int axis,
                 const std::string& unit, const MatrixXd& a, const VectorXd& b,
                 const Eigen::RowVectorXd& c, MarginParts parts = {}) {
  const LinearSystem& system = linearization.system;
  const double period = system.period.value_or(0);
  const std::vector<int>& of = plain.states;
  const std::string command = std::string(angle_name[axis]) + "_command";
  LinearSystem open{
      signals_of(system.states, of), {{command, unit}}, {{command, unit}}, a(of, of), b(of), -c(of),
      MatrixXd::Zero(1, 1),          system.period};
  const FrequencyResponse response(open.a, open.b, open.c, open.d, period);
  const Margins margins =
      margins_of(response, frequencies_to_look_at(eigenvalues_of(open.a), plain.poles, period),
                 plain.slowest, parts);
  linearization.margins.push_back({command, margins, std::move(open)});
}

// Whether any margin of an axis' command is asked for.
bool looks_for(const LoopParts& parts, int axis) {
  const MarginParts& margins = parts.margins[static_cast<std::size_t>(axis)];
  return margins.gains || margins.phases;
}

// Returns a - b, with 0 for what only rounding leaves.
MatrixXd without(const MatrixXd& a, const MatrixXd& b) {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  return a.binaryExpr(
      b, [](double p, double q) { return std::abs(p - q) <= rounding * std::abs(q) ? 0 : p - q; });
}

// Zeros of C (sI - A)^-1 (B0 + s B1 + s^2 B2): those of the system with the reference and its lower
// derivatives as further states and the highest as input. (Multiples of A could replace the powers
// of s, but their entries would cancel.)
Eigenvalues tracking_zeros(const MatrixXd& a, const MatrixXd& of_reference, const MatrixXd& c,
                           const std::vector<int>& axes) {
  const Eigen::Index n = a.rows(), m = std::ssize(axes);
  const bool of_accelerations = !of_reference.rightCols(2).isZero(0);
  const Eigen::Index orders = of_accelerations ? 2 : 1, size = n + orders * m;
  const auto of_order = [&](Eigen::Index order) -> MatrixXd {
    return of_reference.middleCols(2 * order, 2)(Eigen::all, axes);
  };
  MatrixXd all = MatrixXd::Zero(size, size), input = MatrixXd::Zero(size, m),
           output = MatrixXd::Zero(c.rows(), size);
  all.topLeftCorner(n, n) = a;
  for (Eigen::Index order = 0; order < orders; ++order) {
    all.block(0, n + order * m, n, m) = of_order(order);
  }
  if (of_accelerations) all.block(n, n + m, m, m).setIdentity();
  input.topRows(n) = of_order(orders);
  input.bottomRows(m).setIdentity();
  output.leftCols(n) = c;
  return transmission_zeros(all, input, output, MatrixXd::Zero(c.rows(), m));
}

Linearization continuous_loop_about(const Scenario& scene, const Model& model,
                                    const LinearPoint& at, const LoopParts& parts) {
  const std::vector<int> axes = moving_axes(model);
  const Heave heave = heave_of(scene, at);
  const LoopDerivatives loop = loop_derivatives(model, at, heave);
  const PlantDerivatives plant = plant_derivatives(model, at, heave);
  const std::vector<int> states = loop_states(loop, axes);
  std::vector<LinearSignal> inputs;
  const std::vector<int> columns = reference_inputs(loop.of_reference, axes, inputs);
  Linearization linearization;
  LinearSystem& system = linearization.system;
  system = system_of(state_signals(loop.places, command_unit(scene), states), std::move(inputs),
                     axes, loop.of_state(states, states), loop.of_reference(states, columns));
  linearization.poles = sorted_eigenvalues(system.a);
  if (parts.zeros) {
    linearization.zeros =
        tracking_zeros(system.a, loop.of_reference(states, Eigen::all), system.c, axes);
  }

  const std::optional<int> idle =
      idle_axis(model, {system.states, system.a, loop.command_of_state(Eigen::all, states)});
  const PlainLoop plain = plain_loop(linearization, slowest_at(plant), idle);
  for (const int axis : axes) {
    if (axis == idle || !looks_for(parts, axis)) continue;
    const VectorXd b = plant.of_command(states, axis);
    const Eigen::RowVectorXd c = loop.command_of_state(axis, states);
    add_margins(linearization, plain, axis, command_unit(scene), without(system.a, b * c), b, c,
                parts.margins[static_cast<std::size_t>(axis)]);
  }
  add_bandwidths(linearization, plain, columns, axes, parts, idle);
  return linearization;
}

Linearization sampled_loop_about(const Scenario& scene, const Model& model, const LinearPoint& at,
                                 const LoopParts& parts) {
  const std::vector<int> axes{0, 1};
  const PlantDerivatives plant = plant_derivatives(model, at, heave_of(scene, at));
  const SampledCycle cycle(plant, *model.rig, at, SampledCycle::Frames::of_equal_age);
  const SampledMap closed = cycle.map();
  std::vector<LinearSignal> inputs;
  const std::vector<int> columns = reference_inputs(closed.of_reference, axes, inputs);
  Linearization linearization;
  LinearSystem& system = linearization.system;
  system = system_of(cycle.signals(command_unit(scene)), std::move(inputs), axes, closed.a,
                     closed.of_reference(Eigen::all, columns));
  system.period = scene.controller->sampling->period;
  linearization.poles = poles_of_period(system.a);
  if (parts.zeros) {
    linearization.zeros = transmission_zeros(system.a, closed.of_reference.leftCols(2), system.c,
                                             MatrixXd::Zero(2, 2));
  }
  const std::optional<int> idle = idle_axis(model, {system.states, system.a, closed.law});
  const PlainLoop plain = plain_loop(linearization, slowest_at(plant), idle);
  for (const int axis : axes) {
    if (axis == idle || !looks_for(parts, axis)) continue;
    const SampledMap open = cycle.map(axis == 0, axis == 1);
    add_margins(linearization, plain, axis, command_unit(scene), open.a, open.of_command.col(axis),
                open.law.row(axis), parts.margins[static_cast<std::size_t>(axis)]);
  }
  add_bandwidths(linearization, plain, columns, axes, parts, idle);
  return linearization;
}

Linearization sampled_plant_about(const Scenario& scene, const Model& model,
                                  const LinearPoint& at) {
  if (!scene.controller || !scene.controller->sampling) {
    throw InputError(
        "linearize: the scenario has no controller.sampling, which gives the period and the delays "
        "of "
        "the sampled plant; allowed: plant or loop");
  }
  const SampledCycle cycle(plant_derivatives(model, at, heave_of(scene, at)), *model.rig, at,
                           SampledCycle::Frames::of_equal_age);
  const int n = cycle.size(), first = cycle.controller_at();
  // The controller's memory is not part of the plant.
  std::vector<int> kept;
  for (int i = 0; i < n; ++i) {
    if (i < first || i >= first + cycle.controller_size()) kept.push_back(i);
  }
  const SampledMap open = cycle.map(true, true);
  Linearization linearization;
  LinearSystem& system = linearization.system;
  system = {signals_of(cycle.signals(command_unit(scene)), kept),
            signals_of_commands(scene, {0, 1}),
            signals_of_positions({0, 1}, "_measured"),
            open.a(kept, kept),
            open.of_command(kept, Eigen::all),
            open.seen(Eigen::all, kept),
            MatrixXd::Zero(2, 2),
            scene.controller->sampling->period};
  linearization.poles = poles_of_period(system.a);
  linearization.zeros = transmission_zeros(system.a, system.b, system.c, system.d);
  return linearization;
}

}  // namespace

Linearization loop_with(const Linearization& plant, const LinearSystem& law,
                        const std::vector<int>& axes) {
  const LinearSystem& of = plant.system;
  const Eigen::Index n = of.a.rows(), m = law.a.rows();
  // Commands from measurements and from the law's memory.
  MatrixXd commands(2, n + m);
  commands << product(law.d, of.c), law.c;
  // Closes the loops of the given commands.
  const auto round = [&](const MatrixXd& given) {
    MatrixXd a(n + m, n + m);
    a << of.a, MatrixXd::Zero(n, m), product(law.b, of.c), law.a;
    a.topRows(n) += product(of.b, given);
    return a;
  };
  Linearization linearization;
  LinearSystem& system = linearization.system;
  system.states = of.states;
  for (Eigen::Index i = 0; i < m; ++i) {
    system.states.push_back({"law_" + std::to_string(i + 1), "1"});
  }
  system.a = round(commands);
  system.b.resize(n + m, 0);
  system.c.resize(0, n + m);
  system.period = of.period;
  linearization.poles = poles_of_period(system.a);
  // An axis without a command is left out if it stands apart.
  std::optional<int> idle;
  if (axes.size() == 1 && stands_apart({system.states, system.a, commands}, 1 - axes[0])) {
    idle = 1 - axes[0];
  }
  const PlainLoop plain = plain_loop(linearization, 0, idle);
  for (const int axis : axes) {
    MatrixXd others = commands;
    others.row(axis).setZero();
    VectorXd b = VectorXd::Zero(n + m);
    b.head(n) = of.b.col(axis);
    add_margins(linearization, plain, axis, of.inputs[static_cast<std::size_t>(axis)].unit,
                round(others), b, commands.row(axis));
  }
  return linearization;
}

LinearKind usual_kind(const Scenario& scene) {
  if (!scene.controller) return LinearKind::plant;
  if (commands_of(scene) != nullptr) {
    return scene.controller->sampling ? LinearKind::sampled : LinearKind::plant;
  }
  return scene.controller->own ? LinearKind::sampled : LinearKind::loop;
}

namespace {

Linearization linearize_as(const Scenario& scene, const Model& model, LinearKind kind,
                           const LinearPoint& at, const LoopParts& parts) {
  switch (kind) {
    case LinearKind::plant:
      break;
    case LinearKind::sampled:
      return sampled_plant_about(scene, model, at);
    case LinearKind::loop:
      if (!scene.controller) {
        throw InputError(
            "linearize: the scenario has no controller, which the loop needs; allowed: plant");
      }
      if (commands_of(scene) != nullptr) {
        throw InputError("linearize: controller.commands close no loop; allowed: plant, sampled");
      }
      if (scene.controller->own) {
        throw InputError(
            "linearize: found your own controller, whose law bbsim does not know; allowed: plant, "
            "sampled");
      }
      return scene.controller->sampling ? sampled_loop_about(scene, model, at, parts)
                                        : continuous_loop_about(scene, model, at, parts);
  }
  return plant_about(scene, model, at);
}

// Symmetry makes -0 of 0, and -0 + 0 is 0.
void make_zeros_plain(Eigenvalues& values) {
  for (auto& value : values) value = {value.real() + 0.0, value.imag() + 0.0};
}

}  // namespace

Linearization linearize(const Scenario& scene, const Model& model, LinearKind kind,
                        const LinearPoint& at, const LoopParts& parts) {
  require_linear(scene);
  Linearization linearization = linearize_as(scene, model, kind, at, parts);
  std::vector<LinearSystem*> all{&linearization.system};
  for (LoopMargins& loop : linearization.margins) all.push_back(&loop.open);
  for (LinearSystem* const system : all) {
    for (MatrixXd* const matrix : {&system->a, &system->b, &system->c, &system->d})
      matrix->array() += 0.0;
  }
  make_zeros_plain(linearization.poles);
  make_zeros_plain(linearization.zeros);
  return linearization;
}

}  // namespace bbsim::model
