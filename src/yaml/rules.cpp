// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/rules.hpp"

#include <cmath>

namespace bbsim::yaml {

std::string Number::allowed() const {
  const std::string_view such_as = example.empty() ? yaml::example(dimension) : example;
  return std::string(noun(dimension)) + range.text() + ", such as " + std::string(such_as);
}

bool Number::read(const Value& value, double& into) const {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::scalar) return value.refuse("", allowed());
  const Quantity quantity = read_quantity(node.text, node.quoted, dimension);
  if (!quantity.value) return value.refuse(quantity.fault, allowed());
  if (!range.holds(*quantity.value)) return value.refuse("", allowed());
  into = *quantity.value;
  value.note(into, dimension);
  return true;
}

Declared Whole::declared() const {
  Declared value = number().declared();
  value.whole = true;
  return value;
}

Declared Sign::declared() {
  return Declared::any({Declared::number(Dimension::number, {.at_least = 1, .at_most = 1}),
                        Declared::number(Dimension::number, {.at_least = -1, .at_most = -1})});
}

bool Sign::read(const Value& value, int& into) {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::scalar || (node.text != "1" && node.text != "-1")) {
    return value.refuse("", allowed());
  }
  into = node.text == "1" ? 1 : -1;
  return true;
}

bool Whole::read(const Value& value, double& into) const {
  if (!number().read(value, into)) return false;
  return into == std::floor(into) ||
         value.refuse("", "a whole number of at least " + number_text(least));
}

bool Usual::read(const Value& value, double& into) const {
  if (!number.read(value, into)) return false;
  const Node& node = *value.node;
  const bool has_unit = !read_quantity(node.text, node.quoted, Dimension::number).value;
  const double size = std::abs(into);
  if (has_unit || size == 0 || (size <= most && size >= least)) return true;
  value.warn("found " + shown(node) + ", which is read in " +
             std::string(si_unit(number.dimension)) + "; did you mean \"" + shown(node) + ' ' +
             std::string(unit) + "\"?");
  return true;
}

Usual angle_limit(Range range, double most) {
  return {{Dimension::angle, range}, "deg", most};
}

std::string PairOf::allowed() const {
  return "two " + std::string(plural(dimension)) + " [x, y], such as [0.1, 0]";
}

namespace {

// "0" or "1": the position of a component in a path of --set or --vary.
std::optional<std::size_t> position_in_pair(std::string_view key) {
  if (key == "0") return 0;
  if (key == "1") return 1;
  return {};
}

// Whether an override created this node for a missing pair, as --set ball.velocity.0=1 does.
bool holds_positions(const Node& node) {
  return node.kind == Node::Kind::mapping && node.position.source > 0 &&
         std::ranges::all_of(node.entries, [](const Entry& entry) {
           return position_in_pair(entry.key).has_value();
         });
}

}  // namespace

bool PairOf::read(const Value& value, Pair& into) const {
  const Node& node = *value.node;
  if (holds_positions(node)) {  // a component without a value keeps its default
    bool fine = true;
    for (const Entry& entry : node.entries) {
      const Value item{entry.value, value.path_of(entry.key), entry.position, value.context};
      fine = Number{dimension}.read(item, into[*position_in_pair(entry.key)]) && fine;
    }
    return fine;
  }
  const std::string what = allowed();
  return ArrayOf<2>{{dimension}, what}.read(value, into);
}

std::string StateGain::allowed() {
  return "two rows, phi and theta, of four numbers (for x, y, vx, vy) or of eight (for phi, theta, "
         "phi_rate, theta_rate too)";
}

Declared StateGain::declared() {
  const auto row = [](std::size_t size) {
    return Declared::list(size, size, Declared::number(Dimension::number));
  };
  return Declared::list(2, 2, Declared::any({row(4), row(8)}));
}

bool StateGain::read(const Value& value, std::array<std::array<double, 8>, 2>& into) {
  if (value.node->kind != Node::Kind::sequence || value.node->items.size() != into.size()) {
    return value.refuse("", allowed());
  }
  bool fine = true;
  for (std::size_t row = 0; row < into.size(); ++row) {
    const Value numbers = value.item(row);
    const std::size_t count = numbers.node->items.size();
    if (numbers.node->kind != Node::Kind::sequence || (count != 4 && count != 8)) {
      fine = numbers.refuse("", allowed());
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      fine = Number{}.read(numbers.item(i), into[row][i]) && fine;
    }
  }
  return fine;
}

std::string GainMatrix::allowed() const {
  return "a number k, for [[k, 0], [0, k]], or a 2x2 matrix [[a, b], [c, d]]";
}

Declared GainMatrix::declared() {
  return Declared::any(
      {Declared::number(Dimension::number), Declared::list(2, 2, PairOf{}.declared())});
}

bool GainMatrix::read(const Value& value, Matrix2& into) const {
  const Node& node = *value.node;
  if (node.kind == Node::Kind::scalar) {
    const Quantity quantity = read_quantity(node.text, node.quoted, Dimension::number);
    if (!quantity.value) return value.refuse(quantity.fault, allowed());
    into = {{{*quantity.value, 0}, {0, *quantity.value}}};
    value.note(*quantity.value, Dimension::number);
    return true;
  }
  constexpr ArrayOf<2> row{{}, "a row of two numbers, such as [1, 0]"};
  const std::string what = allowed();
  return ArrayOf<2, ArrayOf<2>>{row, what}.read(value, into);
}

bool Text::read(const Value& value, std::string& into) const {
  const Node& node = *value.node;
  if (node.kind != Node::Kind::scalar) return value.refuse("", allowed());
  if (node.text.empty()) return value.refuse("", allowed());
  for (const char c : node.text) {
    const bool line = lines && (c == '\n' || c == '\t');
    if ((static_cast<unsigned char>(c) < 0x20 && !line) || c == 0x7F) {
      return value.refuse(", with control characters", allowed());
    }
  }
  into = node.text;
  return true;
}

bool refuse_name(const Value& value, const std::vector<std::string_view>& names) {
  return value.refuse(hint(value.node->text, names), "one of " + joined(names));
}

}  // namespace bbsim::yaml
