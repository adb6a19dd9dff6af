#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "solve/pace.hpp"
#include "solve/piece.hpp"
#include "solve/row_block.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {
namespace {

class Step : public Piece {
 public:
  Step(Stepper& stepper, double from, double to)
      : Piece(from, to, stepper.parts()), stepper_(stepper) {}
  void evaluate(const double* times, std::size_t count, double* rows) const override {
    stepper_.evaluate(times, count, rows);
  }

 private:
  Stepper& stepper_;
};

}  // namespace

Outcome run_through(Stepper& stepper, const model::Model& model, const OutputGrid& grid,
                    StateSink& sink, const Watch& watch) {
  const std::size_t row_size = model.size() + (model.gamma ? 1 : 0);
  RowBlock rows(sink, row_size);
  double* const first = rows.next();
  std::copy(model.initial.begin(), model.initial.end(), first);
  if (model.gamma) first[model.size()] = 0;

  PieceSink* const pieces = sink.pieces();
  if (pieces != nullptr) pieces->begin_run();
  const bool with_rows = sink.wants_rows();

  Outcome outcome;
  Pace pace(grid.end());
  const auto fail = [&](std::string reason) {
    outcome.ending = Ending::failed;
    outcome.reason = std::move(reason);
    outcome.last_state = stepper.state();
    outcome.worst_state = stepper.worst_state();
  };
  stepper.start(0, model.initial.data());
  std::array<double, 64> times;
  std::size_t next_row = 1, next_stop = 0;
  for (std::size_t steps = 1;; ++steps) {
    const double limit = next_stop < model.stops.size() ? model.stops[next_stop] : grid.end();
    const double before = stepper.time();
    if (const char* reason = stepper.step(limit)) {
      fail(reason);
      break;
    }
    const double reached = stepper.time();
    if (pieces != nullptr) {
      const bool at_stop = reached >= limit && reached < grid.end();
      pieces->accept(Step(stepper, before, at_stop ? std::nextafter(reached, before) : reached));
    }
    if (!with_rows) {
      while (next_row < grid.size() && grid[next_row] <= reached) ++next_row;
    }
    while (next_row < grid.size() && grid[next_row] <= reached) {
      std::size_t count = 0;
      while (count < times.size() && next_row + count < grid.size() &&
             grid[next_row + count] <= reached) {
        times[count] = grid[next_row + count];
        ++count;
      }
      double* const out = rows.next(count);
      stepper.evaluate(times.data(), count, out);
      next_row += count;
    }
    if (reached >= grid.end()) break;
    if (reached >= limit) {
      ++next_stop;
      stepper.jump();
    } else if (pace.creeps(reached)) {
      fail(pace.reason());
      std::vector<double> row(row_size);
      stepper.evaluate(&reached, 1, row.data());
      outcome.last_state.assign(row.begin(),
                                row.begin() + static_cast<std::ptrdiff_t>(model.size()));
      break;
    }
    if (watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed)) {
      outcome.ending = Ending::interrupted;
      break;
    }
    if (watch.progress && steps % 256 == 0) watch.progress(reached);
  }
  rows.flush();
  outcome.reached = stepper.time();
  outcome.rows = next_row;
  outcome.statistics = stepper.statistics();
  return with_all_rows(std::move(outcome), grid.size());
}

}  // namespace bbsim::solve
