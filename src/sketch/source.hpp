// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Joins the files of a sketch into one C++ source, as the Arduino IDE does.
#pragma once

#include <string>
#include <vector>

namespace bbsim::sketch {

struct SketchFile {
  std::string name;  // shown in the compiler's messages
  std::string text;
};

// Joins the files in order, below #include <Arduino.h>. A function that is used above its
// definition gets a prototype directly above the declaration that uses it first, where its types
// are known. #line directives let the compiler's messages name the lines of the files.
[[nodiscard]] std::string joined(const std::vector<SketchFile>& files);

// The names between <> or "" of all #include directives in the text.
[[nodiscard]] std::vector<std::string> includes_of(const std::string& text);

}  // namespace bbsim::sketch
