// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `controller.program` and `controller.library`.
#include <algorithm>
#include <string>
#include <utility>

#include "scenario/columns.hpp"
#include "scenario/sections.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

// Parameters of an external controller: names with numbers.
struct Parameters {
  [[nodiscard]] static std::string allowed() {
    return "a mapping of names to numbers, such as {kp: 0.7}";
  }

  [[nodiscard]] static yaml::Declared declared() {
    yaml::Declared value(yaml::Declared::Kind::names);
    value.parts.push_back(yaml::Declared::number(yaml::Dimension::number));
    return value;
  }
  static bool read(const yaml::Value& value, std::vector<Parameter>& into) {
    if (value.node->kind != yaml::Node::Kind::mapping) return value.refuse("", allowed());
    yaml::Keys keys(value);
    bool fine = true;
    for (const yaml::Entry& entry : value.node->entries) {
      const std::optional<yaml::Value> found = keys.find(entry.key);
      if (!found) continue;  // an override removed it
      const yaml::Value& number = *found;
      if (!is_own_name(entry.key)) {
        fine = number.report(
            "found a name with characters other than letters, digits and underscores, or more than "
            "60; allowed: a name such as kp");
      } else if (yaml::Number{yaml::Dimension::number, {}, "0.7"}.read(
                     number, into.emplace_back(Parameter{entry.key, 0}).value)) {
        continue;
      }
      fine = false;
    }
    keys.finish();
    return fine;
  }
};

constexpr yaml::Range some_time{.above = 0, .at_most = 86400};

void read_process(yaml::Keys& keys, ControllerProgram& program,
                  std::vector<Parameter>& parameters) {
  const yaml::ListOf<yaml::Text, std::string> words{
      {"a word"}, 1, 1000, "words, such as [python3, pid.py]"};
  keys.required("command", words, program.command,
                {.meaning = "the program and its arguments; no shell reads them",
                 .range = "1 to 1000 words"});
  keys.optional("parameters", Parameters{}, parameters,
                {"names and numbers that bbsim passes to the program: `{kp: 0.7}`"});
  const yaml::Number time{yaml::Dimension::time, some_time};
  keys.optional("timeout", time, program.timeout, {"for each answer"});
  program.start_timeout = std::max(program.start_timeout, program.timeout);
  keys.optional("start_timeout", time, program.start_timeout,
                {.meaning = "for the first answer, which includes the program's startup",
                 .standard = "5, at least `timeout`"});
}

void read_serial(yaml::Keys& keys, SerialProgram& serial) {
  keys.about({"command", "parameters", "timeout", "start_timeout"},
             {.meaning = "[a program at the sketch's `Serial`](#a-program-and-a-sketch); as of "
                         "`controller.program`",
              .standard = "-"});
  read_process(keys, serial.program, serial.parameters);
  const yaml::Number period{yaml::Dimension::time, {.above = 0}, period_example};
  keys.optional("period", Period{{period, "ms", 1}}, serial.period,
                {.meaning = "time between samples of that program, such as its camera's frames",
                 .standard = "`sampling.period`",
                 .range = "≥ `sampling.period`"});
  keys.optional(
      "delay", yaml::Number{yaml::Dimension::time, {.at_least = 0}}, serial.delay,
      {"time from a sample to the first byte that the program sends, such as its computation"});
}

}  // namespace

void read_program(yaml::Keys& keys, Controller& controller) {
  OwnController& own = controller.own.emplace();
  ControllerProgram program;
  read_process(keys, program, own.parameters);
  own.by = std::move(program);
  own.folder = keys.context().folder.string();
  keys.context().own_controller = true;
}

void read_library(yaml::Keys& keys, Controller& controller) {
  OwnController& own = controller.own.emplace();
  ControllerLibrary library;
  keys.required("file", yaml::Text{"the name of a shared library"}, library.file,
                {"the shared library, relative to the scenario"});
  keys.optional("wiring", yaml::Text{"the name of a file that says what a sketch is wired to"},
                library.wiring,
                {"for a sketch: the [wiring](wiring.md) of its board, relative to the scenario"});
  keys.optional("serial", yaml::MappingOf(read_serial), library.serial);
  keys.optional("parameters", Parameters{}, own.parameters,
                {"names and numbers that bbsim passes to the library"});
  own.by = std::move(library);
  own.folder = keys.context().folder.string();
  keys.context().own_controller = true;
}

}  // namespace bbsim::scenario
