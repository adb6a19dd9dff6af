// For every processor: pairs of lanes, which are SSE2 on x86-64 and Neon on 64-bit ARM.
#include "solve/lanes/rosenbrock.hpp"

namespace bbsim::solve::lanes {

struct Baseline {
  static constexpr int lanes = 2;
};

#ifdef __x86_64__
#define BBSIM_BASELINE "sse2"
#else
#define BBSIM_BASELINE "baseline"
#endif

extern const KernelSet kernels_baseline;
constinit const KernelSet kernels_baseline{BBSIM_BASELINE, Baseline::lanes,
                                           Rosenbrock<Baseline, Drives::acceleration>::kernel,
                                           Rosenbrock<Baseline, Drives::angle>::kernel};

}  // namespace bbsim::solve::lanes
