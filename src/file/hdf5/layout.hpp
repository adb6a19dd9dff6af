// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Names in our files that writer and reader share.
#pragma once

namespace bbsim::hdf5 {

// The attribute that tells the axis of series from a column.
inline constexpr const char* axis_mark = "axis";

// The group of the tables that the scenario read: of each a group, which has as an attribute the
// file's name, with a dataset a column, which has as an attribute the column's name. (HDF5 cannot
// call anything by a name with a slash.)
inline constexpr const char* inputs_group = "inputs";
inline constexpr const char* input_file = "file";
inline constexpr const char* input_title = "column";

}  // namespace bbsim::hdf5
