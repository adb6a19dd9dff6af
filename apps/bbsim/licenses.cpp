// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "licenses.hpp"

#include "bbsim_licenses.hpp"  // cmake/licenses.cmake

namespace bbsim::app {

std::string licenses() {
  return {bbsim_licenses, sizeof bbsim_licenses - 2};
}

}  // namespace bbsim::app
