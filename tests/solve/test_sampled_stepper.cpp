// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sampled rigs piece by piece between instants, compared with radau's steps with guards.
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>

#include "catch.hpp"
#include "record/recorder.hpp"
#include "solve/hybrid_driver.hpp"
#include "solve/integrate.hpp"
#include "solve/radau/radau.hpp"
#include "solve/sampled/lane_engine.hpp"
#include "solve/sampled/lane_kernel.hpp"
#include "solve/sampled/motion_tables.hpp"
#include "solve/sampled/sampled.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test::test_sampled_stepper {

using namespace bbsim;

namespace {

constexpr solve::Tolerances tight{1e-11, 1e-13};

Scenario scene_of(const std::string& text) {
  return parse_scenario(text, "rig.yaml");
}

solve::MakeStepper generally(const solve::OutputGrid& grid) {
  return [&grid](const model::Model& model) {
    return std::make_unique<solve::radau::RadauStepper>(model, solve::radau::choose_kernels(), 12,
                                                        tight, grid.end());
  };
}

solve::MakeStepper by_pieces(const solve::OutputGrid&, solve::Tolerances tolerances = tight) {
  return [tolerances](const model::Model& model) {
    return std::make_unique<solve::sampled::HeldStepper>(model, solve::sampled::choose_kernels(),
                                                         tolerances);
  };
}

struct Both {
  solve::Outcome outcome;
  solve::Trajectory rows;
  explicit Both(std::size_t row_size) : rows(row_size) {}
};

Both run_of(const model::Model& model, const solve::OutputGrid& grid,
            const solve::MakeStepper& stepper) {
  Both run(model.row_size());
  run.outcome = solve::integrate_hybrid(model, stepper, tight, grid, run.rows, {});
  return run;
}

// Largest difference of any number in any row, relative to its size.
double largest_difference(const model::Model& model, const Both& a, const Both& b) {
  REQUIRE(a.rows.rows() == b.rows.rows());
  std::vector<double> size(model.row_size(), 1e-3);
  for (std::size_t i = 0; i < a.rows.rows(); ++i) {
    for (std::size_t k = 0; k < size.size(); ++k) {
      size[k] = std::max(size[k], std::abs(a.rows.row(i)[k]));
    }
  }
  double largest = 0;
  for (std::size_t i = 0; i < a.rows.rows(); ++i) {
    for (std::size_t k = 0; k < size.size(); ++k) {
      largest = std::max(largest, std::abs(a.rows.row(i)[k] - b.rows.row(i)[k]) / size[k]);
    }
  }
  return largest;
}

// Every kind of servo with every limit, every law and drive, and rigs beyond the paper's.
struct Case {
  const char* what;
  const char* servo;       // and mounting
  const char* controller;  // without its sampling
  const char* more = "";
};

const Case cases[] = {
    {"a hobby servo", "{servo: {natural_frequency: 31.4, damping: 0.8}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"rate limit", "{servo: {natural_frequency: 31.4, damping: 0.8, rate_limit: 0.6}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"acceleration limit",
     "{servo: {natural_frequency: 31.4, damping: 0.4, acceleration_limit: 20, rate_limit: 1}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"stops", "{servo: {natural_frequency: 31.4, damping: 0.2, angle_limit: 0.05}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"backlash and a dead band",
     "{servo: {natural_frequency: 31.4, damping: 0.6, backlash: 0.01, dead_band: 0.002}}",
     "gravity_compensation: {kp: 8, kv: 6}, drives: angle, limit: 0.2"},
    {"steppers that lose steps",
     "{servo: {stepper: {steps: 2000, torque: 0.2, inertia: 1e-2, corner_speed: 0.3}, rate_limit: "
     "0.8, acceleration_limit: 12}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"steppers with backlash",
     "{servo: {stepper: {microsteps: 8, gear: 3}, rate_limit: 0.8, acceleration_limit: 12, "
     "backlash: 0.004, phi: {backlash: 0}}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"first order, all limits",
     "{servo: {time_constant: 0.03, angle_limit: 0.06, rate_limit: 1.5, backlash: 0.004}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"over-damped, all limits",
     "{servo: {natural_frequency: 60, damping: 2.5, angle_limit: 0.05, rate_limit: 0.5, "
     "acceleration_limit: 40, backlash: 0.004}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"stiff", "{servo: {natural_frequency: 2000, damping: 0.7}}",
     "gravity_compensation: {kp: 6, kv: 5}, drives: angle, limit: 0.2"},
    {"accelerations driven", "{start: {phi: 0.01}}",
     "lqr: {position: 20, velocity: 1, command: 0.1}, drives: acceleration, limit: 30"},
    {"a mounting that is not the paper's",
     "{servo: {natural_frequency: 31.4, damping: 0.8, rate_limit: 2}, mounting: {height: 0.02, "
     "phi_offset: 0.01, skew: 0.02, yaw: 0.1, base_tilt: 0.01}}",
     "gravity_compensation: {kp: 8, kv: 6}, drives: angle, limit: 0.2"},
    {"servos fed back", "{servo: {natural_frequency: 40, damping: 1}}",
     "lqr: {position: 20, velocity: 1, angle: 1, rate: 0.01, command: 1}, drives: angle, limit: "
     "0.2"},
    {"push rods, all limits",
     "{servo: {natural_frequency: 31.4, damping: 0.8, rate_limit: 1.5, backlash: 0.006}, "
     "mounting: {height: 0.02, phi_offset: 0.01}, linkage: {horn: 0.024, arm: 0.06, offset: "
     "[-0.016, 0.07]}}",
     "gravity_compensation: {kp: 8, kv: 6}, drives: angle, limit: 0.2"},
    {"a rod on one axis that the controller inverts",
     "{servo: {time_constant: 0.03, rate_limit: 2}, linkage: {phi: {horn: 0.024, arm: 0.06, "
     "offset: [-0.016, 0.07]}}}",
     "gravity_compensation: {kp: 8, kv: 6}, drives: angle, limit: 0.2, assumes: exact"},
    {"three legs",
     "{servo: {natural_frequency: 31.4, damping: 0.8, rate_limit: 1.5, backlash: 0.006}, "
     "three_servos: {radius_base: 0.06, radius_plate: 0.09, horn: 0.04, rod: 0.1, height: 0.11}}",
     "gravity_compensation: {kp: 6, kv: 5}, drives: angle, limit: 0.2"},
    {"three unequal and stiff legs",
     "{servo: {natural_frequency: 600, damping: 0.7}, three_servos: {legs: "
     "[{angle: 0, radius_base: 0.06, radius_plate: 0.09, horn: 0.04, rod: 0.1, height: 0.11}, "
     "{angle: 2.0, radius_base: 0.06, radius_plate: 0.085, horn: 0.045, rod: 0.1, height: 0.11}, "
     "{angle: -2.1, radius_base: 0.065, radius_plate: 0.09, horn: 0.04, rod: 0.105, height: "
     "0.11}]}}",
     "gravity_compensation: {kp: 6, kv: 5}, drives: angle, limit: 0.2"},
    {"three legs of which some are at the rate limit",
     "{servo: {natural_frequency: 31.4, damping: 0.8, rate_limit: 0.4}, "
     "three_servos: {radius_base: 0.06, radius_plate: 0.09, horn: 0.04, rod: 0.1, height: 0.11}}",
     "gravity_compensation: {kp: 6, kv: 5}, drives: angle, limit: 0.2"},
    {"steppers that ring",
     "{servo: {stepper: {gear: 2, natural_frequency: 90, damping: 0.08}, rate_limit: 0.8, "
     "acceleration_limit: 12}}",
     "lqr: {position: 20, velocity: 1, angle: 1, rate: 0.01, command: 1}, drives: angle, limit: "
     "0.2"},
    {"steppers that ring and lose steps",
     "{servo: {stepper: {steps: 2000, torque: 0.2, inertia: 1e-2, corner_speed: 0.3, "
     "natural_frequency: 90}, rate_limit: 0.8, acceleration_limit: 12}}",
     "gravity_compensation: {kp: 10, kv: 8}, drives: angle, limit: 0.2"},
    {"three legs with steppers, of which two ring",
     "{servo: {stepper: {natural_frequency: 200}, rate_limit: 2, acceleration_limit: 40}, "
     "three_servos: {radius_base: 0.06, radius_plate: 0.09, horn: 0.04, rod: 0.1, height: 0.11, "
     "legs: [{}, {servo: {stepper: {natural_frequency: 120, damping: 0}}}, {servo: {stepper: "
     "{}}}]}}",
     "gravity_compensation: {kp: 6, kv: 5}, drives: angle, limit: 0.2"},
    {"steppers that ring behind push rods",
     "{servo: {stepper: {natural_frequency: 90}, rate_limit: 1.5, acceleration_limit: 20}, "
     "mounting: {height: 0.02, phi_offset: 0.01}, linkage: {horn: 0.024, arm: 0.06, offset: "
     "[-0.016, 0.07]}}",
     "gravity_compensation: {kp: 8, kv: 6}, drives: angle, limit: 0.2"},
};

std::string text_of(const Case& one, const std::string& sampling, const std::string& columns) {
  return std::string(
             "gravity: 9.81\n"
             "ball: {radius: 0.02, mass: 0.033, position: [0.05, 0.01], spin: 1}\n"
             "plate: {size: [0.32, 0.24], inertia: [4e-3, 6e-3, 1e-2]}\n"
             "gimbal: ") +
         one.servo + "\ncontroller: {" + one.controller +
         ", reference: {circle: {radius: 0.05, rate: -0.5}}, " + sampling +
         "}\n"
         "events: {edge: stop, slip: {friction: 0.2, action: note}, lift_off: stop}\n"
         "time: {end: 3, step: 0.013}\noutput: {columns: [" +
         columns + "]}\n" + one.more;
}

// Without quantization, because a switch of the command by one step would amplify rounding.
const char* const sampling =
    "sampling: {period: 0.02, delay: 0.006, derivative_filter: 0.03}, "
    "sensor: {delay: 0.011, noise: 2e-4, seed: 3, dropout: 0.1}";
// No two periods are equal, and frames come between samples.
const char* const uneven =
    "sampling: {period: 0.02, delay: 0.006, jitter: 0.002, derivative_filter: 0.03}, "
    "sensor: {period: 0.033, phase: 0.004, delay: 0.011, noise: 2e-4, seed: 3}";

}  // namespace

TEST_CASE("a rig by pieces is the rig in general, whatever its servos, law and mounting") {
  const char* const sampling_of = GENERATE(as<const char*>{}, sampling, uneven);
  for (const Case& one : cases) {
    INFO(one.what << ", " << sampling_of);
    const Scenario scene = scene_of(text_of(one, sampling_of, "t, x, gamma"));
    const model::Model model = model::assemble(scene, true);
    REQUIRE(solve::sampled::can_step(model));
    const solve::OutputGrid grid(scene.time);
    const Both general = run_of(model, grid, generally(grid));
    const Both pieces = run_of(model, grid, by_pieces(grid));
    CHECK(pieces.outcome.ending == general.outcome.ending);
    CHECK(std::abs(pieces.outcome.reached - general.outcome.reached) < 1e-9);
    CHECK(largest_difference(model, general, pieces) < 2e-8);
    const auto &a = general.outcome.occurrences, &b = pieces.outcome.occurrences;
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      CHECK(a[i].name == b[i].name);
      CHECK(std::abs(a[i].t - b[i].t) < 1e-8);
      CHECK(std::abs(a[i].sample.ball.x - b[i].sample.ball.x) < 1e-8);
    }
  }
}

TEST_CASE("integrate() solves sampled rigs by pieces, and no others") {
  const Scenario scene = scene_of(text_of(cases[0], sampling, "t, x"));
  const model::Model sampled = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  const auto stepper = solve::make_stepper(sampled, Method::radau, tight, grid);
  CHECK(stepper->servos() != nullptr);
  CHECK(solve::make_stepper(sampled, Method::bdf, tight, grid)->servos() == nullptr);
  Scenario continuous = scene;
  continuous.controller->sampling.reset();
  continuous.controller->sensor.reset();
  CHECK_FALSE(solve::sampled::can_step(model::assemble(continuous, false)));
  // With a linkage, unless something else moves the ball. Lanes do not count the motors' work.
  Scenario linked = scene_of(text_of(cases[13], sampling, "t, x"));
  scenario::Integrals without_work(false);
  without_work.work = false;
  CHECK(solve::sampled::can_step(model::assemble(linked, false)));
  CHECK_FALSE(solve::sampled::fits_lanes(model::assemble(linked, false)));
  CHECK(solve::sampled::fits_lanes(model::assemble(linked, without_work)));
  const Scenario rings = scene_of(text_of(*std::prev(std::end(cases)), sampling, "t, x"));
  CHECK(solve::sampled::can_step(model::assemble(rings, without_work)));
  CHECK_FALSE(solve::sampled::fits_lanes(model::assemble(rings, without_work)));
  linked.ball.losses.viscous = 1e-6;
  CHECK_FALSE(solve::sampled::can_step(model::assemble(linked, without_work)));
}

TEST_CASE("pieces too long for their tolerance are split") {
  // Four commands in eight seconds, and a stiff servo that jumps at each.
  const Scenario scene = scene_of(text_of(
      cases[8], "sampling: {period: 0.8, delay: 0.1, derivative_filter: 1}", "t, x, gamma"));
  const model::Model model = model::assemble(scene, true);
  const solve::OutputGrid grid(scene.time);
  const Both general = run_of(model, grid, generally(grid));
  const Both pieces = run_of(model, grid, by_pieces(grid));
  CHECK(pieces.outcome.ending == general.outcome.ending);
  CHECK(largest_difference(model, general, pieces) < 1e-8);
  CHECK(pieces.outcome.statistics.error_test_failures > 0);
  // A looser tolerance is met with fewer steps.
  Both loose(model.row_size());
  loose.outcome = solve::integrate_hybrid(model, by_pieces(grid, {1e-6, 1e-8}), {1e-6, 1e-8}, grid,
                                          loose.rows, {});
  CHECK(largest_difference(model, general, loose) < 1e-4);
  CHECK(loose.outcome.statistics.steps < pieces.outcome.statistics.steps);
}

TEST_CASE("events of a rig solved by pieces are found between instants and at them") {
  // The ball leaves the plate or slips, in one case immediately after a jump of the command.
  struct Watched {
    const char* what;
    const char* servo;
    const char* controller;
    const char* events;
  };
  const Watched watched[] = {
      {"off the edge", "{servo: {natural_frequency: 31.4, damping: 0.8}}",
       "pd: {kp: [[-2, 0], [0, 2]], kv: 0}, drives: angle, limit: 0.2", "{edge: stop}"},
      {"noted at the edge, and goes on", "{servo: {natural_frequency: 31.4, damping: 0.8}}",
       "pd: {kp: [[-2, 0], [0, 2]], kv: 0}, drives: angle, limit: 0.2", "{edge: note}"},
      {"slips when the command jumps", "{}",
       "pd: {kp: [[600, 0], [0, -600]], kv: [[40, 0], [0, -40]]}, drives: acceleration, limit: 60",
       "{slip: {friction: 0.08, action: note}, lift_off: note}"},
      {"tilts", "{servo: {natural_frequency: 20, damping: 0.3}}",
       "pd: {kp: [[5, 0], [0, -5]], kv: [[1, 0], [0, -1]]}, drives: angle, limit: 0.2",
       "{tilt: {limit: 0.15, action: note}, edge: note}"},
  };
  for (const Watched& one : watched) {
    INFO(one.what);
    const Scenario scene =
        scene_of(std::string("gravity: 9.81\nball: {radius: 0.02, position: [0.05, 0.01]}\n"
                             "plate: {size: [0.32, 0.24]}\ngimbal: ") +
                 one.servo + "\ncontroller: {" + one.controller +
                 ", reference: {point: [0, 0]}, sampling: {period: 0.02, delay: 0.006}}\nevents: " +
                 one.events + "\ntime: {end: 1.5, step: 0.01}\noutput: {columns: [t, x]}\n");
    const model::Model model = model::assemble(scene, false);
    const solve::OutputGrid grid(scene.time);
    const Both general = run_of(model, grid, generally(grid));
    const Both pieces = run_of(model, grid, by_pieces(grid));
    REQUIRE_FALSE(general.outcome.occurrences.empty());
    CHECK(pieces.outcome.ending == general.outcome.ending);
    REQUIRE(pieces.outcome.occurrences.size() == general.outcome.occurrences.size());
    for (std::size_t i = 0; i < general.outcome.occurrences.size(); ++i) {
      const model::Occurrence &a = general.outcome.occurrences[i],
                              &b = pieces.outcome.occurrences[i];
      CHECK(a.name == b.name);
      CHECK(a.stopped == b.stopped);
      CHECK(std::abs(a.t - b.t) < 1e-8);
    }
    CHECK(largest_difference(model, general, pieces) < 1e-6);
  }
}

TEST_CASE("servos' tables of all lanes together equal those of each lane") {
  using Table = solve::sampled::MotionTable;
  struct Lane {
    model::HeldLaw law;
    double length;
  };
  // Normal, at a limit, without spring, without damper; one lane has no piece.
  const Lane lanes[solve::sampled::group]{{{986.96, 50.27}, 0.02}, {{986.96, 50.27}, 0.0137},
                                          {{0, 0}, 0.02},          {{0, 25}, 0.02},
                                          {{2000, 0}, 0.02},       {{986.96, 50.27}, 0},
                                          {{4e6, 3200}, 4e-4},     {{986.96, 50.27}, 3e-9}};
  const auto axis = std::make_unique<solve::sampled::LaneAxis>();
  const auto servo = std::make_unique<solve::sampled::LaneServo>();
  alignas(64) double length[solve::sampled::group];
  for (int l = 0; l < solve::sampled::group; ++l) {
    servo->stiffness[l] = lanes[l].law.stiffness;
    servo->damping[l] = lanes[l].law.damping;
    length[l] = lanes[l].length;
  }
  solve::sampled::choose_lane_kernels().tables(*axis, *servo, length);
  for (int l = 0; l < solve::sampled::group; ++l) {
    const auto [law, h] = lanes[l];
    if (h == 0) continue;
    INFO(law.stiffness << " " << law.damping << " over " << h);
    solve::sampled::MotionTables tables(solve::sampled::choose_kernels());
    const Table& wanted = tables.of(law, h);
    // Some rounding errors of each sum's largest term; the start's weights add up to 5.5.
    constexpr double rounding = 20 * 2.2e-16, summed = 5.5 * rounding;
    const double size[Table::rows] = {h, 1, 1 / h};  // by rate; by acceleration times h
    for (int row = 0; row < Table::rows; ++row) {
      for (int n = 0; n < solve::sampled::nodes; ++n) {
        CHECK(std::abs(axis->by_rate[row][n][l] - wanted.by_rate[row][n]) <= rounding * size[row]);
        CHECK(std::abs(axis->by_acceleration[row][n][l] - wanted.by_acceleration[row][n]) <=
              rounding * h * size[row]);
      }
    }
    CHECK(axis->most_by_rate[l] == Approx(wanted.most_by_rate).epsilon(rounding));
    CHECK(axis->most_by_acceleration[l] == Approx(wanted.most_by_acceleration).epsilon(rounding));
    CHECK(std::abs(axis->missed_by_rate[l] - wanted.missed_by_rate) <= summed / h);
    CHECK(std::abs(axis->missed_by_acceleration[l] - wanted.missed_by_acceleration) <= summed);
  }
}

TEST_CASE("bounds of a piece contain its columns") {
  // In the order of solve::Bounded.
  constexpr std::string_view bounded[] = {"x",
                                          "y",
                                          "vx",
                                          "vy",
                                          "distance",
                                          "tilt",
                                          "tilt_rate",
                                          "tracking_error",
                                          "motor_torque_phi",
                                          "motor_torque_theta",
                                          "motor_power"};
  struct Looks : solve::PieceSink {
    const model::Model& model;
    const model::BallConstants& constants;
    record::Rows rows;
    std::size_t pieces = 0, wide = 0, unbounded = 0;
    Looks(const model::Model& m, const model::BallConstants& c,
          const std::vector<const scenario::Column*>& columns)
        : model(m), constants(c), rows(columns) {
      rows.begin(m, c);
    }
    void begin_run() override {}
    void accept(const solve::Piece& piece) override {
      ++pieces;
      std::vector<double> row(model.row_size());
      for (std::size_t c = 0; c < rows.columns().size(); ++c) {
        INFO(rows.columns()[c]->name << " from " << piece.from() << " to " << piece.to());
        const auto bounds = piece.bounds(static_cast<solve::Bounded>(c), constants, false);
        const auto close = piece.bounds(static_cast<solve::Bounded>(c), constants, true);
        REQUIRE(bounds.has_value() == close.has_value());
        if (!bounds) {
          ++unbounded;
          continue;
        }
        double least = 1e99, most = -1e99;
        for (int i = 0; i <= 20; ++i) {
          const double t =
              i == 20 ? piece.to() : piece.from() + (piece.to() - piece.from()) * i / 20.0;
          piece.evaluate(&t, 1, row.data());
          rows.evaluate(&t, row.data(), 1);
          least = std::min(least, rows[c][0]);
          most = std::max(most, rows[c][0]);
        }
        const double rounding = 1e-12;
        CHECK(least >= bounds->least - rounding);
        CHECK(most <= bounds->most + rounding);
        CHECK(least >= close->least - rounding);
        CHECK(most <= close->most + rounding);
        // Both may be roots of rounding errors.
        if (close->most - close->least > bounds->most - bounds->least + 1e-7) ++wide;
      }
    }
  };
  std::vector<const scenario::Column*> columns;
  for (const std::string_view name : bounded) columns.push_back(scenario::find_column(name));
  for (const Case& one : cases) {
    INFO(one.what);
    Scenario scene = scene_of(text_of(one, sampling, "t, x"));
    scene.time.end = 0.5;
    const model::Model model = model::assemble(scene, false);
    const model::BallConstants constants = model::constants_of(scene);
    const solve::OutputGrid grid(scene.time);
    Looks looks(model, constants, columns);
    solve::Trajectory rows(model.row_size(), &looks);
    static_cast<void>(solve::integrate_hybrid(model, by_pieces(grid), tight, grid, rows, {}));
    CHECK(looks.pieces > 5);
    CHECK(looks.wide == 0);  // a close look never widens the bounds
    // A stiff servo moves between the nodes.
    const bool is_stiff = std::string_view(one.what).find("stiff") != std::string_view::npos;
    CHECK((looks.unbounded > looks.pieces) == is_stiff);
  }
}

TEST_CASE(
    "configs/rig.yaml without noise is within 1e-10 m of its solution, at its own tolerance") {
  Scenario scene = read_scenario(std::string(BBSIM_SOURCE_DIR) + "/configs/rig.yaml");
  scene.controller->sensor->noise = 0;
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  const Both exact = run_of(model, grid, by_pieces(grid, {1e-13, 1e-15}));
  const Both general = run_of(model, grid, generally(grid));
  const Both own = run_of(model, grid, by_pieces(grid, {1e-8, 1e-10}));
  REQUIRE(own.outcome.ending == solve::Ending::done);
  double by_own = 0, by_general = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      by_own = std::max(by_own, std::abs(own.rows.row(i)[k] - exact.rows.row(i)[k]));
      by_general = std::max(by_general, std::abs(general.rows.row(i)[k] - exact.rows.row(i)[k]));
    }
  }
  CHECK(by_own < 1e-10);
  CHECK(by_general < 1e-9);
}

}  // namespace bbsim_test::test_sampled_stepper
