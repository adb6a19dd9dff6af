// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The entry points shared by the C++ library and Python: text or a dict, settings, and check().
//
// An input is YAML, with lines "--set KEY=VALUE" and "--number KEY=VALUE". If its first line is
// "dict", the rest is JSON, converted to text as python/bbsim/_scenario.py converts a dict; numbers
// beyond 1e300, and 1e-301, stand for those that JSON lacks. A line "--check" calls check(), which
// takes a second for a loop under sanitizers; without it, a run reads the scenario and is stopped
// as it begins.
#include <sys/types.h>

#include <algorithm>
#include <bbsim/bbsim.hpp>
#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "controller/foreign_code.hpp"
#include "fuzz.hpp"
#include "yaml/document.hpp"

namespace {

using namespace bbsim_fuzz;
using Json = nlohmann::ordered_json;

// Whether Python can represent it as str.
bool is_unicode(const std::string& text) {
  try {
    static_cast<void>(Json(text).dump());
    return true;
  } catch (const Json::type_error&) {
    return false;
  }
}

// _scenario.py: _plain, _text.
std::string text_of(const Json& value) {
  std::string text;
  if (value.is_object()) {
    for (const auto& [key, one] : value.items()) {
      text += (text.empty() ? "" : ", ") + Json(key).dump() + ": " + text_of(one);
    }
    return '{' + text + '}';
  }
  if (value.is_array()) {
    for (const Json& one : value) text += (text.empty() ? "" : ", ") + text_of(one);
    return '[' + text + ']';
  }
  if (value.is_number_float()) {
    const auto number = value.get<double>();
    if (number > 1e300) return ".inf";
    if (number < -1e300) return "-.inf";
    if (number == 1e-301) return ".nan";
  }
  return value.dump();
}

// YAML limits the length of keys, so that a reader can recognize one early.
bool has_short_keys(const Json& value) {
  if (!value.is_structured()) return true;
  for (const auto& [key, one] : value.items()) {
    if ((value.is_object() && key.size() > 1000) || !has_short_keys(one)) return false;
  }
  return true;
}

int height_of(const Json& value) {
  int most = 0;
  if (value.is_structured()) {
    for (const Json& one : value) most = std::max(most, 1 + height_of(one));
  }
  return most;
}

// Whether the node equals the value.
bool holds(const bbsim::yaml::Node& node, const Json& value) {
  using Kind = bbsim::yaml::Node::Kind;
  if (value.is_null()) return node.kind == Kind::null;
  if (value.is_object()) {
    if (node.kind != Kind::mapping || node.entries.size() != value.size()) return false;
    auto entry = node.entries.begin();
    for (const auto& [key, one] : value.items()) {
      if (entry->key != key || !holds(*entry->value, one)) return false;
      ++entry;
    }
    return true;
  }
  if (value.is_array()) {
    if (node.kind != Kind::sequence || node.items.size() != value.size()) return false;
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (!holds(*node.items[i], value[i])) return false;
    }
    return true;
  }
  if (value.is_string()) {
    return node.kind == Kind::scalar && node.quoted && node.text == value.get<std::string>();
  }
  return node.kind == Kind::scalar && !node.quoted && node.text == text_of(value);
}

// Python's text of a dict must be read as that dict.
void must_be_read_as(const std::string& text, const Json& dict) {
  using namespace bbsim::yaml;
  try {
    static_cast<void>(check_text(text, 0));
  } catch (const TextFault&) {
    return;  // control characters, which are refused by name
  }
  if (height_of(dict) > deepest || !has_short_keys(dict)) return;
  Nodes nodes;
  const Node* const read = parse_yaml(text, 0, nodes);
  must(read != nullptr && holds(*read, dict));
}

struct Setting {
  std::string key, value;
  bool is_number = false;
};

struct Input {
  std::string text;
  std::vector<Setting> settings;
  bool is_checked = false;
};

Input read_input(std::string_view bytes) {
  Input input;
  while (!bytes.empty()) {
    const std::string_view line = take_line(bytes);
    bool is_setting = line == "--check";
    input.is_checked = input.is_checked || is_setting;
    for (const std::string_view option : {"--set ", "--number "}) {
      if (!line.starts_with(option)) continue;
      const std::string_view setting = line.substr(option.size());
      const std::size_t equals = std::min(setting.find('='), setting.size());
      input.settings.push_back({std::string(setting.substr(0, equals)),
                                std::string(setting.substr(std::min(equals + 1, setting.size()))),
                                option == "--number "});
      is_setting = true;
    }
    if (!is_setting) input.text.append(line) += '\n';
  }
  return input;
}

void must_be_read(const Input& input) {
  bbsim::Scenario scenario = bbsim::Scenario::from_text(input.text, "fuzz.yaml");
  for (const Setting& setting : input.settings) {
    if (setting.is_number) {
      scenario.set(setting.key, std::strtod(setting.value.c_str(), nullptr));
    } else {
      scenario.set(setting.key, setting.value);
    }
  }
  if (input.is_checked) {
    // The target variation covers the sweep's cases, which may be many.
    const std::string said = scenario.set("sweep", "null").check();
    must(!said.empty() && is_unicode(said));
    return;
  }
  bbsim::RunOptions options;
  options.keep_rows = false;
  options.goes_on = [](double) { return false; };
  const bbsim::Result result = bbsim::run(bbsim::Scenario(scenario), options);
  must(!result.columns.empty() && result.units.size() == result.columns.size());
  must(result.status != bbsim::Status::failed || !result.reason.empty());
  must(is_unicode(result.reason) && Json::accept(result.summary));
}

}  // namespace

// Replaces src/controller/foreign_code.cpp entirely, because an input could run anything.
pid_t bbsim::controller::start_program(const bbsim::file::NewProcess& /*program*/, int& error) {
  error = EPERM;
  return 0;
}
void* bbsim::controller::open_library(const std::string& /*path*/, std::string& error) {
  error = "not while fuzzing";
  return nullptr;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view bytes = bbsim_fuzz::text_of(data, size);
  const bool is_dict = bytes.starts_with("dict\n");
  if (is_dict) take_line(bytes);
  Input input = read_input(bytes);
  if (is_dict) {
    const Json dict = Json::parse(input.text, nullptr, false);
    if (!dict.is_object()) return 0;
    input.text = text_of(dict);
    must_be_read_as(input.text, dict);
  }
  try {
    must_be_read(input);
  } catch (const bbsim::ScenarioError& error) {
    must(!error.faults().empty() && is_unicode(error.what()));
    for (const bbsim::Fault& fault : error.faults()) {
      must(!fault.message.empty());
      for (const std::string& text : {fault.place, fault.message, fault.key, fault.hint}) {
        must(is_unicode(text));
      }
    }
  } catch (const bbsim::Error& error) {
    must(*error.what() != '\0' && is_unicode(error.what()));
  }
  return 0;
}
