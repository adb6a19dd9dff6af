// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scenes of scenes.yaml.
#pragma once

#include <yaml-cpp/yaml.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "scenario/reader.hpp"
#include "support/run_in_memory.hpp"

namespace bbsim_test {

struct SceneCase {
  std::string what, file, scene;  // a file of the project, or the text
  std::vector<std::string> changes;
  std::size_t events;
  double apart;
  bool stiff, waits;
};

inline const std::vector<SceneCase>& scene_cases() {
  static const std::vector<SceneCase> cases = [] {
    std::vector<SceneCase> made;
    for (const YAML::Node& one : YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/solve/scenes.yaml")) {
      const std::string scene = one["scene"] ? YAML::Dump(one["scene"]) : "";
      made.push_back({one["what"].as<std::string>(), one["file"].as<std::string>(""), scene,
                      one["set"].as<std::vector<std::string>>(std::vector<std::string>{}),
                      one["events"].as<std::size_t>(0), one["apart"].as<double>(1e-8),
                      one["stiff"].as<bool>(false), one["waits"].as<bool>(false)});
    }
    return made;
  }();
  return cases;
}

// Without the resolutions of the project's rigs, whose steps would amplify rounding.
inline bbsim::Scenario load(const SceneCase& one) {
  if (one.file.empty()) return bbsim::parse_scenario(one.scene, "scene.yaml", one.changes);
  bbsim::Scenario scene =
      bbsim::read_scenario(std::string(BBSIM_SOURCE_DIR "/") + one.file + ".yaml", one.changes);
  if (scene.gimbal.servo) scene.gimbal.servo->dead_band = 0;
  if (scene.controller && scene.controller->sampling) scene.controller->sampling->resolution = 0;
  if (scene.controller && scene.controller->sensor) scene.controller->sensor->resolution = 0;
  return scene;
}

inline bbsim::Scenario scene_called(const std::string& what) {
  for (const SceneCase& one : scene_cases()) {
    if (one.what == what) return load(one);
  }
  throw std::runtime_error("no scene " + what);
}

}  // namespace bbsim_test
