// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The format in which the reader process prints the table of an HDF5 file. Both sides come from one
// build and run on one machine, so numbers are in their binary form.
//
//     a line of JSON: {"bbsim_table", "rows", "columns", "axes", "attributes", "inputs"}
//     the numbers of each axis
//     blocks of rows: the values of these rows, column by column
//     each table that the scenario read, column by column
//
// A number is a double. A series has `width` doubles per row. A text is its length, in 64 bits, and
// its bytes. Names, units and attributes are UTF-8; U+FFFD replaces invalid bytes.
#pragma once

#include <cstddef>

namespace bbsim::hdf5 {

// The version increases with every change of this format.
inline constexpr const char* table_key = "bbsim_table";
inline constexpr int table_version = 1;

// Kinds of columns.
inline constexpr const char* number_kind = "number";
inline constexpr const char* text_kind = "text";
inline constexpr const char* series_kind = "series";

inline constexpr std::size_t longest_text = std::size_t{1} << 26U;  // bytes; also for the JSON line

}  // namespace bbsim::hdf5
