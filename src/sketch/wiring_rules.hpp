// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Rules for values of a wiring, in addition to those of yaml/rules.hpp.
#pragma once

#include <bbsim/wiring.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/pair.hpp"
#include "yaml/rules.hpp"

namespace bbsim::sketch {

// The number of the pin with this name, or -1.
[[nodiscard]] inline int pin_of(std::string_view name) {
  const bool analog = name.starts_with('A');
  if (analog) name.remove_prefix(1);
  if (name.empty() || name.size() > 2 || (name.size() == 2 && name[0] == '0')) return -1;
  int number = 0;
  for (const char c : name) {
    if (c < '0' || c > '9') return -1;
    number = 10 * number + (c - '0');
  }
  if (number > (analog ? 15 : 53)) return -1;
  return analog ? 54 + number : number;  // as Arduino.h numbers them
}

struct Pin {
  [[nodiscard]] static std::string allowed() { return "a pin, 0 to 53 or A0 to A15"; }
  [[nodiscard]] static yaml::Declared declared() { return yaml::Declared::Kind::text; }
  static bool read(const yaml::Value& value, int& into) {
    into = value.node->kind == yaml::Node::Kind::scalar ? pin_of(value.node->text) : -1;
    return into >= 0 || value.refuse("", allowed());
  }
};

struct Whole {
  int least, most;

  [[nodiscard]] std::string allowed() const {
    return "a whole number from " + std::to_string(least) + " to " + std::to_string(most);
  }
  [[nodiscard]] yaml::Declared declared() const {
    yaml::Declared number = yaml::Declared::number(
        yaml::Dimension::number, {.at_least = double(least), .at_most = double(most)});
    number.whole = true;
    return number;
  }
  bool read(const yaml::Value& value, int& into) const {
    double number = 0;
    const yaml::Number any{yaml::Dimension::number, {}, "1"};
    if (value.node->kind != yaml::Node::Kind::scalar) return value.refuse("", allowed());
    if (!any.read(value, number)) return false;
    if (!(number >= least && number <= most) || number != std::floor(number)) {
      return value.refuse("", allowed());
    }
    into = static_cast<int>(number);
    return true;
  }
};

// {counts: [low, high], position: [low, high]}
struct CountMap {
  [[nodiscard]] static std::string allowed() {
    return "two places, such as {counts: [100, 920], position: [\"-16 cm\", \"16 cm\"]}";
  }
  static void read_keys(yaml::Keys& keys, bbsim_count_map& map) {
    Pair counts{0, 1}, position{0, 1};
    keys.required("counts", yaml::PairOf{yaml::Dimension::number}, counts);
    if (keys.required("position", yaml::PairOf{yaml::Dimension::length}, position) &&
        position[0] == position[1]) {
      keys.find("position")->refuse("", "two different lengths");
    }
    map = {{counts[0], counts[1]}, {position[0], position[1]}};
  }
  [[nodiscard]] static yaml::Declared declared() { return yaml::MappingOf(read_keys).declared(); }
  static bool read(const yaml::Value& value, bbsim_count_map& into) {
    if (value.node->kind != yaml::Node::Kind::mapping) return value.refuse("", allowed());
    return yaml::MappingOf(read_keys).read(value, into);
  }
};

// Pins with the values that they read.
struct Inputs {
  [[nodiscard]] static std::string allowed() {
    return "a mapping of pins to what they read, such as {A5: 512, 7: 1}";
  }
  [[nodiscard]] static yaml::Declared declared() {
    yaml::Declared pins(yaml::Declared::Kind::names);
    pins.parts.push_back(yaml::Declared::number(yaml::Dimension::number));
    return pins;
  }
  static bool read(const yaml::Value& value, std::vector<bbsim_wired_input>& into) {
    if (value.node->kind != yaml::Node::Kind::mapping) return value.refuse("", allowed());
    yaml::Keys keys(value);
    bool fine = true;
    for (const yaml::Entry& entry : value.node->entries) {
      const auto found = keys.find(entry.key);
      const int pin = pin_of(entry.key);
      if (!found) continue;
      if (pin < 0) {
        fine = found->report("found no pin; allowed: " + Pin::allowed());
        continue;
      }
      const int most = pin < 54 ? 1 : 65535;
      int level = 0;
      fine = Whole{0, most}.read(*found, level) && fine;
      into.push_back({pin, static_cast<double>(level)});
    }
    keys.finish();
    return fine;
  }
};

}  // namespace bbsim::sketch
