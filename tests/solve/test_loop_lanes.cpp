// Loops in lanes: against the collocation integrator, one by one.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "catch.hpp"
#include "simd/instruction_set.hpp"
#include "solve/integrate.hpp"
#include "solve/loop/loop_lanes.hpp"
#include "solve/radau/radau.hpp"
#include "support/run_in_memory.hpp"

using namespace bbsim;
using namespace bbsim_test;
using solve::loop::group;
using solve::loop::LoopCase;
using solve::loop::LoopLanes;
using solve::loop::states;

namespace bbsim::solve::loop {
extern const Kernels kernels_baseline;
}

namespace {

template <Drives drives>
LoopCase loop_case(const Scenario& scene) {
  using Loop = model::ClosedLoop<model::Shape::full, drives>;
  const model::Model model = model::assemble(scene, false);
  const model::SignalView path = std::get<Loop>(model.system).reference().view();
  REQUIRE(path.harmonic_count <= 1);
  LoopCase one{};
  one.radius = scene.ball.radius;
  one.gravity = scene.gravity;
  if (scene.gimbal.servo) {
    one.omega_n = scene.gimbal.servo->natural_frequency;
    one.zeta = scene.gimbal.servo->damping;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      one.kv[i][j] = scene.controller->kv[i][j];
      one.kp[i][j] = scene.controller->kp[i][j];
    }
    one.start[i] = path.start[i];
    one.rate[i] = path.rate[i];
    if (path.harmonic_count == 1) {
      one.frequency = path.harmonics->frequency;
      one.sine[i] = path.harmonics->sine[i];
      one.cosine[i] = path.harmonics->cosine[i];
    }
  }
  std::copy(model.initial.begin(), model.initial.end(), one.initial);
  return one;
}

LoopCase case_of(const Scenario& scene) {
  return scene.controller->drives == Drives::angle ? loop_case<Drives::angle>(scene)
                                                   : loop_case<Drives::acceleration>(scene);
}

// Scenes whose gains are within 30 % of the given one's.
std::vector<Scenario> with_other_gains(const Scenario& scene, std::size_t count) {
  std::mt19937_64 random(42);
  std::uniform_real_distribution<double> factor(0.7, 1.3);
  std::vector<Scenario> scenes(count, scene);
  for (Scenario& one : scenes) {
    for (auto* gains : {&one.controller->kv, &one.controller->kp}) {
      for (auto& row : *gains) {
        for (double& gain : row) gain *= factor(random);
      }
    }
  }
  return scenes;
}

std::vector<LoopCase> cases_of(const std::vector<Scenario>& scenes) {
  std::vector<LoopCase> cases;
  for (const Scenario& scene : scenes) cases.push_back(case_of(scene));
  return cases;
}

solve::Trajectory truth(const Scenario& scene) {
  const model::Model model = model::assemble(scene, false);
  solve::Trajectory rows(model.row_size());
  const solve::OutputGrid grid(scene.time);
  REQUIRE(solve::integrate(model, Method::radau, {1e-12, 1e-14}, grid, rows, {}).ending ==
          solve::Ending::done);
  return rows;
}

// The error of the ball's place, over all rows, m.
double error_of(const LoopLanes& lanes, int lane, const Scenario& scene) {
  const solve::Trajectory exact = truth(scene);
  double worst = 0;
  for (std::size_t row = 0; row < exact.rows(); ++row) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double ours = lanes.rows()[(row * states + i) * group + static_cast<std::size_t>(lane)];
      // Not a maximum of NaN.
      const double apart = std::abs(ours - exact.row(row)[i]);
      worst = apart <= worst ? worst : apart;
    }
  }
  return worst;
}

std::vector<double> lane_of(const LoopLanes& lanes, std::size_t rows, int lane) {
  std::vector<double> values(rows * states);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = lanes.rows()[i * group + static_cast<std::size_t>(lane)];
  }
  return values;
}

int count_of(const std::array<bool, group>& carried) {
  return static_cast<int>(std::count(carried.begin(), carried.end(), true));
}

// A local error of this tolerance, m, where the ball is within 0.1 m.
double local_error(solve::Tolerances tolerances) {
  return tolerances.rtol * 0.1 + tolerances.atol;
}

Scenario short_literal() {
  Scenario scene = scenario_named("fig2b-literal");
  scene.time = {1, 0.05};
  return scene;
}

}  // namespace

TEST_CASE("loops in lanes follow collocation at every tolerance") {
  const char* name = GENERATE("fig2b", "stiff-servo", "fig2b-literal");
  const double rtol = GENERATE(1e-4, 1e-7, 1e-10, 1e-12);
  Scenario scene = scenario_named(name);
  // As printed the loop grows without bound; long before 0.7 s it is a loop like others.
  if (scene.controller->drives == Drives::acceleration) scene.time = {0.3, 0.01};
  const std::vector<Scenario> scenes = with_other_gains(scene, group);
  const int nodes = GENERATE(8, 12);
  const solve::Tolerances tolerances{rtol, rtol / 100};
  LoopLanes lanes(scene.controller->drives, nodes, tolerances, solve::OutputGrid(scene.time));
  CHECK(count_of(lanes.integrate(cases_of(scenes).data(), group)) == group);
  for (int lane = 0; lane < group; ++lane) {
    CAPTURE(name, rtol, nodes, lane);
    // Some tens of steps, whose errors a stable loop forgets.
    CHECK(error_of(lanes, lane, scenes[static_cast<std::size_t>(lane)]) <
          10 * local_error(tolerances));
  }
}

TEST_CASE("a step's error falls with the order of the method") {
  const Scenario base = scenario_named("fig2b");
  const auto error_at = [&](double h) {
    Scenario scene = base;
    scene.time = {2, 2};
    scene.gimbal.start = {0.05, -0.03, 0, 0};
    const LoopCase one = case_of(scene);
    const solve::loop::Kernel& kernel = solve::loop::kernels_baseline.angle.few;
    std::vector<double> memory(kernel.workspace / sizeof(double) + 8);
    void* place = memory.data();
    std::size_t space = memory.size() * sizeof(double);
    void* const workspace = std::align(64, kernel.workspace, place, space);
    solve::loop::Loops loops;
    alignas(64) double initial[states][group], row[states][group];
    const auto fill = [](double(&lanes)[group], double value) {
      std::fill(std::begin(lanes), std::end(lanes), value);
    };
    fill(loops.radius, one.radius);
    fill(loops.gravity, one.gravity);
    fill(loops.omega_n, one.omega_n);
    fill(loops.zeta, one.zeta);
    fill(loops.frequency, one.frequency);
    for (int i = 0; i < 2; ++i) {
      fill(loops.start[i], one.start[i]);
      fill(loops.rate[i], one.rate[i]);
      fill(loops.sine[i], one.sine[i]);
      fill(loops.cosine[i], one.cosine[i]);
      for (int j = 0; j < 2; ++j) {
        fill(loops.kv[i][j], one.kv[i][j]);
        fill(loops.kp[i][j], one.kp[i][j]);
      }
    }
    for (int i = 0; i < states; ++i) fill(initial[i], one.initial[i]);
    kernel.start(workspace, loops, initial, 1e-6, 1e-8);
    solve::loop::Attempt attempt;
    const int steps = static_cast<int>(std::lround(2 / h));
    for (int i = 0; i < steps; ++i) {
      kernel.attempt(workspace, i * h, h, attempt);
      const double end = i * h + h;
      if (i == steps - 1) kernel.evaluate(workspace, &end, 1, false, row[0]);
      kernel.accept(workspace);
    }
    const solve::Trajectory exact = truth(scene);
    return std::hypot(row[0][0] - exact.row(1)[0], row[1][0] - exact.row(1)[1]);
  };
  // At the ends of steps Radau IIA of eight nodes has order 15; and between nodes 8.
  CHECK(std::log2(error_at(1) / error_at(0.5)) > 10);
}

TEST_CASE("a stiff servo costs loops in lanes no order") {
  const Scenario scene = scenario_named("stiff-servo");
  const std::vector<LoopCase> cases = cases_of(with_other_gains(scene, group));
  const auto steps_at = [&](double rtol) {
    LoopLanes lanes(Drives::angle, 8, {rtol, rtol / 100}, solve::OutputGrid(scene.time));
    CHECK(count_of(lanes.integrate(cases.data(), group)) == group);
    // A Jacobian that is not near all nodes' takes ten turns.
    CHECK(static_cast<double>(lanes.statistics().nonlinear_iterations) <
          3.5 * static_cast<double>(lanes.statistics().jacobian_evaluations));
    return static_cast<double>(lanes.statistics().steps);
  };
  // Four times with order 8, and ten times with the order of a method that suffers.
  CHECK(steps_at(1e-10) / steps_at(1e-5) < 5);
  CHECK(steps_at(1e-4) < 25);
}

TEST_CASE("a loop's rows depend neither on what ran before nor, in one pack, on its lane") {
  const Scenario scene = scenario_named("stiff-servo");
  std::vector<LoopCase> cases = cases_of(with_other_gains(scene, 2 * group));
  const solve::OutputGrid grid(scene.time);
  const solve::Tolerances tolerances{1e-5, 1e-7};
  LoopLanes lanes(Drives::angle, 8, tolerances, grid);
  const int count = GENERATE(1, 3, 8);
  CAPTURE(count);
  const auto rows_of = [&] {
    CHECK(count_of(lanes.integrate(cases.data(), count)) == count);
    std::vector<std::vector<double>> rows;
    for (int lane = 0; lane < count; ++lane) rows.push_back(lane_of(lanes, grid.size(), lane));
    return rows;
  };
  const auto before = rows_of();
  lanes.integrate(&cases[group], group);
  CHECK(rows_of() == before);
  std::reverse(cases.begin(), cases.begin() + count);
  auto reversed = rows_of();
  std::reverse(reversed.begin(), reversed.end());
  // With narrower packs other loops are in a loop's own, and may ask for another turn.
  if (solve::loop::choose_kernels().width == group) CHECK(reversed == before);
  for (std::size_t lane = 0; lane < before.size(); ++lane) {
    for (std::size_t i = 0; i < before[lane].size(); ++i) {
      REQUIRE(reversed[lane][i] == Approx(before[lane][i]).margin(local_error(tolerances)));
    }
  }
}

TEST_CASE("a loop that cannot be carried to the end is given up, and the others are not") {
  const bool alone = GENERATE(false, true);
  const Scenario literal = short_literal();  // infinite at 0.75 s
  Scenario mild = literal;
  mild.controller->kv = {{{2, 0}, {0, -2}}};
  mild.controller->kp = {{{1, 0}, {0, -1}}};
  std::vector<Scenario> scenes = with_other_gains(mild, group);
  const std::vector<std::size_t> bad = {2, 5};
  for (std::size_t lane : bad) scenes[lane] = literal;
  if (alone) scenes.assign(1, literal);
  const int count = static_cast<int>(scenes.size());
  const solve::Tolerances tolerances{1e-6, 1e-8};
  LoopLanes lanes(Drives::acceleration, 8, tolerances, solve::OutputGrid(literal.time));
  const std::vector<LoopCase> cases = cases_of(scenes);
  const auto carried = lanes.integrate(cases.data(), count);
  CHECK(lanes.statistics().steps < 1000);
  if (alone) {
    CHECK(count_of(carried) == 0);
    return;
  }
  for (int lane = 0; lane < group; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    const bool is_bad = std::count(bad.begin(), bad.end(), at) > 0;
    CAPTURE(lane);
    CHECK(carried[at] == !is_bad);
    if (!is_bad) CHECK(error_of(lanes, lane, scenes[at]) < 10 * local_error(tolerances));
  }
  // The same, to the bit, another time.
  std::vector<double> first(lanes.rows(), lanes.rows() + states * group * 21);
  CHECK(lanes.integrate(cases.data(), count) == carried);
  for (int lane = 0; lane < group; ++lane) {
    if (!carried[static_cast<std::size_t>(lane)]) continue;
    for (std::size_t i = 0; i < states * 21; ++i) {
      REQUIRE(lanes.rows()[i * group + static_cast<std::size_t>(lane)] ==
              first[i * group + static_cast<std::size_t>(lane)]);
    }
  }
}

TEST_CASE("a loop that explodes is given up long before its steps are nothing") {
  // Near such an instant each step is a twentieth shorter than the one before: 600 of them, from
  // start to rounding.
  const double gain = GENERATE(-10.0, -1.0, -0.1);
  Scenario scene = scenario_named("fig2b");
  scene.controller->kv[0][0] = gain;
  const std::vector<LoopCase> cases = cases_of(std::vector<Scenario>(group, scene));
  LoopLanes lanes(Drives::angle, 8, {1e-6, 1e-9}, solve::OutputGrid(scene.time));
  CHECK(count_of(lanes.integrate(cases.data(), group)) == 0);
  CHECK(lanes.statistics().steps < 200);
}

TEST_CASE("a loop of no numbers is given up, and the others are not") {
  const Scenario scene = scenario_named("fig2b");
  const std::vector<Scenario> scenes = with_other_gains(scene, group);
  std::vector<LoopCase> cases = cases_of(scenes);
  const double bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity());
  cases[3].kv[0][0] = bad;
  const solve::Tolerances tolerances{1e-6, 1e-8};
  LoopLanes lanes(Drives::angle, 8, tolerances, solve::OutputGrid(scene.time));
  const auto carried = lanes.integrate(cases.data(), group);
  for (int lane = 0; lane < group; ++lane) {
    const auto at = static_cast<std::size_t>(lane);
    CHECK(carried[at] == (lane != 3));
    if (lane != 3) CHECK(error_of(lanes, lane, scenes[at]) < 10 * local_error(tolerances));
  }
}

TEST_CASE("loops in lanes follow BBSIM_SIMD, and agree to the tolerance") {
  const Scenario scene = scenario_named("stiff-servo");
  const std::vector<Scenario> scenes = with_other_gains(scene, group);
  const std::vector<LoopCase> cases = cases_of(scenes);
  const int chosen = solve::loop::choose_kernels().width;
  CHECK((chosen == 2 || chosen == 4 || chosen == 8));
  for (const auto& [name, width] : {std::pair("sse2", 2), {"avx2", 4}, {"avx512", 8}}) {
    if (!simd::find_instruction_set(name)) continue;
    CAPTURE(name);
    setenv("BBSIM_SIMD", name, 1);
    CHECK(solve::loop::choose_kernels().width == width);
    const solve::Tolerances tolerances{1e-6, 1e-8};
    LoopLanes lanes(Drives::angle, 8, tolerances, solve::OutputGrid(scene.time));
    CHECK(count_of(lanes.integrate(cases.data(), group)) == group);
    CHECK(error_of(lanes, 0, scenes[0]) < 10 * local_error(tolerances));
  }
  unsetenv("BBSIM_SIMD");
}

TEST_CASE("loops whose gains cross from axis to axis are no harder") {
  Scenario scene = scenario_named("fig2b");
  scene.controller->kv = {{{0.8, 0.5}, {0.4, -0.9}}};
  const solve::Tolerances tolerances{1e-9, 1e-11};
  LoopLanes lanes(Drives::angle, 12, tolerances, solve::OutputGrid(scene.time));
  CHECK(count_of(lanes.integrate(cases_of({scene}).data(), 1)) == 1);
  CHECK(error_of(lanes, 0, scene) < 10 * local_error(tolerances));
  CHECK(lanes.statistics().nonlinear_iterations < 4 * lanes.statistics().jacobian_evaluations);
}

TEST_CASE("loops in lanes know what they were greatest at, between rows") {
  const char* name = GENERATE("fig2b", "stiff-servo", "fig2b-literal");
  Scenario scene = scenario_named(name);
  if (scene.controller->drives == Drives::acceleration) scene.time.end = 0.5;
  if (std::string(name) == "stiff-servo") scene.time.end = 0.2;
  const std::vector<Scenario> scenes = with_other_gains(scene, group);
  const std::vector<LoopCase> cases = cases_of(scenes);
  const solve::Tolerances tolerances{1e-10, 1e-12};
  Scenario close = scene, far = scene;
  close.time.step = close.time.end / 20000;
  far.time.step = far.time.end;
  LoopLanes rows(scene.controller->drives, 12, tolerances, solve::OutputGrid(close.time));
  LoopLanes ends(scene.controller->drives, 12, tolerances, solve::OutputGrid(far.time));
  const solve::OutputGrid grid(close.time);
  CHECK(count_of(rows.integrate(cases.data(), group)) == group);
  CHECK(count_of(ends.integrate(cases.data(), group)) == group);
  for (std::size_t lane = 0; lane < group; ++lane) {
    double most[solve::loop::looks] = {};
    const LoopCase& one = cases[lane];
    for (std::size_t row = 0; row < grid.size(); ++row) {
      const auto state = [&](std::size_t i) {
        return rows.rows()[(row * states + i) * group + lane];
      };
      const auto raise = [&](solve::loop::Look look, double size) {
        most[look] = std::max(most[look], size);
      };
      const double a = std::pow(std::sin(state(5) / 2), 2), b = std::pow(std::sin(state(6) / 2), 2);
      raise(solve::loop::versine, 2 * (a + b) - 4 * a * b);
      raise(solve::loop::rate_squared, state(7) * state(7) + state(8) * state(8));
      raise(solve::loop::distance_squared, state(0) * state(0) + state(1) * state(1));
      double error = 0;
      for (std::size_t i = 0; i < 2; ++i) {
        const double angle = one.frequency * grid[row];
        const double from = state(i) - one.start[i] - one.rate[i] * grid[row] -
                            one.sine[i] * std::sin(angle) - one.cosine[i] * std::cos(angle);
        error += from * from;
      }
      raise(solve::loop::error_squared, error);
    }
    for (int look = 0; look < solve::loop::looks; ++look) {
      CAPTURE(name, lane, look);
      const double found = ends.greatest().of[look][lane];
      // Of rows h apart the greatest is below the true one by h^2 / 8 of its curvature, in servos
      // of 2000 rad/s some 1e-4; and never above it.
      CHECK(found >= most[look] * (1 - 1e-8));
      CHECK(found <= most[look] * (1 + 1e-3));
      CHECK(rows.greatest().of[look][lane] == found);
    }
  }
}

TEST_CASE("rows of places alone are those of all states, and end with all") {
  const Scenario scene = scenario_named("fig2b");
  const std::vector<LoopCase> cases = cases_of(with_other_gains(scene, group));
  const solve::OutputGrid grid(scene.time);
  LoopLanes all(Drives::angle, 12, {1e-9, 1e-11}, grid),
      places(Drives::angle, 12, {1e-9, 1e-11}, grid);
  places.leave_out_all_but_places();
  all.integrate(cases.data(), group);
  places.integrate(cases.data(), group);
  for (std::size_t row = 0; row < grid.size(); ++row) {
    const std::size_t count = row + 1 < grid.size() ? 2 : states;
    for (std::size_t i = 0; i < count * group; ++i) {
      const double value = all.rows()[row * all.row_size() + i];
      // The polynomial's end and the last node are the same but for rounding.
      REQUIRE(places.rows()[row * places.row_size() + i] ==
              Approx(value).epsilon(1e-12).margin(1e-16));
    }
  }
}
