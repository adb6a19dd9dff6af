// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds and opens the HDF5 module, which writes and reads files.
#pragma once

#include <string>
#include <vector>

#include "file/hdf5/interface.hpp"

namespace bbsim::file {

// The module; or, in `trouble`, why it is missing and the remedy, as the end of a sentence.
struct Hdf5Module {
  const hdf5::Module* functions = nullptr;
  std::string trouble;
};

// Looks for the module in these folders, in order, and opens it; it is never closed.
[[nodiscard]] Hdf5Module open_hdf5_module(const std::vector<std::string>& folders);

// The folders to search: BBSIM_MODULE_PATH alone, if it is set; otherwise those above the
// shared library with this code, or ../lib/bbsim (or the system's name for lib) of the program.
[[nodiscard]] std::vector<std::string> hdf5_module_folders();

// The module, which is opened at the first call.
[[nodiscard]] const Hdf5Module& hdf5_module();

}  // namespace bbsim::file
