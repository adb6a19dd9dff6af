// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes HDF5 files through the HDF5 module, with its errors as OutputError.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "file/atomic_file.hpp"
#include "file/hdf5/interface.h"
#include "file/table_writer.hpp"

namespace bbsim::file {

// An HDF5 file that gets its final name when it is complete. Arguments are as in the module's
// interface (hdf5/interface.h). Every function throws OutputError; the object may then only be
// destroyed. If the HDF5 library crashes, the program ends as for an uncaught error.
class Hdf5Output {
 public:
  Hdf5Output(const Hdf5Output&) = delete;
  Hdf5Output& operator=(const Hdf5Output&) = delete;

  // Throws before any work is done if the target cannot be written.
  Hdf5Output(const std::string& target, std::span<const bbsim_hdf5_column> columns,
             Durable durable = Durable::no);

  void write_axis(const bbsim_hdf5_column& axis, const double* values);
  void append(const bbsim_hdf5_values* columns, std::size_t rows);
  // Writes a column with as many values as rows have been appended.
  void write_column(const bbsim_hdf5_column& column, const double* values);
  void write_inputs(const std::vector<InputTable>& inputs);
  // Completes the file and puts it under its final name. Without this call no file remains.
  void finish(const Attributes& attributes);

 private:
  void check_open() const;
  // Calls a function of the module with a place for its error. Throws if the function fails.
  template <class Function>
  void call(const Function& function);
  [[noreturn]] void fail(const bbsim_hdf5_error& error);

  struct Destroy {
    const Hdf5Output* output;
    void operator()(bbsim_hdf5_writer* writer) const;
  };

  std::string target_;
  std::string message_of_crash_;
  const bbsim_hdf5_module& module_;
  AtomicFile file_;  // outlives writer_, which writes to its descriptor
  std::unique_ptr<bbsim_hdf5_writer, Destroy> writer_;
};

// Throws OutputError if this program cannot write HDF5.
void require_hdf5(const std::string& target);

}  // namespace bbsim::file
