// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What becomes of this program where the HDF5 library crashes in it, as it writes.
//
// Debian's HDF5 does not bear it everywhere that it gets no memory. Files come to no harm by that:
// the one that is being written has no name yet. So it is an end like that of any other file that
// cannot be written: with a message and exit code 3.
#pragma once

namespace bbsim::file {

// While there is one, a crash of this thread is one of the HDF5 library, and ends the program with
// `message`, a line, which must stay as long. Another thread waits until it is gone.
class WithinHdf5 {
 public:
  explicit WithinHdf5(const char* message);
  ~WithinHdf5();
  WithinHdf5(const WithinHdf5&) = delete;
  WithinHdf5& operator=(const WithinHdf5&) = delete;

 private:
  const char* before_;
};

}  // namespace bbsim::file
