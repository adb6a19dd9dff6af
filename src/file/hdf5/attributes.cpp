// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/attributes.hpp"

#include <cstring>

namespace bbsim::hdf5 {
namespace {

constexpr const char* writing = "writing an attribute";
constexpr const char* reading = "reading an attribute";

void write_scalar(hid_t object, const char* name, hid_t in_file, hid_t in_memory,
                  const void* value) {
  const Dataspace space(H5Screate(H5S_SCALAR), writing);
  Attribute attribute(H5Acreate2(object, name, in_file, space, H5P_DEFAULT, H5P_DEFAULT), writing);
  check(H5Awrite(attribute, in_memory, value), writing);
  attribute.close_checked(writing);
}

std::string read_string(hid_t attribute, const Datatype& type) {
  if (check(H5Tis_variable_str(type), reading) > 0) {
    char* text = nullptr;
    check(H5Aread(attribute, type, static_cast<void*>(&text)), reading);
    std::string value = text == nullptr ? "" : text;  // null for an empty string
    H5free_memory(text);
    return value;
  }
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), reading);
  return text.c_str();  // up to the padding
}

}  // namespace

Datatype string_type_of(std::size_t size) {
  Datatype type(H5Tcopy(H5T_C_S1), "preparing a string");
  check(H5Tset_size(type, size), "preparing a string");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "preparing a string");
  return type;
}

Datatype string_type() {
  return string_type_of(H5T_VARIABLE);
}

void set_attribute(hid_t object, const char* name, const char* text) {
  const Datatype type = string_type_of(std::strlen(text) + 1);
  write_scalar(object, name, type, type, text);
}

void set_attribute(hid_t object, const char* name, double number) {
  write_scalar(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &number);
}

void set_attribute(hid_t object, const char* name, std::int64_t number) {
  write_scalar(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &number);
}

bool read_attribute(hid_t attribute, Value& value) {
  const Datatype type(H5Aget_type(attribute), reading);
  const Dataspace space(H5Aget_space(attribute), reading);
  if (H5Sget_simple_extent_type(space) != H5S_SCALAR) return false;
  switch (H5Tget_class(type)) {
    case H5T_STRING:
      value = read_string(attribute, type);
      return true;
    case H5T_FLOAT: {
      double number = 0;
      check(H5Aread(attribute, H5T_NATIVE_DOUBLE, &number), reading);
      value = number;
      return true;
    }
    case H5T_INTEGER: {
      std::int64_t number = 0;
      check(H5Aread(attribute, H5T_NATIVE_INT64, &number), reading);
      value = number;
      return true;
    }
    default:
      return false;
  }
}

std::string attribute_of(hid_t object, const char* name) {
  if (check(H5Aexists(object, name), reading) == 0) return "";
  const Attribute attribute(H5Aopen(object, name, H5P_DEFAULT), reading);
  Value value;
  if (!read_attribute(attribute, value)) return "";
  const auto* text = std::get_if<std::string>(&value);
  return text == nullptr ? "" : *text;
}

}  // namespace bbsim::hdf5
