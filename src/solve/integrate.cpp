// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/integrate.hpp"

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include "solve/cvode/cvode.hpp"
#include "solve/radau/radau.hpp"
#include "solve/sampled/sampled.hpp"
#include "solve/stepper.hpp"

namespace bbsim::solve {
namespace {

// Tightens the tolerance of each step in coupled scenes. The error over the run then stays near the
// tolerance for every column. The hardest column is u = r gamma': it is hundreds of times smaller
// than other speeds if the ball hardly spins. BDF and Adams need more, because they take many more
// steps, whose errors have one sign. Other scenes keep their tolerances, steps and results.
Tolerances of_each_step(const model::Model& model, Method method, Tolerances asked) {
  const bool coupled = std::visit(
      [](const auto& system) { return model::is_coupled<std::decay_t<decltype(system)>>; },
      model.system);
  if (!coupled) return asked;
  constexpr double finest = 1e-14;
  const bool collocation = method == Method::radau;
  const double rtol = (collocation ? 1e-1 : 1e-2) * asked.rtol;
  return {std::max(rtol, std::min(finest, asked.rtol)), (collocation ? 1e-2 : 1e-4) * asked.atol};
}

}  // namespace

std::unique_ptr<Stepper> make_stepper(const model::Model& model, Method method,
                                      Tolerances tolerances, const OutputGrid& grid) {
  tolerances = of_each_step(model, method, tolerances);
  switch (method) {
    case Method::radau:
      if (sampled::can_step(model)) {
        return std::make_unique<sampled::HeldStepper>(model, sampled::choose_kernels(), tolerances);
      }
      return std::make_unique<radau::RadauStepper>(model, radau::choose_kernels(),
                                                   radau::choose_stages(model, tolerances.rtol),
                                                   tolerances, grid.end());
    case Method::bdf:
    case Method::adams:
      return make_cvode_stepper(model, method, tolerances);
    case Method::automatic:
      break;
  }
  throw std::logic_error("make_stepper: no integrator was chosen");
}

std::function<std::optional<Outcome>()> begin(const model::Model& model, Method method,
                                              Tolerances tolerances, const OutputGrid& grid,
                                              StateSink& sink, const Watch& watch) {
  const Method chosen = choose_method(method);
  const auto stepper_of = [chosen, tolerances, &grid](const model::Model& any) {
    return make_stepper(any, chosen, tolerances, grid);
  };
  std::function<std::optional<Outcome>()> advance;
  if (model.hybrid()) {
    const std::shared_ptr<HybridRun> run =
        begin_hybrid(model, stepper_of, tolerances, grid, sink, watch);
    advance = [run] { return run->advance(); };
  } else {
    advance = [stepper_of, &model, &grid, &sink, &watch] {
      return run_through(*stepper_of(model), model, grid, sink, watch);
    };
  }
  return [chosen, advance] {
    std::optional<Outcome> outcome = advance();
    if (outcome) outcome->method = chosen;
    return outcome;
  };
}

Outcome integrate(const model::Model& model, Method method, Tolerances tolerances,
                  const OutputGrid& grid, StateSink& sink, const Watch& watch) {
  return begin(model, method, tolerances, grid, sink, watch)().value();
}

}  // namespace bbsim::solve
