// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs of a scenario with values, times and starts of their own, as arrays.
#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "api/assemble.hpp"
#include "api/sweep.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"
#include "base/text.hpp"
#include "scenario/columns.hpp"
#include "scenario/measures.hpp"
#include "solve/output_grid.hpp"
#include "sweep/sweep.hpp"
#include "sweep/task.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::api {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& found,
                         const std::string& allowed) {
  throw InputError(what + ": found " + found + "; allowed: " + allowed);
}

std::string place(std::string_view what, std::size_t number) {
  return std::string(what) + ": case " + std::to_string(number);
}

void require_count(const std::string& what, std::size_t found, std::size_t count) {
  if (found == count) return;
  refuse(what, "values for " + std::to_string(found) + " cases",
         "for " + std::to_string(count) + ", one for each case");
}

void check_keys(const CasesRequest& request) {
  for (const auto& key : request.keys) {
    const std::string what = "cases: " + shown(key.key);
    require_count(what, std::max(key.numbers.size(), key.texts.size()), request.count);
    for (std::size_t i = 0; i < key.numbers.size(); ++i) {
      if (std::isfinite(key.numbers[i])) continue;
      refuse(place("cases", i) + ": " + shown(key.key), number_text(key.numbers[i]),
             "finite numbers");
    }
  }
}

void check_windows(const CasesRequest& request, double end) {
  const sweep::Windows& windows = request.windows;
  if (!windows.begin.empty()) require_count("begin", windows.begin.size(), request.count);
  if (!windows.end.empty()) require_count("end", windows.end.size(), request.count);
  if (!windows.start.empty()) require_count("start", windows.start.size(), request.count);
  for (std::size_t i = 0; i < windows.begin.size(); ++i) {
    const double begin = windows.begin[i];
    const double to = windows.end.empty() ? end : windows.end[i];
    if (windows.end.empty() ? begin >= 0 && begin < to : std::isfinite(begin)) continue;
    refuse(place("begin", i), number_text(begin),
           windows.end.empty() ? "times from 0 s to below " + number_text(end) + " s"
                               : "finite times");
  }
  for (std::size_t i = 0; i < windows.end.size(); ++i) {
    const double begin = windows.begin_of(i);
    if (std::isfinite(windows.end[i]) && windows.end[i] > begin) continue;
    refuse(place("end", i), number_text(windows.end[i]),
           "times above the case's begin, " + number_text(begin) + " s");
  }
  for (std::size_t i = 0; i < windows.start.size(); ++i) {
    for (std::size_t k = 0; k < sweep::start_names.size(); ++k) {
      const double value = windows.start[i][k];
      if (std::isfinite(value)) continue;
      refuse(place("start", i) + ": " + std::string(sweep::start_names[k]), number_text(value),
             "finite numbers");
    }
  }
}

// Times of cases that vary the end of their run are checked against no end.
void check_times(const CasesRequest& request, double end) {
  const sweep::CaseTimes& times = *request.times;
  if (times.count == 0) return;
  if (times.each) require_count("times", times.values.size() / times.count, request.count);
  const bool alike = !times.each && !request.windows.cut();
  for (std::size_t i = 0; i < (alike ? 1 : request.count); ++i) {
    const double from = request.windows.begin_of(i);
    const double to = request.windows.end.empty() ? end : request.windows.end[i];
    const auto list = times.of(i);
    for (std::size_t k = 0; k < list.size(); ++k) {
      const auto at = [&] {
        return (alike ? "times: " : place("times", i) + ", ") + ("time " + std::to_string(k));
      };
      const bool is_within = std::isfinite(list[k]) &&
                             (list[k] >= from || sweep::is_same_time(list[k], from)) &&
                             (list[k] <= to || sweep::is_same_time(list[k], to));
      if (!is_within) {
        refuse(
            at(), number_text(list[k]),
            "times that the case covers, " + number_text(from) + " to " + number_text(to) + " s");
      }
      if (k > 0 && list[k] < list[k - 1]) {
        refuse(at(), number_text(list[k]) + " after " + number_text(list[k - 1]),
               "times that do not decrease");
      }
    }
  }
}

// Numbers of your own controller must also be among output.columns.
void check_columns(const std::vector<std::string>& names, const Scenario& first) {
  const std::vector<std::string> own = scenario::own_columns(first);
  for (auto name = names.begin(); name != names.end(); ++name) {
    const std::string found = shown(*name);
    const scenario::Column* const column = scenario::find_column(*name);
    const bool is_known = column != nullptr && (column->needs != scenario::Needs::own ||
                                                std::ranges::find(own, *name) != own.end());
    if (!is_known) {
      refuse("columns", found + yaml::hint(*name, scenario::column_names()),
             "the names that `bbsim columns` lists");
    }
    if (const scenario::Missing lacks = scenario::missing(*column, first)) {
      refuse("columns", found + ", but " + lacks.why, lacks.instead);
    }
    if (std::find(names.begin(), name, *name) != name) {
      refuse("columns", found + " again", "each column once");
    }
  }
}

class Cases {
 public:
  Cases(const CasesRequest& request, const sweep::SweepPlan& plan, const Scenario& first,
        Watch& watch, CasesResult& result)
      : request_(request), plan_(plan), watch_(watch), result_(result) {
    if (request.times) {
      times_ = *request.times;
    } else {
      const solve::OutputGrid grid(first.time);
      times_.count = grid.size();
      for (std::size_t i = 0; i < grid.size(); ++i) times_.values.push_back(grid[i]);
    }
    constexpr double most_numbers = 1e11;  // of a column
    if (static_cast<double>(request.count) * static_cast<double>(times_.count) > most_numbers) {
      refuse("cases",
             std::to_string(request.count) + " at " + std::to_string(times_.count) + " times",
             "at most 1e11 numbers for each column");
    }
    result.times = times_.count;
    result.columns.resize(request.columns.size());
    for (auto& column : result.columns) column.assign(request.count * times_.count, no_number);
    result.measures.resize(request.measures.size());
    for (auto& measure : result.measures) measure.assign(request.count, no_number);
    result.status.assign(request.count, {"", ""});
    for (const std::string& name : request.columns) {
      if (name != "t") series_.push_back(scenario::find_column(name));
    }
    measures_ = request.count > 0 ? sweep::sweep_measures(request.measures, request.family, plan)
                                  : scenario::measures_named(request.measures, first);
  }

  // Returns false if interrupted.
  bool run() {
    const sweep::Windows& windows = request_.windows;
    const bool own_rows = request_.times || windows.cut();
    // Means over the rows are those over the scenario's output times.
    const bool apart = own_rows && !request_.columns.empty() && !measures_.empty();
    sweep::SweepTask task{request_.family, plan_, apart ? decltype(measures_){} : measures_};
    task.report = [this](std::string_view line) { watch_.controller_says(line); };
    if (windows.cut() || !windows.start.empty() || !windows.events) task.windows = &windows;
    passes_ = apart ? 2 : 1;
    watch_.start(0);
    bool finished = true;
    if (!request_.columns.empty()) {
      task.series = series_;
      task.series_rows = times_.count;
      task.series_in_lanes = request_.in_lanes;
      if (own_rows) task.times = &times_;
      finished = run(task);
      task.series.clear();
      task.series_rows = 0;
      task.times = nullptr;
      task.measures = measures_;
    }
    if (finished && (apart || request_.columns.empty())) finished = run(task);
    watch_.end();
    return finished;
  }

 private:
  bool run(const sweep::SweepTask& task) {
    const sweep::Engine engine = sweep::choose_engine(task);
    return sweep::run_sweep(
        engine, {0, request_.count}, threads_of(request_.threads), stop_of(watch_),
        [](sweep::CaseResults&) {},
        [&](const sweep::CaseResults& results) {
          take(task, results);
          done_ += results.count;
          watch_.update(static_cast<double>(done_) / static_cast<double>(passes_ * request_.count),
                        "");
        });
  }

  void take(const sweep::SweepTask& task, const sweep::CaseResults& results) {
    const std::size_t stride = 1 + task.measures.size();
    for (std::size_t i = 0; i < results.count; ++i) {
      sweep::CaseStatus& status = result_.status[results.first + i];
      status = results.status[i];
      // It came to its end, but not within solver.error.
      if (status.word == "inaccurate") status.word = "failed";
      for (std::size_t m = 0; m < task.measures.size(); ++m) {
        result_.measures[m][results.first + i] = results.numbers[i * stride + 1 + m];
      }
    }
    if (task.series_rows == 0) return;
    std::size_t series = 0;
    for (std::size_t c = 0; c < request_.columns.size(); ++c) {
      double* const into = result_.columns[c].data() + results.first * times_.count;
      if (request_.columns[c] != "t") {
        std::ranges::copy(results.series[series++], into);
        continue;
      }
      for (std::size_t i = 0; i < results.count; ++i) {
        take_times(results.first + i, results.numbers[i * stride], into + i * times_.count);
      }
    }
  }

  // The times up to that at which the case ended, s after its begin.
  void take_times(std::size_t number, double reached, double* into) const {
    const double begin = request_.windows.begin_of(number);
    const double until = begin + reached;
    const auto list = times_.of(number);
    for (std::size_t k = 0; k < list.size(); ++k) {
      const bool is_within = (list[k] >= begin || sweep::is_same_time(list[k], begin)) &&
                             (list[k] <= until || sweep::is_same_time(list[k], until));
      if (is_within) into[k] = list[k];
    }
  }

  const CasesRequest& request_;
  const sweep::SweepPlan& plan_;
  Watch& watch_;
  CasesResult& result_;
  sweep::CaseTimes times_;
  std::vector<const scenario::Column*> series_;
  std::vector<scenario::Measure> measures_;
  std::size_t passes_ = 1, done_ = 0;
};

bool varies_time(const CasesRequest& request) {
  return std::ranges::any_of(request.keys,
                             [](const auto& key) { return key.key.starts_with("time"); });
}

}  // namespace

CasesResult run_cases(const CasesRequest& request, Watch& watch) {
  constexpr double most_cases = 1e9;
  require_whole("threads", request.threads, 0, most_threads);
  require_whole("cases", static_cast<double>(request.count), 0, most_cases);
  check_keys(request);
  const sweep::SweepPlan plan(request.family, request.keys, request.count);
  using Settings = std::vector<ScenarioFamily::Setting>;
  Scenario first = request.family.read(request.count > 0 ? plan.first_settings() : Settings{});
  check_columns(request.columns, first);
  const bool any_end = varies_time(request);
  const double end = any_end ? infinity : first.time.end;
  check_windows(request, end);
  if (request.times) check_times(request, end);
  if (any_end && !request.times && !request.columns.empty()) {
    refuse("times", "none, although the cases vary keys of time", "times");
  }
  CasesResult result;
  Cases cases(request, plan, first, watch, result);
  if (request.count == 0) return result;
  try_controller(request.family, std::move(first), watch);
  if (!cases.run()) result.code = ExitCode::interrupted;
  return result;
}

}  // namespace bbsim::api
