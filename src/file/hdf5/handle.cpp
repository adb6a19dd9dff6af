// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/handle.hpp"

#include <cstdlib>

namespace bbsim::file::hdf5 {
namespace {

// HDF5 gives the system's error in a text only: "..., errno = 28, error message = ...".
int errno_in(const std::string& text) {
  constexpr std::string_view mark = "errno = ";
  const std::size_t place = text.rfind(mark);
  return place == std::string::npos ? 0 : std::atoi(text.c_str() + place + mark.size());
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

}  // namespace bbsim::file::hdf5
