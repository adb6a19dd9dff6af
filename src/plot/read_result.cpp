// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/read_result.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <string_view>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "file/format.hpp"
#include "file/hdf5_table.hpp"
#include "file/whole_file.hpp"
#include "scenario/columns.hpp"
#include "scenario/reader.hpp"
#include "scenario/variation.hpp"

namespace bbsim::plot {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool is_hdf5(const std::string& file) {
  return file::format_of(file) == file::Format::hdf5;
}

double to_number(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// The scenario's text has a place of its own.
std::string summary_text(Json json) {
  json.erase("scenario_text");
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// The attributes of an HDF5 file as the summary that they are; of lists, a line an entry.
std::string summary_of(const file::Attributes& attributes) {
  constexpr std::array statistics = {"steps", "rhs_evaluations", "jacobian_evaluations",
                                     "nonlinear_iterations", "error_test_failures"};
  Json json = Json::object();
  for (const auto& [name, value] : attributes) {
    Json& place = std::ranges::find(statistics, name) == statistics.end()
                      ? json[name]
                      : json["statistics"][name];
    std::visit([&place](const auto& held) { place = held; }, value.value());
  }
  return summary_text(std::move(json));
}

// "t=0.54 event=edge action=stop x=0.16 y=-0.02 ...", as record/summary.hpp writes it.
Event event_of(const std::string& line) {
  std::map<std::string, std::string> members;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) members[word.substr(0, equals)] = word.substr(equals + 1);
  }
  Event event{members["event"], members["action"] == "stop", to_number(members["t"]),
              to_number(members["x"]), to_number(members["y"])};
  for (const auto& [name, value] : members) {
    if (scenario::find_column(name) != nullptr) event.state[name] = to_number(value);
  }
  return event;
}

// Where the scenario's text stands for a file that may have changed since, or be gone with its
// tables: what can be read of it is enough for a picture.
void take_scenario(Result& result, const std::string& text, const std::string& name,
                   const std::vector<std::string>& overrides) {
  if (text.empty()) return;
  result.scenario = parse_sound_parts(text, name, overrides);
}

void take_attributes(Result& result, const file::Attributes& attributes) {
  std::map<std::string, std::string> by_name;
  for (const auto& [name, value] : attributes) by_name[name] = value.text();
  result.title = by_name["title"];
  result.status = by_name["status"];
  result.reason = by_name["reason"];
  result.version = by_name["version"];
  result.summary = summary_of(attributes);
  if (by_name.contains("end_time")) result.end_time = to_number(by_name["end_time"]);
  for (const std::string& line : lines_of(by_name["events"])) {
    result.events.push_back(event_of(line));
  }
  take_scenario(result, by_name["scenario_text"], by_name["scenario"],
                lines_of(by_name["overrides"]));
  result.tells_drawn = by_name.contains("vary");
  for (const std::string& line : lines_of(by_name["vary"])) {
    const Variation variation = scenario::split_variation(line);
    if (scenario::parse_variation(variation).random()) result.drawn_keys.push_back(variation.key);
  }
}

Result read_hdf5_result(const std::string& file) {
  const file::Hdf5TableReader reader(file);
  file::Hdf5Block block;
  reader.read(0, reader.rows(), block);
  Result result;
  result.file = file;
  result.rows = reader.rows();
  for (std::size_t c = 0; c < reader.columns().size(); ++c) {
    const file::Hdf5Column& from = reader.columns()[c];
    if (from.kind == file::Hdf5Kind::series) continue;  // trajectories of a sweep
    Column column{from.name, std::move(block.values[c])};
    column.unit = from.unit;
    if (from.kind == file::Hdf5Kind::text) {
      column.texts = std::move(block.texts[c]);
      column.numbers.assign(result.rows, NAN);
    }
    result.columns.push_back(std::move(column));
  }
  if (result.rows == 0) throw InputError(file + ": has no rows");
  take_attributes(result, reader.attributes());
  return result;
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

constexpr std::size_t most_of_a_summary = std::size_t{1} << 28U;  // bytes: a million events

bool is_summary(const Json& json) {
  return json.is_object() && json.contains("status") && json.contains("events") &&
         json["events"].is_array() && json.contains("output");
}

void take_summary(Result& result, const Json& json) {
  result.units_known = true;
  result.title = member<std::string>(json, "title", "");
  result.status = member<std::string>(json, "status", "");
  result.reason = member<std::string>(json, "reason", "");
  result.version = member<std::string>(json, "version", "");
  result.summary = summary_text(json);
  if (json.contains("end_time")) result.end_time = member(json, "end_time", 0.0);
  for (const Json& event : json["events"]) {
    if (!event.is_object()) continue;
    result.events.push_back({member<std::string>(event, "event", ""),
                             member<std::string>(event, "action", "") == "stop",
                             member(event, "t", 0.0), member(event, "x", 0.0),
                             member(event, "y", 0.0)});
    for (const auto& [name, value] : event.items()) {
      const bool column = value.is_number() && scenario::find_column(name) != nullptr;
      if (column) result.events.back().state[name] = value.get<double>();
    }
  }
  std::vector<std::string> overrides;
  if (json.contains("overrides") && json["overrides"].is_array()) {
    for (const Json& text : json["overrides"]) {
      if (text.is_string()) overrides.push_back(text.get<std::string>());
    }
  }
  take_scenario(result, member<std::string>(json, "scenario_text", ""),
                member<std::string>(json, "scenario", ""), overrides);
}

void read_summary(Result& result, const std::string& file) {
  const Json json = parse_json(file::read_whole(file, {}, most_of_a_summary));
  if (!is_summary(json)) {
    throw InputError(file +
                     ": is no summary; allowed: what `bbsim run --summary FILE.json` writes");
  }
  const std::size_t rows = member(json, "rows", std::size_t{0});
  if (rows != result.rows) {
    throw InputError(file + ": is the summary of another run: it has " + std::to_string(rows) +
                     " rows, " + result.file + " has " + std::to_string(result.rows));
  }
  take_summary(result, json);
}

// Whether one file was written that long after the other, which copies made in one go are not.
bool is_newer(const fs::path& one, const fs::path& other) {
  std::error_code error;
  const fs::file_time_type first = fs::last_write_time(other, error);
  if (error) return false;
  const fs::file_time_type second = fs::last_write_time(one, error);
  return !error && second - first > std::chrono::seconds(2);
}

// NAME.json beside NAME.csv, if it tells of that very file. A run writes it last.
void find_summary(Result& result) {
  const fs::path csv(result.file), summary(summary_beside(result.file));
  if (summary.empty()) return;
  result.beside = summary;
  Json json;
  try {
    json = parse_json(file::read_whole(summary, {}, most_of_a_summary));
  } catch (const InputError&) {  // nobody asked for it
    return;
  }
  if (!is_summary(json)) return;
  if (fs::path(member<std::string>(json, "output", "")).filename() != csv.filename()) return;
  const bool as_long = member(json, "rows", std::size_t{0}) == result.rows;
  if (as_long && !is_newer(csv, summary)) return take_summary(result, json);
  result.left_out = summary.string() + ": left out, since it " +
                    (as_long ? "is older than " : "has another number of rows than ") +
                    result.file + " and so is of another run" +
                    (as_long ? "; --summary " + summary.string() + " takes it all the same" : "");
}

}  // namespace

std::string summary_beside(const std::string& file) {
  fs::path summary(file);
  summary.replace_extension(".json");
  std::error_code ignored;
  if (file == "-" || is_hdf5(file) || !fs::is_regular_file(summary, ignored)) return "";
  return summary;
}

Result read_result(const std::string& file, const Beside& beside, const LogChoice& log,
                   std::vector<std::string>* notes) {
  if (const std::string ending = file::lower_ending(file); ending == ".yaml" || ending == ".yml") {
    throw InputError(file + ": is a scenario; draw its result: bbsim run " + file +
                     " -o run.h5 && bbsim plot run.h5");
  }
  std::vector<std::string> ignored;
  std::vector<std::string>& told = notes == nullptr ? ignored : *notes;
  Result result = is_hdf5(file) ? read_hdf5_result(file) : read_csv_columns(file, log.header, told);
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
    make_log(result, log, false, told);
  }
  if (result.scenario && (result.title.empty() || !beside.scenario.empty())) {
    result.title = result.scenario->title;
  }
  return result;
}

}  // namespace bbsim::plot
