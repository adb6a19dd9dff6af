// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/minimize.hpp"

namespace bbsim::fit {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

class Profile {
 public:
  Profile(const Task& task, WindowsFit& windows, const VectorXd& u,
          const Eigen::MatrixXd& covariance, Index k, double growth,
          const std::vector<Index>& moving, std::size_t& iterations)
      : task_(task),
        windows_(windows),
        u_(u),
        direction_(covariance.col(k) / covariance(k, k)),
        k_(k),
        growth_(growth),
        linear_(std::sqrt(covariance(k, k) * growth)),
        least_(windows.residuals(u).squaredNorm()),
        iterations_(iterations) {
    std::ranges::copy_if(moving, std::back_inserter(others_), [k](Index one) { return one != k; });
  }

  // The distance of the end on the side of `sign`.
  double distance(double sign) {
    const VectorXd linear = u_ + sign * linear_ * direction_;
    // Mostly the other keys are best where the linearized problem has them.
    const double first = ratio_at(linear);
    if (std::abs(first - 1) < 0.1) return linear_ / first;
    if (is_at_bound(linear) && first <= 1) return linear_;
    // Otherwise step by step: the way from the optimum through the step before leads to the next.
    VectorXd towards = sign * direction_;
    double step = linear_ / 2;
    double inside = 0, outside = std::numeric_limits<double>::infinity();
    constexpr int most_steps = 10;
    for (int i = 0; i < most_steps; ++i) {
      if (is_stopped(task_)) return linear_;
      VectorXd v = u_ + step * towards;
      const bool at_bound = is_at_bound(v);
      // To 1 % of the growth.
      const Precision enough{0.01 * growth_ / (least_ + growth_), 1e-4, 15};
      static_cast<void>(minimize(task_, windows_, others_, v, iterations_, enough));
      const double ratio = ratio_at(v);
      if (std::abs(ratio - 1) < 0.03) return step / ratio;
      // An end beyond a bound is the bound.
      if (at_bound && ratio <= 1) return step;
      if (step > 30 * linear_) return std::numeric_limits<double>::infinity();
      if (ratio < 1) {
        inside = step;
        towards = (v - u_) / step;
      } else {
        outside = step;
      }
      if (outside - inside < 0.02 * linear_) break;
      step *= std::clamp(1 / ratio, 0.4, 2.0);
      // Where another key comes to a bound, the growth has a corner: no step leaves the bracket.
      const double margin = 0.1 * (outside - inside);
      if (std::isfinite(outside) && (step < inside + margin || step > outside - margin)) {
        step = (inside + outside) / 2;
      }
    }
    return step;
  }

 private:
  [[nodiscard]] bool is_at_bound(const VectorXd& v) const {
    const FreeKey& key = task_.keys[static_cast<std::size_t>(k_)];
    const double value = key.value(v[k_]);
    return value == key.lower || value == key.upper;
  }

  // How far `v` is on the way to the end: to second order, the root of the growth.
  [[nodiscard]] double ratio_at(const VectorXd& v) {
    const double above = windows_.residuals(v).squaredNorm() - least_;
    return std::sqrt(std::max(above, 1e-6 * growth_) / growth_);
  }

  const Task& task_;
  WindowsFit& windows_;
  const VectorXd& u_;
  VectorXd direction_;
  Index k_;
  double growth_, linear_, least_;
  std::size_t& iterations_;
  std::vector<Index> others_;
};

}  // namespace

Ends profile(const Task& task, WindowsFit& windows, const VectorXd& u,
             const Eigen::MatrixXd& covariance, Index k, double growth,
             const std::vector<Index>& moving, std::size_t& iterations) {
  Profile one(task, windows, u, covariance, k, growth, moving, iterations);
  return {u[k] - one.distance(-1), u[k] + one.distance(1)};
}

}  // namespace bbsim::fit
