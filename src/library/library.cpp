// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The public library, include/bbsim/bbsim.hpp, on top of api/, in the inline namespace v0.
#include <Eigen/Core>
#include <algorithm>
#include <utility>

#include "api/check.hpp"
#include "api/run.hpp"
#include "api/stepped_run.hpp"
#include "api/sweep.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "file/outputs.hpp"
#include "scenario/family.hpp"
#include "scenario/measures.hpp"

namespace bbsim::house {
using Scenario = bbsim::Scenario;
}

#include "bbsim/bbsim.hpp"

namespace bbsim {
inline namespace v0 {

std::string_view library_version() noexcept {
  return BBSIM_VERSION;
}

Error::~Error() = default;
FileError::~FileError() = default;
ControllerError::~ControllerError() = default;
ScenarioError::ScenarioError(const std::string& text, std::vector<Fault> faults)
    : Error(text), faults_(std::move(faults)) {}
ScenarioError::~ScenarioError() = default;

namespace {

// Does the work and turns internal exceptions into public ones.
template <class Work>
auto guarded(const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    std::vector<Fault> faults;
    for (const Problem& problem : error.problems()) {
      const KeyAndHint found = key_and_hint(problem.message);
      faults.push_back({problem.where, problem.message, found.key, found.hint});
    }
    throw ScenarioError(error.what(), std::move(faults));
  } catch (const OutputError& error) {
    throw FileError(error.what());
  } catch (const model::ControllerFault& fault) {
    throw ControllerError(fault.what());
  }
}

[[noreturn]] void refuse(const std::string& message) {
  const KeyAndHint found = key_and_hint(message);
  throw ScenarioError(message, {{"", message, found.key, found.hint}});
}

// What the pointer of a Scenario or Stepper points to. It is null after a move.
template <class State>
State& present(const std::unique_ptr<State>& state) {
  if (!state) refuse("found an object that was moved from; allowed: one that has a value");
  return *state;
}

class Watch : public api::Watch {
 public:
  explicit Watch(std::function<bool(double)> goes_on) : goes_on_(std::move(goes_on)) {}

  void update(double fraction, const std::string& /*detail*/) override {
    if (goes_on_ && !goes_on_(fraction)) stop_ = true;
  }
  [[nodiscard]] const std::atomic<bool>* stop() override { return &stop_; }

 private:
  std::function<bool(double)> goes_on_;
  std::atomic<bool> stop_{false};
};

}  // namespace

struct Scenario::State {
  Source source;
  bool is_file = false;

  [[nodiscard]] ScenarioFamily family() const { return ScenarioFamily(source); }
};

Scenario::Scenario(std::unique_ptr<State> state) : state_(std::move(state)) {}
Scenario::Scenario(const Scenario& other)
    : state_(other.state_ ? std::make_unique<State>(*other.state_) : nullptr) {}
Scenario::Scenario(Scenario&&) noexcept = default;
Scenario& Scenario::operator=(const Scenario& other) {
  return *this = Scenario(other);
}
Scenario& Scenario::operator=(Scenario&&) noexcept = default;
Scenario::~Scenario() = default;

Scenario Scenario::from_file(const std::string& file) {
  return guarded([&] {
    return Scenario(std::make_unique<State>(State{ScenarioFamily(file, {}).source(), true}));
  });
}

Scenario Scenario::from_text(const std::string& text, const std::string& name) {
  return guarded([&] {
    return Scenario(
        std::make_unique<State>(State{ScenarioFamily(Source{name, text, {}}).source(), false}));
  });
}

Scenario& Scenario::set(const std::string& key, const std::string& value) {
  present(state_).source.overrides.push_back(key + '=' + value);
  return *this;
}

Scenario& Scenario::set(const std::string& key, double value) {
  return set(key, number_text(value));
}

const Scenario::State& Scenario::state() const {
  return present(state_);
}

std::string Scenario::check() const {
  return guarded([&] {
    Watch watch({});
    return to_text(api::check(state().family().itself(), watch));
  });
}

namespace {

// Passes rows to the sink one by one.
struct RowSink {
  std::function<void(std::span<const double>)> sink;
  std::vector<double> row{};

  void operator()(std::span<const double* const> columns, std::size_t rows) {
    row.resize(columns.size());
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c) row[c] = columns[c][r];
      sink(row);
    }
  }
};

api::RunRequest request_of(const Scenario& scenario, const RunOptions& options) {
  const Scenario::State& state = scenario.state();
  const ScenarioFamily family = state.family();
  api::RunRequest request;
  request.scenario = family.itself();
  request.inputs = family.inputs();
  request.measures = options.measures;
  request.keeps_rows = options.keep_rows;
  if (options.sink) {
    request.rows_to = RowSink{options.sink};
  } else if (!options.keep_rows) {
    request.rows_to = [](auto&&...) {};
  }
  if (!options.file.empty()) {
    file::Outputs outputs;
    api::reads_scenario(outputs, state.is_file ? state.source.file : "", request.scenario);
    outputs.writes(options.file, "file");
    request.output = options.file;
  }
  return request;
}

Status status_of(const std::string& word) {
  return word == "done"      ? Status::done
         : word == "stopped" ? Status::stopped
         : word == "failed"  ? Status::failed
         : word == "refused" ? Status::refused
                             : Status::interrupted;
}

Result result_of(api::RunResult run) {
  Result result;
  result.status = status_of(run.summary.status);
  result.summary = record::to_json(run.summary);
  result.reason = std::move(run.summary.reason);
  result.columns = std::move(run.columns);
  result.units = std::move(run.units);
  for (file::Column& column : run.rows.columns) {
    result.values.push_back(std::move(column.numbers));
  }
  result.measures = std::move(run.summary.measures);
  result.warnings = std::move(run.summary.warnings);
  return result;
}

std::size_t place_in(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) refuse("there is no column " + std::string(name));
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

const std::vector<double>& Result::column(std::string_view name) const {
  const std::size_t place = place_in(columns, name);
  if (place >= values.size()) refuse("found no rows; allowed: RunOptions::keep_rows");
  return values[place];
}

Result run(const Scenario& scenario, const RunOptions& options) {
  return guarded([&] {
    Watch watch(options.goes_on);
    return result_of(api::run(request_of(scenario, options), watch));
  });
}

struct Stepper::State {
  std::optional<api::SteppedRun> run;
  Sample sample;

  void copy_sample() {
    const api::Sample& of = run->sample();
    sample = {of.number,
              of.t,
              of.ball,
              of.reference,
              of.reference_rate,
              of.reference_acceleration,
              {of.servo[0], of.servo[1]},
              {of.servo_rate[0], of.servo_rate[1]}};
  }
};

Stepper::Stepper(const Scenario& scenario, const RunOptions& options)
    : state_(std::make_unique<State>()) {
  guarded([&] {
    api::RunRequest request = request_of(scenario, options);
    const house::Scenario its = std::move(request.scenario);
    state_->run.emplace(its, std::move(request));
    state_->copy_sample();
  });
}
Stepper::~Stepper() = default;
Stepper::Stepper(Stepper&&) noexcept = default;
Stepper& Stepper::operator=(Stepper&&) noexcept = default;

bool Stepper::is_over() const {
  return present(state_).run->is_over();
}

const Sample& Stepper::sample() const {
  return present(state_).sample;
}

void Stepper::step(const Command& command) {
  if (is_over()) refuse("the run is over; allowed: result()");
  State& state = *state_;  // which the run's own sink may move away
  guarded([&] {
    state.run->step(command);
    state.copy_sample();
  });
}

Result Stepper::result() const {
  if (!is_over()) refuse("the run is not over; allowed: step()");
  return result_of(state_->run->result());
}

Table sweep(const Scenario& scenario, const SweepOptions& options) {
  return guarded([&] {
    const ScenarioFamily family = scenario.state().family();
    api::SweepChoice choice{{}, {}, options.samples, options.seed, options.measures};
    for (const auto& [key, spec] : options.vary) choice.vary.push_back({key, spec});
    if (!options.vary.empty()) choice.combine = options.zip ? "zip" : "grid";
    api::SweepRequest request{scenario.state().source.file, &family,
                              api::with_choice(family.read_sweep(), choice)};
    request.threads = static_cast<double>(options.threads);
    Watch watch(options.goes_on);
    api::SweepResult sweep_result = api::sweep(request, watch);
    Table table;
    table.complete = sweep_result.code == ExitCode::done;
    for (file::Column& column : sweep_result.table.columns) {
      table.columns.push_back({std::move(column.name), std::move(column.unit),
                               std::move(column.numbers), std::move(column.texts)});
    }
    return table;
  });
}

const Table::Column& Table::column(std::string_view name) const {
  const auto found = std::ranges::find(columns, name, &Column::name);
  if (found == columns.end()) refuse("there is no column " + std::string(name));
  return *found;
}

Cases simulate(const Scenario& scenario, std::size_t count, const std::vector<CaseKey>& keys,
               const SimulateOptions& options) {
  return guarded([&] {
    const ScenarioFamily family = scenario.state().family();
    api::CasesRequest request{family, count};
    for (const CaseKey& key : keys) request.keys.push_back({key.key, key.numbers, key.texts});
    request.columns = options.columns;
    request.measures = options.measures;
    if (options.times) {
      const std::size_t each = options.own_times ? std::max<std::size_t>(count, 1) : 1;
      if (options.times->size() % each != 0) {
        refuse("times: found " + std::to_string(options.times->size()) + "; allowed: as many for " +
               "each of " + std::to_string(count) + " cases");
      }
      request.times = {*options.times, options.times->size() / each, options.own_times};
    }
    request.windows = {options.begin, options.end, options.start, options.events};
    request.threads = static_cast<double>(options.threads);
    Watch watch(options.goes_on);
    api::CasesResult cases_result = api::run_cases(request, watch);
    Cases cases{cases_result.times,
                std::move(cases_result.columns),
                std::move(cases_result.measures),
                {},
                {}};
    for (sweep::CaseStatus& status : cases_result.status) {
      cases.status.push_back(status_of(status.word));
      cases.reason.push_back(std::move(status.reason));
    }
    return cases;
  });
}

LinearSystem linearize(const Scenario& scenario, const std::string& kind, const std::string& at) {
  return guarded([&] {
    api::LinearizeRequest request{scenario.state().family().itself(), api::kind_named(kind), at};
    Watch watch({});
    const api::Linearized linearized = api::linearize(request, watch);
    if (!linearized.reason.empty()) refuse(linearized.reason);
    const model::LinearSystem& its = linearized.linearization.system;
    const auto rows = [](const Eigen::MatrixXd& matrix) {
      std::vector<std::vector<double>> all;
      for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
        std::vector<double>& row = all.emplace_back();
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) row.push_back(matrix(i, j));
      }
      return all;
    };
    const auto names = [](const std::vector<model::LinearSignal>& signals) {
      std::vector<std::string> all;
      for (const model::LinearSignal& signal : signals) all.push_back(signal.name);
      return all;
    };
    return LinearSystem{names(its.states), names(its.inputs), names(its.outputs),
                        rows(its.a),       rows(its.b),       rows(its.c),
                        rows(its.d),       its.period,        api::file_text(linearized, ".json")};
  });
}

}  // namespace v0
}  // namespace bbsim
