// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Cases read back, some rows at a time.
#include <algorithm>
#include <utility>

#include "base/shown.hpp"
#include "file/hdf5_input.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file {
namespace {

Hdf5Kind kind_of(bbsim_hdf5_kind kind) {
  switch (kind) {
    case BBSIM_HDF5_TEXT:
      return Hdf5Kind::text;
    case BBSIM_HDF5_SERIES:
      return Hdf5Kind::series;
    default:
      return Hdf5Kind::number;
  }
}

}  // namespace

class Hdf5TableReader::State {
 public:
  explicit State(const std::string& file) : input_(file) {
    for (std::size_t d = 0; d < input_.root_datasets(); ++d) {
      const Hdf5Dataset& dataset = input_.datasets()[d];
      Hdf5Column column{dataset.name, dataset.unit, dataset.description, kind_of(dataset.kind),
                        dataset.width};
      if (dataset.kind == BBSIM_HDF5_AXIS) {
        column.width = 1;
        axes_.emplace_back(std::move(column), std::vector<double>());
        const Hdf5Wanted wanted{d, &axes_.back().second};
        input_.read(0, dataset.rows, {&wanted, 1});
        continue;
      }
      if (!columns_.empty() && dataset.rows != rows_) {
        input_.fail("dataset " + shown(column.name) + " has " + std::to_string(dataset.rows) +
                    " rows, " + shown(columns_[0].name) + " has " + std::to_string(rows_) +
                    "; all must have the same number");
      }
      rows_ = dataset.rows;
      columns_.push_back(std::move(column));
      datasets_.push_back(d);
    }
    if (columns_.empty()) input_.fail("it holds no column of cases at its root");
  }

  [[nodiscard]] const std::vector<Hdf5Column>& columns() const { return columns_; }
  [[nodiscard]] const std::vector<Hdf5Axis>& axes() const { return axes_; }
  [[nodiscard]] const Attributes& attributes() const { return input_.attributes(); }
  [[nodiscard]] std::size_t rows() const { return rows_; }

  void read(std::size_t first, std::size_t count, Hdf5Block& into) const {
    count = first < rows_ ? std::min(count, rows_ - first) : 0;
    into.rows = count;
    into.values.resize(columns_.size());
    into.texts.resize(columns_.size());
    std::vector<Hdf5Wanted> wanted;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      into.texts[c].clear();
      into.values[c].clear();
      wanted.push_back({datasets_[c], &into.values[c], &into.texts[c]});
    }
    if (count > 0) input_.read(first, count, wanted);
  }

  [[nodiscard]] std::vector<InputTable> read_inputs() const {
    std::vector<InputTable> inputs;
    for (const auto& [file, first, count] : input_.inputs()) {
      const auto table = std::make_shared<TableData>();
      table->columns.resize(count);
      std::vector<Hdf5Wanted> wanted;
      for (std::size_t c = 0; c < count; ++c) {
        const Hdf5Dataset& dataset = input_.datasets()[first + c];
        if (dataset.kind != BBSIM_HDF5_NUMBER || dataset.rows != input_.datasets()[first].rows) {
          input_.fail("input table " + shown(file) + " is no table of numbers");
        }
        table->names.push_back(dataset.name);
        wanted.push_back({first + c, &table->columns[c]});
      }
      if (count > 0) input_.read(0, input_.datasets()[first].rows, wanted);
      inputs.push_back({file, table});
    }
    return inputs;
  }

 private:
  Hdf5Input input_;
  std::vector<Hdf5Column> columns_;
  std::vector<std::size_t> datasets_;  // of each column, as the input counts them
  std::vector<Hdf5Axis> axes_;
  std::size_t rows_ = 0;
};

Hdf5TableReader::Hdf5TableReader(const std::string& file) : state_(std::make_unique<State>(file)) {}
Hdf5TableReader::~Hdf5TableReader() = default;
Hdf5TableReader::Hdf5TableReader(Hdf5TableReader&&) noexcept = default;
Hdf5TableReader& Hdf5TableReader::operator=(Hdf5TableReader&&) noexcept = default;

const std::vector<Hdf5Column>& Hdf5TableReader::columns() const {
  return state_->columns();
}
const std::vector<Hdf5Axis>& Hdf5TableReader::axes() const {
  return state_->axes();
}
const Attributes& Hdf5TableReader::attributes() const {
  return state_->attributes();
}
std::size_t Hdf5TableReader::rows() const {
  return state_->rows();
}

std::vector<InputTable> Hdf5TableReader::read_inputs() const {
  return state_->read_inputs();
}

void Hdf5TableReader::read(std::size_t first, std::size_t count, Hdf5Block& into) const {
  state_->read(first, count, into);
}

}  // namespace bbsim::file
