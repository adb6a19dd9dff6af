// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Computes measures of the loop, which need no run, alone or beside measures of the motion.
#include <algorithm>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/real.hpp"
#include "model/control/loop_analysis.hpp"
#include "sweep/runners.hpp"

namespace bbsim::sweep {
namespace {

class LoopRunner : public CaseRunner {
 public:
  LoopRunner(const SweepTask& task, std::unique_ptr<CaseRunner> motion)
      : task_(task),
        split_(scenario::split_loop_measures(task.measures)),
        scenario_(task),
        motion_(std::move(motion)) {
    for (const std::size_t place : split_.loop_places) loops_.push_back(task.measures[place]);
    parts_ = model::parts_of(loops_);
  }

  std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                  const std::atomic<bool>& stop) override {
    const std::size_t done = motion_ ? motion_->run(first, count, moved_, stop) : count;
    into.first = first;
    into.resize(count, task_);
    if (motion_) into.series = std::move(moved_.series);
    for (std::size_t i = 0; i < done; ++i) {
      if (stop.load(std::memory_order_relaxed)) return i;
      double* const values = into.values.data() + i * task_.plan.axes().size();
      task_.plan.values(first + i, values);
      double* const numbers = &into.numbers[i * (1 + task_.measures.size())];
      if (motion_) {
        take_motion(i, numbers, into.status[i]);
      } else {
        numbers[0] = no_number;
        into.status[i] = {};
      }
      take_loop(first + i, values, numbers + 1, into.status[i]);
    }
    return done;
  }

 private:
  void take_motion(std::size_t i, double* numbers, CaseStatus& status) {
    const double* const found = &moved_.numbers[i * (1 + split_.motion_places.size())];
    numbers[0] = found[0];
    for (std::size_t m = 0; m < split_.motion_places.size(); ++m) {
      numbers[1 + split_.motion_places[m]] = found[1 + m];
    }
    status = std::move(moved_.status[i]);
  }

  void take_loop(std::size_t number, const double* values, double* measures, CaseStatus& status) {
    results_.assign(loops_.size(), no_number);
    whys_.assign(loops_.size(), nullptr);
    if (status.word != "refused") {
      try {
        const Scenario& scenario = scenario_.at(number, values);
        const model::Model model = model::assemble(scenario, false);
        model::LoopAnalysis analysis(scenario, model, parts_);
        for (std::size_t m = 0; m < loops_.size(); ++m) {
          if (const scenario::Missing lacks = scenario::missing(loops_[m], scenario)) {
            whys_[m] = lacks.why;
            continue;
          }
          const model::LoopAnalysis::Value found = analysis.value_of(*loops_[m].loop);
          results_[m] = found.value;
          whys_[m] = found.why;
        }
      } catch (const InputError& error) {  // for example, an LQR that has no gain
        results_.assign(loops_.size(), no_number);
        status = {"refused", error.what()};
      }
    }
    for (std::size_t m = 0; m < loops_.size(); ++m) measures[split_.loop_places[m]] = results_[m];
    if (status.word != "done") return;
    const std::string why = scenario::why_not_finite(loops_, results_.data(), whys_);
    if (!why.empty()) status.reason += (status.reason.empty() ? "" : "; ") + why;
  }

  const SweepTask& task_;
  const scenario::SplitMeasures split_;
  std::vector<scenario::Measure> loops_;
  model::LoopParts parts_;
  CaseScenario scenario_;
  std::unique_ptr<CaseRunner> motion_;
  CaseResults moved_;
  std::vector<double> results_;
  scenario::Whys whys_;
};

}  // namespace

bool is_of_loop_only(const SweepTask& task) {
  return task.series.empty() && !task.measures.empty() &&
         std::ranges::all_of(task.measures, [](const scenario::Measure& measure) {
           return measure.kind == scenario::Measure::Kind::loop;
         });
}

SweepTask task_of_motion(const SweepTask& task) {
  SweepTask motion = task;
  motion.measures = scenario::split_loop_measures(task.measures).of_motion;
  return motion;
}

std::unique_ptr<CaseRunner> loop_runner(const SweepTask& task, std::unique_ptr<CaseRunner> motion) {
  return std::make_unique<LoopRunner>(task, std::move(motion));
}

}  // namespace bbsim::sweep
