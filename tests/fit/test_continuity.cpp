// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Joined windows: bbsim fit --continuity.

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "api/fit.hpp"
#include "base/error.hpp"
#include "catch.hpp"
#include "fit/data.hpp"
#include "rig.hpp"

namespace bbsim_test::test_continuity {

using namespace bbsim;

namespace {

api::FitResult fitted(const Folder& folder, const std::vector<std::string>& free,
                      const std::string& window, bool continuity, double hold_out = 0,
                      api::Watch* watch = nullptr) {
  const ScenarioFamily family(folder / "rig.yaml", {});
  api::FitRequest request{family, {folder / "log.csv"}, {}, free, window};
  request.continuity = continuity;
  request.hold_out = hold_out;
  request.threads = 2;
  api::Watch nobody;
  return api::fit(request, false, watch != nullptr ? *watch : nobody);
}

// Stops a fit after the given number of iterations.
class Patience : public api::Watch {
 public:
  explicit Patience(std::size_t iterations) : left_(iterations) {}
  void update(double, const std::string&) override {
    if (left_ == 0 || --left_ == 0) stop_ = true;
  }
  const std::atomic<bool>* stop() override { return &stop_; }

 private:
  std::size_t left_;
  std::atomic<bool> stop_ = false;
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("joined windows give the fit of one long window") {
  const Folder folder;
  folder.put("log.csv", log_text(5e-4, 1.1, 0.01));
  folder.put("rig.yaml", assumed_rig);
  const std::vector<std::string> free = {"ball.inertia_factor", "gimbal.motion.phi.table.scale",
                                         "gimbal.motion.phi.table.offset"};
  const api::FitResult joined = fitted(folder, free, "2 s", true);
  const api::FitResult whole = fitted(folder, free, "20 s", false);
  const api::FitResult apart = fitted(folder, free, "2 s", false);
  CAPTURE(joined.text, whole.text, apart.text);
  REQUIRE(whole.fitted.windows == 1);
  REQUIRE(joined.fitted.windows == 10);
  CHECK(joined.fitted.joints == 9U);
  CHECK(contains(joined.text, "802 numbers in 10 windows of 2 s, joined at 9 joints"));
  CHECK(contains(joined.json, R"("joints": 9)"));
  CHECK_FALSE(apart.fitted.joints);
  for (std::size_t k = 0; k < free.size(); ++k) {
    const fit::Parameter &one = joined.fitted.parameters[k], &same = whole.fitted.parameters[k];
    CAPTURE(free[k], one.estimate, same.estimate, same.sd);
    // Joining ends once a step changes the sum of squares by less than 1e-12: 1e-6 of its root.
    CHECK(std::abs(one.estimate - same.estimate) < 1e-5 * same.sd);
    // Differences over 1e-3 of a start give derivatives to 1e-5 over a run of 20 s.
    CHECK(one.sd == Approx(same.sd).epsilon(1e-4));
    CHECK(one.low == Approx(same.low).margin(1e-3 * same.sd));
    CHECK(one.high == Approx(same.high).margin(1e-3 * same.sd));
    // Free starts discard this information.
    CHECK(one.sd < 0.5 * apart.fitted.parameters[k].sd);
  }
  for (std::size_t c = 0; c < 2; ++c) {
    CHECK(joined.fitted.columns[c].rms == Approx(whole.fitted.columns[c].rms).epsilon(1e-8));
  }
}

TEST_CASE("joined windows converge from where one long window fails") {
  const auto loop = [](const std::string& gains) {
    return R"(
ball: {radius: 1 cm, position: [2 cm, -1 cm]}
gimbal: {servo: {natural_frequency: 5 Hz, damping: 0.8}}
controller:
  gravity_compensation: )" +
           gains + R"(
  drives: angle
  reference: {lissajous: {amplitude: [5 cm, 4 cm], rate: [2.1, 3.3]}}
time: {end: 20, step: 50 ms}
output: {columns: [t, x, y, phi, theta]}
)";
  };
  const Folder folder;
  std::istringstream lines(log_text(3e-4, 1, 0, 1, loop("{kp: 10, kv: 8}")));
  std::string line, text;
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0, 6e-5);  // rad
  std::getline(lines, text);
  while (std::getline(lines, line)) {
    std::array<double, 5> row{};
    REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", row.data(), &row[1], &row[2], &row[3],
                        &row[4]) == 5);
    row[3] += noise(random);
    row[4] += noise(random);
    text += "\n";
    for (std::size_t c = 0; c < row.size(); ++c) text += (c > 0 ? "," : "") + number_text(row[c]);
  }
  folder.put("log.csv", text + "\n");
  const std::vector<std::string> free = {"controller.gravity_compensation.kp",
                                         "controller.gravity_compensation.kv"};
  folder.put("rig.yaml", loop("{kp: 10, kv: 8}"));
  const api::FitResult whole = fitted(folder, free, "20 s", false);
  // The servos' delay makes these gains unstable.
  folder.put("rig.yaml", loop("{kp: 20, kv: 0.5}"));
  const api::FitResult joined = fitted(folder, free, "1 s", true);
  CAPTURE(joined.text, whole.text);
  CHECK(joined.fitted.joints == 19U);
  for (std::size_t k = 0; k < 2; ++k) {
    const fit::Parameter &one = joined.fitted.parameters[k], &same = whole.fitted.parameters[k];
    CAPTURE(free[k], one.estimate, same.estimate, same.sd);
    // Each fit ends when the sum of squares, 1604, changes by less than a relative 1e-12.
    CHECK(std::abs(one.estimate - same.estimate) < 4e-5 * same.sd);
    CHECK(one.sd == Approx(same.sd).epsilon(1e-4));
  }
  // The joined windows need fewer iterations than one long window gets here.
  Patience patience(joined.fitted.iterations);
  const api::FitResult astray = fitted(folder, free, "20 s", false, 0, &patience);
  CAPTURE(joined.fitted.iterations, astray.text);
  CHECK(astray.code == ExitCode::interrupted);
  CHECK(astray.fitted.columns[0].rms > 1);
}

TEST_CASE("windows join if no gap is between them") {
  const Folder folder;
  std::istringstream lines(log_text(5e-4, 1.1));
  std::string text;
  int row = 0;
  for (std::string line; std::getline(lines, line); ++row) {
    const bool is_lost = row > 150 && row < 170;  // 7.5 s to 8.5 s
    if (!is_lost && row % 17 != 3) text += line + "\n";
  }
  folder.put("log.csv", text);
  folder.put("rig.yaml", assumed_rig);
  const std::vector<std::string> free = {"ball.inertia_factor", "gimbal.motion.phi.table.scale"};
  const api::FitResult made = fitted(folder, free, "2 s", true);
  CAPTURE(made.text);
  CHECK(made.fitted.windows == 10);
  CHECK(made.fitted.joints == 8U);
  CHECK(std::abs(made.fitted.parameters[0].estimate - 0.43) < 3.9 * made.fitted.parameters[0].sd);
  CHECK(std::abs(made.fitted.parameters[1].estimate - 1.1) < 3.9 * made.fitted.parameters[1].sd);
  // A held-out window is a gap.
  folder.put("log.csv", log_text(5e-4, 1.1));
  const api::FitResult held = fitted(folder, free, "2 s", true, 0.2);
  CHECK(held.fitted.windows == 8);
  CHECK(held.fitted.joints == 7U - 1U);
  REQUIRE(held.fitted.columns[0].held);
  CHECK(*held.fitted.columns[0].held == Approx(5e-4).epsilon(0.25));
}

TEST_CASE("windows are not joined if their starts are not the whole state") {
  const auto refused = [](const std::string& controller, const std::string& ball = "") {
    const Folder folder;
    folder.put("log.csv", log_text(5e-4));
    folder.put("rig.yaml", "ball: {radius: 1 cm" + ball +
                               "}\ngimbal: {servo: {natural_frequency: 5 Hz, damping: 0.8}}\n"
                               "controller: {drives: angle, reference: {point: [0, 0]}, " +
                               controller + "}\ntime: {end: 20, step: 50 ms}\n");
    return message_of<InputError>([&] {
      static_cast<void>(fitted(folder, {"gimbal.servo.natural_frequency"}, "2 s", true));
    });
  };
  CHECK(contains(refused("gravity_compensation: {kp: 10, kv: 8}, sampling: {period: 20 ms}"),
                 "--continuity: found a sampled controller, whose state is not part of a window's "
                 "start; allowed: scenes with no state but that of the ball and of the gimbal"));
}

}  // namespace bbsim_test::test_continuity
