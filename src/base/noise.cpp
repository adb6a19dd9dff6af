// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base/noise.hpp"

#include <cmath>

namespace bbsim {
namespace {

// The coefficients of artanh's series: 1/1, 1/3, ...
struct OddParts {
  double of[13]{};
  constexpr OddParts() {
    for (int i = 0; i < 13; ++i) of[i] = 1.0 / (2 * i + 1);
  }
};
constexpr OddParts odd_parts;

// -log(p) from sums and products only, because C libraries round log() differently. With
// p = m 2^e, log m = 2 artanh((m - 1) / (m + 1)).
double minus_log(double p) {
  constexpr double ln_2 = 0.693147180559945309;
  int exponent = 0;
  const double m = std::frexp(p, &exponent);  // in [1/2, 1), exactly
  const double s = (m - 1) / (m + 1), s2 = s * s;
  double series = 0;
  for (int i = 12; i >= 0; --i) series = series * s2 + odd_parts.of[i];
  return -(exponent * ln_2 + 2 * s * series);
}

constexpr double central = 0.425;  // |p - 1/2| up to here uses one rational function

double central_quantile(double q) {
  const double r = 0.180625 - q * q;
  return q * (((59.109374720 * r + 159.29113202) * r + 50.434271938) * r + 3.3871327179) /
         (((67.187563600 * r + 78.757757664) * r + 17.895169469) * r + 1);
}

double outer_quantile(double p) {
  const double q = p - 0.5;
  double r = std::sqrt(minus_log(q < 0 ? p : 1 - p));
  double z = 0;
  if (r <= 5) {
    r -= 1.6;
    z = (((0.17023821103 * r + 1.3067284816) * r + 2.7568153900) * r + 1.4234372777) /
        ((0.12021132975 * r + 0.73700164250) * r + 1);
  } else {
    r -= 5;
    z = (((0.017337203997 * r + 0.42868294337) * r + 3.0812263860) * r + 6.6579051150) /
        ((0.012258202635 * r + 0.24197894225) * r + 1);
  }
  return q < 0 ? -z : z;
}

}  // namespace

double normal_quantile(double p) {
  const double q = p - 0.5;
  return std::abs(q) <= central ? central_quantile(q) : outer_quantile(p);
}

void Noise::draw() {
  for (double& p : uniforms_) p = (static_cast<double>(generator_() >> 12U) + 0.5) * 0x1p-52;
  // The central formula applies to most numbers. Without a branch, the loop vectorizes.
  for (std::size_t i = 0; i < together; ++i) normals_[i] = central_quantile(uniforms_[i] - 0.5);
  for (std::size_t i = 0; i < together; ++i) {
    if (std::abs(uniforms_[i] - 0.5) > central) normals_[i] = outer_quantile(uniforms_[i]);
  }
  drawn_ = 0;
}

}  // namespace bbsim
