// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes a table as one extendible dataset per column.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "file/hdf5/handle.hpp"
#include "file/hdf5/interface.h"

namespace bbsim::hdf5 {

// Every function may throw Failure. A system error, such as a full disk, is recorded in
// system_error() and takes precedence in reports.
class Writer {
 public:
  void start(int descriptor, std::span<const bbsim_hdf5_column> columns);  // call it first
  void write_axis(const bbsim_hdf5_column& axis, const double* values);
  void append(const bbsim_hdf5_values* columns, std::size_t rows);
  void write_column(const bbsim_hdf5_column& column, const double* values);
  void write_input(const char* name, const char* file,
                   std::span<const bbsim_hdf5_input_column> columns, std::size_t rows);
  void finish(std::span<const bbsim_hdf5_attribute> attributes);

  [[nodiscard]] int system_error() const { return *system_error_; }  // an errno, 0 if none

 private:
  struct Column {
    Dataset dataset;
    bbsim_hdf5_kind kind;
    hsize_t width;
  };

  void attach_scale(std::span<const bbsim_hdf5_column> columns);

  std::unique_ptr<int> system_error_ = std::make_unique<int>(0);  // outlives file_
  File file_;
  Group inputs_;  // created for the first input
  std::vector<Column> columns_;
  hid_t scale_ = -1;  // scale of the rows: a column's dataset, or -1
  hsize_t rows_ = 0;
};

}  // namespace bbsim::hdf5
