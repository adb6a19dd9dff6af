// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/scene.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/number_text.hpp"

namespace bbsim::replay {
namespace {

[[noreturn]] void refuse_run(const std::string& name, const std::string& what) {
  throw InputError(name + ": cannot be replayed: " + what);
}

void check_rows(const std::string& of, const std::string& column, std::size_t rows,
                const std::string& other, std::size_t wanted) {
  if (rows == wanted) return;
  refuse_run(of, "column " + column + " has " + std::to_string(rows) + " rows, and " + other +
                     " has " + std::to_string(wanted));
}

void check_times(const Run& run, const std::vector<double>& times) {
  for (std::size_t row = 0; row < times.size(); ++row) {
    const std::string place = "t in row " + std::to_string(row + 1) + " is ";
    if (!std::isfinite(times[row])) {
      refuse_run(run.name, place + number_text(times[row]) + "; every row needs a finite time");
    }
    if (row > 0 && times[row] <= times[row - 1]) {
      refuse_run(run.name, place + number_text(times[row]) + ", after " +
                               number_text(times[row - 1]) + "; times have to increase");
    }
  }
}

void check_run(const Run& run) {
  if (run.find("t") == nullptr) {
    refuse_run(
        run.name,
        "it has no column t; a replay needs t, x and y: --map t=COLUMN names those of a log");
  }
  if (run.find("x") == nullptr && run.find("y") == nullptr) {
    refuse_run(run.name, "it has neither a column x nor y; a replay needs t, x and y");
  }
  const std::size_t rows = row_count(run);
  if (rows == 0) refuse_run(run.name, "it has no rows");
  for (const file::Column& column : run.columns) {
    check_rows(run.name, column.name, column.numbers.size(), "t", rows);
  }
  if (!run.orientation.empty() && run.orientation.size() != rows) {
    refuse_run(run.name, "there are " + std::to_string(run.orientation.size()) +
                             " orientations of the ball, and t has " + std::to_string(rows) +
                             " rows");
  }
  check_times(run, run.find("t")->numbers);
}

void check_sweep(const Sweep& sweep) {
  const std::size_t cases = sweep.status.size();
  if (cases == 0) refuse_run(sweep.name, "it has no cases");
  if (sweep.keys.empty()) refuse_run(sweep.name, "no key varies in it");
  if (sweep.measures.empty()) refuse_run(sweep.name, "it has no measure");
  check_rows(sweep.name, "case", sweep.cases.size(), "status", cases);
  for (const auto* columns : {&sweep.keys, &sweep.measures}) {
    for (const SweepColumn& column : *columns) {
      check_rows(sweep.name, column.name, column.numbers.size(), "status", cases);
    }
  }
}

}  // namespace

std::size_t row_count(const Run& run) {
  const file::Column* t = run.find("t");
  return t == nullptr ? 0 : t->numbers.size();
}

std::size_t rows_of_file(const Run& run) {
  return row_count(run) - (run.has_end_row ? 1 : 0);
}

std::optional<double> ball_radius(const Run& run) {
  if (!run.scenario) return {};
  const Ball& ball = run.scenario->ball;
  return ball.groove ? ball.groove->ball_radius : ball.radius;
}

std::vector<double> coordinate(const Run& run, std::string_view name) {
  const file::Column* series = run.find(name);
  return series == nullptr ? std::vector<double>(row_count(run), 0.0) : series->numbers;
}

void check_scene(const Scene& scene) {
  if (scene.runs.empty() && scene.sweeps.empty()) {
    throw InputError("nothing to replay: neither a run nor a sweep");
  }
  for (const Run& run : scene.runs) check_run(run);
  for (const Sweep& sweep : scene.sweeps) check_sweep(sweep);
}

namespace {

// The greatest distances of the runs and their references from home, along each axis.
struct Extent {
  double x = 0, y = 0;

  void include(double at_x, double at_y) {
    if (!(std::abs(at_x) <= largest_drawn && std::abs(at_y) <= largest_drawn)) return;
    x = std::max(x, std::abs(at_x));
    y = std::max(y, std::abs(at_y));
  }
};

Extent extent(const Scene& scene) {
  Extent all;
  for (const Run& run : scene.runs) {
    const std::vector<double> x = coordinate(run, "x"), y = coordinate(run, "y");
    for (std::size_t row = 0; row < x.size(); ++row) all.include(x[row], y[row]);
    for (const auto& point : run.reference) all.include(point[0], point[1]);
  }
  return all;
}

// Makes a plate with some margin around the paths, for a ball of this radius.
void fit_plate(Stage& stage, const Extent& paths, double ball) {
  constexpr double margin = 1.2, thin = 1e-6, beam = 1.0 / 8;
  const double far = std::max(paths.x, paths.y);
  if (far == 0 && ball == 0) {
    stage.width = stage.depth = 0.3;
    return;
  }
  stage.width = stage.depth = 2 * std::max(margin * far, 6 * ball);
  const double across = std::max(beam * stage.width, std::min(4 * ball, stage.width));
  if (paths.y < thin * paths.x) stage.depth = across;
  if (paths.x < thin * paths.y) stage.width = across;
}

}  // namespace

Stage stage_of(const Scene& scene) {
  Stage stage;
  std::optional<double> ball;  // of the first run that tells
  for (const Run& run : scene.runs) {
    if (!ball) ball = ball_radius(run);
    const Plate plate = run.scenario ? run.scenario->plate : Plate();
    if (stage.plate_given || (!plate.size && !plate.diameter)) continue;
    stage.plate_given = true;
    stage.round = !plate.size;
    stage.width = plate.size ? (*plate.size)[0] : *plate.diameter;
    stage.depth = plate.size ? (*plate.size)[1] : *plate.diameter;
  }
  if (!stage.plate_given) fit_plate(stage, extent(scene), ball.value_or(0));
  // On a beam, the ball may be as large as on a plate of the same length.
  constexpr double ball_part = 1.0 / 30;
  const double side =
      stage.plate_given ? std::min(stage.width, stage.depth) : std::max(stage.width, stage.depth);
  stage.ball_radius = ball.value_or(ball_part * side);
  return stage;
}

std::vector<Quaternion> rolled(const std::vector<double>& x, const std::vector<double>& y,
                               const std::vector<double>* gamma, double radius) {
  std::vector<Quaternion> result;
  result.reserve(x.size());
  Quaternion now{1, 0, 0, 0};
  for (std::size_t row = 0; row < x.size(); ++row) {
    if (row > 0) {
      const double dgamma = gamma == nullptr ? 0 : (*gamma)[row] - (*gamma)[row - 1];
      const std::array<double, 3> turn{-(y[row] - y[row - 1]) / radius,
                                       (x[row] - x[row - 1]) / radius, dgamma};
      if (std::isfinite(turn[0] + turn[1] + turn[2])) {
        now = normalised(product(rotation_by(turn), now));
      }
    }
    result.push_back(now);
  }
  return result;
}

namespace {

// The integral from the first row on, by trapezoids. Rows that are not finite add nothing.
std::vector<double> integral(const std::vector<double>& t, const std::vector<double>& rate) {
  std::vector<double> sum(t.size(), 0);
  for (std::size_t row = 1; row < t.size(); ++row) {
    const double more = (t[row] - t[row - 1]) * (rate[row] / 2 + rate[row - 1] / 2);
    sum[row] = sum[row - 1] + (std::isfinite(more) ? more : 0);
  }
  return sum;
}

// The part of the ball's path that its rotation covers: the path minus the slip.
std::vector<double> way_rolled(const Run& run, const char* axis, const char* slip) {
  std::vector<double> way = coordinate(run, axis);
  if (const file::Column* const rate = run.find(slip)) {
    const std::vector<double> slipped = integral(run.find("t")->numbers, rate->numbers);
    for (std::size_t row = 0; row < way.size(); ++row) way[row] -= slipped[row];
  }
  return way;
}

}  // namespace

std::vector<Quaternion> orientation_of(const Run& run, double radius) {
  if (!run.orientation.empty()) return run.orientation;
  const file::Column* const gamma = run.find("gamma");
  const file::Column* const spin = run.find("spin");
  const bool slip_known = run.find("slip_x") != nullptr && run.find("slip_y") != nullptr &&
                          (gamma != nullptr || spin != nullptr) && run.scenario;
  if (!run.rolls && !slip_known) return {};
  std::vector<double> turned;
  if (gamma != nullptr) {
    turned = gamma->numbers;
  } else if (spin != nullptr) {
    turned = integral(run.find("t")->numbers, spin->numbers);
  }
  return rolled(way_rolled(run, "x", "slip_x"), way_rolled(run, "y", "slip_y"),
                turned.empty() ? nullptr : &turned,
                run.scenario ? run.scenario->ball.radius : radius);
}

}  // namespace bbsim::replay
