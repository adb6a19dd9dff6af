// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "licenses.hpp"

#include "embedded.hpp"

namespace bbsim::app {

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
