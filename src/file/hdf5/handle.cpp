// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/handle.hpp"

namespace bbsim::hdf5 {

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
  throw Failure(std::string(doing) + " failed" + (reason.empty() ? "" : ": " + reason));
}

void keep_errors_to_ourselves() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace bbsim::hdf5
