// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The formats behind open_table() and read_table(). Only these functions use them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

// Both throw OutputError.
[[nodiscard]] std::unique_ptr<TableWriter> open_csv(const std::string& target,
                                                    const std::vector<ColumnHeader>& headers);
[[nodiscard]] std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                                     const std::vector<ColumnHeader>& headers);

// All throw InputError.
[[nodiscard]] Table read_csv(const std::string& file, const CsvChoice& choice);
[[nodiscard]] Table read_hdf5(const std::string& file);

}  // namespace bbsim::file
