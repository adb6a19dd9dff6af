// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <bbsim/bbsim.hpp>
#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "configs";
  bbsim::Scenario scene = bbsim::Scenario::from_file(folder + "/fig2b.yaml");
  scene.set("time.end", 2);
  std::size_t rows = 0;
  bbsim::RunOptions options;
  options.measures = {"max_tilt"};
  options.sink = [&rows](std::span<const double>) { ++rows; };
  const bbsim::Result result = bbsim::run(scene, options);
  std::printf("%zu rows, x = %.17g, %s\n", rows, result.column("x").back(),
              result.measures[0].first.c_str());

  const bbsim::Table table = bbsim::sweep(scene, {.vary = {{"ball.radius", "list:0.01,0.02"}}});
  std::printf("%zu cases\n", table.column("case").numbers.size());
  std::printf("%zu states\n", bbsim::linearize(scene, "plant").states.size());

  bbsim::Stepper stepper(bbsim::Scenario::from_file(folder + "/rig.yaml").set("time.end", 1));
  std::size_t samples = 0;
  for (; !stepper.is_over(); ++samples) stepper.step({0, 0});
  std::printf("%zu samples\n", samples);
  try {
    static_cast<void>(bbsim::run(scene.set("ball.radius", -1)));
  } catch (const bbsim::ScenarioError& error) {
    std::printf("%s: %s\n", error.faults()[0].key.c_str(), error.faults()[0].hint.c_str());
    return 0;
  }
  return 1;
}
