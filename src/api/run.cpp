// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/run.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <utility>

#include "api/assemble.hpp"
#include "api/replay.hpp"
#include "api/run_sensitivity.hpp"
#include "api/simulation.hpp"
#include "base/number_text.hpp"
#include "controller/host.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "file/memory_table.hpp"
#include "scenario/expectation.hpp"

namespace bbsim::api {
namespace {

using Columns = std::vector<const scenario::Column*>;

// Records in `result` which expectations hold; `places` has the place of each one's measure.
void judge(const std::vector<scenario::Expectation>& expectations,
           const std::vector<std::size_t>& places, const Simulation& simulation,
           RunResult& result) {
  for (std::size_t i = 0; i < expectations.size(); ++i) {
    const scenario::Expectation& expectation = expectations[i];
    const std::size_t at = places[i];
    const double value = simulation.measures[at];
    const bool holds = expectation.holds(value);
    result.summary.expectations.push_back({expectation.text, value, holds});
    if (holds) continue;
    const std::string unit = expectation.measure.unit();
    const char* const why = simulation.whys[at];
    result.unmet.push_back(
        "not as expected: " + expectation.text + ": " + expectation.measure.name + " is " +
        (std::isnan(value) ? "not a number" + (why != nullptr ? std::string(": ") + why : "")
                           : number_text(value) + (unit == "1" ? "" : ' ' + unit)));
    if (result.code == ExitCode::done) result.code = ExitCode::ended_early;
  }
}

// Columns of the rows, and those that measures use.
Columns needed_for(Columns columns, const std::vector<scenario::Measure>& measures) {
  for (const scenario::Measure& measure : measures) {
    if (measure.column != nullptr) columns.push_back(measure.column);
    if (measure.instant.column != nullptr) columns.push_back(measure.instant.column);
  }
  return columns;
}

// These columns, followed by others that a picture of the scene needs.
Columns with_pictured(const Columns& columns, const Scenario& scenario) {
  std::vector<std::string> names{"t",       "x",       "y",       "phi",    "theta",
                                 "ball_qw", "ball_qx", "ball_qy", "ball_qz"};
  if (scenario.controller) {
    for (const char* name : {"x_reference", "y_reference", "phi_command", "theta_command"}) {
      names.emplace_back(name);
    }
    if (scenario.controller->sampling) {
      names.emplace_back("x_measured");
      names.emplace_back("y_measured");
    }
  }
  Columns all = columns;
  for (const scenario::Column* column : scenario::columns_named(names)) {
    if (std::ranges::find(all, column) == all.end()) all.push_back(column);
  }
  return all;
}

file::ColumnHeader header_of(const scenario::Column& column) {
  return {column.name, column.unit, column.meaning};
}

std::vector<file::ColumnHeader> headers_of(const Columns& columns) {
  std::vector<file::ColumnHeader> headers;
  headers.reserve(columns.size());
  for (const scenario::Column* column : columns) headers.push_back(header_of(*column));
  return headers;
}

// Writes the first `count` columns of the table, then the others.
void append(const file::Table& table, std::size_t count,
            const std::vector<std::vector<double>>& others, file::TableWriter& writer) {
  std::vector<const double*> columns;
  for (std::size_t c = 0; c < count; ++c) columns.push_back(table.columns[c].numbers.data());
  for (const std::vector<double>& column : others) columns.push_back(column.data());
  writer.append(columns, table.rows);
}

// Passes rows to a callback and, if given, to a second table.
class RowsTo : public file::TableWriter {
 public:
  RowsTo(const RunRequest& request, std::size_t requested, file::TableWriter* next)
      : request_(request), requested_(requested), next_(next) {}

  void append(std::span<const double* const> columns, std::size_t rows) override {
    if (request_.rows_to) request_.rows_to(columns.first(requested_), rows);
    if (next_ != nullptr) next_->append(columns, rows);
  }
  void finish(const file::Attributes&) override {}

 private:
  const RunRequest& request_;
  std::size_t requested_;
  file::TableWriter* next_;
};

// Declares the files that a scenario names.
void reads_parts(file::Outputs& outputs, const Scenario& scenario) {
  for (const auto& [key, path] : scenario.tables) outputs.reads(path, "a table of the scenario");
  for (const std::string& file : controller::files_of(scenario)) {
    outputs.reads(file, "the scenario's controller");
  }
}

// Names of rows and measures, checked before a controller starts and a file is opened.
struct Wanted {
  Columns requested;  // of output.columns
  Columns columns;    // followed by others that a picture needs
  std::vector<scenario::Measure> printed;
  std::vector<scenario::Expectation> expectations;
  std::vector<scenario::Measure> measures;  // `printed`, followed by those of expectations
  std::vector<std::size_t> expected;        // the place of each expectation's measure

  explicit Wanted(const RunRequest& request)
      : requested(scenario::columns_named(request.scenario.output.columns)),
        columns(request.pictured ? with_pictured(requested, request.scenario) : requested),
        printed(scenario::measures_named(scenario::split_measures(request.measures),
                                         request.scenario)) {
    for (const std::string& text : request.expect) {
      expectations.push_back(scenario::read_expectation("--expect", text, request.scenario));
    }
    measures = printed;
    expected = scenario::add_expected(measures, expectations);
  }
};

}  // namespace

struct PausingRun::State {
  State(const RunRequest& of, Watch& its)
      : request(of),
        watch(its),
        scenario(of.scenario),
        wanted(of),
        sensitivity(of, wanted.requested, wanted.printed),
        headers(checked_headers()),
        host(make_host(watch)),
        model(assemble(scenario, needed_for(wanted.columns, wanted.measures), host)),
        grid(scenario.time) {
    for (std::size_t c = 0; c < wanted.requested.size(); ++c) {
      const scenario::Column& column = *wanted.requested[c];
      if (column.needs != scenario::Needs::own) continue;
      headers[c].unit = units.emplace_back(host.unit_of(column.name).value_or("1"));
    }
    request.ready();
    if (!request.output.empty()) writer = file::open_table(request.output, headers);
    if (!request.summary.empty()) summary_file.emplace(request.summary);
    if (writer) writer->keep(request.inputs);
    const std::size_t requested = wanted.requested.size();
    // Derivatives are known only after the last row.
    file::TableWriter* const beside = sensitivity.wanted() ? nullptr : writer.get();
    if (request.pictured || request.keeps_rows || sensitivity.wanted() ||
        (!writer && !request.rows_to)) {
      kept.emplace(scenario::names_of(wanted.columns), beside, requested);
    }
    rows.emplace(request, requested, kept ? &*kept : beside);
    with_places(scenario, [&] {
      simulated.emplace(scenario, model, grid,
                        RowsAndMeasures{wanted.columns, requested, wanted.measures}, *rows, watch);
    });
  }

  [[nodiscard]] std::vector<file::ColumnHeader> checked_headers() const {
    std::vector<file::ColumnHeader> all = headers_of(wanted.requested);
    sensitivity.add_headers(all);
    if (!request.output.empty()) file::require_table_name(request.output);
    if (request.replaces_its_like_only) {
      file::require_like(request.output, file::table_with(file::csv_header(all)));
    }
    return all;
  }

  [[nodiscard]] RunResult finish();

  const RunRequest& request;
  Watch& watch;
  const Scenario& scenario;
  Wanted wanted;
  Sensitivity sensitivity;
  std::vector<file::ColumnHeader> headers;
  controller::Host host;
  model::Model model;
  solve::OutputGrid grid;
  std::deque<std::string> units;  // from the scene's own controller
  std::unique_ptr<file::TableWriter> writer;
  std::optional<file::AtomicFile> summary_file;
  std::optional<file::MemoryTable> kept;
  std::optional<RowsTo> rows;
  std::optional<SimulatedRun> simulated;
};

RunResult PausingRun::State::finish() {
  Simulation simulation = with_places(scenario, [&] {
    Simulation of = simulated->finish();
    if (of.result.code == ExitCode::done) host.require_printed();
    return of;
  });
  RunResult result = std::move(simulation.result);
  record::RunSummary& summary = result.summary;
  summary.output = request.output;
  if (const std::string unheard = host.unheard(); !unheard.empty()) {
    summary.warnings.push_back("warning: " + unheard);
  }
  const std::string remark = host.line_remark();
  if (!remark.empty() && result.code == ExitCode::done) {
    summary.warnings.push_back("warning: " + remark);
  }
  for (std::size_t m = 0; m < wanted.printed.size(); ++m) {
    summary.measures.emplace_back(wanted.printed[m].name, simulation.measures[m]);
  }
  file::Table table;
  if (kept) table = kept->take();
  std::vector<std::vector<double>> derivatives;
  if (sensitivity.wanted()) {
    derivatives = sensitivity.find(result, watch);
    if (writer) append(table, wanted.requested.size(), derivatives, *writer);
  }
  for (const file::ColumnHeader& header : headers) {
    result.columns.emplace_back(header.name);
    result.units.emplace_back(header.unit);
  }
  judge(wanted.expectations, wanted.expected, simulation, result);
  result.rows_requested = grid.size();
  if (writer && summary.error_estimate) {
    writer->add_column(header_of(scenario::position_error), simulation.row_estimates);
  }
  // If the controller failed to begin, there are no rows, and the file of an earlier run stays.
  if (writer && summary.rows > 0) {
    writer->finish(record::to_attributes(summary, scenario.source.text));
  }
  if (summary_file) {
    summary_file->write(record::to_json(summary));
    summary_file->commit();
  }
  host.finish();
  if (request.pictured) {
    result.pictured =
        run_of(scenario, std::move(table), summary, simulation.end_row, request.checked);
  } else if (kept) {
    result.rows = std::move(table);
    for (std::size_t c = 0; c < derivatives.size(); ++c) {
      result.rows.columns.push_back({sensitivity.names()[c], std::move(derivatives[c])});
    }
  }
  return result;
}

PausingRun::PausingRun(const RunRequest& request, Watch& watch)
    : state_(std::make_unique<State>(request, watch)) {}
PausingRun::~PausingRun() = default;

bool PausingRun::advance() {
  return with_places(state_->scenario, [this] { return state_->simulated->advance(); });
}

RunResult PausingRun::finish() {
  return state_->finish();
}

RunResult run(const RunRequest& request, Watch& watch) {
  PausingRun run(request, watch);
  run.advance();
  return run.finish();
}

void reads_scenario(file::Outputs& outputs, const std::string& file, const Scenario& scenario) {
  outputs.reads(file, "the scenario");
  reads_parts(outputs, scenario);
}

void reads_with_result(file::Outputs& outputs, const results::Result& result) {
  if (!result.beside.empty()) outputs.reads(result.beside, "the summary of " + result.file);
  if (result.scenario) reads_parts(outputs, *result.scenario);
}

}  // namespace bbsim::api
