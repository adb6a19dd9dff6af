// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Open loops over the frequency, for a Bode plot.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>

#include "model/control/linearize.hpp"
#include "model/eigenvalues.hpp"

namespace bbsim::model {
namespace {

using Complex = std::complex<double>;

// The phase nearest to the one before; NaN beside a pole.
double without_jump(double phase, double before) {
  constexpr double turn = 2 * std::numbers::pi;
  return phase - turn * std::round((phase - before) / turn);
}

// The places of those points that a picture needs: others are near the last one in all curves.
std::vector<std::size_t> needed_points(const OpenLoops& all) {
  constexpr double step = 0.12, turn = 0.05, ratio = 1.12;  // of log gain, rad; of frequencies
  std::vector<std::size_t> kept{0};
  for (std::size_t i = 1; i < all.frequencies.size(); ++i) {
    const std::size_t last = kept.back();
    const bool moved = std::ranges::any_of(all.curves, [&](const OpenLoops::Curve& curve) {
      return !(std::abs(std::log(curve.gain[i] / curve.gain[last])) < step &&
               std::abs(curve.phase[i] - curve.phase[last]) < turn);
    });
    const bool ends = i + 1 == all.frequencies.size();
    if (moved || ends || all.frequencies[i] > ratio * all.frequencies[last]) kept.push_back(i);
  }
  return kept;
}

std::vector<double> picked(const std::vector<double>& values,
                           const std::vector<std::size_t>& places) {
  std::vector<double> some;
  for (const std::size_t i : places) some.push_back(values[i]);
  return some;
}

}  // namespace

std::vector<double> open_loop_frequencies(const Linearization& linearization) {
  std::vector<Complex> open, closed;
  const auto add = [](std::vector<Complex>& all, const Eigen::MatrixXd& a) {
    const std::vector<Complex> some = eigenvalues_of(a);
    all.insert(all.end(), some.begin(), some.end());
  };
  for (const LoopMargins& loop : linearization.margins) {
    add(open, loop.open.a);
    add(closed, loop.open.a - loop.open.b * loop.open.c);
  }
  if (open.empty()) return {};
  const double period = linearization.system.period.value_or(0);
  std::vector<double> points = frequencies_to_look_at(open, closed, period);
  std::vector<double> sizes;  // of poles, as rates
  open.insert(open.end(), closed.begin(), closed.end());
  for (const Complex& pole : open) {
    if (period > 0 && !(std::abs(pole) > 1e-6)) continue;
    sizes.push_back(std::abs(period > 0 ? std::log(pole) / period : pole));
  }
  if (sizes.empty() || points.empty()) return points;
  constexpr double far = 30;
  const double fastest = *std::max_element(sizes.begin(), sizes.end());
  std::erase_if(sizes, [fastest](double size) { return !(size > 1e-6 * fastest); });
  if (sizes.empty()) return points;
  const double low = *std::min_element(sizes.begin(), sizes.end()) / far,
               high = std::max(fastest * far, period > 0 ? points.back() : 0);
  std::erase_if(points, [=](double w) { return w < low || w > high; });
  return points;
}

OpenLoops open_loops(const Linearization& linearization) {
  OpenLoops all;
  if (linearization.margins.empty()) return all;
  const double period = linearization.system.period.value_or(0);
  all.frequencies = open_loop_frequencies(linearization);
  for (const LoopMargins& loop : linearization.margins) {
    const LinearSystem& open = loop.open;
    const FrequencyResponse response(open.a, open.b, open.c, open.d, period);
    OpenLoops::Curve curve;
    double before = -0.75 * std::numbers::pi;
    for (const double w : all.frequencies) {
      const Complex value = response.at(w, 0, 0);
      curve.gain.push_back(std::abs(value));
      curve.phase.push_back(without_jump(std::arg(value), before));
      if (std::isfinite(curve.phase.back())) before = curve.phase.back();
    }
    all.curves.push_back(std::move(curve));
  }
  if (all.frequencies.empty()) return all;
  const std::vector<std::size_t> places = needed_points(all);
  for (OpenLoops::Curve& curve : all.curves) {
    curve = {picked(curve.gain, places), picked(curve.phase, places)};
  }
  all.frequencies = picked(all.frequencies, places);
  return all;
}

}  // namespace bbsim::model
