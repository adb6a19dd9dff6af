// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scenario/variation.hpp"

#include <string_view>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "yaml/problems.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::scenario {
namespace {

constexpr std::size_t most_values = 1'000'000'000;

constexpr std::string_view allowed =
    "linear:FROM:TO:COUNT, log:FROM:TO:COUNT, list:A,B,C, uniform:FROM:TO or normal:MEAN:SD";

using Way = VariationSpec::Kind;

struct Form {
  std::string_view name;
  Way kind;
  std::size_t parts;  // after the name
};
constexpr Form forms[] = {{"linear", Way::linear, 3},
                          {"log", Way::log, 3},
                          {"list", Way::list, 1},
                          {"uniform", Way::uniform, 2},
                          {"normal", Way::normal, 2}};

// Splits at separators outside brackets and quotes.
std::vector<std::string> parted(std::string_view text, char separator) {
  std::vector<std::string> parts;
  int depth = 0;
  char quote = 0;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i == text.size() || (text[i] == separator && depth == 0 && quote == 0)) {
      parts.emplace_back(trimmed(text.substr(start, i - start)));
      start = i + 1;
    } else if (quote != 0) {
      if (text[i] == quote) quote = 0;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else {
      depth += (text[i] == '[' || text[i] == '{') - (text[i] == ']' || text[i] == '}');
    }
  }
  return parts;
}

[[noreturn]] void fail(const Variation& variation, const std::string& found,
                       std::string_view wanted) {
  throw InputError(yaml::shown(variation.key) + ": found " + found +
                   "; allowed: " + std::string(wanted));
}

std::size_t read_count(const Variation& variation, const std::string& text) {
  const auto count = number_in<std::size_t>(text);
  if (!count || *count == 0 || *count > most_values) {
    fail(variation, "the count " + yaml::shown(text), "a whole number from 1 to 1e9");
  }
  return *count;
}

// Whether a bound, possibly in quotes, starts with a number. Its unit is read later, with its key.
bool starts_with_number(std::string_view bound) {
  if (bound.front() == '"' || bound.front() == '\'') bound.remove_prefix(1);
  return yaml::leading_decimal(bound).length > 0;
}

}  // namespace

VariationSpec parse_variation(const Variation& variation) {
  const std::string_view text = variation.spec;
  const std::size_t colon = text.find(':');
  const std::string_view name = trimmed(text.substr(0, colon));
  const Form* form = nullptr;
  for (const Form& known : forms) {
    if (known.name == name) form = &known;
  }
  if (form == nullptr || colon == std::string_view::npos) {
    fail(variation, yaml::shown(text.empty() ? "nothing" : text), allowed);
  }
  const std::string_view rest = text.substr(colon + 1);
  VariationSpec spec;
  spec.kind = form->kind;
  if (spec.kind == Way::list) {
    spec.values = parted(rest, ',');
    spec.count = spec.values.size();
  } else {
    spec.values = parted(rest, ':');
    if (spec.values.size() != form->parts) fail(variation, yaml::shown(text), allowed);
    if (form->parts == 3) {
      spec.count = read_count(variation, spec.values.back());
      spec.values.pop_back();
    }
  }
  for (const std::string& value : spec.values) {
    if (value.empty()) fail(variation, "an empty value in " + yaml::shown(text), allowed);
    if (spec.kind != Way::list && !starts_with_number(value)) {
      fail(variation, yaml::shown(value) + " in " + yaml::shown(text),
           "numbers and quantities, such as linear:0.01:0.02:11");
    }
  }
  return spec;
}

std::vector<TiedKey> tied_keys(const Variation& variation) {
  std::vector<TiedKey> keys;
  for (const std::string& part : parted(variation.key, ',')) {
    TiedKey key{part};
    if (const std::size_t star = part.find('*'); star != std::string::npos) {
      const yaml::Quantity number = yaml::read_quantity(std::string_view(part).substr(0, star),
                                                        false, yaml::Dimension::number);
      key = {std::string(trimmed(std::string_view(part).substr(star + 1))),
             number.value.value_or(0)};
    } else if (part.starts_with('-')) {
      key = {std::string(trimmed(std::string_view(part).substr(1))), -1};
    }
    if (key.path.empty() || key.factor == 0) {
      fail(variation, part.empty() ? "no key beside a comma" : yaml::shown(part),
           "KEY, -KEY or NUMBER*KEY with a number that is not 0, separated by commas");
    }
    keys.push_back(std::move(key));
  }
  return keys;
}

std::string scaled(const std::string& value, double factor) {
  if (factor == 1) return value;
  const yaml::Decimal decimal = yaml::leading_decimal(value);
  if (decimal.length == 0) return "";
  const std::optional<double> number = yaml::to_double(decimal, 0).value;
  if (!number) return "";
  // Adding 0 turns -0 into 0.
  return number_text(factor * *number + 0.0) + value.substr(decimal.length);
}

Variation split_variation(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--vary: found " + yaml::shown(assignment) +
                     "; allowed: KEY=SPEC, such as ball.position.0=linear:-0.1:0.1:21");
  }
  return {assignment.substr(0, equals), assignment.substr(equals + 1)};
}

}  // namespace bbsim::scenario
