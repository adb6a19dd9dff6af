// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5 tables of numbers, as runs write them.
#include <algorithm>
#include <utility>

#include "base/shown.hpp"
#include "file/formats.hpp"
#include "file/hdf5_input.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file {
namespace {

// A slash in a name would make groups: d(x)/d(ball.radius) becomes d(x)_d(ball.radius).
Hdf5Column column_of(const ColumnHeader& header) {
  std::string name(header.name);
  std::ranges::replace(name, '/', '_');
  return {std::move(name), std::string(header.unit), std::string(header.meaning)};
}

// A table of numbers alone.
class Hdf5Writer final : public TableWriter {
 public:
  Hdf5Writer(const std::string& target, const std::vector<Hdf5Column>& columns)
      : table_(target, columns, {}, Durable::no) {}

  void append(std::span<const double* const> columns, std::size_t rows) override {
    table_.append(columns, rows);
  }
  void add_column(const ColumnHeader& header, const std::vector<double>& values) override {
    table_.add_column(column_of(header), values);
  }
  void keep(const std::vector<InputTable>& inputs) override { table_.keep(inputs); }
  void finish(const Attributes& attributes) override { table_.finish(attributes); }

 private:
  Hdf5TableWriter table_;
};

const char* why_no_column(bbsim_hdf5_kind kind) {
  switch (kind) {
    case BBSIM_HDF5_TEXT:
      return "text";
    case BBSIM_HDF5_SERIES:
      return "several numbers a row, in two dimensions";
    case BBSIM_HDF5_AXIS:
      return "the axis of other datasets";
    default:
      return nullptr;
  }
}

}  // namespace

std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                       const std::vector<ColumnHeader>& headers) {
  std::vector<Hdf5Column> columns;
  for (const ColumnHeader& header : headers) columns.push_back(column_of(header));
  return std::make_unique<Hdf5Writer>(target, columns);
}

TableData read_hdf5(const std::string& file) {
  const Hdf5Input input(file);
  const std::span<const Hdf5Dataset> datasets(input.datasets().data(), input.root_datasets());
  if (datasets.empty()) input.fail("it holds no datasets at its root");
  const Hdf5Dataset& first = datasets.front();
  TableData table;
  for (const Hdf5Dataset& dataset : datasets) {
    if (const char* held = why_no_column(dataset.kind)) {
      input.fail("dataset " + shown(dataset.name) + " is no column of numbers: it holds " + held);
    }
    if (dataset.rows != first.rows) {
      input.fail("dataset " + shown(dataset.name) + " has " + std::to_string(dataset.rows) +
                 " rows, " + shown(first.name) + " has " + std::to_string(first.rows) +
                 "; all must have the same number");
    }
    table.names.push_back(dataset.name);
  }
  table.columns.resize(datasets.size());
  std::vector<Hdf5Wanted> wanted;
  for (std::size_t d = 0; d < datasets.size(); ++d) wanted.push_back({d, &table.columns[d]});
  input.read(0, first.rows, wanted);
  return table;
}

}  // namespace bbsim::file
