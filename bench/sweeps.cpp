// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares sweeps with the same cases run one by one with odeint's Dormand-Prince 5(4) and CVODE's
// BDF: processor time per case at equal error.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/cpu_clock.hpp"
#include "equal_error.hpp"
#include "record/rows.hpp"
#include "solve/integrate.hpp"
#include "sweep/runners.hpp"
#include "sweep/sweep.hpp"
#include "tools.hpp"

namespace {

using namespace bbsim;
using bench::Point;

const std::atomic<bool> goes_on{false};

struct Job {
  std::string name;
  std::string scene;  // in tests/data/scenarios
  std::vector<Variation> vary;
  double error;       // m, for the comparison
  std::string other;  // the tool to compare with
  double ratio;       // target for the other tool's time over the sweep's
};

const std::vector<Job> jobs{
    {"fig2a: amplitude and phase",
     "fig2a",
     {{"gimbal.motion.phi.sinusoid.amplitude", "uniform:0.005:0.015"},
      {"gimbal.motion.theta.sinusoid.phase", "uniform:0:3"}},
     1e-9,
     "dopri5",
     35},
    {"fig2b: gains",
     "fig2b",
     {{"controller.pd.kv.0.0", "uniform:0.7:1.3"}, {"controller.pd.kv.1.1", "uniform:-1.3:-0.7"}},
     1e-9,
     "dopri5",
     25},
    {"fig2b: gains",
     "fig2b",
     {{"controller.pd.kv.0.0", "uniform:0.7:1.3"}, {"controller.pd.kv.1.1", "uniform:-1.3:-0.7"}},
     1e-12,
     "dopri5",
     40},
    {"stiff-servo: gains",
     "stiff-servo",
     {{"controller.pd.kv.0.0", "uniform:0.035:0.065"},
      {"controller.pd.kp.1.1", "uniform:-0.065:-0.035"}},
     1e-6,
     "bdf",
     40},
    {"stiff-servo: gains",
     "stiff-servo",
     {{"controller.pd.kv.0.0", "uniform:0.035:0.065"},
      {"controller.pd.kp.1.1", "uniform:-0.065:-0.035"}},
     1e-9,
     "bdf",
     100},
};

// Number of cases with a known solution.
constexpr double known_cases = 64;

std::vector<scenario::Measure> default_measures(bool loop) {
  std::vector<scenario::Measure> measures;
  for (const std::string& name : scenario::default_measures(loop)) {
    measures.push_back(*scenario::find_measure(name));
  }
  return measures;
}

bool is_length(const scenario::Measure& measure) {
  return measure.column->unit == "m";
}

// A sweep and everything that it refers to.
class Cases {
 public:
  Cases(const std::string& file, const Job& job, double samples, solve::Tolerances tolerances)
      : family_(file, {"solver.rtol=" + record_text(tolerances.rtol),
                       "solver.atol=" + record_text(tolerances.atol)}),
        plan_(family_, sweep(job, samples)),
        task_{family_, plan_,
              default_measures(family_.read(plan_.settings(0)).controller.has_value())},
        engine_(sweep::choose_engine(task_)) {}
  Cases(const Cases&) = delete;
  Cases& operator=(const Cases&) = delete;

  [[nodiscard]] const sweep::SweepTask& task() const { return task_; }
  [[nodiscard]] const sweep::Engine& engine() const { return engine_; }
  [[nodiscard]] std::size_t count() const { return plan_.cases(); }

 private:
  static std::string record_text(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
  }
  static Sweep sweep(const Job& job, double samples) {
    Sweep made;
    made.vary = job.vary;
    made.samples = samples;
    return made;
  }

  ScenarioFamily family_;
  sweep::SweepPlan plan_;
  sweep::SweepTask task_;
  sweep::Engine engine_;
};

// Largest difference of the measures that are lengths, m.
double largest_error(const sweep::SweepTask& task, const std::vector<double>& numbers,
                     const std::vector<double>& exact) {
  double largest = 0;
  const std::size_t width = 1 + task.measures.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i % width == 0 || !is_length(task.measures[i % width - 1])) continue;
    const double error = std::abs(numbers[i] - exact[i]);
    largest =
        std::isfinite(error) ? std::max(largest, error) : std::numeric_limits<double>::infinity();
  }
  return largest;
}

// Least time of `work`, once it has not fallen for a while, s.
template <class Work>
double least_seconds(double budget, Work work) {
  double least = std::numeric_limits<double>::infinity(), total = 0;
  for (int since = 0, runs = 0; since < 10 && (runs < 2 || total < budget); ++runs, ++since) {
    const CpuClock clock;
    work();
    const double seconds = clock.seconds();
    if (seconds < 0.995 * least) since = 0;
    least = std::min(least, seconds);
    total += seconds;
  }
  return least;
}

// A point whose time is still being measured.
struct Candidate {
  Point point;
  std::function<double(double budget)> seconds;  // per case, the least within the budget
};

// Takes errors from the few cases with a known solution, and times from many cases, so that the
// sweep's setup does not count.
Candidate sweep_point(const std::string& file, const Job& job, const sweep::CaseResults& exact,
                      solve::Tolerances tolerances) {
  constexpr double many = 4096;
  const Cases few(file, job, known_cases, tolerances);
  sweep::CaseResults results;
  static_cast<void>(few.engine().runner()->run(0, few.count(), results, goes_on));
  const double error = largest_error(few.task(), results.numbers, exact.numbers);
  const auto cases = std::make_shared<Cases>(file, job, many, tolerances);
  const auto runner = std::shared_ptr<sweep::CaseRunner>(cases->engine().runner());
  return {{"sweep", tolerances, error, 1e99, 1}, [cases, runner](double budget) {
            sweep::CaseResults taken;
            return least_seconds(
                       budget,
                       [&] { static_cast<void>(runner->run(0, cases->count(), taken, goes_on)); }) /
                   static_cast<double>(cases->count());
          }};
}

// Takes the measures that are lengths from the rows alone, as tools give nothing between them.
void add_row_measures(const sweep::SweepTask& task, const bench::Scene& scene,
                      const bench::Rows& rows, std::vector<double>& numbers) {
  using Kind = scenario::Measure::Kind;
  numbers.push_back(scene.grid.end());
  for (const scenario::Measure& measure : task.measures) {
    double most = 0, squares = 0, last = 0;
    const model::BallConstants no_constants;  // lengths need none
    record::Rows column({measure.column});
    column.begin(scene.model, no_constants);
    for (std::size_t i = 0; is_length(measure) && i < scene.grid.size(); ++i) {
      const double t = scene.grid[i];
      column.evaluate(&t, rows.row(i), 1);
      last = column[0][0];
      most = std::max(most, last);
      squares += last * last;
    }
    numbers.push_back(measure.kind == Kind::end   ? last
                      : measure.kind == Kind::rms ? std::sqrt(squares / double(scene.grid.size()))
                                                  : most);
  }
}

// Runs the tool over the known cases. Models and memory are made before the clock starts.
Candidate tool_point(const bench::Tool& tool, const Cases& cases, solve::Tolerances tolerances) {
  const sweep::SweepTask& task = cases.task();
  const auto scenes = std::make_shared<std::vector<bench::Scene>>();
  std::vector<double> numbers, exact;
  bool fine = true;
  for (std::size_t i = 0; i < cases.count(); ++i) {
    const Scenario scenario = task.family.read(task.plan.settings(i));
    bench::Scene& scene = scenes->emplace_back(bench::Scene{"",
                                                            model::assemble(scenario, false),
                                                            solve::OutputGrid(scenario.time),
                                                            {},
                                                            {},
                                                            {},
                                                            scenario.ball.radius,
                                                            scenario.gravity});
    for (std::size_t k = 0; k < scene.grid.size(); ++k) scene.times.push_back(scene.grid[k]);
    bench::Rows rows(scene.grid.size(), scene.model.size());
    fine = fine && tool.run(scene, tolerances, rows);
    add_row_measures(task, scene, rows, numbers);
    static_cast<void>(solve::integrate(scene.model, Method::radau,
                                       {scenario.solver.rtol, scenario.solver.atol}, scene.grid,
                                       rows));
    add_row_measures(task, scene, rows, exact);
  }
  const double error =
      fine ? largest_error(task, numbers, exact) : std::numeric_limits<double>::infinity();
  return {{tool.name, tolerances, error, 1e99, 1}, [&tool, scenes, tolerances](double budget) {
            bench::Rows rows(scenes->front().grid.size(), scenes->front().model.size());
            return least_seconds(budget,
                                 [&] {
                                   for (const bench::Scene& scene : *scenes) {
                                     tool.run(scene, tolerances, rows);
                                   }
                                 }) /
                   static_cast<double>(scenes->size());
          }};
}

// Adds two tolerances per decade, from 1e-2 down, until the error is a hundredth of `error`.
template <class Make>
void add_ladder(double error, std::vector<Candidate>& candidates, Make make) {
  for (int i = 4; i <= 24; ++i) {
    const double rtol = std::pow(10.0, -i / 2.0);
    Candidate candidate = make(solve::Tolerances{rtol, rtol / 100});
    const double reached = candidate.point.error;
    if (reached < 100 * error) candidates.push_back(std::move(candidate));
    if (reached < error / 100) return;
  }
}

void measure(const Job& job, const std::string& folder, double budget) {
  const std::string file = folder + "/scenarios/" + job.scene + ".yaml";
  const Cases finest(file, job, known_cases, {1e-13, 1e-15});
  sweep::CaseResults exact;
  static_cast<void>(sweep::single_runner(finest.task())->run(0, finest.count(), exact, goes_on));

  std::vector<Candidate> candidates;
  add_ladder(job.error, candidates, [&](solve::Tolerances tolerances) {
    return sweep_point(file, job, exact, tolerances);
  });
  for (const bench::Tool& tool : bench::all_tools()) {
    if (job.other != tool.name) continue;
    add_ladder(job.error, candidates,
               [&](solve::Tolerances tolerances) { return tool_point(tool, finest, tolerances); });
  }
  // Take turns, so that other load on the machine affects all alike.
  std::vector<Point> points;
  constexpr int turns = 5;
  for (int turn = 0; turn < turns; ++turn) {
    for (Candidate& candidate : candidates) {
      candidate.point.seconds =
          std::min(candidate.point.seconds, candidate.seconds(budget / turns));
    }
  }
  for (const Candidate& candidate : candidates) points.push_back(candidate.point);

  const auto own = bench::seconds_at(points, "sweep", job.error);
  const auto other = bench::seconds_at(points, job.other, job.error);
  const double ratio = own && other ? *other / *own : 0;
  const std::string engine = Cases(file, job, 4096, {1e-6, 1e-8}).engine().name;
  std::printf("%-28s %-14s %7.0e %10.3f  %-7s %9.2f %8.1f  >= %.0f %s\n", job.name.c_str(),
              engine.c_str(), job.error, own ? 1e6 * *own : 0.0, job.other.c_str(),
              other ? 1e6 * *other : 0.0, ratio, job.ratio, ratio >= job.ratio ? "holds" : "FAILS");
  std::fflush(stdout);
}

// Prints a sweep's wall time on one thread over that on two.
void measure_threads(const std::string& folder) {
  const Cases cases(folder + "/scenarios/fig2b.yaml", jobs[1], 20000, {1e-8, 1e-10});
  double least[2] = {1e99, 1e99};
  for (int turn = 0; turn < 5; ++turn) {
    for (std::size_t threads = 1; threads <= 2; ++threads) {
      const auto start = std::chrono::steady_clock::now();
      static_cast<void>(sweep::run_sweep(
          cases.engine(), {0, cases.count()}, threads, goes_on, [](sweep::CaseResults&) {},
          [](const sweep::CaseResults&) {}));
      const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
      least[threads - 1] = std::min(least[threads - 1], wall.count());
    }
  }
  const double ratio = least[0] / least[1];
  std::printf("\nwall time on one thread over two: %.2f  >= 1.85 %s\n", ratio,
              ratio >= 1.85 ? "holds" : "FAILS");
}

// Compares a sweep in which a third of the cases grow without bound with one in which none does.
void measure_blow_ups(const std::string& folder) {
  const std::string file = folder + "/scenarios/fig2b.yaml";
  const auto seconds = [&](const char* gains) {
    // With the other sign, the gain makes the loop unstable: its motion overflows before the end.
    const Job job{"", "fig2b", {{"controller.pd.kv.0.0", gains}, {"ball.mass", "uniform:1:2"}},
                  0,  "",      0};
    const Cases cases(file, job, 1000, {1e-8, 1e-10});
    const auto runner = cases.engine().runner();
    sweep::CaseResults results;
    const double time = least_seconds(
        0.5, [&] { static_cast<void>(runner->run(0, cases.count(), results, goes_on)); });
    const auto failed =
        std::count_if(results.status.begin(), results.status.end(),
                      [](const sweep::CaseStatus& status) { return status.word != "done"; });
    std::printf("%-28s %6.1f us a case, %td of %zu end early\n", gains,
                1e6 * time / static_cast<double>(cases.count()), failed, cases.count());
    return time / static_cast<double>(cases.count());
  };
  std::printf("\n");
  const double none = seconds("list:0.9,1,1.1"), third = seconds("list:0.9,1,-10");
  std::printf("time where a third blows up over where none does: %.2f  <= 1.5 %s\n", third / none,
              third <= 1.5 * none ? "holds" : "FAILS");
}

}  // namespace

int main(int count, char** words) {
  std::string data = BBSIM_SOURCE_DIR "/tests/data";
  double budget = 0.5;
  CLI::App app("Times sweeps against the same cases one by one, at equal error.");
  app.add_option("--data", data, "folder with scenarios/")->capture_default_str();
  app.add_option("--budget", budget, "most seconds to spend on a point")->capture_default_str();
  CLI11_PARSE(app, count, words);
  try {
    std::printf(
        "processor time a case of a sweep, its scenario set and its default measures taken, and "
        "of\n"
        "the other tool's integration alone, rows included; error: the largest of end_x, end_y,\n"
        "max_distance and the tracking errors over 64 cases, the other tool's over its rows\n\n"
        "%-28s %-14s %7s %10s  %-7s %9s %8s\n",
        "sweep", "engine", "error m", "sweep us", "other", "other us", "ratio");
    for (const Job& job : jobs) measure(job, data, budget);
    measure_threads(data);
    measure_blow_ups(data);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
