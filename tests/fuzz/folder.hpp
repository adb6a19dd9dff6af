// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A fuzz target's own folder, emptied before each input and removed when the target ends.
#pragma once

#include <filesystem>

#include "support/folder.hpp"

namespace bbsim_fuzz {

class InputFolder : public ::Folder {
 public:
  [[nodiscard]] std::filesystem::path path() const { return name(); }

  void clear() const {
    for (const auto& entry : std::filesystem::directory_iterator(path())) {
      std::filesystem::remove_all(entry.path());
    }
  }
};

}  // namespace bbsim_fuzz
