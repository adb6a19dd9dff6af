// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the process that prints the tables of HDF5 files.
//
// Debian's HDF5 library crashes on some damaged files and loops forever on others. It therefore
// reads files in a separate process with bounded time and memory (hdf5/reader_program.cpp). If that
// process fails, this program reports an error.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "file/descriptor.hpp"

namespace bbsim::file {

// A file could not be read. what() is the end of a sentence.
class Hdf5Trouble : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// How to read a table: rows per block, and the largest number of rows in all.
struct Hdf5Rows {
  static constexpr std::size_t all = static_cast<std::size_t>(-1);
  std::size_t a_block = all, most = all;
};

// The process ends with this object. Every function throws Hdf5Trouble.
class Hdf5Process {
 public:
  Hdf5Process(const std::vector<std::string>& files, const Hdf5Rows& rows);
  // Takes over a running process, with its standard output and error.
  Hdf5Process(pid_t process, Descriptor output, Descriptor error);
  ~Hdf5Process();
  Hdf5Process(const Hdf5Process&) = delete;
  Hdf5Process& operator=(const Hdf5Process&) = delete;

  // Reads its next output: a line without the line break, or a number of bytes.
  [[nodiscard]] std::string line();
  void take(void* to, std::size_t bytes);

 private:
  // Reads from 1 to `most` bytes, as many as the system has. Returns their number.
  std::size_t read(char* to, std::size_t most);
  void fill();  // refills waiting_, which must be used up
  void end();
  [[noreturn]] void fail_by_end();

  pid_t process_;  // 0 after it has ended
  Descriptor output_, error_;
  std::vector<char> waiting_;  // read ahead; bytes [next_, end_) are unused
  std::size_t next_ = 0, end_ = 0;
};

}  // namespace bbsim::file
