// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Frequency responses, margins and bandwidths against their closed forms.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catch.hpp"
#include "model/control/frequency.hpp"

namespace bbsim_test::test_frequency {

using namespace bbsim;
using bbsim::model::FrequencyResponse;
using bbsim::model::Margins;
using Complex = std::complex<double>;
using Eigen::MatrixXd;

namespace {

constexpr double pi = std::numbers::pi;

// gain / ((s - pole 1) (s - pole 2) ...), as a chain; of z with a period.
struct Chain {
  std::vector<double> poles;
  double gain;

  [[nodiscard]] FrequencyResponse response(double period = 0) const {
    const auto n = static_cast<Eigen::Index>(poles.size());
    MatrixXd a = MatrixXd::Zero(n, n), b = MatrixXd::Zero(n, 1), c = MatrixXd::Zero(1, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      a(i, i) = poles[static_cast<std::size_t>(i)];
      if (i > 0) a(i, i - 1) = 1;
    }
    b(0, 0) = gain;
    c(0, n - 1) = 1;
    return {a, b, c, MatrixXd::Zero(1, 1), period};
  }
  [[nodiscard]] Complex at(Complex s) const {
    Complex value = gain;
    for (const double pole : poles) value /= s - pole;
    return value;
  }
  // `closed`: the poles of 1 + L, near which the response may have features.
  [[nodiscard]] Margins margins(const std::vector<Complex>& closed, double period = 0) const {
    const std::vector<Complex> open(poles.begin(), poles.end());
    return model::margins_of(response(period), model::frequencies_to_look_at(open, closed, period));
  }
};

}  // namespace

TEST_CASE("a frequency response is C (sI - A)^-1 B + D, with a bound on its rounding") {
  const Chain chain{{-1, -3, -1e4, 0.5}, 2e4};
  const FrequencyResponse response = chain.response();
  for (const double w : {0.0, 1e-3, 1.0, 40.0, 1e5}) {
    const Complex exact = chain.at({0, w});
    CAPTURE(w);
    CHECK(std::abs(response.at(w, 0, 0) - exact) < 1e-14 * std::abs(exact));
    const FrequencyResponse::Careful careful = response.carefully_at(w, 0, 0);
    CHECK(std::abs(careful.value - exact) <= careful.rounding);
    CHECK(careful.rounding < 1e-12 * std::abs(exact));
  }
  CHECK(std::isinf(response.last()));
  const FrequencyResponse only_d(MatrixXd(0, 0), MatrixXd(0, 1), MatrixXd(1, 0),
                                 MatrixXd::Constant(1, 1, 3), 0);
  CHECK(only_d.at(7, 0, 0) == Complex(3));
}

TEST_CASE("a discrete response ends at half the sampling rate and is real there") {
  const Chain chain{{0.5, -0.2}, 1};
  const double period = 0.1;
  const FrequencyResponse response = chain.response(period);
  CHECK(response.last() == pi / period);
  CHECK(response.at(response.last(), 0, 0).imag() == 0);
  CHECK(response.at(response.last(), 0, 0).real() == Approx(1 / (-1.5 * -0.8)).epsilon(1e-14));
  const Complex exact = chain.at(std::polar(1.0, 3 * period));
  CHECK(std::abs(response.at(3, 0, 0) - exact) < 1e-15);
}

TEST_CASE("margins of chains are those of their closed forms") {
  SECTION("k / (s (s + 1) (s + 2)): -180 degrees at sqrt(2), where the magnitude is k / 6") {
    const Margins margins = Chain{{0, -1, -2}, 1.5}.margins({{-0.3, 0.7}, {-0.3, -0.7}, -2.4});
    CHECK(margins.gain == Approx(4).epsilon(1e-12));
    CHECK(margins.gain_at == Approx(std::numbers::sqrt2).epsilon(1e-12));
    CHECK(margins.reduction == 0);
    const double w = margins.phase_at;
    CHECK(w * std::hypot(w, 1) * std::hypot(w, 2) == Approx(1.5).epsilon(1e-12));
    CHECK(margins.phase == Approx(pi / 2 - std::atan(w) - std::atan(w / 2)).epsilon(1e-12));
    CHECK(margins.delay == Approx(margins.phase / w).epsilon(1e-12));
    CHECK(margins.delay_at == w);
  }
  SECTION(
      "2 / (s - 1): -2 at 0, through which a pole passes; magnitude 1 at sqrt(3), 120 degrees") {
    const Margins margins = Chain{{1}, 2}.margins({-1});
    CHECK(std::isinf(margins.gain));
    CHECK(margins.reduction == Approx(0.5).epsilon(1e-14));
    CHECK(margins.reduction_at == 0);
    CHECK(margins.phase == Approx(pi / 3).epsilon(1e-12));
    CHECK(margins.phase_at == Approx(std::sqrt(3.0)).epsilon(1e-12));
  }
  SECTION("sampled, 0.5 / (z - 1): a pole passes through z = -1; |z - 1| = 2 sin(w T / 2)") {
    const double period = 0.02;
    const Margins margins = Chain{{1}, 0.5}.margins({0.5}, period);
    CHECK(margins.gain == Approx(4).epsilon(1e-13));
    CHECK(margins.gain_at == pi / period);
    CHECK(margins.phase_at == Approx(2 / period * std::asin(0.25)).epsilon(1e-12));
    CHECK(margins.phase == Approx(pi / 2 - margins.phase_at * period / 2).epsilon(1e-12));
  }
}

TEST_CASE("gain margins below the lowest relevant frequency are ignored") {
  const Chain chain{{1}, 2};
  const auto frequencies = model::frequencies_to_look_at({1}, {-1}, 0);
  const Chain third{{0, -1, -2}, 1.5};
  const auto of_third =
      model::frequencies_to_look_at({0, -1, -2}, {{-0.3, 0.7}, {-0.3, -0.7}, -2.4}, 0);
  CHECK(model::margins_of(third.response(), of_third, 1.4).gain == Approx(4));
  CHECK(std::isinf(model::margins_of(third.response(), of_third, 1.5).gain));
  CHECK(model::margins_of(chain.response(), frequencies, 0).reduction == Approx(0.5));
}

TEST_CASE("the bandwidth is where the magnitude falls by 3 dB") {
  const auto width = [](const FrequencyResponse& of, const std::vector<Complex>& poles) {
    return model::bandwidth_of([&](double w) { return of.at(w, 0, 0); },
                               model::frequencies_to_look_at({}, poles, 0));
  };
  CHECK(width(Chain{{-5}, 35}.response(), {-5}) == Approx(5).epsilon(1e-12));
  // Two equal lags: (1 + w^2)^2 = 2.
  CHECK(width(Chain{{-1, -1}, 1}.response(), {-1, -1}) ==
        Approx(std::sqrt(std::numbers::sqrt2 - 1)).epsilon(1e-12));
  const MatrixXd one = MatrixXd::Ones(1, 1);
  // (s + 2) / (s + 1) falls from 2 to 1, which is below 2 / sqrt(2); (s + 1.1) / (s + 1) does not.
  CHECK(width({-one, one, one, one, 0}, {-1}) == Approx(std::numbers::sqrt2).epsilon(1e-12));
  CHECK(std::isinf(width({-one, 0.1 * one, one, one, 0}, {-1})));
  // If the response is 0 at frequency 0, it cannot fall.
  CHECK(std::isinf(width({-one, one, -one, one, 0}, {-1})));
}

TEST_CASE("frequencies to look at are sorted and resolve every resonance") {
  const Complex narrow(-1e-6, 50), wide(-3, 1);
  const auto frequencies =
      model::frequencies_to_look_at({narrow, std::conj(narrow)}, {wide, std::conj(wide)}, 0);
  REQUIRE(std::ranges::is_sorted(frequencies));
  CHECK(frequencies.front() < 0.01);
  CHECK(frequencies.back() > 1e4);
  const auto near =
      std::ranges::count_if(frequencies, [](double w) { return std::abs(w - 50) <= 4.1e-6; });
  CHECK(near >= 9);
  // Sampled: up to half the sampling rate.
  const auto sampled = model::frequencies_to_look_at({0.5}, {0.9}, 0.1);
  CHECK(sampled.back() <= pi / 0.1);
  CHECK(sampled.back() > 0.99 * pi / 0.1);
}

}  // namespace bbsim_test::test_frequency
