// The table of the Rosenbrock method: its order conditions (Hairer and Wanner, Solving Ordinary
// Differential Equations II, IV.7), for autonomous and other systems, and its stability at
// infinity.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "catch.hpp"
#include "solve/rosenbrock/rodas5p.hpp"

namespace {

using Table = bbsim::solve::rosenbrock::Rodas5P<void>;
constexpr std::size_t s = 8;
using Vector = std::array<double, s>;
using Matrix = std::array<Vector, s>;

Vector operator*(const Matrix& a, const Vector& b) {
  Vector c{};
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < s; ++j) c[i] += a[i][j] * b[j];
  }
  return c;
}

Vector operator*(const Vector& a, const Vector& b) {
  Vector c{};
  for (std::size_t i = 0; i < s; ++i) c[i] = a[i] * b[i];
  return c;
}

double dot(const Vector& a, const Vector& b) {
  double total = 0;
  for (std::size_t i = 0; i < s; ++i) total += a[i] * b[i];
  return total;
}

// The solution x of x L = b, L lower triangular.
Vector solve_left(const Vector& b, const Matrix& l) {
  Vector x{};
  for (std::size_t i = s; i-- > 0;) {
    double rest = b[i];
    for (std::size_t j = i + 1; j < s; ++j) rest -= x[j] * l[j][i];
    x[i] = rest / l[i][i];
  }
  return x;
}

// In the method's own variables: alpha and alpha + gamma, the matrices of the stages.
struct Method {
  Matrix inverse_gamma{}, alpha{}, beta{};
  Vector increments{};  // m: the weights of the increments

  Method() {
    Matrix a{};
    for (std::size_t i = 0; i < s; ++i) {
      const std::size_t from = i < 6 ? i : 5;
      for (std::size_t j = 0; j < 5; ++j) a[i][j] = Table::a[from][j];
      for (std::size_t j = 5; j < i; ++j) a[i][j] = 1;
      for (std::size_t j = 0; j < 7; ++j) inverse_gamma[i][j] = -Table::c[i][j];
      inverse_gamma[i][i] = 1 / Table::gamma;
    }
    increments = a[7];
    increments[7] = 1;
    for (std::size_t i = 0; i < s; ++i) {
      Vector unit{};
      unit[i] = 1;
      alpha[i] = solve_left(a[i], inverse_gamma);
      const Vector gamma = solve_left(unit, inverse_gamma);
      for (std::size_t j = 0; j < s; ++j) beta[i][j] = alpha[i][j] + gamma[j];
    }
  }

  // The residuals of the conditions up to `order` of weights at the fraction x of a step.
  [[nodiscard]] std::vector<double> residuals(const Vector& weights, int order, double x) const {
    Vector ones;
    ones.fill(1);
    const Vector b = solve_left(weights, inverse_gamma), c = alpha * ones, e = beta * ones;
    const Vector c2 = c * c, c3 = c2 * c, ae = alpha * e, be = beta * e;
    const double x2 = x * x, x3 = x2 * x, x4 = x3 * x, x5 = x4 * x;
    std::vector<double> all{dot(b, ones) - x,
                            dot(b, e) - x2 / 2,
                            dot(b, c2) - x3 / 3,
                            dot(b, be) - x3 / 6,
                            dot(b, c3) - x4 / 4,
                            dot(b, c * ae) - x4 / 8,
                            dot(b, beta * c2) - x4 / 12,
                            dot(b, beta * be) - x4 / 24};
    if (order < 5) return all;
    for (const double residual :
         {dot(b, c3 * c) - x5 / 5, dot(b, c2 * ae) - x5 / 10, dot(b, ae * ae) - x5 / 20,
          dot(b, c * (alpha * c2)) - x5 / 15, dot(b, c * (alpha * be)) - x5 / 30,
          dot(b, beta * c3) - x5 / 20, dot(b, beta * (c * ae)) - x5 / 40,
          dot(b, beta * (beta * c2)) - x5 / 60, dot(b, beta * (beta * be)) - x5 / 120}) {
      all.push_back(residual);
    }
    return all;
  }
};

// Coefficients have 16 digits, and are up to 150.
constexpr double rounding = 1e-13;

}  // namespace

TEST_CASE("Rodas5P has order 5, its embedded method and its polynomial order 4") {
  const Method method;
  for (double residual : method.residuals(method.increments, 5, 1)) {
    CHECK(std::abs(residual) < rounding);
  }
  Vector embedded = method.increments;
  embedded[7] = 0;
  for (double residual : method.residuals(embedded, 4, 1)) CHECK(std::abs(residual) < rounding);
  for (const double x : {0.2, 0.5, 0.9}) {
    Vector weights;
    for (std::size_t j = 0; j < s; ++j) {
      const double bend = Table::dense[0][j] + x * (Table::dense[1][j] + x * Table::dense[2][j]);
      weights[j] = x * (method.increments[j] + (1 - x) * bend);
    }
    for (double residual : method.residuals(weights, 4, x)) CHECK(std::abs(residual) < rounding);
  }
}

TEST_CASE("Rodas5P's nodes are sums of its rows, and it damps what is infinitely stiff") {
  const Method method;
  Vector ones;
  ones.fill(1);
  const Vector c = method.alpha * ones, e = method.beta * ones;
  for (std::size_t i = 0; i < s; ++i) {
    CHECK(std::abs(c[i] - Table::node[i]) < rounding);
    CHECK(std::abs(e[i] - c[i] - Table::d[i]) < rounding);
  }
  const Vector b = solve_left(method.increments, method.inverse_gamma);
  CHECK(std::abs(1 - dot(solve_left(b, method.beta), ones)) < rounding);
}
