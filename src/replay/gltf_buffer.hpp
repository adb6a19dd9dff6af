// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The binary part of a glTF file, and the JSON that describes its content.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace bbsim::replay {

class GltfBuffer {
 public:
  // Each function returns the index of the new accessor. The format requires that vertices and
  // animations use separate views.
  std::size_t add_scalars(
      std::span<const float> values);  // with their bounds: an animation's times
  std::size_t add_vectors(std::span<const std::array<float, 3>> values);
  std::size_t add_quaternions(std::span<const std::array<float, 4>> values);
  // With bounds, which glTF requires of positions.
  std::size_t add_vertices(std::span<const std::array<float, 3>> values, bool bounds);
  std::size_t add_indices(std::span<const std::uint16_t> values);

  // Adds "accessors", "bufferViews" and "buffers" to `json`. Returns the file: header, JSON, bytes.
  [[nodiscard]] std::string file(nlohmann::ordered_json json) const;

 private:
  void put(std::uint32_t word);
  std::size_t add(const char* type, int component, std::size_t count, std::size_t start,
                  int target);

  std::string bytes_;
  nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
};

}  // namespace bbsim::replay
