// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The formats behind open_table() and read_table(). Only these functions use them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "file/cell_table.hpp"
#include "file/table_writer.hpp"

namespace bbsim::file {

// Both throw OutputError.
[[nodiscard]] std::unique_ptr<TableWriter> open_csv(const std::string& target,
                                                    const std::vector<ColumnHeader>& headers);
[[nodiscard]] std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                                     const std::vector<ColumnHeader>& headers);

// All throw InputError.
[[nodiscard]] TableData read_csv(const std::string& file);  // "-" is standard input
[[nodiscard]] TableData read_hdf5(const std::string& file);
[[nodiscard]] CellTable read_csv_cells(const std::string& file, const CsvChoice& choice);
[[nodiscard]] CellTable read_hdf5_cells(const std::string& file);

}  // namespace bbsim::file
