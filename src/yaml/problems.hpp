// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Collects all faults of a scenario to report them together.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "yaml/document.hpp"

namespace bbsim::yaml {

class Problems {
 public:
  // `name` is the file's name in messages. `text` is its content without a byte order mark, for
  // columns. `settings` belong to one case of a sweep; their sources follow those of the overrides.
  Problems(std::string name, std::string_view text, std::vector<std::string> overrides,
           std::vector<std::string> settings = {})
      : name_(std::move(name)),
        text_(text),
        overrides_(std::move(overrides)),
        settings_(std::move(settings)) {}

  void add(const Position& position, std::string message);

  // Adds a remark on a valid value that may be a mistake: "note: ..." or "warning: ...".
  void remark(const Position& position, std::string message);

  // Throws InputError if there are problems: the first 50 in the order of the text, then of the
  // overrides, and the number of the others.
  void throw_if_any() const;

  // Each remark with its place, in the order of the calls.
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

  // "file:line:column", or the override or setting.
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

// Text in messages uses the common shown().
using bbsim::shown;

// A node for a sentence that begins with "found": -0.01, "10 cm", nothing, a list of 3, a mapping.
[[nodiscard]] std::string shown(const Node& node);

}  // namespace bbsim::yaml
