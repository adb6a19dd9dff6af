// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The 64-bit hash FNV-1a of Fowler, Noll and Vo, for bytes, or for numbers one word at a time. It
// detects damage, not malice.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

namespace bbsim {

inline constexpr std::uint64_t fnv1a_start = 0xCBF29CE484222325U;

[[nodiscard]] constexpr std::uint64_t fnv1a(std::uint64_t hash, std::uint64_t word) {
  return (hash ^ word) * 0x100000001B3U;
}
[[nodiscard]] constexpr std::uint64_t fnv1a(std::uint64_t hash, double number) {
  return fnv1a(hash, std::bit_cast<std::uint64_t>(number));
}
[[nodiscard]] constexpr std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t hash = fnv1a_start;
  for (const char c : bytes) hash = fnv1a(hash, std::uint64_t{static_cast<unsigned char>(c)});
  return hash;
}

}  // namespace bbsim
