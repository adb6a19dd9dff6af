// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The results of a sweep on their way into a file: CSV or HDF5, whole under its final name once all
// cases are there, and until then a part that can be gone on with.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "file/hdf5_table.hpp"
#include "file/table_writer.hpp"
#include "sweep/case_rows.hpp"

namespace bbsim::sweep {

struct CaseFileLayout {
  std::vector<file::Hdf5Column> columns;  // the case, then numbers and texts, then series
  file::Hdf5Column axis{};                // of the series, if there are any
  std::vector<double> axis_values{};
  std::vector<file::InputTable> inputs{};  // what the scenario read, for HDF5
  // Which cases come, and in groups of how many they are computed, the last one less perhaps.
  std::size_t first_case = 0, cases = 0, group = 1;
  bool is_shard = false;  // a part of a sweep, to be merged: CSV keeps its plan beside it
};

// Rows that an earlier, unfinished run left.
struct KeptRows {
  std::size_t rows = 0;   // of the first cases, in whole groups
  StatusCounts statuses;  // of these
  std::string trouble;    // why not all that is there is kept, a sentence; empty if it is
};

// What a row of all columns but the series is: fields parted by commas (file/case_text.hpp) and
// "\n". Functions throw OutputError.
class CaseFile {
 public:
  virtual ~CaseFile() = default;

  [[nodiscard]] virtual const KeptRows& kept() const = 0;
  // The name of the part, empty if nothing stays of an unfinished run.
  [[nodiscard]] virtual std::string part() const = 0;

  // Some rows; of each series, rows * width numbers.
  virtual void append(std::string_view lines, std::size_t rows,
                      const std::vector<std::vector<double>>& series) = 0;
  // To be called for an end before all cases are there: what is there stays, whatever happens then.
  virtual void interrupt() = 0;
  virtual void finish(const file::Attributes& attributes) = 0;
};

// The header of its CSV: the names of all columns but the series.
[[nodiscard]] std::string header_of(const std::vector<file::Hdf5Column>& columns);

// Throws InputError for another ending than .csv, .h5 and .hdf5, for series anywhere but in HDF5,
// and for what cannot be resumed on. "-" is standard output.
void check_case_target(const std::string& target, const CaseFileLayout& layout, bool resume);

// `plan` says all that the results depend on, so that with `resume` no other sweep's part is taken
// up. Standard output, and what is no regular file, gets CSV as it comes. Throws InputError for a
// target as above, and for a part that cannot be gone on with.
[[nodiscard]] std::unique_ptr<CaseFile> open_case_file(const std::string& target,
                                                       CaseFileLayout layout,
                                                       const std::string& plan, bool resume);

// What is written beside the target until then; nothing where rows go as they come.
[[nodiscard]] std::vector<std::string> case_files_beside(const std::string& target);

}  // namespace bbsim::sweep
