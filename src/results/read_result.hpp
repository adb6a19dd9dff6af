// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads a result from files, with the known facts of its scene.
#pragma once

#include <string>
#include <vector>

#include "results/log.hpp"
#include "results/result.hpp"

namespace bbsim::results {

// Sources for facts that a CSV file cannot hold. Each may be empty.
struct Beside {
  std::string summary;                 // written by `bbsim run --summary`
  std::string scenario;                // the scenario of the run
  std::vector<std::string> overrides;  // each "key.path=value"
};

// Reads a CSV or HDF5 file of a run or a sweep, or any other CSV file with a header; "-" is CSV on
// standard input. HDF5 files describe their scene. For a CSV without a named summary, reads
// NAME.json beside NAME.csv if it is a summary of that file, with as many rows and no older. A
// named scenario overrides both. Throws InputError. Reads a CSV as a log if nothing identifies it
// as a result of bbsim or if `log` has options.
[[nodiscard]] Result read_result(const std::string& file, const Beside& beside,
                                 const LogChoice& log = {});

// A result in memory: its columns, of one length, and its summary as `run --summary` writes it,
// which may be empty.
[[nodiscard]] Result result_of(std::vector<Column> columns, const std::string& summary);

// NAME.json beside NAME.csv, which read_result() may use; empty if there is none.
[[nodiscard]] std::string summary_beside(const std::string& file);

// Reads only the columns; `header` names those of a CSV if the file does not. Throws InputError.
[[nodiscard]] Result read_columns(const std::string& file, const std::vector<std::string>& header);

}  // namespace bbsim::results
