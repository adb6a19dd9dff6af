// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Names within bbsim's HDF5 files, for the writer and the reader.
#pragma once

namespace bbsim::file::hdf5 {

// The attribute that distinguishes an axis of series from a column.
inline constexpr const char* axis_mark = "axis";

// The group of the tables that the scenario read. Each table is a group with a dataset per column.
// Attributes hold the names of file and columns, because HDF5 names cannot contain a slash.
inline constexpr const char* inputs_group = "inputs";
inline constexpr const char* input_file = "file";
inline constexpr const char* input_title = "column";

}  // namespace bbsim::file::hdf5
