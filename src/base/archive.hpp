// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The state of objects as bytes, and back: for a run that is gone on with by another process.
//
// A class has one function for both ways, which says what the parts must be like:
//     template <class Archive> void archive(Archive& archive) {
//       archive(speed_, queue_);
//       archive.require(is_finite(speed_));
//     }
// Bytes are those of this build on this kind of machine: whoever keeps them says which. They may
// have been changed on the way, on purpose, too: all that is counted, chosen or waited for by them
// is checked, so that they lead nowhere a run could not.
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

// Numbers alone: what could be no value of its type has a function of its own.
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

// The bytes are no state of such a run. what() is a sentence's end: "is cut short".
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
  // One of an enumeration's values, from 0 to `last`.
  template <class Enumeration>
  void enumerated(Enumeration& value, Enumeration /*last*/) {
    bytes(&value, sizeof value);
  }
  // Numbers, as many as there are in this run.
  template <Sequence List>
  void fixed(List& list) {
    put(list);
  }
  // What holds of the state of any run.
  static void require(bool /*sound*/) {}
  // Some bytes that are no object of a type.
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

// Throws StateFault where the bytes end too soon, or are not what is required.
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
      require_bytes(size);  // no element takes less than a byte
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

// Of objects that are nothing but doubles: whether all are finite.
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

// Whether it is a number, or infinite.
[[nodiscard]] inline bool is_number(double value) {
  return !std::isnan(value);
}

}  // namespace bbsim
