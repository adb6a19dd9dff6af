#include "study/sweep/sweep.hpp"

#include <CLI/App.hpp>
#include <CLI/Validators.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "describe.hpp"
#include "progress.hpp"
#include "record/case_file.hpp"
#include "record/case_text.hpp"
#include "record/measures.hpp"
#include "scenario/variation.hpp"
#include "signals.hpp"
#include "solve/collocation/radau.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::app {
namespace {

struct SweepArguments {
  ScenarioArguments scenario;
  std::vector<std::string> vary, measure;
  std::string combine, output, shard, error;
  std::optional<double> samples, seed;
  std::size_t threads = 0;
  bool resume = false, keep_trajectories = false;
};

struct Shard {
  std::size_t number = 1, of = 1;
};

Shard read_shard(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  int end = 0;
  if (text.find_first_not_of("0123456789/") != std::string::npos || text.size() > 19 ||
      std::sscanf(text.c_str(), "%zu/%zu%n", &shard.number, &shard.of, &end) != 2 ||
      end != static_cast<int>(text.size()) || shard.number < 1 || shard.number > shard.of) {
    throw InputError("--shard: found " + text + "; allowed: K/N with K from 1 to N, such as 2/8");
  }
  return shard;
}

double whole(const char* option, double number) {
  if (number == std::floor(number)) return number;
  throw InputError(std::string(option) + ": found " + record::number_text(number) +
                   "; allowed: a whole number");
}

// What the scenario says of the sweep, and the command line instead of it.
Sweep sweep_of(const SweepArguments& arguments, const Sweep& in_scenario) {
  Sweep sweep = in_scenario;
  if (!arguments.vary.empty()) {
    sweep.vary.clear();
    for (const std::string& one : arguments.vary) {
      sweep.vary.push_back(input::split_variation(one));
    }
  }
  if (!arguments.combine.empty()) {
    sweep.combine = arguments.combine == "zip" ? Combine::zip : Combine::grid;
  }
  const auto random = [](const Variation& one) { return input::parse_variation(one).random(); };
  if (!arguments.vary.empty() && std::none_of(sweep.vary.begin(), sweep.vary.end(), random)) {
    sweep.samples.reset();  // of what the scenario would draw
  }
  if (arguments.samples) sweep.samples = whole("--samples", *arguments.samples);
  if (arguments.seed) sweep.seed = whole("--seed", *arguments.seed);
  if (!arguments.measure.empty()) {
    sweep.measure.clear();
    for (const std::string& names : arguments.measure) {
      for (std::size_t start = 0; start != std::string::npos;) {
        const std::size_t comma = names.find(',', start);
        sweep.measure.push_back(names.substr(start, comma - start));
        start = comma == std::string::npos ? comma : comma + 1;
      }
    }
  }
  return sweep;
}

std::vector<record::Measure> measures_of(const Sweep& sweep, const Scenario& scenario) {
  const bool loop = scenario.controller.has_value();
  std::vector<record::Measure> measures;
  for (const std::string& name :
       sweep.measure.empty() ? record::default_measures(loop) : sweep.measure) {
    const std::optional<record::Measure> measure = record::find_measure(name);
    if (!measure) {
      throw InputError("measure: found " + name + "; allowed: " + record::allowed_measures());
    }
    const char* const why = record::why_missing(*measure->column, scenario);
    if (why != nullptr) throw InputError("measure: found " + name + ", but " + why);
    for (const record::Measure& other : measures) {
      if (other.name == name) throw InputError("measure: found " + name + " twice");
    }
    measures.push_back(*measure);
  }
  return measures;
}

record::CaseFileLayout layout_of(const study::SweepTask& task, const Scenario& scenario) {
  record::CaseFileLayout layout;
  using record::CaseKind;
  layout.columns.push_back({"case", "1", "number of the case, from 0"});
  for (const study::Axis& axis : task.plan.axes()) {
    layout.columns.push_back({axis.key, "SI", "varied key of the scenario, in SI units and radians",
                              axis.numeric ? CaseKind::number : CaseKind::text});
  }
  layout.columns.push_back({"status", "", "done, or why the case ended early", CaseKind::text});
  layout.columns.push_back({"end_time", "s", "time reached"});
  for (const record::Measure& measure : task.measures) {
    layout.columns.push_back({measure.name, std::string(measure.column->unit), measure.meaning()});
  }
  if (task.series.empty()) return layout;
  const solve::OutputGrid grid(scenario.time);
  layout.axis = {"t", "s", "time"};
  for (std::size_t i = 0; i < grid.size(); ++i) layout.axis_values.push_back(grid[i]);
  for (const record::Column* column : task.series) {
    layout.columns.push_back({std::string(column->name), std::string(column->unit),
                              std::string(column->meaning), CaseKind::series, grid.size()});
  }
  return layout;
}

// Columns of the output rows to be kept of each case.
void keep_trajectories(study::SweepTask& task, const Scenario& scenario) {
  for (const study::Axis& axis : task.plan.axes()) {
    if (axis.key.starts_with("time") || axis.key.starts_with("output")) {
      throw InputError("cannot keep trajectories where " + axis.key +
                       " varies: they must have the same rows in all cases");
    }
  }
  for (const std::string& name : scenario.output.columns) {
    if (name != "t") task.series.push_back(record::find_column(name));
  }
  task.series_rows = solve::OutputGrid(scenario.time).size();
}

// All that the results depend on.
std::string plan_text(const ScenarioFamily& family, const Sweep& sweep,
                      const study::SweepTask& task, const Shard& shard) {
  const Source& source = family.source();
  nlohmann::ordered_json plan;
  plan["version"] = BBSIM_VERSION;
  plan["instruction_set"] = solve::collocation::choose_kernels().name;
  plan["scenario"] = source.text;
  plan["overrides"] = source.overrides;
  for (const auto& [name, hash] : family.table_hashes()) plan["tables"][name] = hash;
  for (const Variation& variation : sweep.vary) {
    plan["vary"].push_back(variation.key + '=' + variation.spec);
  }
  plan["combine"] = sweep.combine == Combine::zip ? "zip" : "grid";
  if (sweep.samples) {
    plan["samples"] = *sweep.samples;
    plan["seed"] = sweep.seed;
  }
  for (const record::Measure& measure : task.measures) plan["measure"].push_back(measure.name);
  plan["trajectories"] = !task.series.empty();
  if (shard.of > 1) plan["shard"] = std::to_string(shard.number) + '/' + std::to_string(shard.of);
  return plan.dump(1) + '\n';
}

record::Attributes attributes_of(const ScenarioFamily& family, const Sweep& sweep,
                                 std::size_t cases) {
  const Source& source = family.source();
  record::Attributes attributes{{"version", BBSIM_VERSION},
                                {"scenario", std::filesystem::path(source.file).filename()},
                                {"scenario_text", source.text}};
  const auto lines = [](const auto& items, const auto& text) {
    std::string all;
    for (const auto& item : items) all += (all.empty() ? "" : "\n") + text(item);
    return all;
  };
  attributes.emplace_back("overrides", lines(source.overrides, [](const auto& o) { return o; }));
  attributes.emplace_back(
      "vary", lines(sweep.vary, [](const Variation& one) { return one.key + '=' + one.spec; }));
  attributes.emplace_back("cases", std::to_string(cases));
  attributes.emplace_back("combine", sweep.combine == Combine::zip ? "zip" : "grid");
  if (sweep.samples) {
    attributes.emplace_back("samples", short_number(*sweep.samples));
    attributes.emplace_back("seed", record::number_text(sweep.seed));
  }
  return attributes;
}

std::string default_output(const std::string& scenario, const Shard& shard) {
  std::string name = std::filesystem::path(scenario).stem().string() + "-sweep";
  if (shard.of > 1) name += '-' + std::to_string(shard.number) + "of" + std::to_string(shard.of);
  return name + ".csv";
}

// The rows of some cases as CSV, on the thread that computed them.
void write_text(const study::SweepTask& task, study::CaseResults& results) {
  const auto& axes = task.plan.axes();
  const std::size_t numbers = 1 + task.measures.size();
  std::string& text = results.text;
  text.clear();
  for (std::size_t i = 0; i < results.count; ++i) {
    text += std::to_string(results.first + i);
    for (std::size_t a = 0; a < axes.size(); ++a) {
      text += ',';
      const double value = results.values[i * axes.size() + a];
      if (axes[a].numeric) {
        record::append_number(text, value);
      } else {
        record::append_text(text, axes[a].texts[static_cast<std::size_t>(value)]);
      }
    }
    text += ',';
    record::append_text(text, results.status[i]);
    for (std::size_t n = 0; n < numbers; ++n) {
      text += ',';
      record::append_number(text, results.numbers[i * numbers + n]);
    }
    text += '\n';
  }
}

std::size_t available_threads() {
  return std::max(1U, std::thread::hardware_concurrency());
}

ExitCode sweep(const SweepArguments& arguments, const Options& options) {
  std::vector<std::string> overrides = arguments.scenario.overrides;
  if (!arguments.error.empty()) overrides.push_back("solver.error=" + arguments.error);
  const Shard shard = read_shard(arguments.shard);
  const ScenarioFamily family(arguments.scenario.file, overrides);
  const Sweep sweep = sweep_of(arguments, family.read_sweep());
  const study::SweepPlan plan(family, sweep);
  const Scenario first = family.read(plan.settings(0));
  study::SweepTask task{family, plan, measures_of(sweep, first)};
  if (arguments.keep_trajectories) keep_trajectories(task, first);

  const study::Engine engine = study::choose_engine(task);
  const std::size_t group = engine.group;
  const study::CaseRange range = study::shard_range(plan.cases(), group, shard.number, shard.of);

  const std::atomic<bool>& stop = watch_signals();
  Progress progress(arguments.scenario.file, options.quiet, true);
  const bool checked = plan.check(family, range.first, range.last, [&](double part) {
    progress.update(part, "checking the cases");
    return !stop.load(std::memory_order_relaxed);
  });
  if (!checked) {
    progress.clear();
    if (!options.quiet) std::fprintf(stderr, "interrupted before the first case.\n");
    return ExitCode::interrupted;
  }

  const std::string output =
      arguments.output.empty() ? default_output(arguments.scenario.file, shard) : arguments.output;
  const auto file = record::open_case_file(output, layout_of(task, first),
                                           plan_text(family, sweep, task, shard), arguments.resume);
  file->keep_only(file->kept() - file->kept() % group);
  const std::size_t kept = file->kept(), all = range.last - range.first;

  const std::size_t threads = arguments.threads > 0 ? arguments.threads : available_threads();
  std::size_t done = kept, early = 0;
  const auto started = std::chrono::steady_clock::now();
  const auto seconds = [&started] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  };
  const auto rate = [&] { return static_cast<double>(done - kept) / seconds(); };
  const bool finished = study::run_sweep(
      engine, {range.first + kept, range.last}, threads, stop,
      [&task](study::CaseResults& results) { write_text(task, results); },
      [&](const study::CaseResults& results) {
        file->append(results.text, results.series);
        done += results.count;
        for (const std::string& status : results.status) early += status != "done" ? 1 : 0;
        progress.update(static_cast<double>(done) / static_cast<double>(all),
                        short_number(rate()) + " cases/s");
      });
  progress.clear();

  const std::string counts = std::to_string(done) + " of " + std::to_string(all) + " cases";
  if (!finished) {
    if (!options.quiet) {
      std::fprintf(stderr, "interrupted after %s.\n", counts.c_str());
      if (!file->part().empty() && done > 0) {
        std::fprintf(stderr, "  %s keeps them; the same command with --resume goes on.\n",
                     file->part().c_str());
      }
    }
    return ExitCode::interrupted;
  }
  file->finish(attributes_of(family, sweep, plan.cases()));
  if (!options.quiet) {
    std::string line = output + ": " + counts;
    if (kept > 0) line += ", " + std::to_string(kept) + " of them from before";
    if (early > 0) line += ", " + std::to_string(early) + " ended early (see status)";
    line += ", by " + engine.name;
    std::fprintf(stderr, "%s, %s s\n", line.c_str(), short_number(seconds()).c_str());
  }
  return ExitCode::done;
}

}  // namespace

void add_sweep(CLI::App& app, const Options& options, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("sweep", "Simulate a scenario at many values of its keys");
  command->fallthrough();
  const auto arguments = std::make_shared<SweepArguments>();
  add_scenario(*command, arguments->scenario);
  may_be_repeated(*command->add_option(
      "--vary", arguments->vary,
      "KEY=SPEC: values for a key, such as ball.position.0=linear:-0.1:0.1:21; may be "
      "given again. SPEC is linear:FROM:TO:COUNT, log:FROM:TO:COUNT, list:A,B,C, "
      "uniform:FROM:TO or normal:MEAN:SD; values may have units. Default: the "
      "scenario's sweep.vary"));
  command
      ->add_option("--combine", arguments->combine,
                   "grid: each value with each (default); zip: the first with the first")
      ->check(CLI::IsMember({"grid", "zip"}));
  command->add_option("--samples", arguments->samples, "cases to draw for uniform and normal")
      ->check(CLI::Range(1.0, 9007199254740992.0));
  command->add_option("--seed", arguments->seed, "of what is drawn; default: 1")
      ->check(CLI::Range(0.0, 9007199254740992.0));
  may_be_repeated(*command->add_option(
      "--measure", arguments->measure,
      "NAME[,NAME...] instead of the default measures: min_, max_, rms_ or end_ and "
      "one of bbsim columns"));
  command->add_option("-o,--output", arguments->output,
                      "FILE.csv, FILE.h5, or - for CSV on standard output; default: the scenario's "
                      "name with -sweep.csv, in the current folder");
  command
      ->add_option("-j,--threads", arguments->threads,
                   "threads; default: as many as there are processors")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1024}));
  command->add_option("--shard", arguments->shard,
                      "K/N: only part K of N, from 1; `bbsim merge` puts the parts together");
  command->add_flag("--resume", arguments->resume, "go on with a sweep that did not end");
  command->add_flag("--keep-trajectories", arguments->keep_trajectories,
                    "keep the output rows of each case too (HDF5)");
  command->add_option("--error", arguments->error,
                      "bound on the error of x and y at all output times of each case");
  command->callback([arguments, &options, &chosen] {
    chosen = [arguments, &options] { return sweep(*arguments, options); };
  });
}

}  // namespace bbsim::app
