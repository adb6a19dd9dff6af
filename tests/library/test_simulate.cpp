// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Cases as arrays, through the shared library.
#include <algorithm>
#include <bbsim/bbsim.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "catch.hpp"

namespace bbsim_test::test_simulate {

namespace {

const std::string configs = BBSIM_SOURCE_DIR "/configs/";
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

bbsim::Scenario shipped(const std::string& name) {
  return bbsim::Scenario::from_file(configs + name + ".yaml")
      .set("time.end", 1)
      .set("time.step", 0.02);
}

std::vector<double> even(double from, double to, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    numbers.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(count - 1));
  }
  return numbers;
}

bbsim::Result run_at(const bbsim::Scenario& scene, double radius,
                     const std::vector<std::string>& columns) {
  std::string list;
  for (const std::string& name : columns) list += (list.empty() ? "[" : ", ") + name;
  return bbsim::run(
      bbsim::Scenario(scene).set("ball.radius", radius).set("output.columns", list + "]"));
}

// The message of the only fault.
template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const bbsim::ScenarioError& error) {
    return error.what();
  }
  return "nothing was refused";
}

std::string refusal_of(const bbsim::SimulateOptions& options, std::size_t count = 2,
                       const std::vector<bbsim::CaseKey>& keys = {}) {
  return refusal([&] { (void)bbsim::simulate(shipped("fig2b"), count, keys, options); });
}

bool tells(const std::string& message, const std::vector<std::string>& parts) {
  INFO(message);
  const bool all = std::ranges::all_of(
      parts, [&](const std::string& part) { return message.find(part) != std::string::npos; });
  CHECK(all);
  return all;
}

}  // namespace

TEST_CASE("columns of cases are those of runs, in lanes and alone") {
  struct One {
    const char* name;
    std::size_t count;
    std::vector<std::string> columns;
    double tolerance;  // of the lanes, which step in another way, with rtol 1e-8; 0: bit for bit
  };
  const One one = GENERATE(values<One>({
      {"fig2a", 40, {"t", "x", "y"}, 1e-8},
      {"fig2b", 40, {"t", "x", "y"}, 1e-8},
      {"fig2b", 3, {"t", "gamma", "phi_rate", "x"}, 0},
      {"rig",
       20,
       {"x", "vx", "t", "phi", "theta_rate", "phi_acceleration", "x_measured", "phi_command",
        "normal_force"},
       1e-6},
      {"rig", 3, {"x", "x_measured", "phi_command", "gamma"}, 0},
      {"slides", 3, {"t", "x", "spin"}, 0},
  }));
  CAPTURE(one.name, one.count);
  const bbsim::Scenario scene = shipped(one.name);
  const std::vector<double> radii = even(0.015, 0.02, one.count);
  bbsim::SimulateOptions options;
  options.columns = one.columns;
  const bbsim::Cases cases = bbsim::simulate(scene, one.count, {{"ball.radius", radii}}, options);
  REQUIRE(cases.times == 51);
  std::vector<double> times;
  for (const double t : {0.0, 0.02, 0.02, 0.34, 0.5, 1.0}) times.push_back(t);
  options.times = times;
  const bbsim::Cases some = bbsim::simulate(scene, one.count, {{"ball.radius", radii}}, options);
  REQUIRE(some.times == times.size());
  for (std::size_t i = 0; i < one.count; ++i) {
    CAPTURE(i);
    CHECK(cases.status[i] == bbsim::Status::done);
    CHECK(cases.reason[i].empty());
    const bbsim::Result run = run_at(scene, radii[i], one.columns);
    for (std::size_t c = 0; c < one.columns.size(); ++c) {
      CAPTURE(one.columns[c]);
      double largest = 0, most = 0, most_at_times = 0;
      for (std::size_t k = 0; k < cases.times; ++k) {
        largest = std::max(largest, std::abs(run.values[c][k]));
        most = std::max(most, std::abs(cases.columns[c][i * cases.times + k] - run.values[c][k]));
      }
      for (std::size_t k = 0; k < times.size(); ++k) {
        const auto row = static_cast<std::size_t>(std::lround(times[k] / 0.02));
        most_at_times = std::max(
            most_at_times, std::abs(some.columns[c][i * times.size() + k] - run.values[c][row]));
      }
      CHECK(most <= one.tolerance * std::max(1.0, largest));
      CHECK(most_at_times <= one.tolerance * std::max(1.0, largest));
    }
  }
}

TEST_CASE("measures of cases are those of a sweep, with columns or without") {
  const std::string name = GENERATE("fig2a", "fig2b", "rig", "slides");
  const std::vector<double> radii = even(0.015, 0.02, 33);
  std::vector<std::string> measures{"end_x", "max_tilt", "rms_x"};
  if (name == "fig2b" || name == "rig") measures = {"end_x", "max_tilt", "rms_tracking_error"};
  bbsim::SweepOptions sweep;
  sweep.measures = measures;
  sweep.vary = {{"ball.radius", "linear:0.015:0.02:33"}};
  const bbsim::Table table = bbsim::sweep(shipped(name), sweep);
  bbsim::SimulateOptions options;
  options.measures = measures;
  options.times = GENERATE(std::optional<std::vector<double>>{}, std::vector<double>{0.1, 0.7});
  if (options.times) options.columns = {"x"};
  const bbsim::Cases cases = bbsim::simulate(shipped(name), 33, {{"ball.radius", radii}}, options);
  for (std::size_t m = 0; m < measures.size(); ++m) {
    for (std::size_t i = 0; i < radii.size(); ++i) {
      CAPTURE(name, measures[m], i);
      // A radius may differ in its last digit.
      CHECK(cases.measures[m][i] ==
            Approx(table.column(measures[m]).numbers[i]).epsilon(1e-9).margin(1e-12));
    }
  }
}

TEST_CASE("a case that begins within a run, at its state, continues the run") {
  // A given motion, a loop, torques.
  const std::string name = GENERATE("fig2b", "traced", "sags", "fig2a");
  const bbsim::Scenario scene = shipped(name).set("solver.rtol", 1e-11).set("solver.atol", 1e-13);
  bbsim::SimulateOptions options;
  options.columns = {"x", "y", "vx", "vy", "phi", "theta", "phi_rate", "theta_rate", "spin", "t"};
  const bbsim::Cases whole = bbsim::simulate(scene, 1, {}, options);
  options.begin = {0.2, 0, 0.5};
  options.end = {0.6, 1, 1};
  options.own_times = true;
  options.times = std::vector<double>{0.2, 0.4, 0.6, 0, 0.02, 1, 0.5, 0.52, 0.98};
  for (const double begin : options.begin) {
    const auto row = static_cast<std::size_t>(std::lround(begin / 0.02));
    bbsim::State& state = options.start.emplace_back();
    for (std::size_t k = 0; k < state.size(); ++k) state[k] = whole.columns[k][row];
  }
  const bbsim::Cases parts = bbsim::simulate(scene, 3, {}, options);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(parts.status[i] == bbsim::Status::done);
    for (std::size_t k = 0; k < 3; ++k) {
      const double t = (*options.times)[3 * i + k];
      CHECK(parts.columns.back()[3 * i + k] == t);
      const auto row = static_cast<std::size_t>(std::lround(t / 0.02));
      for (std::size_t c = 0; c < options.columns.size(); ++c) {
        CAPTURE(name, i, t, options.columns[c]);
        // The whole run carries on states that a start lacks, such as a motor's current.
        CHECK(parts.columns[c][3 * i + k] ==
              Approx(whole.columns[c][row]).epsilon(1e-7).margin(1e-7));
      }
    }
  }
  // Without times, the rows of the scenario outside of a case have no numbers.
  options.times.reset();
  const bbsim::Cases rows = bbsim::simulate(scene, 3, {}, options);
  REQUIRE(rows.times == 51);
  for (std::size_t k = 0; k < 51; ++k) {
    CHECK(std::isfinite(rows.columns[0][k]) == (k >= 10 && k <= 30));
    CHECK(std::isfinite(rows.columns.back()[2 * 51 + k]) == (k >= 25));
  }
}

TEST_CASE("each case has its own status and reason") {
  const bbsim::Scenario rig = bbsim::Scenario::from_file(configs + "rig.yaml").set("time.end", 4);
  bbsim::SimulateOptions options;
  options.columns = {"t", "x"};
  options.measures = {"end_x"};
  // The second has no such radius, the third begins beside the plate.
  const std::vector<bbsim::CaseKey> keys{{"ball.radius", {0.02, -1, 0.02}},
                                         {"ball.position.0", {0.05, 0.05, 0.5}}};
  const bbsim::Cases cases = bbsim::simulate(rig, 3, keys, options);
  CHECK(cases.status ==
        std::vector{bbsim::Status::done, bbsim::Status::refused, bbsim::Status::stopped});
  CHECK(cases.reason[0].empty());
  CHECK(tells(cases.reason[1], {"ball.radius", "found -1", "allowed: "}));
  CHECK(cases.reason[2] == "edge");
  CHECK(std::isnan(cases.measures[0][1]));
  for (std::size_t c = 0; c < 2; ++c) {
    const double* const first = cases.columns[c].data();
    CHECK(std::all_of(first, first + cases.times, [](double x) { return std::isfinite(x); }));
    CHECK(std::all_of(first + cases.times, first + 2 * cases.times,
                      [](double x) { return std::isnan(x); }));
    CHECK(std::isnan(first[3 * cases.times - 1]));
  }
  const bbsim::Cases lacks = bbsim::simulate(
      shipped("rig"), 2, {{"plate.inertia", {}, {"", "null"}}}, {.columns = {"motor_torque_phi"}});
  CHECK(lacks.status[0] == bbsim::Status::done);
  CHECK(lacks.status[1] == bbsim::Status::refused);
  CHECK(tells(lacks.reason[1], {"plate.inertia"}));
  options.events = false;
  CHECK(bbsim::simulate(rig, 3, keys, options).status[2] == bbsim::Status::done);
  // If no case is sound, the first one's faults are the caller's.
  CHECK(tells(refusal([&] {
                (void)bbsim::simulate(rig, 2, {{"ball.radius", {-1, -2}}}, options);
              }),
              {"case 0", "ball.radius"}));
  // A loop that runs away.
  const bbsim::Cases gone =
      bbsim::simulate(shipped("fig2b-literal").set("time.end", 1e5).set("time.step", 10), 1, {},
                      {.columns = {"x"}});
  CHECK(gone.status[0] == bbsim::Status::failed);
  CHECK_FALSE(gone.reason[0].empty());
}

TEST_CASE("texts, and keys that only some cases have") {
  bbsim::SimulateOptions options;
  options.measures = {"max_distance"};
  const bbsim::Cases cases = bbsim::simulate(
      shipped("fig2b"), 3,
      {{"ball.radius", {}, {"2 cm", "", "0.02"}}, {"ball.position", {}, {"", "[0, 0]", ""}}},
      options);
  CHECK(cases.measures[0][0] == cases.measures[0][2]);
  CHECK(cases.measures[0][0] != cases.measures[0][1]);
  const bbsim::Cases none = bbsim::simulate(shipped("fig2b"), 0, {}, options);
  CHECK(none.status.empty());
  CHECK(none.measures == std::vector<std::vector<double>>{{}});
}

TEST_CASE("odd arguments are refused with their place and what is allowed") {
  CHECK(tells(refusal_of({.columns = {"phy"}}), {"columns: found phy", "did you mean phi"}));
  CHECK(tells(refusal_of({.columns = {"x]"}}), {"columns: found x]", "allowed: "}));
  CHECK(tells(refusal_of({.columns = {"x", "x"}}), {"columns: found x again", "once"}));
  CHECK(tells(refusal_of({.columns = {"phi_torque"}}), {"columns: found phi_torque, but"}));
  CHECK(tells(refusal_of({.measures = {"max_tild"}}), {"max_tild", "did you mean max_tilt"}));
  CHECK(tells(refusal_of({}, 1, {{"ball.radios", {0.01}}}), {"ball.radios", "radius"}));
  CHECK(tells(refusal_of({}, 2, {{"ball.radius", {0.01}}}), {"ball.radius", "1 cases", "for 2"}));
  CHECK(tells(refusal_of({}, 1, {{"ball.radius", {not_a_number}}}), {"case 0", "ball.radius"}));
  CHECK(tells(refusal_of({}, 1, {{"ball.radius", {1}}, {"ball.radius", {1}}}), {"twice"}));
  CHECK(tells(refusal_of({.times = std::vector{0.5, 0.4}}), {"time 1", "do not decrease"}));
  CHECK(tells(refusal_of({.times = std::vector{0.5, 1.1}}), {"time 1", "0 to 1 s"}));
  CHECK(tells(refusal_of({.times = std::vector{-0.1}}), {"time 0", "0 to 1 s"}));
  for (const double time : {not_a_number, HUGE_VAL, -HUGE_VAL}) {
    CHECK(tells(refusal_of({.times = std::vector{time}}), {"time 0", "allowed: "}));
  }
  CHECK(tells(refusal_of({.times = std::vector{0.1, 0.2, 0.3}, .own_times = true}), {"times"}));
  CHECK(tells(refusal_of({.times = std::vector{0.1, 0.3}, .own_times = true, .begin = {0, 0.4}}),
              {"case 1", "0.4 to 1 s"}));
  CHECK(tells(refusal_of({.begin = {0.1}}), {"begin", "1 cases", "2"}));
  CHECK(tells(refusal_of({.begin = {0, -0.1}}), {"begin: case 1", "-0.1"}));
  CHECK(tells(refusal_of({.begin = {0, 1}}), {"begin: case 1", "below 1 s"}));
  CHECK(tells(refusal_of({.begin = {0, not_a_number}}), {"begin: case 1"}));
  CHECK(tells(refusal_of({.begin = {0, 0.5}, .end = {1, 0.5}}), {"end: case 1", "0.5"}));
  CHECK(tells(refusal_of({.end = {1, not_a_number}}), {"end: case 1"}));
  CHECK(tells(refusal_of({.start = {bbsim::State{}}}), {"start", "1 cases"}));
  CHECK(tells(refusal_of({.start = {bbsim::State{}, {0, not_a_number}}}), {"start: case 1: y"}));
  CHECK(tells(refusal_of({.threads = 1'000'000}), {"threads"}));
  CHECK(tells(refusal_of({}, std::size_t{1} << 62U), {"cases"}));
  const bbsim::Scenario whole = bbsim::Scenario::from_file(configs + "fig2b.yaml");
  CHECK(tells(refusal([&] {
                (void)bbsim::simulate(whole, 1, {{"time.end", {2}}}, {.columns = {"x"}});
              }),
              {"times: found none"}));
  // A table covers only its rows.
  const bbsim::Cases outside =
      bbsim::simulate(shipped("recorded"), 2, {}, {.begin = {0, 1e4}, .end = {1, 1e4 + 1}});
  CHECK(outside.status[1] == bbsim::Status::refused);
  CHECK(tells(outside.reason[1], {"tables cover"}));
}

TEST_CASE("cases end when their caller asks, and keep what is done") {
  bbsim::SimulateOptions options;
  options.columns = {"x"};
  options.threads = 2;
  options.goes_on = [](double) { return false; };
  const bbsim::Cases ended =
      bbsim::simulate(shipped("rig"), 4000, {{"ball.radius", even(0.01, 0.02, 4000)}}, options);
  const auto undone = std::ranges::find(ended.status, bbsim::Status::interrupted);
  CHECK(undone != ended.status.end());
  for (std::size_t i = 0; i < ended.status.size(); ++i) {
    const bool done = ended.status[i] == bbsim::Status::done;
    CHECK(done == std::isfinite(ended.columns[0][(i + 1) * ended.times - 1]));
  }
}

}  // namespace bbsim_test::test_simulate
