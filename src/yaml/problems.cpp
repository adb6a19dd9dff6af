// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/problems.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "base/error.hpp"

namespace bbsim::yaml {
namespace {

constexpr std::size_t most_shown = 50;         // problems
constexpr std::size_t longest_override = 200;  // bytes

// Converts a column in bytes to a column in characters.
int character_column(std::string_view text, const Position& position) {
  const std::size_t line = offset_of(text, {0, position.line, 1});
  const auto before = text.substr(line, static_cast<std::size_t>(position.column - 1));
  return position.column - static_cast<int>(std::ranges::count_if(before, continues_character));
}

}  // namespace

void Problems::add(const Position& position, std::string message) {
  problems_.push_back({position, std::move(message)});
}

void Problems::remark(const Position& position, std::string message) {
  remarks_.push_back(where(position) + ": " + std::move(message));
}

std::string Problems::where(const Position& position) const {
  if (position.source > 0) {
    const auto i = static_cast<std::size_t>(position.source - 1);
    return i < overrides_.size()
               ? "--set " + shown(overrides_[i], longest_override)
               : "with " + shown(settings_[i - overrides_.size()], longest_override);
  }
  return name_ + ':' + std::to_string(position.line) + ':' +
         std::to_string(character_column(text_, position));
}

void Problems::throw_if_any() const {
  if (problems_.empty()) return;
  std::vector<const Located*> sorted;
  sorted.reserve(problems_.size());
  for (const Located& problem : problems_) sorted.push_back(&problem);
  std::ranges::stable_sort(sorted, {}, [](const Located* problem) {
    const Position& at = problem->position;
    return std::tuple(at.source, at.line, at.column);
  });

  std::vector<Problem> first;
  for (const Located* problem : sorted) {
    if (first.size() == most_shown) break;
    first.push_back({where(problem->position), problem->message});
  }
  if (sorted.size() > most_shown) {
    first.push_back({"", "and " + std::to_string(sorted.size() - most_shown) + " more problems"});
  }
  throw InputError(std::move(first));
}

std::string shown(const Node& node) {
  switch (node.kind) {
    case Node::Kind::null:
      return "nothing";
    case Node::Kind::scalar:
      return node.quoted ? '"' + shown(node.text) + '"' : shown(node.text);
    case Node::Kind::sequence:
      return node.items.empty() ? "an empty list"
                                : "a list of " + std::to_string(node.items.size());
    case Node::Kind::mapping:
      return "a mapping";
  }
  return "";
}

}  // namespace bbsim::yaml
