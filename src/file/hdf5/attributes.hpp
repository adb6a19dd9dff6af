// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Attributes, and the strings in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "file/hdf5/handle.hpp"

namespace bbsim::hdf5 {

// What an attribute of a single value holds.
using Value = std::variant<std::string, double, std::int64_t>;

// Strings of any length in UTF-8, as h5py writes them. Throws Failure, as all here.
[[nodiscard]] Datatype string_type();
// Strings of at most so many bytes.
[[nodiscard]] Datatype string_type_of(std::size_t size);

// The text has the file's own, fixed length: what is not in the global heap of a damaged file
// cannot lead HDF5 astray, and headers have checksums.
void set_attribute(hid_t object, const char* name, const char* text);
void set_attribute(hid_t object, const char* name, double number);
void set_attribute(hid_t object, const char* name, std::int64_t number);

// The text of a scalar string attribute; "" if there is none of that name or kind.
[[nodiscard]] std::string attribute_of(hid_t object, const char* name);
// The value of an open attribute; false if it is no single string or number.
[[nodiscard]] bool read_attribute(hid_t attribute, Value& value);

}  // namespace bbsim::hdf5
