// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/format.hpp"

#include <filesystem>

#include "base/text.hpp"

namespace bbsim::file {

Format format_of(const std::string& file) {
  const std::string ending = lower_ending(file);
  if (ending == ".csv") return Format::csv;
  return ending == ".h5" || ending == ".hdf5" ? Format::hdf5 : Format::other;
}

std::string lower_ending(const std::string& file) {
  return lower(std::filesystem::path(file).extension().string());
}

}  // namespace bbsim::file
