// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sums of a few sines with one base period that begin and end at rest.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "base/noise.hpp"
#include "design/motion.hpp"

namespace bbsim::design {

inline constexpr double turn = 6.283185307179586;  // rad

// Multiples of 1/length for each axis, with the amplitudes and phases that they may have: the
// motion starts from zero at rest, and tilts leave a ball at rest that was at rest before.
class Multisine {
 public:
  struct Band {
    Plays plays;
    double length;        // s
    std::size_t highest;  // the largest multiple
    double middle;        // center of the drawn multiples
    std::array<bool, 2> axes;
  };
  // Draws the multiples, and how amplitudes depend on frequency.
  Multisine(const Band& band, Noise& noise);

  // The number of free numbers.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] Motion motion(const std::vector<double>& numbers) const;

 private:
  struct Axis {
    std::vector<double> frequencies;  // rad/s
    // Maps free numbers to the amplitudes of cosines, then of sines.
    Eigen::MatrixXd amplitudes;
  };
  Plays plays_;
  std::array<Axis, 2> axes_;
};

// The largest multiple that suits a log with this rate (Hz).
[[nodiscard]] std::size_t highest_multiple(double length, double rate);

}  // namespace bbsim::design
