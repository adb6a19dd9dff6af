// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/accuracy.hpp"

#include <cmath>
#include <optional>

#include "api/assemble.hpp"
#include "base/error.hpp"
#include "base/number_text.hpp"
#include "solve/output_grid.hpp"

namespace bbsim::api {
namespace {

std::optional<double> tolerance(const std::string& text) {
  const auto value = number_in<double>(text.starts_with('+') ? text.substr(1) : text);
  return value && *value >= 1e-14 && *value <= 0.1 ? value : std::nullopt;
}

// Rounded commands and readings jump with the last bit of the state, which sets a floor under the
// error of every method.
Scenario without_resolutions(const Scenario& scenario) {
  Scenario fine = scenario;
  if (!fine.controller) return fine;
  if (fine.controller->sampling) fine.controller->sampling->resolution = 0;
  if (fine.controller->sensor) fine.controller->sensor->resolution = 0;
  return fine;
}

}  // namespace

std::vector<double> tolerance_ladder(const std::string& text) {
  const std::size_t colon = text.find(':');
  const auto first = tolerance(text.substr(0, colon));
  const auto last = colon == std::string::npos ? first : tolerance(text.substr(colon + 1));
  if (!first || !last || *last > *first) {
    throw InputError("--rtol: found " + text +
                     "; allowed: LOOSEST:TIGHTEST such as 1e-3:1e-13, or one value, each from 0.1 "
                     "down to 1e-14");
  }
  std::vector<double> ladder;
  for (int decade = 0;; ++decade) {
    const double rung = decade == 0 ? *first : study::ten_digits(*first / std::pow(10.0, decade));
    if (rung < *last) return ladder;
    ladder.push_back(rung);
  }
}

study::AccuracyStudy accuracy(const Scenario& scenario, std::vector<Method> methods,
                              const std::vector<double>& rtols, Watch& watch) {
  const model::Model model =
      assemble(without_resolutions(scenario), scenario::columns_named(scenario.output.columns));
  if (model.rig && model.rig->sampled && model.rig->sampled->law.kind == model::LawKind::held) {
    throw InputError(scenario.source.file +
                     ": controller: found one of your own, which accuracy does not run; allowed: a "
                     "law of bbsim (`bbsim run --error` estimates the error of this scenario)");
  }
  if (methods.empty()) {
    for (const NamedMethod& known : named_methods) {
      if (known.method != Method::automatic) methods.push_back(known.method);
    }
  }
  study::AccuracyStudy study =
      study::measure_accuracy(model, solve::OutputGrid(scenario.time), methods, rtols,
                              {watch.stop(), [&watch](double part) { watch.update(part, ""); }});
  watch.end();
  return study;
}

study::Verification verify(Watch& watch) {
  study::Verification verification =
      study::verify({watch.stop(), [&watch](double part) { watch.update(part, ""); }});
  watch.end();
  return verification;
}

study::FullModelStudy compare_simpler(const Scenario& scenario, Watch& watch) {
  return study::compare_simpler(scenario, {watch.stop(), {}});
}

}  // namespace bbsim::api
