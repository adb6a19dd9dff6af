// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds the HDF5 module, which writes, and the reader's program, and opens the module.
#pragma once

#include <string>
#include <vector>

#include "file/hdf5/interface.h"

namespace bbsim::file {

// The module, or why there is none and what to do about it, as a sentence's end.
struct Hdf5Module {
  const bbsim_hdf5_module* functions = nullptr;
  std::string trouble;
};

// A program beside the module; without a path, why there is none.
struct ModuleFile {
  std::string path, trouble;
};

// Looks for the program that reads HDF5 files in these folders, in order.
[[nodiscard]] ModuleFile find_hdf5_reader(const std::vector<std::string>& folders);

// Looks for the module in these folders, in order, and opens it; it is never closed.
[[nodiscard]] Hdf5Module open_hdf5_module(const std::vector<std::string>& folders);

// Where to look for both: the folder BBSIM_MODULE_PATH if the environment has it, otherwise beside
// the running program: ../lib/bbsim, or what the system calls lib.
[[nodiscard]] std::vector<std::string> hdf5_module_folders();

// The module, opened at the first call.
[[nodiscard]] const Hdf5Module& hdf5_module();

}  // namespace bbsim::file
