// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Ends the program cleanly if the HDF5 library crashes while it writes.
//
// Debian's HDF5 may crash when memory runs out. This damages no file, because the new file has no
// name yet. The program therefore ends as for any file that cannot be written: with a message and
// exit code 3.
#pragma once

namespace bbsim::file {

// While an object exists, a crash of this thread counts as one of the HDF5 library and ends the
// program with `message`, a line that must outlive the object. Other threads wait to create theirs.
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
