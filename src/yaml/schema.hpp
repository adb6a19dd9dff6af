// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How a mapping of the scenario is read into a struct: one function a mapping.
//
//     void read_ball(Keys& keys, Ball& ball) {
//       keys.required("radius", Number{Dimension::length, {.above = 0}}, ball.radius);
//       keys.optional("spin", Number{Dimension::angular_rate}, ball.spin);
//     }
//
// The keys that the function asks for are the known ones, in either spelling (spelling.hpp): any
// other is reported, with the nearest known one. A rule (rules.hpp) says what a value may be, in
// `allowed()`, and reads it, in `read()`, which reports what is wrong and returns whether all is
// well.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "file/table_writer.hpp"
#include "yaml/document.hpp"
#include "yaml/problems.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::yaml {

// The table files read so far, by path; scenarios of one family share them, over threads.
struct Tables {
  std::mutex mutex;
  std::map<std::string, file::InputTable> by_file;  // under the mutex; a table once read stays

  [[nodiscard]] std::vector<file::InputTable> all() {
    const std::lock_guard lock(mutex);
    std::vector<file::InputTable> tables;
    for (const auto& [path, table] : by_file) tables.push_back(table);
    return tables;
  }
};

// A single number, in SI units.
struct NotedNumber {
  double value = 0;
  Dimension dimension = Dimension::number;
};

// What reading a scenario shares.
struct Context {
  Problems& problems;
  std::filesystem::path folder;  // where table files are
  std::optional<double> end{};   // time.end, s, once it is read
  std::shared_ptr<Tables> tables = std::make_shared<Tables>();
  // Where each single number goes that is read, if somebody asks, by its key's path in American
  // spelling.
  std::map<std::string, NotedNumber>* numbers = nullptr;
  bool own_controller = false;  // which gives numbers of its own names; once it is read
};

// A node on its way into the scenario.
struct Value {
  const Node* node;
  std::string path;   // its key's full path as written, empty at the top
  Position position;  // of its key: where something missing inside is reported
  Context* context;

  [[nodiscard]] Value item(std::size_t i) const;
  [[nodiscard]] std::string path_of(std::string_view key) const;
  // The last name of the path.
  [[nodiscard]] std::string_view name() const;

  // Reports "path: found <node><remark>; allowed: <allowed>" at the node. Returns false.
  bool refuse(std::string_view remark, std::string_view allowed) const;
  // Reports "path: <message>" at the node. Returns false.
  bool report(std::string_view message) const;

  // Remarks at the node, with the key's path: "warning: path: <message>".
  void warn(std::string_view message) const;
  // The same of what is as it should be: "note: path: <message>".
  void mention(std::string_view message) const;

  // Says that a single number was read here, in SI units.
  void note(double number, Dimension dimension) const;
};

class Keys {
 public:
  explicit Keys(Value mapping) : mapping_(std::move(mapping)) {}

  // The value of that key, if it is there. The key is known from now on.
  std::optional<Value> find(std::string_view key);

  // Reads the key's value if it is there. Returns false after reporting a problem.
  template <class Rule, class T>
  bool optional(std::string_view key, const Rule& rule, T& into) {
    const std::optional<Value> value = find(key);
    return !value || rule.read(*value, into);
  }

  // Reads the value as above; `into` is set if the key is there, and empty if not.
  template <class Rule, class T>
  bool optional(std::string_view key, const Rule& rule, std::optional<T>& into) {
    const std::optional<Value> value = find(key);
    return !value || rule.read(*value, into.emplace());
  }

  // Reads the key's value; reports it as missing if it is not there.
  template <class Rule, class T>
  bool required(std::string_view key, const Rule& rule, T& into) {
    const std::optional<Value> value = find(key);
    return value ? rule.read(*value, into) : missing(key, rule.allowed());
  }

  // Reads a mapping that, where it is not there, reads as an empty one: all defaults, and its own
  // required keys reported as missing.
  template <class T>
  bool section(std::string_view key, void (*reader)(Keys&, T&), T& into);

  // Reports at the mapping that the key is missing. Returns false.
  bool missing(std::string_view key, std::string_view allowed);

  // Whether exactly one of the keys is there; reports it if not.
  bool exactly_one(const std::vector<std::string_view>& keys);

  // Reports each key that nobody asked for, and each that is there more than once.
  void finish() const;

  [[nodiscard]] const std::vector<std::string_view>& known() const { return known_; }
  [[nodiscard]] const Value& mapping() const { return mapping_; }
  [[nodiscard]] Context& context() const { return *mapping_.context; }

 private:
  void know(std::string_view key);
  void report_unknown(const Entry& entry) const;
  void report_again(const Entry& entry, const Entry& first) const;

  Value mapping_;
  std::vector<std::string_view> known_;
};

[[nodiscard]] std::string comma_separated(const std::vector<std::string_view>& words);

// The rule of a mapping that `reader` reads.
template <class T>
class MappingOf {
 public:
  using Reader = void (*)(Keys&, T&);
  explicit MappingOf(Reader reader) : reader_(reader) {}

  // The known keys are found by reading a mapping without any.
  [[nodiscard]] std::string allowed() const {
    Problems unheard("", "", {});
    Context context{unheard, {}};
    Node empty;
    empty.kind = Node::Kind::mapping;
    Keys keys({&empty, "", {}, &context});
    T scratch{};
    reader_(keys, scratch);
    return "a mapping with " + comma_separated(keys.known());
  }

  bool read(const Value& value, T& into) const {
    if (value.node->kind != Node::Kind::mapping) return value.refuse("", allowed());
    Keys keys(value);
    reader_(keys, into);
    keys.finish();
    return true;
  }

 private:
  Reader reader_;
};

template <class T>
bool Keys::section(std::string_view key, void (*reader)(Keys&, T&), T& into) {
  static const Node empty = [] {
    Node node;
    node.kind = Node::Kind::mapping;
    return node;
  }();
  const std::optional<Value> value = find(key);
  const Value absent{&empty, mapping_.path_of(key), mapping_.position, mapping_.context};
  return MappingOf<T>(reader).read(value ? *value : absent, into);
}

}  // namespace bbsim::yaml
