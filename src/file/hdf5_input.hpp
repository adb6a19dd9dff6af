// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5 files that the program reads, by way of a process of their own.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "file/attributes.hpp"
#include "file/hdf5/interface.h"
#include "file/hdf5_process.hpp"

namespace bbsim::file {

struct Hdf5Dataset {
  std::string name, unit, description;
  bbsim_hdf5_kind kind = BBSIM_HDF5_NUMBER;
  std::size_t width = 1, rows = 0;
};

// Datasets first ... first + count - 1 are the columns of a table that a scenario read.
struct Hdf5InputTable {
  std::string file;
  std::size_t first = 0, count = 0;
};

// Where a dataset's rows go: texts of a text, numbers of all else, `width` a row.
struct Hdf5Wanted {
  std::size_t dataset;
  std::vector<double>* numbers = nullptr;
  std::vector<std::string>* texts = nullptr;
};

// Every function throws InputError.
class Hdf5Input {
 public:
  explicit Hdf5Input(const std::string& file);
  ~Hdf5Input();
  Hdf5Input(const Hdf5Input&) = delete;
  Hdf5Input& operator=(const Hdf5Input&) = delete;

  // In the file's order; those of the root come first.
  [[nodiscard]] const std::vector<Hdf5Dataset>& datasets() const { return datasets_; }
  [[nodiscard]] std::size_t root_datasets() const;
  [[nodiscard]] const std::vector<Hdf5InputTable>& inputs() const { return inputs_; }
  // The root's, those that are a text or a number.
  [[nodiscard]] const Attributes& attributes() const { return attributes_; }

  // Rows [first, first + rows) of some datasets, within what there is; an axis has `width` rows of
  // one number.
  void read(std::size_t first, std::size_t rows, std::span<const Hdf5Wanted> wanted) const;

  [[noreturn]] void fail(std::string_view reason) const;

 private:
  void open();
  void add_dataset(const std::string& message);
  void add_attribute(const std::string& message);
  void take_numbers(Hdf5Talk& talk, const Hdf5Dataset& dataset, std::size_t rows,
                    std::vector<double>& numbers) const;
  void take_texts(Hdf5Talk& talk, std::size_t rows, std::vector<std::string>& texts) const;

  std::string file_;
  std::shared_ptr<Hdf5Process> process_;
  std::uint64_t number_ = 0;  // of the file, as the process counts
  bool is_open_ = false;
  std::vector<Hdf5Dataset> datasets_;
  std::vector<Hdf5InputTable> inputs_;
  Attributes attributes_;
};

}  // namespace bbsim::file
