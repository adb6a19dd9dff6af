// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The keys that vary in a sweep, and its results.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

#include "results/result.hpp"

namespace bbsim::results {
namespace {

// Fewer cases do not tell whether values are random.
constexpr std::size_t many_cases = 8;

std::vector<double> sorted_distinct(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

Key key_of(const Column& column) {
  Key key{column.name, column.numbers, {}};
  if (column.is_text()) {
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < key.values.size(); ++i) {
      const auto [place, added] = places.emplace(column.text(i), key.labels.size());
      if (added) key.labels.push_back(place->first);
      key.values[i] = static_cast<double>(place->second);
    }
  }
  key.distinct = sorted_distinct(key.values);
  key.unit = column.unit == "1" ? "" : column.unit;
  return key;
}

bool looks_drawn(const Key& key) {
  const std::size_t cases = key.values.size();
  if (key.is_text() || cases < many_cases || 2 * key.distinct.size() <= cases) return false;
  return !std::ranges::is_sorted(key.values) &&
         !std::ranges::is_sorted(key.values, std::ranges::greater());
}

// Whether the values of two keys correspond one to one.
bool correspond(const Key& a, const Key& b) {
  if (a.distinct.size() != b.distinct.size()) return false;
  std::map<double, double> partners;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (std::isnan(a.values[i]) || std::isnan(b.values[i])) return false;
    const auto [partner, added] = partners.emplace(a.values[i], b.values[i]);
    if (!added && partner->second != b.values[i]) return false;
  }
  return true;
}

// The word "failed" of "failed at 0.7 s: ...".
std::string first_word(const std::string& text) {
  const auto end = std::ranges::find_if(
      text, [](unsigned char c) { return std::isspace(c) != 0 || c == ':' || c == ','; });
  return {text.begin(), end};
}

void end_a_case(SweepTable& table, const std::string& status) {
  table.status.push_back(status);
  if (status == "done") return;
  for (auto& [word, cases] : table.others) {
    if (word != status) continue;
    ++cases;
    return;
  }
  table.others.emplace_back(status, 1);
}

}  // namespace

std::vector<std::string> SweepTable::followers(const Key& key) const {
  std::vector<std::string> names;
  for (const Key& other : keys) {
    if (&other != &key && other.leader == key.leader) names.push_back(other.name);
  }
  return names;
}

SweepTable sweep_table(const Result& sweep) {
  SweepTable table;
  bool before_status = true;
  for (const Column& column : sweep.columns) {
    if (column.name == "case") continue;
    if (column.name == "status") {
      before_status = false;
      for (const std::string& text : column.texts) end_a_case(table, first_word(text));
      continue;
    }
    if (!before_status) {
      if (!column.is_text() && column.name != "reason") table.measures.push_back(&column);
      continue;
    }
    Key key = key_of(column);
    if (key.distinct.size() < 2) continue;
    key.drawn = sweep.drawn_keys_known
                    ? std::ranges::find(sweep.drawn_keys, key.name) != sweep.drawn_keys.end()
                    : looks_drawn(key);
    key.leader = table.keys.size();
    table.keys.push_back(std::move(key));
  }
  for (std::size_t k = 0; k < table.keys.size(); ++k) {
    for (std::size_t earlier = 0; earlier < k; ++earlier) {
      Key& key = table.keys[k];
      const Key& earlier_key = table.keys[earlier];
      if (key.drawn || earlier_key.drawn || key.leader != k || !correspond(key, earlier_key))
        continue;
      key.leader = earlier_key.leader;
    }
  }
  std::erase_if(table.measures, [](const Column* column) {
    return column->name == "end_time" && sorted_distinct(column->numbers).size() < 2;
  });
  return table;
}

}  // namespace bbsim::results
