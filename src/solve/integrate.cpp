// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/integrate.hpp"

#include "solve/hybrid_driver.hpp"
#include "solve/make_stepper.hpp"

namespace bbsim::solve {

Outcome integrate(const model::Model& model, Method method, Tolerances tolerances,
                  const OutputGrid& grid, StateSink& sink, const Watch& watch) {
  const Method chosen = choose_method(method);
  const auto stepper_of = [&](const model::Model& any) {
    return make_stepper(any, chosen, tolerances, grid);
  };
  Outcome outcome = model.hybrid()
                        ? integrate_hybrid(model, stepper_of, tolerances, grid, sink, watch)
                        : run_through(*stepper_of(model), model, grid, sink, watch);
  outcome.method = chosen;
  return outcome;
}

}  // namespace bbsim::solve
