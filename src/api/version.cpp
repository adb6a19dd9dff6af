// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/version.hpp"

#include "bbsim_commit.hpp"  // cmake/commit.cmake

namespace bbsim::api {

std::string_view version() {
  return BBSIM_VERSION BBSIM_COMMIT_SUFFIX;
}

std::string_view commit() {
  return BBSIM_COMMIT;
}

}  // namespace bbsim::api
