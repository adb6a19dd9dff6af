// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the CSV rows of sweeps and checks each of them.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "file/hdf5_table.hpp"

namespace bbsim::sweep {

// Origin of a file, which selects the type of errors: InputError if the user gave the file,
// OutputError if it holds results.
enum class Blame { input, output };

// Throws InputError or OutputError.
[[noreturn]] void blame(Blame whose, const std::string& message);

// Reads the lines of a file from its beginning. The caller keeps the descriptor.
class PartLines {
 public:
  PartLines(int descriptor, std::string name, Blame whose);

  // Gets the next line without its line break, valid until the next call. Returns false at the end
  // of the file. Throws if the system cannot read.
  [[nodiscard]] bool next(std::string_view& line);
  // Whether the last line had its line break.
  [[nodiscard]] bool whole() const { return whole_; }
  // End of the last line, in bytes from the beginning of the file.
  [[nodiscard]] off_t end() const { return end_; }

 private:
  [[nodiscard]] bool fill();

  int descriptor_;
  std::string name_;
  Blame whose_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, size_ = 0;  // of the unread bytes in the buffer
  off_t place_ = 0, end_ = 0;         // of the next read; end of the last line
  bool whole_ = false;
};

// Splits rows into fields. The first field is the number of the case.
class RowReader {
 public:
  // The permitted content of a field.
  enum class Field { whole_number, number, text };

  explicit RowReader(std::vector<Field> fields);
  // Expects the columns of the CSV text: all but the series.
  explicit RowReader(const std::vector<file::Hdf5Column>& columns);
  // Takes the columns from a CSV header. The header does not tell which fields before the status
  // are numbers, so these are read as text.
  explicit RowReader(const std::string& header);

  // Splits a row. Returns the first difference from a row of `bbsim sweep`; empty if the row is
  // sound.
  [[nodiscard]] std::string read(std::string_view line);

  // The content of the last row, if it was sound.
  [[nodiscard]] std::size_t case_number() const { return case_number_; }
  [[nodiscard]] double number(std::size_t field) const { return numbers_[field]; }
  [[nodiscard]] std::string text(std::size_t field) const;

 private:
  std::vector<Field> fields_;
  std::vector<std::string_view> cells_;
  std::vector<double> numbers_;
  std::size_t case_number_ = 0;
};

// A case that ended early, or that misses an expectation.
struct FailedCase {
  std::size_t number = 0;
  std::string status, reason;
};

// How many cases ended with each status, and how many miss each expectation.
struct StatusCounts {
  std::map<std::string, std::size_t, std::less<>> words;  // by status
  std::size_t not_finite = 0;      // status done with a reason: a measure is not finite
  std::vector<std::size_t> unmet;  // by expectation
  std::vector<FailedCase> failed;  // the first most_failed of them

  static constexpr std::size_t most_failed = 20;

  // In the order of the cases; add_expected() after add() of the same case.
  void add(std::size_t number, const std::string& status, std::string_view reason);
  void add_expected(std::size_t number, std::size_t which, bool holds);
  void add(const StatusCounts& others);
  [[nodiscard]] std::size_t early() const;  // cases that ended before their end time
};

}  // namespace bbsim::sweep
