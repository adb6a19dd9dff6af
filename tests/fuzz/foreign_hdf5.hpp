// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5 files as other programs might write them: valid, but seldom tables.
#pragma once

#include <cstdint>
#include <string>

#include "fuzz.hpp"

namespace bbsim_fuzz {

// Writes a file of groups, links, datasets and attributes of all kinds, sizes and types, chosen by
// the bytes. Skips what HDF5 refuses to write.
void write_foreign_hdf5(const std::string& file, const std::uint8_t* data, std::size_t size);

}  // namespace bbsim_fuzz
