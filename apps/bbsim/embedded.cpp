// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "embedded.hpp"

#include <algorithm>

#include "api/version.hpp"
#include "bbsim_commands.hpp"
#include "bbsim_examples.hpp"
#include "bbsim_licenses.hpp"
#include "bbsim_templates.hpp"
#include "simd/instruction_set.hpp"

namespace bbsim::app {

std::span<const EmbeddedFile> example_files() {
  return bbsim_examples;
}

std::span<const EmbeddedFile> template_files() {
  return bbsim_templates;
}

std::span<const EmbeddedFile> command_tables() {
  return bbsim_commands;
}

std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name) {
  return std::ranges::find(files, name, &EmbeddedFile::name)->text;
}

std::string version() {
  return std::string("bbsim " BBSIM_VERSION "\ninstruction set: ") +
         simd::name_of(simd::chosen_instruction_set()) + "\ncommit: " + std::string(api::commit()) +
         "\nlibraries: " BBSIM_LIBRARIES;
}

std::string licenses() {
  const std::string rule = '\n' + std::string(80, '-') + "\n\n";
  std::string texts;
  for (const EmbeddedFile& file : bbsim_licenses) {
    if (!texts.empty()) texts += rule;
    texts += file.text;
  }
  texts.pop_back();  // the caller adds the line break when it prints
  return texts;
}

}  // namespace bbsim::app
