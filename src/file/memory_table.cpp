// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/memory_table.hpp"

#include <utility>

namespace bbsim::file {

MemoryTable::MemoryTable(std::vector<std::string> names, TableWriter* beside,
                         std::size_t columns_beside)
    : beside_(beside), columns_beside_(columns_beside) {
  table_.columns.resize(names.size());
  table_.names = std::move(names);
}

void MemoryTable::append(std::span<const double* const> columns, std::size_t rows) {
  if (beside_ != nullptr) beside_->append(columns.first(columns_beside_), rows);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    table_.columns[c].insert(table_.columns[c].end(), columns[c], columns[c] + rows);
  }
}

TableData MemoryTable::take() {
  return std::exchange(table_, {});
}

}  // namespace bbsim::file
