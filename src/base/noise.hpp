// Random numbers that are the same on every machine: a generator whose output the C++ standard
// fixes, and arithmetic that IEEE 754 fixes.
#pragma once

#include <cstdint>
#include <random>

namespace bbsim {

// The deviate z with P(Z < z) = p, 0 < p < 1, of the standard normal distribution, within a
// relative 2e-7: Wichura's algorithm AS 241, PPND7 (Applied Statistics 37, 1988).
[[nodiscard]] double normal_quantile(double p);

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : generator_(seed) {}

  // A number in (0, 1), of 52 bits.
  [[nodiscard]] double uniform() {
    return (static_cast<double>(generator_() >> 12U) + 0.5) * 0x1p-52;
  }
  [[nodiscard]] double normal() { return normal_quantile(uniform()); }

 private:
  std::mt19937_64 generator_;
};

}  // namespace bbsim
