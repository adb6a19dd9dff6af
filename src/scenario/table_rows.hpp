// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads columns of a CSV or HDF5 file for interpolation over the run's time.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/log_columns.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

struct TableRows {
  std::string file;
  std::vector<double> times;                // s, strictly increasing, at least four that are finite
  std::vector<std::vector<double>> values;  // finite; one vector for each value key
};

// Reads {file: motion.csv, time: t, KEY: column, ...} with a KEY for each of `value_keys`, and the
// file (each file once for all scenarios that share a context). `unit` gives the unit of the values
// and `time_unit` that of the times; the default is SI, with a warning if the numbers look
// different. `header` names the columns of a CSV without a header. `scale`, `offset`, `delay` and
// `time_offset` change the rows. A delayed table, and one that ends at most a period before the
// run, have rows at times of -infinity and infinity that hold the end values. Reports all faults;
// `into.values` may then stay empty.
void read_table_rows(yaml::Keys& keys, const std::vector<std::string_view>& value_keys,
                     yaml::Dimension dimension, TableRows& into);

// Columns of one file, all of one dimension.
struct FileColumns {
  std::string file;
  std::vector<std::vector<double>> columns;  // in SI units; finite
  bool has_unit = false;                     // the scenario or a column's name gives a unit
};

// Reads the columns that `column_keys` name. Returns false after reporting a fault. `unit` (for
// times also `time_unit`) works as above, but the caller issues the warning.
bool read_columns(yaml::Keys& keys, const std::vector<std::string_view>& column_keys,
                  yaml::Dimension dimension, FileColumns& into);

// Warns, at the mapping of a table, that numbers of a file do not look like SI units. `what`
// describes them: "value goes up to 12". `key` is the key that states the unit.
void warn_of_unit(const yaml::Value& table, const std::string& file, const std::string& what,
                  yaml::Dimension dimension, const Doubt& doubt, std::string_view key);

}  // namespace bbsim::scenario
