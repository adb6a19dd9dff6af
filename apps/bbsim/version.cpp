// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "version.hpp"

#include "api/version.hpp"
#include "embedded.hpp"
#include "simd/instruction_set.hpp"

namespace bbsim::app {

std::string version() {
  return std::string("bbsim " BBSIM_VERSION "\ninstruction set: ") +
         simd::name_of(simd::chosen_instruction_set()) + "\ncommit: " + std::string(api::commit()) +
         "\nlibraries: " BBSIM_LIBRARIES;
}

std::string licenses() {
  const std::string rule = '\n' + std::string(80, '-') + "\n\n";
  std::string texts;
  for (const EmbeddedFile& file : license_files()) {
    if (!texts.empty()) texts += rule;
    texts += file.text;
  }
  texts.pop_back();  // the caller adds the line break when it prints
  return texts;
}

}  // namespace bbsim::app
