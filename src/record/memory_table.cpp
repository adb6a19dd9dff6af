#include "record/memory_table.hpp"

#include <string>
#include <utility>

namespace bbsim::record {

MemoryTable::MemoryTable(const std::vector<const Column*>& columns, TableWriter* beside,
                         std::size_t columns_beside)
    : beside_(beside), columns_beside_(columns_beside) {
  for (const Column* column : columns) table_.names.emplace_back(column->name);
  table_.columns.resize(columns.size());
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

}  // namespace bbsim::record
