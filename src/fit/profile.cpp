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
          const std::vector<Index>& moving)
      : task_(task),
        windows_(windows),
        u_(u),
        direction_(covariance.col(k) / covariance(k, k)),
        k_(k),
        growth_(growth),
        linear_(std::sqrt(covariance(k, k) * growth)),
        least_(windows.residuals(u).squaredNorm()) {
    std::ranges::copy_if(moving, std::back_inserter(others_), [k](Index one) { return one != k; });
  }

  // The distance of the end on the side of `sign`.
  double distance(double sign) {
    const FreeKey& key = task_.keys[static_cast<std::size_t>(k_)];
    double step = linear_;
    constexpr int most_tries = 8;
    for (int i = 0; i < most_tries; ++i) {
      if (is_stopped(task_)) return linear_;
      VectorXd v = u_ + sign * step * direction_;
      // An end beyond a bound is the bound, unless the logs refute it.
      const double value = key.value(v[k_]);
      const bool at_bound = value == key.lower || value == key.upper;
      const double ratio = std::sqrt(growth_at(v, i) / growth_);
      if (!std::isfinite(ratio)) {
        step /= 2;
        continue;
      }
      if (at_bound && ratio <= 1) return step;
      // To second order, the way to the end is in proportion to the root of the growth.
      if (std::abs(ratio - 1) < 0.1 && (i == 0 || std::abs(ratio - 1) < 0.02)) return step / ratio;
      step *= std::clamp(1 / ratio, 0.2, 4.0);
      if (step > 30 * linear_) return std::numeric_limits<double>::infinity();
    }
    return step;
  }

 private:
  // With the other keys where the linearized problem has them, and if that is not enough, where
  // they are best.
  double growth_at(VectorXd& v, int round) {
    const double above = windows_.residuals(v).squaredNorm() - least_;
    const double most = 1.21 * growth_;  // a ratio of 1.1
    if (round == 0 && above <= most && above >= 0.81 * growth_) return above;
    std::size_t unheard = 0;
    if (!minimize(task_, windows_, others_, v, unheard)) return above;
    return std::max(windows_.residuals(v).squaredNorm() - least_, 1e-3 * growth_);
  }

  const Task& task_;
  WindowsFit& windows_;
  const VectorXd& u_;
  VectorXd direction_;
  Index k_;
  double growth_, linear_, least_;
  std::vector<Index> others_;
};

}  // namespace

Ends profile(const Task& task, WindowsFit& windows, const VectorXd& u,
             const Eigen::MatrixXd& covariance, Index k, double growth,
             const std::vector<Index>& moving) {
  Profile one(task, windows, u, covariance, k, growth, moving);
  return {u[k] - one.distance(-1), u[k] + one.distance(1)};
}

}  // namespace bbsim::fit
