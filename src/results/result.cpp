// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "results/result.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <variant>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"
#include "base/text.hpp"
#include "file/descriptor.hpp"
#include "file/line_reader.hpp"
#include "file/table_writer.hpp"
#include "scenario/columns.hpp"
#include "scenario/reader.hpp"
#include "scenario/variation.hpp"

namespace bbsim::results {
namespace {

namespace fs = std::filesystem;

bool is_hdf5(const std::string& file) {
  return file::format_of(file) == file::Format::hdf5;
}

template <class T>
T member(const Json& json, const char* name, T otherwise) {
  const auto found = json.find(name);
  if (found == json.end()) return otherwise;
  if constexpr (std::is_arithmetic_v<T>) {
    return found->is_number() ? found->get<T>() : otherwise;
  } else {
    return found->is_string() ? found->get<T>() : otherwise;
  }
}

std::string text_in(const Json& json, const char* name) {
  return member<std::string>(json, name, "");
}

// The summary in the attributes of an HDF5 file. Lists have one line per entry.
Json summary_of(const file::Attributes& attributes) {
  constexpr std::array statistics = {"steps", "rhs_evaluations", "jacobian_evaluations",
                                     "nonlinear_iterations", "error_test_failures"};
  Json json = Json::object();
  for (const auto& [name, value] : attributes) {
    Json& place = std::ranges::find(statistics, name) == statistics.end()
                      ? json[name]
                      : json["statistics"][name];
    std::visit([&place](const auto& held) { place = held; }, value.value());
  }
  return json;
}

// A list of texts; in an HDF5 file, the lines of one text.
std::vector<std::string> list_in(const Json& json, const char* name) {
  std::vector<std::string> list = lines_of(text_in(json, name));
  if (!json.contains(name) || !json[name].is_array()) return list;
  for (const Json& text : json[name]) {
    if (text.is_string()) list.push_back(text.get<std::string>());
  }
  return list;
}

// "t=0.54 event=edge action=stop x=0.16 y=-0.02 ...", as record/summary.hpp writes it.
Json members_of(const std::string& line) {
  Json members = Json::object();
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) continue;
    const std::string name = word.substr(0, equals), text = word.substr(equals + 1);
    const auto value = number_in<double>(text);
    members[name] = value ? Json(*value) : Json(text);
  }
  return members;
}

std::vector<Event> events_in(const Json& json) {
  std::vector<Json> all;
  for (const std::string& line : lines_of(text_in(json, "events"))) all.push_back(members_of(line));
  if (json.contains("events") && json["events"].is_array()) {
    std::ranges::copy_if(json["events"], std::back_inserter(all), &Json::is_object);
  }
  std::vector<Event> events;
  for (const Json& event : all) {
    events.push_back({text_in(event, "event"), text_in(event, "action") == "stop",
                      member(event, "t", 0.0), member(event, "x", 0.0), member(event, "y", 0.0)});
    for (const auto& [name, value] : event.items()) {
      const bool column = value.is_number() && scenario::find_column(name) != nullptr;
      if (column) events.back().state[name] = value.get<double>();
    }
  }
  return events;
}

constexpr std::size_t most_of_a_summary = std::size_t{1} << 28U;  // bytes: a million events

bool is_summary(const Json& json) {
  return json.is_object() && json.contains("status") && json.contains("events") &&
         json["events"].is_array() && json.contains("output");
}

void take_summary(Result& result, const Json& json) {
  result.units_known = true;
  result.title = text_in(json, "title");
  result.status = text_in(json, "status");
  result.reason = text_in(json, "reason");
  result.version = text_in(json, "version");
  if (json.contains("end_time")) result.end_time = member(json, "end_time", 0.0);
  result.events = events_in(json);
  result.drawn_keys_known = json.contains("vary");
  for (const std::string& line : list_in(json, "vary")) {
    const Variation variation = scenario::split_variation(line);
    if (scenario::parse_variation(variation).random()) result.drawn_keys.push_back(variation.key);
  }
  // The scenario's file may have changed or vanished, with its tables. The readable parts of its
  // text suffice for a picture.
  if (const std::string text = text_in(json, "scenario_text"); !text.empty()) {
    result.scenario =
        parse_sound_parts(text, text_in(json, "scenario"), list_in(json, "overrides"));
  }
  Json shown = json;
  shown.erase("scenario_text");  // used above
  result.summary = json_text(shown);
}

void read_summary(Result& result, const std::string& file) {
  const Json json = parse_json(file::read_whole(file, {}, most_of_a_summary));
  if (!is_summary(json)) {
    throw InputError(file +
                     ": is not a summary; allowed: what `bbsim run --summary FILE.json` writes");
  }
  const std::size_t rows = member(json, "rows", std::size_t{0});
  if (rows != result.rows) {
    throw InputError(file + ": is the summary of another run: it has " + std::to_string(rows) +
                     " rows, " + result.file + " has " + std::to_string(result.rows));
  }
  take_summary(result, json);
}

// Whether a file is clearly newer than another. Copies made together differ by less.
bool is_newer(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const fs::file_time_type time_b = fs::last_write_time(b, error);
  if (error) return false;
  const fs::file_time_type time_a = fs::last_write_time(a, error);
  return !error && time_a - time_b > std::chrono::seconds(2);
}

// Takes NAME.json beside NAME.csv, if it describes that file. A run writes it last.
void find_summary(Result& result) {
  const fs::path csv(result.file), summary(summary_beside(result.file));
  if (summary.empty()) return;
  result.beside = summary;
  Json json;
  try {
    json = parse_json(file::read_whole(summary, {}, most_of_a_summary));
  } catch (const InputError&) {  // it was not requested
    return;
  }
  if (!is_summary(json)) return;
  if (fs::path(text_in(json, "output")).filename() != csv.filename()) return;
  const bool as_long = member(json, "rows", std::size_t{0}) == result.rows;
  if (as_long && !is_newer(csv, summary)) return take_summary(result, json);
  result.left_out = summary.string() + ": left out, since it " +
                    (as_long ? "is older than " : "has another number of rows than ") +
                    result.file + " and so is from another run" +
                    (as_long ? "; --summary " + summary.string() + " uses it anyway" : "");
}

bool has_digits_of_doubles(const Result& table) {
  constexpr std::size_t fewest = 15;  // characters of a number
  return std::ranges::any_of(table.columns, [](const Column& column) {
    return std::ranges::any_of(column.numbers, [](double number) {
      char text[longest_number];
      return static_cast<std::size_t>(write_number(text, number) - text) >= fewest;
    });
  });
}

// Whether bbsim seems to have written a table: all columns are in `bbsim columns`, some have names
// that only bbsim uses, and numbers have the digits of doubles, unlike a rig's log.
bool looks_like_a_run(const Result& table) {
  constexpr std::array<std::string_view, 12> anybodys = {
      "t", "x", "y", "vx", "vy", "phi", "theta", "spin", "tilt", "distance", "power", "energy"};
  if (table.find("t") == nullptr) return false;
  bool own_name = false;
  for (const Column& column : table.columns) {
    if (scenario::find_column(column.name) == nullptr) return false;
    own_name = own_name || std::ranges::find(anybodys, column.name) == anybodys.end();
  }
  return own_name && has_digits_of_doubles(table);
}

// Fields that blanks separate, or names and numbers that equal signs join, are texts.
void require_numbers(const Result& result) {
  const auto is_number = [](double number) { return !std::isnan(number); };
  const auto text = std::ranges::find_if(result.columns, &Column::is_text);
  if (text == result.columns.end()) return;
  for (const Column& column : result.columns) {
    if (std::ranges::any_of(column.numbers, is_number)) return;
  }
  const auto first = std::ranges::find_if_not(text->texts, &std::string::empty);
  throw InputError(file::name_in_messages(result.file) + ": found no numbers, but texts such as " +
                   quoted(*first, file::longest_name) +
                   "; allowed: numbers below a header, with commas, semicolons or tabs between "
                   "them, or pairs such as x:0.01 t:120");
}

}  // namespace

std::string summary_beside(const std::string& file) {
  fs::path summary(file);
  summary.replace_extension(".json");
  std::error_code ignored;
  if (file == "-" || is_hdf5(file) || !fs::is_regular_file(summary, ignored)) return "";
  return summary;
}

Result result_of(std::vector<Column> columns, const std::string& summary) {
  Result result;
  static_cast<file::Table&>(result) = file::Table(std::move(columns));
  if (!summary.empty()) take_summary(result, parse_json(summary));
  return result;
}

Result read_columns(const std::string& file, const std::vector<std::string>& header) {
  Result result;
  static_cast<file::Table&>(result) = file::read_table(file, {{}, header});
  if (result.rows == 0) {
    const bool left_out = !result.notes.empty();
    throw InputError(file::name_in_messages(file) + ": has a header and no rows" +
                     (left_out ? "; commas, semicolons or tabs separate the fields of a row" : ""));
  }
  require_numbers(result);
  // Trajectories of a sweep are not columns.
  std::erase_if(result.columns,
                [&](const Column& column) { return column.numbers.size() != result.rows; });
  result.units_known = is_hdf5(file) || result.is_sweep() || looks_like_a_run(result);
  return result;
}

Result read_result(const std::string& file, const Beside& beside, const LogChoice& log) {
  Result result = read_columns(file, log.header);
  if (is_hdf5(file)) take_summary(result, summary_of(result.attributes));
  if (!beside.summary.empty()) {
    read_summary(result, beside.summary);
  } else if (!result.is_sweep()) {
    find_summary(result);
  }
  if (!beside.scenario.empty()) {
    result.scenario = read_scenario(beside.scenario, beside.overrides);
    result.units_known = true;
  }
  if (log.given() || (!result.units_known && result.version.empty())) {
    make_log(result, log, false);
  }
  if (result.scenario && (result.title.empty() || !beside.scenario.empty())) {
    result.title = result.scenario->title;
  }
  return result;
}

std::string Result::shown_file() const {
  return file == "-" ? "standard input" : std::filesystem::path(file).filename().string();
}

bool Result::is_sweep() const {
  return !columns.empty() && columns.front().name == "case" && find("status") != nullptr;
}

void add_end_row(Result& result) {
  if (result.status != "stopped" || result.events.empty() || result.rows == 0) return;
  const Event& end = result.events.back();
  const Column* const t = result.find("t");
  if (!end.stopped || t == nullptr || t->is_text() || !(end.t > t->numbers.back())) return;
  std::map<std::string, double> state = end.state;
  state.insert_or_assign("t", end.t);
  state.insert_or_assign("x", end.x);
  state.insert_or_assign("y", end.y);
  state.insert_or_assign("distance", std::hypot(end.x, end.y));
  for (Column& column : result.columns) {
    const auto known = state.find(column.name);
    column.numbers.push_back(known == state.end() ? no_number : known->second);
    if (!column.texts.empty()) column.texts.emplace_back();
  }
  ++result.rows;
  result.has_end_row = true;
}

}  // namespace bbsim::results
