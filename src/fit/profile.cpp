// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/profile.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fit/minimize.hpp"
#include "model/dense.hpp"

namespace bbsim::fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {}  // namespace

struct Profiles::Point {
  VectorXd u, residuals;
  MatrixXd jacobian;
};

struct Profiles::Step {
  VectorXd by;               // change of all keys
  bool at_bound = false;     // the key reaches its bound
  double reach = unlimited;  // change of the key without bound or limit
  double slack = 0;          // decrease of the sum of squares that the other keys still allow
};

Profiles::Profiles(const Task& task, const WindowsFit& windows, const VectorXd& u,
                   const WindowsFit::Derivatives& derivatives)
    : task_(task),
      windows_(windows),
      u_(u),
      jacobian_(derivatives.projected),
      lower_(u.size()),
      upper_(u.size()) {
  for (Index k = 0; k < u.size(); ++k) {
    const FreeKey& key = task.keys[static_cast<std::size_t>(k)];
    lower_[k] = key.number(key.lower);
    upper_[k] = key.number(key.upper);
  }
  WindowsFit at_optimum = windows;
  residuals_ = at_optimum.residuals(u);
  least_ = residuals_.squaredNorm();
}

// Step to where the linearized residuals have the sum of squares `target`, with the other keys
// optimal. The key moves at most `most` away from the optimum.
Profiles::Step Profiles::step_from(const Point& from, Index k, double sign, double target,
                                   double most) const {
  Step step{VectorXd::Zero(u_.size())};
  std::vector<Index> free;
  for (Index i = 0; i < u_.size(); ++i) {
    if (i != k) free.push_back(i);
  }
  VectorXd residuals = from.residuals;  // with the keys at a bound fixed
  for (;;) {
    // Directions that are hardly determined stay fixed, as in the covariance.
    const VectorXd sizes = from.jacobian.colwise().norm().cwiseMax(1e-300);
    MatrixXd others(residuals.size(), static_cast<Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i) {
      others.col(static_cast<Index>(i)) = from.jacobian.col(free[i]) / sizes[free[i]];
    }
    const VectorXd column = from.jacobian.col(k);
    VectorXd by_residuals, by_column, rest = residuals, effect = column;
    if (!free.empty()) {
      const model::LeastSquares solver(others, 1e-4);
      by_residuals = solver.solve(residuals);
      by_column = solver.solve(column);
      rest -= others * by_residuals;
      effect -= others * by_column;
    }
    // The key's step d solves |rest + effect d|^2 = target.
    const double a = std::max(effect.squaredNorm(), 1e-300), b = effect.dot(rest);
    const double inside = b * b - a * (rest.squaredNorm() - target);
    const double key_step = (-b + sign * std::sqrt(std::max(inside, 0.0))) / a;
    step.slack = residuals.squaredNorm() - rest.squaredNorm();
    const double reached = from.u[k] - u_[k];
    step.reach = sign * (reached + key_step);
    double to = sign * std::min(step.reach, most);
    step.at_bound = u_[k] + to <= lower_[k] || u_[k] + to >= upper_[k];
    to = std::clamp(u_[k] + to, lower_[k], upper_[k]) - u_[k];
    step.by[k] = to - reached;

    std::vector<Index> rest_of_free;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const Index key = free[i];
      const auto row = static_cast<Index>(i);
      const double goes = -(by_residuals[row] + by_column[row] * step.by[k]) / sizes[key];
      const double goal = from.u[key] + goes;
      step.by[key] = std::clamp(goal, lower_[key], upper_[key]) - from.u[key];
      if (goal > lower_[key] && goal < upper_[key]) rest_of_free.push_back(key);
    }
    if (rest_of_free.size() == free.size()) return step;
    for (const Index key : free) {
      if (std::ranges::find(rest_of_free, key) == rest_of_free.end()) {
        residuals += from.jacobian.col(key) * step.by[key];
      }
    }
    free = std::move(rest_of_free);
  }
}

// Distance of the end from the optimum, on the side of `sign`.
double Profiles::distance(Index k, double growth, double sign) const {
  const double target = least_ + growth;
  // Fraction of the way to the end: to second order, the root of the growth.
  const auto ratio_at = [&](const VectorXd& residuals) {
    const double above = residuals.squaredNorm() - least_;
    return std::sqrt(std::max(above, 1e-6 * growth) / growth);
  };
  WindowsFit windows = windows_;
  Point at{u_, residuals_, jacobian_};
  Step step = step_from(at, k, sign, target, unlimited);
  const double linear = step.reach;
  double inside = 0, outside = unlimited, gone = 0;
  constexpr int most_steps = 20;
  for (int i = 0; i < most_steps; ++i) {
    if (is_stopped(task_)) return linear;
    const VectorXd to = at.u + step.by;
    gone = sign * (to[k] - u_[k]);
    const VectorXd residuals = windows.residuals(to);
    const double ratio = ratio_at(residuals);
    // A full step would oscillate if the residuals are far from linear.
    const double expected = (at.residuals + at.jacobian * step.by).squaredNorm();
    const double excess = residuals.squaredNorm() - expected;
    if (excess > std::max(growth, step.slack / 2)) {
      step.by /= 2;
      step.at_bound = false;
      continue;
    }
    // The other keys are mostly optimal where the linear problem puts them.
    Point next{to, residuals, at.jacobian};
    const bool is_bound = step.at_bound && ratio <= 1;
    if (is_bound || std::abs(ratio - 1) < (i == 0 ? 0.1 : 0.03)) {
      const double slack = step_from(next, k, sign, target, unlimited).slack;
      if (slack < 0.06 * growth) return is_bound ? gone : gone / ratio;
    }
    if (gone > 30 * linear) return unlimited;
    next.jacobian = windows.derivatives(to).projected;
    at = std::move(next);
    step = step_from(at, k, sign, target, unlimited);
    const double best = std::sqrt(std::max(at.residuals.squaredNorm() - step.slack - least_, 0.0));
    if (best < std::sqrt(growth)) {
      inside = std::max(inside, gone);
    } else {
      outside = std::min(outside, gone);
    }
    double most = std::clamp(step.reach, 0.3 * gone, 2.5 * gone);
    const double margin = 0.1 * (outside - inside);
    if (std::isfinite(outside) && (most < inside + margin || most > outside - margin)) {
      most = (inside + outside) / 2;
    }
    if (outside - inside < 0.02 * linear) return most;
    step = step_from(at, k, sign, target, most);
  }
  return gone;
}

Ends Profiles::ends(Index k, double growth) const {
  return {u_[k] - distance(k, growth, -1), u_[k] + distance(k, growth, 1)};
}

}  // namespace bbsim::fit
