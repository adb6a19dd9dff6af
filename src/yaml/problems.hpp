// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Everything that is wrong with a scenario, collected to be reported in one go.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/shown.hpp"
#include "yaml/document.hpp"

namespace bbsim::yaml {

class Problems {
 public:
  // `name` stands for the file in messages; `text` is its content, without a byte order
  // mark, for columns. After the overrides come the `settings` of one case of a sweep.
  Problems(std::string name, std::string_view text, std::vector<std::string> overrides,
           std::vector<std::string> settings = {})
      : name_(std::move(name)),
        text_(text),
        overrides_(std::move(overrides)),
        settings_(std::move(settings)) {}

  void add(const Position& position, std::string message);

  // What is allowed, but may not be what the user meant: "note: ..." or "warning: ...".
  void remark(const Position& position, std::string message);

  // Throws InputError if there are any: in the order of the text, then of the overrides; the
  // first 50, and how many more there are.
  void throw_if_any() const;

  // Each with its place, in the order in which they were made.
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

  // "file:line:column", or which override.
  [[nodiscard]] std::string where(const Position& position) const;

 private:
  struct Located {
    Position position;
    std::string message;
  };

  std::string name_;
  std::string_view text_;
  std::vector<std::string> overrides_, settings_;
  std::vector<Located> problems_;
  std::vector<std::string> remarks_;
};

// A piece of text is shown here as anywhere.
using bbsim::shown;

// A node in a sentence that begins with "found": -0.01, "10 cm", nothing, a list of 3, a mapping.
[[nodiscard]] std::string shown(const Node& node);

}  // namespace bbsim::yaml
