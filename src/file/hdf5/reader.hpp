// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads the datasets of a file's root group, and of the tables within it, some rows at a time.
//
// What a file says of itself is not believed: a dataset that would be larger than what the file
// can hold is refused before any memory is taken for it, and so is what lies in other files.
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
  // Calls `got_on` after each dataset and attribute that it finds.
  Reader(const char* path, void (*got_on)());

  // Datasets are counted in the file's order, those of the root first, then those of the inputs.
  [[nodiscard]] std::size_t root_datasets() const { return root_datasets_; }
  [[nodiscard]] const DatasetInfo& info(std::size_t dataset) const {
    return datasets_.at(dataset).info;
  }
  [[nodiscard]] const std::vector<InputInfo>& inputs() const { return inputs_; }
  // The root's, those that are a text or a number.
  [[nodiscard]] const std::vector<std::pair<std::string, Value>>& attributes() const {
    return attributes_;
  }
  // Rows [first, first + rows), within what there is, of what is no text; an axis has `width` rows
  // of one number.
  void read_numbers(std::size_t dataset, std::size_t first, std::size_t rows, double* to) const;
  // Reads the same rows of a dataset that is a text.
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
  std::uint64_t bytes_;         // of the file
  std::uint64_t declared_ = 0;  // bytes of all datasets so far, as they say
  std::vector<Open> datasets_;
  std::size_t root_datasets_ = 0;
  std::vector<InputInfo> inputs_;
  std::vector<std::pair<std::string, Value>> attributes_;
};

}  // namespace bbsim::hdf5
