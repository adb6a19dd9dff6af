// What a loop bears: margins of gain, phase and delay, and the bandwidth, from its frequency
// response.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <functional>
#include <limits>
#include <vector>

namespace bbsim::model {

// c (s I - A)^-1 b + d at s = i w, or, with a period T > 0, at exp(i w T); w in rad/s.
class FrequencyResponse {
 public:
  FrequencyResponse(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::MatrixXd& c,
                    const Eigen::MatrixXd& d, double period);

  // From input j to output i.
  [[nodiscard]] std::complex<double> at(double w, Eigen::Index i, Eigen::Index j) const;

 private:
  Eigen::MatrixXd a_, b_, c_, d_;  // A in Hessenberg form: what is left to solve is cheap
  double period_;
};

// Frequencies, rising, between which nothing of a system with these poles happens unseen: from well
// below the slowest to well above the fastest, or to half the rate of the samples.
[[nodiscard]] std::vector<double> frequencies_to_look_at(
    const std::vector<std::complex<double>>& poles, double period);

// Of the loop 1 + L = 0. What no change brings to the border of stability is infinite, or 0.
struct Margins {
  static constexpr double none = std::numeric_limits<double>::infinity();
  double gain = none, gain_at = none;         // the smallest factor above 1, and where, rad/s
  double reduction = 0, reduction_at = none;  // the largest factor below 1
  double phase = none, phase_at = none;  // the smallest in size, rad; negative: a lead is borne
  double delay = none, delay_at = none;  // the shortest, s
};

[[nodiscard]] Margins margins_of(const std::function<std::complex<double>(double)>& open_loop,
                                 const std::vector<double>& frequencies);

// Where the size of a response first falls below its value at 0 over the root of 2, rad/s; none if
// it does not.
[[nodiscard]] double bandwidth_of(const std::function<std::complex<double>(double)>& closed_loop,
                                  const std::vector<double>& frequencies);

}  // namespace bbsim::model
