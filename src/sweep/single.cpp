// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs cases one by one, each with the integrator of `bbsim run`.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "base/error.hpp"
#include "base/real.hpp"
#include "controller/host.hpp"
#include "model/model.hpp"
#include "record/recorder.hpp"
#include "solve/integrate.hpp"
#include "study/error_control.hpp"
#include "sweep/runners.hpp"

namespace bbsim::sweep {
namespace {

// Omits the end time, which has its own column.
CaseStatus status_of(const solve::Outcome& outcome) {
  switch (outcome.ending) {
    case solve::Ending::failed:
      return {"failed", outcome.reason};
    case solve::Ending::stopped:
      return {"stopped", outcome.occurrences.back().name};
    case solve::Ending::done:
    case solve::Ending::interrupted:
      break;
  }
  return {};
}

class SingleRunner : public CaseRunner {
 public:
  explicit SingleRunner(const SweepTask& task)
      : task_(task), scenario_(task), recorder_({task.series, task.measures}) {
    integrals_ = scenario::integrals_for(task.series);
    integrals_.gamma |= scenario::any_needs(task.measures, scenario::Needs::gamma);
    integrals_.work |= scenario::any_needs(task.measures, scenario::Needs::work);
  }

  std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                  const std::atomic<bool>& stop) override {
    into.first = first;
    into.resize(count, task_);
    for (std::size_t i = 0; i < count; ++i) {
      task_.plan.values(first + i, into.values.data() + i * task_.plan.axes().size());
      if (!run_case(first + i, i, into, stop)) return i;
    }
    return count;
  }

 private:
  bool run_case(std::size_t number, std::size_t place, CaseResults& into,
                const std::atomic<bool>& stop) {
    double* const numbers = &into.numbers[place * (1 + task_.measures.size())];
    CaseStatus& status = into.status[place];
    try {
      const Scenario& scenario =
          scenario_.at(number, into.values.data() + place * task_.plan.axes().size());
      for (const scenario::Column* const column : task_.series) {
        const scenario::Missing lacks = scenario::missing(*column, scenario);
        if (lacks) throw InputError(std::string(column->name) + ": " + lacks.why);
      }
      model::Model model = model::assemble(scenario, integrals_);
      if (scenario.controller && scenario.controller->own) {
        if (!controllers_) controllers_.emplace(task_.report, &stop);
        controllers_->attach(scenario, model);
      }
      const model::BallConstants constants = model::constants_of(scenario);
      const double begin = task_.windows != nullptr ? task_.windows->begin_of(number) : 0;
      std::optional<TimedRows> timed;
      if (task_.times != nullptr) {
        timed = rows_at(task_.times->of(number), begin, begin + scenario.time.end);
      }
      const solve::OutputGrid grid = timed ? timed->grid : solve::OutputGrid(scenario.time);
      const Solver& solver = scenario.solver;
      SeriesWriter series(into.series, place * task_.series_rows, timed ? &*timed : nullptr);
      recorder_.begin(model, constants, grid, &series);
      const solve::Watch watch{&stop, {}};
      solve::Outcome outcome;
      if (solver.error) {
        const study::ErrorControlled run =
            study::integrate_to_error(model, solver.method, *solver.error, grid, recorder_, watch);
        status = status_of(run.outcome);
        if (run.outcome.ending == solve::Ending::done && !run.met) {
          char text[80];
          std::snprintf(text, sizeof text, "error about %.2g m: out of reach of double precision",
                        run.estimate);
          status = {"inaccurate", text};
        }
        outcome = run.outcome;
      } else {
        outcome = solve::integrate(model, solver.method, {solver.rtol, solver.atol}, grid,
                                   recorder_, watch);
        status = status_of(outcome);
      }
      if (outcome.ending == solve::Ending::interrupted) return false;
      numbers[0] = outcome.reached;
      recorder_.finish(outcome, numbers + 1);
      judge(task_, scenario, numbers + 1, status, recorder_.whys());
    } catch (const InputError& error) {  // for example, an LQR that has no gain
      std::fill_n(numbers, 1 + task_.measures.size(), no_number);
      status = {"refused", error.what()};
    }
    return true;
  }

  const SweepTask& task_;
  CaseScenario scenario_;
  record::Recorder recorder_;
  std::optional<controller::Host> controllers_;  // for cases with your own controller
  scenario::Integrals integrals_ = false;
};

}  // namespace

std::unique_ptr<CaseRunner> single_runner(const SweepTask& task) {
  return std::make_unique<SingleRunner>(task);
}

}  // namespace bbsim::sweep
