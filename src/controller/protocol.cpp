// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/protocol.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"
#include "base/text.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::controller {
namespace {

// Writes a number with a point or an exponent, so that no reader takes it for an integer, which
// would lose the sign of -0.
char* write_real(char* to, double value) {
  if (!std::isfinite(value)) return to + std::string_view("null").copy(to, 4);
  char* const end = write_number(to, value);
  const bool whole =
      std::all_of(to, end, [](char c) { return c == '-' || (c >= '0' && c <= '9'); });
  if (!whole) return end;
  end[0] = '.';
  end[1] = '0';
  return end + 2;
}

char* write_text(char* to, std::string_view text) {
  return to + text.copy(to, text.size());
}

// ,"name":[a,b]
char* write_list(char* to, std::string_view name, std::span<const double> numbers) {
  to = write_text(to, ",\"");
  to = write_text(to, name);
  to = write_text(to, "\":[");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) *to++ = ',';
    to = write_real(to, numbers[i]);
  }
  *to++ = ']';
  return to;
}

// What a number that is not finite becomes, since JSON has none.
constexpr const char* not_finite = "NaN";

// Programs print NaN and infinities in their own words, which JSON does not have.
Json parse_answer(std::string_view line) {
  Json answer = parse_json(line);
  if (!answer.is_discarded()) return answer;
  constexpr std::string_view words[] = {"-Infinity", "Infinity", "NaN", "-nan",
                                        "nan",       "-inf",     "inf"};
  std::string text;
  bool quoted = false;
  for (std::size_t at = 0; at < line.size();) {
    const std::string_view rest = line.substr(at);
    const auto* const word =
        std::ranges::find_if(words, [&](std::string_view word) { return rest.starts_with(word); });
    if (!quoted && word != std::end(words)) {
      (text += '"').append(not_finite) += '"';
      at += word->size();
      continue;
    }
    if (rest[0] == '"') quoted = !quoted;
    const std::size_t count = quoted && rest[0] == '\\' ? 2 : 1;
    text += rest.substr(0, count);
    at += count;
  }
  return parse_json(text);
}

bool is_real(const Json& value) {
  return value.is_number() || value == Json(not_finite);
}

double real_in(const Json& value) {
  return value.is_number() ? value.get<double>() : no_number;
}

std::string not_understood(std::string_view line, const std::string& why) {
  return "its answer was " + bbsim::quoted(line, longest_saying) + ": " + why;
}

// For an answer that lacks a name, a similar name in the answer: ", but "comand" (did you mean
// command?)". Empty if there is none.
std::string misspelt(std::string_view line, const std::string& lacks) {
  const Json answer = parse_json(line);
  if (!answer.is_object()) return "";
  const std::string_view wanted[] = {lacks};
  for (const auto& [name, value] : answer.items()) {
    const std::string meant = name == "command" ? "" : yaml::hint(name, wanted);
    if (!meant.empty()) return ", but " + bbsim::quoted(name) + meant;
  }
  return "";
}

std::string form_of(std::size_t commands) {
  return std::string("allowed: {\"command\": [") + (commands == 2 ? "PHI, THETA" : "S1, S2, S3") +
         "]}, optionally with \"NAME\": NUMBER";
}

// The text of an answer {"error": "..."}; empty for any other answer.
std::optional<std::string> error_of(std::string_view line) {
  const Json answer = parse_json(line);
  if (!answer.is_object()) return {};
  const auto error = answer.find("error");
  if (error == answer.end() || !error->is_string()) return {};
  return error->get<std::string>();
}

// The bytes of a text whose characters are U+0000 to U+00FF; false: it has others.
bool bytes_of(std::string_view text, std::string& bytes) {
  while (!text.empty()) {
    const Utf8Character next = first_character(text);
    if (next.length == 0 || next.code > 0xFF) return false;
    bytes += static_cast<char>(next.code);
    text.remove_prefix(next.length);
  }
  return true;
}

}  // namespace

std::string refusal(std::string_view line, const std::string& why) {
  if (const auto error = error_of(line))
    return "it gave up: " + bbsim::quoted(*error, longest_saying);
  return not_understood(line, advice_on_text(line) + why);
}

std::string advice_on_text(std::string_view line) {
  if (trimmed(line).starts_with('{')) return "";
  return "standard output is only for answers, print all else to standard error; ";
}

std::string hello_line(const Setup& setup) {
  Json hello = Json::object();
  hello["protocol"] = protocol_version;
  hello["bbsim"] = BBSIM_VERSION;
  hello["period"] = setup.period;
  hello["delay"] = setup.delay;
  hello["resolution"] = setup.resolution;
  hello["derivative_filter"] = setup.derivative_filter;
  hello["drives"] = name_of(setup.drives);
  hello["limit"] = std::isfinite(setup.limit) ? Json(setup.limit) : Json(nullptr);
  hello["end"] = setup.end;
  hello["parameters"] = Json::object();
  for (const Parameter& parameter : setup.parameters) {
    hello["parameters"][parameter.name] = parameter.value;
  }
  hello["columns"] = setup.columns;
  hello["fields"] = Json::object();
  hello["fields"]["sample"] = "1";
  for (const Field& field : fields) hello["fields"][std::string(field.name)] = field.unit;
  if (setup.serial) {
    hello["serial"] = true;
  } else {
    hello["command"] = command_unit(setup.drives);
  }
  return json_text(hello) + '\n';
}

Ready read_ready(std::string_view line) {
  Ready ready;
  const auto refuse = [&](const std::string& why) {
    ready.fault = refusal(line, why);
    return ready;
  };
  const std::string wanted = "allowed: {\"protocol\": " + std::to_string(protocol_version) +
                             "}, optionally with \"reset\": " +
                             "true, \"columns\": {\"NAME\": \"UNIT\"}, \"fields\": "
                             "[\"NAME\"]";
  const Json answer = parse_json(line);
  if (!answer.is_object()) return refuse(wanted);
  if (!answer.contains("protocol")) {
    return refuse("found no protocol" + misspelt(line, "protocol") + "; " + wanted);
  }
  for (const auto& [key, value] : answer.items()) {
    if (key == "protocol") {
      if (value != Json(protocol_version)) {
        return refuse("found a protocol of another version; allowed: " +
                      std::to_string(protocol_version));
      }
    } else if (key == "reset" || key == "save") {  // save: of programs for bbsim 0.3, ignored
      if (!value.is_boolean()) {
        return refuse("found a " + key + " that is neither true nor false");
      }
      if (key == "reset") ready.reset = value.get<bool>();
    } else if (key == "fields") {
      ready.fields.reset();
      for (const Json& name : value) {
        const auto field = std::ranges::find_if(
            fields, [&](const Field& field) { return name == Json(std::string(field.name)); });
        if (field != fields.end()) {
          ready.fields.set(static_cast<std::size_t>(field - fields.begin()));
        } else if (name != Json("sample")) {
          std::vector<std::string_view> known{"sample"};
          for (const Field& field : fields) known.push_back(field.name);
          const bool is_text = name.is_string();
          const std::string meant = is_text ? yaml::hint(name.get<std::string>(), known) : "";
          return refuse(
              "found a field " +
              (is_text ? bbsim::quoted(name.get<std::string>()) : "that is not a string") + meant +
              "; allowed: those of the hello");
        }
      }
    } else if (key == "columns") {
      if (!value.is_object()) return refuse("found columns that are not an object; " + wanted);
      ready.columns.emplace();
      for (const auto& [name, unit] : value.items()) {
        if (!unit.is_string()) return refuse("found a unit that is not a string; " + wanted);
        ready.columns->emplace_back(name, unit.get<std::string>());
      }
    } else {
      constexpr std::string_view known[] = {"protocol", "reset", "columns", "fields"};
      return refuse("found " + bbsim::quoted(key) + yaml::hint(key, known) + "; " + wanted);
    }
  }
  return ready;
}

std::size_t write_sample(const model::ControllerSample& sample, Fields wanted,
                         char (&line)[longest_sample]) {
  char* to = write_text(line, "{\"sample\":");
  to = std::to_chars(to, to + longest_number, sample.number).ptr;
  std::size_t next = 0;  // index in `fields`
  const auto list = [&](std::span<const double> numbers) {
    if (wanted[next]) to = write_list(to, fields[next].name, numbers);
    ++next;
  };
  const auto pair = [&](double a, double b) { list(Pair{a, b}); };
  if (wanted[next++]) {
    to = write_text(to, ",\"t\":");
    to = write_real(to, sample.t);
  }
  if (sample.seen) {
    pair((*sample.seen)[0], (*sample.seen)[1]);
  } else if (wanted[next++]) {
    to = write_text(to, ",\"ball\":null");
  }
  const auto& [x, y] = sample.reference;
  pair(x.value, y.value);
  pair(x.rate, y.rate);
  pair(x.acceleration, y.acceleration);
  list(sample.servo);
  list(sample.servo_rate);
  to = write_text(to, "}\n");
  return static_cast<std::size_t>(to - line);
}

std::string read_answer(std::string_view line, std::span<const std::string> names,
                        std::span<double> command, double* own, bool first) {
  // Says what is wrong, and then what is allowed.
  const auto refuse_form = [&](const std::string& why) {
    return refusal(line, why + form_of(command.size()));
  };
  const auto refuse = [line](const std::string& why) { return refusal(line, why); };
  const Json answer = parse_answer(line);
  if (!answer.is_object()) return refuse_form("");
  std::fill_n(own, names.size(), no_number);
  bool commanded = false;
  for (const auto& [name, value] : answer.items()) {
    if (name == "command") {
      if (!value.is_array() || value.size() != command.size() ||
          !std::ranges::all_of(value, is_real)) {
        return refuse_form(std::string("found a command that is not ") +
                           (command.size() == 2 ? "two" : "three") + " numbers; ");
      }
      std::ranges::transform(value, command.begin(), real_in);
      commanded = true;
    } else if (is_real(value)) {
      const auto wanted = std::ranges::find(names, name);
      if (wanted == names.end()) continue;
      own[wanted - names.begin()] = real_in(value);
      if (std::isfinite(real_in(value))) continue;
      return refuse("found " + bbsim::quoted(name) + " that is not a finite number");
    } else {
      std::vector<std::string_view> known{"command", "error"};
      known.insert(known.end(), names.begin(), names.end());
      const std::string meant = yaml::hint(name, known);
      const char* const kind = name == "error" ? " that is not a string" : " that is not a number";
      return refuse_form("found " + bbsim::quoted(name) + (meant.empty() ? kind : meant) + "; ");
    }
  }
  if (!commanded) return refuse_form("found no command" + misspelt(line, "command") + "; ");
  if (!std::ranges::all_of(command, [](double value) { return std::isfinite(value); })) {
    return refuse("found a command that is not a finite number");
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::isnan(own[i])) {
      const std::string why = "found no " + bbsim::quoted(names[i]) +
                              ", which output.columns asks for" + misspelt(line, names[i]);
      if (first) throw KeyError("output.columns", refusal(line, why));
      return refuse(why);
    }
  }
  return {};
}

std::string with_serial(std::string_view sample_line, std::string_view bytes) {
  std::string text;  // UTF-8
  for (const char character : bytes) {
    const auto byte = static_cast<unsigned char>(character);
    if (byte >= 0x80) text += static_cast<char>(0xC0 | (byte >> 6));
    text += static_cast<char>(byte < 0x80 ? byte : 0x80 | (byte & 0x3F));
  }
  std::string line(sample_line.substr(0, sample_line.rfind('}')));
  return line + ",\"serial\":" + json_text(Json(text)) + "}\n";
}

SerialAnswer read_serial_answer(std::string_view line, std::span<const std::string> names,
                                double* own) {
  SerialAnswer result;
  const auto refuse = [&](const std::string& why) {
    result.fault = refusal(line, why);
    return result;
  };
  const std::string form =
      "allowed: {\"serial\": \"BYTES\"}, optionally with \"baud\": NUMBER, \"NAME\": NUMBER";
  const Json answer = parse_answer(line);
  if (!answer.is_object()) return refuse(form);
  std::vector<std::string_view> known{"serial", "baud", "error"};
  known.insert(known.end(), names.begin(), names.end());
  for (const auto& [name, value] : answer.items()) {
    if (name == "serial" && value.is_string()) {
      const auto& text = value.get_ref<const std::string&>();
      if (!bytes_of(text, result.bytes)) {
        return refuse("found a character beyond U+00FF in \"serial\", which is no byte; " + form);
      }
    } else if (name == "baud" && value.is_number() && value.get<double>() > 0) {
      result.baud = value.get<double>();
    } else if (name == "serial" || name == "baud" || !is_real(value)) {
      const std::string meant = yaml::hint(name, known);
      return refuse("found " + bbsim::quoted(name) +
                    (meant.empty() ? " with a value that is not allowed" : meant) + "; " + form);
    } else if (const auto wanted = std::ranges::find(names, name); wanted != names.end()) {
      own[wanted - names.begin()] = real_in(value);
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::isfinite(own[i])) continue;
    return refuse("found no finite " + bbsim::quoted(names[i]) + ", which output.columns asks for");
  }
  return result;
}

}  // namespace bbsim::controller
