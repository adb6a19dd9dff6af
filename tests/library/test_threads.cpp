// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Eight threads use the library together and get the results of one thread. scripts/test --threads
// runs these tests under the thread sanitizer.
#include <array>
#include <atomic>
#include <barrier>
#include <bbsim/bbsim.hpp>
#include <csignal>
#include <exception>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_threads {

namespace {

constexpr std::size_t threads = 8;
const std::string configs = BBSIM_SOURCE_DIR "/configs/";

// Calls work(0) to work(7) in threads that start together. Catch2's checks are for one thread only.
template <class Work>
void at_once(const Work& work) {
  std::barrier start(static_cast<std::ptrdiff_t>(threads));
  std::array<std::exception_ptr, threads> thrown;
  {
    std::vector<std::jthread> all;
    for (std::size_t i = 0; i < threads; ++i) {
      all.emplace_back([&, i] {
        start.arrive_and_wait();
        try {
          work(i);
        } catch (...) {
          thrown[i] = std::current_exception();
        }
      });
    }
  }
  for (const std::exception_ptr& exception : thrown) {
    if (exception) std::rethrow_exception(exception);
  }
}

// Checks that work(i) in each of eight threads returns what it returns in this one.
template <class Work>
void same_at_once(const Work& work) {
  std::array<std::optional<decltype(work(0))>, threads> found;
  at_once([&](std::size_t i) { found[i] = work(i); });
  for (std::size_t i = 0; i < threads; ++i) {
    CAPTURE(i);
    CHECK(found[i] == work(i));
  }
}

bbsim::Scenario shipped(const std::string& name) {
  return bbsim::Scenario::from_file(configs + name + ".yaml").set("time.end", 1);
}

}  // namespace

TEST_CASE("eight threads run scenarios of their own") {
  // Smooth, sampled with noise, table files, friction, three servos, torques.
  const std::array<std::string, threads> names{"fig2b",  "rig",  "recorded",     "slides",
                                               "traced", "sags", "three-servos", "torque-lqr"};
  same_at_once([&](std::size_t i) {
    const bbsim::Result result = bbsim::run(shipped(names[i]), {.measures = {"max_tilt"}});
    return std::pair(result.values, result.measures);
  });
  same_at_once([&](std::size_t i) { return shipped(names[i]).check(); });
}

TEST_CASE("eight threads share a scenario that none modifies") {
  const bbsim::Scenario traced = shipped("traced");
  same_at_once([&](std::size_t) { return bbsim::run(traced).values; });
  const bbsim::Scenario rig = shipped("rig");
  same_at_once([&](std::size_t i) {
    const bbsim::Scenario own = bbsim::Scenario(rig).set("ball.radius", 0.01 + 0.001 * double(i));
    return std::pair(bbsim::run(rig).values, bbsim::run(own).values);
  });
  same_at_once(
      [&](std::size_t i) { return bbsim::linearize(rig, i % 2 == 0 ? "plant" : "sampled").json; });
}

TEST_CASE("eight threads sweep, each with its own threads") {
  const auto tilts = [](const std::string& name, const std::string& vary) {
    bbsim::SweepOptions options;
    options.vary = {{"ball.radius", vary}};
    options.measures = {"max_tilt", "rms_x"};
    options.threads = 3;
    const bbsim::Table table = bbsim::sweep(shipped(name), options);
    return std::pair(table.column("max_tilt").numbers, table.column("rms_x").numbers);
  };
  // Open lanes, lanes, rigs in lanes, single runs.
  const std::array<std::string, 4> names{"fig2a", "fig2b", "rig", "slides"};
  same_at_once([&](std::size_t i) { return tilts(names[i % 4], "linear:0.01:0.02:20"); });
}

TEST_CASE("eight threads simulate cases, each with its own threads") {
  const auto columns = [](const std::string& name, const bbsim::SimulateOptions& more) {
    bbsim::SimulateOptions options = more;
    options.columns = {"t", "x", "y"};
    options.threads = 3;
    std::vector<double> radii;
    for (int i = 0; i < 40; ++i) radii.push_back(0.01 + 2.5e-4 * i);
    return bbsim::simulate(shipped(name), radii.size(), {{"ball.radius", radii}}, options).columns;
  };
  const std::array<std::string, 4> names{"fig2a", "fig2b", "rig", "slides"};
  same_at_once([&](std::size_t i) {
    bbsim::SimulateOptions options;
    options.times = {0.1, 0.25, 0.9};
    if (i >= 4) options.begin.assign(40, 0.1);
    return columns(names[i % 4], options);
  });
}

TEST_CASE("eight threads step, and a stepper moves between threads") {
  const bbsim::Scenario rig = shipped("rig");
  std::vector<bbsim::Stepper> steppers;
  for (std::size_t i = 0; i < threads; ++i) steppers.emplace_back(rig);
  for (std::size_t shift = 0; shift < threads; ++shift) {
    at_once([&](std::size_t i) {
      bbsim::Stepper& stepper = steppers[(i + shift) % threads];
      for (int k = 0; k < 5 && !stepper.is_over(); ++k) stepper.step({0.01, 0});
    });
  }
  bbsim::Stepper alone(rig);
  while (!alone.is_over()) alone.step({0.01, 0});
  for (bbsim::Stepper& stepper : steppers) {
    while (!stepper.is_over()) stepper.step({0.01, 0});
    CHECK(stepper.result().values == alone.result().values);
  }
  at_once([&](std::size_t) {  // abandoned half-way
    bbsim::Stepper stepper(rig);
    stepper.step({0, 0});
  });
}

TEST_CASE("eight threads get refusals, each with its own faults") {
  same_at_once([](std::size_t i) {
    const std::string key = i % 2 == 0 ? "ball.radius" : "no" + std::to_string(i);
    try {
      (void)bbsim::run(shipped("fig2b").set(key, -1));
    } catch (const bbsim::ScenarioError& error) {
      return std::string(error.what());
    }
    return std::string();
  });
}

TEST_CASE("eight threads write files and leave the process's signal handlers alone") {
  const Folder folder;
  const bbsim::Scenario rig = shipped("rig");
  const auto name = [&](std::size_t i, const std::string& ending) {
    return folder / (std::to_string(i) + ending);
  };
  const auto signal_action = [] {
    struct sigaction action {};
    sigaction(SIGSEGV, nullptr, &action);
    return action.sa_handler;
  };
  const auto before = signal_action();
  for (int round = 0; round < 5; ++round) {
    at_once([&](std::size_t i) {
      (void)bbsim::run(rig, {.file = name(i, ".csv")});
      (void)bbsim::run(rig, {.file = name(i, ".h5")});
    });
    CHECK(signal_action() == before);
  }
  const std::string csv = content_of(name(0, ".csv")), h5 = content_of(name(0, ".h5"));
  CHECK(csv.size() > 1000);
  CHECK(h5.size() > 1000);
  for (std::size_t i = 1; i < threads; ++i) {
    CHECK(content_of(name(i, ".csv")) == csv);
    CHECK(content_of(name(i, ".h5")) == h5);
  }
  CHECK(folder.entries() == 2 * std::ptrdiff_t(threads));
}

TEST_CASE("eight threads run your own controller from a library") {
  const bbsim::Scenario own =
      bbsim::Scenario::from_file(BBSIM_SOURCE_DIR "/examples/controllers/library.yaml")
          .set("controller.library.file", BBSIM_EXAMPLE_LIBRARY)
          .set("time.end", 1);
  same_at_once([&](std::size_t) { return bbsim::run(own).values; });
}

TEST_CASE("one thread ends the work of seven others") {
  std::atomic<bool> goes_on{true};
  std::atomic<std::size_t> begun{0};
  std::array<bbsim::Status, threads> found{};
  at_once([&](std::size_t i) {
    if (i == 0) {
      while (begun < threads - 1) std::this_thread::yield();
      goes_on = false;
      found[0] = bbsim::Status::interrupted;
      return;
    }
    bool is_first = true;
    const auto begin = [&] {
      if (std::exchange(is_first, false)) ++begun;
    };
    bbsim::RunOptions options;
    options.keep_rows = false;
    options.goes_on = [&](double) {
      begin();
      return goes_on.load();
    };
    // A circle of several days, which would never finish in time.
    try {
      found[i] = bbsim::run(shipped("fig2b").set("time.end", 1e7), options).status;
    } catch (...) {
      begin();
      throw;
    }
    begin();
  });
  for (const bbsim::Status status : found) CHECK(status == bbsim::Status::interrupted);
}

}  // namespace bbsim_test::test_threads
