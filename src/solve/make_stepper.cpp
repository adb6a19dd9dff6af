#include "solve/make_stepper.hpp"

#include <stdexcept>

#include "solve/cvode/cvode.hpp"
#include "solve/radau/radau.hpp"

namespace bbsim::solve {

std::unique_ptr<Stepper> make_stepper(const model::Model& model, Method method,
                                      Tolerances tolerances, const OutputGrid& grid) {
  switch (method) {
    case Method::radau:
      return std::make_unique<radau::RadauStepper>(model, radau::choose_kernels(),
                                                   radau::choose_stages(tolerances.rtol),
                                                   tolerances, grid.end());
    case Method::bdf:
    case Method::adams:
      return make_cvode_stepper(model, method, tolerances);
    case Method::automatic:
      break;
  }
  throw std::logic_error("make_stepper: no integrator was chosen");
}

}  // namespace bbsim::solve
