// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the program and its HDF5 reader, a process of its own, say to each other: requests go one
// way, answers the other. Both are of one build on one machine, so numbers are as in memory.
//
//     open PATH                -> (input | dataset | attribute)... opened FILE
//     read FILE ROWS DATASETS  -> (numbers | texts)... done
//     close FILE               -> nothing
//
// `failed WHY` may come instead of any answer, and ends what was asked for.
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace bbsim::hdf5 {

// The reader begins with it. Grows with every change below.
inline constexpr std::uint64_t protocol = 0x6262'7369'6d00'0001;

enum class Message : std::uint32_t {
  open = 1,   // path
  read,       // file, first row, rows, then datasets as they were counted
  close,      // file
  ready,      // protocol
  input,      // name of a table's file; the datasets that come next are its columns
  dataset,    // kind, width, rows, name, unit, description
  attribute,  // name, then 0 and a text, 1 and a double's bits, or 2 and a whole number
  opened,     // file
  numbers,    // doubles, any number of them
  texts,      // texts, any number of them
  done,
  failed,  // text
};

// Each message begins with this.
struct Head {
  Message what{};
  std::uint32_t bytes = 0;  // that follow
};

// No message has more bytes than this, whoever sends it.
inline constexpr std::uint32_t most_bytes = std::uint32_t{1} << 26U;

// Puts a message together.
class Packer {
 public:
  Packer& number(std::uint64_t value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    return *this;
  }
  Packer& text(std::string_view value) {
    number(value.size());
    bytes_ += value;
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Takes one apart. Throws std::runtime_error where there is less than is asked for.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : bytes_(bytes) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view text() { return take(number()); }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > bytes_.size()) throw std::runtime_error("a message ends too early");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  std::string_view bytes_;
};

}  // namespace bbsim::hdf5
