// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keeps the trajectories of a sweep's cases until the sweep is done.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "file/descriptor.hpp"
#include "file/flusher.hpp"

namespace bbsim::sweep {

// Keeps the numbers of each case, one series after the other, and their checksum, in a file beside
// a locked part. Every function throws OutputError.
class SeriesPart {
 public:
  // The file gets the owner and the permissions of the part.
  SeriesPart(std::string name, std::size_t numbers_a_case, int part);

  // Checks all cases of an earlier run. Returns the number of sound cases before the first damaged
  // one.
  [[nodiscard]] std::size_t count_kept() const;
  void keep_only(std::size_t cases);

  // Appends `cases` cases: cases * width numbers of each series.
  void append(const std::vector<std::vector<double>>& series, std::size_t cases);
  void sync();

  // Reads cases first ... first + count - 1, one case after the other.
  void read(std::size_t first, std::size_t count, std::vector<double>& numbers) const;

  void remove() const;

 private:
  [[nodiscard]] std::size_t words() const { return numbers_ + 1; }  // of 8 bytes, for each case
  [[nodiscard]] off_t place_of(std::size_t cases) const;
  [[nodiscard]] std::size_t read_words(std::size_t first, std::size_t count) const;
  [[nodiscard]] bool is_sound(std::size_t number, const double* words) const;
  [[noreturn]] void fail(const std::string& doing, int error) const;

  std::string name_;
  std::size_t numbers_, cases_ = 0;
  file::Descriptor descriptor_;
  file::Flusher flusher_;
  mutable std::vector<double> buffer_;
};

}  // namespace bbsim::sweep
