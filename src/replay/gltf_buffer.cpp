// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/gltf_buffer.hpp"

#include <algorithm>
#include <bit>

namespace bbsim::replay {
namespace {

using Json = nlohmann::ordered_json;

// Numbers of types and uses in glTF 2.0.
constexpr int float_component = 5126, short_component = 5123;
constexpr int no_target = 0, vertex_target = 34962, index_target = 34963;

void put_word(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xFF);
}

template <std::size_t width>
void add_bounds(Json& accessor, std::span<const std::array<float, width>> values) {
  Json least = Json::array(), greatest = Json::array();
  for (std::size_t i = 0; i < width; ++i) {
    const auto [low, high] = std::minmax_element(
        values.begin(), values.end(), [i](const auto& a, const auto& b) { return a[i] < b[i]; });
    least.push_back(static_cast<double>((*low)[i]));
    greatest.push_back(static_cast<double>((*high)[i]));
  }
  accessor["min"] = least;
  accessor["max"] = greatest;
}

}  // namespace

void GltfBuffer::put(std::uint32_t word) {
  put_word(bytes_, word);
}

std::size_t GltfBuffer::add(const char* type, int component, std::size_t count, std::size_t start,
                            int target) {
  Json view = {{"buffer", 0}, {"byteOffset", start}, {"byteLength", bytes_.size() - start}};
  if (target != no_target) view["target"] = target;
  views_.push_back(view);
  accessors_.push_back({{"bufferView", views_.size() - 1},
                        {"componentType", component},
                        {"count", count},
                        {"type", type}});
  while (bytes_.size() % 4 != 0) bytes_ += '\0';
  return accessors_.size() - 1;
}

std::size_t GltfBuffer::add_scalars(std::span<const float> values) {
  const std::size_t start = bytes_.size();
  for (const float value : values) put(std::bit_cast<std::uint32_t>(value));
  const std::size_t accessor = add("SCALAR", float_component, values.size(), start, no_target);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  accessors_[accessor]["min"] = {static_cast<double>(*low)};
  accessors_[accessor]["max"] = {static_cast<double>(*high)};
  return accessor;
}

std::size_t GltfBuffer::add_vectors(std::span<const std::array<float, 3>> values) {
  const std::size_t start = bytes_.size();
  for (const auto& value : values) {
    for (const float x : value) put(std::bit_cast<std::uint32_t>(x));
  }
  return add("VEC3", float_component, values.size(), start, no_target);
}

std::size_t GltfBuffer::add_quaternions(std::span<const std::array<float, 4>> values) {
  const std::size_t start = bytes_.size();
  for (const auto& value : values) {
    for (const float x : value) put(std::bit_cast<std::uint32_t>(x));
  }
  return add("VEC4", float_component, values.size(), start, no_target);
}

std::size_t GltfBuffer::add_vertices(std::span<const std::array<float, 3>> values, bool bounds) {
  const std::size_t start = bytes_.size();
  for (const auto& value : values) {
    for (const float x : value) put(std::bit_cast<std::uint32_t>(x));
  }
  const std::size_t accessor = add("VEC3", float_component, values.size(), start, vertex_target);
  if (bounds) add_bounds(accessors_[accessor], values);
  return accessor;
}

std::size_t GltfBuffer::add_indices(std::span<const std::uint16_t> values) {
  const std::size_t start = bytes_.size();
  for (const std::uint16_t value : values) {
    bytes_ += static_cast<char>(value & 0xFF);
    bytes_ += static_cast<char>(value >> 8);
  }
  return add("SCALAR", short_component, values.size(), start, index_target);
}

std::string GltfBuffer::file(Json json) const {
  json["accessors"] = accessors_;
  json["bufferViews"] = views_;
  json["buffers"] = Json::array({{{"byteLength", bytes_.size()}}});
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  while (text.size() % 4 != 0) text += ' ';

  constexpr std::uint32_t magic = 0x46546C67, version = 2;                  // "glTF"
  constexpr std::uint32_t json_chunk = 0x4E4F534A, bin_chunk = 0x004E4942;  // "JSON", "BIN"
  constexpr std::size_t header = 12, chunk_header = 8;
  std::string result;
  put_word(result, magic);
  put_word(result, version);
  put_word(result,
           static_cast<std::uint32_t>(header + 2 * chunk_header + text.size() + bytes_.size()));
  put_word(result, static_cast<std::uint32_t>(text.size()));
  put_word(result, json_chunk);
  result += text;
  put_word(result, static_cast<std::uint32_t>(bytes_.size()));
  put_word(result, bin_chunk);
  return result + bytes_;
}

}  // namespace bbsim::replay
