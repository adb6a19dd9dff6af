// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/minimize.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <unsupported/Eigen/LevenbergMarquardt>
#include <utility>

#include "base/short_number.hpp"
#include "model/dense.hpp"

// Eigen's minimizer uses it; dense.cpp compiles it.
extern template class Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;

namespace bbsim::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The problem for Eigen's minimizer, in the keys that may move.
class Functor : public Eigen::DenseFunctor<double> {
 public:
  Functor(const Task& task, WindowsFit& windows, const VectorXd& u, std::vector<Index> moving,
          std::size_t& iterations)
      : DenseFunctor(static_cast<int>(moving.size()), static_cast<int>(windows.size())),
        task_(task),
        windows_(windows),
        u_(u),
        moving_(std::move(moving)),
        iterations_(iterations) {}

  int operator()(const VectorXd& v, VectorXd& residuals) {
    residuals = windows_.residuals(whole(v));
    cost_ = residuals.squaredNorm();
    return is_stopped(task_) ? -1 : 0;
  }

  int df(const VectorXd& v, MatrixXd& jacobian) {
    const MatrixXd projected = windows_.derivatives(whole(v)).projected;
    jacobian.resize(projected.rows(), static_cast<Index>(moving_.size()));
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      jacobian.col(static_cast<Index>(i)) = projected.col(moving_[i]);
    }
    ++iterations_;
    if (task_.progress) {
      const auto done = static_cast<double>(iterations_);
      const double rms = std::sqrt(cost_ / static_cast<double>(windows_.size()));
      task_.progress(done / (done + 5), "iteration " + std::to_string(iterations_) +
                                            ", rms residual " + rounded(rms, 4) + " noise");
    }
    return is_stopped(task_) ? -1 : 0;
  }

  [[nodiscard]] VectorXd whole(const VectorXd& v) const {
    VectorXd u = u_;
    for (std::size_t i = 0; i < moving_.size(); ++i) u[moving_[i]] = v[static_cast<Index>(i)];
    return u;
  }

 private:
  const Task& task_;
  WindowsFit& windows_;
  const VectorXd& u_;
  std::vector<Index> moving_;
  std::size_t& iterations_;
  double cost_ = 0;
};

}  // namespace

bool is_stopped(const Task& task) {
  return task.stop != nullptr && task.stop->load(std::memory_order_relaxed);
}

bool is_at_bound(const FreeKey& key, double u) {
  const double value = key.value(u);
  const bool positive = key.logarithmic && key.lower == 0;
  return (value == key.lower && !positive) || value == key.upper;
}

bool minimize(const Task& task, WindowsFit& windows, std::vector<Index> moving, VectorXd& u,
              std::size_t& iterations) {
  while (!moving.empty()) {
    Functor functor(task, windows, u, moving, iterations);
    Eigen::LevenbergMarquardt<Functor> method(functor);
    method.setFtol(1e-12);
    method.setXtol(1e-9);
    method.setFactor(1000);
    method.setMaxfev(200);
    VectorXd v(static_cast<Index>(moving.size()));
    for (std::size_t i = 0; i < moving.size(); ++i) v[static_cast<Index>(i)] = u[moving[i]];
    method.minimize(v);
    u = functor.whole(v);
    if (is_stopped(task)) return false;
    std::vector<Index> rest;
    for (const Index k : moving) {
      const FreeKey& key = task.keys[static_cast<std::size_t>(k)];
      if (is_at_bound(key, u[k])) {
        u[k] = key.number(key.value(u[k]));
      } else {
        rest.push_back(k);
      }
    }
    if (rest.size() == moving.size()) return true;
    moving = std::move(rest);
  }
  return true;
}

bool follow(const Task& task, WindowsFit& windows, VectorXd& u) {
  const MatrixXd known = windows.known_derivatives().projected;
  if (known.cols() != u.size()) return false;
  std::vector<Index> moving;
  for (Index k = 0; k < u.size(); ++k) {
    if (!is_at_bound(task.keys[static_cast<std::size_t>(k)], u[k])) moving.push_back(k);
  }
  if (moving.empty()) return true;
  MatrixXd jacobian(known.rows(), static_cast<Index>(moving.size()));
  VectorXd sizes(jacobian.cols());
  for (Index i = 0; i < jacobian.cols(); ++i) {
    const auto column = known.col(moving[static_cast<std::size_t>(i)]);
    sizes[i] = std::max(column.norm(), 1e-300);
    jacobian.col(i) = column / sizes[i];
  }
  // Directions that the residuals hardly determine stay fixed.
  const model::LeastSquares solver(jacobian, 1e-4);
  VectorXd residuals = windows.residuals(u);
  double last = std::numeric_limits<double>::infinity();
  constexpr int most_steps = 10;
  for (int i = 0; i < most_steps; ++i) {
    if (is_stopped(task)) return false;
    const VectorXd step = solver.solve(residuals);
    const double gain = (jacobian * step).squaredNorm();
    if (gain <= 1e-12 * residuals.squaredNorm()) return true;
    // Each step must gain much less than the one before.
    if (gain > 0.1 * last) return false;
    last = gain;
    VectorXd to = u;
    for (Index k = 0; k < step.size(); ++k) {
      const Index key = moving[static_cast<std::size_t>(k)];
      to[key] -= step[k] / sizes[k];
      if (is_at_bound(task.keys[static_cast<std::size_t>(key)], to[key])) return false;
    }
    u = to;
    residuals = windows.residuals(u);
  }
  return false;
}

}  // namespace bbsim::fit
