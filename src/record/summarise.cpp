// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/summarise.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"
#include "base/text.hpp"
#include "file/csv_fields.hpp"

namespace bbsim::record {
namespace {

const file::Column& column_of(const file::Table& table, const std::string& file,
                              const std::string& name, const std::string& option) {
  if (const file::Column* const found = table.find(name)) return *found;
  throw InputError(option + ": found " + name + "; " + file + " has the columns " +
                   joined(table.names()));
}

// Default measures: the numeric columns, in sweeps those after the status; keys come before it.
std::vector<std::string> all_measures(const file::Table& table) {
  std::vector<std::string> names;
  bool is_after = table.find("status") == nullptr;
  for (const file::Column& column : table.columns) {
    is_after = is_after || column.name == "status";
    if (is_after && column.texts.empty() && column.width == 1 && column.name != "case" &&
        column.name != "end_time") {
      names.push_back(column.name);
    }
  }
  return names;
}

// The value below which `part` (0 to 1) of the sorted values lies, by linear interpolation as in
// numpy.quantile; NaN if there are none.
double quantile(const std::vector<double>& sorted, double part) {
  if (sorted.empty()) return no_number;
  const double place = part * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], place - static_cast<double>(below));
}

// ",count,mean,deviation,min", quantiles and ",max" of the values.
std::string figures_of(std::vector<double> values, const std::vector<double>& quantiles) {
  std::ranges::sort(values);
  const bool none = values.empty();
  const auto count = static_cast<double>(values.size());
  const double least = none ? no_number : values.front();
  // Sums differences from the least value, so that nearly equal large values keep their digits.
  double sum = 0, squares = 0;
  for (const double value : values) sum += value - least;
  const double mean = none ? no_number : least + sum / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  std::string text = ',' + std::to_string(values.size());
  const auto add = [&text](double value) { text += ',' + number_text(value); };
  add(mean);
  add(values.size() < 2 ? no_number : std::sqrt(squares / (count - 1)));
  add(least);
  for (const double part : quantiles) add(quantile(values, part));
  add(none ? no_number : values.back());
  return text;
}

struct Group {
  std::string keys;                         // their values, as fields of its rows
  std::size_t cases = 0;                    // all, however they ended
  std::vector<std::vector<double>> values;  // of each measure
};

}  // namespace

std::string summarise(const file::Table& table, const std::string& name,
                      const std::vector<std::string>& keys,
                      const std::vector<std::string>& measures,
                      const std::vector<double>& quantiles) {
  std::vector<const file::Column*> by;
  for (const std::string& key : keys) by.push_back(&column_of(table, name, key, "--by"));
  const std::vector<std::string> names = measures.empty() ? all_measures(table) : measures;
  if (names.empty()) {
    throw InputError(name +
                     ": found no columns of numbers to summarize; allowed: a sweep's result");
  }
  std::vector<const file::Column*> columns;
  for (const std::string& measure : names) {
    const file::Column& column = column_of(table, name, measure, "--measure");
    if (!column.texts.empty() || column.width != 1) {
      throw InputError(
          "--measure: found " + measure +
          ", which is not a column of numbers; allowed: " + joined(all_measures(table)));
    }
    columns.push_back(&column);
  }
  const file::Column* const ends = table.find("status");

  std::vector<Group> groups;
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < table.rows; ++i) {
    std::string key;
    for (const file::Column* column : by) {
      file::append_text(key,
                        column->has_text(i) ? column->texts[i] : number_text(column->numbers[i]));
      key += ',';
    }
    const auto [place, is_new] = places.emplace(key, groups.size());
    if (is_new) groups.push_back({key, 0, std::vector<std::vector<double>>(columns.size())});
    Group& group = groups[place->second];
    ++group.cases;
    if (ends != nullptr && ends->has_text(i) && ends->texts[i] != "done") continue;
    for (std::size_t m = 0; m < columns.size(); ++m) {
      const double value = columns[m]->numbers[i];
      if (std::isfinite(value)) group.values[m].push_back(value);
    }
  }

  std::string text;
  for (const std::string& key : keys) text += key + ',';
  text += "measure,cases,count,mean,deviation,min";
  // 0.05 becomes q5 and 0.001 becomes q0.1; rounding removes binary errors of the percentage.
  for (const double part : quantiles) {
    text += ",q" + number_text(std::round(part * 1e12) / 1e10);
  }
  text += ",max\n";
  for (Group& group : groups) {
    for (std::size_t m = 0; m < names.size(); ++m) {
      text += group.keys + names[m] + ',' + std::to_string(group.cases) +
              figures_of(std::move(group.values[m]), quantiles) + '\n';
    }
  }
  return text;
}

}  // namespace bbsim::record
