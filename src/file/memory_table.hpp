// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keeps rows in memory, optionally beside a file.
#pragma once

#include <string>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

class MemoryTable : public TableWriter {
 public:
  // `beside` may be null. Otherwise it receives the first `columns_beside` columns of all rows as
  // they arrive; its owner finishes it.
  explicit MemoryTable(const std::vector<std::string>& names, TableWriter* beside = nullptr,
                       std::size_t columns_beside = 0);

  void append(std::span<const double* const> columns, std::size_t rows) override;
  void finish(const Attributes&) override {}

  // Takes the rows out of the object.
  [[nodiscard]] Table take();

 private:
  Table table_;
  TableWriter* beside_;
  std::size_t columns_beside_;
};

}  // namespace bbsim::file
