// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "base/error.hpp"
#include "model/assemble_rig.hpp"
#include "model/control/linear_law.hpp"
#include "model/control/linear_parts.hpp"
#include "model/dense.hpp"
#include "model/signals/reference_path.hpp"
#include "simd/gradient.hpp"

namespace bbsim::model {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

template <class Loop>
using LinkOf = std::decay_t<decltype(std::declval<Loop>().loop.link)>;

// A loop of motors and servos that are within their limits, of a ball that rolls; level at home.
template <class Loop>
Loop placed(Loop loop, const Model& model, const LinearPoint& at) {
  loop.parts.contact = {};
  for (MotorMode& motor : loop.motors) motor = {};
  if (at.home) loop.loop.mode = {};
  auto& link = loop.loop.link;
  if constexpr (std::is_same_v<LinkOf<Loop>, Linkages>) {
    if (model.rig && !model.rig->between.none()) {
      link = linkages_at(model.rig->between, at);
    } else if (at.home) {
      link = levelled(link);
    }
  }
  if constexpr (std::is_same_v<LinkOf<Loop>, ThreeServos>) {
    for (int i = 0; i < 2 && at.home; ++i) {
      link.cos_offset[i] = 1;
      link.sin_offset[i] = link.offset[i] = 0;
    }
  }
  return loop;
}

// Calls use(loop) with the scene's loop as it is about a point.
template <class Use>
auto with_loop_at(const Model& model, const LinearPoint& at, const Use& use) {
  using Result = decltype(use(std::declval<const CoupledLoop<>&>()));
  return std::visit(
      [&](const auto& any) -> Result {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_coupled_loop<Any>) {
          return use(placed(any, model, at));
        } else if constexpr (is_coupled<Any>) {
          const CoupledBall& ball = any.parts.ball;
          Push<SignalPair> push;
          if constexpr (requires { any.push.on; }) push.on = any.push.on;
          // The plane's offsets are in its angles.
          const CoupledLoop<SignalPair, Linkages> loop(
              any.parts, GimbalBy::servos, {}, {ball.r, ball.g, ball.rolling, {}, {}, {}}, push);
          return use(placed(loop, model, at));
        } else {
          throw std::logic_error("a coupled scene that is none");
        }
      },
      model.system);
}

// The same, with another law and other servos.
template <class Loop>
Loop under(const Loop& of, const ControlLaw& law, const ServoResponses& servo,
           const LinkOf<Loop>& link) {
  const auto& rig = of.loop;
  const GimbalBy by = of.by == GimbalBy::given_torques ? GimbalBy::torques : of.by;
  Loop loop(of.parts, by, of.motor,
            {rig.radius(), rig.gravity(), rig.rolling(), law, servo, {}, rig.mode, link}, of.push);
  loop.integrate_error(law.integrates());
  return loop;
}

// Without the law: one that hands on its reference, u = reference - position. Linkages are told
// what their servos are.
template <class Loop>
Loop plant_of(const Loop& loop) {
  ControlLaw law;
  law.kind = LawKind::linear;
  law.gain[0][0] = law.gain[1][1] = 1;
  LinkOf<Loop> link = loop.loop.link;
  if constexpr (std::is_same_v<LinkOf<Loop>, Linkages>) {
    for (LinkCurve& one : link.of) one.assumed = Assumed::none;
  }
  return under(loop, law, loop.loop.servo(), link);
}

template <class Loop>
VectorXd states_at(const LinearPoint& at) {
  VectorXd z = VectorXd::Zero(Loop::size);
  if (!at.own.empty()) {
    z = Eigen::Map<const VectorXd>(at.own.data(), Loop::size);
  } else if (Loop::servos == 2) {
    for (std::size_t i = 0; i < at.state.size(); ++i) z[static_cast<Eigen::Index>(i)] = at.state[i];
  }
  return z;
}

template <class Loop>
void put_states(const LinearPoint& at, Varied (&z)[Loop::size]) {
  const VectorXd values = states_at<Loop>(at);
  for (int i = 0; i < Loop::size; ++i) z[i] = Varied::variable(values[i], i);
}

// Rates under a reference, and the push of that time.
template <class Loop, class Number>
void rates_under(const Loop& loop, const std::array<Jet<Number>, 2>& reference, double time,
                 const Number* z, Number* dz) {
  if constexpr (Loop::pushes) {
    const auto push = loop.push.on.at(time);
    const PushedInputs<Number> in{reference, {Number(push[0].value), Number(push[1].value)}};
    loop.derivative_of(in, z, dz);
  } else {
    loop.derivative_of(reference, z, dz);
  }
}

template <class Loop>
PlantDerivatives differentiate_plant(const Loop& loop, const LinearPoint& at) {
  constexpr int n = Loop::size;
  Varied z[n], dz[n];
  put_states<Loop>(at, z);
  rates_under(plant_of(loop), reference_for(at.command, z, n), at.time, z, dz);
  return plant_derivatives<n>(dz);
}

// What the law says of an axis: to its servo; where there are three, of the plane.
template <class Loop, class Axes>
auto command_of(const Axes& axes, int i) {
  if constexpr (Loop::servos == 2) {
    return decltype(std::declval<Loop>().loop)::told(axes, i);
  } else {
    return axes.command.value[i];
  }
}

template <class Loop>
LoopDerivatives differentiate_loop(const Loop& loop, const LinearPoint& at) {
  constexpr int n = Loop::size;
  Varied z[n], dz[n];
  put_states<Loop>(at, z);
  const auto reference = varied<Varied>(at.reference, n);
  rates_under(loop, reference, at.time, z, dz);
  const auto axes = loop.loop.axes(reference, z);
  const Varied commands[2] = {command_of<Loop>(axes, 0), command_of<Loop>(axes, 1)};
  return loop_derivatives<n>(dz, commands);
}

// Where states are that not all loops have.
struct Places {
  int servos, integral, motor;
  bool motor_integrates;
};

Places places_of(const Model& model) {
  return with_loop_at(model, home_point(), [&](const auto& loop) -> Places {
    using Loop = std::decay_t<decltype(loop)>;
    using Layout = typename Loop::Layout;
    return {Loop::servos, Layout::integral, Layout::motor, loop.motor.from_integral != 0};
  });
}

bool spin_acts(const MatrixXd& of_state, const std::vector<int>& on) {
  return std::ranges::any_of(on, [&](int i) { return of_state(i, spin_state) != 0; });
}

// In a SampledCycle's order.
std::vector<int> cycle_states(const Model& model, const MatrixXd& of_state) {
  const Places at = places_of(model);
  std::vector<int> states{0, 1, 2, 3};
  for (int i = spin_state + 1; i < at.integral; ++i) states.push_back(i);
  if (at.motor_integrates) states.insert(states.end(), {at.motor, at.motor + 1});
  if (spin_acts(of_state, states)) states.push_back(spin_state);
  return states;
}

}  // namespace

std::vector<LinearSignal> coupled_signals(const Model& model, const std::string& command_unit) {
  const Places at = places_of(model);
  std::vector<LinearSignal> signals{
      {"x", "m"}, {"y", "m"}, {"vx", "m/s"}, {"vy", "m/s"}, {spin_name, "m/s"}};
  for (const bool rates : {false, true}) {
    const char* const three[] = {"servo_phi", "servo_theta", "servo_third"};
    const char* const two[] = {"phi", "theta"};
    for (int i = 0; i < at.servos; ++i) {
      const std::string name = at.servos == 3 ? three[i] : two[i];
      signals.push_back({name + (rates ? "_rate" : ""), rates ? "rad/s" : "rad"});
    }
  }
  for (const char* one : {"phi_command_integral", "theta_command_integral"}) {
    signals.push_back({one, command_unit});
  }
  for (const char* one : {"phi_integral", "theta_integral"}) signals.push_back({one, "rad s"});
  return signals;
}

std::vector<int> coupled_states(const Model& model, const MatrixXd& of_state) {
  std::vector<int> states = cycle_states(model, of_state);
  // The spin stands after the velocities.
  if (states.back() == spin_state) std::rotate(states.begin() + 4, states.end() - 1, states.end());
  return states;
}

int coupled_integral(const Model& model) {
  return places_of(model).integral;
}

PlantDerivatives coupled_plant_at(const Model& model, const LinearPoint& at) {
  return with_loop_at(model, at, [&](const auto& loop) { return differentiate_plant(loop, at); });
}

LoopDerivatives coupled_loop_at(const Model& model, const LinearPoint& at) {
  return with_loop_at(model, at, [&](const auto& loop) { return differentiate_loop(loop, at); });
}

CycleParts coupled_cycle_at(const Model& model, const LinearPoint& at, std::vector<int>& states) {
  return with_loop_at(model, at, [&](const auto& loop) {
    using Loop = std::decay_t<decltype(loop)>;
    constexpr int servos = Loop::servos, angle = Loop::Layout::angle, rate = Loop::Layout::rate;
    const PlantDerivatives plant = differentiate_plant(loop, at);
    states = cycle_states(model, plant.of_state);
    CycleParts parts;
    parts.servos = servos;
    parts.a = plant.of_state(states, states);
    parts.b = plant.of_command(states, Eigen::all);

    const VectorXd z = states_at<Loop>(at);
    MatrixXd jump = MatrixXd::Zero(Loop::size, servos);
    for (int i = 0; i < servos; ++i) {
      VectorXd kicked = z;
      kicked.segment<servos>(rate) = Eigen::Matrix<double, servos, 1>::Unit(i);
      const auto rates = loop.loop.plane_rates(kicked.data());
      const auto kick = loop.loop.impulse(z.data(), rates[0], rates[1]);
      for (int j = 0; j < 3; ++j) jump(2 + j, i) = kick[static_cast<std::size_t>(j)];
      jump(rate + i, i) = 1;
    }
    parts.jump = jump(states, Eigen::all);

    const Rig& rig = *model.rig;
    parts.take_controller(rig, linear_law(rig.sampled->law, feedback_at(rig, at), at.reference));
    if constexpr (std::is_same_v<LinkOf<Loop>, Linkages>) {
      if (!rig.between.none()) link_controller(parts, loop.loop.link, rig, at);
    }
    if constexpr (std::is_same_v<LinkOf<Loop>, ThreeServos>) {
      // What the controller takes the servos' angles and rates for, and what it tells them.
      Varied servo[3], moving[3], known[2], known_rate[2];
      for (int i = 0; i < 3; ++i) {
        servo[i] = Varied::variable(z[angle + i], i);
        moving[i] = Varied::variable(z[rate + i], 3 + i);
      }
      loop.loop.link.believed(servo, moving, known, known_rate);
      parts.fed = MatrixXd::Zero(4, std::ssize(states));
      parts.fed.block<2, 6>(0, 4) = simd::gradients(known, 0, 6);
      parts.fed.block<2, 6>(2, 4) = simd::gradients(known_rate, 0, 6);
      const Varied wanted[2] = {Varied::variable(at.command[0], 0),
                                Varied::variable(at.command[1], 1)};
      Varied told[3];
      loop.loop.link.told(wanted, told);
      parts.told = simd::gradients(told, 0, 2);
    }
    return parts;
  });
}

namespace {

// What an equilibrium is looked for among, and what has to vanish there.
struct Rest {
  std::vector<int> states;     // unknown, of a loop
  std::vector<int> vanishing;  // rates
  bool commands = false;       // unknown too: there is no law that gives them
};

Rest rest_of(const Places& places, const ControlLaw& law, bool has_law) {
  Rest rest;
  rest.vanishing = {2, 3};
  if (has_law) rest.states = {0, 1};
  for (int i = 0; i < places.servos; ++i) {
    rest.states.push_back(spin_state + 1 + i);
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

// Laws ask for reference - seen, and are given reference - position: moves the reference by what
// the sensor, if there is one, sees otherwise.
template <class Number>
void see_by(const Sensor* sensor, const Number* z, std::array<Jet<Number>, 2>& reference) {
  if (sensor == nullptr || sensor->is_aligned()) return;
  const Eigen::Matrix2d seen = seen_matrix(*sensor);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    Number& value = reference[i].value;
    value = value + z[i] - (seen(row, 0) * z[0] + seen(row, 1) * z[1]) - sensor->offset[i];
  }
}

// Rates of a loop whose controller sees the ball by its sensor, and what states add to them.
template <class Loop>
PlantDerivatives differentiate_seen(const Loop& loop, const Sensor* sensor, const LinearPoint& at) {
  constexpr int n = Loop::size;
  Varied z[n], dz[n];
  put_states<Loop>(at, z);
  std::array<Jet<Varied>, 2> reference;
  for (std::size_t i = 0; i < 2; ++i) reference[i] = {at.reference[i].value, 0.0, 0.0};
  see_by(sensor, z, reference);
  rates_under(loop, reference, at.time, z, dz);
  return {simd::values(dz), simd::gradients(dz, 0, n), MatrixXd::Zero(n, 2)};
}

// The law's command at a point: to the servos or of the plane, and before what links them.
template <class Loop>
std::pair<Pair, Pair> commands_at(const Loop& loop, const Sensor* sensor, const LinearPoint& at) {
  const VectorXd z = states_at<Loop>(at);
  std::array<Jet<double>, 2> reference = at.reference;
  see_by(sensor, z.data(), reference);
  const auto axes = loop.loop.axes(reference, z.data());
  return {{command_of<Loop>(axes, 0), command_of<Loop>(axes, 1)},
          {axes.command.value[0], axes.command.value[1]}};
}

}  // namespace

LinearPoint coupled_equilibrium(const Scenario& scene, const Model& model) {
  LinearPoint point;
  Pair position = scene.ball.position;
  ControlLaw law;
  const Sensor* sensor = nullptr;
  if (scene.controller) {
    const auto path = reference_path(scene.controller->reference).at(0.0);
    for (std::size_t i = 0; i < 2; ++i) position[i] = point.reference[i].value = path[i].value;
    law = with_loop_at(model, point, [](const auto& loop) { return loop.law(); });
    if (model.rig->sampled) {
      law = model.rig->sampled->law;
      sensor = &model.rig->sampled->sensor;
    }
  }
  const bool has_law = law.kind == LawKind::linear || law.kind == LawKind::gravity_compensation;
  const Places places = places_of(model);
  const Rest rest = rest_of(places, law, has_law);
  const Eigen::Index n = std::ssize(rest.vanishing), of_states = std::ssize(rest.states);
  VectorXd z = with_loop_at(model, point, [](const auto& loop) -> VectorXd {
    return VectorXd::Zero(std::decay_t<decltype(loop)>::size);
  });
  z[0] = position[0];
  z[1] = position[1];
  // Whatever a servo's answer is like, it rests at its command.
  const ServoResponses at_rest = scene.gimbal.servo ? ServoResponse{1, 1, 0} : ServoResponse{};
  const auto put = [&] {
    point.own.assign(z.begin(), z.end());
    if (places.servos == 2) std::copy_n(z.data(), point.state.size(), point.state.begin());
  };
  const auto with_law = [&](const auto& use) {
    return with_loop_at(model, point, [&](const auto& loop) {
      return use(under(loop, law, at_rest, loop.loop.link));
    });
  };
  for (int i = 0; i < 50; ++i) {
    put();
    if (has_law) {
      point.command =
          with_law([&](const auto& loop) { return commands_at(loop, sensor, point).first; });
    }
    const PlantDerivatives now = with_law([&](const auto& loop) {
      return has_law ? differentiate_seen(loop, sensor, point) : differentiate_plant(loop, point);
    });
    MatrixXd slope(n, n);
    slope.leftCols(of_states) = now.of_state(rest.vanishing, rest.states);
    if (rest.commands) slope.rightCols(2) = now.of_command(rest.vanishing, Eigen::all);
    const auto solved = solve_if_regular(slope, -now.rates(rest.vanishing));
    if (!solved) break;
    const VectorXd change = *solved;
    for (Eigen::Index k = 0; k < of_states; ++k) {
      z[rest.states[static_cast<std::size_t>(k)]] += change[k];
    }
    for (int k = 0; k < 2 && rest.commands; ++k) {
      point.command[static_cast<std::size_t>(k)] += change[of_states + k];
    }
    // Newton's last step: what it leaves is rounding.
    if (change.norm() > 1e-9 * (1 + z.norm())) continue;
    put();
    if (!has_law) return point;
    const auto [command, asked] =
        with_law([&](const auto& loop) { return commands_at(loop, sensor, point); });
    point.command = command;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (std::abs(asked[axis]) > command_limit(*scene.controller, axis).value_or(unlimited)) {
        throw InputError(
            "linearize: there is no equilibrium: the command that keeps the ball at its reference "
            "is beyond controller.limit");
      }
    }
    return point;
  }
  throw InputError(
      "linearize: there is no equilibrium: everything rests at no single position, at any angles "
      "and commands of this gimbal");
}

}  // namespace bbsim::model
