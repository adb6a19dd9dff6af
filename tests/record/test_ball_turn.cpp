// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Columns ball_qw to ball_qz: the ball's orientation against closed forms and its twist.
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "catch.hpp"
#include "file/memory_table.hpp"
#include "model/model.hpp"
#include "record/recorder.hpp"
#include "record/rows.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"
#include "support/tables.hpp"

namespace bbsim_test::test_ball_turn {

using namespace bbsim;

namespace {

Eigen::Quaterniond eigen(const Quaternion& q) {
  return {q[0], q[1], q[2], q[3]};
}

model::Sample moving(double t, double x, double vx, double y, double vy) {
  model::Sample sample;
  sample.t = t;
  sample.ball = {x, y, vx, vy, 0};
  return sample;
}

file::Table run(const std::string& name, const std::string& overrides_columns,
                const std::string& step, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"output.columns=" + overrides_columns, "time.step=" + step};
  overrides.insert(overrides.end(), more.begin(), more.end());
  const Scenario scene =
      read_scenario(std::string(BBSIM_SOURCE_DIR) + "/configs/" + name + ".yaml", overrides);
  const auto columns = scenario::columns_named(scene.output.columns);
  const model::Model model = model::assemble(scene, scenario::integrals_for(columns));
  const solve::OutputGrid grid(scene.time);
  file::MemoryTable table(scenario::names_of(columns));
  const model::BallConstants constants = model::constants_of(scene);
  record::Recorder recorder({columns});
  recorder.begin(model, constants, grid, &table);
  const solve::Outcome outcome = solve::integrate(
      model, scene.solver.method, {scene.solver.rtol, scene.solver.atol}, grid, recorder, {});
  REQUIRE(outcome.ending == solve::Ending::done);
  return table.take();
}

constexpr const char* all = "[t,ball_qw,ball_qx,ball_qy,ball_qz,vx,vy,spin]";

Eigen::Quaterniond orientation(const file::Table& table, std::size_t row) {
  return {table.columns[1].numbers[row], table.columns[2].numbers[row],
          table.columns[3].numbers[row], table.columns[4].numbers[row]};
}

}  // namespace

TEST_CASE("a ball that rolls straight turns by distance over radius, beyond a full turn") {
  record::BallTurn turn(0.02);
  const double length = 2 * std::numbers::pi * 0.02;
  CHECK(eigen(turn.go_to(moving(0, 0, 0, 0, 0))).isApprox(Eigen::Quaterniond::Identity()));
  for (int i = 1; i <= 8; ++i) {
    const double s = i / 8.0;
    const Eigen::Quaterniond expected(
        Eigen::AngleAxisd(2 * std::numbers::pi * s * s, Eigen::Vector3d::UnitY()));
    // At growing speed along a line, the orientation is exactly the integral of the twist.
    const auto q = eigen(turn.go_to(moving(s, length * s * s, 2 * length * s, 0, 0)));
    CHECK(q.angularDistance(expected) < 1e-7);
  }
}

TEST_CASE("around a circle the orientation error is fourth order in the row spacing") {
  // In the frame that rotates with the contact point the ball turns at a constant rate.
  const double r = 0.01, big = 0.05, angle = 2;
  const auto error = [&](int rows) {
    record::BallTurn turn(r);
    Quaternion last{};
    for (int i = 0; i <= rows; ++i) {
      const double a = angle * i / rows, s = std::sin(a), c = std::cos(a);
      last = turn.go_to(moving(a, big * c, -big * s, big * s, big * c));
    }
    const Eigen::Vector3d axis(-big / r * angle, 0, -angle);
    const Eigen::Quaterniond exact =
        Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
        Eigen::Quaterniond(Eigen::AngleAxisd(axis.norm(), axis.normalized()));
    return eigen(last).angularDistance(exact);
  };
  const double coarse = error(20), fine = error(40);
  CHECK(coarse < 0.01);
  CHECK(std::log2(coarse / fine) > 3.8);
}

TEST_CASE("the columns turn with the ball's twist") {
  // Central differences over two rows of 1 ms have an error of h^2/6 times the third derivative,
  // about |w|^3 / 8; |w| stays below 60 rad/s in both.
  for (const char* name : {"fig2a", "fig2b"}) {
    const file::Table table = run(name, all, "0.001");
    const Scenario scene =
        read_scenario(std::string(BBSIM_SOURCE_DIR) + "/configs/" + name + ".yaml");
    const double r = scene.ball.radius;
    const std::size_t rows = table.columns[0].numbers.size();
    REQUIRE(rows > 1000);
    double worst = 0, largest = 0;
    for (std::size_t i = 1; i + 1 < rows; i += 7) {
      const Eigen::Quaterniond now = orientation(table, i);
      CHECK(now.norm() == Approx(1).epsilon(1e-14));
      const Eigen::Quaterniond step =
          orientation(table, i + 1) * orientation(table, i - 1).inverse();
      const double h = table.columns[0].numbers[i + 1] - table.columns[0].numbers[i - 1];
      const Eigen::AngleAxisd turned(step);
      const Eigen::Vector3d found = turned.angle() / h * turned.axis();
      const Eigen::Vector3d twist(-table.columns[6].numbers[i] / r, table.columns[5].numbers[i] / r,
                                  table.columns[7].numbers[i]);
      worst = std::max(worst, (found - twist).norm());
      largest = std::max(largest, twist.norm());
    }
    CAPTURE(name, worst, largest);
    CHECK(largest > 1);
    CHECK(worst < 1e-3 * largest);
  }
}

TEST_CASE("coarse rows give the same orientation as dense rows") {
  for (const char* name : {"fig2a", "fig2b"}) {
    const file::Table coarse = run(name, all, "0.02"), fine = run(name, all, "0.001");
    double worst = 0;
    for (std::size_t i = 0; i < coarse.columns[0].numbers.size(); ++i) {
      worst = std::max(worst, orientation(coarse, i).angularDistance(orientation(fine, 20 * i)));
    }
    CAPTURE(name, worst);
    CHECK(worst < 2e-6);  // docs/reference/columns.md says 1e-6 for fig2a
  }
}

TEST_CASE("a sliding ball turns at its own rate, and not as if it rolled") {
  const std::vector<std::string> whole{"events.rest=note", "time.end=1"};
  const file::Table fine =
      run("slides", "[t,ball_qw,ball_qx,ball_qy,ball_qz,vx,vy,spin,slip_x,slip_y]", "0.001", whole);
  const double r = 0.026;
  const auto c = numbers_of(fine);
  const auto twist = [&](std::size_t i) {
    return Eigen::Vector3d((c[9][i] - c[6][i]) / r, (c[5][i] - c[8][i]) / r, c[7][i]);
  };
  // The scene gives the initial rotation.
  CHECK((twist(0) - Eigen::Vector3d(20, -110, 15)).norm() < 1e-9);
  for (std::size_t i = 1; i + 1 < fine.columns[0].numbers.size(); i += 7) {
    const Eigen::AngleAxisd turned(orientation(fine, i + 1) * orientation(fine, i - 1).inverse());
    // Central differences over 2 ms at 112 rad/s: (0.112)^2 / 24 of it from its turning and, if
    // friction changes between two rows, its effect in 2 ms, 0.2 rad/s.
    CHECK((turned.angle() / 0.002 * turned.axis() - twist(i)).norm() < 0.3);
  }
  // Rows of 20 ms: if sliding ends between rows, its 6.9 m/s^2 times h^2 / (8 r) is 0.013.
  const file::Table coarse = run("slides", all, "0.02", whole);
  for (std::size_t i = 0; i < coarse.columns[0].numbers.size(); ++i) {
    CHECK(orientation(coarse, i).angularDistance(orientation(fine, 20 * i)) < 0.015);
  }
}

TEST_CASE("requesting the orientation changes no other column") {
  const file::Table with = run("fig2b", "[t,x,y,vx,phi,ball_qw]", "0.02");
  const file::Table without = run("fig2b", "[t,x,y,vx,phi]", "0.02");
  for (std::size_t c = 0; c < without.columns.size(); ++c) {
    CHECK(with.columns[c].numbers == without.columns[c].numbers);
  }
}

}  // namespace bbsim_test::test_ball_turn
