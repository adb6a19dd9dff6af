// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the datasets of a file's root group, and of the tables within it, some rows at a time.
//
// What a file says of itself is not believed: a dataset that would be larger than what the file
// can hold is refused before any memory is taken for it, and so is what lies in other files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "file/hdf5/attributes.hpp"
#include "file/hdf5/handle.hpp"
#include "file/hdf5/interface.h"

namespace bbsim::hdf5 {

struct DatasetInfo {
  std::string name, unit, description;
  bbsim_hdf5_kind kind = BBSIM_HDF5_NUMBER;
  std::size_t width = 1, rows = 0;
};

// Where a reader tells what a file holds: first the root's datasets, in the file's order, then its
// attributes, then of each input table its file's name and its datasets.
struct Contents {
  std::function<void(const DatasetInfo&)> dataset;
  std::function<void(const std::string& name, const Value&)> attribute;
  std::function<void(const std::string& file)> input;
};

// Every function may throw Failure.
class Reader {
 public:
  Reader(const char* path, const Contents& contents);

  // Datasets are counted in the order in which they were told.
  [[nodiscard]] const DatasetInfo& info(std::size_t dataset) const;
  // Rows [first, first + rows), within what there is, of what is no text; an axis has `width` rows
  // of one number.
  void read_numbers(std::size_t dataset, std::size_t first, std::size_t rows, double* to) const;
  // Reads the same rows of a dataset that is a text.
  [[nodiscard]] std::vector<std::string> read_texts(std::size_t dataset, std::size_t first,
                                                    std::size_t rows) const;

 private:
  void tell_datasets(hid_t group, const std::string& path, const Contents& contents);
  void tell_inputs(hid_t root, const Contents& contents);
  void check_size(hid_t dataset, const DatasetInfo& info, const std::string& path);

  struct Open {
    DatasetInfo info;
    std::string path;  // for messages
    Dataset dataset;
  };

  File file_;
  std::uint64_t bytes_;         // of the file
  std::uint64_t declared_ = 0;  // bytes of all datasets so far, as they say
  std::vector<Open> datasets_;
};

}  // namespace bbsim::hdf5
