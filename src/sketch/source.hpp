// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Files of a sketch -> one C++ source, as the Arduino IDE makes it.
#pragma once

#include <string>
#include <vector>

namespace bbsim::sketch {

struct SketchFile {
  std::string name;  // as messages of the compiler show it
  std::string text;
};

// Joins the files in their order, below #include <Arduino.h>. A function that is used above its
// definition gets a prototype above that use, as late as can be, so that it sees the same types.
// Messages of a compiler name the files' own lines (#line).
[[nodiscard]] std::string joined(const std::vector<SketchFile>& files);

// The names between <> or "" of all #include in the text.
[[nodiscard]] std::vector<std::string> includes_of(const std::string& text);

}  // namespace bbsim::sketch
