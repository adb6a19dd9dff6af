// Columns of a CSV or HDF5 file, to be interpolated over the time of the run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "yaml/schema.hpp"

namespace bbsim::scenario {

struct TableRows {
  std::string file;
  std::vector<double> times;                // s, strictly increasing, at least four
  std::vector<std::vector<double>> values;  // finite, one vector for each of the keys of values
};

// Reads {file: motion.csv, time: t, KEY: column, ...}, with a key for each of `value_keys`, and the
// file, once a scenario. `noun` says what a value is: "angle". Where something is wrong it is
// reported, and `into.values` may stay empty.
void read_table_rows(yaml::Keys& keys, const std::vector<std::string_view>& value_keys,
                     std::string_view noun, TableRows& into);

// Reads the columns that the keys name of the file that `file` names, whole and finite; false after
// reporting what is wrong. `noun` as above.
bool read_columns(yaml::Keys& keys, const std::vector<std::string_view>& column_keys,
                  std::string_view noun, std::string& file,
                  std::vector<std::vector<double>>& columns);

}  // namespace bbsim::scenario
