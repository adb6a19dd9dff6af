// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Random numbers that are the same on every machine: the C++ standard fixes the generator's output,
// and IEEE 754 fixes the arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

namespace bbsim {

// The inverse normal distribution: the z with P(Z < z) = p, 0 < p < 1, to a relative 2e-7.
// Wichura's algorithm AS 241, PPND7 (Applied Statistics 37, 1988).
[[nodiscard]] double normal_quantile(double p);

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : generator_(seed) {}

  // A number in (0, 1), with 52 random bits.
  [[nodiscard]] double uniform() { return uniforms_[next()]; }
  // A standard normal number: the quantile of a uniform number.
  [[nodiscard]] double normal() { return normals_[next()]; }

 private:
  // Drawn in batches, so that the processor overlaps the quantiles.
  static constexpr std::size_t together = 16;

  [[nodiscard]] std::size_t next() {
    if (drawn_ == together) draw();
    return drawn_++;
  }
  void draw();

  std::mt19937_64 generator_;
  std::array<double, together> uniforms_{}, normals_{};
  std::size_t drawn_ = together;  // numbers used from the current batch
};

}  // namespace bbsim
