// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Margins of gain, phase and delay of a loop, and its bandwidth, from its frequency response.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <functional>
#include <limits>
#include <vector>

namespace bbsim::model {

// C (s I - A)^-1 B + D at s = i w, or, with a period T (s) > 0, at exp(i w T); w in rad/s.
// A is n x n, B n x m, C p x n, D p x m, and all are finite.
// Method: A balanced and in Hessenberg form, so that each frequency takes n^2 operations; Laub,
// IEEE Trans. Automatic Control 26 (1981).
class FrequencyResponse {
 public:
  FrequencyResponse(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c,
                    const Eigen::MatrixXd& d, double period);

  // From input j to output i. Real at 0 and at half the sampling rate; not finite at a pole.
  [[nodiscard]] std::complex<double> at(double w, Eigen::Index i, Eigen::Index j) const;

  // Slower, but accurate also near poles on the border of stability; `rounding` bounds the effect
  // of the entries' rounding.
  struct Careful {
    std::complex<double> value;
    double rounding;
  };
  [[nodiscard]] Careful carefully_at(double w, Eigen::Index i, Eigen::Index j) const;

  // Half the sampling rate, rad/s; infinite in continuous time.
  [[nodiscard]] double last() const;

 private:
  [[nodiscard]] std::complex<double> point(double w) const;

  Eigen::MatrixXd a_, b_, c_, d_;  // A in Hessenberg form, cheap to solve
  Eigen::MatrixXd balanced_a_, balanced_b_, balanced_c_;
  double period_;
};

// Rising frequencies, dense enough for a system with these open-loop and closed-loop poles, from
// well below the slowest to well above the fastest, or to half the sampling rate. Poles of
// rate 0 do not set the slowest.
[[nodiscard]] std::vector<double> frequencies_to_look_at(
    const std::vector<std::complex<double>>& open, const std::vector<std::complex<double>>& closed,
    double period);

// Margins of the loop 1 + L = 0; infinite, or 0, if no change brings it to the border of stability.
struct Margins {
  static constexpr double none = std::numeric_limits<double>::infinity();
  // The smallest factor above 1, and its frequency, rad/s: from 0, where a pole passes through 0
  // (or z = 1), to half the sampling rate (z = -1).
  double gain = none, gain_at = none;
  double reduction = 0, reduction_at = none;  // the largest factor below 1
  // The smallest turn of L's phase, rad: more lag if above 0, more lead if below 0.
  double phase = none, phase_at = none;
  double delay = none, delay_at = none;  // the shortest, s
};

// Margins to compute; the others keep their defaults.
struct MarginParts {
  bool gains = true, phases = true;  // phases: and delays
};

// Margins of a response L with one input and one output, over frequencies_to_look_at(), at least
// one. Leaves out crossings that rounding of the entries could make or remove, and gain factors
// below `slowest` (rad/s). Margins of an unstable loop say where poles cross the border.
[[nodiscard]] Margins margins_of(const FrequencyResponse& open_loop,
                                 const std::vector<double>& frequencies, double slowest = 0,
                                 MarginParts parts = {});

// Frequency at which a response first falls below 1 / sqrt(2) of that at 0 (by 3.01 dB), rad/s;
// infinite if it does not.
[[nodiscard]] double bandwidth_of(const std::function<std::complex<double>(double)>& closed_loop,
                                  const std::vector<double>& frequencies);

}  // namespace bbsim::model
