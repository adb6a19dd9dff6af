#include "solve/integrate.hpp"

#include "solve/choose.hpp"
#include "solve/cvode/cvode.hpp"
#include "solve/hybrid_driver.hpp"
#include "solve/radau/radau.hpp"

namespace bbsim::solve {

Outcome integrate(const model::Model& model, Method method, Tolerances tolerances,
                  const OutputGrid& grid, StateSink& sink, const Watch& watch) {
  const Method chosen = choose_method(method);
  if (model.hybrid()) return integrate_hybrid(model, chosen, tolerances, grid, sink, watch);
  if (chosen == Method::radau) {
    return integrate_radau(model, tolerances, grid, sink, watch);
  }
  return integrate_cvode(model, chosen, tolerances, grid, sink, watch);
}

}  // namespace bbsim::solve
