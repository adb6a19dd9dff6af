// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/quad_step.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/real.hpp"

namespace bbsim::study {
namespace {

// P_0(x), ..., P_{count - 1}(x).
void legendre(Quad x, int count, Quad* values) {
  values[0] = 1.0;
  if (count > 1) values[1] = x;
  for (int k = 1; k + 1 < count; ++k) {
    values[k + 1] = ((2 * k + 1) * x * values[k] - k * values[k - 1]) / (k + 1);
  }
}

// The right Radau points on (-1, 1], increasing: the roots of P_s - P_{s-1}. Newton's iteration
// starts from the Chebyshev-Radau points.
std::vector<Quad> radau_points(int s) {
  std::vector<Quad> roots;
  std::vector<Quad> p(static_cast<std::size_t>(s) + 1);
  for (int i = s - 1; i > 0; --i) {
    Quad x = std::cos(2 * std::numbers::pi * i / (2 * s - 1));
    // The guess has two digits, and each pass doubles them. 113 bits are 34 digits.
    for (int pass = 0; pass < 7; ++pass) {
      legendre(x, s + 1, p.data());
      const Quad slope = s * (x * p[s] - p[s - 1]) - (s - 1) * (x * p[s - 1] - p[s - 2]);
      x -= (p[s] - p[s - 1]) * (x * x - 1) / slope;
    }
    roots.push_back(x);
  }
  roots.emplace_back(1.0);
  return roots;
}

// The binomial coefficient of 2s over s.
Quad central_binomial(int s) {
  Quad value = 1.0;
  for (int i = 1; i <= s; ++i) value = value * (s + i) / i;
  return value;
}

// The factors are kept while each pass reduces the error at least by this factor. Another pass in
// quad costs a tenth of new factors.
constexpr double worth_keeping = 0.05;

}  // namespace

RadauRule::RadauRule(int s) : stages(s), matrix_in_double(s, s) {
  const std::vector<Quad> roots = radau_points(s);
  const std::size_t size = roots.size();
  // p[i * (s + 1) + k] = P_k at root i.
  std::vector<Quad> p(size * (size + 1));
  std::vector<Quad> weights;  // of the quadrature on (0, 1)
  for (std::size_t i = 0; i < size; ++i) {
    const Quad x = roots[i];
    Quad* row = &p[i * (size + 1)];
    legendre(x, s + 1, row);
    nodes.push_back((1 + x) / 2);
    const Quad scaled = s * row[size - 1];
    weights.push_back((1 + x) / (2 * scaled * scaled));
  }

  // l_j = w_j sum_k (2k + 1) P_k(x_j) P_k, and the integral of (2k + 1) P_k from -1 is P_{k+1} -
  // P_{k-1}.
  matrix.resize(size * size);
  for (std::size_t i = 0; i < size; ++i) {
    const Quad* at_i = &p[i * (size + 1)];
    for (std::size_t j = 0; j < size; ++j) {
      const Quad* at_j = &p[j * (size + 1)];
      Quad sum = 2 * nodes[i];
      for (std::size_t k = 1; k < size; ++k) sum += at_j[k] * (at_i[k + 1] - at_i[k - 1]);
      const Quad a = weights[j] * sum / 2;
      matrix[i * size + j] = a;
      matrix_in_double(static_cast<int>(i), static_cast<int>(j)) = plain(a);
    }
  }

  to_legendre.resize(size * size);
  for (std::size_t k = 0; k < size; ++k) {
    for (std::size_t j = 0; j < size; ++j) {
      to_legendre[k * size + j] =
          (2.0 * static_cast<double>(k) + 1) * weights[j] * p[j * (size + 1) + k];
    }
  }

  std::vector<Quad> points{0.0};
  points.insert(points.end(), nodes.begin(), nodes.end());
  for (const Quad& point : points) {
    Quad product = 1.0;
    for (const Quad& other : points) {
      if (!(other == point)) product *= point - other;
    }
    barycentric.push_back(1 / product);
  }
  // The barycentric sum is the leading coefficient of the interpolant. The leading coefficient of
  // P_k(2t - 1) is the binomial coefficient of 2k over k. Without the point 0, each weight regains
  // the factor of that point.
  for (std::size_t i = 0; i < size; ++i) {
    last_coefficient.push_back(barycentric[i + 1] / central_binomial(s));
    previous_coefficient.push_back(barycentric[i + 1] * nodes[i] / central_binomial(s - 1));
  }
}

CollocationStep::CollocationStep(const Equation& equation, const RadauRule& rule, double tolerance)
    : equation_(equation),
      rule_(rule),
      tolerance_(tolerance),
      n_(equation.size()),
      z_(static_cast<std::size_t>(n_)),
      scale_(n_),
      w_in_double_(static_cast<std::size_t>(n_ * rule.stages)),
      w_(w_in_double_.size()),
      slopes_(w_in_double_.size()),
      residual_(n_ * rule.stages) {}

double CollocationStep::solve(Quad t, Quad h, const std::vector<Quad>& z) {
  t_ = t;
  h_ = h;
  z_ = z;
  for (Eigen::Index i = 0; i < n_; ++i) scale_[i] = 1 + std::abs(plain(z_[i]));

  double correction = 0;
  if (!solve_in_double(&correction)) return infinity;
  // The error visible in double, above the noise of the iteration, may be enough to reject the
  // step.
  const double seen = tail(w_in_double_);
  if (!(seen <= std::max({tolerance_, 1e3 * correction, 1e-11}))) return seen;

  std::copy(w_in_double_.begin(), w_in_double_.end(), w_.begin());
  if (!refine()) return infinity;
  return tail(w_);
}

// Starts from W = 0. `correction`: the size of the last correction.
bool CollocationStep::solve_in_double(double* correction) {
  std::fill(w_in_double_.begin(), w_in_double_.end(), 0.0);
  factorise();
  Eigen::Map<Eigen::VectorXd> w(w_in_double_.data(), residual_.size());
  double last = infinity;
  for (Eigen::Index pass = 0, growing = 0; pass < 25; ++pass) {
    residual_in_double();
    const Eigen::VectorXd change = factors_.solve(residual_);
    w -= change;
    *correction = norm(change);
    if (!std::isfinite(*correction) || *correction > 1e6) return false;
    const double contraction = *correction / last;
    if (*correction < 1e-13) return true;
    if (*correction < 1e-8 && contraction > 0.3) return true;  // rounding
    if (contraction > 1 && pass > 1 && ++growing > 2) return false;
    if (pass > 0 && contraction > worth_keeping) factorise();
    last = *correction;
  }
  return false;
}

bool CollocationStep::refine() {
  // Far enough below the tolerance not to show in the error estimate.
  const double goal = std::max(1e-4 * tolerance_, 16 * Quad::epsilon());
  double last = 0;
  for (Eigen::Index pass = 0; pass < 40; ++pass) {
    residual_in_quad();
    const Eigen::VectorXd change = factors_.solve(residual_);
    for (std::size_t i = 0; i < w_.size(); ++i) w_[i] -= change[static_cast<Eigen::Index>(i)];
    const double correction = norm(change);
    if (!std::isfinite(correction)) return false;
    const double contraction = pass == 0 ? 1 : correction / last;
    if (correction * std::min(1.0, contraction) < goal) return true;
    if (contraction > 1) return false;
    if (pass > 0 && contraction > worth_keeping) {
      for (std::size_t i = 0; i < w_.size(); ++i) w_in_double_[i] = plain(w_[i]);
      factorise();
    }
    last = correction;
  }
  return false;
}

// Factors I - h A (x) J, with the Jacobian of each stage.
void CollocationStep::factorise() {
  const Eigen::Index s = rule_.stages;
  const double t = plain(t_), h = plain(h_);
  Eigen::MatrixXd matrix(n_ * s, n_ * s);
  std::vector<double> z(z_.size());
  for (Eigen::Index j = 0; j < s; ++j) {
    for (Eigen::Index p = 0; p < n_; ++p) z[p] = plain(z_[p]) + w_in_double_[j * n_ + p];
    const Eigen::MatrixXd jacobian =
        h * equation_.jacobian(t + plain(rule_.nodes[j]) * h, z.data());
    for (Eigen::Index i = 0; i < s; ++i) {
      matrix.block(i * n_, j * n_, n_, n_) = -rule_.matrix_in_double(i, j) * jacobian;
    }
  }
  matrix.diagonal().array() += 1;
  factors_ = model::Elimination(matrix);
}

void CollocationStep::residual_in_double() {
  const Eigen::Index s = rule_.stages;
  const double t = plain(t_), h = plain(h_);
  Eigen::MatrixXd slopes(n_, s);
  std::vector<double> z(z_.size());
  for (Eigen::Index j = 0; j < s; ++j) {
    for (Eigen::Index p = 0; p < n_; ++p) z[p] = plain(z_[p]) + w_in_double_[j * n_ + p];
    equation_.derivative(t + plain(rule_.nodes[j]) * h, z.data(), slopes.col(j).data());
  }
  const Eigen::Map<const Eigen::MatrixXd> w(w_in_double_.data(), n_, s);
  Eigen::Map<Eigen::MatrixXd>(residual_.data(), n_, s) =
      w - h * slopes * rule_.matrix_in_double.transpose();
}

void CollocationStep::residual_in_quad() {
  const Eigen::Index s = rule_.stages;
  std::vector<Quad> z(z_.size());
  for (Eigen::Index j = 0; j < s; ++j) {
    Quad* slope = &slopes_[j * n_];
    for (Eigen::Index p = 0; p < n_; ++p) z[p] = z_[p] + w_[j * n_ + p];
    equation_.derivative(t_ + rule_.nodes[j] * h_, z.data(), slope);
    for (Eigen::Index p = 0; p < n_; ++p) slope[p] *= h_;
  }
  for (Eigen::Index i = 0; i < s; ++i) {
    const Quad* a = &rule_.matrix[i * s];
    for (Eigen::Index p = 0; p < n_; ++p) {
      Quad sum = w_[i * n_ + p];
      for (Eigen::Index j = 0; j < s; ++j) sum -= a[j] * slopes_[j * n_ + p];
      residual_[i * n_ + p] = plain(sum);
    }
  }
}

double CollocationStep::norm(const Eigen::VectorXd& correction) const {
  const Eigen::Map<const Eigen::MatrixXd> by_stage(correction.data(), n_, rule_.stages);
  return (by_stage.array().abs().colwise() / scale_.array()).maxCoeff<Eigen::PropagateNaN>();
}

// The error of the polynomial, from its Legendre coefficients. In a step of reasonable length they
// fall by a factor of five or more per degree, so the last one bounds the remainder. If symmetry
// makes the last one vanish, a tenth of the one before replaces it.
template <class Real>
double CollocationStep::tail(const std::vector<Real>& increments) const {
  double largest = 0;
  for (Eigen::Index p = 0; p < n_; ++p) {
    Quad last = 0.0, previous = 0.0;
    for (Eigen::Index j = 0; j < rule_.stages; ++j) {
      last += rule_.last_coefficient[j] * increments[j * n_ + p];
      previous += rule_.previous_coefficient[j] * increments[j * n_ + p];
    }
    const double error = std::max(std::abs(plain(last)), 0.1 * std::abs(plain(previous)));
    if (!std::isfinite(error)) return infinity;
    largest = std::max(largest, error / scale_[p]);
  }
  return largest;
}

void CollocationStep::state_at(Quad fraction, Quad* z) const {
  // Barycentric interpolation of W, which is 0 at 0.
  std::vector<Quad> shares(w_.size() / n_);
  Quad sum = 0.0;
  for (Eigen::Index i = -1; i < rule_.stages; ++i) {
    const Quad distance = i < 0 ? fraction : fraction - rule_.nodes[i];
    if (distance == Quad(0.0)) {
      for (Eigen::Index p = 0; p < n_; ++p) z[p] = i < 0 ? z_[p] : z_[p] + w_[i * n_ + p];
      return;
    }
    const Quad share = rule_.barycentric[i + 1] / distance;
    if (i >= 0) shares[i] = share;
    sum += share;
  }
  for (Eigen::Index p = 0; p < n_; ++p) {
    Quad weighted = 0.0;
    for (Eigen::Index i = 0; i < rule_.stages; ++i) weighted += shares[i] * w_[i * n_ + p];
    z[p] = z_[p] + weighted / sum;
  }
}

CollocationStep::Integral::Integral(const CollocationStep& step, int state)
    : h_(step.h_), start_(step.z_[state]) {
  const Eigen::Index s = step.rule_.stages;
  for (Eigen::Index k = 0; k < s; ++k) {
    Quad coefficient = 0.0;
    for (Eigen::Index j = 0; j < s; ++j) {
      coefficient += step.rule_.to_legendre[k * s + j] * step.w_[j * step.n_ + state];
    }
    legendre_.push_back(coefficient);
  }
}

Quad CollocationStep::Integral::to(Quad fraction) const {
  const std::size_t s = legendre_.size();
  std::vector<Quad> p(s + 1);
  legendre(2 * fraction - 1, static_cast<int>(s) + 1, p.data());
  // The integral of P_k(2t - 1) from 0 is (P_{k+1} - P_{k-1}) / (2 (2k + 1)).
  Quad sum = legendre_[0] * fraction;
  for (std::size_t k = 1; k < s; ++k) {
    sum += legendre_[k] * (p[k + 1] - p[k - 1]) / (4.0 * static_cast<double>(k) + 2);
  }
  return h_ * (fraction * start_ + sum);
}

}  // namespace bbsim::study
