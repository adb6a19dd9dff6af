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
#include "solve/radau/radau.hpp"
#include "solve/rosenbrock/loop_lanes.hpp"
#include "support/run_in_memory.hpp"

using namespace bbsim;
using namespace bbsim_test;
using solve::rosenbrock::group;
using solve::rosenbrock::LoopCase;
using solve::rosenbrock::LoopLanes;
using solve::rosenbrock::states;

namespace bbsim::solve::rosenbrock {
extern const LaneKernels kernels_baseline;
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
  const double rtol = GENERATE(1e-4, 1e-7, 1e-10);
  Scenario scene = scenario_named(name);
  // As printed the loop grows without bound; before 0.7 s it is a loop like others.
  if (scene.controller->drives == Drives::acceleration) scene.time = {0.5, 0.01};
  const std::vector<Scenario> scenes = with_other_gains(scene, group);
  const solve::Tolerances tolerances{rtol, rtol / 100};
  LoopLanes lanes(scene.controller->drives, tolerances, solve::OutputGrid(scene.time));
  CHECK(count_of(lanes.integrate(cases_of(scenes).data(), group)) == group);
  for (int lane = 0; lane < group; ++lane) {
    CAPTURE(name, rtol, lane);
    // Some tens to hundreds of steps, whose errors a stable loop forgets.
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
    const solve::rosenbrock::Kernel& kernel = solve::rosenbrock::kernels_baseline.angle;
    std::vector<double> memory(kernel.workspace / sizeof(double) + 8);
    void* place = memory.data();
    std::size_t space = memory.size() * sizeof(double);
    void* const workspace = std::align(64, kernel.workspace, place, space);
    solve::rosenbrock::Loops loops;
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
    double errors[group];
    const int steps = static_cast<int>(std::lround(2 / h));
    for (int i = 0; i < steps; ++i) {
      kernel.attempt(workspace, i * h, h, errors);
      const double end = i * h + h;
      if (i == steps - 1) kernel.evaluate(workspace, &end, 1, row[0]);
      kernel.accept(workspace);
    }
    const solve::Trajectory exact = truth(scene);
    return std::hypot(row[0][0] - exact.row(1)[0], row[1][0] - exact.row(1)[1]);
  };
  CHECK(std::log2(error_at(0.1) / error_at(0.05)) > 4.5);
  CHECK(std::log2(error_at(0.05) / error_at(0.025)) > 4.5);
}

TEST_CASE("a stiff servo costs loops in lanes no order") {
  const Scenario scene = scenario_named("stiff-servo");
  const std::vector<LoopCase> cases = cases_of(with_other_gains(scene, group));
  const auto steps_at = [&](double rtol) {
    LoopLanes lanes(Drives::angle, {rtol, rtol / 100}, solve::OutputGrid(scene.time));
    CHECK(count_of(lanes.integrate(cases.data(), group)) == group);
    return static_cast<double>(lanes.statistics().steps);
  };
  // Ten times with order 5, and a hundred times with the order 2.5 of a method that suffers.
  CHECK(steps_at(1e-10) / steps_at(1e-5) < 12);
  CHECK(steps_at(1e-4) < 50);
}

TEST_CASE("a loop's rows depend neither on its lane nor on what ran before") {
  const Scenario scene = scenario_named("stiff-servo");
  std::vector<LoopCase> cases = cases_of(with_other_gains(scene, 2 * group));
  const solve::OutputGrid grid(scene.time);
  LoopLanes lanes(Drives::angle, {1e-5, 1e-7}, grid);
  const int count = GENERATE(1, 3, 8);
  CAPTURE(count);
  CHECK(count_of(lanes.integrate(cases.data(), count)) == count);
  std::vector<std::vector<double>> before;
  for (int lane = 0; lane < count; ++lane) before.push_back(lane_of(lanes, grid.size(), lane));
  lanes.integrate(&cases[group], group);
  std::reverse(cases.begin(), cases.begin() + count);
  CHECK(count_of(lanes.integrate(cases.data(), count)) == count);
  for (int lane = 0; lane < count; ++lane) {
    CHECK(lane_of(lanes, grid.size(), lane) == before[static_cast<std::size_t>(count - 1 - lane)]);
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
  LoopLanes lanes(Drives::acceleration, tolerances, solve::OutputGrid(literal.time));
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
  LoopLanes lanes(Drives::angle, {1e-6, 1e-9}, solve::OutputGrid(scene.time));
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
  LoopLanes lanes(Drives::angle, tolerances, solve::OutputGrid(scene.time));
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
  const int chosen = solve::rosenbrock::choose_kernels().width;
  CHECK((chosen == 2 || chosen == 4 || chosen == 8));
  for (const auto& [name, width] : {std::pair("sse2", 2), {"avx2", 4}, {"avx512", 8}}) {
    if (!simd::find_instruction_set(name)) continue;
    CAPTURE(name);
    setenv("BBSIM_SIMD", name, 1);
    CHECK(solve::rosenbrock::choose_kernels().width == width);
    const solve::Tolerances tolerances{1e-6, 1e-8};
    LoopLanes lanes(Drives::angle, tolerances, solve::OutputGrid(scene.time));
    CHECK(count_of(lanes.integrate(cases.data(), group)) == group);
    CHECK(error_of(lanes, 0, scenes[0]) < 10 * local_error(tolerances));
  }
  unsetenv("BBSIM_SIMD");
}
