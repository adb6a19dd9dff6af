// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Random numbers that are the same on every machine: a generator whose output the C++ standard
// fixes, and arithmetic that IEEE 754 fixes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

#include "base/archive.hpp"

namespace bbsim {

// The deviate z with P(Z < z) = p, 0 < p < 1, of the standard normal distribution, within a
// relative 2e-7: Wichura's algorithm AS 241, PPND7 (Applied Statistics 37, 1988).
[[nodiscard]] double normal_quantile(double p);

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : generator_(seed) {}

  // A number in (0, 1), of 52 bits.
  [[nodiscard]] double uniform() { return uniforms_[next()]; }
  // The normal quantile of such a number.
  [[nodiscard]] double normal() { return normals_[next()]; }

  // How far it is drawn (base/archive.hpp).
  template <class Archive>
  void archive(Archive& archive) {
    // (A generator that stands beyond its numbers makes new ones.)
    archive(generator_, uniforms_, normals_, drawn_);
    archive.require(drawn_ <= together && is_finite(uniforms_, normals_));
  }

 private:
  // Drawn together, so that quantiles overlap in the processor.
  static constexpr std::size_t together = 16;

  [[nodiscard]] std::size_t next() {
    if (drawn_ == together) draw();
    return drawn_++;
  }
  void draw();

  std::mt19937_64 generator_;
  std::array<double, together> uniforms_{}, normals_{};
  std::size_t drawn_ = together;  // of those that are there
};

}  // namespace bbsim
