// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/template.hpp"

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/error.hpp"
#include "base/json.hpp"
#include "file/share_folders.hpp"
#include "file/whole_file.hpp"

namespace bbsim::replay {
namespace {

constexpr std::string_view title_mark = "@BBSIM_TITLE@";
constexpr std::string_view data_mark = "@BBSIM_DATA@";
constexpr std::string_view engine_mark = "@BBSIM_ENGINE@";

// JSON for a <script> element. These characters occur only in strings, where the escapes mean the
// same. Without them, nothing ends the script or one of its lines.
std::string script_text(const std::string& text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    switch (text[i]) {
      case '<':
        result += "\\u003c";
        break;
      case '>':
        result += "\\u003e";
        break;
      case '&':
        result += "\\u0026";
        break;
      case '\xE2':  // U+2028 and U+2029
        if (text.compare(i, 3, "\xE2\x80\xA8") == 0 || text.compare(i, 3, "\xE2\x80\xA9") == 0) {
          result += text[i + 2] == '\xA8' ? "\\u2028" : "\\u2029";
          i += 2;
          break;
        }
        [[fallthrough]];
      default:
        result += text[i];
    }
  }
  return result;
}

// Text for HTML. Replaces bytes that are not UTF-8 as the JSON does.
std::string html_text(const std::string& raw) {
  const std::string text = parse_json(json_text(raw)).get<std::string>();
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '&':
        result += "&amp;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20) result += c;
    }
  }
  return result;
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
  const std::size_t after_title = title_place + title_mark.size();
  std::string result{page_template.substr(0, title_place)};
  result += html_text(title);
  result += page_template.substr(after_title, data - after_title);
  result += script_text(json);
  result += page_template.substr(data + data_mark.size());
  return result;
}

std::string with_engine(std::string page_template, std::string_view engine) {
  return page_template.replace(place_of(engine_mark, page_template), engine_mark.size(), engine);
}

std::string read_template(const std::string& name, const std::vector<std::string>& folders,
                          const std::string& remedy) {
  std::string looked_in;
  for (const std::string& folder : folders) {
    try {
      return file::read_whole(std::filesystem::path(folder) / name);
    } catch (const InputError&) {  // try the next folder
    }
    looked_in.append(looked_in.empty() ? "" : " and ").append(folder);
  }
  if (!remedy.empty()) {
    throw OutputError("cannot make a live page: " + name + " is not in " + looked_in + "; " +
                      remedy);
  }
  throw OutputError("cannot make a page: its template " + name + " is not in " + looked_in +
                    "; it is made where bbsim is built with three.js and dygraphs (Debian: "
                    "libjs-three, libjs-dygraphs; scripts/setup installs them): build bbsim again, "
                    "or set BBSIM_SHARE_PATH to the template's folder");
}

std::string read_template(const std::string& name, const std::string& remedy) {
  return read_template(name, file::share_folders(), remedy);
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
