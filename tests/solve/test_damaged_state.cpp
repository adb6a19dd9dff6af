// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Modified states: a run that continues from one ends or is refused.
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/noise.hpp"
#include "base/queue.hpp"
#include "catch.hpp"
#include "support/run_in_memory.hpp"
#include "support/scenes.hpp"

using namespace bbsim;
using namespace bbsim_test;

namespace {

Scenario rig() {
  Scenario scene = fig2b();
  scene.ball.radius = 0.02;
  scene.gimbal.servo = Servo{30, 0.8};
  scene.gimbal.servo->rate_limit = 3;
  scene.controller->limit = 0.2;
  scene.controller->sampling = Sampling{0.02, 0.01, 0.002, 0.03};
  Sensor sensor;
  sensor.noise = 2e-4;
  sensor.delay = 0.03;
  sensor.dropout = 0.05;
  scene.controller->sensor = sensor;
  scene.time = {2, 0.1};
  return scene;
}

Scenario jittering() {
  Scenario scene = rig();
  scene.controller->sampling->jitter = 0.002;
  return scene;
}

Scenario filmed() {
  Scenario scene = rig();
  scene.controller->sensor->period = 0.033;
  return scene;
}

// The second half of a run, from a saved state.
class Halved {
 public:
  explicit Halved(const Scenario& scene) : model_(model::assemble(scene, true)), grid_(scene.time) {
    solve::PartialRun first;
    first.end_row = grid_.size() / 2;
    first.keeps_state = true;
    solve::Trajectory rows(model_.row_size());
    static_cast<void>(run(first, rows));
    state = first.state;
    next_row_ = first.next_row;
  }

  // Whether a run continues from the state; false if the state is refused.
  [[nodiscard]] bool goes_on_from(const std::string& changed) const {
    solve::PartialRun second;
    second.first_row = next_row_;
    second.end_row = grid_.size();
    second.from = changed;
    solve::Trajectory rows(model_.row_size());
    try {
      static_cast<void>(run(second, rows));
      return true;
    } catch (const StateFault&) {
      return false;
    }
  }

  std::string state;

 private:
  solve::Outcome run(solve::PartialRun& part, solve::Trajectory& rows) const {
    return solve::integrate(model_, Method::radau, {1e-6, 1e-8}, grid_, rows, {}, &part);
  }

  model::Model model_;
  solve::OutputGrid grid_;
  std::size_t next_row_ = 0;
};

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

template <class T>
std::string bytes_of(T value) {
  StateWriter writer;
  writer(value);
  return writer.bytes();
}

// Not inlined, because GCC would warn that the buffer is too short.
template <class T>
[[gnu::noinline]] bool reads(const std::string& bytes, T into) {
  StateReader reader(bytes);
  try {
    reader(into);
    return true;
  } catch (const StateFault&) {
    return false;
  }
}

}  // namespace

TEST_CASE("no changed word of a state makes a run crash, hang or use all memory") {
  const Scenario scene = GENERATE(fig2a(), fig2b(), rig(), jittering(), filmed());
  const Halved run(scene);
  REQUIRE(run.state.size() > 100);
  CHECK(run.goes_on_from(run.state));
  const std::uint64_t words[] = {1,
                                 255,
                                 std::uint64_t{1} << 31U,
                                 std::uint64_t{1} << 62U,
                                 ~std::uint64_t{0},
                                 bits_of(-1e15),
                                 bits_of(1e15),
                                 bits_of(std::numeric_limits<double>::quiet_NaN())};
  std::size_t refused = 0;
  for (std::size_t at = 0; at + sizeof(std::uint64_t) <= run.state.size(); at += 7) {
    for (const std::uint64_t word : words) {
      // Most numbers of a random generator behave alike.
      if (at > 400 && at + 400 < run.state.size() && at % 5 != 0) continue;
      std::string changed = run.state;
      std::memcpy(changed.data() + at, &word, sizeof word);
      if (!run.goes_on_from(changed)) ++refused;
    }
  }
  CHECK(refused > 0);
  for (std::size_t size = 97; size < run.state.size(); size += 97) {
    CHECK_FALSE(run.goes_on_from(run.state.substr(0, size)));
  }
  CHECK_FALSE(run.goes_on_from(run.state + '\0'));
}

TEST_CASE("values read from a state are valid for their type and within bounds") {
  CHECK(reads(std::string(1, '\1'), false));
  CHECK_FALSE(reads(std::string(1, '\2'), false));
  CHECK(reads(bytes_of(std::optional(1.5)), std::optional<double>()));
  CHECK_FALSE(reads("\7" + std::string(8, '\0'), std::optional<double>()));
  CHECK_FALSE(reads(bytes_of(std::size_t{1} << 40U), std::vector<double>()));
  CHECK_FALSE(reads(bytes_of(std::size_t{0}) + bytes_of(std::size_t{3}), Queue<double>()));

  const std::string noise = bytes_of(Noise(1));
  CHECK(reads(noise, Noise(2)));
  const std::string drawn = bytes_of(std::size_t{17});  // one of 16 that are generated together
  CHECK_FALSE(reads(noise.substr(0, noise.size() - drawn.size()) + drawn, Noise(2)));
}
