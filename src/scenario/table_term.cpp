#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "scenario/profile.hpp"
#include "scenario/rules.hpp"

namespace bbsim::input {
namespace {

constexpr std::size_t fewest_rows = 4;  // of a C2 interpolant without end conditions to invent

// The file's content, or nullptr after reporting why there is none.
const record::TableData* load(const Value& file, const std::string& name) {
  Context& context = *file.context;
  const std::filesystem::path path = context.folder / name;
  const auto known = context.tables.find(path.string());
  if (known != context.tables.end()) return &known->second;

  std::error_code error;
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    file.refuse(", which is no regular file", "a table file");
    return nullptr;
  }
  try {
    return &context.tables.emplace(path.string(), record::read_table(path.string())).first->second;
  } catch (const InputError& e) {
    for (const Problem& problem : e.problems()) {
      const std::string where = problem.where.empty() ? "" : problem.where + ": ";
      file.report(where + problem.message);
    }
    return nullptr;
  }
}

const std::vector<double>* find_column(const Value& key, const std::string& name,
                                       const record::TableData& data) {
  const auto found = std::ranges::find(data.names, name);
  if (found == data.names.end()) {
    refuse_name(key, {data.names.begin(), data.names.end()});
    return nullptr;
  }
  return &data.columns[static_cast<std::size_t>(found - data.names.begin())];
}

// What is wrong with the rows, or nothing: "found ...; allowed: ...".
std::string fault(const Table& table) {
  const std::size_t rows = table.times.size();
  if (rows < fewest_rows) {
    return "found " + std::to_string(rows) + (rows == 1 ? " row" : " rows") +
           "; allowed: at least " + std::to_string(fewest_rows);
  }
  for (std::size_t i = 0; i < rows; ++i) {
    const std::string row = " in row " + std::to_string(i + 1) + " below the header";
    if (!std::isfinite(table.times[i])) {
      return "found the time " + number_text(table.times[i]) + row + "; allowed: a finite time";
    }
    if (!std::isfinite(table.values[i])) {
      return "found the value " + number_text(table.values[i]) + row + "; allowed: a finite angle";
    }
    if (i > 0 && !(table.times[i] > table.times[i - 1])) {
      return "found the time " + number_text(table.times[i]) + row + ", after " +
             number_text(table.times[i - 1]) + "; allowed: strictly increasing times";
    }
  }
  return "";
}

std::string cover_fault(const Table& table, double end) {
  const double first = table.times.front();
  const double last = table.times.back();
  if (first <= 0 && last >= end) return "";
  return "found times from " + number_text(first) + " to " + number_text(last) +
         " s; allowed: a table that covers the run, 0 to " + number_text(end) + " s";
}

}  // namespace

void read_table_term(Keys& keys, Table& table) {
  std::string time_name;
  std::string value_name;
  bool named = keys.required("file", Text{"the name of a CSV file"}, table.file);
  named = keys.required("time", Text{"the name of a column of the file"}, time_name) && named;
  named = keys.required("value", Text{"the name of a column of the file"}, value_name) && named;
  if (!named) return;

  const record::TableData* data = load(*keys.find("file"), table.file);
  if (data == nullptr) return;
  const std::vector<double>* times = find_column(*keys.find("time"), time_name, *data);
  const std::vector<double>* values = find_column(*keys.find("value"), value_name, *data);
  if (times == nullptr || values == nullptr) return;
  table.times = *times;
  table.values = *values;

  std::string wrong = fault(table);
  if (wrong.empty() && keys.context().end) wrong = cover_fault(table, *keys.context().end);
  if (!wrong.empty()) keys.mapping().report(shown(table.file) + ": " + wrong);
}

}  // namespace bbsim::input
