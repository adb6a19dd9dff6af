// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Names within bbsim's HDF5 files, for the writer and the reader.
#pragma once

#include <algorithm>
#include <string>

namespace bbsim::file::hdf5 {

// The attribute that distinguishes an axis of series from a column.
inline constexpr const char* axis_mark = "axis";

// The group of the tables that the scenario read. Each table is a group with a dataset per column.
inline constexpr const char* inputs_group = "inputs";
inline constexpr const char* input_file = "file";

// The attribute with the name of a column that a dataset cannot have: HDF5 names have no slash.
inline constexpr const char* column_title = "column";

[[nodiscard]] inline std::string dataset_name(std::string column) {
  std::ranges::replace(column, '/', '_');
  return column;
}

}  // namespace bbsim::file::hdf5
