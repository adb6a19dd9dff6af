// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The constants of the collocation, and the lanes' sine and cosine.
#include <algorithm>
#include <cmath>
#include <complex>

#include "catch.hpp"
#include "simd/pack.hpp"
#include "solve/collocation/radau_table.hpp"

namespace bbsim_test::test_radau_tables {

using namespace bbsim::solve::radau;

namespace {

struct TestLanes {};

template <int s>
void check_tables() {
  constexpr const auto& table = radau_table<Shared, s>;
  CAPTURE(s);
  CHECK(table.c[s - 1] == 1);
  // Order conditions of a collocation: powers up to s - 1 are integrated exactly. The bound is s
  // rounding errors of numbers below 1, and one for each multiplication of a power.
  const double rounding = 4 * s * 2.3e-16;
  for (int i = 0; i < s; ++i) {
    for (int q = 1; q <= s; ++q) {
      double sum = 0, twice = 0;
      for (int j = 0; j < s; ++j) {
        sum += table.a[j][i] * std::pow(table.c[j], q - 1);
        twice += table.a_squared[j][i] * std::pow(table.c[j], q - 1);
      }
      CHECK(std::abs(sum - std::pow(table.c[i], q) / q) < rounding);
      if (q < s) CHECK(std::abs(twice - std::pow(table.c[i], q + 1) / (q * (q + 1))) < rounding);
    }
  }
  // The last row is Radau's quadrature: exact up to degree 2 s - 2.
  for (int q = s; q < 2 * s; ++q) {
    double sum = 0;
    for (int j = 0; j < s; ++j) sum += table.a[j][s - 1] * std::pow(table.c[j], q - 1);
    CHECK(std::abs(sum - 1.0 / q) < rounding);
  }
  // back * lambda * forward = a. The eigenvectors are nearly parallel, so rounding is magnified by
  // the size of their inverse.
  double magnified = 1;
  for (int j = 0; j < s; ++j) {
    for (int k = 0; k < s / 2; ++k) {
      magnified =
          std::max({magnified, std::abs(table.forward_re[j][k]), std::abs(table.forward_im[j][k])});
    }
  }
  for (int i = 0; i < s; ++i) {
    for (int j = 0; j < s; ++j) {
      double sum = 0;
      for (int k = 0; k < s / 2; ++k) {
        const std::complex<double> lambda(table.lambda_re[k], table.lambda_im[k]);
        const std::complex<double> y =
            lambda * std::complex<double>(table.forward_re[j][k], table.forward_im[j][k]);
        sum += table.back_re[k][i] * y.real() + table.back_im[k][i] * y.imag();
      }
      CHECK(std::abs(sum - table.a[j][i]) < rounding * magnified);
    }
  }
  // Legendre coefficients of the shifted P_1 = 2 c - 1.
  for (int i = 0; i < s; ++i) {
    double sum = 0;
    for (int j = 0; j < s; ++j) sum += table.legendre[j][i] * (2 * table.c[j] - 1);
    CHECK(std::abs(sum - (i == 1 ? 1 : 0)) < 4 * rounding);
  }
}

}  // namespace

TEST_CASE("the tables satisfy the order conditions and their factors multiply to A") {
  check_tables<8>();
  check_tables<12>();
  check_tables<16>();
}

TEST_CASE("sine and cosine in lanes are accurate to two units in the last place") {
  using P = bbsim::simd::Pack<TestLanes, 2>;
  double worst = 0;
  const auto look = [&](double angle) {
    const auto wave = sin_cos(P(angle));
    const auto in_ulps = [](double value, long double exact) {
      const double unit = std::nextafter(std::abs(static_cast<double>(exact)), 10.0) -
                          std::abs(static_cast<double>(exact));
      return static_cast<double>(std::abs(value - exact)) / unit;
    };
    worst = std::max({worst, in_ulps(wave.sin[0], std::sin(static_cast<long double>(angle))),
                      in_ulps(wave.cos[1], std::cos(static_cast<long double>(angle)))});
  };
  for (int i = -40000; i <= 40000; ++i) look(i * 2.5e-4 + 1e-5);  // -10 to 10
  CHECK(worst < 2);
  worst = 0;
  for (int i = 0; i < 20000; ++i) look(9e4 + i * 1.37);  // across the limit of the fast reduction
  CHECK(worst < 2);
  CHECK(sin_cos(P(0.0)).sin[0] == 0);
  CHECK(sin_cos(P(0.0)).cos[0] == 1);
}

}  // namespace bbsim_test::test_radau_tables
