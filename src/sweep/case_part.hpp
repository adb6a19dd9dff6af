// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads and writes the rows of cases in the part of a sweep.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sweep/case_file.hpp"
#include "sweep/part_file.hpp"

namespace bbsim::sweep {

// Checks every row that it reads, including those that it wrote. Functions throw OutputError.
class CasePart {
 public:
  CasePart(const std::string& target, const CaseFileLayout& layout, const std::string& plan,
           bool resume);

  // Reads the rows of an earlier run. Keeps whole groups up to the first damaged row, and at most
  // the first `most` cases, whose trajectories are sound. Call it once, before append().
  void resume(std::size_t most);
  [[nodiscard]] const KeptRows& kept() const { return kept_; }

  [[nodiscard]] sweep::PartFile& file() { return file_; }
  [[nodiscard]] const sweep::PartFile& file() const { return file_; }

  void append(std::string_view lines, std::size_t rows);
  // Throws unless there is a row for each case of the sweep.
  void check_complete(std::size_t rows) const;
  void check_complete() const { check_complete(rows_); }

  // Calls use(reader) for each row and throws if a row is damaged. Returns the number of rows.
  template <class Use>
  std::size_t read(Use use) const {
    PartLines lines(file_.descriptor(), file_.name(), Blame::output);
    RowReader reader(layout_.columns);
    std::string_view line;
    std::size_t rows = 0;
    for (bool header = true; lines.next(line); header = false) {
      const std::string fault = header ? fault_of_header(line, lines.whole())
                                       : fault_of(line, lines.whole(), rows, reader);
      if (!fault.empty()) refuse(fault);
      if (header) continue;
      use(reader);
      ++rows;
    }
    return rows;
  }

 private:
  [[nodiscard]] std::string fault_of_header(std::string_view line, bool whole) const;
  [[nodiscard]] std::string fault_of(std::string_view line, bool whole, std::size_t row,
                                     RowReader& reader) const;
  [[noreturn]] void refuse(const std::string& fault) const;

  const CaseFileLayout& layout_;
  std::string header_;
  sweep::PartFile file_;
  KeptRows kept_;
  std::size_t rows_ = 0;
};

}  // namespace bbsim::sweep
