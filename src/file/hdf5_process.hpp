// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The process that prints the tables of HDF5 files.
//
// Debian's HDF5 library crashes on some damaged files and goes in circles on others. So it reads
// in a process of its own (hdf5/reader_program.cpp), which is bounded in time and memory and may
// end in any way: what is left of that here is an error that says so.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "file/descriptor.hpp"

namespace bbsim::file {

// Why a file could not be read, as the end of a sentence.
class Hdf5Trouble : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// How a table is read: in blocks of so many rows, and no more rows in all.
struct Hdf5Rows {
  static constexpr std::size_t all = static_cast<std::size_t>(-1);
  std::size_t a_block = all, most = all;
};

// Ends with this object. Every function throws Hdf5Trouble.
class Hdf5Process {
 public:
  Hdf5Process(const std::vector<std::string>& files, const Hdf5Rows& rows);
  // One that runs already, whose standard output and error these are.
  Hdf5Process(pid_t process, Descriptor output, Descriptor error);
  ~Hdf5Process();
  Hdf5Process(const Hdf5Process&) = delete;
  Hdf5Process& operator=(const Hdf5Process&) = delete;

  // What it prints next: a line, without its end, or so many bytes.
  [[nodiscard]] std::string line();
  void take(void* to, std::size_t bytes);

 private:
  // At least a byte more, as the system gives them.
  std::size_t read(char* to, std::size_t most);
  void fill();  // waiting_, which must be used up
  void end();
  [[noreturn]] void fail_by_end();

  pid_t process_;  // 0 once it is known to have ended
  Descriptor output_, error_;
  std::vector<char> waiting_;  // bytes [next_, end_) of it came with others
  std::size_t next_ = 0, end_ = 0;
};

}  // namespace bbsim::file
