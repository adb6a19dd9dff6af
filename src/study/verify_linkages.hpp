// Checks of what stands between servos and the plane, against closed forms of its geometry.
#pragma once

#include <functional>
#include <vector>

#include "study/verify.hpp"

namespace bbsim::study {

[[nodiscard]] std::vector<std::function<Check()>> linkage_checks();

}  // namespace bbsim::study
