// What is modelled of a scene and what is not, and why: for `bbsim check` and the summary.
#pragma once

#include <vector>

#include "model/model.hpp"

namespace bbsim::model {

// `stops` is the number of times within the run that no step goes over.
[[nodiscard]] std::vector<Note> explain(const Scenario& scene, Shape shape, bool gamma,
                                        std::size_t stops);

}  // namespace bbsim::model
