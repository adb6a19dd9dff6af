// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "scene.hpp"

#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "file/table.hpp"
#include "scenario/reader.hpp"

namespace bbsim::bench {
namespace {

const std::vector<double>& column(const file::Table& table, const std::string& name,
                                  const std::string& file) {
  const file::Column* const found = table.find(name);
  if (found == nullptr) throw InputError(file + ": has no column " + name);
  return found->numbers;
}

}  // namespace

Scene load_scene(const std::string& folder, const std::string& name) {
  const std::string file = folder + "/reference/" + name + ".csv";
  const Scenario scenario = read_scenario(folder + "/scenarios/" + name + ".yaml");
  const file::Table table = file::read_table(file);
  Scene scene{name,
              model::assemble(scenario, false),
              solve::OutputGrid(scenario.time),
              {},
              column(table, "x", file),
              column(table, "y", file),
              scenario.ball.radius,
              scenario.gravity};
  for (std::size_t i = 0; i < scene.grid.size(); ++i) scene.times.push_back(scene.grid[i]);
  const std::vector<double>& times = column(table, "t", file);
  bool alike = times.size() == scene.times.size();
  for (std::size_t i = 0; alike && i < times.size(); ++i) {
    alike =
        std::abs(times[i] - scene.times[i]) <= 1e-12 * scene.grid.end();  // rounding of i * step
  }
  if (!alike) throw InputError(file + ": its times are not the output times of the scenario");
  return scene;
}

double largest_error(const Scene& scene, const Rows& rows) {
  double largest = 0;
  std::visit(
      [&](const auto& system) {
        for (std::size_t i = 0; i < scene.grid.size(); ++i) {
          const model::BallMotion ball = system.sample(scene.grid[i], rows.row(i)).ball;
          const double error =
              std::max(std::abs(ball.x - scene.x[i]), std::abs(ball.y - scene.y[i]));
          if (!std::isfinite(error)) {
            largest = std::numeric_limits<double>::infinity();
            return;
          }
          largest = std::max(largest, error);
        }
      },
      scene.model.system);
  return largest;
}

}  // namespace bbsim::bench
