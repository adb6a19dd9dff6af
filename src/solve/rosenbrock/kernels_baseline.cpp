// For every processor: pairs of lanes, which are SSE2 on x86-64 and Neon on 64-bit ARM.
#include "solve/rosenbrock/rosenbrock.hpp"

namespace bbsim::solve::rosenbrock {

struct Baseline {
  static constexpr int lanes = 2;
};

extern const LaneKernels kernels_baseline;
constinit const LaneKernels kernels_baseline{Baseline::lanes,
                                             Rosenbrock<Baseline, Drives::acceleration>::kernel,
                                             Rosenbrock<Baseline, Drives::angle>::kernel};

}  // namespace bbsim::solve::rosenbrock
