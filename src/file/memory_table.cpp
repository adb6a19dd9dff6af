// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/memory_table.hpp"

#include <utility>

namespace bbsim::file {

MemoryTable::MemoryTable(const std::vector<std::string>& names, TableWriter* beside,
                         std::size_t columns_beside)
    : table_(names, std::vector<std::vector<double>>(names.size())),
      beside_(beside),
      columns_beside_(columns_beside) {}

void MemoryTable::append(std::span<const double* const> columns, std::size_t rows) {
  if (beside_ != nullptr) beside_->append(columns.first(columns_beside_), rows);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<double>& numbers = table_.columns[c].numbers;
    numbers.insert(numbers.end(), columns[c], columns[c] + rows);
  }
  table_.rows += rows;
}

Table MemoryTable::take() {
  return std::exchange(table_, {});
}

}  // namespace bbsim::file
