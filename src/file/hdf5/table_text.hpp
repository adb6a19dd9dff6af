// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How the reader, a process of its own, prints the table of an HDF5 file. Both sides are of one
// build on one machine, so numbers are as in memory.
//
//     a line of JSON: {"bbsim_table", "rows", "columns", "axes", "attributes", "inputs"}
//     each axis: its numbers
//     blocks of rows: each column's of these rows, one column after the other
//     each table that the scenario read: its columns, one after the other
//
// A number is a double; a series has `width` of them a row; a text is its length, of 64 bits, and
// its bytes. Names, units and attributes are UTF-8; bytes that are not are replaced by U+FFFD.
#pragma once

#include <cstddef>

namespace bbsim::hdf5 {

// Grows with every change of the above.
inline constexpr const char* table_key = "bbsim_table";
inline constexpr int table_version = 1;

// What a column holds.
inline constexpr const char* number_kind = "number";
inline constexpr const char* text_kind = "text";
inline constexpr const char* series_kind = "series";

inline constexpr std::size_t longest_text = std::size_t{1} << 26U;  // bytes; of a head, too

}  // namespace bbsim::hdf5
