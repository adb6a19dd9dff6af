// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The measures of the loop equal the numbers of `bbsim linearize` and `bbsim check`.
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "model/control/loop_analysis.hpp"
#include "scenario/reader.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_loop_analysis {

using namespace bbsim;
using model::LoopAnalysis;

namespace {

scenario::Measure named(const std::string& name) {
  const auto measure = scenario::find_measure(name);
  CAPTURE(name);
  REQUIRE(measure);
  REQUIRE(measure->kind == scenario::Measure::Kind::loop);
  return *measure;
}

// Requests a single measure, so that nothing else is computed.
LoopAnalysis::Value value_of(const std::string& name, const Scenario& scene) {
  const scenario::Measure measure = named(name);
  REQUIRE_FALSE(scenario::missing(measure, scene));
  const model::Model model = model::assemble(scene, false);
  LoopAnalysis analysis(scene, model, model::parts_of({measure}));
  return analysis.value_of(*measure.loop);
}

Scenario config(const std::string& name, const std::vector<std::string>& set = {}) {
  return read_scenario(BBSIM_SOURCE_DIR "/configs/" + name + ".yaml", set);
}

}  // namespace

TEST_CASE("margins and bandwidths equal those of the linear loop bit for bit") {
  const std::string name = GENERATE("rig", "fig2b", "step", "hold", "pushrod", "three-servos",
                                    "torque-lqr", "catch", "falls");
  CAPTURE(name);
  const Scenario scene = config(name);
  const model::Model model = model::assemble(scene, false);
  const model::Linearization loop =
      model::linearize(scene, model, model::LinearKind::loop, model::home_point());
  REQUIRE(loop.margins.size() == 2);
  for (const std::size_t axis : {0U, 1U}) {
    const std::string angle = axis == 0 ? "phi" : "theta", place = axis == 0 ? "x" : "y";
    const model::Margins& margins = loop.margins[axis].margins;
    CHECK(value_of(angle + "_gain_margin", scene).value == margins.gain);
    CHECK(value_of(angle + "_gain_reduction", scene).value == margins.reduction);
    CHECK(value_of(angle + "_phase_margin", scene).value == std::abs(margins.phase));
    CHECK(value_of(angle + "_delay_margin", scene).value == margins.delay);
    CHECK(value_of(place + "_bandwidth", scene).value == loop.bandwidths[axis].value);
    CHECK(value_of(place + "_feedback_bandwidth", scene).value ==
          loop.bandwidths[axis].of_feedback);
  }
  CHECK(value_of("stable", scene).value == 1);
}

TEST_CASE("spectral measures come from the poles that check prints") {
  SECTION("in continuous time") {
    const Scenario scene = config("fig2b");
    const model::Eigenvalues poles = model::closed_loop_poles(model::assemble(scene, false));
    CHECK(value_of("spectral_abscissa", scene).value == poles.front().real());
  }
  SECTION("from sample to sample") {
    const Scenario scene = config("rig");
    const model::Eigenvalues poles = model::sampled_poles(model::assemble(scene, false));
    CHECK(value_of("spectral_radius", scene).value == std::abs(poles.front()));
    CHECK(value_of("spectral_abscissa", scene).value == std::log(std::abs(poles.front())) / 0.02);
  }
  SECTION("per sample if the sensor's frames make a cycle of several samples") {
    const Scenario scene = config("rig", {"controller.sensor.period=30 ms"});
    const model::Eigenvalues poles = model::sampled_poles(model::assemble(scene, false));
    // 20 and 30 ms coincide again after three samples.
    CHECK(value_of("spectral_radius", scene).value == std::pow(std::abs(poles.front()), 1 / 3.0));
    const LoopAnalysis::Value margin = value_of("phi_delay_margin", scene);
    CHECK(std::isnan(margin.value));
    CHECK_FALSE(std::string(margin.why).empty());
  }
}

TEST_CASE("an unstable loop has spectral measures but no margins") {
  Scenario scene = fig2b();
  scene.controller->kv = {{{-1, 0}, {0, 1}}};
  CHECK(value_of("stable", scene).value == 0);
  CHECK(value_of("spectral_abscissa", scene).value > 0);
  for (const char* const name : {"phi_gain_margin", "theta_delay_margin", "x_bandwidth"}) {
    const LoopAnalysis::Value found = value_of(name, scene);
    CHECK(std::isnan(found.value));
    CHECK_FALSE(std::string(found.why).empty());
  }
}

TEST_CASE("with one axis the other one has no margin") {
  const Scenario scene = config("beam");
  CHECK(std::isfinite(value_of("phi_gain_margin", scene).value));
  const LoopAnalysis::Value other = value_of("theta_gain_margin", scene);
  CHECK(std::isnan(other.value));
  CHECK_FALSE(std::string(other.why).empty());
}

}  // namespace bbsim_test::test_loop_analysis
