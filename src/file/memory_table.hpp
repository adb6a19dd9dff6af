// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rows kept in memory, alone or beside a file.
#pragma once

#include <string>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

class MemoryTable : public TableWriter {
 public:
  // Columns of these names. `beside`, which may be null, gets the first `columns_beside` columns of
  // all rows, too, as they come; finishing it is left to its owner.
  explicit MemoryTable(std::vector<std::string> names, TableWriter* beside = nullptr,
                       std::size_t columns_beside = 0);

  void append(std::span<const double* const> columns, std::size_t rows) override;
  void finish(const Attributes&) override {}

  // What was kept. Nothing is left.
  [[nodiscard]] TableData take();

 private:
  TableData table_;
  TableWriter* beside_;
  std::size_t columns_beside_;
};

}  // namespace bbsim::file
