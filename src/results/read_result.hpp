// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Files -> a result and what is known of its scene.
#pragma once

#include <string>
#include <vector>

#include "file/cell_table.hpp"
#include "results/log.hpp"
#include "results/result.hpp"

namespace bbsim::results {

// Where to look for what a CSV file has no place for. Both may be empty.
struct Beside {
  std::string summary;                 // as `bbsim run --summary` wrote it
  std::string scenario;                // the scenario that was run,
  std::vector<std::string> overrides;  // and what was set in it
};

// Reads a CSV or HDF5 file of a run or a sweep, or any other CSV file with a header; "-" is CSV on
// standard input. An HDF5 file tells of its scene itself. For a CSV without a summary named,
// NAME.json beside NAME.csv is taken if it is the summary of a run into that file, with as many
// rows. A scenario that is named comes before both. Throws InputError.
// A CSV that nothing tells to be a result of bbsim, or of which `log` says something, is read as a
// log; what was done to it is added to `notes`, if that is given.
[[nodiscard]] Result read_result(const std::string& file, const Beside& beside,
                                 const LogChoice& log = {},
                                 std::vector<std::string>* notes = nullptr);

// NAME.json beside NAME.csv, as read_result() looks for it: empty if there is none.
[[nodiscard]] std::string summary_beside(const std::string& file);

// The columns of a table that was read from a file. Adds to `notes` what was left out.
[[nodiscard]] Result result_of(file::CellTable cells, const std::string& file,
                               std::vector<std::string>& notes);

// Only the columns, of CSV; `header` names them if the file does not. Adds to `notes` what was left
// out. Throws InputError with file:line:column.
[[nodiscard]] Result read_csv_columns(const std::string& file,
                                      const std::vector<std::string>& header,
                                      std::vector<std::string>& notes);

}  // namespace bbsim::results
