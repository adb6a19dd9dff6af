// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The measures of a run.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/model.hpp"
#include "record/recorder.hpp"
#include "solve/integrate.hpp"

namespace bbsim_test {

struct MeasuredRun {
  bbsim::solve::Outcome outcome;
  std::vector<double> values;
  std::map<std::string, double> of;  // the same, by name
  std::string why;                   // reasons of those that are not finite
  std::optional<bbsim::record::MotorPeaks> peaks;
};

// `integrate` runs a model over a grid into a sink.
template <class Integrate>
MeasuredRun measured(const bbsim::Scenario& scene,
                     const std::vector<bbsim::scenario::Measure>& measures, Integrate integrate) {
  const bbsim::model::Model model = bbsim::model::assemble(scene, false);
  const bbsim::model::BallConstants constants = bbsim::model::constants_of(scene);
  const bbsim::solve::OutputGrid grid(scene.time);
  bbsim::record::Recorder recorder({{}, measures, true});
  recorder.begin(model, constants, grid);
  MeasuredRun made{
      integrate(model, grid, recorder), std::vector<double>(measures.size()), {}, "", {}};
  recorder.finish(made.outcome, made.values.data());
  for (std::size_t i = 0; i < measures.size(); ++i) made.of[measures[i].name] = made.values[i];
  made.why = why_not_finite(measures, made.values.data(), recorder.whys());
  made.peaks = recorder.peaks();
  return made;
}

inline MeasuredRun measured(const bbsim::Scenario& scene,
                            const std::vector<bbsim::scenario::Measure>& measures,
                            bbsim::Method method, bbsim::solve::Tolerances tolerances) {
  return measured(scene, measures, [&](const auto& model, const auto& grid, auto& recorder) {
    return bbsim::solve::integrate(model, method, tolerances, grid, recorder);
  });
}

}  // namespace bbsim_test
