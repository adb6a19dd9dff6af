#include "study/sweep/single.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "model/model.hpp"
#include "solve/choose.hpp"
#include "solve/collocation/radau.hpp"
#include "solve/integrate.hpp"
#include "study/error_control.hpp"
#include "study/sweep/case_scenario.hpp"
#include "study/sweep/track_meter.hpp"

namespace bbsim::study {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

std::string seconds(double t) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g s", t);
  return text;
}

// Of a row of results, and of the status column: without commas.
std::string status_of(const solve::Outcome& outcome) {
  switch (outcome.ending) {
    case solve::Ending::failed:
      return "failed at " + seconds(outcome.reached) + ": " + outcome.reason;
    case solve::Ending::stopped:
      return "stopped at " + seconds(outcome.reached) + ": " + outcome.occurrences.back().name;
    case solve::Ending::done:
    case solve::Ending::interrupted:
      break;
  }
  return "done";
}

// Passes rows on to two sinks.
class Both : public solve::StateSink {
 public:
  Both(solve::StateSink& one, solve::StateSink& other) : one_(one), other_(other) {}
  void accept(std::size_t first, std::size_t count, const double* values) override {
    one_.accept(first, count, values);
    other_.accept(first, count, values);
  }

 private:
  solve::StateSink &one_, &other_;
};

// Columns of one case's rows into its place among the results.
class SeriesSink : public solve::StateSink {
 public:
  SeriesSink(const SweepTask& task, const model::Model& model,
             const model::BallConstants& constants, const solve::OutputGrid& grid,
             CaseResults& into, std::size_t place)
      : task_(task),
        model_(model),
        constants_(constants),
        grid_(grid),
        into_(into),
        start_(place * task.series_rows),
        dynamics_(
            std::any_of(task.series.begin(), task.series.end(), [](const record::Column* column) {
              return column->needs == record::Needs::dynamics ||
                     column->needs == record::Needs::plate;
            })) {}

  void accept(std::size_t first, std::size_t count, const double* values) override {
    for (std::size_t i = 0; i < count; ++i) {
      const model::Sample sample = model_.sample(grid_[first + i], values + i * model_.row_size());
      const model::Dynamics dynamics =
          dynamics_ ? model::dynamics(sample, constants_) : model::Dynamics{};
      for (std::size_t c = 0; c < task_.series.size(); ++c) {
        into_.series[c][start_ + first + i] = task_.series[c]->value({sample, &dynamics});
      }
    }
  }

 private:
  const SweepTask& task_;
  const model::Model& model_;
  const model::BallConstants& constants_;
  const solve::OutputGrid& grid_;
  CaseResults& into_;
  std::size_t start_;
  bool dynamics_;
};

class SingleRunner : public CaseRunner {
 public:
  explicit SingleRunner(const SweepTask& task)
      : task_(task),
        scenario_(task),
        meter_(task.measures),
        track_(task.measures),
        kernels_(solve::collocation::choose_kernels()),
        quick_(task.series.empty() && are_track_measures(task.measures)),
        same_signals_(shares_signals(task.plan)) {
    const auto needs = [](const record::Column* column) {
      return column->needs == record::Needs::gamma;
    };
    for (const Axis& axis : task.plan.axes()) {
      if (axis.key.starts_with("solver")) same_tolerances_ = false;
    }
    gamma_ = record::any_needs(task.measures, record::Needs::gamma) ||
             std::any_of(task.series.begin(), task.series.end(), needs);
  }

  std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                  const std::atomic<bool>& stop) override {
    into.first = first;
    into.resize(count, task_);
    for (std::size_t i = 0; i < count; ++i) {
      task_.plan.values(first + i, &into.values[i * task_.plan.axes().size()]);
      if (!run_case(first + i, i, into, stop)) return i;
    }
    return count;
  }

 private:
  bool run_case(std::size_t number, std::size_t place, CaseResults& into,
                const std::atomic<bool>& stop) {
    double* const numbers = &into.numbers[place * (1 + task_.measures.size())];
    std::string& status = into.status[place];
    try {
      const Scenario& scenario =
          scenario_.at(number, &into.values[place * task_.plan.axes().size()]);
      const model::Model model = model::assemble(scenario, gamma_);
      const model::BallConstants constants = model::constants_of(scenario);
      const solve::OutputGrid grid(scenario.time);
      const Solver& solver = scenario.solver;
      if (quick_ && !solver.error && solve::choose_method(solver.method) == Method::radau &&
          has_track(model)) {
        return run_quickly(scenario, model, constants, grid, stop, numbers, status);
      }
      meter_.begin(model, constants, grid);
      SeriesSink series(task_, model, constants, grid, into, place);
      Both both(meter_, series);
      solve::StateSink& sink = task_.series.empty() ? static_cast<solve::StateSink&>(meter_) : both;
      const solve::Watch watch{&stop, {}};
      solve::Outcome outcome;
      if (scenario.solver.error) {
        const ErrorControlled run = integrate_to_error(model, scenario.solver.method,
                                                       *scenario.solver.error, grid, sink, watch);
        status = status_of(run.outcome);
        if (status == "done" && !run.met) {
          char text[80];
          std::snprintf(text, sizeof text, "error about %.2g m: out of reach of double precision",
                        run.estimate);
          status = text;
        }
        outcome = run.outcome;
      } else {
        outcome =
            solve::integrate(model, solver.method, {solver.rtol, solver.atol}, grid, sink, watch);
        status = status_of(outcome);
      }
      if (outcome.ending == solve::Ending::interrupted) return false;
      numbers[0] = outcome.reached;
      meter_.finish(outcome, numbers + 1);
      for (std::size_t m = 0; m < task_.measures.size(); ++m) {
        if (record::why_missing(*task_.measures[m].column, scenario) != nullptr) {
          numbers[1 + m] = nothing;
        }
      }
    } catch (const InputError& error) {  // there is no gain of an LQR, say
      std::fill_n(numbers, 1 + task_.measures.size(), nothing);
      status = std::string("refused: ") + error.what();
    }
    return true;
  }

  // What solve::integrate does with a smooth model, without looking at each row by itself.
  bool run_quickly(const Scenario& scenario, const model::Model& model,
                   const model::BallConstants& constants, const solve::OutputGrid& grid,
                   const std::atomic<bool>& stop, double* numbers, std::string& status) {
    const solve::Tolerances tolerances{scenario.solver.rtol, scenario.solver.atol};
    track_.begin(model, constants, grid, same_signals_);
    if (stepper_ && same_tolerances_) {
      stepper_->renew(model, grid.end());
    } else {
      stepper_.emplace(model, kernels_, solve::collocation::choose_stages(tolerances.rtol),
                       tolerances, grid.end());
    }
    stepper_->leave_out_velocities(track_.wants_positions_only(model));
    const solve::Outcome outcome = solve::run_through(*stepper_, model, grid, track_, {&stop, {}});
    if (outcome.ending == solve::Ending::interrupted) return false;
    numbers[0] = outcome.reached;
    track_.finish(numbers + 1);
    status = status_of(outcome);
    return true;
  }

  const SweepTask& task_;
  CaseScenario scenario_;
  record::Meter meter_;
  TrackMeter track_;
  const solve::collocation::KernelSet& kernels_;
  std::optional<solve::collocation::RadauStepper> stepper_;  // its memory, from case to case
  bool quick_, same_signals_, same_tolerances_ = true;
  bool gamma_ = false;
};

}  // namespace

void CaseResults::resize(std::size_t cases, const SweepTask& task) {
  count = cases;
  values.resize(cases * task.plan.axes().size());
  numbers.resize(cases * (1 + task.measures.size()));
  status.resize(cases);
  series.resize(task.series.size());
  for (auto& column : series) column.assign(cases * task.series_rows, nothing);
}

void CaseResults::cut(std::size_t cases, const SweepTask& task) {
  count = cases;
  values.resize(cases * task.plan.axes().size());
  numbers.resize(cases * (1 + task.measures.size()));
  status.resize(cases);
  for (auto& column : series) column.resize(cases * task.series_rows);
}

std::unique_ptr<CaseRunner> single_runner(const SweepTask& task) {
  return std::make_unique<SingleRunner>(task);
}

}  // namespace bbsim::study
