#include "solve/integrate.hpp"

#include "solve/choose.hpp"
#include "solve/collocation/radau.hpp"
#include "solve/cvode.hpp"

namespace bbsim::solve {

Outcome integrate(const model::Model& model, Method method, Tolerances tolerances,
                  const OutputGrid& grid, StateSink& sink, const Watch& watch) {
  const Choice choice = choose_method(model, method, tolerances, grid.end());
  if (choice.method == Method::radau) {
    return integrate_radau(model, tolerances, grid, sink, watch);
  }
  return integrate_cvode(model, choice.method, tolerances, grid, sink, watch);
}

}  // namespace bbsim::solve
