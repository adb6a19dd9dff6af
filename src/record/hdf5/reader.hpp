// Reads the one-dimensional datasets of a file's root group.
#pragma once

#include "record/hdf5/interface.h"

namespace bbsim::hdf5 {

// Throws Failure.
void read(const char* path, const bbsim_hdf5_sink& sink);

}  // namespace bbsim::hdf5
