// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the cases of tests/app/transcripts; README.md there has their statements.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/number_text.hpp"
#include "catch.hpp"
#include "file/hdf5_table.hpp"
#include "shell.hpp"

namespace bbsim_test {

using nlohmann::json;
namespace file = bbsim::file;

namespace {

using Names = std::vector<std::string>;
using Constants = std::map<std::string, std::string>;

struct Statement {
  std::string head;  // its first line
  Names more;        // its indented lines, without two blanks
};

void replace_all(std::string& text, const std::string& part, const std::string& by) {
  for (std::size_t at = text.find(part); at != std::string::npos;
       at = text.find(part, at + by.size())) {
    text.replace(at, part.size(), by);
  }
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

// The statements before the first case, which belong to all cases, and those of one case.
std::vector<Statement> statements_of(const std::string& text, const std::string& title) {
  std::vector<Statement> found;
  bool taken = true;
  for (const std::string& line : lines(text)) {
    if (line.starts_with("== ")) {
      taken = line.substr(3) == title;
    } else if (taken && line.starts_with("  ")) {
      found.back().more.push_back(line.substr(2));
    } else if (taken && !line.empty() && line.front() != '#') {
      found.push_back({line, {}});
    }
  }
  return found;
}

// Attributes, columns and the inputs' columns of an HDF5 file.
json hdf5_of(const std::string& path) {
  file::Hdf5TableReader file(path);
  json made;
  for (const auto& [name, value] : file.head().attributes) {
    std::visit([&, &key = name](const auto& its) { made["attributes"][key] = its; }, value.value());
  }
  file::Hdf5Block block;
  (void)file.read(block);
  for (std::size_t i = 0; i < file.columns().size(); ++i) {
    const file::Hdf5Column& column = file.columns()[i];
    made["columns"][column.name] = {{"unit", column.unit}};
    if (column.kind == file::Hdf5Kind::number) {
      made["columns"][column.name]["greatest"] = *std::ranges::max_element(block.values[i]);
    }
  }
  made["inputs"] = json::array();
  for (const auto& [name, data] : file.read_inputs()) made["inputs"].push_back(data->names());
  return made;
}

// Writes the scenario and the tables that an HDF5 file contains.
void unpack(const Folder& folder, const std::string& from, const std::string& scenario) {
  file::Hdf5TableReader file(folder / from);
  for (const auto& [name, value] : file.head().attributes) {
    if (name == "scenario_text") folder.write(scenario, value.text());
  }
  for (const auto& [name, data] : file.read_inputs()) {
    std::string text;
    for (const std::string& column : data->names()) text += (text.empty() ? "" : ",") + column;
    for (std::size_t row = 0; row < data->columns[0].numbers.size(); ++row) {
      for (std::size_t c = 0; c < data->columns.size(); ++c) {
        text += (c == 0 ? '\n' : ',') + bbsim::number_text(data->columns[c].numbers[row]);
      }
    }
    folder.write(std::filesystem::path(scenario).parent_path() / name, text + '\n');
  }
}

// A CSV as an array of rows, an HDF5 file, or the JSON of any other file.
json table_of(const Folder& folder, const std::string& file) {
  if (file.ends_with(".h5")) return hdf5_of(file.front() == '/' ? file : folder / file);
  if (!file.ends_with(".csv")) return summary_of(folder, file);
  json table = json::array();
  const auto cells = rows(folder.read(file));
  for (std::size_t row = 1; row < cells.size(); ++row) {
    json& made = table.emplace_back(json::object());
    for (std::size_t i = 0; i < cells[row].size(); ++i) {
      const json number = json::parse(cells[row][i], nullptr, false);
      made[cells[0].at(i)] = number.is_number() ? number : json(cells[row][i]);
    }
  }
  return table;
}

json value_of(const Folder& folder, const std::string& file, std::string pointer) {
  const json table = table_of(folder, file);
  const std::size_t last = pointer.find("/last");
  if (last != std::string::npos) {
    const std::size_t size = table.at(json::json_pointer(pointer.substr(0, last))).size();
    pointer.replace(last, 5, '/' + std::to_string(size - 1));
  }
  return table.at(json::json_pointer(pointer));
}

class Player {
 public:
  explicit Player(Constants constants) : constants_(std::move(constants)) {
    constants_["FOLDER"] = folder_.name();
  }

  // Plays the statements; those after an "each" once for each of its values, in their own folder.
  void play(const std::vector<Statement>& statements, std::size_t first = 0) {
    for (std::size_t i = first; i < statements.size(); ++i) {
      const std::string word = statements[i].head.substr(0, statements[i].head.find(' '));
      if (word == "each" || word == "let") {
        const auto [name, value] = definition(statements[i]);
        if (word == "let") {
          constants_[name] = value;
          continue;
        }
        for (const std::string& one : split(value, '|')) {
          Player next(constants_);
          std::string values = ' ' + one + " ;";
          for (const std::string& column : split(name, ',')) {
            const std::size_t end = values.find(" ;");
            next.constants_[trimmed(column)] = trimmed(values.substr(0, end));
            values.erase(0, end + 2);
          }
          next.play(set_up(statements, i), 0);
        }
        return;
      }
      Statement statement = statements[i];
      fill(statement.head);
      for (std::string& line : statement.more) fill(line);
      INFO(statement.head);
      take(word, statement);
    }
  }

 private:
  void fill(std::string& text) const {
    for (const auto& [name, value] : constants_) replace_all(text, '{' + name + '}', value);
  }

  // The statements that a value of "each" needs: all but itself and the constants before it.
  static std::vector<Statement> set_up(const std::vector<Statement>& statements, std::size_t each) {
    std::vector<Statement> needed;
    for (std::size_t i = 0; i < statements.size(); ++i) {
      const bool defined = i <= each && (statements[i].head.starts_with("each ") ||
                                         statements[i].head.starts_with("let "));
      if (!defined) needed.push_back(statements[i]);
    }
    return needed;
  }

  [[nodiscard]] std::pair<std::string, std::string> definition(const Statement& statement) const {
    std::string text = statement.head.substr(statement.head.find(' ') + 1);
    for (const std::string& line : statement.more) text += ' ' + trimmed(line);
    fill(text);
    const std::size_t equal = text.find(" = ");
    return {text.substr(0, equal), text.substr(equal + 3)};
  }

  void take(const std::string& word, const Statement& statement) {
    const Names words = words_of(statement.head);
    if (word == "file") {
      std::string text;
      for (const std::string& line : statement.more) text += line + '\n';
      written_[words.at(1)] = text;
      folder_.write(words.at(1), text);
    } else if (word == "files") {
      CHECK(folder_.files() == Names(words.begin() + 1, words.end()));
    } else if (word == "unchanged") {
      for (std::size_t i = 1; i < words.size(); ++i) {
        CHECK(folder_.read(words[i]) == written_.at(words[i]));
      }
    } else if (word == "same" || word == "differ") {
      const bool same = folder_.read(words.at(1)) == folder_.read(words.at(2));
      CHECK(same == (word == "same"));
    } else if (word == "lines") {
      CHECK(lines(folder_.read(words.at(1))).size() == std::stoul(words.at(2)));
    } else if (word == "value") {
      compare(words, statement.head);
    } else if (word == "unpack") {
      unpack(folder_, words.at(1), words.at(2));
    } else if (word == "started") {
      const auto [all, running] = processes();
      CHECK(running == 0);
      if (words.at(1) != "any") CHECK(all == std::stoi(words[1]));
    } else if (word == "in") {
      const auto [head, texts] = expectations(statement);
      check(folder_.read(words_of(head).at(1)), texts.at("=>"));
    } else {
      command(statement);
    }
  }

  // Number of processes that the file "pids" lists, and how many of them still run; killed
  // processes take time to end, longer on a busy machine.
  [[nodiscard]] std::pair<int, int> processes() const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    std::pair<int, int> found;
    do {
      found = {0, 0};
      std::ifstream ids(folder_ / "pids");
      for (int id = 0; ids >> id; ++found.first) {
        const std::string state = content_of("/proc/" + std::to_string(id) + "/stat");
        // State Z is a zombie: dead, but not yet waited for.
        if (!state.empty() && !contains(state, ") Z ")) ++found.second;
      }
    } while (found.second > 0 && std::chrono::steady_clock::now() < until);
    return found;
  }

  void compare(const Names& words, const std::string& line) const {
    const json is = value_of(folder_, words.at(1), words.at(2));
    const std::string& sign = words.at(3);
    const std::string rest = line.substr(line.find(' ' + sign + ' ') + sign.size() + 2);
    if (sign == "has") {
      CAPTURE(is.dump(), rest);
      CHECK(contains(is.dump(), rest));
      return;
    }
    const json wanted = words.size() > 6 && words[4] == "of"
                            ? value_of(folder_, words.at(5), words.at(6))
                            : json::parse(rest);
    CAPTURE(is.dump(), wanted.dump());
    if (sign.front() == '~') {
      const double within = sign == "~" ? 1e-6 : std::stod(sign.substr(1));
      CHECK(is.get<double>() == Approx(wanted.get<double>()).epsilon(within));
      return;
    }
    static const std::map<std::string, bool (*)(const json&, const json&)> signs{
        {"=", [](const json& a, const json& b) { return a == b; }},
        {"!=", [](const json& a, const json& b) { return a != b; }},
        {"<", [](const json& a, const json& b) { return a < b; }},
        {"<=", [](const json& a, const json& b) { return a <= b; }},
        {">", [](const json& a, const json& b) { return a > b; }},
        {">=", [](const json& a, const json& b) { return a >= b; }},
        {"size", [](const json& a, const json& b) { return a.size() == b; }},
    };
    CHECK(signs.at(sign)(is, wanted));
  }

  // A statement without what it expects, and the texts of each kind.
  static std::pair<std::string, std::map<std::string, Names>> expectations(
      const Statement& statement) {
    std::string rest = statement.head;
    for (const std::string& line : statement.more) rest += ' ' + trimmed(line);
    static const std::regex mark(" (=>|!!)([~^]?)(?= |$)");
    std::pair<std::string, std::map<std::string, Names>> parts{"", {{"=>", {}}, {"!!", {}}}};
    std::string* last = &parts.first;
    for (std::smatch match; std::regex_search(rest, match, mark); rest = match.suffix()) {
      *last += match.prefix();
      Names& texts = parts.second[match[1]];
      // A text that must be absent begins with "!"; one at the beginning, with "^".
      const std::string how = match[2] == "~" ? "!" : match[2].str();
      last = &texts.emplace_back(how);
    }
    *last += rest;
    for (auto& [kind, texts] : parts.second) {
      for (std::string& text : texts) {
        const std::size_t blank = text.find(' ');
        if (blank < 2) text.erase(blank, 1);
        replace_all(text, "\\n", "\n");
        replace_all(text, "\\s", " ");
      }
    }
    return parts;
  }

  static void check(const std::string& text, const Names& parts) {
    for (const std::string& part : parts) {
      CAPTURE(part, text);
      if (part.empty()) {
        CHECK(text.empty());
      } else if (part.front() == '^') {
        CHECK(text.starts_with(part.substr(1)));
      } else {
        const bool absent = part.front() == '!';
        CHECK(contains(text, part.substr(absent ? 1 : 0)) != absent);
      }
    }
  }

  void command(const Statement& statement) {
    const auto [head, texts] = expectations(statement);
    static const std::regex form(R"((\d+|\?)(?: ([A-Z]+)@([^ :>]+)(?::(\d+))?)?([>$]) ?(.*))");
    std::smatch match;
    if (!std::regex_match(head, match, form)) throw std::runtime_error("no statement: " + head);
    const std::string line = match[6];
    Result result;
    if (match[5] == "$") {
      result = shell(line, folder_);
    } else {
      result = launched(line, match[2], match[3], match[4]);
    }
    CAPTURE(result.out, result.err);
    if (match[1] != "?") REQUIRE(result.exit_code == std::stoi(match[1]));
    check(result.err, texts.at("!!"));
    check(result.out, texts.at("=>"));
  }

  // Runs a line, with variables before it and perhaps "> FILE" behind it. A signal is sent after
  // some milliseconds, or once a file has some bytes.
  Result launched(const std::string& line, const std::string& signal, const std::string& when,
                  const std::string& bytes) {
    Launch launch{words_of(line), folder_.path()};
    Names& words = launch.arguments;
    Names variables;
    static const std::regex variable("[A-Z_]+=.*");
    while (!words.empty() && std::regex_match(words.front(), variable)) {
      variables.push_back(words.front());
      words.erase(words.begin());
    }
    launch.prepare = [&] {
      for (std::string& one : variables) putenv(one.data());
    };
    std::string into;
    if (words.size() > 1 && words[words.size() - 2] == ">") {
      into = words.back();
      words.resize(words.size() - 2);
    }
    if (!signal.empty()) {
      static const std::map<std::string, int> signals{
          {"INT", SIGINT}, {"TERM", SIGTERM}, {"HUP", SIGHUP}, {"KILL", SIGKILL}};
      launch.signal = signals.at(signal);
      if (bytes.empty()) {
        launch.signal_after = std::chrono::milliseconds(std::stoi(when));
      } else {
        launch.signal_when = [this, when, size = std::stoul(bytes)] {
          std::error_code none;
          const std::uintmax_t has = std::filesystem::file_size(folder_ / when, none);
          return !none && has >= size;
        };
      }
    }
    Result result = bbsim(launch);
    if (!into.empty()) folder_.write(into, result.out);
    return result;
  }

  Folder folder_;
  Constants constants_;
  Constants written_;  // text by file
};

}  // namespace

void play(const std::string& transcript, const std::string& title) {
  const std::string text =
      Folder().read(BBSIM_SOURCE_DIR "/tests/app/transcripts/" + transcript + ".txt");
  Player({{"SOURCE", BBSIM_SOURCE_DIR},
          {"BBSIM_VERSION", BBSIM_VERSION},
          {"CHILD", BBSIM_TEST_CHILD},
          {"PID", BBSIM_EXAMPLE_LIBRARY},
          {"LEGS", BBSIM_EXAMPLE_LEGS},
          {"TEMPLATE", BBSIM_TEMPLATE_LIBRARY},
          {"MISDEEDS", BBSIM_MISDEEDS},
          {"VERSION", BBSIM_MISDEEDS_VERSION},
          {"LACK", BBSIM_MISDEEDS_LACK}})
      .play(statements_of(text, title));
}

}  // namespace bbsim_test
