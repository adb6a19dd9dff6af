// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sampled rigs piece by piece between instants, compared with radau's steps with guards.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "catch.hpp"
#include "record/recorder.hpp"
#include "solve/integrate.hpp"
#include "solve/radau/radau.hpp"
#include "solve/sampled/lane_engine.hpp"
#include "solve/sampled/lane_kernel.hpp"
#include "solve/sampled/motion_tables.hpp"
#include "solve/sampled/sampled.hpp"
#include "solve/stepper.hpp"
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
  run.outcome = solve::begin_hybrid(model, stepper, tight, grid, run.rows, {})->advance().value();
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

struct Case {
  std::string what, gimbal, controller, events;
};

// The rigs of rigs.yaml.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> made;
    const YAML::Node rigs = YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/solve/rigs.yaml");
    const auto text_of = [](const YAML::Node& node) {
      YAML::Emitter text;
      text.SetMapFormat(YAML::Flow);
      text.SetSeqFormat(YAML::Flow);
      text << node;
      return std::string(text.c_str());
    };
    for (const YAML::Node& one : rigs) {
      const auto part = [&](const char* name) {
        return text_of(one[name] ? one[name] : rigs[0][name]);
      };
      made.push_back({one["what"].as<std::string>(), part("gimbal"), part("controller"),
                      one["events"] ? text_of(one["events"]) : ""});
    }
    return made;
  }();
  return all;
}

const Case& rig(std::string_view what) {
  return *std::ranges::find(cases(), what, &Case::what);
}

// `sampling` is not for rigs with events of their own.
std::string text_of(const Case& one, const std::string& sampling, const std::string& columns) {
  const bool watched = !one.events.empty();
  return "gravity: 9.81\n"
         "ball: {radius: 0.02, mass: 0.033, position: [0.05, 0.01], spin: 1}\n"
         "plate: {size: [0.32, 0.24], inertia: [4e-3, 6e-3, 1e-2]}\n"
         "gimbal: " +
         one.gimbal + "\ncontroller: " + one.controller.substr(0, one.controller.size() - 1) +
         (watched
              ? ", reference: {point: [0, 0]}, sampling: {period: 0.02, delay: 0.006}}\nevents: " +
                    one.events + "\ntime: {end: 1.5, step: 0.01}\n"
              : ", reference: {circle: {radius: 0.05, rate: -0.5}}, " + sampling +
                    "}\nevents: {edge: stop, slip: {friction: 0.2, action: note}, lift_off: stop}\n"
                    "time: {end: 3, step: 0.013}\n") +
         "output: {columns: [" + columns + "]}\n";
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
  for (const Case& one : cases()) {
    if (!one.events.empty() && sampling_of == uneven) continue;
    INFO(one.what << ", " << sampling_of);
    const Scenario scene = scene_of(text_of(one, sampling_of, "t, x, gamma"));
    const model::Model model = model::assemble(scene, true);
    REQUIRE(solve::sampled::can_step(model));
    const solve::OutputGrid grid(scene.time);
    const Both general = run_of(model, grid, generally(grid));
    const Both pieces = run_of(model, grid, by_pieces(grid));
    CHECK(pieces.outcome.ending == general.outcome.ending);
    CHECK(std::abs(pieces.outcome.reached - general.outcome.reached) < 1e-9);
    CHECK(largest_difference(model, general, pieces) < (one.events.empty() ? 2e-8 : 1e-6));
    CHECK((one.events.empty() || !general.outcome.occurrences.empty()));
    const auto &a = general.outcome.occurrences, &b = pieces.outcome.occurrences;
    REQUIRE(a.size() == b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      CHECK(a[i].name == b[i].name);
      CHECK(a[i].stopped == b[i].stopped);
      CHECK(std::abs(a[i].t - b[i].t) < 1e-8);
      CHECK(std::abs(a[i].sample.ball.x - b[i].sample.ball.x) < 1e-8);
    }
  }
}

TEST_CASE("integrate() solves sampled rigs by pieces, and no others") {
  const Scenario scene = scene_of(text_of(rig("a hobby servo"), sampling, "t, x"));
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
  Scenario linked = scene_of(text_of(rig("push rods, all limits"), sampling, "t, x"));
  scenario::Integrals without_work(false);
  without_work.work = false;
  CHECK(solve::sampled::can_step(model::assemble(linked, false)));
  CHECK_FALSE(solve::sampled::fits_lanes(model::assemble(linked, false)));
  CHECK(solve::sampled::fits_lanes(model::assemble(linked, without_work)));
  const Scenario rings =
      scene_of(text_of(rig("steppers that ring behind push rods"), sampling, "t, x"));
  CHECK(solve::sampled::can_step(model::assemble(rings, without_work)));
  CHECK_FALSE(solve::sampled::fits_lanes(model::assemble(rings, without_work)));
  linked.ball.losses.viscous = 1e-6;
  CHECK_FALSE(solve::sampled::can_step(model::assemble(linked, without_work)));
}

TEST_CASE("pieces too long for their tolerance are split") {
  // Four commands in eight seconds, and a stiff servo that jumps at each.
  const Scenario scene =
      scene_of(text_of(rig("over-damped, all limits"),
                       "sampling: {period: 0.8, delay: 0.1, derivative_filter: 1}", "t, x, gamma"));
  const model::Model model = model::assemble(scene, true);
  const solve::OutputGrid grid(scene.time);
  const Both general = run_of(model, grid, generally(grid));
  const Both pieces = run_of(model, grid, by_pieces(grid));
  CHECK(pieces.outcome.ending == general.outcome.ending);
  CHECK(largest_difference(model, general, pieces) < 1e-8);
  CHECK(pieces.outcome.statistics.error_test_failures > 0);
  // A looser tolerance is met with fewer steps.
  Both loose(model.row_size());
  loose.outcome =
      solve::begin_hybrid(model, by_pieces(grid, {1e-6, 1e-8}), {1e-6, 1e-8}, grid, loose.rows, {})
          ->advance()
          .value();
  CHECK(largest_difference(model, general, loose) < 1e-4);
  CHECK(loose.outcome.statistics.steps < pieces.outcome.statistics.steps);
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
    std::size_t pieces = 0, wide = 0, unbounded = 0, trends = 0;
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
        double least = 1e99, most = -1e99, first = 0, last = 0;
        for (int i = 0; i <= 20; ++i) {
          // Closer at the ends.
          const double part = (1 - std::cos(3.141592653589793 * i / 20)) / 2;
          const double t = i == 20 ? piece.to() : piece.from() + (piece.to() - piece.from()) * part;
          piece.evaluate(&t, 1, row.data());
          rows.evaluate(&t, row.data(), 1);
          last = rows[c][0];
          if (i == 0) first = last;
          least = std::min(least, last);
          most = std::max(most, last);
        }
        const double rounding = 1e-12;
        if (close->trend != 0) {
          ++trends;
          CHECK(most <= (close->trend > 0 ? last : first) + rounding);
          CHECK(least >= (close->trend > 0 ? first : last) - rounding);
        }
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
  for (const Case& one : cases()) {
    INFO(one.what);
    Scenario scene = scene_of(text_of(one, sampling, "t, x"));
    scene.time.end = 0.5;
    const model::Model model = model::assemble(scene, false);
    const model::BallConstants constants = model::constants_of(scene);
    const solve::OutputGrid grid(scene.time);
    Looks looks(model, constants, columns);
    solve::Trajectory rows(model.row_size(), &looks);
    static_cast<void>(
        solve::begin_hybrid(model, by_pieces(grid), tight, grid, rows, {})->advance().value());
    CHECK(looks.pieces > 5);
    CHECK(looks.wide == 0);  // a close look never widens the bounds
    CHECK(looks.trends > looks.pieces);
    // A stiff servo moves between the nodes.
    const bool is_stiff = one.what.find("stiff") != std::string::npos;
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
