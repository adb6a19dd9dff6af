#include "model/control/sampled_cycle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <type_traits>
#include <utility>

#include "model/control/linear_law.hpp"
#include "model/control/riccati.hpp"
#include "model/dense.hpp"
#include "model/systems/any_jacobian.hpp"

namespace bbsim::model {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Vector2 = Eigen::Vector2d;

// Where the states of LinearPlant are among those of RigLoop.
constexpr std::array places{0, 1, 2, 3, 5, 6, 7, 8};

template <bool integrates>
RigLoop<integrates> held(const RigLoop<integrates>& loop) {
  return {loop.radius(), loop.gravity(), loop.rolling(), ControlLaw{}, loop.servo(), {}};
}

// With a plane that is level at home, where a linkage's own angle may not be 0.
RigLoop<true, SignalPair, Linkages> held(const RigLoop<true, SignalPair, Linkages>& loop) {
  return {loop.radius(),      loop.gravity(), loop.rolling(), ControlLaw{}, loop.servo(), {}, {},
          levelled(loop.link)};
}

// Three servos, about home, are two ideal ones.
RigLoop<true> held(const RigLoop<true, SignalPair, ThreeServos>& loop) {
  return {loop.radius(), loop.gravity(), loop.rolling(), ControlLaw{}, loop.servo(), {}};
}

// The states in `of` about home, under commands that are held in `mode`, the loop's own.
template <class Loop>
LinearPlant about_home(Loop& loop, RigMode& mode, const std::vector<int>& of) {
  const double home[Loop::size] = {};
  MatrixXd full(Loop::size, Loop::size);
  jacobian(loop, 0.0, home, full.data());
  double none[Loop::size], one[Loop::size];
  loop.derivative(0.0, home, none);
  const auto n = static_cast<Eigen::Index>(of.size());
  LinearPlant plant{full(of, of), MatrixXd(n, 2)};
  for (int j = 0; j < 2; ++j) {
    mode.command[j] = 1;
    loop.derivative(0.0, home, one);
    mode.command[j] = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const int place = of[static_cast<std::size_t>(i)];
      plant.b(i, j) = one[place] - none[place];
    }
  }
  return plant;
}

}  // namespace

struct SampledCycle::Parts {
  VectorXd plant;
  std::deque<Vector2> exposures, commands;
  Vector2 position, velocity, integral, held;
};

void CycleParts::take_controller(const Rig& rig, const LinearLaw& law) {
  of_feedback = law.of_feedback;
  of_reference = law.of_reference;
  sampling = rig.sampled->sampling;
  sensor = rig.sampled->sensor;
  integrates = rig.sampled->law.integrates();
  for (int i = 0; i < servos; ++i) time_constant[i] = rig.servo[i].time_constant;
}

SampledCycle::SampledCycle(CycleParts parts) : parts_(std::move(parts)) {
  const double period = parts_.sampling.period;
  const auto split = [period](double delay, double* whole) {
    *whole = std::floor(delay / period + 1e-9);
    return std::max(0.0, delay - *whole * period);
  };
  double whole = 0;
  const double exposed_before = split(parts_.sensor.delay, &whole);
  exposure_ = exposed_before > 1e-9 * period ? period - exposed_before : 0;
  exposures_ = static_cast<std::size_t>(whole) + (exposure_ > 0 ? 1 : 0);
  application_ = split(parts_.sampling.delay, &whole);
  if (application_ <= 1e-9 * period) application_ = 0;
  commands_ = static_cast<std::size_t>(whole);
  const double instants[3] = {std::min(exposure_, application_), std::max(exposure_, application_),
                              period};
  double from = 0;
  for (int i = 0; i < 3; ++i) {
    LinearPlant way = after({parts_.a, parts_.b}, instants[i] - from);
    advance_a_[i] = std::move(way.a);
    advance_b_[i] = std::move(way.b);
    from = instants[i];
  }
}

int SampledCycle::controller_at() const {
  return static_cast<int>(parts_.a.rows()) + 2 * static_cast<int>(exposures_);
}

int SampledCycle::controller_size() const {
  return 4 + (parts_.integrates ? 2 : 0);
}

int SampledCycle::size() const {
  // A command that is applied at once is none of the period's start.
  return controller_at() + controller_size() + 2 * static_cast<int>(commands_) +
         (application_ > 0 ? 2 : 0);
}

std::vector<LinearSignal> SampledCycle::memory(const std::string& command_unit) const {
  std::vector<LinearSignal> signals;
  const auto add = [&signals](const char* first, const char* second, const std::string& suffix,
                              const std::string& unit) {
    signals.push_back({first + suffix, unit});
    signals.push_back({second + suffix, unit});
  };
  for (std::size_t i = 1; i <= exposures_; ++i) add("x", "y", "_seen_" + std::to_string(i), "m");
  add("x", "y", "_known", "m");
  add("vx", "vy", "_known", "m/s");
  if (parts_.integrates) add("x", "y", "_integral", "m s");
  for (std::size_t i = 1; i <= commands_; ++i) {
    add("phi", "theta", "_waiting_" + std::to_string(i), command_unit);
  }
  if (application_ > 0) add("phi", "theta", "_held", command_unit);
  return signals;
}

SampledCycle::Parts SampledCycle::unpacked(const VectorXd& state) const {
  Parts of;
  Eigen::Index next = parts_.a.rows();
  of.plant = state.head(next);
  const auto pair = [&]() -> Vector2 {
    next += 2;
    return state.segment<2>(next - 2);
  };
  for (std::size_t i = 0; i < exposures_; ++i) of.exposures.push_back(pair());
  of.position = pair();
  of.velocity = pair();
  of.integral = parts_.integrates ? pair() : Vector2::Zero().eval();
  for (std::size_t i = 0; i < commands_; ++i) of.commands.push_back(pair());
  of.held = application_ > 0 ? pair() : Vector2::Zero().eval();
  return of;
}

VectorXd SampledCycle::packed(const Parts& of) const {
  VectorXd state(size());
  Eigen::Index next = of.plant.size();
  state.head(next) = of.plant;
  const auto put = [&](const Vector2& pair) {
    state.segment<2>(next) = pair;
    next += 2;
  };
  for (const Vector2& seen : of.exposures) put(seen);
  put(of.position);
  put(of.velocity);
  if (parts_.integrates) put(of.integral);
  for (const Vector2& command : of.commands) put(command);
  if (application_ > 0) put(of.held);
  return state;
}

void SampledCycle::advance(Parts& of, int i) const {
  of.plant = (advance_a_[i] * of.plant + advance_b_[i] * of.held).eval();
}

void SampledCycle::expose(Parts& of) const {
  const Vector2 at = of.plant.head<2>();
  if (parts_.sensor.is_aligned()) {
    of.exposures.push_back(at);
  } else {
    of.exposures.emplace_back(seen_matrix(parts_.sensor) * at);
  }
}

void SampledCycle::apply(Parts& of) const {
  of.held = of.commands.front();
  of.commands.pop_front();
  VectorXd told = of.held;
  if (parts_.told.size() > 0) told = (parts_.told * of.held).eval();
  VectorXd jump = VectorXd::Zero(parts_.servos);
  for (int i = 0; i < parts_.servos; ++i) {
    if (!parts_.time_constant[i]) continue;
    jump[i] =
        (told[i] - of.plant[4 + i]) / *parts_.time_constant[i] - of.plant[4 + parts_.servos + i];
  }
  if (!jump.isZero(0)) of.plant += (parts_.jump * jump).eval();
}

SampledCycle::Output SampledCycle::run(const VectorXd& state, const Input& input) const {
  Parts of = unpacked(state);
  if (exposure_ == 0) expose(of);

  const double period = parts_.sampling.period, filter = parts_.sampling.derivative_filter;
  const double keep = filter / (filter + period);
  Output output;
  output.seen = of.exposures.front();
  of.exposures.pop_front();
  of.velocity = (keep * of.velocity + (1 - keep) / period * (output.seen - of.position)).eval();
  of.position = output.seen;
  if (parts_.integrates) of.integral += period * (input.reference.head<2>() - output.seen);
  Eigen::Matrix<double, 10, 1> known;
  known << of.position, of.velocity, of.plant.segment<4>(4), of.integral;
  if (parts_.fed.size() > 0) known.segment<4>(4) = parts_.fed * of.plant;
  output.law = parts_.of_feedback * known + parts_.of_reference * input.reference;
  Vector2 command = output.law;
  for (int i = 0; i < 2; ++i) {
    if (input.open[i]) command[i] = input.command[i];
  }
  of.commands.push_back(command);

  if (application_ == 0) apply(of);
  advance(of, 0);
  const bool exposure_first = exposure_ <= application_;
  for (int i = 1; i <= 2; ++i) {
    if ((i == 1) == exposure_first) {
      if (exposure_ > 0) expose(of);
    } else if (application_ > 0) {
      apply(of);
    }
    advance(of, i);
  }
  output.state = packed(of);
  return output;
}

MatrixXd SampledCycle::map() const {
  const int n = size();
  MatrixXd map(n, n);
  for (int j = 0; j < n; ++j) map.col(j) = run(VectorXd::Unit(n, j), {}).state;
  return map;
}

LinearPlant linear_plant(const RigLoop<>& loop) {
  RigLoop<> plain = held(loop);
  return about_home(plain, plain.mode, {places.begin(), places.end()});
}

namespace {

template <class Link, class Held>
LinearPlant coupled_plant(const CoupledLoop<SignalPair, Link>& loop, Held held_loop) {
  CoupledParts parts = loop.parts;
  parts.contact = {};
  CoupledLoop plain(parts, loop.by, loop.motor, std::move(held_loop));
  std::vector<int> of(places.begin(), places.end());
  if (loop.motor.from_integral != 0) {
    of.insert(of.end(), {CoupledLoopLayout::motor, CoupledLoopLayout::motor + 1});
  }
  return about_home(plain, plain.loop.mode, of);
}

}  // namespace

LinearPlant linear_plant(const CoupledLoop<>& loop) {
  return coupled_plant(loop, held(loop.loop));
}

LinearPlant linear_plant(const CoupledLoop<SignalPair, Linkages>& loop) {
  return coupled_plant(loop, held(loop.loop));
}

LinearPlant linear_plant(const CoupledLoop<SignalPair, ThreeServos>& loop) {
  return coupled_plant(loop, held(loop.loop));
}

Eigen::Matrix2d seen_matrix(const Sensor& sensor) {
  const double c = std::cos(sensor.rotation), s = std::sin(sensor.rotation);
  Eigen::Matrix2d matrix;
  matrix << sensor.scale[0] * c, -sensor.scale[0] * s, sensor.scale[1] * s, sensor.scale[1] * c;
  return matrix;
}

Linkages levelled(const Linkages& link) {
  Linkages level = link;
  for (LinkCurve& one : level.of) {
    const Turn<double> home = one.plain_turn(0.0);
    one.set_offsets(0, std::atan2(home.sin, home.cos));
  }
  return level;
}

LinearPlant after(const LinearPlant& plant, double time) {
  const Eigen::Index n = plant.a.rows();
  MatrixXd both = MatrixXd::Zero(n + 2, n + 2);
  both.topLeftCorner(n, n) = plant.a * time;
  both.topRightCorner(n, 2) = plant.b * time;
  const MatrixXd all = exponential(both);
  return {all.topLeftCorner(n, n), all.topRightCorner(n, 2)};
}

Eigen::Matrix<double, 2, 8> lqr_gain(const LinearPlant& plant, const LqrWeights& weights,
                                     double period) {
  VectorXd diagonal(8);
  diagonal << weights.position, weights.position, weights.velocity, weights.velocity, weights.angle,
      weights.angle, weights.rate, weights.rate;
  const MatrixXd q = diagonal.asDiagonal();
  const MatrixXd r = weights.command * MatrixXd::Identity(2, 2);
  if (period > 0) {
    const LinearPlant step = after(plant, period);
    return solve_discrete_riccati(step.a, step.b, q, r).gain;
  }
  return solve_continuous_riccati(plant.a, plant.b, q, r).gain;
}

namespace {

// The plant's first eight states are those of LinearPlant, and `loop` kicks the ball as it does.
template <bool integrates, class Link>
CycleParts parts_of(const LinearPlant& plant, const RigLoop<integrates, SignalPair, Link>& loop,
                    const Rig& rig) {
  using Loop = RigLoop<integrates, SignalPair, Link>;
  CycleParts parts;
  parts.a = plant.a;
  parts.b = plant.b;
  parts.jump = MatrixXd::Zero(plant.a.rows(), 2);
  for (int i = 0; i < 2; ++i) {
    double home[Loop::size] = {};
    home[Loop::Layout::rate + i] = 1;
    const auto rates = loop.plane_rates(home);
    home[Loop::Layout::rate + i] = 0;
    const auto kick = loop.impulse(home, rates[0], rates[1]);
    parts.jump.col(i).template head<8>() << 0, 0, kick[0], kick[1], 0, 0, i == 0 ? 1 : 0,
        i == 0 ? 0 : 1;
  }
  parts.take_controller(rig, linear_law(rig.sampled->law, {}, {}));
  if constexpr (std::is_same_v<Link, Linkages>) {
    double slope[2];
    for (int i = 0; i < 2; ++i) slope[i] = loop.link.of[i].slope;
    parts.link_controller(slope, slope);
  }
  return parts;
}

}  // namespace

void CycleParts::link_controller(const double (&of_command)[2], const double (&of_angle)[2]) {
  for (int i = 0; i < 2; ++i) {
    of_feedback.col(4 + i) *= of_angle[i];
    of_feedback.col(6 + i) *= of_angle[i];
  }
  for (int i = 0; i < 2; ++i) {
    of_feedback.row(i) /= of_command[i];
    of_reference.row(i) /= of_command[i];
  }
}

CycleParts cycle_parts(const RigLoop<>& loop, const Rig& rig) {
  const RigLoop<> plain = held(loop);
  return parts_of(linear_plant(plain), plain, rig);
}

Eigenvalues sampled_poles(const RigLoop<>& loop, const Rig& rig) {
  if (rig.sampled->law.kind == LawKind::held) return {};
  return poles_of_period(SampledCycle(cycle_parts(loop, rig)).map());
}

Eigenvalues sampled_poles(const Model& model) {
  return std::visit(
      [&](const auto& any) -> Eigenvalues {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_coupled_loop<Any>) {
          if (model.rig->sampled->law.kind == LawKind::held) return {};
          return poles_of_period(
              SampledCycle(parts_of(linear_plant(any), held(any.loop), *model.rig)).map());
        } else if constexpr (std::is_same_v<Any, RigLoop<>>) {
          return sampled_poles(any, *model.rig);
        } else {
          return {};
        }
      },
      model.system);
}

Eigenvalues plant_poles(const Model& model) {
  return std::visit(
      [](const auto& any) -> Eigenvalues {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_coupled_loop<Any> || std::is_same_v<Any, RigLoop<>>) {
          return sorted_eigenvalues(linear_plant(any).a);
        } else {
          return {};
        }
      },
      model.system);
}

}  // namespace bbsim::model
