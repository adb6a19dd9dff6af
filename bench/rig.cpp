// configs/rig.yaml beside the same rig written by hand (rig_by_hand.hpp): processor time of a run,
// and how far it is from the solution.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
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

namespace {

using namespace bbsim;

// Takes columns and forgets them, but for x and y, by which an error is told.
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
        model_(model::assemble(scene_, false)),
        constants_(model::constants_of(scene_)),
        grid_(scene_.time),
        columns_(scenario::columns_named(scene_.output.columns)) {}
  Prepared(const Prepared&) = delete;
  Prepared& operator=(const Prepared&) = delete;

  // A run as `bbsim run` makes it, up to the text of its rows.
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
  model::Model model_;
  model::BallConstants constants_;
  solve::OutputGrid grid_;
  std::vector<const scenario::Column*> columns_;
};

struct Candidate {
  std::string name;
  std::function<void()> run;
  std::function<double()> error;  // of the last run, m
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

// The most that a run may take, as a part of dopri5's time at rtol 1e-8.
double target(bool all, const std::string& kernels) {
  const double best = all ? 0.3 : 0.15;
  return kernels == "avx512" ? best : kernels == "avx2" ? (all ? 0.5 : 0.25) : 0;
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
  least.plate.inertia.reset();  // nor anybody's peaks of torques
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
      {"bbsim: events, all columns", [&] { whole.run(taken); }, by_us},
      {"bbsim: positions, angles, commands", [&] { plain.run(taken); }, by_us}};
  for (const double rtol : {1e-8, 1e-12, 0.0}) {
    char name[60];
    std::snprintf(name, sizeof name, "by hand: dopri5, rtol %.0e", rtol);
    candidates.push_back({rtol > 0 ? name : "by hand: classical, two steps a piece",
                          [&rows, rtol, noise] {
                            bench::run_by_hand({noise, rtol}, rows.data());
                          },
                          by_hand});
  }
  // In turns, so that whatever else the machine does hits all alike.
  std::vector<double> errors(candidates.size());
  constexpr int turns = 10;
  for (int turn = 0; turn < turns; ++turn) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      Candidate& one = candidates[i];
      double spent = 0;
      while (spent < budget / turns) {
        const solve::CpuClock clock;
        one.run();
        const double seconds = clock.seconds();
        one.seconds = std::min(one.seconds, seconds);
        spent += seconds;
      }
      errors[i] = one.error();
    }
  }
  const std::string kernels = simd::name_of(simd::chosen_instruction_set());
  const double other = candidates[2].seconds;
  std::printf("%-40s %9s %9s %8s\n", noise ? "with noise" : "without noise", "us", "error m",
              "ratio");
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double ratio = candidates[i].seconds / other;
    std::printf("%-40s %9.1f %9.1e %8.3f", candidates[i].name.c_str(), 1e6 * candidates[i].seconds,
                errors[i], ratio);
    const double most = i < 2 ? target(i == 0, kernels) : 0;
    if (most > 0) std::printf("  <= %.2f %s", most, ratio <= most ? "holds" : "FAILS");
    std::printf("\n");
  }
  if (!noise) {
    std::printf("%-40s %29s %.0e %s\n", "error without noise", "<=", 1e-10,
                errors[0] <= 1e-10 ? "holds" : "FAILS");
  }
}

}  // namespace

int main(int count, char** words) {
  const std::string file = BBSIM_SOURCE_DIR "/configs/rig.yaml";
  double budget = 0.5;
  CLI::App app("Times configs/rig.yaml against the same rig written by hand.");
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
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
