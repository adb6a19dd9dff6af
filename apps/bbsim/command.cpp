// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <string_view>
#include <utility>

#include "base/number_text.hpp"

namespace bbsim::app {

namespace {

// Refuses an option with an empty value, which is often an unset variable of a script.
CLI::Option* refusing_nothing(CLI::Option* option) {
  const auto fault = [](const std::string& text) -> std::string {
    return text.empty() ? "found nothing; allowed: a value, or leave the option out" : "";
  };
  return option->check(CLI::Validator(fault, ""));
}

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

Option& Option::takes(const std::string& type) {
  option_->type_name(type);
  return *this;
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
  option_->delimiter(',')->allow_extra_args(false);
  return *this;
}

Option& Option::may_be_repeated() {
  option_->take_all()->expected(1)->allow_extra_args(false);
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
  option_->expected(1)->allow_extra_args(false);
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

Option Command::option(const std::string& names, std::string& value, const std::string& what) {
  return Option(*refusing_nothing(app_->add_option(names, value, what)));
}

Option Command::option(const std::string& names, std::size_t& value, const std::string& what) {
  return Option(*app_->add_option(names, value, what));
}

Option Command::option(const std::string& names, std::optional<double>& value,
                       const std::string& what) {
  return Option(*app_->add_option(names, value, what));
}

Option Command::option(const std::string& names, std::vector<std::string>& values,
                       const std::string& what) {
  return Option(*refusing_nothing(app_->add_option(names, values, what)));
}

Option Command::option(const std::string& names, std::vector<double>& values,
                       const std::string& what) {
  return Option(*app_->add_option(names, values, what));
}

Option Command::flag(const std::string& names, bool& value, const std::string& what) {
  return Option(*app_->add_flag(names, value, what));
}

void Command::does(Chosen what) {
  app_->callback([&chosen = *chosen_, what = std::move(what)] { chosen = what; });
}

}  // namespace bbsim::app
