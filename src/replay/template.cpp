// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/template.hpp"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "base/json.hpp"
#include "file/descriptor.hpp"
#include "file/share_folders.hpp"

namespace bbsim::replay {
namespace {

constexpr std::string_view title_mark = "@BBSIM_TITLE@";
constexpr std::string_view data_mark = "@BBSIM_DATA@";
constexpr std::string_view engine_mark = "@BBSIM_ENGINE@";

using Replacements = std::vector<std::pair<std::string_view, std::string_view>>;

std::string replaced(std::string_view text, const Replacements& replacements) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto found = std::ranges::find_if(
        replacements, [text](const auto& pair) { return text.starts_with(pair.first); });
    const bool is_plain = found == replacements.end();
    result += is_plain ? text.substr(0, 1) : found->second;
    text.remove_prefix(is_plain ? 1 : found->first.size());
  }
  return result;
}

// JSON for a <script> element. These characters occur only in strings, where the escapes mean the
// same. Without them, nothing ends the script or one of its lines.
std::string script_text(const std::string& text) {
  return replaced(text, {{"<", "\\u003c"},
                         {">", "\\u003e"},
                         {"&", "\\u0026"},
                         {"\xE2\x80\xA8", "\\u2028"},
                         {"\xE2\x80\xA9", "\\u2029"}});
}

// Text for HTML. Replaces bytes that are not UTF-8 as the JSON does.
std::string html_text(const std::string& raw) {
  std::string text = parse_json(json_text(raw)).get<std::string>();
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  return replaced(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}});
}

std::size_t place_of(std::string_view mark, std::string_view text) {
  const std::size_t place = text.find(mark);
  if (place == std::string_view::npos || text.find(mark, place + 1) != std::string_view::npos) {
    throw InputError("the page's template is damaged: it has to have " + std::string(mark) +
                     " once; install all of bbsim");
  }
  return place;
}

}  // namespace

std::string filled(std::string_view page_template, const std::string& title,
                   const std::string& json) {
  const std::size_t title_place = place_of(title_mark, page_template);
  const std::size_t data = place_of(data_mark, page_template);
  if (data < title_place) {
    throw InputError("the page's template is damaged: its data are before its title");
  }
  std::string result{page_template};
  result.replace(data, data_mark.size(), script_text(json));
  return result.replace(title_place, title_mark.size(), html_text(title));
}

std::string with_engine(std::string page_template, std::string_view engine) {
  return page_template.replace(place_of(engine_mark, page_template), engine_mark.size(), engine);
}

std::string read_template(const std::string& name, const std::vector<std::string>& folders) {
  std::string looked_in;
  for (const std::string& folder : folders.empty() ? file::share_folders() : folders) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::error_code error;
    if (std::filesystem::exists(file, error)) return file::read_whole(file);
    looked_in.append(looked_in.empty() ? "" : " and ").append(folder);
  }
  if (name == engine_name) {
    throw OutputError("cannot make a live page: " + name + " is not in " + looked_in +
                      "; `scripts/setup --wasm && scripts/build wasm` makes it in bbsim's sources");
  }
  throw OutputError("cannot make a page: its template " + name + " is not in " + looked_in +
                    "; it is made where bbsim is built with three.js and dygraphs (Debian: "
                    "libjs-three, libjs-dygraphs; scripts/setup installs them): build bbsim again, "
                    "or set BBSIM_SHARE_PATH to the template's folder");
}

std::string file_of_template(const std::string& name) {
  for (const std::string& folder : file::share_folders()) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::error_code error;
    if (std::filesystem::exists(file, error)) return file.string();
  }
  return "";
}

}  // namespace bbsim::replay
