// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "results/result.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/real.hpp"

namespace bbsim::results {

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
