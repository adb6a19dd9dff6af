// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/numbers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

namespace bbsim::replay {
namespace {

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < here ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= here ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

}  // namespace

// Each value becomes a word, little endian.
template <class WordOf>
Numbers::Json Numbers::list(std::vector<double> values, WordOf word_of) const {
  if (arrays_ != nullptr) {
    arrays_->push_back(std::move(values));
    return arrays_->size() - 1;
  }
  std::vector<unsigned char> bytes;
  bytes.reserve(values.size() * sizeof word_of(0));
  for (const double value : values) {
    const auto word = word_of(value);
    for (std::size_t i = 0; i < sizeof word; ++i) {
      bytes.push_back(static_cast<unsigned char>(word >> (8 * i) & 0xFFU));
    }
  }
  return base64(bytes);
}

Numbers::Json Numbers::floats(std::vector<double> values) const {
  return list(std::move(values), [](double value) {
    // Overflow, where a plain conversion is undefined.
    if (std::abs(value) > std::numeric_limits<float>::max()) value = std::copysign(HUGE_VAL, value);
    return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  });
}

Numbers::Json Numbers::doubles(std::vector<double> values) const {
  return list(std::move(values), [](double value) { return std::bit_cast<std::uint64_t>(value); });
}

Numbers::Json Numbers::parts(std::vector<double> values) const {
  return list(std::move(values), [](double value) {
    return static_cast<std::uint16_t>(std::lround(std::clamp(value, -1.0, 1.0) * 32767));
  });
}

}  // namespace bbsim::replay
