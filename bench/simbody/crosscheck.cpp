// Equation (27) against a multibody engine that does not know it.
//
// Simbody (Sherman, Seth and Delp 2011) gets two prescribed pins, a plate, a free ball and its
// ideal sphere-on-plane constraint with rolling, and integrates its own equations of motion. The
// paths of the contact point are compared.
//
//     crosscheck SCENARIO.yaml...    open-loop scenarios; prints the largest differences
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "model/model.hpp"
#include "rig.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"

namespace {

struct Differences {
  double position = 0;  // of x and y at the worst output time, m
  double extent = 0;    // the largest coordinate, m
};

Differences compare(const bbsim::Scenario& scene) {
  if (!scene.gimbal.motion) throw std::runtime_error("not an open loop");
  bbsim::model::SignalPair motion;
  motion.add(0, scene.gimbal.motion->phi);
  motion.add(1, scene.gimbal.motion->theta);

  const bbsim::model::Model model = bbsim::model::assemble(scene, false);
  const bbsim::solve::OutputGrid grid(scene.time);
  bbsim::solve::Trajectory rows(model.size());
  const auto outcome =
      bbsim::solve::integrate(model, bbsim::Method::automatic, {1e-13, 1e-15}, grid, rows);
  if (outcome.ending != bbsim::solve::Ending::done) throw std::runtime_error(outcome.reason);

  std::vector<double> times;
  for (std::size_t i = 0; i < grid.size(); ++i) times.push_back(grid[i]);
  const bbsim::Ball& ball = scene.ball;
  const auto angle = [&](double t, int axis, int order) {
    const auto jet = motion.at(t)[static_cast<std::size_t>(axis)];
    return order == 0 ? jet.value : order == 1 ? jet.rate : jet.acceleration;
  };
  const auto path = crosscheck::simulate(
      {ball.radius, ball.mass, scene.gravity, ball.position, ball.velocity, ball.spin, angle},
      times);

  Differences differences;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto ours = std::visit(
        [&](const auto& any) { return any.sample(times[i], rows.row(i)).ball; }, model.system);
    differences.position = std::max(
        {differences.position, std::abs(path[i][0] - ours.x), std::abs(path[i][1] - ours.y)});
    differences.extent = std::max({differences.extent, std::abs(ours.x), std::abs(ours.y)});
  }
  return differences;
}

}  // namespace

int main(int argc, char** argv) {
  std::printf("%-44s %-16s %s\n", "scenario", "extent (m)", "largest difference (m)");
  for (int i = 1; i < argc; ++i) {
    try {
      const Differences differences = compare(bbsim::read_scenario(argv[i]));
      std::printf("%-44s %-16.4g %.1e\n", argv[i], differences.extent, differences.position);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", argv[i], error.what());
      return 1;
    }
  }
  return 0;
}
