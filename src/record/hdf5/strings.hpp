// Strings of any length in UTF-8, as h5py writes them.
#pragma once

#include <string>

#include "record/hdf5/handle.hpp"

namespace bbsim::hdf5 {

// Each throws Failure.
[[nodiscard]] Datatype string_type();
void set_attribute(hid_t object, const char* name, const char* value);
// The text of a scalar string attribute; "" if there is none of that name or kind.
[[nodiscard]] std::string attribute_of(hid_t object, const char* name);
// The same of an open attribute; false if it is no scalar string.
[[nodiscard]] bool read_attribute(hid_t attribute, std::string& value);

}  // namespace bbsim::hdf5
