// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks the tables of keys in docs/reference against the readers' declarations. A page says which
// keys share a row, and in which order; the declarations give the other cells. With
// BBSIM_WRITE_DOCS in the environment the test writes the tables, with rows for new keys.
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

struct KeyAt {
  std::string path;
  const DeclaredKey* key;
};

// Collects all keys below a value in the order of their declarations.
void collect(const Declared& value, const std::string& path, std::vector<KeyAt>& into) {
  for (const DeclaredKey& key : value.keys) {
    const std::string its = path.empty() ? key.name : path + '.' + key.name;
    if (std::ranges::count(into, its, &KeyAt::path) == 0) into.push_back({its, &key});
    collect(key.value, its, into);
  }
  for (const Declared& part : value.parts) collect(part, path, into);
}

const std::vector<KeyAt>& all_keys() {
  static std::vector<KeyAt> keys;
  if (keys.empty()) collect(declared_keys(), "", keys);
  return keys;
}

const DeclaredKey* key_at(const std::string& path) {
  static std::map<std::string, const DeclaredKey*> keys;
  if (keys.empty()) {
    for (const auto& [its, key] : all_keys()) keys.emplace(its, key);
  }
  return keys.contains(path) ? keys.at(path) : nullptr;
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

// The cell of a key's own words, or else the declaration's text.
std::string cell(std::string_view given, const std::string& declared) {
  if (given == "-") return "";
  return given.empty() ? declared : std::string(given);
}

// The row of a key; `names` is its first cell.
std::string row_of(const std::string& names, const DeclaredKey& key) {
  std::string text = "|" + names + "|";
  for (const std::string& one :
       {cell(key.about.unit, unit_cell(key.value)), cell(key.about.standard, default_cell(key)),
        cell(key.about.range, range_cell(key.value)), std::string(key.about.meaning)}) {
    text += (one.empty() ? "" : " " + one) + " |";
  }
  return text;
}

// The full paths of the keys of a row: "`ball.push.x`, `.y`". `prefix` is that of all keys except
// those at the top level.
std::vector<std::string> paths_of(const std::string& names, const std::string& prefix) {
  std::vector<std::string> paths;
  std::string name;
  for (std::stringstream text(names);
       std::getline(text, name, '`') && std::getline(text, name, '`');) {
    if (name.starts_with('.')) {
      name = paths.back().substr(0, paths.back().rfind('.')) + name;
    } else if (key_at(name.substr(0, name.find('.'))) == nullptr) {
      name.insert(0, prefix);
    }
    paths.push_back(name);
  }
  return paths;
}

struct Table {
  const char *page, *heading, *prefix;
};
constexpr Table tables[] = {
    {"scenario.md", "Top level", ""},
    {"scenario.md", "Ball", ""},
    {"scenario.md", "Plate", ""},
    {"scenario.md", "Gimbal", ""},
    {"scenario.md", "Mounting", "gimbal."},
    {"scenario.md", "Servos", "gimbal."},
    {"scenario.md", "Linkages", "gimbal."},
    {"scenario.md", "Three servos", "gimbal."},
    {"scenario.md", "Torques and motors", "gimbal."},
    {"scenario.md", "Controller", ""},
    {"scenario.md", "Laws", "controller."},
    {"scenario.md", "Reference paths", "controller.reference."},
    {"scenario.md", "Sampling", "controller."},
    {"scenario.md", "Sensor", "controller."},
    {"scenario.md", "Events", ""},
    {"scenario.md", "Time, solver and output", ""},
    {"scenario.md", "Sweep", ""},
    {"scenario.md", "Exercise", ""},
    {"scenario.md", "Profiles", "gimbal.motion.phi."},
    {"controllers.md", "Keys", ""},
};

// The lines of a table of a page, and the keys in the rows.
struct Rows {
  std::vector<std::string> lines;
  std::vector<std::vector<std::string>> paths;
};

Rows rows_of(std::string_view table, const std::string& prefix) {
  Rows rows;
  std::string line;
  for (std::stringstream text{std::string(table)}; std::getline(text, line);) {
    rows.lines.push_back(line);
    rows.paths.push_back(paths_of(line.substr(1, line.find('|', 1) - 1), prefix));
  }
  return rows;
}

// Writes the rows anew. A key's second row, which points to its first one, stays as it is.
void fill(Rows& rows, std::set<std::string>& known) {
  for (std::size_t i = 2; i < rows.lines.size(); ++i) {
    std::string& line = rows.lines[i];
    const std::vector<std::string>& paths = rows.paths[i];
    const bool first = known.insert(paths.front()).second;
    known.insert(paths.begin(), paths.end());
    const DeclaredKey* const key = key_at(paths.front());
    INFO(line);
    REQUIRE(key != nullptr);
    for (const std::string& path : paths) {
      INFO(path);
      REQUIRE(key_at(path) != nullptr);
      CHECK(key_at(path)->about.meaning == key->about.meaning);
    }
    if (first) line = row_of(line.substr(1, line.find('|', 1) - 1), *key);
  }
}

// Whether the key has a row, or shares the words of a key of its name that has one.
bool is_known(const KeyAt& one, const std::set<std::string>& known) {
  return std::ranges::any_of(known, [&](const std::string& path) {
    const DeclaredKey* const key = key_at(path);
    return path == one.path || (key != nullptr && key->name == one.key->name &&
                                key->about.meaning == one.key->about.meaning);
  });
}

// Adds the rows of new keys, each behind the key that is declared before it.
void add_new(Rows& rows, std::set<std::string>& known) {
  for (std::size_t k = 1; k < all_keys().size(); ++k) {
    const KeyAt &one = all_keys()[k], &before = all_keys()[k - 1];
    if (one.key->value.kind == Declared::Kind::mapping || is_known(one, known)) continue;
    const auto row = std::ranges::find_if(
        rows.paths, [&](const auto& paths) { return std::ranges::count(paths, before.path) > 0; });
    if (row == rows.paths.end()) continue;
    known.insert(one.path);
    const auto i = row - rows.paths.begin();
    std::string& line = rows.lines[static_cast<std::size_t>(i)];
    if (one.key->about.meaning == before.key->about.meaning) {
      line.insert(line.find('|', 1) - 1, ", `." + one.key->name + '`');
      row->push_back(one.path);
      continue;
    }
    const std::string first = line.substr(3, line.find('`', 3) - 3);
    const std::string name = first.substr(0, first.rfind('.') + 1) + one.key->name;
    rows.lines.insert(rows.lines.begin() + i + 1, row_of(" `" + name + "` ", *one.key));
    rows.paths.insert(row + 1, {one.path});
  }
}

}  // namespace

TEST_CASE("the tables of keys in the documents match the readers' declarations") {
  std::map<std::string, std::string> pages, wanted;
  for (const Table& table : tables) {
    std::stringstream text;
    text << std::ifstream(BBSIM_SOURCE_DIR "/docs/reference/" + std::string(table.page)).rdbuf();
    pages[table.page] = wanted[table.page] = text.str();
  }
  std::set<std::string> known;  // keys with a row
  for (const bool with_new : {false, true}) {
    for (const Table& table : tables) {
      std::string& page = wanted[table.page];
      const std::size_t heading = page.find("\n## " + std::string(table.heading) + "\n");
      REQUIRE(heading != std::string::npos);
      const std::size_t begin = page.find("\n| key | unit |", heading) + 1;
      const std::size_t end = page.find("\n\n", begin);
      Rows rows = rows_of(std::string_view(page).substr(begin, end - begin), table.prefix);
      with_new ? add_new(rows, known) : fill(rows, known);
      std::string text;
      for (const std::string& line : rows.lines) text += (text.empty() ? "" : "\n") + line;
      page.replace(begin, end - begin, text);
    }
  }
  for (const auto& [page, text] : wanted) {
    if (std::getenv("BBSIM_WRITE_DOCS") != nullptr) {
      std::ofstream(BBSIM_SOURCE_DIR "/docs/reference/" + page) << text;
    }
    CHECK(pages[page] == text);
  }
  for (const KeyAt& one : all_keys()) {
    INFO(one.path);
    CHECK(one.key->value.kind != Declared::Kind::none);
    CHECK((one.key->value.kind == Declared::Kind::mapping || is_known(one, known)));
  }
}

TEST_CASE("the words of a key repeat no declaration") {
  for (const auto& [path, key] : all_keys()) {
    INFO(path);
    const auto differs = [](std::string_view given, const std::string& declared) {
      return given.empty() || given != (declared.empty() ? "-" : declared);
    };
    CHECK(differs(key->about.unit, unit_cell(key->value)));
    CHECK(differs(key->about.standard, default_cell(*key)));
    CHECK(differs(key->about.range, range_cell(key->value)));
  }
}

}  // namespace bbsim_test::test_keys
