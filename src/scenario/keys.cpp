// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/keys.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "scenario/sections.hpp"
#include "yaml/quantity.hpp"
#include "yaml/rules.hpp"
#include "yaml/spelling.hpp"

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

struct Leaf {
  const Declared* value;
  std::string standard{};
  yaml::About about{};  // of the nearest key that has a meaning
};

// The declaration of this kind at the path from a value.
std::optional<Leaf> find_leaf(const Leaf& from, std::string_view path, Declared::Kind kind) {
  const Declared& declared = *from.value;
  if (declared.kind == Declared::Kind::any) {
    for (const Declared& part : declared.parts) {
      if (const auto found = find_leaf({&part, from.standard, from.about}, path, kind)) {
        return found;
      }
    }
    return {};
  }
  if (path.empty()) return declared.kind == kind ? std::optional(from) : std::nullopt;
  const std::size_t dot = path.find('.');
  const std::string_view name = path.substr(0, dot);
  const std::string_view rest = dot == std::string_view::npos ? "" : path.substr(dot + 1);
  if (declared.kind == Declared::Kind::mapping) {
    const auto key = std::ranges::find(declared.keys, name, &yaml::DeclaredKey::name);
    if (key == declared.keys.end()) return {};
    const yaml::About& about = key->about.meaning.empty() ? from.about : key->about;
    return find_leaf({&key->value, key->standard, about}, rest, kind);
  }
  const bool holds_any =
      declared.kind == Declared::Kind::list || declared.kind == Declared::Kind::names;
  if (!holds_any || declared.parts.empty()) return {};
  return find_leaf({&declared.parts.front(), "", from.about}, rest, kind);
}

// What a servo has without its key: by its model, by its speed, or in common for both axes. Empty
// for other keys.
std::optional<double> of_servo(const std::string& name, const ScenarioFamily& family) {
  constexpr std::string_view prefix = "gimbal.servo.";
  if (!name.starts_with(prefix) || family.text_at("gimbal.servo").empty()) return {};
  const Scenario scene = family.read({});
  std::string_view key = std::string_view(name).substr(prefix.size());
  const bool of_theta = key.starts_with("theta.");
  if (of_theta || key.starts_with("phi.")) key.remove_prefix(key.find('.') + 1);
  const Servo& servo = scene.gimbal.servo_of(of_theta ? 1 : 0);
  const Declared has = declared_servo(servo);
  const auto found = std::ranges::find(has.keys, key, &yaml::DeclaredKey::name);
  return found == has.keys.end() ? std::nullopt : number_in<double>(found->standard);
}

}  // namespace

const Declared& declared_keys() {
  static const Declared declared = yaml::MappingOf(read_sections).declared();
  return declared;
}

std::vector<std::string> key_paths() {
  std::set<std::string> paths;
  add(declared_keys(), "", paths);
  return {paths.begin(), paths.end()};
}

std::string plain_meaning(const yaml::About& about) {
  std::string text(about.meaning);
  for (auto link = text.find("]("); link != std::string::npos; link = text.find("](")) {
    text.erase(link, text.find(')', link) - link + 1);
    text.erase(text.rfind('[', link), 1);
  }
  std::erase_if(text, [](char c) { return c == '`' || c == '$' || c == '*' || c == '\\'; });
  return text;
}

std::optional<NumberKey> number_key(std::string_view path) {
  const auto leaf = find_leaf({&declared_keys()}, yaml::american(path), Declared::Kind::number);
  if (!leaf) return {};
  return NumberKey{leaf->value->dimension, leaf->value->range,
                   yaml::read_quantity(leaf->standard, false, leaf->value->dimension).value,
                   leaf->value->whole, plain_meaning(leaf->about)};
}

std::optional<std::string> scalar_default(std::string_view path) {
  for (const auto kind : {Declared::Kind::number, Declared::Kind::name}) {
    const auto leaf = find_leaf({&declared_keys()}, yaml::american(path), kind);
    if (leaf) return leaf->standard;
  }
  return {};
}

ScenarioFamily::Setting NamedNumber::setting(double to) const {
  return {name, number_text(to) + (unit.empty() ? "" : " " + unit)};
}

NamedNumber number_named(const std::string& option, std::string name,
                         const ScenarioFamily& family) {
  const auto known = number_key(name);
  if (!known) {
    // The scenario's reader throws if the key is unknown.
    static_cast<void>(family.read({{name, "1"}}));
    throw InputError(option + ": " + shown(name) +
                     ": takes no single number; allowed: a key that is a number, such as "
                     "ball.radius");
  }
  NamedNumber found{std::move(name), *known, std::string(yaml::si_unit(known->dimension))};
  found.value = family.number_at(found.name, {});
  if (!found.value) found.value = of_servo(found.name, family);
  if (!found.value) found.value = known->standard;
  return found;
}

}  // namespace bbsim::scenario
