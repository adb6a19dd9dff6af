// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "version.hpp"

#include "api/version.hpp"
#include "simd/instruction_set.hpp"

namespace bbsim::app {

std::string version() {
  return std::string("bbsim " BBSIM_VERSION "\ninstruction set: ") +
         simd::name_of(simd::chosen_instruction_set()) + "\ncommit: " + std::string(api::commit()) +
         "\nlibraries: " BBSIM_LIBRARIES;
}

}  // namespace bbsim::app
