// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Owned HDF5 identifiers and checked calls, for the module and the reader.
#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace bbsim::hdf5 {

// A call of HDF5 failed. The module and the reader catch this exception.
class Failure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Throws Failure with the most specific entry of HDF5's error stack.
[[noreturn]] void fail(std::string_view doing);

// Keeps HDF5 from writing errors to standard error.
void keep_errors_to_ourselves();

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

}  // namespace bbsim::hdf5
