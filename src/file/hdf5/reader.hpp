// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the datasets of a file's root group and of its input tables, some rows at a time.
//
// The reader does not trust the file. It refuses data in other files. It refuses a dataset that
// declares more than the file can hold, before it allocates memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
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

// A table that the scenario read: datasets first ... first + count - 1 are its columns.
struct InputInfo {
  std::string file;
  std::size_t first = 0, count = 0;
};

// Every function may throw Failure.
class Reader {
 public:
  // Calls `got_on`, as a sign of progress, after each dataset and attribute.
  Reader(const char* path, void (*got_on)());

  // Datasets are numbered in the file's order: first those of the root, then those of the inputs.
  [[nodiscard]] std::size_t root_datasets() const { return root_datasets_; }
  [[nodiscard]] const DatasetInfo& info(std::size_t dataset) const {
    return datasets_.at(dataset).info;
  }
  [[nodiscard]] const std::vector<InputInfo>& inputs() const { return inputs_; }
  // The root attributes that are a text or a number.
  [[nodiscard]] const std::vector<std::pair<std::string, Value>>& attributes() const {
    return attributes_;
  }
  // Reads rows [first, first + rows) of a dataset that is not a text. The rows must exist. An axis
  // has `width` rows of one number.
  void read_numbers(std::size_t dataset, std::size_t first, std::size_t rows, double* to) const;
  // Reads rows of a text dataset likewise.
  [[nodiscard]] std::vector<std::string> read_texts(std::size_t dataset, std::size_t first,
                                                    std::size_t rows) const;

 private:
  void find_datasets(hid_t group, const std::string& path);
  void find_attributes(hid_t root);
  void find_inputs(hid_t root);
  void check_size(hid_t dataset, const DatasetInfo& info, const std::string& path);

  struct Open {
    DatasetInfo info;
    std::string path;  // for messages
    Dataset dataset;
  };

  void (*got_on_)();
  File file_;
  std::uint64_t bytes_;         // size of the file
  std::uint64_t declared_ = 0;  // bytes that all datasets so far declare
  std::vector<Open> datasets_;
  std::size_t root_datasets_ = 0;
  std::vector<InputInfo> inputs_;
  std::vector<std::pair<std::string, Value>> attributes_;
};

}  // namespace bbsim::hdf5
