// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/check_run.hpp"

#include <utility>

#include "base/real.hpp"
#include "solve/radau/radau.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {
namespace {

// Cuts each interval between two stops into equal parts, and ends a step at each cut.
class DividedStepper : public radau::RadauStepper {
 public:
  DividedStepper(const model::Model& model, CheckRun how, Tolerances tolerances, double end)
      : RadauStepper(model, radau::choose_kernels(), how.stages, tolerances, end),
        parts_(how.parts),
        most_steps_(how.most_steps) {}

  void start(double t, const double* z) override {
    limit_ = no_number;  // the next step() begins a new interval
    RadauStepper::start(t, z);
  }

  std::optional<Failure> step(double limit) override {
    if (statistics().steps >= most_steps_) {
      return Failure{Why::too_slow, "the check takes too many steps"};
    }
    if (limit != limit_) {
      limit_ = limit;
      from_ = time();
      part_ = 1;
    }
    while (part_ < parts_ && time() >= part_end()) ++part_;
    return RadauStepper::step(part_ < parts_ ? part_end() : limit);
  }

 private:
  [[nodiscard]] double part_end() const { return from_ + (limit_ - from_) * part_ / parts_; }

  int parts_, part_ = 1;
  std::size_t most_steps_;
  double limit_ = 0, from_ = 0;  // s
};

}  // namespace

Outcome integrate_check_run(const model::Model& model, CheckRun how, Tolerances tolerances,
                            const OutputGrid& grid, StateSink& sink, const Watch& watch) {
  const auto run = [&] {
    if (model.hybrid()) {
      const auto make_stepper = [&](const model::Model& of) {
        return std::make_unique<DividedStepper>(of, how, tolerances, grid.end());
      };
      return begin_hybrid(model, make_stepper, tolerances, grid, sink, watch)->advance().value();
    }
    DividedStepper stepper(model, how, tolerances, grid.end());
    return run_through(stepper, model, grid, sink, watch);
  };
  Outcome outcome = run();
  outcome.method = Method::radau;
  return outcome;
}

}  // namespace bbsim::solve
