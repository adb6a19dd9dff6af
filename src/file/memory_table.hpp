// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Keeps rows in memory, optionally beside a file.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "file/table_writer.hpp"

namespace bbsim::file {

class MemoryTable : public TableWriter {
 public:
  // `beside` may be null. Otherwise it receives the first `columns_beside` columns of all rows as
  // they arrive; its owner finishes it.
  explicit MemoryTable(const std::vector<std::string>& names, TableWriter* beside = nullptr,
                       std::size_t columns_beside = 0)
      : table_(names, std::vector<std::vector<double>>(names.size())),
        beside_(beside),
        columns_beside_(columns_beside) {}

  void append(std::span<const double* const> columns, std::size_t rows) override {
    if (beside_ != nullptr) beside_->append(columns.first(columns_beside_), rows);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      std::vector<double>& numbers = table_.columns[c].numbers;
      numbers.insert(numbers.end(), columns[c], columns[c] + rows);
    }
    table_.rows += rows;
  }
  void finish(const Attributes&) override {}

  // Takes the rows out of the object.
  [[nodiscard]] Table take() { return std::exchange(table_, {}); }

 private:
  Table table_;
  TableWriter* beside_;
  std::size_t columns_beside_;
};

}  // namespace bbsim::file
