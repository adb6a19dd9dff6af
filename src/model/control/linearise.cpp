// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/linearise.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "base/error.hpp"
#include "model/assemble_rig.hpp"
#include "model/control/common_cycle.hpp"
#include "model/control/linear_law.hpp"
#include "model/control/linear_parts.hpp"
#include "model/control/sampled_cycle.hpp"
#include "model/control/transmission_zeros.hpp"
#include "model/dense.hpp"
#include "model/eigenvalues.hpp"
#include "model/servo/linkages.hpp"
#include "model/signals/reference_path.hpp"
#include "scenario/coupled.hpp"
#include "simd/gradient.hpp"

namespace bbsim::model {

Linkages linkages_at(const Between& between, const LinearPoint& at) {
  Linkages link = between.at_home();
  for (std::size_t i = 0; i < between.linkages.size(); ++i) {
    const Linkage& linkage = between.linkages[i];
    if (!linkage.table) continue;
    const auto piece = [&](double servo) {
      return linkage.table->view().pieces[linkage.piece_at(0, servo, 1)];
    };
    link.of[i].piece = piece((at.state.data() + RigLayout::angle)[i]);
    link.of[i].command_piece = piece(at.command[i]);
  }
  return at.home ? levelled(link) : link;
}

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int angle = RigLayout::angle, rate = RigLayout::rate, integral = RigLayout::integral;

}  // namespace

Feedback<double> feedback_at(const Rig& rig, const LinearPoint& at) {
  Feedback<double> fed{};
  for (int i = 0; i < 2; ++i) {
    const auto state = [&](int place) { return (at.state.data() + place)[i]; };
    fed.position[i] = state(0);
    fed.velocity[i] = state(2);
    fed.angle[i] = state(angle);
    fed.rate[i] = state(rate);
    fed.integral[i] = state(integral);
  }
  if (rig.sampled && !rig.sampled->sensor.is_aligned()) {
    const Sensor& sensor = rig.sampled->sensor;
    const Eigen::Vector2d p = seen_matrix(sensor) * Eigen::Vector2d(fed.position),
                          v = seen_matrix(sensor) * Eigen::Vector2d(fed.velocity);
    for (int i = 0; i < 2; ++i) {
      fed.position[i] = p[i] + sensor.offset[static_cast<std::size_t>(i)];
      fed.velocity[i] = v[i];
    }
  }
  if (!at.home && !rig.between.none()) {
    double known[4];
    if (rig.between.three) {
      rig.between.believed(at.own.data() + angle, at.own.data() + angle + rig.servos, known);
    } else {
      rig.between.believed(fed.angle, fed.rate, known);
    }
    std::copy_n(known, 2, fed.angle);
    std::copy_n(known + 2, 2, fed.rate);
  }
  return fed;
}

void link_controller(CycleParts& parts, const Linkages& link, const Rig& rig,
                     const LinearPoint& at) {
  double of_command[2], of_angle[2];
  for (int i = 0; i < 2; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    const LinkCurve& curve = link.of[i];
    const LinkCurve& known = rig.between.linkages[axis].curve;
    const bool exact = known.assumed == Assumed::exact;
    LinkCurve commanded = curve;
    commanded.piece = curve.command_piece;
    of_command[i] = exact ? commanded.plain_turn(at.command[axis]).slope : curve.slope;
    of_angle[i] = exact ? curve.plain_turn((at.state.data() + angle)[i]).slope : curve.slope;
    if (known.kind == LinkCurve::Kind::ideal) of_command[i] = of_angle[i] = 1;
  }
  parts.link_controller(of_command, of_angle);
}

namespace {

constexpr int plant_size = RigLoop<>::size;

// Whether the scene's own system is differentiated (linear_coupled.cpp). Others are RigLoops: at
// home three servos, which are alike and follow what they are told, are two ideal ones.
bool in_full(const Scenario& scene, const LinearPoint& at) {
  return scenario::is_coupled(scene) || (scene.gimbal.three_servos && !at.home);
}

bool has_linkages(const Scenario& scene) {
  return scene.gimbal.linkage[0] || scene.gimbal.linkage[1];
}

// The gimbal and the ball without a controller's law, whatever moves the gimbal: a law that hands
// on its reference, u = reference - position.
template <class Link>
RigLoop<false, SignalPair, Link> plant_of(const Scenario& scene, const LinearPoint& at) {
  bool level = at.home;
  ServoResponses servo;
  RigMode mode;
  Link link;
  if (scene.controller) {
    // As the loop has them.
    Scenario plain = scene;
    plain.controller->law = Law::pd;
    const auto built = assemble_rig<false, Link>(plain, {});
    servo = built.loop.servo();
    mode = built.loop.mode;
    link = built.loop.link;
    if constexpr (!Link::direct) {
      link = linkages_at(built.rig.between, at);
      for (LinkCurve& one : link.of) one.assumed = Assumed::none;
    }
  } else {
    // A motion that is prescribed has the offsets in its angles.
    level = true;
  }
  if (level) mode = {};
  ControlLaw law;
  law.kind = LawKind::linear;
  law.gain[0][0] = law.gain[1][1] = 1;
  return {scene.ball.radius, scene.gravity, general_rolling(scene), law, servo, {}, mode, link};
}

template <class Link>
PlantDerivatives differentiate_plant(const RigLoop<false, SignalPair, Link>& plant,
                                     const LinearPoint& at) {
  Varied z[plant_size], dz[plant_size];
  for (int i = 0; i < plant_size; ++i) {
    z[i] = Varied::variable(at.state[static_cast<std::size_t>(i)], i);
  }
  plant.derivative_of(reference_for(at.command, z, plant_size), z, dz);
  return plant_derivatives<plant_size>(dz);
}

PlantDerivatives differentiate_rig(const Scenario& scene, const LinearPoint& at) {
  return has_linkages(scene) ? differentiate_plant(plant_of<Linkages>(scene, at), at)
                             : differentiate_plant(plant_of<Direct>(scene, at), at);
}

template <bool integrates, class Link>
LoopDerivatives differentiate_loop_with(const Scenario& scene, const LinearPoint& at) {
  const auto built = assemble_rig<integrates, Link>(scene, {});
  auto loop = built.loop;
  if constexpr (!Link::direct) loop.link = linkages_at(built.rig.between, at);
  if (at.home) loop.mode = {};
  constexpr int n = RigLoop<integrates>::size;
  Varied z[n], dz[n];
  for (int i = 0; i < n; ++i) z[i] = Varied::variable(at.state[static_cast<std::size_t>(i)], i);
  const auto reference = varied<Varied>(at.reference, n);
  loop.derivative_of(reference, z, dz);
  const RigAxes<Varied> axes = loop.axes(reference, z);
  const Varied commands[2] = {loop.told(axes, 0), loop.told(axes, 1)};
  return loop_derivatives<n>(dz, commands);
}

template <bool integrates>
LoopDerivatives differentiate_loop(const Scenario& scene, const LinearPoint& at) {
  return has_linkages(scene) ? differentiate_loop_with<integrates, Linkages>(scene, at)
                             : differentiate_loop_with<integrates, Direct>(scene, at);
}

// The coordinates that move: by symmetry x goes with phi, and y with theta.
std::vector<int> axes_of(const Model& model) {
  return std::visit(
      [](const auto& system) -> std::vector<int> {
        constexpr Shape shape = std::decay_t<decltype(system)>::moves;
        if constexpr (shape == Shape::along_x) return {0};
        if constexpr (shape == Shape::along_y) return {1};
        return {0, 1};
      },
      model.system);
}

const char* coordinate(int axis) {
  return axis == 0 ? "x" : "y";
}

const char* angle_name(int axis) {
  return axis == 0 ? "phi" : "theta";
}

std::vector<LinearSignal> signals_of(const std::vector<LinearSignal>& all,
                                     const std::vector<int>& states) {
  std::vector<LinearSignal> signals;
  signals.reserve(states.size());
  for (const int i : states) signals.push_back(all[static_cast<std::size_t>(i)]);
  return signals;
}

// Of the states of a RigLoop.
std::vector<LinearSignal> rig_signals(const std::string& command_unit) {
  return {{"x", "m"},
          {"y", "m"},
          {"vx", "m/s"},
          {"vy", "m/s"},
          {spin_name, "m/s"},
          {"phi", "rad"},
          {"theta", "rad"},
          {"phi_rate", "rad/s"},
          {"theta_rate", "rad/s"},
          {"phi_command_integral", command_unit},
          {"theta_command_integral", command_unit}};
}

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
    signals.push_back({std::string(angle_name(axis)) + suffix, command_unit(scene)});
  }
  return signals;
}

std::vector<LinearSignal> signals_of_positions(const std::vector<int>& axes, const char* suffix) {
  std::vector<LinearSignal> signals;
  for (const int axis : axes) signals.push_back({std::string(coordinate(axis)) + suffix, "m"});
  return signals;
}

// Which of the reference's inputs there are, of values, rates and accelerations: the values, and
// what else the loop feels.
std::vector<int> reference_inputs(const MatrixXd& of_reference, const std::vector<int>& axes,
                                  std::vector<LinearSignal>& signals) {
  constexpr const char* suffixes[] = {"_reference", "_reference_rate", "_reference_acceleration"};
  constexpr const char* units[] = {"m", "m/s", "m/s^2"};
  std::vector<int> columns;
  for (int order = 0; order < 3; ++order) {
    if (order > 0 && of_reference.middleCols(2 * order, 2).isZero(0)) continue;
    for (const int axis : axes) {
      columns.push_back(2 * order + axis);
      signals.push_back({std::string(coordinate(axis)) + suffixes[order], units[order]});
    }
  }
  return columns;
}

// The states of a RigLoop that belong to these axes, and the spin where it acts on another.
std::vector<int> states_of(const MatrixXd& of_state, const std::vector<int>& axes) {
  std::vector<int> states;
  for (const int first : {0, 2}) {
    for (const int axis : axes) states.push_back(first + axis);
  }
  VectorXd acts = of_state.col(spin_state);
  acts[spin_state] = 0;
  if (!acts.isZero(0)) states.push_back(spin_state);
  for (const int first : {angle, rate}) {
    for (const int axis : axes) states.push_back(first + axis);
  }
  return states;
}

// The positions, which are the first states.
MatrixXd positions_of(Eigen::Index outputs, Eigen::Index states) {
  return MatrixXd::Identity(outputs, states);
}

Linearisation plant_about(const Scenario& scene, const Model& model, const LinearPoint& at) {
  if (scene.gimbal.servo &&
      (scene.gimbal.servo->time_constant || scene.gimbal.servo_of(1).time_constant)) {
    throw InputError(
        "linearize: found --plant and a servo of first order (gimbal.servo.time_constant), whose "
        "rate jumps with its command; allowed: --sampled or --loop");
  }
  const std::vector<int> axes = axes_of(model);
  const bool full = in_full(scene, at);
  const PlantDerivatives plant = full ? coupled_plant_at(model, at) : differentiate_rig(scene, at);
  const std::vector<int> states =
      full ? coupled_states(model, plant.of_state) : states_of(plant.of_state, axes);
  Linearisation made;
  LinearSystem& system = made.system;
  const std::string unit = command_unit(scene);
  system.states = signals_of(full ? coupled_signals(model, unit) : rig_signals(unit), states);
  system.inputs = signals_of_commands(scene, axes);
  system.outputs = signals_of_positions(axes, "");
  system.a = plant.of_state(states, states);
  system.b = plant.of_command(states, axes);
  system.c = positions_of(std::ssize(axes), std::ssize(states));
  system.d = MatrixXd::Zero(std::ssize(axes), std::ssize(axes));
  made.poles = sorted_eigenvalues(system.a);
  made.zeros = transmission_zeros(system.a, system.b, system.c, system.d);
  return made;
}

// From where the reference is, with the rates that it then has, to where the ball is.
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

// A closed loop as its margins and bandwidth are taken from: without the spin, whose pole no
// command moves. Off home it is next to 0, so that what a response is at rest, on which side of the
// border the pole is, and by which factor it changes that, say nothing.
struct PlainLoop {
  std::vector<int> states;  // of the system's
  MatrixXd a;
  Eigenvalues poles;
  // Gain margins slower than this say nothing either, rad/s: where the gimbal moves, the point has
  // moved on by then.
  double slowest;
};

// Below which frequency a point has moved on before anything happens, rad/s: four times the rates
// at which the plane turns, and at which it throws the ball as its turn quickens.
double slowest_at(const Scenario& scene, const LinearPoint& at, const PlantDerivatives& plant) {
  const int servos = scene.gimbal.three_servos && !at.own.empty() ? 3 : 2;
  const double* const angles = (at.own.empty() ? at.state.data() : at.own.data()) + angle;
  const auto largest = [servos](const auto& of, int first) {
    double size = 0;
    for (int i = 0; i < servos; ++i) size = std::max(size, std::abs(of[first + i]));
    return size;
  };
  return 4 * std::max(largest(plant.rates, angle),
                      std::sqrt(largest(plant.rates, angle + servos) * largest(angles, 0)));
}

PlainLoop plain_loop(Linearisation& made, double slowest) {
  const LinearSystem& system = made.system;
  PlainLoop plain;
  plain.slowest = slowest;
  for (int i = 0; i < static_cast<int>(system.states.size()); ++i) {
    if (system.states[static_cast<std::size_t>(i)].name != spin_name) plain.states.push_back(i);
  }
  plain.a = system.a(plain.states, plain.states);
  plain.poles = plain.states.size() == system.states.size() ? made.poles
                : system.period                             ? poles_of_period(plain.a)
                                                            : sorted_eigenvalues(plain.a);
  made.stable = system.period ? stable_by_period(plain.poles) : stable(plain.poles);
  return plain;
}

void add_bandwidths(Linearisation& made, const PlainLoop& plain, const std::vector<int>& columns,
                    const std::vector<int>& axes) {
  const LinearSystem& system = made.system;
  const double period = system.period.value_or(0);
  const FrequencyResponse response(plain.a, system.b(plain.states, Eigen::all),
                                   system.c(Eigen::all, plain.states), system.d, period);
  const std::vector<double> frequencies = frequencies_to_look_at({}, plain.poles, period);
  // A law that is told the reference's accelerations may follow it at any frequency, by the plant's
  // own inverse: what its feedback does is seen without them.
  std::vector<int> fed_back;
  std::ranges::copy_if(columns, std::back_inserter(fed_back), [](int j) { return j / 2 < 2; });
  for (const int axis : axes) {
    const auto width = [&](const std::vector<int>& of) {
      return bandwidth_of(tracking(response, of, axes, axis), frequencies);
    };
    const double whole = width(columns);
    made.bandwidths.push_back(
        {coordinate(axis), whole, fed_back.size() == columns.size() ? whole : width(fed_back)});
  }
}

// The loop of one command: with what A, B and C it goes once round, open there.
void add_margins(Linearisation& made, const PlainLoop& plain, int axis, const MatrixXd& a,
                 const VectorXd& b, const Eigen::RowVectorXd& c) {
  const double period = made.system.period.value_or(0);
  const std::vector<int>& of = plain.states;
  const MatrixXd open = a(of, of);
  // What comes back is taken from the reference: 1 + L.
  const FrequencyResponse response(open, b(of), -c(of), MatrixXd::Zero(1, 1), period);
  made.margins.push_back(
      {std::string(angle_name(axis)) + "_command",
       margins_of(response, frequencies_to_look_at(eigenvalues_of(open), plain.poles, period),
                  plain.slowest)});
}

// What is left of a where b is taken from it, without what only rounding leaves.
MatrixXd without(const MatrixXd& a, const MatrixXd& b) {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  return a.binaryExpr(
      b, [](double p, double q) { return std::abs(p - q) <= rounding * std::abs(q) ? 0 : p - q; });
}

// Zeros of C (sI - A)^-1 (B0 + s B1 + s^2 B2): those of the system whose states are the
// reference and its rate too, and whose input is its acceleration. (The powers of s could be had by
// multiples of A, whose entries would cancel.)
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

Linearisation continuous_loop_about(const Scenario& scene, const Model& model,
                                    const LinearPoint& at) {
  const std::vector<int> axes = axes_of(model);
  const bool integrates = integrates_error(scene), full = in_full(scene, at);
  const LoopDerivatives loop = full         ? coupled_loop_at(model, at)
                               : integrates ? differentiate_loop<true>(scene, at)
                                            : differentiate_loop<false>(scene, at);
  const PlantDerivatives plant = full ? coupled_plant_at(model, at) : differentiate_rig(scene, at);
  std::vector<int> states =
      full ? coupled_states(model, loop.of_state) : states_of(loop.of_state, axes);
  for (const int axis : axes) {
    // Without an integral part that never changes.
    const int place = (full ? coupled_integral(model) : integral) + axis;
    if (integrates && !loop.of_state.row(place).isZero(0)) states.push_back(place);
  }
  Linearisation made;
  LinearSystem& system = made.system;
  const std::string unit = command_unit(scene);
  system.states = signals_of(full ? coupled_signals(model, unit) : rig_signals(unit), states);
  const std::vector<int> columns = reference_inputs(loop.of_reference, axes, system.inputs);
  system.outputs = signals_of_positions(axes, "");
  system.a = loop.of_state(states, states);
  system.b = loop.of_reference(states, columns);
  system.c = positions_of(std::ssize(axes), std::ssize(states));
  system.d = MatrixXd::Zero(std::ssize(axes), std::ssize(columns));
  made.poles = sorted_eigenvalues(system.a);

  made.zeros = tracking_zeros(system.a, loop.of_reference(states, Eigen::all), system.c, axes);

  MatrixXd of_command = MatrixXd::Zero(loop.of_state.rows(), 2);
  of_command.topRows(plant.of_command.rows()) = plant.of_command;
  const PlainLoop plain = plain_loop(made, slowest_at(scene, at, plant));
  for (const int axis : axes) {
    const VectorXd b = of_command(states, axis);
    const Eigen::RowVectorXd c = loop.command_of_state(axis, states);
    add_margins(made, plain, axis, without(system.a, b * c), b, c);
  }
  add_bandwidths(made, plain, columns, axes);
  return made;
}

// Of the plant's states, in SampledCycle's order: the spin, if it acts, comes last.
std::vector<int> cycle_states(const MatrixXd& of_state) {
  std::vector<int> states{0, 1, 2, 3, 5, 6, 7, 8};
  VectorXd acts = of_state.col(spin_state);
  acts[spin_state] = 0;
  if (!acts.isZero(0)) states.push_back(spin_state);
  return states;
}

template <class Link>
CycleParts cycle_parts_with(const Scenario& scene, const LinearPoint& at,
                            std::vector<int>& states) {
  const auto loop = plant_of<Link>(scene, at);
  const PlantDerivatives plant = differentiate_plant(loop, at);
  states = cycle_states(plant.of_state);
  CycleParts parts;
  parts.a = plant.of_state(states, states);
  parts.b = plant.of_command(states, Eigen::all);
  MatrixXd jump = MatrixXd::Zero(plant_size, 2);
  for (int i = 0; i < 2; ++i) {
    std::array<double, RigLoop<true>::size> kicked = at.state;
    for (int j = 0; j < 2; ++j) (kicked.data() + rate)[j] = i == j ? 1 : 0;
    const auto rates = loop.plane_rates(kicked.data());
    const auto kick = loop.impulse(at.state.data(), rates[0], rates[1]);
    for (int j = 0; j < 3; ++j) jump(2 + j, i) = kick[static_cast<std::size_t>(j)];
    jump(rate + i, i) = 1;
  }
  parts.jump = jump(states, Eigen::all);

  const Rig rig = assemble_rig<false, Link>(scene, {}).rig;
  parts.take_controller(rig, linear_law(rig.sampled->law, feedback_at(rig, at), at.reference));
  if constexpr (!Link::direct) link_controller(parts, loop.link, rig, at);
  return parts;
}

CycleParts cycle_parts_about(const Scenario& scene, const Model& model, const LinearPoint& at,
                             std::vector<int>& states) {
  CycleParts parts = in_full(scene, at)    ? coupled_cycle_at(model, at, states)
                     : has_linkages(scene) ? cycle_parts_with<Linkages>(scene, at, states)
                                           : cycle_parts_with<Direct>(scene, at, states);
  // From sample to sample there is one system only if each looks at a frame of the same age.
  if (common_cycle(parts.sampling, parts.sensor).samples > 1) parts.sensor.period.reset();
  return parts;
}

std::vector<LinearSignal> signals_of_cycle(const Scenario& scene, const Model& model,
                                           const LinearPoint& at, const std::vector<int>& states,
                                           const SampledCycle& cycle) {
  const std::string unit = command_unit(scene);
  std::vector<LinearSignal> signals =
      signals_of(in_full(scene, at) ? coupled_signals(model, unit) : rig_signals(unit), states);
  for (LinearSignal& signal : cycle.memory(unit)) {
    signals.push_back(std::move(signal));
  }
  return signals;
}

Linearisation sampled_loop_about(const Scenario& scene, const Model& model, const LinearPoint& at) {
  const std::vector<int> axes{0, 1};
  std::vector<int> states;
  const SampledCycle cycle(cycle_parts_about(scene, model, at, states));
  const int n = cycle.size();
  const VectorXd none = VectorXd::Zero(n);
  MatrixXd of_reference(n, 6);
  for (int j = 0; j < 6; ++j) {
    SampledCycle::Input input;
    input.reference[j] = 1;
    of_reference.col(j) = cycle.run(none, input).state;
  }
  Linearisation made;
  LinearSystem& system = made.system;
  system.states = signals_of_cycle(scene, model, at, states, cycle);
  const std::vector<int> columns = reference_inputs(of_reference, axes, system.inputs);
  system.outputs = signals_of_positions(axes, "");
  system.a = cycle.map();
  system.b = of_reference(Eigen::all, columns);
  system.c = positions_of(2, n);
  system.d = MatrixXd::Zero(2, std::ssize(columns));
  system.period = scene.controller->sampling->period;
  made.poles = poles_of_period(system.a);
  made.zeros =
      transmission_zeros(system.a, of_reference.leftCols(2), system.c, MatrixXd::Zero(2, 2));
  const PlantDerivatives plant =
      in_full(scene, at) ? coupled_plant_at(model, at) : differentiate_rig(scene, at);
  const PlainLoop plain = plain_loop(made, slowest_at(scene, at, plant));
  for (const int axis : axes) {
    SampledCycle::Input open;
    open.open[axis] = true;
    MatrixXd a(n, n);
    Eigen::RowVectorXd c(n);
    for (int j = 0; j < n; ++j) {
      const SampledCycle::Output out = cycle.run(VectorXd::Unit(n, j), open);
      a.col(j) = out.state;
      c[j] = out.law[axis];
    }
    open.command[axis] = 1;
    add_margins(made, plain, axis, a, cycle.run(none, open).state, c);
  }
  add_bandwidths(made, plain, columns, axes);
  return made;
}

Linearisation sampled_plant_about(const Scenario& scene, const Model& model,
                                  const LinearPoint& at) {
  if (!scene.controller || !scene.controller->sampling) {
    throw InputError(
        "linearize: found --sampled, but the scene has no controller.sampling, which gives the "
        "period and the delays; allowed: --plant or --loop");
  }
  std::vector<int> states;
  const SampledCycle cycle(cycle_parts_about(scene, model, at, states));
  const std::vector<LinearSignal> signals = signals_of_cycle(scene, model, at, states, cycle);
  const int n = cycle.size(), first = cycle.controller_at();
  // What the controller remembers is no part of the plant.
  std::vector<int> kept;
  for (int i = 0; i < n; ++i) {
    if (i < first || i >= first + cycle.controller_size()) kept.push_back(i);
  }
  SampledCycle::Input open;
  open.open[0] = open.open[1] = true;
  MatrixXd a(n, n), c(2, n), b(n, 2);
  for (int j = 0; j < n; ++j) {
    const SampledCycle::Output out = cycle.run(VectorXd::Unit(n, j), open);
    a.col(j) = out.state;
    c.col(j) = out.seen;
  }
  for (int j = 0; j < 2; ++j) {
    SampledCycle::Input input = open;
    input.command[j] = 1;
    b.col(j) = cycle.run(VectorXd::Zero(n), input).state;
  }
  Linearisation made;
  LinearSystem& system = made.system;
  for (const int i : kept) system.states.push_back(signals[static_cast<std::size_t>(i)]);
  system.inputs = signals_of_commands(scene, {0, 1});
  system.outputs = signals_of_positions({0, 1}, "_measured");
  system.a = a(kept, kept);
  system.b = b(kept, Eigen::all);
  system.c = c(Eigen::all, kept);
  system.d = MatrixXd::Zero(2, 2);
  system.period = scene.controller->sampling->period;
  made.poles = poles_of_period(system.a);
  made.zeros = transmission_zeros(system.a, system.b, system.c, system.d);
  return made;
}

// The command under which the servos rest at their angles.
Pair resting_command(const Scenario& scene, const LinearPoint& at) {
  if (!scene.controller || scene.controller->drives == Drives::acceleration) return {0, 0};
  return {at.state[angle], at.state[angle + 1]};
}

// Turns the gimbal to where the plane is level.
void turn_level(const Scenario& scene, LinearPoint& point) {
  const bool by_angle = scene.controller && scene.controller->drives == Drives::angle;
  for (int i = 0; i < 50; ++i) {
    point.command = resting_command(scene, point);
    const PlantDerivatives at = differentiate_rig(scene, point);
    const Eigen::Vector2d fall = at.rates.segment<2>(2);
    if (fall.norm() <= 1e-15 * scene.gravity) return;
    Eigen::Matrix2d slope = at.of_state.block<2, 2>(2, angle);
    if (by_angle) slope += at.of_command.middleRows<2>(2);
    const Eigen::Vector2d change = solve_consistent(slope, -fall);
    if (!change.allFinite()) break;
    point.state[angle] += change[0];
    point.state[angle + 1] += change[1];
    // Newton's last step: what it leaves is rounding.
    if (change.norm() < 1e-9) {
      point.command = resting_command(scene, point);
      return;
    }
  }
  throw InputError("linearize: there is no equilibrium: no angles of this gimbal level its plate");
}

// Where the law's command is the one under which the gimbal rests: position, and integrals.
void place_ball(const Rig& rig, const ControlLaw& law, LinearPoint& point) {
  // The law's own command for that, where a linkage is between.
  Pair asked = point.command;
  if (!rig.between.linkages.empty()) {
    const double none[2] = {0, 0};
    double known[4];
    rig.between.believed(point.command.data(), none, known);
    asked = {known[0], known[1]};
  }
  Eigen::Matrix2d seen = Eigen::Matrix2d::Identity();
  if (rig.sampled) seen = seen_matrix(rig.sampled->sensor);

  std::vector<int> unknowns{0, 1};
  std::vector<int> integrated;
  for (int i = 0; i < 2; ++i) {
    if (!law.integrates(static_cast<std::size_t>(i))) continue;
    unknowns.push_back(8 + i);
    integrated.push_back(i);
  }
  const Eigen::Index n = std::ssize(unknowns);
  for (int i = 0; i < 50; ++i) {
    Feedback<double> fed = feedback_at(rig, point);
    for (int j = 0; j < 2; ++j) fed.velocity[j] = fed.rate[j] = 0;
    const auto plain = [](int, double raw) { return raw; };
    const Command<double> u = command(law, fed, point.reference, plain);
    const LinearLaw linear = linear_law(law, fed, point.reference);
    VectorXd left = VectorXd::Zero(n);
    MatrixXd slope = MatrixXd::Zero(n, n);
    for (int j = 0; j < 2; ++j) left[j] = u.value[j] - asked[static_cast<std::size_t>(j)];
    slope.topRows(2) = linear.of_feedback(Eigen::all, unknowns);
    slope.topLeftCorner(2, 2) = (slope.topLeftCorner(2, 2) * seen).eval();
    for (std::size_t k = 0; k < integrated.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(2 + k);
      const double(&gain)[2] = law.integral[integrated[k]];
      left[row] = -integral_rate(law, static_cast<std::size_t>(integrated[k]), fed.position,
                                 point.reference);
      slope.row(row).head<2>() = gain[0] * seen.row(0) + gain[1] * seen.row(1);
    }
    const auto solved = solve_if_regular(slope, -left);
    if (!solved) break;
    const VectorXd change = *solved;
    for (Eigen::Index k = 0; k < n; ++k) {
      const int place = unknowns[static_cast<std::size_t>(k)];
      point.state[static_cast<std::size_t>(place < 8 ? place : integral + place - 8)] += change[k];
    }
    if (change.norm() <= 1e-12 * (1 + left.norm())) return;
  }
  throw InputError(
      "linearize: there is no equilibrium: the law's command keeps the plate level at no single "
      "position");
}

void require_linear(const Scenario& scene) {
  const std::string why = why_not_linear(scene);
  if (!why.empty()) throw InputError("linearize: " + why);
}

}  // namespace

std::string why_not_linear(const Scenario& scene) {
  const auto dry = [](const std::string& what) {
    return "found " + what +
           ", which is dry: it depends on the direction of motion and holds at rest, so no linear "
           "equations approximate it; allowed: ";
  };
  const Losses& losses = scene.ball.losses;
  const char* const viscous = "ball.losses.viscous alone";
  if (losses.rolling > 0) return dry("ball.losses.rolling") + viscous;
  if (losses.pivoting > 0) return dry("ball.losses.pivoting") + viscous;
  if (scene.events.slip && scene.events.slip->sliding) {
    return dry("events.slip with action: slide") + "stop or note, with which the ball rolls";
  }
  if (scenario::moved_by_torques(scene) && scene.gimbal.motor && scene.gimbal.motor->friction > 0) {
    return dry("gimbal.motor.friction") + "gimbal.motor.viscous alone";
  }
  return "";
}

LinearPoint home_point() {
  LinearPoint point;
  point.home = true;
  return point;
}

LinearPoint equilibrium(const Scenario& scene) {
  require_linear(scene);
  LinearPoint point;
  if (in_full(scene, point)) return coupled_equilibrium(scene, assemble(scene, false));
  Pair position = scene.ball.position;
  if (scene.controller) {
    const auto path = reference_path(scene.controller->reference).at(0.0);
    for (std::size_t i = 0; i < 2; ++i) position[i] = point.reference[i].value = path[i].value;
  }
  std::copy(position.begin(), position.end(), point.state.begin());
  turn_level(scene, point);
  if (!scene.controller || scene.controller->own ||
      scene.controller->law == Law::feedback_linearisation) {
    return point;
  }
  const AssembledRig<false> built = assemble_rig<false>(scene, {});
  const ControlLaw& law = built.rig.sampled ? built.rig.sampled->law : built.loop.law();
  place_ball(built.rig, law, point);
  double asked[4] = {point.command[0], point.command[1], 0, 0};
  if (!built.rig.between.linkages.empty()) {
    const double none[2] = {0, 0};
    built.rig.between.believed(point.command.data(), none, asked);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const double limit = command_limit(*scene.controller, i).value_or(unlimited);
    if (std::abs(asked[i]) > limit) {
      throw InputError(
          "linearize: there is no equilibrium: the command that keeps the plate level is beyond "
          "controller.limit");
    }
  }
  return point;
}

LinearKind usual_kind(const Scenario& scene) {
  if (!scene.controller) return LinearKind::plant;
  return scene.controller->own ? LinearKind::sampled : LinearKind::loop;
}

namespace {

Linearisation linearise_as(const Scenario& scene, const Model& model, LinearKind kind,
                           const LinearPoint& at) {
  switch (kind) {
    case LinearKind::plant:
      break;
    case LinearKind::sampled:
      return sampled_plant_about(scene, model, at);
    case LinearKind::loop:
      if (!scene.controller) {
        throw InputError(
            "linearize: found --loop, but the scene has no controller; allowed: --plant");
      }
      if (scene.controller->own) {
        throw InputError(
            "linearize: found --loop with your own controller, whose law bbsim does not know; "
            "allowed: --plant, --sampled");
      }
      return scene.controller->sampling ? sampled_loop_about(scene, model, at)
                                        : continuous_loop_about(scene, model, at);
  }
  return plant_about(scene, model, at);
}

// -0 is what symmetry makes of 0.
MatrixXd with_plain_zeros(const MatrixXd& matrix) {
  return matrix.unaryExpr([](double value) { return value == 0 ? 0.0 : value; });
}

void make_zeros_plain(Eigenvalues& values) {
  for (auto& value : values) {
    if (value.real() == 0) value.real(0);
    if (value.imag() == 0) value.imag(0);
  }
}

}  // namespace

Linearisation linearise(const Scenario& scene, const Model& model, LinearKind kind,
                        const LinearPoint& at) {
  require_linear(scene);
  Linearisation made = linearise_as(scene, model, kind, at);
  LinearSystem& system = made.system;
  for (MatrixXd* matrix : {&system.a, &system.b, &system.c, &system.d}) {
    *matrix = with_plain_zeros(*matrix);
  }
  make_zeros_plain(made.poles);
  make_zeros_plain(made.zeros);
  return made;
}

}  // namespace bbsim::model
