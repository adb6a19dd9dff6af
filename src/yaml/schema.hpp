// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads mappings of the scenario into structs, with one function for each mapping:
//
//     void read_ball(Keys& keys, Ball& ball) {
//       keys.required("radius", Number{Dimension::length, {.above = 0}}, ball.radius, {"radius"});
//       keys.optional("spin", Number{Dimension::angular_rate}, ball.spin, {"rate of turn"});
//     }
//
// The function defines the known keys by reading them, each in either spelling (spelling.hpp). Any
// other key is reported with the nearest known one. `about` is for the documents. A rule
// (rules.hpp) describes the allowed values in allowed(), and in declared() as data (declared.hpp).
// Its read() reads a value, reports its faults, and returns whether it is valid. If values have a
// default, the rule's text_of() converts it to text.
#pragma once

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "file/table.hpp"
#include "yaml/declared.hpp"
#include "yaml/document.hpp"
#include "yaml/problems.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::yaml {

// The table files read so far, by path. The scenarios of a family share them across threads.
struct Tables {
  std::mutex mutex;
  std::map<std::string, file::InputTable> by_file;  // guarded by `mutex`; entries are never removed

  [[nodiscard]] std::vector<file::InputTable> all() {
    const std::lock_guard lock(mutex);
    std::vector<file::InputTable> tables;
    for (const auto& [path, table] : by_file) tables.push_back(table);
    return tables;
  }
};

// A single number in SI units.
struct NotedNumber {
  double value = 0;
  Dimension dimension = Dimension::number;
};

// The shared state of the readers of one scenario.
struct Context {
  Problems& problems;
  std::filesystem::path folder;  // the folder of table files
  std::optional<double> end{};   // time.end (s), once read
  std::shared_ptr<Tables> tables = std::make_shared<Tables>();
  // Keys that name files of tables, and the files' paths, in the order of reading.
  std::vector<std::pair<std::string, std::string>> table_files{};
  // If set, receives each single number that is read, by the key's path in American spelling.
  std::map<std::string, NotedNumber>* numbers = nullptr;
  bool own_controller = false;  // set once an external controller is read, which may name columns
};

// A node with the place where the scenario uses it.
struct Value {
  const Node* node;
  std::string path;   // the key's full path as written; empty at the top
  Position position;  // of the key; missing keys inside are reported here
  Context* context;

  [[nodiscard]] Value item(std::size_t i) const;
  [[nodiscard]] std::string path_of(std::string_view key) const;
  // The value at a path of keys and positions below, if present.
  [[nodiscard]] std::optional<Value> at(std::string_view below) const;
  // The last name in the path.
  [[nodiscard]] std::string_view name() const;

  // Reports "path: found <node><remark>; allowed: <allowed>" at the node. Returns false.
  bool refuse(std::string_view remark, std::string_view allowed) const;
  // Reports "path: <message>" at the node. Returns false.
  bool report(std::string_view message) const;
  // The same at the key.
  bool report_at_key(std::string_view message) const;

  // Adds the remark "warning: path: <message>" at the node.
  void warn(std::string_view message) const;
  // Adds the remark "note: path: <message>" at the node.
  void mention(std::string_view message) const;

  // Records that a single number was read here, in SI units.
  void note(double number, Dimension dimension) const;
};

// The entry of a key of a mapping, in either spelling; nullptr if there is none.
[[nodiscard]] const Entry* entry_of(const Node& mapping, std::string_view key);

class Keys {
 public:
  // With `declared`, the reader of an empty mapping declares its keys there.
  explicit Keys(Value mapping, Declared* declared = nullptr)
      : mapping_(std::move(mapping)), declared_(declared) {}

  // The key's value, if present. Makes the key known.
  std::optional<Value> find(std::string_view key);

  // The same for a key that `rule` reads later. `standard` is its default as text, if any.
  template <class Rule>
  std::optional<Value> find(std::string_view key, const Rule& rule, const About& about = {},
                            const std::string& standard = {}) {
    if (declared_ != nullptr) {
      declare({std::string(key), rule.declared(), false, standard, false, about});
    }
    return find(key);
  }

  // Reads the key's value if present. Returns false after reporting a problem.
  template <class Rule, class T>
  bool optional(std::string_view key, const Rule& rule, T& into, const About& about = {}) {
    if (declared_ != nullptr) {
      declare({std::string(key), rule.declared(), false, text_of(rule, into), false, about});
    }
    const std::optional<Value> value = find(key);
    return !value || rule.read(*value, into);
  }

  // The same; `into` is empty if the key is missing.
  template <class Rule, class T>
  bool optional(std::string_view key, const Rule& rule, std::optional<T>& into,
                const About& about = {}) {
    const std::optional<Value> value = find(key, rule, about, into ? text_of(rule, *into) : "");
    return !value || rule.read(*value, into.emplace());
  }

  // Reads the key's value; reports a missing key.
  template <class Rule, class T>
  bool required(std::string_view key, const Rule& rule, T& into, const About& about = {}) {
    if (declared_ != nullptr) {
      declare({std::string(key), rule.declared(), true, {}, false, about});
    }
    const std::optional<Value> value = find(key);
    return value ? rule.read(*value, into) : missing(key, rule.allowed());
  }

  // Reads a mapping. A missing mapping reads like an empty one: it takes all defaults and reports
  // its required keys as missing.
  template <class T>
  bool section(std::string_view key, void (*reader)(Keys&, T&), T& into, const About& about = {});

  // What the documents say of keys that a reader for several mappings declares after this call.
  void about(std::initializer_list<std::string_view> keys, const About& about) {
    if (declared_ == nullptr) return;
    for (const std::string_view key : keys) abouts_.emplace_back(key, about);
  }

  // Reports the missing key at the mapping. Returns false.
  bool missing(std::string_view key, std::string_view allowed);

  // Whether exactly one of the keys is present. Reports it otherwise.
  bool exactly_one(const std::vector<std::string_view>& keys);

  // Declares that exactly one of the keys must be present. The reader reports violations.
  void one_of(const std::vector<std::string_view>& keys);
  // Declares that the keys of a group exclude those of the others. `needed`: one group must be
  // present. The reader reports violations.
  void exclusive(std::initializer_list<std::initializer_list<std::string_view>> groups,
                 bool needed = false) {
    if (declared_ == nullptr) return;
    declared_->choices.push_back({{groups.begin(), groups.end()}, needed});
  }
  // Declares that all keys of one of the groups must be present. The reader reports violations.
  void needs_one(std::initializer_list<std::initializer_list<std::string_view>> groups) {
    if (declared_ == nullptr) return;
    declared_->needs.push_back({groups.begin(), groups.end()});
  }
  // Reports the key, if present, unless the other key is present too.
  void needs(std::string_view key, std::string_view other);

  // Reports unknown keys and repeated keys.
  void finish() const;

  [[nodiscard]] const std::vector<std::string_view>& known() const { return known_; }
  [[nodiscard]] const Value& mapping() const { return mapping_; }
  [[nodiscard]] Context& context() const { return *mapping_.context; }

 private:
  template <class Rule, class T>
  static std::string text_of(const Rule& rule, const T& value) {
    if constexpr (std::is_same_v<T, double>) {
      if (value == std::numeric_limits<double>::infinity()) return "";  // unlimited
    }
    if constexpr (requires { rule.text_of(value); }) {
      return rule.text_of(value);
    } else {
      return "";
    }
  }

  void declare(DeclaredKey key);
  void know(std::string_view key);
  void report_unknown(const Entry& entry) const;
  void report_again(const Entry& entry, const Entry& first) const;

  Value mapping_;
  std::vector<std::string_view> known_;
  Declared* declared_;
  std::vector<std::pair<std::string_view, About>> abouts_;
};

[[nodiscard]] const Node& empty_mapping();

// The rule for a mapping that `reader` reads.
template <class T>
class MappingOf {
 public:
  using Reader = void (*)(Keys&, T&);
  explicit MappingOf(Reader reader) : reader_(reader) {}

  [[nodiscard]] std::string allowed() const {
    std::vector<std::string_view> known;
    read_empty(nullptr, known);
    return "a mapping with " + joined(known);
  }

  // The keys with the values of `defaults`. A key that is known but not declared has the kind
  // `none`.
  [[nodiscard]] Declared declared(const T& defaults = {}) const {
    Declared result(Declared::Kind::mapping);
    std::vector<std::string_view> known;
    read_empty(&result, known, defaults);
    for (const std::string_view key : known) {
      if (std::ranges::find(result.keys, key, &DeclaredKey::name) == result.keys.end()) {
        result.keys.push_back({std::string(key), {}});
      }
    }
    return result;
  }

  bool read(const Value& value, T& into) const {
    if (value.node->kind != Node::Kind::mapping) return value.refuse("", allowed());
    Keys keys(value);
    reader_(keys, into);
    keys.finish();
    return true;
  }

 private:
  void read_empty(Declared* declared, std::vector<std::string_view>& known,
                  const T& defaults = {}) const {
    Problems unheard("", "", {});
    Context context{unheard, {}};
    Keys keys({&empty_mapping(), "", {}, &context}, declared);
    T scratch = defaults;
    reader_(keys, scratch);
    known = keys.known();
  }

  Reader reader_;
};

template <class T>
bool Keys::section(std::string_view key, void (*reader)(Keys&, T&), T& into, const About& about) {
  if (declared_ != nullptr) {
    declare({std::string(key), MappingOf<T>(reader).declared(), false, {}, true, about});
  }
  const std::optional<Value> value = find(key);
  const Value absent{&empty_mapping(), mapping_.path_of(key), mapping_.position, mapping_.context};
  return MappingOf<T>(reader).read(value ? *value : absent, into);
}

}  // namespace bbsim::yaml
