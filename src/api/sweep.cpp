// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/sweep.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <utility>

#include "api/assemble.hpp"
#include "api/run.hpp"
#include "api/sweep_text.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "scenario/measures.hpp"
#include "scenario/variation.hpp"
#include "solve/output_grid.hpp"
#include "sweep/case_file.hpp"

namespace bbsim::api {
namespace {

std::vector<scenario::Measure> measures_of(const Sweep& sweep, const ScenarioFamily& family,
                                           const sweep::SweepPlan& plan, const Scenario& first) {
  const bool loop = first.controller && commands_of(first) == nullptr;
  return sweep::sweep_measures(
      sweep.measure.empty() ? scenario::default_measures(loop) : sweep.measure, family, plan);
}

// Adds the expectations of `request`, and the measures that they need.
void expect(sweep::SweepTask& task, const SweepRequest& request, const Scenario& first) {
  for (const std::string& text : request.expect) {
    scenario::Expectation expectation = scenario::read_expectation("--expect", text, first);
    if (std::ranges::count(task.expectations, expectation.text, &scenario::Expectation::text) > 0) {
      throw InputError("--expect: found " + bbsim::quoted(expectation.text) +
                       " twice; allowed: once");
    }
    task.expectations.push_back(std::move(expectation));
  }
  task.expected = scenario::add_expected(task.measures, task.expectations);
}

// Says which expectations do not hold in all cases.
void judge(const sweep::SweepTask& task, SweepResult& result) {
  for (std::size_t i = 0; i < result.statuses.unmet.size(); ++i) {
    const std::size_t count = result.statuses.unmet[i];
    if (count == 0) continue;
    result.unmet.push_back("not as expected: " + task.expectations[i].text + ": does not hold in " +
                           std::to_string(count) + " of " + std::to_string(result.rows) + " cases");
    if (result.code == ExitCode::done) result.code = ExitCode::ended_early;
  }
}

// Sets the columns of output rows to keep for each case.
void keep_rows(sweep::SweepTask& task, const Scenario& scenario) {
  for (const sweep::PlanAxis& axis : task.plan.axes()) {
    if (axis.key.starts_with("time") || axis.key.starts_with("output")) {
      throw InputError(
          "--keep-trajectories: found " + axis.key +
          " among the keys that vary; allowed: keys that leave all cases with the same rows");
    }
  }
  for (const std::string& name : scenario.output.columns) {
    if (name != "t") task.series.push_back(scenario::find_column(name));
  }
  task.series_rows = solve::OutputGrid(scenario.time).size();
}

sweep::SweepTask task_of(const SweepRequest& request, const sweep::SweepPlan& plan,
                         const Scenario& first, Watch& watch) {
  sweep::SweepTask task{*request.family, plan,
                        measures_of(request.sweep, *request.family, plan, first)};
  expect(task, request, first);
  task.report = [&watch](std::string_view line) { watch.controller_says(line); };
  if (request.keeps_rows) keep_rows(task, first);
  return task;
}

// Call it before any of the files is opened.
void declare_files(const SweepRequest& request, const Scenario& first) {
  file::Outputs outputs;
  reads_scenario(outputs, request.file, first);
  for (const auto& [name, hash] : request.family->table_hashes()) {
    outputs.reads(name, "a table of the scenario");
  }
  outputs.writes(request.output, request.by_default ? "its name by default, without -o" : "-o");
  for (const std::string& file : sweep::case_files_beside(request.output)) {
    outputs.writes(file, "kept beside " + request.output + " until the sweep is done");
  }
  if (!request.summary.empty()) outputs.writes(request.summary, "--summary");
  if (!request.script.empty()) outputs.writes(request.script, "--slurm");
}

// Destination of a sweep's cases. The threads that compute them call prepare().
struct CaseSink {
  std::function<void(sweep::CaseResults&)> prepare;
  std::function<void(const sweep::CaseResults&)> take;
};

file::Table table_of(const sweep::CaseFileLayout& layout, file::Hdf5Block block) {
  file::Table table;
  block.values.resize(layout.columns.size());
  block.texts.resize(layout.columns.size());
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const file::Hdf5Column& column = layout.columns[c];
    table.columns.push_back(
        {column.name, std::move(block.values[c]), std::move(block.texts[c]), column.unit});
  }
  return table;
}

// Runs the missing cases, and reports the rate to `watch`.
bool run_cases(const sweep::SweepTask& task, const sweep::Engine& engine, sweep::CaseRange missing,
               std::size_t threads, const CaseSink& sink, SweepResult& result, Watch& watch) {
  const auto started = std::chrono::steady_clock::now();
  const auto seconds = [&started] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  };
  const auto share = [&result] {
    return static_cast<double>(result.rows) / static_cast<double>(result.cases);
  };
  watch.start(share());
  const bool finished = sweep::run_sweep(
      engine, missing, threads, stop_of(watch), sink.prepare,
      [&](const sweep::CaseResults& results) {
        sink.take(results);
        result.rows += results.count;
        result.statuses.add(task, results);
        const double rate = static_cast<double>(result.rows - result.kept) / seconds();
        watch.update(share(), rounded(rate, 3) + " cases/s");
      },
      [&](std::size_t had) {
        watch.note("the system gave no more than " + std::to_string(had) + " of " +
                   std::to_string(threads) + " threads; the sweep continues with these");
      });
  watch.end();
  result.seconds = seconds();
  return finished;
}

// Collects the cases in their file. Returns false if the watch stopped it.
bool collect(sweep::CaseFile& file, const file::Attributes& attributes, std::size_t threads,
             const SweepResult& result, Watch& watch) {
  watch.start(0);
  const bool whole = file.finish(
      attributes, {threads, stop_of(watch), [&](std::size_t cases) {
                     watch.update(static_cast<double>(cases) / static_cast<double>(result.cases),
                                  "writing " + result.output);
                   }});
  watch.end();
  return whole;
}

}  // namespace

Sweep with_choice(Sweep sweep, const SweepChoice& choice) {
  if (!choice.vary.empty()) {
    sweep.vary = choice.vary;
    const auto random = [](const Variation& variation) {
      return scenario::parse_variation(variation).random();
    };
    // The scenario's number is for its own random keys, which are replaced.
    if (std::ranges::none_of(sweep.vary, random)) sweep.samples.reset();
  }
  if (!choice.combine.empty()) {
    if (choice.combine != "grid" && choice.combine != "zip") {
      throw InputError("combine: found " + shown(choice.combine) + "; allowed: grid, zip");
    }
    sweep.combine = choice.combine == "zip" ? Combine::zip : Combine::grid;
  }
  if (choice.samples) sweep.samples = choice.samples;
  if (choice.seed) sweep.seed = *choice.seed;
  if (!choice.measures.empty()) sweep.measure = scenario::split_measures(choice.measures);
  return sweep;
}

SweepSize check_sweep(const SweepRequest& request, Watch& watch) {
  const sweep::SweepPlan plan(*request.family, request.sweep);
  const Scenario first = request.family->read(plan.settings(0));
  const sweep::SweepTask task = task_of(request, plan, first, watch);
  declare_files(request, first);
  for (const std::string& remark : first.remarks) watch.note(remark);
  static_cast<void>(plan.check(*request.family, 0, plan.cases(), [&](double part) {
    watch.update(part, "checking the cases");
    return true;
  }));
  watch.end();
  const std::size_t group = sweep::choose_engine(task).group;
  return {plan.cases(), (plan.cases() + group - 1) / group};
}

SweepResult sweep(const SweepRequest& request, Watch& watch) {
  require_whole("threads", request.threads, 0, most_threads);
  const ScenarioFamily& family = *request.family;
  const sweep::SweepPlan plan(family, request.sweep);
  const Scenario first = family.read(plan.settings(0));
  const sweep::SweepTask task = task_of(request, plan, first, watch);
  const sweep::Engine engine = sweep::choose_engine(task);
  const sweep::CaseRange range =
      sweep::shard_range(plan.cases(), engine.group, request.shard.number, request.shard.of);

  SweepResult result;
  result.engine = engine.name;
  result.output = request.output;
  result.cases = range.last - range.first;
  const SweepFacts facts{family, request.sweep, task, first, request.shard};
  sweep::CaseFileLayout layout = layout_of(facts, range);
  if (request.output.empty()) result.table = table_of(layout, {});
  const std::atomic<bool>& stop = stop_of(watch);
  for (const std::string& remark : first.remarks) watch.note(remark);
  const bool checked = plan.check(family, range.first, range.last, [&](double part) {
    watch.update(part, "checking the cases");
    return !stop.load(std::memory_order_relaxed);
  });
  if (!checked) {
    watch.end();
    result.code = ExitCode::interrupted;
    result.reason = "interrupted before the first case.";
    return result;
  }

  const std::size_t threads = threads_of(request.threads);
  const auto interrupted = [&result] {
    result.code = ExitCode::interrupted;
    result.reason = "interrupted after " + std::to_string(result.rows) + " of " +
                    std::to_string(result.cases) + " cases.";
  };
  if (request.output.empty()) {
    try_controller(family, first, watch);
    file::Hdf5Block block;
    const CaseSink sink{
        [](sweep::CaseResults&) {},
        [&](const sweep::CaseResults& results) { append_rows(task, results, block); }};
    if (!run_cases(task, engine, range, threads, sink, result, watch)) interrupted();
    result.table = table_of(layout, std::move(block));
    judge(task, result);
    return result;
  }
  declare_files(request, first);
  // Check the file before a controller starts.
  sweep::check_case_target(request.output, layout, request.resumes);
  if (request.by_default && !request.replaces_anything) {
    file::require_like(request.output, file::table_with(sweep::header_of(layout.columns)));
  }
  try_controller(family, first, watch);
  const auto summary =
      request.summary.empty() ? nullptr : std::make_unique<file::AtomicFile>(request.summary);
  sweep::CaseFile file(request.output, std::move(layout), task, plan_text(facts), request.resumes);
  if (!file.kept().trouble.empty()) watch.warn(file.kept().trouble);
  result.rows = result.kept = file.kept().cases;
  result.statuses = file.kept().statuses;

  const CaseSink sink{[&file](sweep::CaseResults& results) { file.prepare(results); },
                      [&file](const sweep::CaseResults& results) { file.append(results); }};
  const bool ran = run_cases(task, engine, {range.first + result.kept, range.last}, threads, sink,
                             result, watch);
  if (!ran) file.interrupt();
  if (!ran || !collect(file, attributes_of(facts, engine), threads, result, watch)) {
    interrupted();
    if (!file.part().empty() && result.rows > 0) {
      result.reason +=
          "\n  " + file.part() + " keeps them; the same command with --resume continues.";
    }
  }
  judge(task, result);
  if (!result.statuses.failed.empty())
    result.repeat = repeat_text(facts, result.statuses.failed[0]);
  if (summary) {
    summary->write(summary_text(facts, result));
    summary->commit();
  }
  return result;
}

sweep::Merged merge(const std::vector<std::string>& parts, const std::string& output,
                    Watch& watch) {
  file::Outputs outputs;
  for (const std::string& part : parts) {
    outputs.reads(part, "a part");
    if (const std::string plan = sweep::plan_of_part(part); !plan.empty()) {
      outputs.reads(plan, "the plan of " + part);
    }
  }
  outputs.writes(output, "-o");
  return sweep::merge_cases(parts, output, stop_of(watch));
}

}  // namespace bbsim::api
