// The state of objects as bytes, and back: for a run that is gone on with by another process.
//
// A class has one function for both ways,
//     template <class Archive> void archive(Archive& archive) { archive(speed_, queue_); }
// Bytes are those of this build on this kind of machine: whoever keeps them says which.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/error.hpp"

namespace bbsim {

template <class T>
concept PlainBytes = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

template <class T, class Archive>
concept Archived = requires(T& object, Archive& archive) {
  object.archive(archive);
};

template <class T>
concept Sequence = requires(T& list) {
  list.resize(1);
  list.begin();
};

class StateWriter {
 public:
  template <class... Parts>
  void operator()(Parts&... parts) {
    (put(parts), ...);
  }
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
    } else {
      static_assert(PlainBytes<T>);
      bytes(&part, sizeof part);
    }
  }

  std::string bytes_;
};

// Throws InputError where the bytes end too soon.
class StateReader {
 public:
  explicit StateReader(std::string_view from) : left_(from) {}

  template <class... Parts>
  void operator()(Parts&... parts) {
    (get(parts), ...);
  }
  void bytes(void* data, std::size_t size) {
    if (size > left_.size()) throw InputError("the state of the run is cut short");
    std::memcpy(data, left_.data(), size);
    left_.remove_prefix(size);
  }
  [[nodiscard]] bool at_end() const { return left_.empty(); }

 private:
  template <class T>
  void get(T& part) {
    if constexpr (Archived<T, StateReader>) {
      part.archive(*this);
    } else if constexpr (Sequence<T>) {
      std::size_t size = 0;
      get(size);
      // No element takes less than a byte.
      if (size > left_.size()) throw InputError("the state of the run is cut short");
      part.resize(size);
      for (auto& element : part) get(element);
    } else {
      static_assert(PlainBytes<T>);
      bytes(&part, sizeof part);
    }
  }

  std::string_view left_;
};

}  // namespace bbsim
