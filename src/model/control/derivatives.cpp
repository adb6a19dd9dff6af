// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/derivatives.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/error.hpp"
#include "model/assemble.hpp"
#include "model/control/sampled_controller.hpp"
#include "model/dense.hpp"
#include "model/signals/signal_pair.hpp"
#include "scenario/coupled.hpp"
#include "simd/gradient.hpp"

namespace bbsim::model {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// A number with derivatives by a loop's states and six more variables. Smaller loops use it too:
// right-hand sides with another number type would take compilers ten seconds.
constexpr int most_states = 19;
using Varied = simd::WithGradient<most_states + 6>;

// The gimbal's part of a loop: its law, its servos and its linkage.
template <class Loop>
auto& gimbal_of(Loop& loop) {
  return *rig_loop_of(loop);
}
template <class Loop>
using LinkOf = std::decay_t<decltype(gimbal_of(std::declval<Loop&>()).link)>;

// Offsets a linkage so that the plane is level at home, where a servo's own angle may not be 0.
Linkages levelled(Linkages link) {
  for (LinkCurve& curve : link.of) {
    const Turn<double> home = curve.plain_turn(0.0);
    curve.set_offsets(0, std::atan2(home.sin, home.cos));
  }
  return link;
}

// Linkages at home, with the pieces of measured curves that hold at a point.
Linkages linkages_at(const Mechanism& mechanism, const LinearPoint& at) {
  Linkages link = mechanism.at_home();
  for (std::size_t i = 0; i < mechanism.linkages.size(); ++i) {
    const Linkage& linkage = mechanism.linkages[i];
    if (!linkage.table) continue;
    const auto piece = [&](double servo) {
      return linkage.table->view().pieces[linkage.piece_at(0, servo, 1)];
    };
    link.of[i].piece = piece(at.state[RigLayout::angle + i]);
    link.of[i].command_piece = piece(at.command[i]);
  }
  return link;
}

// The loop with motors and servos within their limits and a rolling ball; level if at home.
template <class Loop>
Loop placed(Loop loop, const Model& model, const LinearPoint& at) {
  if constexpr (is_coupled_loop<Loop>) {
    loop.parts.contact = {};
    for (MotorMode& motor : loop.motors) motor = {};
  }
  auto& gimbal = gimbal_of(loop);
  if (at.home) gimbal.mode = {};
  if constexpr (std::is_same_v<LinkOf<Loop>, Linkages>) {
    if (model.rig && !model.rig->mechanism.none())
      gimbal.link = linkages_at(model.rig->mechanism, at);
    if (at.home) gimbal.link = levelled(gimbal.link);
  }
  if constexpr (std::is_same_v<LinkOf<Loop>, ThreeServos>) {
    for (int i = 0; i < 2 && at.home; ++i) gimbal.link.set_offset(i, 0);
    for (ThreeServos::Leg& leg : gimbal.link.leg) {
      if (!at.home || std::atan2(leg.sin_zero, leg.cos_zero) == leg.home) continue;
      leg.cos_zero = std::cos(leg.home);
      leg.sin_zero = std::sin(leg.home);
    }
  }
  return loop;
}

// Converts each system to a loop with all states and integrals.
template <bool integrates>
RigLoop<true> whole_loop(const RigLoop<integrates>& of) {
  return {of.radius(), of.gravity(),   of.rolling(), of.law(),
          of.servo(),  of.reference(), of.mode,      of.link};
}

template <Shape shape, class Equation>
RigLoop<true> whole_loop(const OpenLoop<shape, SignalPair, Equation>& of) {
  GeneralRolling rolling;
  if constexpr (std::is_same_v<Equation, GeneralRolling>) rolling = of.equation();
  return {of.radius(), of.gravity(), rolling, {}, {}, {}};
}

template <Shape shape, Drives drives>
RigLoop<true> whole_loop(const ClosedLoop<shape, drives>& of) {
  ControlLaw law;
  law.kind = LawKind::linear;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      law.gain[i][j] = of.gains().kp[i][j];
      law.gain[i][2 + j] = of.gains().kv[i][j];
    }
  }
  ServoResponse servo;
  if constexpr (drives == Drives::angle) {
    const double w = of.servo().omega_n;
    servo = {w * w, w * w, 2 * of.servo().zeta * w};
  }
  return {of.radius(), of.gravity(), {}, law, servo, of.reference()};
}

// Calls use(loop) with the model as a loop about a point.
template <class Use>
auto with_loop_at(const Model& model, const LinearPoint& at, Heave heave, const Use& use) {
  return std::visit(
      [&](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (std::is_same_v<Any, CoupledLoop<SignalPair, ThreeServos>>) {
          if (heave == Heave::kept) return use(placed(any, model, at));
          const auto& rig = any.loop;
          const CoupledLoop<> two(
              any.parts, any.by, any.motor,
              {rig.radius(), rig.gravity(), rig.rolling(), rig.law(), rig.servo(), {}});
          return use(placed(two, model, at));
        } else if constexpr (is_coupled_loop<Any>) {
          return use(placed(any, model, at));
        } else if constexpr (is_coupled<Any>) {
          const CoupledBall& ball = any.parts.ball;
          Push<SignalPair> push;
          if constexpr (requires { any.push.on; }) push.on = any.push.on;
          // The plane's angles include its offsets.
          const CoupledLoop<SignalPair, Linkages> loop(
              any.parts, GimbalBy::servos, {}, {ball.r, ball.g, ball.rolling, {}, {}, {}}, push);
          return use(placed(loop, model, at));
        } else {
          return use(placed(whole_loop(any), model, at));
        }
      },
      model.system);
}

// The same loop with another law and other servos. Motors then move a gimbal under given torques.
template <class Loop>
Loop under(const Loop& of, const ControlLaw& law, const ServoResponses& servo,
           const LinkOf<Loop>& link) {
  const auto& gimbal = gimbal_of(of);
  std::decay_t<decltype(gimbal)> under_law(gimbal.radius(), gimbal.gravity(), gimbal.rolling(), law,
                                           servo, {}, gimbal.mode, link);
  if constexpr (is_coupled_loop<Loop>) {
    const GimbalBy by = of.by == GimbalBy::given_torques ? GimbalBy::torques : of.by;
    Loop loop(of.parts, by, of.motor, under_law, of.push);
    loop.integrate_error(law.integrates());
    return loop;
  } else {
    return under_law;
  }
}

// The plant: a loop whose law commands its integral parts, which thus become the input. Commands to
// linkages are servo angles.
template <class Loop>
Loop without_law(const Loop& loop) {
  ControlLaw law;
  law.kind = LawKind::linear;
  law.integral[0][0] = law.integral[1][1] = 1;
  const auto& gimbal = gimbal_of(loop);
  LinkOf<Loop> link = gimbal.link;
  if constexpr (std::is_same_v<LinkOf<Loop>, Linkages>) {
    for (LinkCurve& curve : link.of) curve.assumed = Assumed::none;
  }
  return under(loop, law, gimbal.servo(), link);
}

template <class Loop>
VectorXd states_at(const LinearPoint& at) {
  VectorXd z = VectorXd::Zero(Loop::size);
  std::copy_n(at.state.begin(), std::min<std::size_t>(at.state.size(), Loop::size), z.begin());
  return z;
}

template <class Loop>
void vary_states(const LinearPoint& at, Varied (&z)[Loop::size]) {
  static_assert(Loop::size <= most_states);
  const VectorXd values = states_at<Loop>(at);
  for (int i = 0; i < Loop::size; ++i) z[i] = Varied::variable(values[i], i);
}

// Makes values, rates and accelerations of a reference variables from number `first` on.
std::array<Jet<Varied>, 2> varied(const std::array<Jet<double>, 2>& reference, int first) {
  std::array<Jet<Varied>, 2> jets;
  for (std::size_t i = 0; i < 2; ++i) {
    const int number = first + static_cast<int>(i);
    jets[i] = {Varied::variable(reference[i].value, number),
               Varied::variable(reference[i].rate, number + 2),
               Varied::variable(reference[i].acceleration, number + 4)};
  }
  return jets;
}

// Rates under a reference, with the push at that time.
template <class Loop, class Number>
void rates_under(const Loop& loop, const std::array<Jet<Number>, 2>& reference, double time,
                 const Number* z, Number* dz) {
  if constexpr (requires { loop.push.on; }) {
    const auto push = loop.push.on.at(time);
    const PushedInputs<Number> in{reference, {Number(push[0].value), Number(push[1].value)}};
    loop.derivative_of(in, z, dz);
  } else {
    loop.derivative_of(reference, z, dz);
  }
}

template <class Loop>
StatePlaces places_of(const Loop& loop) {
  StatePlaces places{Loop::servos, Loop::Layout::integral, 0, false};
  if constexpr (is_coupled_loop<Loop>) {
    places.motor = Loop::Layout::motor;
    places.motor_integrates = loop.motor.from_integral != 0;
  }
  return places;
}

// The rates, and their derivatives by states and commands.
template <class Loop>
PlantDerivatives differentiate_plant(const Loop& loop, const LinearPoint& at) {
  constexpr int n = Loop::size;
  Varied z[n], dz[n];
  vary_states<Loop>(at, z);
  for (int i = 0; i < 2; ++i) {
    const double command = at.command[static_cast<std::size_t>(i)];
    z[Loop::Layout::integral + i] = Varied::variable(command, n + i);
  }
  rates_under(without_law(loop), std::array<Jet<Varied>, 2>{}, at.time, z, dz);
  PlantDerivatives plant;
  plant.places = places_of(loop);
  plant.state = states_at<Loop>(at);
  plant.rates = simd::values(dz);
  plant.of_state = simd::gradients(dz, 0, n);
  plant.of_command = simd::gradients(dz, n, 2);
  return plant;
}

template <class Loop>
LoopDerivatives differentiate_loop(const Loop& loop, const LinearPoint& at) {
  constexpr int n = Loop::size;
  Varied z[n], dz[n];
  vary_states<Loop>(at, z);
  const auto reference = varied(at.reference, n);
  rates_under(loop, reference, at.time, z, dz);
  const auto& gimbal = gimbal_of(loop);
  const auto axes = gimbal.axes(reference, z);
  const Varied commands[2] = {gimbal.shown(axes, 0), gimbal.shown(axes, 1)};
  return {places_of(loop), simd::gradients(dz, 0, n), simd::gradients(dz, n, 6),
          simd::gradients(commands, 0, n)};
}

template <class Loop>
MatrixXd kick_of(const Loop& loop, const VectorXd& z) {
  constexpr int servos = Loop::servos, rate = Loop::Layout::rate;
  const auto& gimbal = gimbal_of(loop);
  MatrixXd kick = MatrixXd::Zero(Loop::size, servos);
  for (int i = 0; i < servos; ++i) {
    VectorXd kicked = z;
    kicked.segment<servos>(rate) = Eigen::Matrix<double, servos, 1>::Unit(i);
    const RigExtras plane = gimbal.plane(kicked.data());
    const auto jump = gimbal.impulse(z.data(), plane.rate[0], plane.rate[1]);
    for (int j = 0; j < 3; ++j) kick(2 + j, i) = jump[static_cast<std::size_t>(j)];
    kick(rate + i, i) = 1;
  }
  return kick;
}

// Derivatives of what the controller knows of the servos and of what it tells them.
template <class Loop>
void differentiate_link(const Loop& loop, const LinearPoint& at, PlantDerivatives& plant) {
  constexpr int servos = Loop::servos, angle = Loop::Layout::angle, n = Loop::size;
  auto link = gimbal_of(loop).link;
  Varied z[n], known[2], known_rate[2];
  vary_states<Loop>(at, z);
  link.believed(z + angle, z + Loop::Layout::rate, known, known_rate);
  plant.believed.resize(4, n);
  plant.believed << simd::gradients(known, 0, n), simd::gradients(known_rate, 0, n);

  const Varied command[2] = {Varied::variable(at.command[0], 0),
                             Varied::variable(at.command[1], 1)};
  if constexpr (servos == 2) {
    // The command is in servo angles, so invert the map from these to the plane's angles.
    for (LinkCurve& curve : link.of) curve.piece = curve.command_piece;
    const Varied resting[2];
    link.believed(command, resting, known, known_rate);
    plant.servo_commands = inverse(simd::gradients(known, 0, 2));
  } else {
    Varied commands[servos];
    link.commands_for(command, commands);
    plant.servo_commands = simd::gradients(commands, 0, 2);
  }
}

// The feedback at a point, as the controller knows it.
Feedback<double> feedback_at(const Rig& rig, const StatePlaces& places, const LinearPoint& at,
                             const VectorXd& z) {
  Feedback<double> fed{};
  const int angle = spin_state + 1, rate = angle + places.servos;
  for (int i = 0; i < 2; ++i) {
    fed.position[i] = z[i];
    fed.velocity[i] = z[2 + i];
    fed.angle[i] = z[angle + i];
    fed.rate[i] = z[rate + i];
    fed.integral[i] = z[places.integral + i];
  }
  if (rig.sampled && !rig.sampled->sensor.is_aligned()) {
    const Sensor& sensor = rig.sampled->sensor;
    const auto position = turned(sensor, z[0], z[1]), velocity = turned(sensor, z[2], z[3]);
    for (std::size_t i = 0; i < 2; ++i) {
      fed.position[i] = position[i] + sensor.offset[i];
      fed.velocity[i] = velocity[i];
    }
  }
  if (!at.home && !rig.mechanism.none()) {
    double known[4];
    rig.mechanism.believed(&z[angle], &z[rate], known);
    std::copy_n(known, 2, fed.angle);
    std::copy_n(known + 2, 2, fed.rate);
  }
  return fed;
}

}  // namespace

LinearPoint home_point() {
  LinearPoint point;
  point.home = true;
  return point;
}

PlantDerivatives plant_derivatives(const Model& model, const LinearPoint& at, Heave heave) {
  return with_loop_at(model, at, heave, [&](const auto& loop) {
    using Loop = std::decay_t<decltype(loop)>;
    PlantDerivatives plant = differentiate_plant(loop, at);
    plant.kick = kick_of(loop, plant.state);
    if (!model.rig) return plant;
    plant.fed = feedback_at(*model.rig, plant.places, at, plant.state);
    if constexpr (!LinkOf<Loop>::direct) {
      if (!model.rig->mechanism.none()) differentiate_link(loop, at, plant);
    }
    return plant;
  });
}

LoopDerivatives loop_derivatives(const Model& model, const LinearPoint& at, Heave heave) {
  return with_loop_at(model, at, heave,
                      [&](const auto& loop) { return differentiate_loop(loop, at); });
}

LawDerivatives law_derivatives(const ControlLaw& law, const Feedback<double>& at,
                               const std::array<Jet<double>, 2>& reference) {
  LawDerivatives derivatives;
  if (law.kind == LawKind::held) return derivatives;
  int next = 0;
  const auto variables = [&next](const double(&values)[2], Varied(&into)[2]) {
    for (int i = 0; i < 2; ++i) into[i] = Varied::variable(values[i], next++);
  };
  Feedback<Varied> state;
  variables(at.position, state.position);
  variables(at.velocity, state.velocity);
  variables(at.angle, state.angle);
  variables(at.rate, state.rate);
  variables(at.integral, state.integral);
  const auto unlimited_command = [](int, const Varied& raw) { return raw; };
  const Command<Varied> u = command(law, state, varied(reference, next), unlimited_command);
  derivatives.of_feedback = simd::gradients(u.value, 0, 10);
  derivatives.of_reference = simd::gradients(u.value, 10, 6);
  return derivatives;
}

std::vector<int> linear_states(const StatePlaces& places, const MatrixXd& of_state,
                               const std::vector<int>& axes, SpinStands spin) {
  std::vector<int> states;
  for (const int first : {0, 2}) {
    for (const int axis : axes) states.push_back(first + axis);
  }
  const auto after_velocities = std::ssize(states);
  const std::vector<int> three{0, 1, 2};
  for (const int first : {spin_state + 1, spin_state + 1 + places.servos}) {
    for (const int servo : places.servos == 3 ? three : axes) states.push_back(first + servo);
  }
  if (places.motor_integrates) states.insert(states.end(), {places.motor, places.motor + 1});
  // The spin may act on an axis that symmetry leaves out.
  const VectorXd acts = of_state.col(spin_state).head(places.integral);
  if ((acts.array() != 0).count() > (acts[spin_state] != 0 ? 1 : 0)) {
    states.insert(spin == SpinStands::last ? states.end() : states.begin() + after_velocities,
                  spin_state);
  }
  return states;
}

std::vector<int> loop_states(const LoopDerivatives& loop, const std::vector<int>& axes) {
  std::vector<int> states =
      linear_states(loop.places, loop.of_state, axes, SpinStands::after_velocities);
  for (const int axis : axes) {
    const int place = loop.places.integral + axis;
    if (!loop.of_state.row(place).isZero(0)) states.push_back(place);
  }
  return states;
}

std::vector<int> moving_axes(const Model& model) {
  const Shape moves = std::visit(
      [](const auto& system) { return std::decay_t<decltype(system)>::moves; }, model.system);
  if (moves == Shape::along_x) return {0};
  if (moves == Shape::along_y) return {1};
  return {0, 1};
}

std::vector<LinearSignal> signals_of(const std::vector<LinearSignal>& all,
                                     const std::vector<int>& indices) {
  std::vector<LinearSignal> signals;
  for (const int i : indices) signals.push_back(all[static_cast<std::size_t>(i)]);
  return signals;
}

std::vector<LinearSignal> state_signals(const StatePlaces& places, const std::string& command_unit,
                                        const std::vector<int>& states) {
  std::vector<LinearSignal> signals{
      {"x", "m"}, {"y", "m"}, {"vx", "m/s"}, {"vy", "m/s"}, {spin_name, "m/s"}};
  const char* const three[] = {"servo_phi", "servo_theta", "servo_third"};
  const char* const two[] = {"phi", "theta"};
  for (const bool rates : {false, true}) {
    for (int i = 0; i < places.servos; ++i) {
      const std::string name = places.servos == 3 ? three[i] : two[i];
      signals.push_back({name + (rates ? "_rate" : ""), rates ? "rad/s" : "rad"});
    }
  }
  for (const char* name : {"phi_command_integral", "theta_command_integral"}) {
    signals.push_back({name, command_unit});
  }
  for (const char* name : {"phi_integral", "theta_integral"}) signals.push_back({name, "rad s"});
  return signals_of(signals, states);
}

namespace {

template <class Loop>
LinearPlant at_home(const Loop& loop) {
  const PlantDerivatives plant = differentiate_plant(loop, home_point());
  // At rest, the spin acts on nothing.
  const std::vector<int> states =
      linear_states(plant.places, plant.of_state, {0, 1}, SpinStands::last);
  return {plant.of_state(states, states), plant.of_command(states, Eigen::all)};
}

}  // namespace

LinearPlant plant_at_home(const RigLoop<true>& loop) {
  return at_home(loop);
}

LinearPlant plant_at_home(const CoupledLoop<>& loop) {
  return at_home(loop);
}

Eigen::Matrix2d seen_matrix(const Sensor& sensor) {
  const auto x = turned(sensor, 1.0, 0.0), y = turned(sensor, 0.0, 1.0);
  Eigen::Matrix2d matrix;
  matrix << x[0], y[0], x[1], y[1];
  return matrix;
}

namespace {

// The unknowns of an equilibrium, and the rates that must vanish there.
struct Rest {
  std::vector<int> states;     // unknown states of a loop
  std::vector<int> vanishing;  // rates
  bool commands = false;       // unknown too, if no law gives them
};

// Without a sideways pull on the ball, all angles are in equilibrium and stay.
Rest rest_of(const StatePlaces& places, const ControlLaw& law, bool has_law, bool angles_stay) {
  Rest rest;
  if (has_law) rest.states = {0, 1};
  if (!angles_stay) rest.vanishing = {2, 3};
  for (int i = 0; i < places.servos; ++i) {
    if (!angles_stay) rest.states.push_back(spin_state + 1 + i);
    rest.vanishing.push_back(spin_state + 1 + places.servos + i);
  }
  rest.commands = !has_law;
  const auto both = [&](int place) {
    rest.states.push_back(place);
    rest.vanishing.push_back(place);
  };
  for (int j = 0; j < 2 && has_law; ++j) {
    if (law.integrates(static_cast<std::size_t>(j))) both(places.integral + j);
  }
  for (int j = 0; j < 2 && places.motor_integrates; ++j) both(places.motor + j);
  return rest;
}

// Laws need reference - seen, but compute reference - position. Shifts the reference by the
// difference, if there is a sensor.
template <class Number>
void see_by(const Sensor* sensor, const Number* z, std::array<Jet<Number>, 2>& reference) {
  if (sensor == nullptr || sensor->is_aligned()) return;
  const auto seen = turned(*sensor, z[0], z[1]);
  for (std::size_t i = 0; i < 2; ++i) {
    reference[i].value = reference[i].value + z[i] - seen[i] - sensor->offset[i];
  }
}

// Rates of a loop whose controller uses its sensor, and their derivatives by states.
template <class Loop>
PlantDerivatives differentiate_seen(const Loop& loop, const Sensor* sensor, const LinearPoint& at) {
  constexpr int n = Loop::size;
  Varied z[n], dz[n];
  vary_states<Loop>(at, z);
  std::array<Jet<Varied>, 2> reference;
  for (std::size_t i = 0; i < 2; ++i) reference[i] = {at.reference[i].value, 0.0, 0.0};
  see_by(sensor, z, reference);
  rates_under(loop, reference, at.time, z, dz);
  PlantDerivatives seen;
  seen.rates = simd::values(dz);
  seen.of_state = simd::gradients(dz, 0, n);
  return seen;
}

// The law's commands at a point: to the servos or the plane, and before the linkage.
template <class Loop>
std::pair<Pair, Pair> commands_at(const Loop& loop, const Sensor* sensor, const LinearPoint& at) {
  const VectorXd z = states_at<Loop>(at);
  std::array<Jet<double>, 2> reference = at.reference;
  see_by(sensor, z.data(), reference);
  const auto& gimbal = gimbal_of(loop);
  const auto axes = gimbal.axes(reference, z.data());
  return {{gimbal.shown(axes, 0), gimbal.shown(axes, 1)},
          {axes.command.value[0], axes.command.value[1]}};
}

}  // namespace

std::string why_not_linear(const Scenario& scene) {
  const char* const dry = scenario::dry_part(scene);
  if (dry == nullptr) return "";
  const std::string_view part = dry;
  const char* const instead = part.starts_with("events") ? "stop or note, with which the ball rolls"
                              : part.starts_with("gimbal") ? "gimbal.motor.viscous alone"
                                                           : "ball.losses.viscous alone";
  return "found " + std::string(part) +
         ", which is dry: it depends on the direction of motion and holds at rest, so no linear "
         "equations approximate it; allowed: " +
         instead;
}

void require_linear(const Scenario& scene) {
  const std::string why = why_not_linear(scene);
  if (!why.empty()) throw InputError("linearize: " + why);
}

namespace {

// With torques or three servos, the plate's equilibrium depends on where the ball is.
bool is_plain(const Scenario& scene) {
  return !scenario::is_coupled(scene) && !scene.gimbal.three_servos;
}

class EquilibriumSearch {
  template <class Use>
  auto with_loop(const Use& use) const {
    return with_loop_at(model_, point_, Heave::kept, use);
  }
  template <class Use>
  auto with_law(const Use& use) const {
    return with_loop(
        [&](const auto& loop) { return use(under(loop, law_, at_rest_, gimbal_of(loop).link)); });
  }

 public:
  EquilibriumSearch(const Scenario& scene, const Model& model) : model_(model) {
    Pair position = scene.ball.position;
    if (scene.controller && commands_of(scene) == nullptr) {
      const auto path = reference_path(scene.controller->reference, 0).at(0.0);
      for (std::size_t i = 0; i < 2; ++i) position[i] = point_.reference[i].value = path[i].value;
    }
    with_loop([&](const auto& loop) {
      law_ = gimbal_of(loop).law();
      places_ = places_of(loop);
      point_.state.assign(std::decay_t<decltype(loop)>::size, 0);
    });
    std::ranges::copy(position, point_.state.begin());
    if (model.rig && model.rig->sampled) {
      law_ = model.rig->sampled->law;
      sensor_ = &model.rig->sampled->sensor;
    }
    if (scene.gimbal.servo) {
      with_loop([&](const auto& loop) { at_rest_ = gimbal_of(loop).servo(); });
      for (ServoResponse& servo : at_rest_.of) servo = servo.at_rest();
    }
    angles_stay_ = scene.gravity == 0 && is_plain(scene);
    follows_ = scene.controller && scene.controller->drives == Drives::angle &&
               !scenario::moved_by_torques(scene) && places_.servos == 2;
  }

  // Returns nothing if there is no such point, or more than one.
  [[nodiscard]] std::optional<LinearPoint> find(bool under_law) {
    const Rest rest = rest_of(places_, law_, under_law, angles_stay_);
    const auto of_states = std::ssize(rest.states);
    for (int pass = 0; pass < 50; ++pass) {
      if (under_law) point_.command = commands().first;
      const PlantDerivatives now = derivatives(under_law);
      MatrixXd slope(std::ssize(rest.vanishing), of_states + (rest.commands ? 2 : 0));
      slope.leftCols(of_states) = now.of_state(rest.vanishing, rest.states);
      if (rest.commands) slope.rightCols(2) = now.of_command(rest.vanishing, Eigen::all);
      const auto solved = solve_if_regular(slope, -now.rates(rest.vanishing));
      if (!solved) return {};
      const VectorXd change = *solved;
      double size = 0;
      for (Eigen::Index k = 0; k < of_states; ++k) {
        point_.state[static_cast<std::size_t>(rest.states[static_cast<std::size_t>(k)])] +=
            change[k];
      }
      for (int k = 0; k < 2 && rest.commands; ++k) {
        point_.command[static_cast<std::size_t>(k)] += change[of_states + k];
      }
      for (const double value : point_.state) size = std::hypot(size, value);
      // After this step of Newton's method only rounding is left.
      if (change.norm() > 1e-9 * (1 + size)) continue;
      if (under_law) point_.command = commands().first;
      // Equal bit for bit, so that rounding turns no servo.
      if (follows_) std::copy_n(&point_.state[RigLayout::angle], 2, point_.command.begin());
      return point_;
    }
    return {};
  }

  [[nodiscard]] bool has_law() const {
    return feeds_back(law_.kind) && law_.kind != LawKind::feedback_linearisation;
  }

  // To the servos or the plane, and as the law computes them.
  [[nodiscard]] std::pair<Pair, Pair> commands() const {
    return with_law([&](const auto& loop) { return commands_at(loop, sensor_, point_); });
  }

 private:
  [[nodiscard]] PlantDerivatives derivatives(bool under_law) const {
    return with_law([&](const auto& loop) {
      return under_law ? differentiate_seen(loop, sensor_, point_)
                       : differentiate_plant(loop, point_);
    });
  }

  const Model& model_;
  LinearPoint point_;
  ControlLaw law_;
  StatePlaces places_{};
  const Sensor* sensor_ = nullptr;
  ServoResponses at_rest_;
  bool angles_stay_ = false;
  bool follows_ = false;  // servos rest at their commands
};

[[noreturn]] void throw_no_equilibrium(const std::string& why) {
  throw InputError("linearize: there is no equilibrium: " + why);
}

}  // namespace

LinearPoint equilibrium(const Scenario& scene) {
  require_linear(scene);
  const Model model = assemble(scene, false);
  EquilibriumSearch search(scene, model);
  const bool has_law = search.has_law();
  const auto point = search.find(has_law);
  if (!point) {
    if (!is_plain(scene)) {
      throw_no_equilibrium(
          "at no single position does everything rest, whatever the angles and commands of this "
          "gimbal");
    }
    if (has_law && EquilibriumSearch(scene, model).find(false)) {
      throw_no_equilibrium("at no single position does the law's command keep the plate level");
    }
    throw_no_equilibrium("no angles of this gimbal level its plate");
  }
  if (!has_law) return *point;
  const Pair asked = search.commands().second;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (std::abs(asked[axis]) <= command_limit(*scene.controller, axis).value_or(unlimited)) {
      continue;
    }
    throw_no_equilibrium(std::string("the command that keeps ") +
                         (is_plain(scene) ? "the plate level" : "the ball at its reference") +
                         " is beyond controller.limit");
  }
  return *point;
}

}  // namespace bbsim::model
