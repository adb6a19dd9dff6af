// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Owned HDF5 identifiers, checked calls, attributes, and names in files: what the writer and the
// reader share.
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "file/table.hpp"

namespace bbsim::file::hdf5 {

// A call of HDF5 failed. The module catches this exception.
class Failure : public std::runtime_error {
 public:
  explicit Failure(const std::string& text, int system_error = 0)
      : std::runtime_error(text), system_error_(system_error) {}
  [[nodiscard]] int system_error() const { return system_error_; }  // an errno; 0: none

 private:
  int system_error_;
};

// Throws Failure with the most specific entry of HDF5's error stack.
[[noreturn]] void fail(std::string_view doing);

// Returns the result; throws Failure if it is negative, which is HDF5's mark of failure.
template <class Result>
Result check(Result result, std::string_view doing) {
  if (result < 0) fail(doing);
  return result;
}

template <herr_t (*close)(hid_t)>
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, std::string_view doing) : id_(check(id, doing)) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) close(id_);
  }
  operator hid_t() const { return id_; }

  // Closes now, to report errors that only closing reveals.
  void close_checked(std::string_view doing) { check(close(std::exchange(id_, -1)), doing); }

 private:
  hid_t id_ = -1;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Object = Handle<H5Oclose>;
using Dataset = Handle<H5Dclose>;
using Dataspace = Handle<H5Sclose>;
using Datatype = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;

// Access to a file without locks: what bbsim writes has no name yet, results do not change once
// they exist, and many network file systems have no locks.
[[nodiscard]] Properties file_access();

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

// The attribute that distinguishes an axis of series from a column.
inline constexpr const char* axis_mark = "axis";

// The group of the tables that the scenario read. Each table is a group with a dataset per column.
inline constexpr const char* inputs_group = "inputs";
inline constexpr const char* input_file = "file";

// The attribute with the name of a column that a dataset cannot have: HDF5 names have no slash.
inline constexpr const char* column_title = "column";

[[nodiscard]] inline std::string dataset_name(std::string column) {
  std::ranges::replace(column, '/', '_');
  return column;
}

}  // namespace bbsim::file::hdf5
