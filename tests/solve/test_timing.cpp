// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Clocks with jitter, camera frames and misaligned sensors.
#include <cmath>
#include <functional>

#include "catch.hpp"
#include "model/control/sample_exchange.hpp"
#include "model/control/sample_times.hpp"
#include "model/control/sampled_controller.hpp"
#include "support/run_in_memory.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_timing {

using namespace bbsim;

namespace {

// A ball that rolls over a level plate, with a controller that only observes: x = 0.1 t.
Scenario onlooker() {
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.ball.position = {0, 0};
  scene.ball.velocity = {0.1, 0};
  scene.gimbal.servo = Servo{30, 0.8};
  scene.controller->kp = scene.controller->kv = {};
  scene.controller->sampling = Sampling{0.02, 0, 0, 0};
  scene.controller->sensor = Sensor{};
  scene.time = {1, 0.0031};
  return scene;
}

Run run_of(const Scenario& scene) {
  return whole_run(scene, Method::automatic, {1e-10, 1e-12});
}

}  // namespace

TEST_CASE("a sample sees the exposure that its clock, camera and faults give") {
  const auto last_sample = [](double t) { return 0.02 * std::floor(t / 0.02 + 1e-9); };
  Scenario scene = onlooker();
  Sensor& sensor = *scene.controller->sensor;
  std::function<double(double)> seen;  // the time of the exposure that a row shows
  SECTION("measured periods, which start again after the last") {
    scene.controller->sampling->periods = {0.02, 0.03, 0.013};
    seen = [](double t) {
      double sampled = 0;
      for (std::size_t i = 0;; ++i) {
        const double next = sampled + std::array{0.02, 0.03, 0.013}[i % 3];
        if (next > t + 1e-9) return sampled;  // a row at a sample comes after it
        sampled = next;
      }
    };
  }
  SECTION("the last frame that has arrived") {
    sensor.period = 0.033;
    sensor.phase = 0.005;
    sensor.delay = 0.012;
    seen = [=](double t) {
      const double frames = std::floor((last_sample(t) - 0.012 - 0.005) / 0.033 + 1e-9);
      return std::max(0.005 + 0.033 * frames, 0.0);
    };
  }
  SECTION("a sensor that sticks repeats its reading for the duration") {
    const auto [duration, readings] = GENERATE(table<double, int>({{0.11, 6}, {0.1, 5}}));
    sensor.stuck = SensorFault{1, duration};
    seen = [length = 0.02 * readings](double t) { return length * std::floor(t / length + 1e-9); };
  }
  SECTION("frames that wait arrive together") {
    sensor.period = 0.033;
    sensor.phase = 0.005;
    sensor.delay = 0.012;
    sensor.burst = SensorFault{1, 0.1};
    seen = [=](double t) {
      double last = 0, until = -1;
      for (int i = -2; 0.033 * i + 0.017 < last_sample(t) + 0.1; ++i) {
        const double arrives = 0.033 * i + 0.017;
        if (arrives >= until) until = arrives + 0.1;
        if (until <= last_sample(t)) last = std::max(0.0, 0.033 * i + 0.005);
      }
      return last;
    };
  }
  for (const model::Sample& now : run_of(scene).samples) {
    CHECK(std::abs(now.measured[0] - 0.1 * seen(now.t)) < 1e-12);
  }
}

TEST_CASE("a clock with jitter has the requested mean and deviation, and repeats bit for bit") {
  Sampling sampling{0.02, 0, 0, 0};
  sampling.jitter = 0.001;
  model::SampleTimes one(sampling, 7), again(sampling, 7), other(sampling, 8);
  const int n = 20000;
  double sum = 0, square = 0;
  bool differs = false;
  for (int i = 1; i <= n; ++i) {
    const double from = one.at(i - 1), to = one.at(i);
    CHECK(to == again.at(i));
    differs = differs || to != other.at(i);
    sum += to - from;
    square += (to - from - 0.02) * (to - from - 0.02);
    one.forget_before(i - 2);
  }
  CHECK(differs);
  // Four standard deviations each.
  CHECK(std::abs(sum / n - 0.02) < 4 * 0.001 / std::sqrt(n));
  CHECK(std::abs(std::sqrt(square / n) - 0.001) < 4 * 0.001 / std::sqrt(2.0 * n));
  // Time always advances, however large the deviation.
  sampling.jitter = 1;
  model::SampleTimes wild(sampling, 7);
  for (int i = 1; i < 100; ++i) CHECK(wild.at(i) - wild.at(i - 1) >= 0.0019);
}

TEST_CASE("jitter has its own random sequence and does not change the noise") {
  Scenario scene = onlooker();
  scene.ball.velocity = {0, 0};
  scene.controller->sensor->noise = 1e-3;
  scene.time = {0.5, 0.02};
  Scenario jittered = scene;
  jittered.controller->sampling->jitter = 1e-5;
  const Run a = run_of(scene), b = run_of(jittered), c = run_of(jittered);
  // The ball is at rest, so a sample is only its noise.
  for (std::size_t i = 0; i + 1 < a.samples.size(); ++i) {
    CHECK(b.samples[i].measured == c.samples[i].measured);
    // A row at a sample's nominal time may precede the jittered sample.
    const bool same = b.samples[i].measured == a.samples[i].measured;
    const bool last = i > 0 && b.samples[i].measured == a.samples[i - 1].measured;
    CHECK((same || last));
  }
}

TEST_CASE("faults leave the noise of other readings, and come with their probability") {
  Sensor sensor;
  sensor.noise = 1e-3;
  sensor.stuck = SensorFault{0.05, 0.1};
  const int readings = 20000;
  struct Reading {
    Pair position;
    bool sees;
  };
  model::BallSensor ball(sensor), same(sensor);
  model::SensorFaults faults(sensor);
  int stuck = 0;
  Pair before{};
  for (int i = 0; i < readings; ++i) {
    Reading now{{}, true};
    now.sees = ball.read(0, 0, now.position);
    const Pair drawn = now.position;
    faults.stick(0.02 * i, now);
    if (now.position != drawn) {
      ++stuck;
      CHECK(now.position == before);
    }
    before = now.position;
    Pair other;
    CHECK(same.read(0, 0, other));
    CHECK(other == drawn);
  }
  // Four of five readings of a fault repeat the first; 19 on average are between faults.
  const double share = 4.0 / 24;
  CHECK(std::abs(stuck - share * readings) < 5 * std::sqrt(readings * share * 5));
}

TEST_CASE("frames at the samples equal the samples bit for bit") {
  Scenario scene = onlooker();
  scene.controller->kp = {{{0.7, 0}, {0, -0.7}}};
  scene.controller->kv = {{{0.6, 0}, {0, -0.6}}};
  Scenario frames = scene;
  frames.controller->sensor->period = 0.02;
  const Run a = run_of(scene), b = run_of(frames);
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    CHECK(a.samples[i].ball.x == b.samples[i].ball.x);
    CHECK(a.samples[i].measured == b.samples[i].measured);
  }
}

TEST_CASE("a rotated, scaled and offset sensor reports scale R(rotation) p + offset") {
  Scenario scene = onlooker();
  scene.ball.velocity = {0.1, -0.2};
  Sensor& sensor = *scene.controller->sensor;
  sensor.rotation = 0.3;
  sensor.scale = {1.1, 0.9};
  sensor.offset = {0.01, -0.02};
  for (const model::Sample& now : run_of(scene).samples) {
    const double at = 0.02 * std::floor(now.t / 0.02 + 1e-9);
    const double x = 0.1 * at, y = -0.2 * at, c = std::cos(0.3), s = std::sin(0.3);
    CHECK(std::abs(now.measured[0] - (1.1 * (c * x - s * y) + 0.01)) < 1e-12);
    CHECK(std::abs(now.measured[1] - (0.9 * (s * x + c * y) - 0.02)) < 1e-12);
  }
}

TEST_CASE("a ball controlled with an offset sensor rests where the sensor reports the target") {
  Scenario scene = onlooker();
  scene.ball.velocity = {0, 0};
  scene.controller->kp = {{{0.7, 0}, {0, -0.7}}};
  scene.controller->kv = {{{0.6, 0}, {0, -0.6}}};
  scene.controller->reference = PointReference{{0.03, 0.02}};
  scene.controller->sensor->rotation = 0.1;
  scene.controller->sensor->offset = {0.005, 0.002};
  scene.controller->sampling->derivative_filter = 0.03;
  scene.time = {30, 1};
  const model::Sample last = run_of(scene).samples.back();
  const double x = 0.03 - 0.005, y = 0.02 - 0.002, c = std::cos(0.1), s = std::sin(0.1);
  CHECK(last.ball.x == Approx(c * x + s * y).epsilon(1e-4));
  CHECK(last.ball.y == Approx(c * y - s * x).epsilon(1e-4));
}

}  // namespace bbsim_test::test_timing
