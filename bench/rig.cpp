// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares configs/rig.yaml with the same rig written by hand (rig_by_hand.hpp): processor time of
// a run, and error against the solution. Then compares rigs with push rods, three legs and jitter
// with configs/rig.yaml.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/cpu_clock.hpp"
#include "file/table_writer.hpp"
#include "record/recorder.hpp"
#include "rig_by_hand.hpp"
#include "scenario/columns.hpp"
#include "scenario/reader.hpp"
#include "simd/instruction_set.hpp"
#include "solve/integrate.hpp"
#include "sweep/runners.hpp"
#include "sweep/sweep.hpp"

namespace {

using namespace bbsim;

// Receives columns and keeps x and y, for the error.
class Taken : public file::TableWriter {
 public:
  void append(std::span<const double* const> columns, std::size_t rows) override {
    for (std::size_t c = 0; c < 2; ++c) {
      kept[c].insert(kept[c].end(), columns[1 + c], columns[1 + c] + rows);
    }
  }
  void finish(const file::Attributes&) override {}

  std::vector<double> kept[2];
};

// A scene that is read and assembled before the clock starts.
class Prepared {
 public:
  explicit Prepared(Scenario of)
      : scene_(std::move(of)),
        columns_(scenario::columns_named(scene_.output.columns)),
        model_(model::assemble(scene_, scenario::integrals_for(columns_))),
        constants_(model::constants_of(scene_)),
        grid_(scene_.time) {}
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  // A run as in `bbsim run`, but without formatting the rows as text.
  void run(Taken& taken) const {
    for (auto& column : taken.kept) column.clear();
    record::Recorder recorder({columns_, {}, true});
    recorder.begin(model_, constants_, grid_, &taken);
    const Solver& solver = scene_.solver;
    static_cast<void>(
        solve::integrate(model_, solver.method, {solver.rtol, solver.atol}, grid_, recorder));
  }

 private:
  Scenario scene_;
  std::vector<const scenario::Column*> columns_;
  model::Model model_;
  model::BallConstants constants_;
  solve::OutputGrid grid_;
};

// A sweep of the scene over gains and noise seeds, with the default measures.
class Swept {
 public:
  Swept(const std::string& file, std::size_t cases, const std::vector<std::string>& set = {})
      : family_(file, set),
        plan_(family_, sweep_of(cases)),
        task_{family_, plan_, measures()},
        engine_(sweep::choose_engine(task_)),
        runner_(engine_.runner()),
        least_(plan_.cases() / together, std::numeric_limits<double>::infinity()) {}
  Swept(const Swept&) = delete;
  Swept& operator=(const Swept&) = delete;

  [[nodiscard]] const std::string& engine() const { return engine_.name; }
  [[nodiscard]] std::size_t cases() const { return plan_.cases(); }
  // Times a few cases at once, for as long as one run of the others, because other load interrupts
  // longer measurements.
  void run() {
    for (std::size_t i = 0; i < least_.size(); ++i) {
      const CpuClock clock;
      static_cast<void>(runner_->run(i * together, together, results_, goes_on));
      least_[i] = std::min(least_[i], clock.seconds());
    }
  }
  // Sum of the least times of all cases, s.
  [[nodiscard]] double seconds() const {
    return std::accumulate(least_.begin(), least_.end(), 0.0);
  }

  // Largest difference of a length measure from a single run, over the first cases, m.
  [[nodiscard]] double error(std::size_t looked_at) {
    sweep::CaseResults alone;
    static_cast<void>(runner_->run(0, looked_at, results_, goes_on));
    static_cast<void>(sweep::single_runner(task_)->run(0, looked_at, alone, goes_on));
    const std::size_t width = 1 + task_.measures.size();
    double largest = 0;
    for (std::size_t i = 0; i < looked_at * width; ++i) {
      if (i % width == 0 || task_.measures[i % width - 1].column->unit != "m") continue;
      largest = std::max(largest, std::abs(alone.numbers[i] - results_.numbers[i]));
    }
    return largest;
  }

 private:
  static Sweep sweep_of(std::size_t cases) {
    Sweep made;
    made.vary = {{"controller.gravity_compensation.kp", "uniform:5:8"},
                 {"controller.gravity_compensation.kv", "uniform:4:5"},
                 {"controller.sensor.seed", "linear:1:10:10"}};
    made.samples = static_cast<double>(cases) / 10;
    return made;
  }
  static std::vector<scenario::Measure> measures() {
    std::vector<scenario::Measure> all;
    for (const std::string& name : scenario::default_measures(true)) {
      all.push_back(*scenario::find_measure(name));
    }
    return all;
  }

  static constexpr std::size_t together = 8;  // a group of lanes
  static inline const std::atomic<bool> goes_on{false};
  ScenarioFamily family_;
  sweep::SweepPlan plan_;
  sweep::SweepTask task_;
  sweep::Engine engine_;
  std::unique_ptr<sweep::CaseRunner> runner_;
  std::vector<double> least_;  // for each group, s
  sweep::CaseResults results_;
};

struct Candidate {
  std::string name;
  std::function<void()> run;
  std::function<double()> error;    // of the last run, or of a sweep's first cases, m
  double most = 0;                  // bound relative to dopri5 at rtol 1e-8; 0: no target
  double cases = 1;                 // per call
  std::function<double()> least{};  // least time of all calls, s, if that is not the least call
  double seconds = std::numeric_limits<double>::infinity();
};

double largest_difference(const Taken& a, const Taken& b) {
  double largest = 0;
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t i = 0; i < a.kept[c].size(); ++i) {
      largest = std::max(largest, std::abs(a.kept[c][i] - b.kept[c][i]));
    }
  }
  return largest;
}

// Bound on a run's time relative to dopri5 at rtol 1e-8. No target with two lanes.
double target(double by_avx512, double by_avx2) {
  const std::string kernels = simd::name_of(simd::chosen_instruction_set());
  return kernels == "avx512" ? by_avx512 : kernels == "avx2" ? by_avx2 : 0;
}

void measure(const std::string& file, bool noise, double budget) {
  Scenario all = read_scenario(file);
  if (!noise) all.controller->sensor->noise = 0;
  Scenario finest = all;
  finest.solver.rtol = 1e-13;
  finest.solver.atol = 1e-15;
  Taken exact;
  Prepared(finest).run(exact);
  Scenario least = all;
  least.events = {};
  least.plate.inertia.reset();  // no peak torques either
  least.output.columns = {"t", "x", "y", "phi", "theta", "phi_command", "theta_command"};

  const Prepared whole(all), plain(least);
  Taken taken;
  std::vector<bench::HandRow> rows(bench::hand_rows);
  const auto by_us = [&] { return largest_difference(taken, exact); };
  const auto by_hand = [&] {
    double largest = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      largest = std::max({largest, std::abs(rows[i].x - exact.kept[0][i]),
                          std::abs(rows[i].y - exact.kept[1][i])});
    }
    return largest;
  };
  std::vector<Candidate> candidates{
      {"bbsim: events, all columns", [&] { whole.run(taken); }, by_us, target(0.3, 0.5)},
      {"bbsim: positions, angles, commands", [&] { plain.run(taken); }, by_us, target(0.15, 0.25)}};
  for (const double rtol : {1e-8, 1e-12, 0.0}) {
    char name[60];
    std::snprintf(name, sizeof name, "by hand: dopri5, rtol %.0e", rtol);
    candidates.push_back({rtol > 0 ? name : "by hand: classical, two steps a piece",
                          [&rows, rtol, noise] {
                            bench::run_by_hand({noise, rtol}, rows.data());
                          },
                          by_hand});
  }
  std::optional<Swept> swept;
  if (noise) {
    swept.emplace(file, 1000);
    candidates.push_back({"bbsim: a case of 1000, by " + swept->engine(), [&] { swept->run(); },
                          [&] { return swept->error(16); }, target(0.1, 0.2),
                          static_cast<double>(swept->cases()), [&] { return swept->seconds(); }});
  }
  // Take turns, so that other load on the machine affects all alike.
  std::vector<double> errors(candidates.size());
  constexpr int turns = 10;
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      Candidate& one = candidates[i];
      double spent = 0;
      while (spent < budget / turns) {
        const CpuClock clock;
        one.run();
        const double seconds = clock.seconds();
        one.seconds = std::min(one.seconds, (one.least ? one.least() : seconds) / one.cases);
        spent += seconds;
      }
      errors[i] = one.error();
    }
  }
  const double other = candidates[2].seconds;
  std::printf("%-40s %9s %9s %8s\n", noise ? "with noise" : "without noise", "us", "error m",
              "ratio");
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double ratio = candidates[i].seconds / other;
    std::printf("%-40s %9.1f %9.1e %8.3f", candidates[i].name.c_str(), 1e6 * candidates[i].seconds,
                errors[i], ratio);
    const double most = candidates[i].most;
    if (most > 0) std::printf("  <= %.2f %s", most, ratio <= most ? "holds" : "FAILS");
    std::printf("\n");
  }
  if (!noise) {
    std::printf("%-40s %29s %.0e %s\n", "error without noise", "<=", 1e-10,
                errors[0] <= 1e-10 ? "holds" : "FAILS");
  }
}

// A rig, and bounds on its time a sample relative to configs/rig.yaml: of a run, and swept.
struct Mechanism {
  const char* name;
  std::string file;
  std::vector<std::string> set;
  double most = 0, most_swept = 0;  // 0: no target
};

void compare_mechanisms(double budget) {
  const std::string configs = BBSIM_SOURCE_DIR "/configs/", rig = configs + "rig.yaml";
  const std::string rods = "gimbal.linkage={horn: 2.4 cm, arm: 6 cm, offset: [-1.6 cm, 7 cm]}";
  const std::string legs =
      "gimbal.three_servos={radius_base: 6 cm, radius_plate: 9 cm, horn: 4 cm, rod: 10 cm, "
      "height: 11 cm}";
  const std::string jitter = "controller.sampling.jitter=1 ms";
  const std::vector<Mechanism> all{
      {"rig.yaml", rig, {}},
      {"behind push rods", rig, {rods}, 2, 2},
      {"on three legs", rig, {legs}, 2, 2},
      {"with jitter", rig, {jitter}, 2, 2},
      {"with jitter behind push rods", rig, {jitter, rods}, 4, 4},
      {"pushrod.yaml: backlash, jitter, camera", configs + "pushrod.yaml", {}, 6, 8},
      {"three-servos.yaml with noise",
       configs + "three-servos.yaml",
       {"controller.sensor={noise: 0.2 mm}"},
       2,
       2},
  };
  std::printf("%-40s %9s %6s %9s %6s\n", "a sample of", "us", "ratio", "swept us", "ratio");
  double first = 0, first_swept = 0;
  for (const Mechanism& one : all) {
    Scenario scene = ScenarioFamily(one.file, one.set).read({});
    scene.plate.inertia.reset();  // no peak torques
    const double samples = scene.time.end / scene.controller->sampling->period;
    const Prepared whole(scene);
    Swept swept(one.file, 200, one.set);
    Taken taken;
    double least = std::numeric_limits<double>::infinity(), spent = 0;
    while (spent < budget) {
      const CpuClock clock;
      whole.run(taken);
      least = std::min(least, clock.seconds());
      swept.run();
      spent += clock.seconds();
    }
    const double run = least / samples;
    const double of_case = swept.seconds() / static_cast<double>(swept.cases()) / samples;
    if (first == 0) {
      first = run;
      first_swept = of_case;
    }
    std::printf("%-40s %9.2f %6.2f %9.2f %6.2f", one.name, 1e6 * run, run / first, 1e6 * of_case,
                of_case / first_swept);
    if (one.most > 0) {
      const bool holds = run <= one.most * first && of_case <= one.most_swept * first_swept;
      std::printf("  <= %g, %g swept %s", one.most, one.most_swept, holds ? "holds" : "FAILS");
    }
    std::printf("  (%s)\n", swept.engine().c_str());
  }
}

}  // namespace

int main(int count, char** words) {
  const std::string file = BBSIM_SOURCE_DIR "/configs/rig.yaml";
  double budget = 0.5;
  CLI::App app("Times configs/rig.yaml against the same rig written by hand, and other rigs.");
  app.add_option("--budget", budget, "most seconds to spend on a program")->capture_default_str();
  CLI11_PARSE(app, count, words);
  try {
    std::printf(
        "configs/rig.yaml: processor time of a run with its rows, the least of many; error: max\n"
        "|dx|, |dy| over the rows from the solution; ratio: to dopri5 at rtol 1e-8, which has no\n"
        "events but a look at the edge once a piece. Instruction set: %s\n\n",
        simd::name_of(simd::chosen_instruction_set()));
    measure(file, true, budget);
    std::printf("\n");
    measure(file, false, budget);
    std::printf("\n");
    compare_mechanisms(4 * budget);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
