// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A subcommand and its options, by CLI11.
#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/number_text.hpp"
#include "commands.hpp"

namespace bbsim::app {
namespace {

// Prefix of the validator's name, which is never shown.
constexpr std::string_view one_of = "one of ";

}  // namespace

std::vector<std::string> words_of(CLI::Option& option) {
  for (int i = 0;; ++i) {
    const CLI::Validator* validator = nullptr;
    try {
      validator = option.get_validator(i);
    } catch (const CLI::OptionNotFound&) {
      return {};
    }
    const std::string& name = validator->get_name();
    if (name.starts_with(one_of)) return CLI::detail::split(name.substr(one_of.size()), ' ');
  }
}

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::shows_default() {
  option_->capture_default_str();
  return *this;
}

Option& Option::parted_by_commas() {
  option_->delimiter(',');
  return *this;
}

Option& Option::takes_number() {
  const auto fault = [](const std::string& text) -> std::string {
    return number_in<double>(text) ? "" : "found " + text + "; allowed: a number";
  };
  option_->check(CLI::Validator(fault, ""));
  return *this;
}

Option& Option::takes_whole(double least, double most) {
  const auto fault = [least, most](const std::string& text) -> std::string {
    const auto value = number_in<double>(text);
    if (value && is_whole(*value, least, most)) return "";
    return "found " + text + "; allowed: " + whole_numbers(least, most);
  };
  // Without a description, because help would show it as the option's type.
  option_->check(CLI::Validator(fault, ""));
  return *this;
}

Option& Option::takes_one() {
  option_->expected(1)->allow_extra_args(false)->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  return *this;
}

Option& Option::takes_one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words).description("").name(std::string(one_of) +
                                                           CLI::detail::join(words, " ")));
  return *this;
}

Option& Option::excludes(const Option& option) {
  option_->excludes(option.option_);
  return *this;
}

std::string Command::name() const {
  return app_->get_name();
}

void Command::footer(const std::string& text) {
  app_->footer(text);
}

template <class Value>
Option Command::option(const std::string& names, Value& value, const std::string& what) {
  const std::size_t blank = names.find(' ');
  CLI::Option* const option = app_->add_option(names.substr(0, blank), value, what);
  if (blank != std::string::npos) option->type_name(names.substr(blank + 1));
  if (option->get_expected_max() > 1 && !option->get_positional()) {
    option->take_all()->expected(1)->allow_extra_args(false);
  }
  constexpr bool is_text = std::is_same_v<Value, std::string>;
  if constexpr (is_text || std::is_same_v<Value, std::vector<std::string>>) {
    // An empty value is often an unset variable of a script.
    const auto fault = [](const std::string& text) -> std::string {
      return text.empty() ? "found nothing; allowed: a value, or leave the option out" : "";
    };
    option->check(CLI::Validator(fault, ""));
  }
  return Option(*option);
}

using Text = const std::string;
template Option Command::option(Text&, std::string&, Text&);
template Option Command::option(Text&, std::size_t&, Text&);
template Option Command::option(Text&, std::optional<double>&, Text&);
template Option Command::option(Text&, std::vector<std::string>&, Text&);
template Option Command::option(Text&, std::vector<double>&, Text&);

Option Command::flag(const std::string& names, bool& value, const std::string& what) {
  return Option(*app_->add_flag(names, value, what));
}

void Command::does(Chosen what) {
  app_->callback([&chosen = *chosen_, what = std::move(what)] { chosen = what; });
}

}  // namespace bbsim::app
