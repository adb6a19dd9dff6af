#include "model/control/sampled_cycle.hpp"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "model/control/riccati.hpp"
#include "model/eigenvalues.hpp"
#include "model/systems/jacobian.hpp"

namespace bbsim::model {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Vector2 = Eigen::Vector2d;

// Where the states of LinearPlant are among those of RigLoop.
constexpr int places[8] = {0, 1, 2, 3, 5, 6, 7, 8};

RigLoop<> held(const RigLoop<>& loop) {
  RigLoop<> plain(loop.radius(), loop.gravity(), loop.rolling(), ControlLaw{}, loop.servo(), {});
  return plain;
}

// All that a law feeds back, in the order of its fields.
using Feedbacks = Eigen::Matrix<double, 10, 1>;

// u = K (what is fed back) about home, by differentiating the law.
Eigen::Matrix<double, 2, 10> linearised(const ControlLaw& law) {
  using Number = simd::WithGradient<10>;
  const auto pair = [](int first, Number(&into)[2]) {
    for (int i = 0; i < 2; ++i) into[i] = Number::variable(0, first + i);
  };
  Feedback<Number> state;
  pair(0, state.position);
  pair(2, state.velocity);
  pair(4, state.angle);
  pair(6, state.rate);
  pair(8, state.integral);
  const std::array<Jet<double>, 2> home{};
  const auto unlimited_command = [](int, const Number& raw) { return raw; };
  const Command<Number> u = command(law, state, home, unlimited_command);
  Eigen::Matrix<double, 2, 10> gain;
  for (int i = 0; i < 2; ++i) gain.row(i) = u.value[i].gradient.transpose();
  return gain;
}

// One period of a sampled loop, linear. Of its state, in this order: the plant's 8; the exposures
// not yet sampled; the position and velocity that the controller has; the integral, if the law has
// one; the commands not yet applied; the command that is held.
class Cycle {
 public:
  Cycle(const RigLoop<>& loop, const Rig& rig)
      : rig_(rig),
        loop_(held(loop)),
        law_(linearised(rig.sampled->law)),
        plant_(linear_plant(loop_)) {
    const SampledLoop& sampled = *rig.sampled;
    const double period = sampled.sampling.period;
    const auto split = [period](double delay, double* whole) {
      *whole = std::floor(delay / period + 1e-9);
      return std::max(0.0, delay - *whole * period);
    };
    double whole = 0;
    const double exposed_before = split(sampled.sensor.delay, &whole);
    exposure_ = exposed_before > 1e-9 * period ? period - exposed_before : 0;
    exposures_ = static_cast<int>(whole) + (exposure_ > 0 ? 1 : 0);
    application_ = split(sampled.sampling.delay, &whole);
    if (application_ <= 1e-9 * period) application_ = 0;
    commands_ = static_cast<int>(whole);
    integrates_ = sampled.law.integrates();
    const double instants[3] = {std::min(exposure_, application_),
                                std::max(exposure_, application_), period};
    double from = 0;
    for (int i = 0; i < 3; ++i) {
      advance_[i] = after(plant_, instants[i] - from);
      from = instants[i];
    }
  }

  [[nodiscard]] int size() const { return held_at() + 2; }

  void run(VectorXd& s) const {
    if (exposure_ == 0) expose(s);
    sample(s);
    if (application_ == 0) apply(s);
    advance(s, 0);
    const bool exposure_first = exposure_ <= application_;
    at_instant(s, exposure_first);
    advance(s, 1);
    at_instant(s, !exposure_first);
    advance(s, 2);
  }

 private:
  [[nodiscard]] int memory_at() const { return 8 + 2 * (exposures_ + 1); }
  [[nodiscard]] int integral_at() const { return memory_at() + 4; }
  [[nodiscard]] int commands_at() const { return integral_at() + (integrates_ ? 2 : 0); }
  [[nodiscard]] int held_at() const { return commands_at() + 2 * (commands_ + 1); }

  void at_instant(VectorXd& s, bool exposure) const {
    if (exposure) {
      if (exposure_ > 0) expose(s);
    } else if (application_ > 0) {
      apply(s);
    }
  }

  void advance(VectorXd& s, int i) const {
    s.head<8>() = advance_[i].a * s.head<8>() + advance_[i].b * s.segment<2>(held_at());
  }

  // Queues: the entry to be taken next stands first; there is room for one more than wait at the
  // period's start. An exposure within the period comes after the sample took one.
  void expose(VectorXd& s) const {
    s.segment<2>(8 + 2 * (exposure_ > 0 ? exposures_ - 1 : exposures_)) = s.head<2>();
  }

  void sample(VectorXd& s) const {
    const SampledLoop& sampled = *rig_.sampled;
    const double period = sampled.sampling.period;
    const double filter = sampled.sampling.derivative_filter;
    const double keep = filter / (filter + period);
    const Vector2 seen = s.segment<2>(8);
    for (int i = 0; i < exposures_; ++i) s.segment<2>(8 + 2 * i) = s.segment<2>(10 + 2 * i).eval();
    s.segment<2>(8 + 2 * exposures_).setZero();
    auto position = s.segment<2>(memory_at());
    auto velocity = s.segment<2>(memory_at() + 2);
    velocity = (keep * velocity + (1 - keep) / period * (seen - position)).eval();
    position = seen;
    if (integrates_) s.segment<2>(integral_at()) -= period * seen;
    Feedbacks known = Feedbacks::Zero();
    known << position, velocity, s.segment<4>(4), Vector2::Zero();
    if (integrates_) known.tail<2>() = s.segment<2>(integral_at());
    const Vector2 u = law_ * known;
    s.segment<2>(commands_at() + 2 * commands_) = u;
  }

  void apply(VectorXd& s) const {
    s.segment<2>(held_at()) = s.segment<2>(commands_at());
    for (int i = 0; i < commands_; ++i) {
      s.segment<2>(commands_at() + 2 * i) = s.segment<2>(commands_at() + 2 * i + 2).eval();
    }
    s.segment<2>(commands_at() + 2 * commands_).setZero();
    if (!rig_.time_constant) return;
    // A servo of first order takes its new rate at once, and kicks the ball.
    const Vector2 rate = (s.segment<2>(held_at()) - s.segment<2>(4)) / *rig_.time_constant;
    const double home[RigLoop<>::size] = {};
    const auto kick = loop_.impulse(home, rate[0] - s[6], rate[1] - s[7]);
    s[2] += kick[0];
    s[3] += kick[1];
    s.segment<2>(6) = rate;
  }

  const Rig& rig_;
  RigLoop<> loop_;
  Eigen::Matrix<double, 2, 10> law_;
  LinearPlant plant_;
  double exposure_ = 0, application_ = 0;  // instants within the period, s
  int exposures_ = 0, commands_ = 0;       // in the queues at the period's start
  bool integrates_ = false;
  LinearPlant advance_[3];
};

}  // namespace

LinearPlant linear_plant(const RigLoop<>& loop) {
  RigLoop<> plain = held(loop);
  const double home[RigLoop<>::size] = {};
  const auto full = jacobian(plain, 0.0, home);
  double none[RigLoop<>::size], one[RigLoop<>::size];
  plain.derivative(0.0, home, none);
  LinearPlant plant;
  for (int j = 0; j < 2; ++j) {
    plain.mode.command[j] = 1;
    plain.derivative(0.0, home, one);
    plain.mode.command[j] = 0;
    for (int i = 0; i < 8; ++i) plant.b(i, j) = one[places[i]] - none[places[i]];
  }
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) plant.a(i, j) = full(places[i], places[j]);
  }
  return plant;
}

LinearPlant after(const LinearPlant& plant, double time) {
  Eigen::Matrix<double, 10, 10> both = Eigen::Matrix<double, 10, 10>::Zero();
  both.topLeftCorner<8, 8>() = plant.a * time;
  both.topRightCorner<8, 2>() = plant.b * time;
  const Eigen::Matrix<double, 10, 10> all = both.exp();
  return {all.topLeftCorner<8, 8>(), all.topRightCorner<8, 2>()};
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

Eigenvalues sampled_poles(const RigLoop<>& loop, const Rig& rig) {
  const Cycle cycle(loop, rig);
  const int n = cycle.size();
  MatrixXd map(n, n);
  for (int j = 0; j < n; ++j) {
    VectorXd s = VectorXd::Unit(n, j);
    cycle.run(s);
    map.col(j) = s;
  }
  Eigenvalues poles = eigenvalues_of(map);
  std::sort(poles.begin(), poles.end(), [](const auto& a, const auto& b) {
    const double p = std::abs(a), q = std::abs(b);
    return p != q ? p > q : a.imag() > b.imag();
  });
  return poles;
}

}  // namespace bbsim::model
