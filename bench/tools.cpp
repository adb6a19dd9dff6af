// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tools.hpp"

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include "solve/cvode/cvode.hpp"
#include "solve/integrate.hpp"
#include "solve/radau/radau.hpp"

namespace bbsim::bench {
namespace {

bool run_radau(const Scene& scene, solve::Tolerances tolerances, Rows& rows) {
  return solve::integrate(scene.model, Method::radau, tolerances, scene.grid, rows, {}).ending ==
         solve::Ending::done;
}

template <Method method>
bool run_cvode(const Scene& scene, solve::Tolerances tolerances, Rows& rows) {
  return solve::integrate(scene.model, method, tolerances, scene.grid, rows, {}).ending ==
         solve::Ending::done;
}

// Integrates over the scene's grid with odeint's dopri5, with rows from its dense output. Returns
// false if it gives up.
template <class State, class Rates>
bool run_odeint(const Scene& scene, solve::Tolerances tolerances, const Rates& rates, Rows& rows) {
  namespace odeint = boost::numeric::odeint;
  State z;
  std::copy(scene.model.initial.begin(), scene.model.initial.end(), z.begin());
  std::size_t next = 0;
  const auto observe = [&](const State& at, double) {
    std::copy(at.begin(), at.end(), rows.row(next++));
  };
  constexpr double first_step = 0.01;  // s; adapted at once
  try {
    odeint::integrate_times(odeint::make_dense_output(tolerances.atol, tolerances.rtol,
                                                      odeint::runge_kutta_dopri5<State>()),
                            rates, z, scene.times.begin(), scene.times.end(), first_step, observe);
  } catch (const std::runtime_error&) {  // the step shrank to nothing
    return false;
  }
  return next == scene.grid.size();
}

// odeint at its best. The right-hand side is bbsim's, for the concrete system and inlined: no
// virtual call, no branch on the kind of scene. The state is an array of fixed size, so nothing is
// allocated and loops unroll. Rows come from dense output, so output times do not shorten steps. It
// is compiled with -O3, like bbsim's integrators.
bool run_dopri5(const Scene& scene, solve::Tolerances tolerances, Rows& rows) {
  return std::visit(
      [&](const auto& system) {
        using State = std::array<double, std::decay_t<decltype(system)>::size>;
        const auto rates = [&system](const State& at, State& slope, double t) {
          model::derivative(system, t, at.data(), slope.data());
        };
        return run_odeint<State>(scene, tolerances, rates, rows);
      },
      scene.model.system);
}

// The same with a right-hand side for one kind of scene. Both angles are sinusoids of one frequency
// about 0, so one sine and one cosine of time give them and their derivatives. Products shared by
// rows of (27) are computed once. Returns false for other scenes.
bool run_dopri5_by_hand(const Scene& scene, solve::Tolerances tolerances, Rows& rows) {
  using Open = model::OpenLoop<model::Shape::full>;
  const auto* const system = std::get_if<Open>(&scene.model.system);
  if (system == nullptr) return false;
  const model::SignalView motion = system->motion().view();
  const bool plain = motion.harmonic_count == 1 && !motion.shared.any() && motion.start[0] == 0 &&
                     motion.start[1] == 0 && motion.rate[0] == 0 && motion.rate[1] == 0;
  if (!plain) return false;
  const double w = motion.harmonics->frequency;
  const double a0 = motion.harmonics->sine[0], b0 = motion.harmonics->cosine[0];
  const double a1 = motion.harmonics->sine[1], b1 = motion.harmonics->cosine[1];
  const double r = scene.radius, g = scene.gravity, w2 = w * w;
  using State = std::array<double, 5>;  // x, y, x', y', u
  const auto rates = [=](const State& z, State& slope, double t) {
    const double sin = std::sin(w * t), cos = std::cos(w * t);
    const double phi = a0 * sin + b0 * cos, theta = a1 * sin + b1 * cos;
    const double p = w * (a0 * cos - b0 * sin), q = w * (a1 * cos - b1 * sin);
    const double pp = -w2 * phi, qq = -w2 * theta;
    const double sp = std::sin(phi), cp = std::cos(phi), st = std::sin(theta), ct = std::cos(theta);
    const double k = 1.0 / 7, five = 5 * k, pq = p * q, p_squared = p * p, spin = 2 * k * z[4];
    const double lever = five * z[1] * st, along = 12 * k * st * p;
    slope[0] = z[2];
    slope[1] = z[3];
    slope[2] = five * (g * sp + z[0] * p_squared) - (r * ct + lever) * pp -
               (2 * five * z[1] * ct - 12 * k * r * st) * pq - along * z[3] + spin * q;
    slope[3] = five * z[0] * st * pp + r * qq + (lever + five * r * ct) * st * p_squared +
               five * (z[1] * q * q - g * cp * st) + along * z[2] + spin * ct * p;
    slope[4] = r * (st * pp + ct * pq) - (q * z[2] + ct * p * z[3]);
  };
  return run_odeint<State>(scene, tolerances, rates, rows);
}

}  // namespace

const std::vector<Tool>& all_tools() {
  static const std::vector<Tool> tools{{"radau", run_radau},
                                       {"dopri5", run_dopri5},
                                       {"by hand", run_dopri5_by_hand},
                                       {"bdf", run_cvode<Method::bdf>},
                                       {"adams", run_cvode<Method::adams>}};
  return tools;
}

}  // namespace bbsim::bench
