// Scenario -> Model, for a command: what is wrong with a key is said with its place.
#pragma once

#include <vector>

#include "model/model.hpp"
#include "scenario/columns.hpp"

namespace bbsim::app {

// The model that these columns need. Throws InputError.
[[nodiscard]] model::Model assemble(const Scenario& scenario,
                                    const std::vector<const scenario::Column*>& columns);

}  // namespace bbsim::app
