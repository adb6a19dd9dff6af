// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/scene.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/number_text.hpp"

namespace bbsim::replay {
namespace {

[[noreturn]] void refuse_run(const std::string& name, const std::string& what) {
  throw InputError(name + ": cannot be replayed: " + what);
}

void check_rows(const std::string& of, const std::string& column, std::size_t rows,
                const std::string& other, std::size_t wanted) {
  if (rows == wanted) return;
  refuse_run(of, "column " + column + " has " + std::to_string(rows) + " rows, and " + other +
                     " has " + std::to_string(wanted));
}

void check_times(const Run& run, const std::vector<double>& times) {
  for (std::size_t row = 0; row < times.size(); ++row) {
    const std::string place = "t in row " + std::to_string(row + 1) + " is ";
    if (!std::isfinite(times[row])) {
      refuse_run(run.name, place + number_text(times[row]) + "; every row needs a finite time");
    }
    if (row > 0 && times[row] <= times[row - 1]) {
      refuse_run(run.name, place + number_text(times[row]) + ", after " +
                               number_text(times[row - 1]) + "; times have to increase");
    }
  }
}

void check_run(const Run& run) {
  if (find_series(run, "t") == nullptr) {
    refuse_run(
        run.name,
        "it has no column t; a replay needs t, x and y: --map t=COLUMN names those of a log");
  }
  if (find_series(run, "x") == nullptr && find_series(run, "y") == nullptr) {
    refuse_run(run.name, "it has neither a column x nor y; a replay needs t, x and y");
  }
  const std::size_t rows = row_count(run);
  if (rows == 0) refuse_run(run.name, "it has no rows");
  for (const Series& column : run.columns) {
    check_rows(run.name, column.name, column.values.size(), "t", rows);
  }
  if (!run.orientation.empty() && run.orientation.size() != rows) {
    refuse_run(run.name, "there are " + std::to_string(run.orientation.size()) +
                             " orientations of the ball, and t has " + std::to_string(rows) +
                             " rows");
  }
  check_times(run, find_series(run, "t")->values);
}

void check_sweep(const Sweep& sweep) {
  const std::size_t cases = sweep.status.size();
  if (cases == 0) refuse_run(sweep.name, "it has no cases");
  if (sweep.keys.empty()) refuse_run(sweep.name, "no key varies in it");
  if (sweep.measures.empty()) refuse_run(sweep.name, "it has no measure");
  check_rows(sweep.name, "case", sweep.cases.size(), "status", cases);
  for (const auto* columns : {&sweep.keys, &sweep.measures}) {
    for (const SweepColumn& column : *columns) {
      check_rows(sweep.name, column.name, column.rows(), "status", cases);
    }
  }
}

}  // namespace

const Series* find_series(const Run& run, std::string_view name) {
  const auto named = [name](const Series& series) { return series.name == name; };
  const auto found = std::find_if(run.columns.begin(), run.columns.end(), named);
  return found == run.columns.end() ? nullptr : &*found;
}

std::size_t row_count(const Run& run) {
  const Series* t = find_series(run, "t");
  return t == nullptr ? 0 : t->values.size();
}

std::size_t rows_of_file(const Run& run) {
  return row_count(run) - (run.has_end_row ? 1 : 0);
}

std::vector<double> coordinate(const Run& run, std::string_view name) {
  const Series* series = find_series(run, name);
  return series == nullptr ? std::vector<double>(row_count(run), 0.0) : series->values;
}

void check_scene(const Scene& scene) {
  if (scene.runs.empty() && scene.sweeps.empty()) {
    throw InputError("nothing to replay: neither a run nor a sweep");
  }
  for (const Run& run : scene.runs) check_run(run);
  for (const Sweep& sweep : scene.sweeps) check_sweep(sweep);
}

}  // namespace bbsim::replay
