// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An HDF5 file driver that writes through a descriptor that is already open.
//
// HDF5's own drivers cannot end a file on a full disk: closing fails, what could not be written
// stays in its caches, and the process crashes at exit when HDF5 tries once more. This driver notes
// the first error of the system and from then on pretends that all is well, so that HDF5 closes
// the (doomed) file in peace; whoever writes asks for the error.
#pragma once

#include "file/hdf5/handle.hpp"

namespace bbsim::hdf5 {

struct DescriptorTarget {
  int descriptor = -1;
  int* system_error = nullptr;  // gets the errno of the first failure; must outlive the file
};

// Makes files of these access properties go to `target`. Throws Failure.
void use_descriptor(const Properties& file_access, DescriptorTarget target);

}  // namespace bbsim::hdf5
