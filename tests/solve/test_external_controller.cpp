// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs with an external controller: when it is called, its input, and the effect of its faults.
#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "catch.hpp"
#include "model/control/external_controller.hpp"
#include "model/control/sampled_controller.hpp"
#include "model/model.hpp"
#include "scenario/columns.hpp"
#include "solve/integrate.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_external_controller {

using namespace bbsim;

namespace {

// Roughly the rig of configs/step.yaml, with every sensor effect.
Scenario step() {
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.ball.position = {-0.03, 0.01};
  scene.gimbal.servo = Servo{30, 0.8};
  scene.controller->law = Law::pid;
  scene.controller->kp = {{{0.7, 0}, {0, -0.7}}};
  scene.controller->kv = {{{0.6, 0}, {0, -0.6}}};
  scene.controller->ki = {{{0.35, 0}, {0, -0.35}}};
  scene.controller->limit = 0.2;
  scene.controller->sampling = Sampling{0.02, 0.01, 0.002, 0.04};
  Sensor sensor;
  sensor.noise = 2e-4;
  sensor.delay = 0.01;
  sensor.dropout = 0.2;
  scene.controller->sensor = sensor;
  scene.time = {3, 0.02};
  return scene;
}

// The built-in law behind the interface, without its limit and resolution, which belong to the rig.
class BuiltIn : public model::ExternalController {
 public:
  explicit BuiltIn(const Scenario& scene)
      : loop_(*model::assemble(scene, false).rig->sampled), controller_(loop_) {}

  void begin() override {
    controller_ = model::SampledController(loop_);
    ++runs;
  }
  model::Commands command(const model::ControllerSample& sample, double* own) override {
    if (sample.number == stops_at) stop = true;
    if (sample.number == fails_at) throw model::ControllerFault("it fails", interrupts);
    times.push_back(sample.t);
    if (own != nullptr && numbers) *own = double(sample.number);
    const double servo[4] = {sample.servo[0], sample.servo[1], sample.servo_rate[0],
                             sample.servo_rate[1]};
    const Pair two = controller_.command(sample.seen, servo, sample.reference);
    return {two[0], two[1], 0};
  }

  std::size_t fails_at = std::numeric_limits<std::size_t>::max();
  std::size_t stops_at = std::numeric_limits<std::size_t>::max();
  std::atomic<bool> stop = false;
  int runs = 0;
  bool interrupts = false, numbers = false;
  std::vector<double> times;

 private:
  model::SampledLoop loop_;
  model::SampledController controller_;
};

struct Made {
  solve::Outcome outcome;
  std::vector<std::vector<double>> rows;
};

Made run(const model::Model& model, const Scenario& scene, const solve::Watch& watch = {}) {
  solve::Trajectory rows(model.row_size());
  const solve::OutputGrid grid(scene.time);
  Made made{solve::integrate(model, Method::automatic, {1e-9, 1e-11}, grid, rows, watch), {}};
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    made.rows.emplace_back(rows.row(i), rows.row(i) + model.row_size());
  }
  return made;
}

Scenario with_own(Scenario scene, std::vector<std::string> columns = {}) {
  scene.controller->law = Law::own;
  scene.controller->own.emplace();
  for (const std::string& name : columns) {
    scenario::own_column(name);
    scene.output.columns.push_back(name);
  }
  return scene;
}

}  // namespace

TEST_CASE("the built-in law behind the interface gives the same trajectory bit for bit") {
  const Scenario scene = step();
  const model::Model built_in = model::assemble(scene, true);
  model::Model own = model::assemble(with_own(scene), true);
  const auto controller = std::make_shared<BuiltIn>(scene);
  own.rig->sampled->external = controller;
  const Made wanted = run(built_in, scene), found = run(own, scene);
  CHECK(wanted.outcome.ending == solve::Ending::done);
  CHECK(found.outcome.ending == solve::Ending::done);
  CHECK(found.rows == wanted.rows);
  CHECK(controller->runs == 1);
  REQUIRE(controller->times.size() == 151);
  for (std::size_t i = 0; i < controller->times.size(); ++i) {
    CHECK(controller->times[i] == double(i) * 0.02);
  }
  // Another run of the same model starts anew.
  CHECK(run(own, scene).rows == wanted.rows);
  CHECK(controller->runs == 2);
}

TEST_CASE("a controller's numbers are in the rows from one sample to the next") {
  Scenario scene = with_own(step(), {"count"});
  scene.time = {0.2, 0.005};
  model::Model model = model::assemble(scene, false);
  const auto controller = std::make_shared<BuiltIn>(step());
  controller->numbers = true;
  model.rig->sampled->external = controller;
  const Made made = run(model, scene);
  REQUIRE(made.rows.size() == 41);
  for (std::size_t i = 0; i < made.rows.size(); ++i) {
    CHECK(made.rows[i].back() == double(i / 4));
    CHECK(model.sample(0, made.rows[i].data()).own == &made.rows[i].back());
  }
}

TEST_CASE("a controller that fails ends the run at that sample and keeps the rows before") {
  const Scenario scene = step();
  model::Model model = model::assemble(with_own(scene), true);
  const auto controller = std::make_shared<BuiltIn>(scene);
  model.rig->sampled->external = controller;
  const Made whole = run(model, scene);
  for (const std::size_t sample : {std::size_t{0}, std::size_t{1}, std::size_t{70}}) {
    for (const bool interrupts : {false, true}) {
      CAPTURE(sample, interrupts);
      controller->fails_at = sample;
      controller->interrupts = interrupts;
      const Made made = run(model, scene);
      CHECK(made.outcome.ending ==
            (interrupts ? solve::Ending::interrupted : solve::Ending::failed));
      CHECK((made.outcome.why == solve::Why::controller) == !interrupts);
      CHECK(made.outcome.reason == "it fails");
      CHECK(made.outcome.reached == Approx(double(sample) * 0.02).margin(1e-15));
      REQUIRE(made.rows.size() == sample);
      CHECK(made.outcome.rows == sample);
      CHECK(std::equal(made.rows.begin(), made.rows.end(), whole.rows.begin()));
    }
  }
}

TEST_CASE("a run without an attached controller is an internal error") {
  const Scenario scene = step();
  const model::Model model = model::assemble(with_own(scene), true);
  CHECK_THROWS_AS(run(model, scene), std::logic_error);
}

}  // namespace bbsim_test::test_external_controller
