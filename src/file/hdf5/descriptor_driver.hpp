// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An HDF5 file driver that writes through an open descriptor.
//
// HDF5's own drivers cannot close a file on a full disk: closing fails, the unwritten data stays in
// HDF5's caches, and the process crashes at exit when HDF5 tries again. This driver records the
// first system error and then reports success, so that HDF5 can close the incomplete file. The
// writer checks the recorded error.
#pragma once

#include "file/hdf5/handle.hpp"

namespace bbsim::hdf5 {

struct DescriptorTarget {
  int descriptor = -1;
  int* system_error = nullptr;  // receives the errno of the first failure; must outlive the file
};

// Makes files with these access properties go to `target`. Throws Failure.
void use_descriptor(const Properties& file_access, DescriptorTarget target);

}  // namespace bbsim::hdf5
