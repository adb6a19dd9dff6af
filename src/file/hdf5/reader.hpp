// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the datasets of a file's root group, some rows at a time, and its input tables.
//
// The reader refuses data in other files, and a dataset that declares more than the file can hold.
// Other damage is left to the HDF5 library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "file/hdf5/handle.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file::hdf5 {

// Every function may throw Failure.
class FileReader {
 public:
  FileReader(const std::string& file, Hdf5Head& head);

  // Reads rows [first, first + rows). They must exist.
  void read(std::size_t first, std::size_t rows, Hdf5Block& into) const;
  [[nodiscard]] std::vector<InputTable> read_inputs() const;

 private:
  struct Column {
    Hdf5Column about;
    std::string path;  // for messages
    std::size_t rows = 0;
    bool is_axis = false;
    Dataset dataset{};
  };

  [[nodiscard]] std::vector<Column> columns_of(hid_t group, const std::string& path) const;
  [[nodiscard]] Column column_of(hid_t dataset, const std::string& name,
                                 const std::string& path) const;
  void check_size(const Column& column) const;

  File file_;
  std::uint64_t bytes_;  // size of the file
  std::vector<Column> columns_;
};

}  // namespace bbsim::file::hdf5
