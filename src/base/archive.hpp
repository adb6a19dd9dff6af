// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes the state of objects as bytes and reads it back, so that another process can resume a run.
//
// One function of a class serves both directions and states the conditions on its members:
//     template <class Archive> void archive(Archive& archive) {
//       archive(speed_, queue_);
//       archive.require(is_finite(speed_));
//     }
// The bytes are valid only for the build and the kind of machine that wrote them; the caller stores
// both beside them. The bytes may be damaged or forged. The reader therefore checks every count,
// every index and every time, so that a read state is one that a run can reach.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/error.hpp"

namespace bbsim {

// A type whose every bit pattern is a valid value. An enumeration is not: see enumerated().
template <class T>
concept PlainBytes = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::is_enum_v<T>;

template <class T, class Archive>
concept Archived = requires(T& object, Archive& archive) {
  object.archive(archive);
};

template <class T>
concept Sequence = requires(T& list) {
  list.resize(1);
  list.begin();
};

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

// The bytes are not a state of this run. what() ends a sentence: "is damaged: it is truncated".
class StateFault : public InputError {
  using InputError::InputError;
};

class StateWriter {
 public:
  static constexpr bool reads = false;

  template <class... Parts>
  void operator()(Parts&... parts) {
    (put(parts), ...);
  }
  // An enumerator from 0 to `last`.
  template <class Enumeration>
  void enumerated(Enumeration& value, Enumeration /*last*/) {
    bytes(&value, sizeof value);
  }
  // A list whose length the scenario fixes. The reader checks the length.
  template <Sequence List>
  void fixed(List& list) {
    put(list);
  }
  // A condition that the state of every run meets. The reader checks it.
  static void require(bool /*sound*/) {}
  void bytes(void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  void put(T& part) {
    if constexpr (Archived<T, StateWriter>) {
      part.archive(*this);
    } else if constexpr (Sequence<T>) {
      std::size_t size = part.size();
      put(size);
      for (auto& element : part) put(element);
    } else if constexpr (is_optional<T>) {
      bool there = part.has_value();
      put(there);
      if (there) put(*part);
    } else {
      static_assert(PlainBytes<T>);
      bytes(&part, sizeof part);
    }
  }

  std::string bytes_;
};

// Throws StateFault if the bytes end too soon or a condition fails.
class StateReader {
 public:
  static constexpr bool reads = true;

  explicit StateReader(std::string_view from) : left_(from) {}

  template <class... Parts>
  void operator()(Parts&... parts) {
    (get(parts), ...);
  }
  template <class Enumeration>
  void enumerated(Enumeration& value, Enumeration last) {
    std::underlying_type_t<Enumeration> number{};
    bytes(&number, sizeof number);
    require(number >= 0 && number <= static_cast<std::underlying_type_t<Enumeration>>(last));
    value = static_cast<Enumeration>(number);
  }
  template <Sequence List>
  void fixed(List& list) {
    std::size_t size = 0;
    get(size);
    require(size == list.size());
    for (auto& element : list) get(element);
  }
  static void require(bool sound) {
    if (!sound) throw StateFault("is damaged: it contains data that no run writes");
  }
  void bytes(void* data, std::size_t size) {
    require_bytes(size);
    std::memcpy(data, left_.data(), size);
    left_.remove_prefix(size);
  }
  [[nodiscard]] bool at_end() const { return left_.empty(); }

 private:
  void require_bytes(std::size_t size) const {
    if (size > left_.size()) throw StateFault("is damaged: it is truncated");
  }

  template <class T>
  void get(T& part) {
    if constexpr (Archived<T, StateReader>) {
      part.archive(*this);
    } else if constexpr (Sequence<T>) {
      std::size_t size = 0;
      get(size);
      require_bytes(size);  // an element takes at least one byte
      part.resize(size);
      for (auto& element : part) get(element);
    } else if constexpr (std::is_same_v<T, bool>) {
      unsigned char byte = 0;
      bytes(&byte, 1);
      require(byte <= 1);
      part = byte == 1;
    } else if constexpr (is_optional<T>) {
      bool there = false;
      get(there);
      if (!there) return part.reset();
      get(part.emplace());
    } else {
      static_assert(PlainBytes<T>);
      bytes(&part, sizeof part);
    }
  }

  std::string_view left_;
};

// Whether all numbers are finite. Each object must consist of doubles only.
template <class... Objects>
[[nodiscard]] bool is_finite(const Objects&... objects) {
  const auto all = [](const auto& object) {
    constexpr std::size_t count = sizeof object / sizeof(double);
    static_assert(sizeof object % sizeof(double) == 0 &&
                  PlainBytes<std::remove_cvref_t<decltype(object)>>);
    std::array<double, count> numbers;
    std::memcpy(numbers.data(), &object, sizeof object);
    for (const double number : numbers) {
      if (!std::isfinite(number)) return false;
    }
    return true;
  };
  return (all(objects) && ...);
}

// Whether the value is finite or infinite: not a NaN.
[[nodiscard]] inline bool is_number(double value) {
  return !std::isnan(value);
}

}  // namespace bbsim
