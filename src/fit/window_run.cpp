// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "fit/window_run.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "model/model.hpp"
#include "record/rows.hpp"
#include "solve/integrate.hpp"
#include "solve/piece.hpp"

namespace bbsim::fit {
namespace {

// Collects rows of a run at given times.
class RowsAtTimes : public solve::StateSink, public solve::PieceSink {
 public:
  RowsAtTimes(const std::vector<double>& times, std::size_t row_size)
      : times_(times), row_size_(row_size), rows_(times.size() * row_size) {}

  void accept(std::size_t, std::size_t, const double*) override {}
  [[nodiscard]] PieceSink* pieces() override { return this; }
  [[nodiscard]] bool wants_rows() const override { return false; }

  void begin_run() override { next_ = 0; }
  void accept(const solve::Piece& piece) override {
    const std::size_t first = next_;
    asked_.clear();
    for (; next_ < times_.size() && times_[next_] <= piece.to(); ++next_) {
      asked_.push_back(std::max(times_[next_], piece.from()));
    }
    if (!asked_.empty()) piece.evaluate(asked_.data(), asked_.size(), &rows_[first * row_size_]);
  }

  [[nodiscard]] bool all() const { return next_ == times_.size(); }
  [[nodiscard]] const double* rows() const { return rows_.data(); }

 private:
  const std::vector<double>& times_;
  std::size_t row_size_;
  std::vector<double> rows_, asked_;
  std::size_t next_ = 0;
};

}  // namespace

Scenario prepared(Scenario scenario) {
  Events& events = scenario.events;
  if (events.slip && !events.slip->sliding) events.slip.reset();
  events.edge.reset();
  events.lift_off.reset();
  events.tilt.reset();
  events.singularity.reset();
  events.rest.reset();
  events.stick.reset();
  scenario.solver.error.reset();
  scenario.solver.rtol = std::min(scenario.solver.rtol, 1e-10);
  scenario.solver.atol = std::min(scenario.solver.atol, 1e-12);
  scenario.source = {};  // each run copies the scenario
  scenario.remarks.clear();
  return scenario;
}

bool begins_anywhere(const Scenario& scenario) {
  return !scenario.gimbal.motion && commands_of(scenario) == nullptr;
}

Start start_of(const Scenario& scenario) {
  const Ball& ball = scenario.ball;
  const GimbalStart& gimbal = scenario.gimbal.start;
  return {ball.position[0], ball.position[1], ball.velocity[0],  ball.velocity[1], gimbal.phi,
          gimbal.theta,     gimbal.phi_rate,  gimbal.theta_rate, ball.spin};
}

std::vector<double> run_window(const Scenario& scene, const Start& start,
                               const std::vector<double>& times,
                               const std::vector<const scenario::Column*>& columns,
                               std::string& why) {
  Scenario begun = scene;
  begun.ball.position = {start[0], start[1]};
  begun.ball.velocity = {start[2], start[3]};
  begun.ball.spin = start[8];
  if (begins_anywhere(scene)) begun.gimbal.start = {start[4], start[5], start[6], start[7]};
  std::optional<model::Model> assembled;
  try {
    assembled = model::assemble(begun, scenario::integrals_for(columns));
  } catch (const InputError& error) {
    why = error.what();
    return {};
  }
  const model::Model& model = *assembled;
  RowsAtTimes sink(times, model.row_size());
  // End slightly beyond the last row, so that rounding keeps it within the run.
  const double end = times.back() * (1 + 1e-9) + 1e-9;
  const solve::OutputGrid grid({end, end});
  const solve::Outcome outcome = solve::integrate(
      model, begun.solver.method, {begun.solver.rtol, begun.solver.atol}, grid, sink);
  if (outcome.ending != solve::Ending::done || !sink.all()) {
    why = outcome.reason.empty() ? "the run does not reach the window's end" : outcome.reason;
    return {};
  }
  const model::BallConstants constants = model::constants_of(begun);
  record::Rows rows(columns);
  rows.begin(model, constants);
  rows.evaluate(times.data(), sink.rows(), times.size());
  std::vector<double> values;
  values.reserve(columns.size() * times.size());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    values.insert(values.end(), rows[c], rows[c] + times.size());
  }
  if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) {
    why = "the motion is beyond the range of doubles";
    return {};
  }
  return values;
}

}  // namespace bbsim::fit
