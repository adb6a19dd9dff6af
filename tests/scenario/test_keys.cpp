// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks the tables of keys in docs/reference against the readers' declarations. With
// BBSIM_WRITE_DOCS in the environment the test writes them.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/number_text.hpp"
#include "catch.hpp"
#include "scenario/keys.hpp"

namespace bbsim_test::test_keys {

using namespace bbsim;
using namespace bbsim::scenario;
using yaml::Declared;
using yaml::DeclaredKey;

namespace {

using KeysByPath = std::map<std::string, const DeclaredKey*>;

// Collects all keys below a value, by the paths of the tables.
void collect(const Declared& value, const std::string& path, KeysByPath& into) {
  for (const DeclaredKey& key : value.keys) {
    const std::string its = path_in_tables(path.empty() ? key.name : path + '.' + key.name);
    into.emplace(its, &key);
    collect(key.value, its, into);
  }
  for (const Declared& part : value.parts) collect(part, path, into);
}

const KeysByPath& all_keys() {
  static const KeysByPath keys = [] {
    KeysByPath all;
    collect(declared_keys(), "", all);
    return all;
  }();
  return keys;
}

std::string unit_cell(const Declared& value) {
  switch (value.kind) {
    case Declared::Kind::number: {
      std::string unit(yaml::si_unit(value.dimension));
      if (const auto square = unit.find("^2"); square != std::string::npos) {
        unit.replace(square, 2, "²");
      }
      return unit.empty() ? "1" : unit;
    }
    case Declared::Kind::text:
      return "text";
    case Declared::Kind::name:
      return "name";
    case Declared::Kind::unit:
      return "unit";
    case Declared::Kind::list: {
      const Declared::Kind item = value.parts.front().kind;
      const bool numbers = item == Declared::Kind::number || item == Declared::Kind::list;
      return numbers ? unit_cell(value.parts.front()) : "list";
    }
    case Declared::Kind::any:
      return unit_cell(value.parts.front());
    case Declared::Kind::none:
    case Declared::Kind::mapping:
    case Declared::Kind::names:
      break;
  }
  return "mapping";
}

// 1e-8, not 1e-08.
std::string short_exponent(std::string text) {
  if (const auto zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
  return text;
}

std::string shown(double number) {
  return short_exponent(number_text(number));
}

std::string default_cell(const DeclaredKey& key) {
  if (key.must_be_given()) return "required";
  if (key.section) return "";
  if (key.standard.empty()) return "none";
  const bool word = key.value.kind == Declared::Kind::name;
  return word ? '`' + key.standard + '`' : short_exponent(key.standard);
}

std::string range_cell(const Declared& value) {
  if (value.kind == Declared::Kind::list || value.kind == Declared::Kind::any) {
    const Declared& first = value.parts.front();
    return first.kind == Declared::Kind::number ? range_cell(first) : "";
  }
  std::string text = value.whole ? "whole" : "";
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  for (const std::string& name : value.names) add('`' + name + '`');
  const yaml::Range& range = value.range;
  if (range.at_least && range.at_most && !value.whole) {
    return shown(*range.at_least) + " to " + shown(*range.at_most);
  }
  if (range.above) add("> " + shown(*range.above));
  if (range.at_least) add("≥ " + shown(*range.at_least));
  if (range.at_most && !value.whole) add("≤ " + shown(*range.at_most));
  return text;
}

// The cell given in a row, or else the declaration's text.
std::string cell(std::string_view given, const std::string& declared) {
  if (given == "-") return "";
  return given.empty() ? declared : std::string(given);
}

std::string row_of(const KeyText& row, const KeyTable& table) {
  const DeclaredKey& key = *all_keys().at(row.paths(table.prefix).front());
  std::string keys;
  std::istringstream names{std::string(row.keys)};
  for (std::string name; names >> name;) keys += (keys.empty() ? "`" : ", `") + name + '`';
  std::string text = "| " + keys + " |";
  for (const std::string& one :
       {cell(row.unit, unit_cell(key.value)), cell(row.standard, default_cell(key)),
        cell(row.range, range_cell(key.value)), std::string(row.meaning)}) {
    text += (one.empty() ? "" : " " + one) + " |";
  }
  return text + '\n';
}

std::string text_of_table(const KeyTable& table) {
  std::string text = "| key | unit | default | range | meaning |\n|---|---|---|---|---|\n";
  for (const KeyText& row : table.rows) text += row_of(row, table);
  return text;
}

}  // namespace

TEST_CASE("the tables of keys in the documents match the readers' declarations") {
  std::set<std::string_view> pages;
  for (const KeyTable& table : key_tables()) pages.insert(table.page);
  for (const std::string_view page : pages) {
    const std::string file = std::string(BBSIM_SOURCE_DIR) + "/docs/reference/" + std::string(page);
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    std::string wanted = text.str();
    for (const KeyTable& table : key_tables()) {
      if (table.page != page) continue;
      const std::size_t heading = wanted.find("\n## " + std::string(table.heading) + "\n");
      REQUIRE(heading != std::string::npos);
      const std::size_t begin = wanted.find("\n| key | unit |", heading) + 1;
      const std::size_t end = wanted.find("\n\n", begin) + 1;
      wanted.replace(begin, end - begin, text_of_table(table));
    }
    if (std::getenv("BBSIM_WRITE_DOCS") != nullptr) std::ofstream(file) << wanted;
    CHECK(text.str() == wanted);
  }
}

TEST_CASE("each key that is read is declared and has a row in the documents") {
  for (const auto& [path, key] : all_keys()) {
    INFO(path);
    CHECK(key->value.kind != Declared::Kind::none);
    const bool mapping = key->value.kind == Declared::Kind::mapping;
    CHECK((mapping || text_of_key(path) != nullptr));
  }
}

TEST_CASE("each row in the documents describes keys that are read, and repeats no declaration") {
  for (const KeyTable& table : key_tables()) {
    for (const KeyText& row : table.rows) {
      for (const std::string& path : row.paths(table.prefix)) {
        INFO(path);
        REQUIRE(all_keys().contains(path));
        const DeclaredKey& key = *all_keys().at(path);
        const auto differs = [](std::string_view given, const std::string& declared) {
          return given.empty() || given != (declared.empty() ? "-" : declared);
        };
        CHECK(differs(row.unit, unit_cell(key.value)));
        CHECK(differs(row.standard, default_cell(key)));
        CHECK(differs(row.range, range_cell(key.value)));
      }
    }
  }
}

}  // namespace bbsim_test::test_keys
