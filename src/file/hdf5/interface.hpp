// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the HDF5 module offers to the program that loads it.
//
// The two come from one build, so C++ types may cross. Exceptions may not: program and module each
// contain a C++ runtime, and neither can catch what the other throws. Each function therefore
// returns its trouble, which the program turns into an OutputError or InputError.
//
// Any thread may call these functions: they take turns, because Debian's HDF5 is for one thread at
// a time.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "base/fork_mutex.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file::hdf5 {

struct Trouble {
  std::string text{};    // the end of a sentence; empty: none
  int system_error = 0;  // the errno, where the system is the cause
  bool no_memory = false;
};

// A file that is being written. After a failure, it can only be destroyed.
class Writer {
 public:
  virtual ~Writer() = default;
  [[nodiscard]] virtual Trouble append(const Hdf5Block& block) = 0;
  [[nodiscard]] virtual Trouble add_column(const Hdf5Column& column,
                                           const std::vector<double>& values) = 0;
  [[nodiscard]] virtual Trouble keep(const std::vector<InputTable>& inputs) = 0;
  // Sets the root's attributes and closes the file.
  [[nodiscard]] virtual Trouble finish(const Attributes& attributes) = 0;
};

// A file that is being read.
class Reader {
 public:
  virtual ~Reader() = default;
  // Reads rows [first, first + rows). They must exist.
  [[nodiscard]] virtual Trouble read(std::size_t first, std::size_t rows, Hdf5Block& into) = 0;
  [[nodiscard]] virtual Trouble read_inputs(std::vector<InputTable>& into) = 0;
};

// The functions of a module, its only symbol.
struct Module {
  const char* build;  // comes first in every version
  // Writes into an existing empty file.
  Trouble (*create)(const std::string& file, const std::vector<Hdf5Column>& columns,
                    const std::vector<Hdf5Axis>& axes, std::unique_ptr<Writer>& into);
  Trouble (*open)(const std::string& file, Hdf5Head& head, std::unique_ptr<Reader>& into);
  // The program's, set before the first call. One of the module's would be registered for forks
  // while a library is loaded, and a fork may wait for that.
  ForkMutex* turns = nullptr;
};
inline constexpr const char* module_symbol = "bbsim_hdf5_module";

// Program and module fit together if these are equal. The number counts changes of this interface
// between versions.
inline constexpr const char* this_build = "bbsim " BBSIM_VERSION ", interface 1, " __VERSION__;

}  // namespace bbsim::file::hdf5
