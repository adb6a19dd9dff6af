// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes a sweep's results to a CSV or HDF5 file. The file appears whole under its final name once
// all cases are done. Until then a part holds the rows, and a later run can resume it.
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
  std::vector<file::Hdf5Column> columns;  // case first, then numbers and texts, then series
  file::Hdf5Column axis{};                // describes axis_values
  std::vector<double> axis_values{};
  std::vector<file::InputTable> inputs{};  // tables that the scenario read, kept in HDF5 only
  // Columns of 1 and 0, in the order of the sweep's expectations; the last ones but the series.
  std::size_t expectations = 0;
  // The cases are first_case ... first_case + cases - 1. They are computed in groups; the last
  // group may be smaller.
  std::size_t first_case = 0, cases = 0, group = 1;
  bool is_shard = false;  // a part to be merged later; CSV keeps the plan beside it
};

// Rows kept from an earlier, unfinished run.
struct KeptRows {
  std::size_t rows = 0;   // of the first cases, whole groups only
  StatusCounts statuses;  // of these rows
  std::string trouble;    // a sentence: why some rows were dropped; empty if none were
};

// Lines hold the fields of all columns but the series, separated by commas (file/case_text.hpp),
// and end with "\n". Functions throw OutputError.
class CaseFile {
 public:
  virtual ~CaseFile() = default;

  [[nodiscard]] virtual const KeptRows& kept() const = 0;
  // The name of the part; empty if an unfinished run leaves none.
  [[nodiscard]] virtual std::string part() const = 0;

  // Appends `rows` rows: their lines, and rows * width numbers of each series.
  virtual void append(std::string_view lines, std::size_t rows,
                      const std::vector<std::vector<double>>& series) = 0;
  // Keeps the rows so far. Call it if the run ends before all cases are done.
  virtual void interrupt() = 0;
  virtual void finish(const file::Attributes& attributes) = 0;
};

// The header of the CSV text: the names of all columns but the series.
[[nodiscard]] std::string header_of(const std::vector<file::Hdf5Column>& columns);

// Throws InputError for an ending other than .csv, .h5 and .hdf5, for series outside HDF5, and for
// `resume` on a target that keeps no part. "-" is standard output.
void check_case_target(const std::string& target, const CaseFileLayout& layout, bool resume);

// `plan` holds everything that the results depend on; `resume` accepts only a part with the same
// plan. Standard output and targets that are not regular files get CSV rows as they come. Throws
// InputError as check_case_target() does, and for a part that cannot be resumed.
[[nodiscard]] std::unique_ptr<CaseFile> open_case_file(const std::string& target,
                                                       CaseFileLayout layout,
                                                       const std::string& plan, bool resume);

// The files written beside the target until it is complete; none if rows go directly to the target.
[[nodiscard]] std::vector<std::string> case_files_beside(const std::string& target);

}  // namespace bbsim::sweep
