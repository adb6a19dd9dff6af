// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/radau_rule.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace bbsim::study {
namespace {

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

}  // namespace

void legendre(Quad x, int count, Quad* values) {
  values[0] = 1.0;
  if (count > 1) values[1] = x;
  for (int k = 1; k + 1 < count; ++k) {
    values[k + 1] = ((2 * k + 1) * x * values[k] - k * values[k - 1]) / (k + 1);
  }
}

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

}  // namespace bbsim::study
