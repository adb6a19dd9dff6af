#include "record/hdf5/strings.hpp"

namespace bbsim::hdf5 {

Datatype string_type() {
  Datatype type(H5Tcopy(H5T_C_S1), "preparing a string");
  check(H5Tset_size(type, H5T_VARIABLE), "preparing a string");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "preparing a string");
  return type;
}

void set_attribute(hid_t object, const char* name, const char* value) {
  const Datatype type = string_type();
  const Dataspace space(H5Screate(H5S_SCALAR), "writing an attribute");
  Attribute attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                      "writing an attribute");
  check(H5Awrite(attribute, type, &value), "writing an attribute");
  attribute.close_checked("writing an attribute");
}

bool read_attribute(hid_t attribute, std::string& value) {
  const Datatype type(H5Aget_type(attribute), "reading an attribute");
  const Dataspace space(H5Aget_space(attribute), "reading an attribute");
  if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_type(space) != H5S_SCALAR) {
    return false;
  }
  if (check(H5Tis_variable_str(type), "reading an attribute") > 0) {
    char* text = nullptr;
    check(H5Aread(attribute, type, static_cast<void*>(&text)), "reading an attribute");
    value = text == nullptr ? "" : text;  // HDF5 keeps nothing of an empty string
    H5free_memory(text);
  } else {
    std::string text(H5Tget_size(type), '\0');
    check(H5Aread(attribute, type, text.data()), "reading an attribute");
    value = text.c_str();  // up to the padding
  }
  return true;
}

std::string attribute_of(hid_t object, const char* name) {
  std::string value;
  if (check(H5Aexists(object, name), "reading an attribute") == 0) return value;
  const Attribute attribute(H5Aopen(object, name, H5P_DEFAULT), "reading an attribute");
  return read_attribute(attribute, value) ? value : "";
}

}  // namespace bbsim::hdf5
