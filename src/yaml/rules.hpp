// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The rules for values: the allowed values and how to read them (schema.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "base/number_text.hpp"
#include "base/pair.hpp"
#include "yaml/quantity.hpp"
#include "yaml/schema.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::yaml {

// A number in SI units, or a quantity.
struct Number {
  Dimension dimension = Dimension::number;
  Range range{};
  std::string_view example{};  // empty: the dimension's example

  [[nodiscard]] std::string allowed() const;
  [[nodiscard]] Declared declared() const { return Declared::number(dimension, range); }
  [[nodiscard]] static std::string text_of(double value) { return number_text(value); }
  bool read(const Value& value, double& into) const;
};

// A number without a fraction, from `least` up.
struct Whole {
  double least;
  std::string_view example;

  [[nodiscard]] Number number() const {
    return {Dimension::number, {.at_least = least, .at_most = largest_whole}, example};
  }
  [[nodiscard]] std::string allowed() const { return number().allowed(); }
  [[nodiscard]] Declared declared() const;
  [[nodiscard]] static std::string text_of(double value) { return number_text(value); }
  bool read(const Value& value, double& into) const;
};

// A number that is rarely above `most` or below `least`, in SI units. Such a number without a unit
// is read with a warning, because `unit` may have been meant.
struct Usual {
  Number number;
  std::string_view unit;  // "deg"
  double most;
  double least = 0;

  [[nodiscard]] std::string allowed() const { return number.allowed(); }
  [[nodiscard]] Declared declared() const { return number.declared(); }
  [[nodiscard]] static std::string text_of(double value) { return number_text(value); }
  bool read(const Value& value, double& into) const;
};

// A limit of an angle. More than `most` without a unit may be in degrees.
[[nodiscard]] Usual angle_limit(Range range, double most = 2 * std::numbers::pi);

// [x, y]
struct PairOf {
  Dimension dimension = Dimension::number;

  [[nodiscard]] std::string allowed() const;
  [[nodiscard]] Declared declared() const {
    return Declared::list(2, 2, Declared::number(dimension));
  }
  [[nodiscard]] static std::string text_of(const Pair& value) {
    return '[' + number_text(value[0]) + ", " + number_text(value[1]) + ']';
  }
  bool read(const Value& value, Pair& into) const;
};

// A fixed count of values; `each` reads one.
template <std::size_t count, class Rule = Number>
struct ArrayOf {
  Rule each;
  std::string_view what;  // "two lengths greater than 0, such as [0.3, 0.2]"

  [[nodiscard]] std::string allowed() const { return std::string(what); }
  [[nodiscard]] Declared declared() const { return Declared::list(count, count, each.declared()); }
  template <class T>
  bool read(const Value& value, std::array<T, count>& into) const {
    if (value.node->kind != Node::Kind::sequence || value.node->items.size() != count) {
      return value.refuse("", allowed());
    }
    bool fine = true;
    for (std::size_t i = 0; i < count; ++i) fine = each.read(value.item(i), into[i]) && fine;
    return fine;
  }
};

// [width, height] of a rectangle (m).
inline constexpr ArrayOf<2> sides{{Dimension::length, {.above = 0}},
                                  "two lengths greater than 0, such as [0.3, 0.2]"};

// Two rows, for phi and theta, of four gains (for x, y, vx, vy) or eight (also for phi, theta and
// their rates).
struct StateGain {
  [[nodiscard]] static std::string allowed();
  [[nodiscard]] static Declared declared();
  static bool read(const Value& value, std::array<std::array<double, 8>, 2>& into);
};

// A list of values; `rule` reads each item. `once`: no value occurs twice.
template <class Rule, class T>
struct ListOf {
  Rule rule;
  std::size_t fewest, most;
  std::string_view items;   // "points [x, y]"
  std::string_view once{};  // "each key once"

  [[nodiscard]] std::string allowed() const {
    const std::string limits = std::to_string(fewest) + " to " + std::to_string(most) + ' ';
    return "a list of " + (most == Declared::unbounded ? "" : limits) + std::string(items);
  }
  [[nodiscard]] Declared declared() const {
    Declared list = Declared::list(fewest, most, rule.declared());
    list.distinct = !once.empty();
    return list;
  }
  bool read(const Value& value, std::vector<T>& into) const {
    const Node& node = *value.node;
    if (node.kind != Node::Kind::sequence || node.items.size() < fewest ||
        node.items.size() > most) {
      return value.refuse("", allowed());
    }
    into.resize(node.items.size());
    bool fine = true;
    for (std::size_t i = 0; i < into.size(); ++i) {
      fine = rule.read(value.item(i), into[i]) && fine;
    }
    const bool read = fine && !once.empty();
    if constexpr (std::equality_comparable<T>) {
      for (std::size_t i = 1; read && i < into.size(); ++i) {
        const auto here = into.begin() + static_cast<std::ptrdiff_t>(i);
        if (std::find(into.begin(), here, *here) == here) continue;
        fine = value.item(i).refuse(" again", once);
      }
    }
    return fine;
  }
};

// The sign of a direction.
struct Sign {
  [[nodiscard]] static std::string allowed() { return "1 or -1"; }
  [[nodiscard]] static Declared declared();
  [[nodiscard]] static std::string text_of(int sign) { return std::to_string(sign); }
  static bool read(const Value& value, int& into);
};

// A number k, which means [[k, 0], [0, k]], or a matrix [[a, b], [c, d]].
struct GainMatrix {
  [[nodiscard]] std::string allowed() const;
  [[nodiscard]] static Declared declared();
  bool read(const Value& value, Matrix2& into) const;
};

// Text without control characters. `lines` allows line breaks and tabs.
struct Text {
  std::string_view meaning;  // "the name of a column"
  bool lines = false;

  [[nodiscard]] std::string allowed() const { return std::string(meaning); }
  [[nodiscard]] static Declared declared() { return Declared::Kind::text; }
  bool read(const Value& value, std::string& into) const;
};

// Reports that the text is not one of the names, and suggests the nearest one. Returns false.
bool refuse_name(const Value& value, const std::vector<std::string_view>& names);

// The name of an enumerator.
template <class Enum>
struct NameOf {
  struct Named {
    Enum value;
    std::string_view name;
  };
  std::vector<Named> choices;

  [[nodiscard]] std::vector<std::string_view> names() const {
    std::vector<std::string_view> list;
    std::ranges::transform(choices, std::back_inserter(list), &Named::name);
    return list;
  }
  [[nodiscard]] std::string allowed() const { return "one of " + joined(names()); }
  [[nodiscard]] Declared declared() const {
    Declared name(Declared::Kind::name);
    for (const Named& choice : choices) name.names.emplace_back(choice.name);
    return name;
  }
  [[nodiscard]] std::string text_of(Enum value) const {
    return std::string(std::ranges::find(choices, value, &Named::value)->name);
  }

  bool read(const Value& value, Enum& into) const {
    if (value.node->kind != Node::Kind::scalar) return value.refuse("", allowed());
    const auto choice = std::ranges::find(choices, value.node->text, &Named::name);
    if (choice == choices.end()) return refuse_name(value, names());
    into = choice->value;
    return true;
  }
};

}  // namespace bbsim::yaml
