// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares bbsim's integrator with odeint's Dormand-Prince 5(4) and CVODE's BDF and Adams:
// processor time at equal error, over scenes with a quad-precision reference.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>
#include <vector>

#include "report.hpp"
#include "simd/instruction_set.hpp"
#include "study/accuracy.hpp"

namespace {

struct Arguments {
  std::string data = BBSIM_SOURCE_DIR "/tests/data";
  std::string csv;
  std::vector<std::string> scenes{"fig2a", "fast",   "fig2b",      "small-ball",
                                  "spin",  "tumble", "stiff-servo"};
  double budget = 0.1;
};

// Two tolerances per decade, from 1e-2 to 1e-14.
std::vector<double> tolerance_ladder() {
  std::vector<double> ladder;
  for (int i = 4; i <= 28; ++i)
    ladder.push_back(bbsim::study::ten_digits(std::pow(10.0, -i / 2.0)));
  return ladder;
}

int run(const Arguments& arguments) {
  const std::string kernels = bbsim::simd::name_of(bbsim::simd::chosen_instruction_set());
  std::printf(
      "instruction set of radau: %s\n"
      "processor time of one run with its output, the least of many; no gamma\n"
      "error: max |dx|, |dy| over the output times; times at equal error by log-log interpolation\n"
      "\n",
      kernels.c_str());
  std::vector<bbsim::bench::Measured> measured;
  for (const std::string& name : arguments.scenes) {
    std::fprintf(stderr, "measuring %s ...\n", name.c_str());
    const bbsim::bench::Scene scene = bbsim::bench::load_scene(arguments.data, name);
    measured.push_back({name, bbsim::bench::measure(scene, tolerance_ladder(), arguments.budget)});
  }
  std::fputs(bbsim::bench::ratio_table(measured, kernels).c_str(), stdout);
  if (arguments.csv.empty()) return 0;
  std::ofstream file(arguments.csv);
  file << bbsim::bench::points_csv(measured) << std::flush;
  if (!file) {
    std::fprintf(stderr, "%s: could not be written\n", arguments.csv.c_str());
    return 3;
  }
  return 0;
}

}  // namespace

int main(int count, char** words) {
  Arguments arguments;
  CLI::App app("Times integrators at equal error, and compares them with the targets.");
  app.add_option("scenes", arguments.scenes, "scenes of DATA/scenarios with a DATA/reference")
      ->capture_default_str();
  app.add_option("--csv", arguments.csv, "write every point measured to this file");
  app.add_option("--data", arguments.data, "folder with scenarios/ and reference/")
      ->capture_default_str();
  app.add_option("--budget", arguments.budget, "most seconds to spend on a point")
      ->capture_default_str();
  CLI11_PARSE(app, count, words);
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
