// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/key_paths.hpp"

#include <cstddef>
#include <set>

#include "scenario/sections.hpp"

namespace bbsim::scenario {
namespace {

using yaml::Declared;

constexpr std::size_t longest_list = 8;  // with listed positions

void add(const Declared& value, const std::string& path, std::set<std::string>& paths) {
  switch (value.kind) {
    case Declared::Kind::mapping:
      for (const yaml::DeclaredKey& key : value.keys) {
        add(key.value, path.empty() ? key.name : path + '.' + key.name, paths);
      }
      break;
    case Declared::Kind::names:
      paths.insert(path + '.');
      break;
    case Declared::Kind::any:
      for (const Declared& part : value.parts) add(part, path, paths);
      break;
    case Declared::Kind::list:
      paths.insert(path);
      if (value.most > longest_list) break;
      for (std::size_t i = 0; i < value.most; ++i) {
        add(value.parts.front(), path + '.' + std::to_string(i), paths);
      }
      break;
    default:
      paths.insert(path);
  }
}

}  // namespace

std::vector<std::string> key_paths() {
  std::set<std::string> paths;
  add(declared_keys(), "", paths);
  return {paths.begin(), paths.end()};
}

}  // namespace bbsim::scenario
