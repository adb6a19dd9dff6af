// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Columns of a CSV or HDF5 file, to be interpolated over the time of the run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scenario/unit_doubts.hpp"
#include "yaml/schema.hpp"

namespace bbsim::scenario {

struct TableRows {
  std::string file;
  std::vector<double> times;                // s, strictly increasing, at least four
  std::vector<std::vector<double>> values;  // finite, one vector for each of the keys of values
};

// Reads {file: motion.csv, time: t, KEY: column, ...}, with a key for each of `value_keys`, and the
// file, once a scenario. `unit`, one of the dimension of the values, and `time_unit` say what the
// numbers are in; without them they are in SI, and those that do not look like it are warned of.
// Where something is wrong it is reported, and `into.values` may stay empty.
void read_table_rows(yaml::Keys& keys, const std::vector<std::string_view>& value_keys,
                     yaml::Dimension dimension, TableRows& into);

// The columns that keys name of the file that `file` names, all of one dimension.
struct FileColumns {
  std::string file;
  std::vector<std::vector<double>> columns;  // in SI; finite
  bool has_unit = false;                     // one was given
};

// Reads them; false after reporting what is wrong. `unit`, of times `time_unit` too, as above, but
// that it is left to the caller to warn.
bool read_columns(yaml::Keys& keys, const std::vector<std::string_view>& column_keys,
                  yaml::Dimension dimension, FileColumns& into);

// Warns, at the mapping of a table, of numbers of a file that are not in the SI unit that they are
// read in, by their looks. `what` is "value goes up to 12" or the like; `key` is the one that says
// which unit it is.
void warn_of_unit(const yaml::Value& table, const std::string& file, const std::string& what,
                  yaml::Dimension dimension, const Doubt& doubt, std::string_view key);

}  // namespace bbsim::scenario
