// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One step of Radau IIA collocation in quad precision.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "base/quad.hpp"
#include "model/dense.hpp"

namespace bbsim::study {

// The tables of the method on the unit interval: Hairer and Wanner, Solving Ordinary Differential
// Equations II, IV.5. The collocation polynomial u has degree s and is given by its values at 0,
// c_1, ..., c_s = 1. The method is L-stable, so a stiff transient decays within a step. A Gauss
// method would carry its remainder along, and the steps could not grow.
struct RadauRule {
  // `s` is at least 2. Beyond 40 the barycentric weights lose digits.
  explicit RadauRule(int s);

  int stages;
  std::vector<Quad> nodes;           // c_i, increasing within (0, 1]
  std::vector<Quad> matrix;          // a_ij = integral of Lagrange's l_j from 0 to c_i, row-major
  Eigen::MatrixXd matrix_in_double;  // the same, rounded
  std::vector<Quad> barycentric;     // s + 1 weights of interpolation at 0, c_1, ..., c_s
  // Legendre coefficients of u from its increments u(c_i) - u(0): sum of row[i] (u(c_i) - u(0)).
  std::vector<Quad> last_coefficient;  // of degree s
  std::vector<Quad>
      previous_coefficient;  // of degree s - 1, of the polynomial through c_1, ..., c_s
  // Row k gives the Legendre coefficient of degree k < s from values at c_1, ..., c_s.
  std::vector<Quad> to_legendre;
};

// z' = f(t, z) in both precisions, and df/dz.
class Equation {
 public:
  virtual ~Equation() = default;
  [[nodiscard]] virtual int size() const = 0;
  virtual void derivative(double t, const double* z, double* dz) const = 0;
  virtual void derivative(Quad t, const Quad* z, Quad* dz) const = 0;
  [[nodiscard]] virtual Eigen::MatrixXd jacobian(double t, const double* z) const = 0;

  // Later times count as this one (s), so that a step that ends at a jump of f does not see it.
  double latest = std::numeric_limits<double>::infinity();
};

// Solves W_i = h sum_j a_ij f(t + c_j h, z + W_j) for the stages W_i. Newton's iteration with the
// exact Jacobian solves them in double first. The residual is then computed in quad and corrected
// with the same factors in double, as in iterative refinement of a linear system. Each pass gains
// about as many digits as the condition of the system leaves to a double.
class CollocationStep {
 public:
  // Solves stages to well below `tolerance`, relative to 1 + |z| in each state's unit.
  CollocationStep(const Equation& equation, const RadauRule& rule, double tolerance);

  // Makes a step of length h from z at t. Returns the estimated error of the collocation polynomial
  // in the unit of the tolerance, or infinity if the iteration does not converge. If the estimate
  // exceeds the tolerance, the stages may not be refined.
  [[nodiscard]] double solve(Quad t, Quad h, const std::vector<Quad>& z);

  // The state at t + fraction h of the last step.
  void state_at(Quad fraction, Quad* z) const;

  // The integral of one state over the last step, from t to t + fraction h.
  class Integral {
   public:
    Integral(const CollocationStep& step, int state);
    [[nodiscard]] Quad to(Quad fraction) const;

   private:
    Quad h_, start_;
    std::vector<Quad> legendre_;  // coefficients of the increment
  };

 private:
  [[nodiscard]] bool solve_in_double(double* correction);
  [[nodiscard]] bool refine();
  void factorise();
  void residual_in_double();
  void residual_in_quad();
  [[nodiscard]] double norm(const Eigen::VectorXd& correction) const;
  template <class Real>
  [[nodiscard]] double tail(const std::vector<Real>& increments) const;

  const Equation& equation_;
  const RadauRule& rule_;
  double tolerance_;
  Eigen::Index n_;  // number of states

  Quad t_ = 0.0, h_ = 0.0;
  std::vector<Quad> z_;
  Eigen::VectorXd scale_;            // 1 + |z|
  std::vector<double> w_in_double_;  // stage after stage
  std::vector<Quad> w_, slopes_;
  Eigen::VectorXd residual_;
  model::Elimination factors_;
};

}  // namespace bbsim::study
