// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What a loop bears: margins of gain, phase and delay, and the bandwidth, from its frequency
// response.
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

  // From input j to output i. At 0, and at half the rate of the samples, it is real; not finite at
  // a pole.
  [[nodiscard]] std::complex<double> at(double w, Eigen::Index i, Eigen::Index j) const;

  // The same near poles on the border of stability too, where it takes longer, and how far the
  // rounding of the entries may move it.
  struct Careful {
    std::complex<double> value;
    double rounding;
  };
  [[nodiscard]] Careful carefully_at(double w, Eigen::Index i, Eigen::Index j) const;

  // Half the rate of the samples, rad/s; infinite in continuous time.
  [[nodiscard]] double last() const;

 private:
  [[nodiscard]] std::complex<double> point(double w) const;

  Eigen::MatrixXd a_, b_, c_, d_;  // A in Hessenberg form: what is left to solve is cheap
  Eigen::MatrixXd balanced_a_, balanced_b_, balanced_c_;
  double period_;
};

// Frequencies, rising, between which nothing unseen happens of a system with such poles, open and
// closed: from well below the slowest to well above the fastest, or to half the rate of the
// samples. Poles on the border of stability have no rate to look near.
[[nodiscard]] std::vector<double> frequencies_to_look_at(
    const std::vector<std::complex<double>>& open, const std::vector<std::complex<double>>& closed,
    double period);

// Of the loop 1 + L = 0. What no change brings to the border of stability is infinite, or 0.
struct Margins {
  static constexpr double none = std::numeric_limits<double>::infinity();
  // The smallest factor above 1, and where, rad/s: at 0, where a pole passes through 0 (or z = 1),
  // up to half the rate of the samples (z = -1).
  double gain = none, gain_at = none;
  double reduction = 0, reduction_at = none;  // the largest factor below 1
  // The smallest turn of L's phase, rad: above 0, so much more lag; below 0, so much more lead.
  double phase = none, phase_at = none;
  double delay = none, delay_at = none;  // the shortest, s
};

// What is looked for; what is not stays at its default.
struct MarginParts {
  bool gains = true, phases = true;  // phases: and delays
};

// Of a response with one input and one output, L, between frequencies of frequencies_to_look_at();
// at least one. What rounding of the entries would make or unmake is none. Factors of frequencies
// below `slowest` (rad/s) do not count. Of an unstable loop they say where poles cross the border.
[[nodiscard]] Margins margins_of(const FrequencyResponse& open_loop,
                                 const std::vector<double>& frequencies, double slowest = 0,
                                 MarginParts parts = {});

// Where the size of a response first falls below 1 / sqrt(2) of that at 0 (by 3.01 dB), rad/s;
// infinite if it does not.
[[nodiscard]] double bandwidth_of(const std::function<std::complex<double>(double)>& closed_loop,
                                  const std::vector<double>& frequencies);

}  // namespace bbsim::model
