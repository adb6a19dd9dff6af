#include "assemble.hpp"

#include <string>

#include "base/error.hpp"
#include "record/recorder.hpp"
#include "scenario/look_up.hpp"

namespace bbsim::app {

model::Model assemble(const Scenario& scenario,
                      const std::vector<const scenario::Column*>& columns) {
  try {
    return model::assemble(scenario, scenario::need_gamma(columns));
  } catch (const KeyError& error) {
    throw InputError({Problem{place_of(scenario.source, error.key()), error.what()}});
  }
}

}  // namespace bbsim::app
