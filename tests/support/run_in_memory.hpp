// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs a scene in memory and presents it in the paper's symbols.
#pragma once

#include <string>
#include <vector>

#include "catch.hpp"
#include "file/table_writer.hpp"
#include "model/model.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"

namespace bbsim_test {

struct Run {
  bbsim::solve::Outcome outcome;
  std::vector<bbsim::model::Sample> samples;
};

inline Run run_in_memory(const bbsim::Scenario& scene, bbsim::Method method,
                         bbsim::solve::Tolerances tolerances, bool gamma = true,
                         const bbsim::solve::Watch& watch = {}) {
  const bbsim::model::Model model = bbsim::model::assemble(scene, gamma);
  const bbsim::solve::OutputGrid grid(scene.time);
  bbsim::solve::Trajectory trajectory(model.row_size());
  Run run;
  run.outcome = bbsim::solve::integrate(model, method, tolerances, grid, trajectory, watch);
  for (std::size_t i = 0; i < trajectory.rows(); ++i) {
    run.samples.push_back(model.sample(grid[i], trajectory.row(i)));
  }
  return run;
}

// A run that must reach its end, with all rows.
inline Run whole_run(const bbsim::Scenario& scene, bbsim::Method method,
                     bbsim::solve::Tolerances tolerances, bool gamma = true) {
  Run run = run_in_memory(scene, method, tolerances, gamma);
  REQUIRE(run.outcome.ending == bbsim::solve::Ending::done);
  REQUIRE(run.samples.size() == bbsim::solve::OutputGrid(scene.time).size());
  return run;
}

inline std::string data_file(const std::string& name) {
  return std::string(BBSIM_SOURCE_DIR) + "/tests/data/" + name;
}

inline bbsim::Scenario scenario_named(const std::string& name) {
  return bbsim::read_scenario(data_file("scenarios/" + name + ".yaml"));
}

// A quad-precision solution with columns t, x, y, vx, vy, spin, gamma, phi, theta and their rates.
class QuadReference {
 public:
  explicit QuadReference(const std::string& name)
      : table_(bbsim::file::read_table(data_file("reference/" + name + ".csv"))) {}

  [[nodiscard]] const std::vector<double>& operator[](const std::string& column) const {
    if (const bbsim::file::Column* const found = table_.find(column)) return found->numbers;
    throw std::runtime_error("no reference column " + column);
  }

 private:
  bbsim::file::Table table_;
};

}  // namespace bbsim_test
