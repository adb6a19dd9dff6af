// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/serial_protocol.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/json.hpp"
#include "base/quoted.hpp"
#include "base/utf8.hpp"
#include "controller/protocol.hpp"

namespace bbsim::controller {
namespace {

using Json = nlohmann::ordered_json;

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

std::string with_serial(std::string_view sample_line, std::string_view bytes) {
  std::string text;  // UTF-8
  for (const char one : bytes) {
    const auto byte = static_cast<unsigned char>(one);
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
  const Json answer = parse_json(line);
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
    } else if (name == "serial" || name == "baud" || !value.is_number()) {
      const std::string meant = hint(name, known);
      return refuse("found " + bbsim::quoted(name) +
                    (meant.empty() ? " with a value that is not allowed" : meant) + "; " + form);
    } else if (const auto wanted = std::ranges::find(names, name); wanted != names.end()) {
      own[wanted - names.begin()] = value.get<double>();
    }
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::isfinite(own[i])) continue;
    return refuse("found no finite " + bbsim::quoted(names[i]) + ", which output.columns asks for");
  }
  return result;
}

}  // namespace bbsim::controller
