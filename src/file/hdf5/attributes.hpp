// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads and writes attributes and their strings.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "file/attributes.hpp"
#include "file/hdf5/handle.hpp"

namespace bbsim::file::hdf5 {

// UTF-8 strings of any length, as h5py writes them. Throws Failure, like all functions here.
[[nodiscard]] Datatype string_type();
// Strings of at most `size` bytes.
[[nodiscard]] Datatype string_type_of(std::size_t size);

// Text is stored with a fixed length in the object's header, which has a checksum.
void set_attribute(hid_t object, const std::string& name, const AttributeValue& value);

// The value of an open attribute, if it is a single string or number.
[[nodiscard]] std::optional<AttributeValue> value_of(hid_t attribute);
// The text of a string attribute; "" if no attribute has this name or it is not a string.
[[nodiscard]] std::string text_of(hid_t object, const char* name);

}  // namespace bbsim::file::hdf5
