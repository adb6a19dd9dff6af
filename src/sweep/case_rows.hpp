// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The one reader of a sweep's CSV rows: every read is checked, and so is every row.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "file/hdf5_table.hpp"

namespace bbsim::sweep {

// Whose fault it is that a file cannot be read: it was given to us, or it is where results go.
enum class Blame { input, output };

// Throws an InputError or an OutputError.
[[noreturn]] void blame(Blame whose, const std::string& message);

// A file's lines, from its beginning, through a descriptor that stays the caller's.
class PartLines {
 public:
  PartLines(int descriptor, std::string name, Blame whose);

  // The next line, without its break, valid until the next call; false at the file's end. Throws
  // where the system cannot read.
  [[nodiscard]] bool next(std::string_view& line);
  // Whether the last line had its break.
  [[nodiscard]] bool whole() const { return whole_; }
  // Where the last line ended: bytes from the file's beginning.
  [[nodiscard]] off_t end() const { return end_; }

 private:
  [[nodiscard]] bool fill();

  int descriptor_;
  std::string name_;
  Blame whose_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, size_ = 0;  // of what of the buffer is not yet handed out
  off_t place_ = 0, end_ = 0;         // of the next read; of the last line
  bool whole_ = false;
};

// Takes rows apart. The first column is the case, a whole number.
class RowReader {
 public:
  // What a field may hold.
  enum class Field { whole_number, number, text };

  explicit RowReader(std::vector<Field> fields);
  // Rows have the columns that CSV has: all but series.
  explicit RowReader(const std::vector<file::Hdf5Column>& columns);
  // Rows are as the header says, which tells no numbers from texts before the status.
  explicit RowReader(const std::string& header);

  // Takes a row; returns what was found that is not as `bbsim sweep` writes it, empty if all is.
  [[nodiscard]] std::string read(std::string_view line);

  // What the last row held, if it was as it should be.
  [[nodiscard]] std::size_t case_number() const { return case_number_; }
  [[nodiscard]] double number(std::size_t field) const { return numbers_[field]; }
  [[nodiscard]] std::string text(std::size_t field) const;

 private:
  std::vector<Field> fields_;
  std::vector<std::string_view> cells_;
  std::vector<double> numbers_;
  std::size_t case_number_ = 0;
};

// How many cases ended in which way.
struct StatusCounts {
  std::map<std::string, std::size_t, std::less<>> words;  // by status
  std::size_t not_finite = 0;  // done, with a reason: a measure is no finite number

  void add(const std::string& status, std::string_view reason);
  void add(const StatusCounts& others);
  [[nodiscard]] std::size_t early() const;  // that did not come to their end
};

}  // namespace bbsim::sweep
