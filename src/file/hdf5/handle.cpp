// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/handle.hpp"

#include <cstdint>
#include <cstdlib>
#include <variant>

namespace bbsim::file::hdf5 {
namespace {

// HDF5 gives the system's error in a text only: "..., errno = 28, error message = ...".
int errno_in(const std::string& text) {
  constexpr std::string_view mark = "errno = ";
  const std::size_t place = text.rfind(mark);
  return place == std::string::npos ? 0 : std::atoi(text.c_str() + place + mark.size());
}

constexpr const char* writing = "writing an attribute";
constexpr const char* reading = "reading an attribute";

void write_scalar(hid_t object, const std::string& name, hid_t in_file, hid_t in_memory,
                  const void* value) {
  const Dataspace space(H5Screate(H5S_SCALAR), writing);
  Attribute attribute(H5Acreate2(object, name.c_str(), in_file, space, H5P_DEFAULT, H5P_DEFAULT),
                      writing);
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

template <class Number>
Number read_number(hid_t attribute, hid_t in_memory) {
  Number number = 0;
  check(H5Aread(attribute, in_memory, &number), reading);
  return number;
}

}  // namespace

void fail(std::string_view doing) {
  std::string reason;
  // The upward walk begins with the most specific entry.
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* entry, void* text) -> herr_t {
        *static_cast<std::string*>(text) = entry->desc != nullptr ? entry->desc : "";
        return 1;  // stop after the first entry
      },
      &reason);
  throw Failure(std::string(doing) + " failed" + (reason.empty() ? "" : ": " + reason),
                errno_in(reason));
}

Properties file_access() {
  constexpr const char* doing = "preparing the file";
  Properties access(H5Pcreate(H5P_FILE_ACCESS), doing);
  check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), doing);
#if H5_VERSION_GE(1, 12, 1) || (H5_VERSION_GE(1, 10, 7) && !H5_VERSION_GE(1, 12, 0))
  check(H5Pset_file_locking(access, false, true), doing);
#endif
  return access;
}

Datatype string_type_of(std::size_t size) {
  Datatype type(H5Tcopy(H5T_C_S1), "preparing a string");
  check(H5Tset_size(type, size), "preparing a string");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "preparing a string");
  return type;
}

Datatype string_type() {
  return string_type_of(H5T_VARIABLE);
}

void set_attribute(hid_t object, const std::string& name, const AttributeValue& value) {
  if (const auto* real = std::get_if<double>(&value.value())) {
    write_scalar(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, real);
  } else if (const auto* whole = std::get_if<std::int64_t>(&value.value())) {
    write_scalar(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, whole);
  } else {
    const std::string& text = std::get<std::string>(value.value());
    const Datatype type = string_type_of(text.size() + 1);
    write_scalar(object, name, type, type, text.c_str());
  }
}

std::optional<AttributeValue> value_of(hid_t attribute) {
  const Datatype type(H5Aget_type(attribute), reading);
  const Dataspace space(H5Aget_space(attribute), reading);
  if (H5Sget_simple_extent_type(space) != H5S_SCALAR) return std::nullopt;
  switch (H5Tget_class(type)) {
    case H5T_STRING:
      return read_string(attribute, type);
    case H5T_FLOAT:
      return read_number<double>(attribute, H5T_NATIVE_DOUBLE);
    case H5T_INTEGER:
      return read_number<std::int64_t>(attribute, H5T_NATIVE_INT64);
    default:
      return std::nullopt;
  }
}

std::string text_of(hid_t object, const char* name) {
  if (check(H5Aexists(object, name), reading) == 0) return "";
  const Attribute attribute(H5Aopen(object, name, H5P_DEFAULT), reading);
  const std::optional<AttributeValue> value = value_of(attribute);
  const auto* text = value ? std::get_if<std::string>(&value->value()) : nullptr;
  return text == nullptr ? "" : *text;
}

}  // namespace bbsim::file::hdf5
