// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "rig_by_hand.hpp"

#include <algorithm>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <numbers>

#include "base/noise.hpp"

namespace bbsim::bench {
namespace {

namespace odeint = boost::numeric::odeint;

constexpr double degree = std::numbers::pi / 180;
constexpr double r = 0.02, g = 9.81;
constexpr double omega_n = 5 * 2 * std::numbers::pi, zeta = 0.8;
constexpr double angle_limit = 25 * degree, rate_limit = 300 * degree, dead_band = 0.1 * degree;
constexpr double kp = 8, kv = 4, command_limit = 12 * degree, command_step = 0.1 * degree;
constexpr double period = 0.02, filter = 0.03;
constexpr double sensor_step = 0.32e-3, sensor_noise = 0.2e-3;
constexpr double half_width = 0.16, half_depth = 0.12;

// x, y, x', y', u = r gamma', phi, theta, phi', theta'
using State = std::array<double, 9>;

struct Rig {
  double command[2]{0, 0};  // for the servos to follow

  // Equation (27) and two servos. Shared products are computed once.
  void operator()(const State& z, State& dz, double) const {
    const double x = z[0], y = z[1], x_dot = z[2], y_dot = z[3], u = z[4];
    const double p = z[7], q = z[8];
    const double sp = std::sin(z[5]), cp = std::cos(z[5]);
    const double s = std::sin(z[6]), c = std::cos(z[6]);
    const double pp = omega_n * (omega_n * (command[0] - z[5]) - 2 * zeta * p);
    const double qq = omega_n * (omega_n * (command[1] - z[6]) - 2 * zeta * q);
    const double s_p = s * p;
    dz[0] = x_dot;
    dz[1] = y_dot;
    dz[2] = (5 * g * sp - (7 * r * c + 5 * y * s) * pp + 5 * x * p * p -
             (10 * y * c - 12 * r * s) * (p * q) - 12 * s_p * y_dot + 2 * q * u) *
            (1.0 / 7);
    dz[3] = (5 * x * s * pp + 7 * r * qq + 5 * (y * s + r * c) * s_p * p + 5 * y * q * q +
             12 * s_p * x_dot + 2 * c * p * u - 5 * g * cp * s) *
            (1.0 / 7);
    dz[4] = r * (s * pp + c * p * q) - (q * x_dot + c * p * y_dot);
    dz[5] = p;
    dz[6] = q;
    dz[7] = pp;
    dz[8] = qq;
  }
};

double rounded_to(double value, double step) {
  return std::nearbyint(value / step) * step;
}

class Dopri5 {
 public:
  explicit Dopri5(double rtol)
      : stepper_(odeint::make_controlled(rtol / 100, rtol, odeint::runge_kutta_dopri5<State>())) {}

  void advance(const Rig& rig, State& z, double from, double to) {
    stepper_.reset();  // the command has jumped, so the old slope is invalid
    double t = from, step = std::min(step_, to - from);
    while (to - t > 1e-13 * to) {
      const bool cut = step >= to - t;
      double now = cut ? to - t : step;
      const bool passed = stepper_.try_step(std::cref(rig), z, t, now) == odeint::success;
      if (!cut || !passed) step = now;
      if (passed) step_ = std::max(step, now);
    }
  }

 private:
  odeint::controlled_runge_kutta<odeint::runge_kutta_dopri5<State>> stepper_;
  double step_ = period;
};

class Classical {
 public:
  void advance(const Rig& rig, State& z, double from, double to) {
    const double step = (to - from) / 2;
    stepper_.do_step(std::cref(rig), z, from, step);
    stepper_.do_step(std::cref(rig), z, from + step, step);
  }

 private:
  odeint::runge_kutta4<State> stepper_;
};

template <class Integrator>
bool run(Integrator integrator, bool noise, HandRow* rows) {
  Rig rig;
  State z{0.05};
  Noise draws(1);
  double given[2] = {0, 0};  // of the sample, before the servos receive it
  const auto see = [&](double(&at)[2]) {
    for (int i = 0; i < 2; ++i) {
      const double drawn = noise ? sensor_noise * draws.normal() : 0.0;
      at[i] = rounded_to(z[static_cast<std::size_t>(i)] + drawn, sensor_step);
    }
  };
  double exposed[2], seen[2] = {0, 0}, velocity[2] = {0, 0};
  see(exposed);
  const double keep = filter / (filter + period);
  for (std::size_t n = 0;; ++n) {
    const double t = static_cast<double>(n) * period;
    // Exposure of half a period ago.
    for (int i = 0; i < 2; ++i) {
      const double slope = n > 0 ? (exposed[i] - seen[i]) / period : 0;
      velocity[i] = keep * velocity[i] + (1 - keep) * slope;
      seen[i] = exposed[i];
    }
    const double cosine = std::cos(-0.3 * t), sine = std::sin(-0.3 * t);
    const double at[2] = {0.05 * cosine, 0.05 * sine};
    const double rate[2] = {0.015 * sine, -0.015 * cosine};
    double wanted[2];
    for (int i = 0; i < 2; ++i) {
      wanted[i] = -0.09 * at[i] + kv * (rate[i] - velocity[i]) + kp * (at[i] - seen[i]);
    }
    const double highest = std::sin(command_limit);
    const double most = std::floor(command_limit / command_step * (1 + 1e-12)) * command_step;
    const double phi = std::asin(std::clamp(1.4 / g * wanted[0], -highest, highest));
    const double theta =
        std::asin(std::clamp(-1.4 / g * wanted[1] / std::cos(phi), -highest, highest));
    given[0] = rounded_to(std::clamp(phi, -most, most), command_step);
    given[1] = rounded_to(std::clamp(theta, -most, most), command_step);
    rows[n] = {z[0], z[1], z[5], z[6], rig.command[0], rig.command[1]};
    if (n + 1 == hand_rows) return true;

    for (int half = 0; half < 2; ++half) {
      if (half == 1) {
        see(exposed);
        for (int i = 0; i < 2; ++i) {
          if (std::abs(given[i] - rig.command[i]) > dead_band) rig.command[i] = given[i];
        }
      }
      const double from = t + half * period / 2;
      integrator.advance(rig, z, from, from + period / 2);
      for (std::size_t i = 5; i < 7; ++i) {
        z[i] = std::clamp(z[i], -angle_limit, angle_limit);
        z[2 + i] = std::clamp(z[2 + i], -rate_limit, rate_limit);
      }
      if (std::abs(z[0]) > half_width || std::abs(z[1]) > half_depth) return false;
    }
  }
}

}  // namespace

bool run_by_hand(const HandRun& with, HandRow* rows) {
  return with.rtol > 0 ? run(Dopri5(with.rtol), with.noise, rows)
                       : run(Classical(), with.noise, rows);
}

}  // namespace bbsim::bench
