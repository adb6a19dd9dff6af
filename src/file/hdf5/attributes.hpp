// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads and writes attributes and their strings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include "file/hdf5/handle.hpp"

namespace bbsim::hdf5 {

// The value of a scalar attribute.
using Value = std::variant<std::string, double, std::int64_t>;

// UTF-8 strings of any length, as h5py writes them. Throws Failure, like all functions here.
[[nodiscard]] Datatype string_type();
// Strings of at most `size` bytes.
[[nodiscard]] Datatype string_type_of(std::size_t size);

// Text is stored with a fixed length in the object's header, which has a checksum. A damaged global
// heap, where HDF5 keeps strings of variable length, then cannot harm the reader.
void set_attribute(hid_t object, const char* name, const char* text);
void set_attribute(hid_t object, const char* name, double number);
void set_attribute(hid_t object, const char* name, std::int64_t number);

// The text of a scalar string attribute; "" if no attribute has this name or it is not a string.
[[nodiscard]] std::string attribute_of(hid_t object, const char* name);
// Reads the value of an open attribute. Returns false unless it is a single string or number.
[[nodiscard]] bool read_attribute(hid_t attribute, Value& value);

}  // namespace bbsim::hdf5
