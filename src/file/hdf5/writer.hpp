// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes a table as one extendible dataset per column.
#pragma once

#include <string>
#include <vector>

#include "file/hdf5/handle.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file::hdf5 {

// Every function may throw Failure.
class FileWriter {
 public:
  FileWriter(const std::string& file, const std::vector<Hdf5Column>& columns,
             const std::vector<Hdf5Axis>& axes);

  void append(const Hdf5Block& block);
  void add_column(const Hdf5Column& column, const std::vector<double>& values);
  void keep(const std::vector<InputTable>& inputs);
  void finish(const Attributes& attributes);

 private:
  struct Column {
    Dataset dataset;
    Hdf5Kind kind;
    hsize_t width;
  };

  void attach_scale(const std::vector<Hdf5Column>& columns);
  void write_axis(const Hdf5Column& axis, const std::vector<double>& values);

  File file_;
  std::vector<Column> columns_;
  hid_t scale_ = -1;  // scale of the rows: a column's dataset, or -1
  hsize_t rows_ = 0;
};

}  // namespace bbsim::file::hdf5
