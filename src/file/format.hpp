// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The format of a table from the name of its file, and what is behind open_table() and
// read_table().
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

enum class Format { csv, hdf5, other };

// Decides by the ending, in upper or lower case: .csv, .h5, .hdf5.
[[nodiscard]] Format format_of(const std::string& file);

// The ending in lower case: ".svg" for "a.SVG".
[[nodiscard]] std::string lower_ending(const std::string& file);

// Only open_table() and read_table() use these. Writers throw OutputError, readers InputError.
[[nodiscard]] std::unique_ptr<TableWriter> open_csv(const std::string& target,
                                                    const std::vector<ColumnHeader>& headers);
[[nodiscard]] std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                                     const std::vector<ColumnHeader>& headers);
[[nodiscard]] Table read_csv(const std::string& file, const CsvChoice& choice);
[[nodiscard]] Table read_hdf5(const std::string& file);

}  // namespace bbsim::file
