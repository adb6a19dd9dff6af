// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The trajectories of a sweep's cases until the sweep is done.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "file/descriptor.hpp"
#include "file/flusher.hpp"

namespace bbsim::sweep {

// Keeps each case's numbers, one series after the other, and a check of them, in a file beside a
// locked part. Every function throws OutputError.
class SeriesPart {
 public:
  // The file gets the owner and the permissions of the part.
  SeriesPart(std::string name, std::size_t numbers_a_case, int part);

  // Cases that an earlier run left, as they were written; looks at each. Those after the first that
  // is not are of no use.
  [[nodiscard]] std::size_t count_kept() const;
  void keep_only(std::size_t cases);

  // Some cases: of each series, cases * width numbers.
  void append(const std::vector<std::vector<double>>& series, std::size_t cases);
  void sync();

  // Cases first ... first + count - 1, the numbers of each after those of the last.
  void read(std::size_t first, std::size_t count, std::vector<double>& numbers) const;

  void remove() const;

 private:
  [[nodiscard]] std::size_t words() const { return numbers_ + 1; }  // of eight bytes, of a case
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
